// Gamepad in the walk panel: the mapping as a function, and a gamepad of the browser's that the check moves.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { hands, velocity } from "../src/joystick.js";
import { Bench } from "./harness.mjs";

const SEED = Number(process.env.SEED ?? Math.floor(Math.random() * 2 ** 31));
const LAYOUT = {
  dead_zone: 0.12,
  sticks: { forward: { axis: "ABS_Y", reverse: true, share: 1 }, left: { axis: "ABS_X", reverse: true, share: 1 }, turn: { axis: "ABS_RX", reverse: true, share: 1 } },
  buttons: { dead_man: ["BTN_TL"], stop: ["BTN_WEST"] },
};
const RANGES = { forward: [-0.28, 0.94], left: [-0.14, 0.14], turn: [-0.49, 0.49] };
const L1 = 4, A = 0, B = 1, X = 2, VIEW = 8, MENU = 9;

/** Numbers from 0 to 1, the same for the same seed (mulberry32). */
function random(seed) {
  let a = seed;
  return () => {
    a = (a + 0x6d2b79f5) | 0;
    let t = Math.imul(a ^ (a >>> 15), 1 | a);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}
const next = random(SEED);
const between = (low, high) => low + (high - low) * next();

const standard = (axes = [0, 0, 0, 0], held = []) => ({ axes, buttons: Array.from({ length: 17 }, (_, i) => ({ pressed: held.includes(i), value: held.includes(i) ? 1 : 0 })) });
const forwardOf = (axis, layout, ranges) => velocity(hands(standard([0, axis, 0, 0]), layout).sticks, ranges).forward;

test("velocities are in range, zero in the dead zone and monotonous, for any numbers", () => {
  for (let i = 0; i < 5000; i++) {
    const [dead_zone, share, reverse] = [between(0, 0.9), between(0.01, 1), next() < 0.5];
    const layout = { ...LAYOUT, dead_zone, sticks: { forward: { axis: "ABS_Y", reverse, share } } };
    const ranges = { forward: [-Math.floor(between(0, 200)) / 100, Math.floor(between(0, 200)) / 100] };
    const [a, b] = [between(-1.5, 1.5), between(-1.5, 1.5)].sort((x, y) => x - y);
    const [v, w] = [a, b].map((axis) => forwardOf(axis, layout, ranges));
    const about = JSON.stringify({ SEED, a, b, dead_zone, share, reverse, ranges, v, w });
    for (const [axis, speed] of [[a, v], [b, w]]) {
      assert.ok(speed >= share * ranges.forward[0] - 1e-9 && speed <= share * ranges.forward[1] + 1e-9, about);
      if (Math.abs(axis) <= dead_zone) assert.equal(speed, 0, about);
    }
    assert.ok(reverse ? v >= w : v <= w, about);
    assert.ok(Math.abs(forwardOf(reverse ? -1 : 1, layout, ranges) - share * ranges.forward[1]) <= 0.01, about);
  }
  for (const axis of [NaN, undefined, Infinity, -Infinity]) {
    const speed = forwardOf(axis, LAYOUT, RANGES);
    assert.ok(speed >= RANGES.forward[0] && speed <= RANGES.forward[1], `${axis}: ${speed}`);
  }
});

test("the page maps as the command does: a table that both read", () => {
  const rows = JSON.parse(readFileSync(path.join(import.meta.dirname, "joystick.json"), "utf8"));
  for (const row of rows) {
    const [raw, dead_zone, share, reverse, low, high, expected] = row;
    const layout = { ...LAYOUT, dead_zone, sticks: { forward: { axis: "ABS_Y", reverse, share } } };
    const speed = forwardOf((raw + 0.5) / 32767.5, layout, { forward: [low / 100, high / 100] });
    assert.equal(Math.round(100 * speed), expected + 0, JSON.stringify(row));
  }
});

test("triggers and hats by the kernel's names", () => {
  const layout = { ...LAYOUT, sticks: { forward: { axis: "ABS_HAT0Y", reverse: true, share: 1 } }, buttons: { dead_man: ["ABS_Z", "BTN_MODE"] } };
  const pad = standard([0, 0, 0, 0], [12]);
  assert.equal(hands(pad, layout).sticks.forward, 1, "up is ahead");
  assert.equal(hands(standard([0, 0, 0, 0], [13]), layout).sticks.forward, -1);
  for (const [value, is] of [[0, false], [0.4, false], [0.6, true], [1, true]]) {
    pad.buttons[6].value = value;
    assert.equal(hands(pad, layout).held.dead_man, is, `trigger at ${value}`);
  }
  assert.equal(hands(standard([0, 0, 0, 0], [16]), layout).held.dead_man, true);
});

const bench = new Bench();
let from = 0;
before(() => bench.open("walk_2kmh"));
after(() => bench.close());
afterEach(() => bench.clean());
// She walks: the end of the recording would be a halt.
const WALKS = { supply: [1], start_up: [6], gait: [3] };
beforeEach(() => {
  from = bench.mock.received.length;
  bench.mock.override = WALKS;
});

/** Page with a gamepad that `move` moves: axes, and numbers of held buttons. */
async function withPad(mapping = "standard") {
  const page = await bench.page({ init: () => {
    window.pads = [];
    navigator.getGamepads = () => window.pads;
  } });
  page.move = (axes, held = []) => page.evaluate(([axes, held, mapping]) => {
    const buttons = Array.from({ length: 17 }, (_, i) => ({ pressed: held.includes(i), value: held.includes(i) ? 1 : 0 }));
    window.pads = [{ id: "Test Pad (STANDARD GAMEPAD Vendor: 045e)", connected: true, mapping, axes, buttons }];
  }, [axes, held, mapping]);
  // Held until the page says so: a page that a busy machine let stand still wants a new press.
  page.hold = async (axes, good = page.locator(".pad[data-state=held]")) => {
    for (let tries = 0; tries < 5; tries++) {
      await page.move(axes, [L1]);
      await page.settled();
      if (await good.count()) return;
      await page.move(CENTRE);
      await page.settled();
    }
    assert.fail(`never held: ${await page.locator(".pad [role=status]").textContent()}`);
  };
  page.unplug = () => page.evaluate(() => { window.pads = [null]; });
  page.status = async (text) => page.locator(".pad [role=status]", { hasText: text }).waitFor({ timeout: 5000 }).catch(async (e) => {
    throw new Error(`${e.message}\nit says: ${await page.locator(".pad [role=status]").textContent()}`);
  });
  // Two looks, and the longest pause between two commands.
  page.settled = () => page.waitForTimeout(300);
  return page;
}
const CENTRE = [0, 0, 0, 0];
const sentNow = (at) => bench.sent("command", at).map(({ name }) => name);

test("the gamepad is seen; its sticks count while the dead-man button is held; released, she stops", async () => {
  const page = await withPad();
  await page.status("No gamepad");
  const axes = [between(-1, 1), between(-1, -0.3), between(-1, 1), 0];
  await page.move(axes);
  await page.status(/Test Pad: hold left shoulder to steer/);
  const dot = await page.locator(".pad-stick i").first().evaluate((i) => i.style.transform);
  assert.equal(dot, `translate(${Math.round(50 * axes[0])}%, ${Math.round(50 * axes[1])}%)`);
  await page.settled();
  assert.deepEqual(sentNow(from), [], "sticks alone");
  await page.hold(axes);
  const wanted = velocity(hands(standard(axes), LAYOUT).sticks, RANGES);
  await bench.arrives((m) => m.name === "walk/velocity" && Object.entries(wanted).every(([k, v]) => Math.abs(m.values[k] - v) < 1e-9), from);
  assert.equal(Number(await page.getByRole("slider", { name: "Forward" }).inputValue()), wanted.forward);
  await page.getByText("you steer").first().waitFor();
  await page.move(axes);
  await bench.arrives((m) => m.name === "walk/stop", from);
  assert.equal(await page.getByRole("slider", { name: "Forward" }).inputValue(), "0");
  await page.status("hold left shoulder");
  await page.done();
});

test("a stick that moves all the time sends ten times a second, and ends with its last value", async () => {
  const page = await withPad();
  await page.move(CENTRE);
  await page.settled();
  const ways = Array.from({ length: 300 }, () => between(-1, 1));
  const held = page.locator(".pad[data-state=held]");
  let seconds;
  // From the start again if the machine let the page stand still meanwhile: that lets the button go.
  for (let tries = 0; tries < 5; tries++) {
    await page.hold(CENTRE);
    from = bench.mock.received.length;
    seconds = await page.evaluate(async (ways) => {
      const begin = performance.now();
      for (const way of ways) {
        window.pads = [{ ...window.pads[0], axes: [0, way, 0, 0] }];
        await new Promise((resolve) => setTimeout(resolve, 5));
      }
      return (performance.now() - begin) / 1000;
    }, ways);
    if (await held.count()) break;
    await page.move(CENTRE);
    await page.settled();
  }
  const last = velocity(hands(standard([0, ways.at(-1), 0, 0]), LAYOUT).sticks, RANGES).forward;
  await bench.arrives((m) => m.name === "walk/velocity" && m.values.forward === last, from);
  const count = bench.sent("command", from).length;
  assert.ok(count >= 2 && count <= 10 * seconds + 3, `${count} commands in ${seconds} s`);
  await page.done();
});

test("unplugged or unseen she stops, and what was held then does not count", async () => {
  const page = await withPad();
  const ways = {
    unplugged: [() => page.unplug(), () => {}],
    hidden: [(to) => page.evaluate(() => {
      Object.defineProperty(document, "visibilityState", { get: () => "hidden", configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }, to), () => page.evaluate(() => {
      delete document.visibilityState;
      document.dispatchEvent(new Event("visibilitychange"));
    })],
  };
  for (const [name, [lose, find]] of Object.entries(ways)) {
    await page.move([0, -0.8, 0, 0]);
    await page.status("hold left shoulder");
    await page.hold([0, -0.8, 0, 0]);
    await page.waitForTimeout(between(50, 400));
    let at = bench.mock.received.length;
    await lose();
    await bench.arrives((m) => m.name === "walk/stop", at);
    await find();
    at = bench.mock.received.length;
    await page.move([0, -0.4, 0, 0], [L1]);
    await page.status("release left shoulder");
    await page.settled();
    assert.deepEqual(sentNow(at), [], `${name}: held all the time`);
    await page.move(CENTRE);
    await page.settled();
  }
  await page.done();
});

test("the emergency stop needs neither dead-man button nor lease; the other buttons do what they say", async () => {
  const page = await withPad();
  bench.mock.stranger("gangwerk topic pub (pid 7)");
  await page.move(CENTRE);
  await page.status("hold left shoulder");
  await page.move(CENTRE, [B]);
  await bench.arrives((m) => m.type === "emergency_stop", from);
  await page.move(CENTRE);
  await page.settled();
  await page.move(CENTRE, [A]);
  await page.getByText(/hold the dead-man button of the gamepad first/).waitFor();
  await page.hold(CENTRE, page.getByText(/✗ refused .* lease: gangwerk topic pub \(pid 7\) holds the lease/));
  await page.status("release left shoulder");
  assert.deepEqual([sentNow(from), bench.sent("emergency_stop", from).length], [[], 1]);
  bench.mock.calm();
  bench.mock.override = { supply: [1], start_up: [6], gait: [0] };
  await page.move(CENTRE);
  await page.settled();
  await page.hold(CENTRE);
  const press = async (button, name) => {
    await page.hold(CENTRE);
    await page.move(CENTRE, [L1, button]);
    await bench.arrives((m) => m.name === name, from);
    await page.move(CENTRE, [L1]);
    await page.settled();
  };
  await press(VIEW, "walk/stand");
  bench.mock.override = { supply: [0], start_up: [0], gait: [0] };
  await page.settled();
  await press(VIEW, "system/reset");
  await bench.arrives((m) => m.name === "system/enable", from);
  bench.mock.override = WALKS;
  await press(MENU, "walk/stand");
  await press(A, "walk/start");
  const step = bench.sent("command", from).find(({ name }) => name === "walk/step");
  assert.deepEqual(step.values, { length: 0, side: 0, turn: 0, duration: 0.8 });
  // Stopped with the stick held: it counts again from its centre.
  await page.hold([0, -1, 0, 0]);
  await bench.arrives((m) => m.name === "walk/velocity" && m.values.forward === 0.94, from);
  await page.move([0, -1, 0, 0], [L1, X]);
  await bench.arrives((m) => m.name === "walk/stop", from);
  const at = bench.mock.received.length;
  await page.move([0, -0.5, 0, 0], [L1]);
  await page.settled();
  assert.deepEqual(sentNow(at), []);
  await page.move(CENTRE, [L1]);
  await page.settled();
  await page.move([0, -0.5, 0, 0], [L1]);
  await bench.arrives((m) => m.name === "walk/velocity", at);
  await page.done();
});

test("a release stops her however late timers are, and a page that stood still gives the lease back", async () => {
  const page = await withPad();
  await page.move(CENTRE);
  await page.settled();
  await page.hold([0, -0.6, 0, 0]);
  await bench.arrives((m) => m.name === "walk/velocity", from);
  let at = bench.mock.received.length;
  await page.evaluate(() => {
    const begin = performance.now();
    while (performance.now() - begin < 700);
  });
  await bench.arrives((m) => m.type === "lease" && m.give, at);
  await page.status("release left shoulder");
  assert.equal(await page.getByRole("slider", { name: "Forward" }).inputValue(), "0");
  await page.move(CENTRE);
  await page.settled();
  await page.hold([0, -0.6, 0, 0]);
  // No timer any more, and frames that keep the lease.
  await page.evaluate(() => { for (let id = 0; id < 10000; id++) clearInterval(id); });
  at = bench.mock.received.length;
  await bench.arrives((m) => m.type === "pulse", at);
  await page.move([0, -0.6, 0, 0]);
  await bench.arrives((m) => m.name === "walk/stop" || (m.type === "lease" && m.give), at);
  await page.done();
});

test("a step on the spot undoes no stop that came before its answer", async () => {
  const page = await withPad();
  await page.move(CENTRE);
  await page.settled();
  const stops = {
    "the dead-man button": [() => page.move(CENTRE), (m) => m.name === "walk/stop"],
    "the stop button": [() => page.move(CENTRE, [L1, X]), (m) => m.name === "walk/stop"],
    "the emergency stop": [() => page.keyboard.press("Space"), (m) => m.type === "emergency_stop"],
  };
  for (const [name, [stop, stopped]] of Object.entries(stops)) {
    await page.hold(CENTRE);
    bench.mock.late = 1000;
    const at = bench.mock.received.length;
    await page.move(CENTRE, [L1, A]);
    await bench.arrives((m) => m.name === "walk/step", at);
    await stop();
    await bench.arrives(stopped, at);
    await page.waitForTimeout(1500);
    assert.ok(!sentNow(at).includes("walk/start"), `${name}: ${sentNow(at)}`);
    bench.mock.late = 0;
    await page.move(CENTRE);
    await page.settled();
  }
  await page.done();
});

test("what was held through a halt moves nothing", async () => {
  const page = await withPad();
  const halts = {
    "emergency stop": () => page.keyboard.press("Space"),
    "supply off": () => { bench.mock.override = { ...WALKS, supply: [0] }; },
    fallen: () => { bench.mock.override = { ...WALKS, gait: [5] }; },
    "joints stopped": () => { bench.mock.override = { ...WALKS, gait: [6] }; },
    "stopped by somebody else": () => { bench.mock.override = { ...WALKS, gait: [4] }; },
  };
  for (const [name, halt] of Object.entries(halts)) {
    bench.mock.rewind();
    await page.move(CENTRE);
    await page.settled();
    await page.hold([0, -0.6, 0, 0]);
    // Longer ago than a stop of this page.
    await page.waitForTimeout(3200);
    await page.hold([0, -0.6, 0, 0]);
    await halt();
    await page.status("release left shoulder");
    bench.mock.calm();
    bench.mock.override = WALKS;
    await page.settled();
    const at = bench.mock.received.length;
    await page.move([0, -0.7, 0, 0], [L1]);
    await page.settled();
    assert.deepEqual(sentNow(at), [], name);
  }
  await page.done();
});

test("who moves last steers: slider or stick", async () => {
  const page = await withPad();
  await page.move(CENTRE);
  await page.settled();
  await page.hold([0, -0.6, 0, 0]);
  const slider = page.getByRole("slider", { name: "Forward" });
  await bench.arrives((m) => m.name === "walk/velocity", from);
  await slider.press("Home");
  await bench.arrives((m) => m.name === "walk/velocity" && m.values.forward === -0.28, from);
  await page.settled();
  assert.equal(await slider.inputValue(), "-0.28", "the stick has not moved");
  await page.hold([0, -1, 0, 0]);
  await bench.arrives((m) => m.name === "walk/velocity" && m.values.forward === 0.94, from);
  assert.equal(await slider.inputValue(), "0.94");
  await page.done();
});

test("the layout is the server's, and what is wrong with it or with the gamepad is said", async () => {
  bench.mock.joystick.buttons.dead_man = ["ABS_RZ"];
  let page = await withPad();
  await page.move(CENTRE);
  await page.status("hold right trigger");
  await page.move([0, -1, 0, 0], [7]);
  await bench.arrives((m) => m.name === "walk/velocity" && m.values.forward === 0.94, from);
  await page.done();
  bench.mock.joystick = { problem: "joystick.toml: line 3: dead_zone: 2 is not allowed" };
  page = await withPad();
  await page.move(CENTRE);
  await page.status("dead_zone: 2 is not allowed");
  await page.done();
  bench.mock.joystick = null;
  bench.mock.calm();
  page = await withPad("");
  await page.move([0, -1, 0, 0], [L1]);
  await page.status("gangwerk joystick does");
  await page.done();
});
