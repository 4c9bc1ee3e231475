// The page with the real server and a real run: from no power to walking, a push, the emergency stop, the next run.
// Left out, and said so, where the command has no dashboard.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { browser } from "./browser.mjs";
import { binary } from "./harness.mjs";
import { Processes } from "./processes.mjs";

const able = spawnSync(binary(), ["dashboard", "--help"]).status === 0;
const skip = able ? false : "this gangwerk has no dashboard";
const processes = new Processes();
let chromium;
let url;

/** Robot without a timeline: everything is commanded from the page. */
const runRobot = (name) => processes.start(/joined|supply/, "run", processes.scene(name, "startup"), "--lockstep", "--paced", "--no-log", "--dir", processes.run);

before(async () => {
  if (!able) return;
  await runRobot("hanging");
  const { line } = await processes.start(/http:\/\/127\.0\.0\.1:\d+\/#[0-9a-f]{32}/, "dashboard", "--dir", processes.run, "--no-open", "--listen", "127.0.0.1:0");
  url = line.match(/http:\S+/)[0];
  chromium = await browser();
});

after(async () => {
  await chromium?.close();
  await processes.end();
});

/** Value of a state's part. */
const value = (page, name, i = 0) => page.evaluate(([n, k]) => window.gangwerk.state.values[window.gangwerk.hub.last("layout").at(n) + k], [name, i]);
const until = (page, name, wanted, ms = 60000) => page.waitForFunction(([n, w]) => w.includes(window.gangwerk.state.values[window.gangwerk.hub.last("layout").at(n)]), [name, [].concat(wanted)], { timeout: ms });

/** Waits for seconds of the robot's time: a busy machine slows it down. */
async function passed(page, seconds) {
  const from = await value(page, "time");
  await page.waitForFunction((end) => window.gangwerk.state.values[window.gangwerk.hub.last("layout").at("time")] >= end, from + seconds, { timeout: 120000 });
}

test("from no power to walking, a push, and the emergency stop", { skip, timeout: 500000 }, async (t) => {
  const page = await (await chromium.newContext({ viewport: { width: 1280, height: 720 } })).newPage();
  const errors = [];
  page.on("pageerror", (e) => errors.push(e.message));
  page.on("console", (m) => m.type() === "error" && errors.push(m.text()));
  await page.goto(url);
  await page.waitForFunction(() => window.gangwerk?.view.bodies?.solid.root.visible, null, { timeout: 30000 });
  // Each step as the page asks for it.
  const next = async (name) => {
    const current = page.locator(`.steps button[aria-current=step]:text-is("${name}")`);
    await current.waitFor({ timeout: 60000 });
    const answer = page.locator(".steps + .answer:not([data-state=waiting])", { hasText: /accepted|refused/ });
    // On a busy machine a command is too old when it is decided, and says that it is to be sent again, or its answer is late: then
    // the step is another one, or this one comes once more.
    const busy = /send it again|no answer within/;
    for (let k = 0, text = "send it again"; busy.test(text); k++) {
      assert.ok(k < 5, text);
      if (k > 0 && !(await current.isVisible())) return;
      await page.locator(".steps button", { hasText: name }).click();
      await answer.waitFor();
      text = await answer.textContent();
      if (!busy.test(text)) assert.match(text, /✓ accepted/, name);
    }
  };
  // The run switches the supply on by itself.
  await until(page, "supply", 1);
  await next("Home");
  await next("Zero");
  await next("Lower");
  await next("Stand");
  await page.locator('.steps button[aria-current=step]:text-is("Walk")').waitFor({ timeout: 60000 });
  await passed(page, 3);
  // Walking at the slider's speed, and faster when it is moved. A page too busy for a pulse within 0.5 s loses the lease: she
  // stands and the slider goes back to zero, as they shall; then once more.
  const slider = page.getByRole("slider", { name: "Forward" });
  const answer = page.getByLabel("Answer to walking");
  const mean = async (speed) => {
    const set = async () => Number(await slider.inputValue()) > speed - 0.005;
    for (let k = 0; k < 8; k++) {
      await slider.focus();
      for (let key = 0; key < 100 && !(await set()); key++) await page.keyboard.press("ArrowRight");
      await passed(page, 4);
      const told = await answer.textContent();
      if (/send it again/.test(told)) {
        await page.keyboard.press("ArrowLeft");
        continue;
      }
      assert.ok(!(await set()) || /✓ accepted .* walk\/velocity/.test(told), told);
      const from = [await value(page, "time"), await value(page, "torso_truth")];
      await passed(page, 4.8);
      const walked = ((await value(page, "torso_truth")) - from[1]) / ((await value(page, "time")) - from[0]);
      if (await set()) return walked;
      t.diagnostic(`not at ${speed} m/s any more: ${await answer.textContent()}`);
    }
    return assert.fail(`stood eight times in place of walking at ${speed} m/s`);
  };
  const [slow, fast] = [await mean(0.2), await mean(0.4)];
  t.diagnostic(`walks at ${slow.toFixed(3)} m/s with the slider at 0.20, ${fast.toFixed(3)} at 0.40`);
  assert.ok(Math.abs(slow - 0.2) < 0.05 && Math.abs(fast - 0.4) < 0.06, `${slow} ${fast} m/s`);
  // Joint angles of the scene graph are those of the newest state.
  const angles = await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => {
    const { view, state, hub } = window.gangwerk;
    const at = hub.last("layout").at("joint_angle");
    resolve(hub.last("hello").robot.joints.map((_, i) => [view.bodies.solid.angle(i), state.values[at + i], view.measure.tick === state.tick]));
  })));
  assert.ok(angles.every(([drawn, known, same]) => !same || Math.abs(drawn - known) < 1e-5), JSON.stringify(angles));
  // A push by dragging reaches the simulation.
  const { x, y } = await page.evaluate(() => window.gangwerk.view.place());
  const pushed = page.waitForFunction(() => {
    const at = window.gangwerk.hub.last("layout").at("push");
    return Math.hypot(window.gangwerk.state.values[at], window.gangwerk.state.values[at + 1]) > 10;
  }, null, { timeout: 15000, polling: 10 });
  await page.mouse.move(x, y - 40);
  await page.mouse.down();
  await page.mouse.move(x + 30, y - 40, { steps: 4 });
  await page.mouse.up();
  await pushed;
  await page.getByText(/✓ accepted .* sim\/push/).waitFor();
  await page.screenshot({ path: path.join(os.tmpdir(), "gangwerk-page-robot.png") });
  // The page is hidden: she comes to a stand.
  await page.evaluate(() => Object.defineProperty(document, "visibilityState", { get: () => "hidden", configurable: true }));
  await until(page, "gait", [1, 4]);
  await until(page, "gait", 1);
  await page.evaluate(() => { delete document.visibilityState; });
  await page.locator("body").press("Space");
  await until(page, "supply", 0, 5000);
  await page.locator(".stop-answer", { hasText: /✓ accepted .* emergency stop/ }).waitFor();
  assert.deepEqual(errors, []);
  await page.close();
});

test("a page that is open when a run ends shows the next one", { skip, timeout: 120000 }, async () => {
  const page = await (await chromium.newContext()).newPage();
  await page.goto(url);
  await page.waitForFunction(() => window.gangwerk?.view.bodies?.solid.root.visible, null, { timeout: 30000 });
  await processes.interrupt(processes.children[0]);
  await page.getByRole("alert").waitFor({ timeout: 15000 });
  await runRobot("next");
  await page.getByText("connected", { exact: true }).waitFor({ timeout: 30000 });
  await page.getByText("lola · next").waitFor();
  await page.close();
});
