// The page over a log, with the real server: its poses, its keys, two logs, pictures, the link to an instant.
// SEED=N chooses other instants. PAGE=dist takes the page from that folder in place of the one in gangwerk: no build of it is needed.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { after, before, test } from "node:test";
import { browser } from "./browser.mjs";
import { binary } from "./harness.mjs";

const root = path.join(import.meta.dirname, "../../..");
const gangwerk = binary();
const folder = mkdtempSync("/dev/shm/gangwerk-replay-page-");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const children = [];
let chromium;
let one;
let two;
let tables;
let seed = Number(process.env.SEED ?? 1) >>> 0;

/** Mulberry32: uniform in [0, 1). */
function random() {
  seed = (seed + 0x6d2b79f5) >>> 0;
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
}

/** Log of a walk of so many seconds and with this speed. */
function record(name, seconds, speed) {
  const scene = path.join(folder, `${name}.toml`);
  const text = `about = "A check."\nrobot = "lola"\ngait = "lola"\ndepth = 1\nintegrator = "euler"\nsubsteps = 4\ncycle = 0.001\nstart_pose = "stand"\n`
    + `duration = ${seconds}\nseed = 1\n[[command]]\ntime = 0.2\ntopic = "walk/stand"\n[[command]]\ntime = 1.5\ntopic = "walk/velocity"\nforward = ${speed}\n`;
  const log = path.join(folder, `${name}.mcap`);
  writeFileSync(scene, text);
  execFileSync(gangwerk, ["sim", scene, "--log", log], { stdio: "ignore", cwd: root });
  return log;
}

/** Rows of a topic by tick, as `gangwerk log export` prints them. */
function table(log, topic, field) {
  const csv = execFileSync(gangwerk, ["log", "export", log, topic, "--field", "header.tick", "--field", field], { maxBuffer: 1 << 30, encoding: "utf8" });
  const rows = csv.trim().split("\n").slice(1).map((line) => line.split(",").map(Number));
  return new Map(rows.map(([tick, ...values]) => [tick, values]));
}

/** Address of a server that replays these logs. */
function serve(...logs) {
  const more = logs.length > 1 ? ["--against", logs[1]] : [];
  const child = spawn(gangwerk, ["dashboard", "--replay", logs[0], ...more, "--dir", path.join(folder, `run${children.length}`), "--no-open", "--listen", "127.0.0.1:0"], { stdio: ["ignore", "pipe", "inherit"] });
  children.push(child);
  return new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => { const url = String(data).match(/http:\S+/); if (url) resolve(url[0]); });
    child.on("exit", (code) => reject(new Error(`the server ended with ${code}`)));
  });
}

before(async () => {
  const logs = [record("one", 6, 0.3), record("two", 5, 0.15)];
  [one, two] = [await serve(logs[0]), await serve(...logs)];
  tables = { angles: table(logs[0], "sensors", "joint_angle"), position: table(logs[0], "sim_state", "position"), other: table(logs[1], "sensors", "joint_angle") };
  chromium = await browser();
});

after(async () => {
  await chromium?.close();
  for (const child of children) {
    child.removeAllListeners("exit");
    child.kill("SIGTERM");
  }
  rmSync(folder, { recursive: true, force: true });
});

/** Page that shows a recording; what it reports as an error fails the check. */
async function open(url, { width = 1280, height = 720, scheme = "dark" } = {}) {
  const context = await chromium.newContext({ viewport: { width, height }, colorScheme: scheme, acceptDownloads: true });
  for (const file of process.env.PAGE ? ["app.js", "app.css"] : []) {
    const type = file.endsWith("js") ? "text/javascript" : "text/css";
    await context.route(`**/${file}`, (route) => route.fulfill({ contentType: type, body: readFileSync(path.join(process.env.PAGE, file), "utf8") }));
  }
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (e) => errors.push(e.message));
  page.on("console", (m) => m.type() === "error" && errors.push(m.text()));
  await page.goto(url);
  await page.waitForFunction(() => window.gangwerk?.replay.on && window.gangwerk.view.bodies?.solid.root.visible, null, { timeout: 30000 });
  page.done = async () => {
    await context.close();
    assert.deepEqual(errors, []);
  };
  return page;
}

