// Scenes: chosen, started and ended from the page, by mouse and by keys; nothing of it at a server that starts none.

import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";
import { Bench } from "./harness.mjs";

const bench = new Bench();
before(() => bench.open("walk_2kmh"));
after(() => bench.close());
afterEach(async () => {
  await bench.clean();
  bench.mock.setRun("none"); // nothing of a start is still to come
  bench.mock.run = null;
  bench.mock.setRobot(true);
});

/** Page at a server that starts runs, before any. */
async function waiting(options) {
  bench.mock.setRobot(false);
  bench.mock.setRun("none");
  const context = await bench.context(options);
  const page = await context.newPage();
  await page.goto(bench.mock.url);
  await page.getByText("No robot runs here.").waitFor();
  return page;
}

const state = (page) => page.locator(".run-state").textContent();

test("a server that starts no runs has no panel of scenes", async () => {
  const page = await bench.page();
  assert.equal(await page.getByRole("tab", { name: "Scenes" }).count(), 0);
  assert.equal(await page.getByRole("tab").count(), 5);
  // Arrow keys pass it by.
  await page.getByRole("tab", { name: "Steer" }).focus();
  await page.keyboard.press("ArrowLeft");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Events");
  await page.done();
});

test("a picture shows the way, the objects and the pushes of the chosen scene", async () => {
  const page = await waiting();
  const picture = page.getByRole("img", { name: "Top view" });
  assert.equal(await picture.getAttribute("aria-label"), "Top view: a way of 4.7 m, objects: 1, pushes: 1");
  // On the screen: forward is to the right, to the left is up, and a push from the right points up to the way.
  const box = (part) => picture.locator(part).evaluate((element) => {
    // Without the width of its line.
    const [{ x, y, width, height }, screen] = [element.getBBox(), element.getScreenCTM()];
    return { x: screen.a * x + screen.e, y: screen.d * y + screen.f, width: screen.a * width, height: screen.d * height };
  });
  const [frame, way, object, push] = [await picture.boundingBox(), await box(".way"), await box(".object"), await box(".push")];
  const metre = way.width / 4.5;
  const near = (is, wanted) => assert.ok(Math.abs(is - wanted) < 2, `${is} is not ${wanted}`);
  near(way.height, 0.5 * metre);
  near(object.x - way.x, metre);
  near(object.width, 0.5 * metre);
  near(object.y + object.height - (way.y + way.height), 0.2 * metre);
  near(push.x + push.width / 2 - way.x, 2 * metre);
  near(push.y, way.y + way.height);
  for (const part of [way, object, push]) {
    assert.ok(part.x > frame.x && part.y > frame.y && part.x + part.width < frame.x + frame.width && part.y + part.height < frame.y + frame.height);
  }
  await page.getByRole("listbox", { name: "Scenes" }).selectOption("walk_auto");
  await page.getByRole("img", { name: "Top view: on the spot" }).waitFor();
  await page.getByRole("listbox", { name: "Scenes" }).selectOption("wrong");
  assert.equal(await picture.count(), 0);
});

test("a scene is chosen with its model, started, seen, and ended", async () => {
  const page = await waiting();
  // Where nothing runs the panel is open, and says what each scene is about.
  await page.getByRole("alert").getByText("Start one in the panel Scenes").waitFor();
  await page.getByText("Lola stands up, walks, turns and stops.", { exact: true }).waitFor();
  await page.getByText("lola · 34 s, then until Stop · type 1, euler").waitFor();
  await page.getByRole("listbox", { name: "Scenes" }).selectOption("walk_auto");
  await page.getByText(/depth chosen by its tolerance/).waitFor();
  await page.getByLabel("Depth").selectOption("3");
  await page.getByLabel("Integrator").selectOption("semi_implicit");
  let from = bench.mock.received.length;
  await page.getByRole("button", { name: "Start" }).click();
  const { scene, depth, integrator } = await bench.arrives((m) => m.type === "start", from);
  assert.deepEqual({ scene, depth, integrator }, { scene: "walk_auto", depth: 3, integrator: "semi_implicit" });
  await page.getByText("✓ accepted").first().waitFor();
  await page.getByText("walk_auto runs.").waitFor();
  await bench.drawn(page);
  // A second one is refused, and the first goes on.
  await page.getByRole("button", { name: "Start" }).click();
  await page.getByText(/✗ refused .*walk_auto runs already/).waitFor();
  from = bench.mock.received.length;
  await page.getByRole("button", { name: "Stop", exact: true }).click();
  await bench.arrives((m) => m.type === "end", from);
  await page.getByText("walk_auto is ending: the robot comes to a stand first.").waitFor();
  await page.getByText("No robot runs here.").waitFor();
  assert.equal(bench.sent("emergency_stop").length, 0, "an end is no emergency stop");
});

test("as the scene says, unless something else is chosen", async () => {
  const page = await waiting();
  const from = bench.mock.received.length;
  await page.getByRole("button", { name: "Start" }).click();
  const { scene, depth, integrator } = await bench.arrives((m) => m.type === "start", from);
  assert.deepEqual({ scene, depth, integrator }, { scene: "demo", depth: null, integrator: null });
});

test("a start that fails says why; a scene with a mistake cannot be started", async () => {
  const page = await waiting();
  await page.getByLabel("Depth").selectOption("5");
  await page.getByRole("button", { name: "Start" }).click();
  await page.getByText("error: robot lola has no [contact.pads]").waitFor();
  assert.equal(await state(page), "No robot runs here.");
  await page.getByRole("listbox", { name: "Scenes" }).selectOption("wrong");
  await page.locator("p", { hasText: "config/scenes/wrong.toml: line 3" }).waitFor();
  assert.equal(await page.getByRole("button", { name: "Start" }).isDisabled(), true);
});

test("keys alone choose, start and end; the space bar stays the emergency stop", async () => {
  const page = await waiting();
  const from = bench.mock.received.length;
  await page.getByRole("listbox", { name: "Scenes" }).focus();
  await page.keyboard.press("ArrowDown");
  for (let i = 0; i < 3; i++) await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Start");
  await page.keyboard.press("Enter");
  assert.equal((await bench.arrives((m) => m.type === "start", from)).scene, "walk_auto");
  await page.getByText("walk_auto runs.").waitFor();
  await page.getByRole("button", { name: "Stop", exact: true }).focus();
  await page.keyboard.press("Space");
  await bench.arrives((m) => m.type === "emergency_stop", from);
  assert.equal(bench.sent("end", from).length, 0);
  await page.keyboard.press("Enter");
  await bench.arrives((m) => m.type === "end", from);
});

test("a reload finds the panel and the run again; a run of somebody else is told", async () => {
  const page = await waiting();
  await page.getByRole("button", { name: "Start" }).click();
  await page.getByText("demo runs.").waitFor();
  await page.reload();
  await bench.drawn(page);
  await page.getByText("demo runs.").waitFor();
  assert.equal(await page.getByRole("tab", { name: "Scenes" }).getAttribute("aria-selected"), "true");
  bench.mock.setRun("elsewhere");
  await page.getByText("was started elsewhere").waitFor();
});

test("room for it on a tablet: list, choices and buttons are in view", async () => {
  const page = await waiting({ viewport: { width: 1024, height: 768 }, hasTouch: true });
  for (const [role, name] of [["listbox", "Scenes"], ["listbox", "Depth"], ["listbox", "Integrator"], ["button", "Start"], ["button", "Stop"]]) {
    const box = await page.getByRole(role, { name, exact: true }).boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= 1024 && box.y + box.height <= 768, `${name}: ${JSON.stringify(box)}`);
  }
});
