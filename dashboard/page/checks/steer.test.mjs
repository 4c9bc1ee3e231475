// Commands, their answers, the lease, pushes and the emergency stop.

import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { Bench } from "./harness.mjs";

const bench = new Bench();
let from = 0;
before(() => bench.open("walk_2kmh"));
after(() => bench.close());
afterEach(() => bench.clean());
beforeEach(() => { from = bench.mock.received.length; });

test("the speed slider sends the command and shows its answer", async () => {
  const page = await bench.page();
  const slider = page.getByRole("slider", { name: "Forward" });
  await slider.focus();
  for (let i = 0; i < 5; i++) await page.keyboard.press("ArrowRight");
  const sent = await bench.arrives((m) => m.name === "walk/velocity" && Math.abs(m.values.forward - 0.05) < 1e-9, from);
  assert.deepEqual([sent.values.left, sent.values.turn], [0, 0]);
  await page.getByText(/✓ accepted .* walk\/velocity by planner/).waitFor();
  await page.getByRole("button", { name: "Stop walking" }).click();
  await bench.arrives((m) => m.name === "walk/stop", from);
  assert.equal(await slider.inputValue(), "0");
  await page.done();
});

test("a slider that moves fast sends ten times a second and ends with its last value", async () => {
  const page = await bench.page();
  await page.getByRole("slider", { name: "Turn" }).evaluate(async (slider) => {
    for (let i = 1; i <= 60; i++) {
      slider.value = String(i / 200);
      slider.dispatchEvent(new Event("input"));
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
  });
  await bench.arrives((m) => m.name === "walk/velocity" && m.values.turn === 0.3, from);
  const count = bench.sent("command", from).length;
  assert.ok(count >= 2 && count <= 14, `${count} commands for 60 moves`);
  await page.done();
});

test("a refusal is shown with its reason beside its button", async () => {
  const page = await bench.page();
  await page.getByText("Steps and distances").press("Enter");
  const form = page.getByRole("form", { name: "walk/step" });
  await form.getByLabel("length").fill("5");
  await form.getByRole("button", { name: "Send" }).press("Enter");
  await form.getByText(/✗ refused .*length = 5 is outside of \[-1, 1\]/).waitFor();
  await form.getByLabel("length").fill("");
  await form.getByRole("button", { name: "Send" }).press("Enter");
  await form.getByText(/length must be given/).waitFor();
  await page.done();
});

test("who holds the lease is shown; it is taken over and given", async () => {
  const page = await bench.page();
  bench.mock.stranger("gangwerk topic pub (pid 7)");
  await page.getByText("gangwerk topic pub (pid 7) steers").waitFor();
  await page.getByRole("button", { name: /Stand$/ }).click();
  await page.getByText(/✗ refused .* walk\/stand: gangwerk topic pub \(pid 7\) holds the lease/).first().waitFor();
  await page.getByRole("button", { name: "Take over" }).click();
  await page.getByText("you steer").waitFor();
  // Kept by the pulse for longer than it lasts without one.
  await page.waitForTimeout(1500);
  assert.match(bench.mock.holder, /dashboard page/);
  await page.getByRole("button", { name: "Give lease" }).click();
  await page.getByText("nobody steers").waitFor();
  await page.done();
});

test("a page that nobody sees gives no pulse and loses the lease", async () => {
  const page = await bench.page();
  const slider = page.getByRole("slider", { name: "Forward" });
  await slider.press("ArrowRight");
  await page.getByText("you steer").waitFor();
  assert.equal(await slider.inputValue(), "0.01");
  await page.evaluate(() => {
    Object.defineProperty(document, "visibilityState", { get: () => "hidden", configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  });
  await page.waitForTimeout(200);
  const silent = bench.mock.received.length;
  await page.waitForTimeout(900);
  assert.equal(bench.sent("pulse", silent).length, 0);
  assert.equal(bench.mock.holder, "");
  assert.equal(await slider.inputValue(), "0", "she comes to a stand, and so do the sliders");
  await page.done();
});

test("a walk that the planner stops is told, and the sliders rest", async () => {
  const page = await bench.page();
  const slider = page.getByRole("slider", { name: "Forward" });
  await slider.press("ArrowRight");
  await page.getByText("you steer").waitFor();
  bench.mock.event("planner", "LeaseLost", "who commanded the walk is gone; the robot stops");
  await page.locator(".answer", { hasText: /✗ refused .* walk: who commanded the walk is gone/ }).waitFor();
  assert.equal(await slider.inputValue(), "0");
  await page.done();
});

test("sliders rest with every halt, but not with a stop of this page that they were moved after", async () => {
  const walks = { supply: [1], start_up: [6], gait: [3] };
  bench.mock.override = walks;
  const page = await bench.page();
  const slider = page.getByRole("slider", { name: "Forward" });
  const rests = () => page.waitForFunction(() => document.querySelector("input[type=range]").value === "0", null, { timeout: 4000 });
  const halts = {
    "emergency stop": () => page.keyboard.press("Space"),
    "supply off": () => { bench.mock.override = { ...walks, supply: [0] }; },
    fallen: () => { bench.mock.override = { ...walks, gait: [5] }; },
    "joints stopped": () => { bench.mock.override = { ...walks, gait: [6] }; },
    "stopped by somebody else": () => { bench.mock.override = { ...walks, gait: [4] }; },
  };
  for (const [name, halt] of Object.entries(halts)) {
    const at = bench.mock.received.length;
    await slider.press("ArrowRight");
    await bench.arrives((m) => m.name === "walk/velocity" && m.values.forward > 0, at);
    await halt();
    await rests().catch((e) => assert.fail(`${name}: ${e.message}`));
    bench.mock.calm();
    bench.mock.override = walks;
    await page.waitForTimeout(200);
  }
  const at = bench.mock.received.length;
  await page.getByRole("button", { name: "Stop walking" }).click();
  await slider.press("ArrowRight");
  bench.mock.override = { ...walks, gait: [4] };
  await bench.arrives((m) => m.name === "walk/velocity", at);
  await page.waitForTimeout(300);
  assert.equal(await slider.inputValue(), "0.01");
  await page.done();
});

test("the start-up asks for the next action, and power on sends both edges", async () => {
  const page = await bench.page();
  const states = [[0, 0, "Power on"], [1, 1, "Home"], [1, 4, "Zero"], [1, 5, "Lower"], [1, 6, "Stand"]];
  for (const [supply, startUp, button] of states) {
    bench.mock.override = { supply: [supply], start_up: [startUp], gait: [0] };
    await page.locator(`.steps button[aria-current=step]:text-is("${button}")`).waitFor({ timeout: 4000 });
  }
  bench.mock.override = { supply: [0], start_up: [0], gait: [0] };
  await page.getByRole("button", { name: /Power on$/ }).click();
  await bench.arrives((m) => m.name === "system/enable", from);
  assert.deepEqual(bench.sent("command", from).map((m) => m.name), ["system/reset", "system/enable"]);
  bench.mock.override = {};
  await page.done();
});

test("dragging on the body pushes, and the arrow says how much", async () => {
  const page = await bench.page();
  await page.getByRole("button", { name: "side", exact: true }).click();
  await page.waitForTimeout(600);
  // Drags of many lengths: what is sent is rounded, and the arrow says what is sent.
  for (let reach = 82; reach < 106; reach += 2) {
    const before = bench.mock.received.length;
    const { x, y } = await page.evaluate(() => window.gangwerk.view.place());
    await page.mouse.move(x, y - 50);
    await page.mouse.down();
    await page.mouse.move(x + 40, y - 50, { steps: 3 });
    await page.mouse.move(x + reach, y - 50, { steps: 3 });
    const label = await page.locator(".push-label").textContent();
    assert.match(label, /^\d+ N × 0\.10 s = \d+\.\d N s$/);
    await page.mouse.up();
    const { values } = await bench.arrives((m) => m.name === "sim/push", before);
    // From her right side, to the right of the picture is ahead.
    assert.ok(values["force.x"] > 20 && Math.abs(values["force.y"]) < 0.2 * values["force.x"] && values["force.z"] === 0, JSON.stringify(values));
    assert.equal(Math.hypot(values["force.x"], values["force.y"]).toFixed(0), label.match(/^\d+/)[0]);
    assert.equal(values.duration, 0.1);
  }
  await page.getByText(/✓ accepted .* sim\/push by sim-backend/).first().waitFor();
  await page.done();
});

test("Escape gives a push up, and a drag beside the body turns the camera", async () => {
  const page = await bench.page();
  const { x, y } = await page.evaluate(() => window.gangwerk.view.place());
  await page.mouse.move(x, y - 50);
  await page.mouse.down();
  await page.mouse.move(x + 90, y - 50, { steps: 3 });
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await page.getByRole("button", { name: "Follow" }).click();
  const before = await page.evaluate(() => window.gangwerk.view.eye());
  await page.mouse.move(60, 300);
  await page.mouse.down();
  await page.mouse.move(260, 300, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(300);
  assert.equal(bench.sent("command", from).length, 0);
  assert.equal(bench.sent("emergency_stop", from).length, 0);
  const after = await page.evaluate(() => window.gangwerk.view.eye());
  assert.ok(Math.hypot(...after.map((v, i) => v - before[i])) > 0.5, `the camera went from ${before} to ${after}`);
  await page.done();
});

test("the emergency stop is sent by press, by Space wherever it is no text, and by Escape twice", async () => {
  const page = await bench.page();
  const stops = () => bench.sent("emergency_stop", from).length;
  const expect = async (count, how) => {
    await page.waitForTimeout(150);
    assert.equal(stops(), count, how);
  };
  await page.locator("body").press("Space");
  await expect(1, "Space with nothing in focus");
  await page.getByText(/✓ accepted .* emergency stop: the motor supply is off/).first().waitFor();
  await page.getByRole("button", { name: /Stand$/ }).focus();
  await page.keyboard.press("Space");
  await expect(2, "Space on a button");
  assert.equal(bench.sent("command", from).length, 0, "the button in focus was not pressed");
  await page.getByRole("slider", { name: "Forward" }).focus();
  await page.keyboard.press("Space");
  await expect(3, "Space on a slider");
  await page.getByLabel("duration").first().focus();
  await page.keyboard.press("Space");
  await expect(4, "Space in a field of a number");
  await page.getByRole("tab", { name: "Tune" }).click();
  await page.getByRole("searchbox", { name: "Search" }).focus();
  await page.keyboard.press("Space");
  await expect(4, "Space in a text field is a blank");
  await page.keyboard.press("Escape");
  await expect(4, "Escape once");
  await page.keyboard.press("Escape");
  await expect(5, "Escape twice");
  const box = await page.getByRole("button", { name: /EMERGENCY STOP/ }).boundingBox();
  await page.mouse.move(box.x + 20, box.y + 20);
  await page.mouse.down();
  await expect(6, "the press, before it is let go");
  await page.mouse.up();
  await expect(6, "letting go");
  await page.getByRole("button", { name: /EMERGENCY STOP/ }).press("Enter");
  await expect(7, "Enter on the button");
  await page.done();
});

test("no list that opens keeps the space bar", async () => {
  bench.mock.setRun("elsewhere");
  const page = await bench.page();
  for (const tab of ["Scenes", "Steer", "Tune", "Plot", "Machine", "Events"]) {
    await page.getByRole("tab", { name: tab }).click();
    assert.equal(await page.locator("select:visible:not([size])").count(), 0, tab);
    for (const choice of await page.locator("select:visible, .choice button:visible").all()) {
      const at = bench.mock.received.length;
      await choice.click();
      await page.keyboard.press("Space");
      await bench.arrives((m) => m.type === "emergency_stop", at);
    }
  }
  await page.getByRole("tab", { name: "Plot" }).click();
  assert.equal(await page.getByRole("group", { name: "Rate" }).locator("[aria-pressed=true]").textContent(), "1000 /s");
  await bench.arrives((m) => m.type === "plot" && m.rate === 1000, from);
  bench.mock.run = null;
  await page.done();
});

test("a browser that keeps nothing has all of the page, and a page that cannot begin has the emergency stop", async () => {
  const page = await bench.page({ init: () => {
    for (const place of ["localStorage", "sessionStorage"]) {
      Object.defineProperty(window, place, { get() { throw new DOMException("Access is denied for this document.", "SecurityError"); } });
    }
  } });
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByRole("button", { name: "5 s", exact: true }).click();
  await page.getByRole("button", { name: /EMERGENCY STOP/ }).click();
  await bench.arrives((m) => m.type === "emergency_stop", from);
  await page.done();
  const broken = await (await bench.context()).newPage();
  await broken.addInitScript(() => { navigator.getGamepads = () => { throw new Error("broken on purpose"); }; });
  await broken.goto(bench.mock.url);
  await broken.waitForFunction(() => document.querySelector(".stop"));
  assert.equal(await broken.locator("main").count(), 0, "it cannot begin");
  for (const stop of [() => broken.keyboard.press("Space"), () => broken.getByRole("button", { name: /EMERGENCY STOP/ }).click()]) {
    const at = bench.mock.received.length;
    await stop();
    await bench.arrives((m) => m.type === "emergency_stop", at);
  }
});

test("without WebGL everything but the picture works", async () => {
  const context = await bench.context();
  const page = await context.newPage();
  await page.addInitScript(() => {
    const real = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : real.call(this, kind, ...rest);
    };
  });
  await page.goto(bench.mock.url);
  await page.getByText("No picture of the robot").waitFor();
  await page.getByText("power on", { exact: true }).waitFor();
  await page.keyboard.press("Space");
  await bench.arrives((m) => m.type === "emergency_stop", from);
});