/** Waits until what is drawn is the instant of the cursor; {tick, angles, p}. */
async function drawn(page) {
  await page.waitForFunction(() => {
    const { view, replay } = window.gangwerk;
    return view.measure.tick === Math.round(replay.cursor.time / replay.cursor.cycle);
  }, null, { timeout: 15000 });
  return page.evaluate(() => {
    const { view, hub } = window.gangwerk;
    const n = hub.last("hello").robot.joints.length;
    return { tick: view.measure.tick, angles: Array.from({ length: n }, (_, i) => view.bodies.solid.angle(i)), p: view.bodies.solid.root.position.toArray() };
  });
}

const go = (page, time) => page.evaluate((t) => window.gangwerk.replay.cursor.go(t), time);
const cursor = (page) => page.evaluate(() => Math.round(window.gangwerk.replay.cursor.time * 1000));
const instant = () => Math.floor(1 + random() * 4900);

test("poses are the log's at random instants", async () => {
  const page = await open(one);
  for (let k = 0; k < 15; k++) {
    const tick = instant();
    await go(page, tick / 1000);
    const seen = await drawn(page);
    assert.equal(seen.tick, tick);
    const logged = tables.angles.get(tick);
    seen.angles.forEach((angle, i) => assert.ok(Math.abs(angle - logged[i]) < 1e-5, `joint ${i} at tick ${tick}: drawn ${angle}, logged ${logged[i]}`));
    const [x] = tables.position.get(tick);
    assert.ok(Math.abs(seen.p[0] - x) < 0.1, `torso drawn at ${seen.p[0]} m, in truth at ${x} m`);
  }
  await page.done();
});

test("play, speed and the end", async () => {
  const page = await open(one);
  for (const speed of ["1", "0.2", "2"]) {
    await page.locator(".replay-bar select").selectOption(speed);
    await go(page, 1);
    await page.getByRole("button", { name: "Play" }).click();
    const pace = await page.evaluate(() => new Promise((resolve) => {
      // Frames that a busy machine draws a quarter of a second apart or more hold the cursor back.
      const { cursor } = window.gangwerk.replay;
      let [time, before, sum] = [cursor.time, performance.now(), 0];
      const begun = before;
      const step = (now) => {
        sum += Math.min(0.25, Math.max(0, (now - before) / 1000));
        before = now;
        if (now - begun < 1200) requestAnimationFrame(step);
        else resolve((cursor.time - time) / sum);
      };
      requestAnimationFrame(step);
    }));
    assert.ok(Math.abs(pace / Number(speed) - 1) < 0.25, `${pace} s of the log per second at ${speed}`);
    await page.getByRole("button", { name: "Pause" }).click();
    const rests = await cursor(page);
    await page.waitForTimeout(300);
    assert.equal(await cursor(page), rests);
  }
  await page.locator(".replay-bar select").selectOption("10");
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => !window.gangwerk.replay.cursor.playing && window.gangwerk.replay.cursor.time > 5, null, { timeout: 20000 });
  const last = await page.evaluate(() => Math.round(window.gangwerk.hub.last("hello").replay.last * 1000));
  assert.equal((await drawn(page)).tick, last);
  await page.done();
});

