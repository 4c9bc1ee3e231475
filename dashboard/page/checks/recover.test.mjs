// Reload, loss of the connection, another server, another run: the page goes on by itself.

import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";
import { Bench, binary } from "./harness.mjs";
import { Mock } from "./mock.mjs";

const bench = new Bench();
before(() => bench.open("walk_2kmh"));
after(() => bench.close());
afterEach(() => bench.clean());

/** Waits until states come in again. */
const moving = async (page) => {
  const count = await page.evaluate(() => window.gangwerk.state.count);
  await page.waitForFunction((n) => window.gangwerk.state.count > n + 20, count, { timeout: 10000 });
};

test("a reload goes on where it was", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.reload();
  await bench.drawn(page);
  await moving(page);
  assert.equal(await page.getByRole("tab", { name: "Plot" }).getAttribute("aria-selected"), "true");
  await page.getByText(/fields at 200 \/s/).waitFor();
  await page.done();
});

test("a connection that is cut is opened again", async () => {
  const page = await bench.page();
  await moving(page);
  // Kept in the page: the words may be gone before somebody outside has looked.
  await page.evaluate(() => {
    window.seen = [];
    new MutationObserver(() => window.seen.push(document.body.innerText)).observe(document.body, { subtree: true, childList: true, characterData: true });
  });
  bench.mock.cut();
  await page.waitForFunction(() => window.seen.some((text) => text.includes("connection lost")), null, { timeout: 8000 });
  await page.getByText("connected", { exact: true }).waitFor({ timeout: 8000 });
  await moving(page);
  await page.done();
});

test("what waits for an answer hears that the connection is gone; commands meanwhile are not sent", async () => {
  const page = await bench.page();
  const { port, token } = bench.mock;
  await bench.mock.close();
  await page.getByText("connection lost").waitFor();
  await page.getByRole("alert").getByText(/No connection to the dashboard's server/).waitFor();
  await page.getByRole("button", { name: /Stand$/ }).click();
  await page.getByText(/✗ refused .*not sent: no connection/).waitFor();
  await page.waitForTimeout(2500);
  // Another server at the same address.
  bench.mock = new Mock(binary(), "walk_2kmh");
  bench.mock.token = token;
  await bench.mock.listen(port);
  await page.getByText("connected", { exact: true }).waitFor({ timeout: 8000 });
  await moving(page);
  assert.equal(await page.getByRole("alert").isVisible(), false);
  await page.done();
});

test("a robot that goes is told, and the next run is shown", async () => {
  const page = await bench.page();
  const scene = await page.evaluate(() => window.gangwerk.view.bodies.solid.root.uuid);
  bench.mock.setRobot(false);
  await page.getByRole("alert").getByText(/no robot runs in this directory/).waitFor();
  bench.mock.setRobot(true);
  await page.getByText("connected", { exact: true }).waitFor();
  await page.waitForFunction((old) => window.gangwerk.view.bodies.solid.root.uuid !== old, scene);
  await moving(page);
  await page.done();
});

test("a page that comes before the robot waits for it", async () => {
  bench.mock.setRobot(false);
  const context = await bench.context();
  const page = await context.newPage();
  await page.goto(bench.mock.url);
  await page.getByRole("alert").getByText(/no robot runs/).waitFor();
  bench.mock.setRobot(true);
  await bench.drawn(page);
  await moving(page);
  await context.close();
});
