// Tuning, plots and events.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { exact } from "../src/numbers.js";
import { Bench, difference } from "./harness.mjs";

const bench = new Bench();
let from = 0;
before(() => bench.open("walk_2kmh"));
after(() => bench.close());
afterEach(() => bench.clean());
beforeEach(() => { from = bench.mock.received.length; });

test("a number that is none is a dash", () => {
  assert.deepEqual([null, undefined, NaN, 0.1 + 0.2, -0.055].map(exact), ["–", "–", "–", "0.3", "-0.055"]);
});

test("a parameter is set, undone, reset, refused with its range, and saved", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Tune" }).click();
  const field = page.getByRole("spinbutton", { name: "inclination_p.x" });
  await field.fill("1500");
  await field.press("Enter");
  const set = await bench.arrives((m) => m.type === "set", from);
  assert.deepEqual([set.name, set.value], ["controller.inclination_p.x", 1500]);
  await page.getByText(/✓ accepted .* controller\.inclination_p\.x by controller/).waitFor();
  // Beyond its range: refused, and the field shows what holds.
  await field.fill("20000");
  await field.press("Enter");
  await page.getByText(/✗ refused .* is outside of \[0, 10000\]/).waitFor();
  assert.equal(await field.inputValue(), "1500");
  const height = page.getByRole("spinbutton", { name: "swing_height" });
  await height.fill("0.07");
  await height.press("Enter");
  await bench.arrives((m) => m.name === "planner.swing_height" && m.value === 0.07, from);
  await page.waitForFunction(() => document.querySelectorAll(".parameter[data-changed=true]").length === 2);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save as gait file" }).click()]);
  assert.equal(download.suggestedFilename(), "gait_changes.toml");
  const text = readFileSync(await download.path(), "utf8");
  assert.match(text, /^\[control\]\ninclination_p = \[1500\.0, 1350\.0\] # \[N m\/rad\] was \[1350\.0, 1350\.0\]$/m);
  assert.match(text, /^\[step\]\nswing_height = 0\.07 # \[m\] was 0\.055$/m);
  await page.getByRole("button", { name: "Undo" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".parameter[data-changed=true]").length === 1);
  assert.equal(await height.inputValue(), "0.055");
  await page.getByRole("button", { name: "Reset all" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".parameter[data-changed=true]").length === 0);
  assert.equal(bench.mock.parameters[0].value, 1350);
  await page.done();
});

test("the search finds by name, unit and meaning; what is fixed is shown when asked for", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Tune" }).click();
  const shown = () => page.locator(".parameter:visible label").allTextContents();
  assert.ok(!(await shown()).includes("feedback"));
  await page.getByRole("button", { name: "Can be set" }).click();
  assert.ok((await shown()).includes("feedback"));
  await page.getByRole("searchbox", { name: "Search" }).fill("swing foot");
  assert.deepEqual(await shown(), ["swing_height"]);
  await page.done();
});

test("a parameter that somebody else sets is shown", async () => {
  const page = await bench.page();
  const other = await bench.page();
  await page.getByRole("tab", { name: "Tune" }).click();
  await other.getByRole("tab", { name: "Tune" }).click();
  await other.getByRole("spinbutton", { name: "height_p" }).fill("9000");
  await other.getByRole("spinbutton", { name: "height_p" }).press("Enter");
  await page.waitForFunction(() => [...document.querySelectorAll("input")].some((i) => i.value === "9000"));
  await other.getByRole("button", { name: "Reset controller.height_p to 10000" }).click();
  await page.done();
  await other.done();
});