test("keyboard alone: cycles, seconds, events, play, the time bar", async () => {
  const page = await open(one);
  const from = instant();
  await go(page, from / 1000);
  await page.locator("body").press(".");
  assert.equal((await drawn(page)).tick, from + 1);
  for (const key of [",", ","]) await page.keyboard.press(key);
  assert.equal((await drawn(page)).tick, from - 1);
  await page.keyboard.press("l");
  assert.equal(await cursor(page), Math.min(from + 999, await page.evaluate(() => Math.round(window.gangwerk.replay.cursor.last * 1000))));
  await page.keyboard.press("j");
  // Events: those that the log shows, each after the one before.
  await go(page, 0);
  const events = await page.waitForFunction(() => {
    const told = window.gangwerk.hub.last("events")?.events;
    return told?.length ? [...new Set(told.map((e) => e.tick).filter((t) => t > 1))].sort((a, b) => a - b) : null;
  });
  for (const tick of (await events.jsonValue()).slice(0, 3)) {
    await page.keyboard.press("n");
    assert.equal(await cursor(page), tick);
    assert.match(await page.locator(".replay-status").textContent(), /s · .+: /);
  }
  await page.keyboard.press("k");
  await page.waitForFunction(() => window.gangwerk.replay.cursor.playing);
  await page.keyboard.press("k");
  await page.waitForFunction(() => !window.gangwerk.replay.cursor.playing);
  // The slider is reached by the tabulator key and moves by cycles.
  for (let k = 0; k < 80 && !(await page.evaluate(() => document.activeElement.type === "range" && document.activeElement.classList.contains("time-slider"))); k++) await page.keyboard.press("Tab");
  const there = await cursor(page);
  await page.keyboard.press("ArrowRight");
  assert.equal(await cursor(page), there + 1);
  await page.keyboard.press("Home");
  assert.ok((await drawn(page)).tick <= 1);
  // A field keeps its keys, and the space bar stops nothing.
  await page.getByRole("tab", { name: "Events" }).click();
  await page.getByPlaceholder("part of a process").fill("");
  await page.keyboard.type("k.n");
  assert.equal(await page.getByPlaceholder("part of a process").inputValue(), "k.n");
  assert.ok((await cursor(page)) <= 1);
  await page.locator(".bar h1").click();
  await page.keyboard.press("Space");
  await page.locator(".stop-answer", { hasText: "recording" }).waitFor();
  await page.done();
});

test("plots have each cycle around the instant", async () => {
  const page = await open(one);
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByRole("group", { name: "Window" }).getByRole("button", { name: "2 s" }).click();
  const field = await page.evaluate(() => `sensors.joint_angle.${window.gangwerk.hub.last("hello").robot.joints[3].name}`);
  await page.getByLabel("Add a field to this pane").first().fill(field);
  await page.keyboard.press("Enter");
  for (let k = 0; k < 3; k++) {
    const tick = 1200 + Math.floor(random() * 3000);
    await go(page, tick / 1000);
    const rows = await (await page.waitForFunction(([f, t]) => {
      const found = window.gangwerk.replay.tiles[0].samples(f, t - 1, t + 1);
      return found.length >= 1999 ? found : null;
    }, [field, tick / 1000], { timeout: 20000 })).jsonValue();
    for (const [time, value] of rows) {
      const logged = tables.angles.get(Math.round(time * 1000))[3];
      assert.ok(Math.abs(value - logged) < 1e-6, `${field} at ${time} s: ${value}, logged ${logged}`);
    }
  }
  // The line of the instant and the curves are painted.
  const painted = await page.locator(".pane canvas").first().evaluate((c) => {
    const { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
    return data.filter((_, i) => i % 4 === 3 && data[i] > 0).length;
  });
  assert.ok(painted > 500, `${painted} pixels of the first plot`);
  await page.done();
});

test("two logs: a ghost that is the other one, an offset, a link", async () => {
  const tick = 1500 + Math.floor(random() * 2500);
  const page = await open(`${two}&t=${tick / 1000}&offset=0.4`);
  const other = async (at) => {
    await page.waitForFunction((t) => window.gangwerk.replay.other?.root.visible && Math.round(window.gangwerk.replay.cursor.time * 1000) === t[0], [at], { timeout: 15000 });
    await drawn(page);
    return page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => {
      const { replay, hub } = window.gangwerk;
      resolve(hub.last("hello").robot.joints.map((_, i) => replay.other.angle(i)));
    }))));
  };
  const check = (angles, at) => angles.forEach((angle, i) => assert.ok(Math.abs(angle - tables.other.get(at)[i]) < 1e-5, `joint ${i} of the other log at ${at}: ${angle}, logged ${tables.other.get(at)[i]}`));
  check(await other(tick), tick + 400);
  assert.equal((await drawn(page)).tick, tick);
  await page.getByLabel("Other log later by").fill("-0.25");
  await page.waitForFunction(() => Math.abs(window.gangwerk.replay.cursor.offset + 0.25) < 1e-9);
  await page.waitForTimeout(400);
  check(await other(tick), tick - 250);
  // A click on Link puts the instant into the address; a page that opens it is there.
  await go(page, (tick + 37) / 1000);
  await page.getByRole("button", { name: "Link" }).click();
  const address = await page.evaluate(() => location.href);
  assert.match(address, new RegExp(`&t=${((tick + 37) / 1000).toFixed(3)}&offset=-0.25$`));
  const next = await open(address);
  assert.equal((await drawn(next)).tick, tick + 37);
  await next.done();
  await page.done();
});

test("a picture shows her, and a video has bytes", async () => {
  const page = await open(`${one}&t=3`);
  await drawn(page);
  const save = async (press) => {
    const waiting = page.waitForEvent("download", { timeout: 20000 });
    await press();
    const download = await waiting;
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  };
  const picture = await save(() => page.getByRole("button", { name: "Picture" }).click());
  assert.equal(picture.name, "one-3.000s.png");
  const colors = await page.evaluate(async (png) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(png), (c) => c.charCodeAt(0))], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const seen = new Map();
    for (let i = 0; i < data.length; i += 4) seen.set(`${data[i] >> 4} ${data[i + 1] >> 4} ${data[i + 2] >> 4} ${data[i + 3] >> 7}`, 1);
    return seen.size;
  }, picture.bytes.toString("base64"));
  assert.ok(colors > 12, `${colors} colours in the picture`);
  await page.getByRole("button", { name: "Video" }).click();
  await page.waitForTimeout(1500);
  const video = await save(() => page.getByRole("button", { name: "Stop video" }).click());
  assert.match(video.name, /\.webm$/);
  assert.ok(video.bytes.length > 5000 && video.bytes.readUInt32BE(0) === 0x1a45dfa3, `${video.bytes.length} bytes`);
  await page.done();
});

for (const scheme of ["dark", "light"]) {
  test(`axe finds nothing serious, nothing runs over, ${scheme}`, async () => {
    const page = await open(two, { scheme, width: scheme === "dark" ? 1280 : 1024, height: scheme === "dark" ? 720 : 768 });
    assert.ok(await page.locator(".stop").isDisabled());
    for (const tab of ["Steer", "Tune", "Plot", "Machine", "Events"]) {
      await page.getByRole("tab", { name: tab }).click();
      await page.waitForTimeout(300);
      await page.evaluate(axe);
      const { violations, passes } = await page.evaluate(() => window.axe.run(document));
      const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
      assert.deepEqual(serious.map(({ id, nodes }) => `${tab}: ${id}: ${nodes.map((n) => `${n.html.slice(0, 160)} ${n.any[0]?.message ?? ""}`).join(" | ")}`), []);
      assert.ok(passes.length > 15, `${passes.length} rules had something to look at`);
      const over = await page.evaluate(() => [...document.querySelectorAll(".replay-bar, .replay-bar *")].filter((e) => {
        const box = e.getBoundingClientRect();
        return e.checkVisibility() && box.width && (box.left < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5);
      }).map((e) => `${e.className} ${e.textContent.slice(0, 30)}`));
      assert.deepEqual(over, [], tab);
    }
    await page.done();
  });
}