test("a field is found by search, subscribed, drawn, and its value under the cursor is the log's", async () => {
  bench.mock.rewind();
  const page = await bench.page();
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByRole("button", { name: "Add pane" }).click();
  const search = page.getByRole("combobox").last();
  await search.focus();
  await page.keyboard.type("hip left flexion angle sensors");
  await page.keyboard.press("Enter");
  const field = "sensors.joint_angle.left_hip_flexion";
  await bench.arrives((m) => m.type === "plot" && m.fields.includes(field), from);
  const pane = page.getByRole("region", { name: "Pane of plots" }).last();
  await pane.getByRole("group", { name: /Plot: arrow keys/ }).focus();
  for (let i = 0; i < 10; i++) await page.keyboard.press("ArrowLeft");
  // The window fills from the left: nothing is under the cursor at first.
  const under = pane.locator(".plot-value");
  await under.getByText(/\d/).waitFor();
  await page.getByRole("button", { name: "Pause" }).click();
  await page.waitForTimeout(300);
  const value = Number((await under.textContent()).split(" ")[0].replace("−", "-"));
  const [, { columns, rows }] = bench.mock.recording.series.find(([topic]) => topic === "sensors");
  const logged = rows.map((row) => row[columns.indexOf("joint_angle.left_hip_flexion")]);
  assert.ok(Number.isFinite(value) && logged.some((v) => Math.abs(v - value) < 0.006), `${value} is a value of the log`);
  // Something of its colour is drawn.
  const ink = await pane.locator("canvas").evaluate((canvas) => {
    const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let n = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && data[i + 2] > 200 && data[i] < 130) n++;
    return n;
  });
  assert.ok(ink > 50, `${ink} pixels of the curve`);
  await page.done();
});

test("zoom by dragging holds the window, a double click goes on", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.waitForTimeout(2500);
  const box = await page.locator(".u-over").first().boundingBox();
  await page.mouse.move(box.x + 20, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 120, box.y + 40, { steps: 4 });
  await page.mouse.up();
  await page.getByRole("button", { name: "Live" }).waitFor();
  await page.mouse.move(box.x + 20, box.y - 60);
  await page.waitForTimeout(400);
  const clip = { x: box.x, y: box.y, width: box.width, height: box.height };
  const shots = async () => [await page.screenshot({ clip }), (await page.waitForTimeout(800), await page.screenshot({ clip }))];
  assert.equal(await difference(page, ...(await shots())), 0, "held");
  await page.mouse.dblclick(box.x + 200, box.y + 40);
  await page.getByRole("button", { name: "Pause" }).waitFor();
  await page.mouse.move(box.x + 20, box.y - 60);
  assert.ok((await difference(page, ...(await shots()))) > 0.001, "live");
  await page.done();
});

test("events are listed newest first, with answers, and filtered", async () => {
  const page = await bench.page();
  await page.getByRole("button", { name: /Stand$/ }).click();
  await page.getByRole("tab", { name: "Events" }).click();
  const rows = () => page.locator(".events li:visible .event-name").allTextContents();
  await page.waitForFunction(() => document.querySelectorAll(".events li").length >= 2);
  assert.deepEqual((await rows()).slice(0, 2), ["walk/stand", "PlanMade"]);
  await page.getByRole("searchbox", { name: "Filter" }).fill("planmade");
  assert.deepEqual(await rows(), ["PlanMade"]);
  await page.done();
});

test("processes and joints are listed", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Machine" }).click();
  await page.getByRole("img", { name: /execution: p50 70.0 µs, p99 210 µs/ }).waitFor();
  assert.equal(await page.locator("tbody tr").count(), bench.mock.recording.joints.length);
  await page.waitForFunction(() => /°$/.test(document.querySelector("tbody tr td.number").textContent));
  await page.done();
});

test("the machine panel shows cycles by octaves, the one that was late among them", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Machine" }).click();
  const name = "cycles by octaves of execution";
  await page.getByRole("img", { name }).first().waitFor();
  assert.equal(await page.getByRole("img", { name }).count(), 5, "processes with cycles");
  const told = await page.getByRole("img", { name }).first().getAttribute("aria-label");
  assert.match(told, /1000 below 4.10 µs, 100 below 8.19 µs.* 1 below 33554 µs/);
  const heights = await page.getByRole("img", { name }).first().evaluate((e) => [...e.children].map((bar) => bar.getBoundingClientRect().height));
  assert.equal(heights.length, 20);
  // The median is the highest, the late one is seen, and between them is nothing.
  assert.equal(heights.indexOf(Math.max(...heights)), 2);
  assert.ok(heights[15] > 3 && heights[15] < heights[2] / 2 && heights[12] === 0, `${heights}`);
  await page.done();
});
