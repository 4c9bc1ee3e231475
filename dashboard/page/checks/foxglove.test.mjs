// The door for Foxglove, by a client that nobody here wrote: Foxglove's own, with its own reader of CDR, at a robot that runs.
// Left out, and said so, where the command has no such door.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import path from "node:path";
import { after, afterEach, before, test } from "node:test";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";
import { binary } from "./harness.mjs";
import { Processes } from "./processes.mjs";
import { table } from "./recording.mjs";

const { FoxgloveClient } = protocol;
const able = spawnSync(binary(), ["dashboard", "--help"], { encoding: "utf8" }).stdout?.includes("--foxglove");
const skip = able ? false : "this gangwerk has no door for Foxglove";
/** Walks a little by herself, so that there is something to see, and then waits for somebody. */
const TIMELINE = [["0.2", "walk/stand"], ["3.0", "walk/velocity", "forward = 0.278"], ["8.0", "walk/stop"]]
  .map(([time, topic, more = ""]) => `[[command]]\ntime = ${time}\ntopic = "${topic}"\n${more}\n`).join("");
const STOPPED = 12000; // [ticks] after that
const [STANDING, WALKING] = [1n, 3n];
const [WARNING, ERROR] = [1, 2];
const processes = new Processes();
const viewers = [];
/** Messages of sensors and joint states by tick, for a look at the log. */
const seen = { sensors: new Map(), joints: new Map() };
let robot;
let address;

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Waits until there is a value. */
async function until(about, look, ms = 30000) {
  const end = performance.now() + ms;
  for (;;) {
    const found = look();
    if (found) return found;
    assert.ok(performance.now() < end, `${about}: not within ${ms} ms`);
    await sleep(5);
  }
}

/** A viewer: Foxglove's client, and what it was told. */
class Viewer {
  channels = [];
  status = [];
  parameters = [];
  times = [];
  #handlers = new Map();

  constructor({ token = false, subprotocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL, origin } = {}) {
    this.ws = new WebSocket(token ? address : address.split("?")[0], [subprotocol], { origin });
    this.client = new FoxgloveClient({ ws: this.ws });
    this.client.on("error", (error) => { this.error = error; });
    this.client.on("close", (event) => { this.closed = event; });
    this.client.on("serverInfo", (info) => { this.info = info; });
    this.client.on("advertise", (channels) => this.channels.push(...channels));
    this.client.on("status", (status) => this.status.push(status));
    this.client.on("parameterValues", (values) => this.parameters.push(values));
    this.client.on("time", ({ timestamp }) => this.times.push(timestamp));
    this.client.on("message", ({ subscriptionId, timestamp, data }) => this.#handlers.get(subscriptionId)?.(data, timestamp));
    viewers.push(this);
  }

  /** Waits until it knows the channels. */
  async ready() {
    await until("advertise", () => this.error ? assert.fail(this.error.message) : this.channels.length);
    return this;
  }

  /** Subscribes to a channel; `take` is given each message and its time. */
  subscribe(topic, take) {
    const { id, schema, encoding } = this.channels.find((channel) => channel.topic === topic) ?? assert.fail(`no channel ${topic}`);
    assert.equal(encoding, "cdr");
    const reader = new MessageReader(parse(schema, { ros2: true }));
    const subscription = this.client.subscribe(id);
    this.#handlers.set(subscription, (data, time) => take(reader.readMessage(data), time));
    return subscription;
  }

  /** Answer to a request about parameters: name to value. */
  async answer(id) {
    const { parameters } = await until(`answer ${id}`, () => this.parameters.find((values) => values.id === id));
    return Object.fromEntries(parameters.map(({ name, value }) => [name, value]));
  }

  /** A status that has not been looked at. */
  async told(level, fits) {
    const status = await until(`status ${fits}`, () => this.status.find(({ message }) => fits.test(message)));
    assert.equal(status.level, level, status.message);
    this.status.splice(this.status.indexOf(status), 1);
  }
}

before(async () => {
  if (!able) return;
  const run = [processes.scene("fox", "walk_1kmh", TIMELINE), "--lockstep", "--paced", "--out", processes.folder, "--no-plots"];
  ({ child: robot } = await processes.start(/joined|supply/, "run", ...run, "--dir", processes.run));
  const { line } = await processes.start(/ws:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32}/, "dashboard", "--dir", processes.run, "--no-open", "--listen", "127.0.0.1:0", "--foxglove", "127.0.0.1:0");
  address = line.match(/ws:\S+/)[0];
});

afterEach(() => viewers.splice(0).forEach((viewer) => viewer.ws.terminate()));
after(() => processes.end());

test("channels are described, and their messages are sensible and change", { skip, timeout: 120000 }, async (t) => {
  const viewer = await new Viewer({ origin: "https://app.foxglove.dev" }).ready();
  assert.deepEqual(viewer.info.capabilities, ["clientPublish", "parameters", "parametersSubscribe", "time"]);
  assert.deepEqual(viewer.info.supportedEncodings, ["json"]);
  for (const { schema, topic } of viewer.channels) assert.ok(parse(schema, { ros2: true }).length > 0, topic);
  const topics = viewer.channels.map(({ topic }) => topic);
  for (const topic of ["/gangwerk/sensors", "/gangwerk/controller_state", "/joint_states", "/tf", "/tf_static", "/markers", "/rosout"]) assert.ok(topics.includes(topic), topic);
  // What is said once is said to whoever comes late.
  let urdf;
  viewer.subscribe("/robot_description", ({ data }) => { urdf = data; });
  await until("URDF", () => urdf);
  assert.match(urdf, /<robot[\s\S]*<\/robot>/);
  // All cycles of one topic, and 100 messages per second of a standard one.
  viewer.subscribe("/gangwerk/sensors", ({ header, joint_angle, foot_wrench }, time) => {
    assert.equal(time, header.stamp_ns, "time of the log");
    seen.sensors.set(Number(header.tick), { angle: [...joint_angle], force: foot_wrench.map(({ force }) => force[2]) });
  });
  viewer.subscribe("/joint_states", ({ name, position }, time) => seen.joints.set(Number(time / 1000000n), { name, position: [...position] }));
  let frames = 0;
  viewer.subscribe("/tf", ({ transforms }) => { frames += transforms.length; });
  const newest = () => [...seen.sensors.keys()].at(-1) ?? 0;
  await until("a walk", () => seen.sensors.size >= 3000 && newest() > 5000 && frames > 0, 60000);
  const ticks = [...seen.sensors.keys()];
  const gaps = ticks.filter((tick, i) => i > 0 && tick !== ticks[i - 1] + 1).length;
  assert.ok(gaps < 5, `${gaps} gaps`);
  assert.ok(viewer.times.every((time, i) => i === 0 || time > viewer.times[i - 1]), "time never goes back");
  const last = [...seen.joints.values()].at(-1);
  const knee = last.name.findIndex((name) => /right.*knee/.test(name));
  const angles = [...seen.sensors.values()].map(({ angle }) => angle[knee]);
  const [least, most] = [Math.min(...angles), Math.max(...angles)];
  assert.ok(least > 0 && most < 2.01 && most - least > 0.1 && new Set(angles).size > 1000, `knee ${least} to ${most} rad`);
  const weight = [...seen.sensors.values()].map(({ force }) => force[0] + force[1]);
  assert.ok(Math.max(...weight) > 400 && Math.max(...weight) < 3000, `${Math.max(...weight)} N on both feet`);
  assert.ok(seen.joints.size >= ticks.length / 11, `${seen.joints.size} joint states`);
  t.diagnostic(`${ticks.length} cycles, ${gaps} gaps, ${seen.joints.size} joint states, ${viewer.times.length} times`);
});

test("the shipped layout shows what there is", { skip, timeout: 30000 }, async () => {
  const { channels } = await new Viewer().ready();
  const { configById } = JSON.parse(readFileSync(path.join(import.meta.dirname, "../../../config/foxglove/lola.json"), "utf8"));
  const panels = Object.values(configById);
  const paths = panels.flatMap(({ paths = [], topicPath = [], topicToRender = [], topics = {} }) => [...paths.map(({ value }) => value), topicPath, topicToRender, ...Object.keys(topics)].flat());
  assert.ok(paths.length > 20, `${paths.length} paths`);
  for (const whole of paths) {
    const [, topic, name, index] = whole.match(/^(\/[\w/]+)(?:\.(\w+)(?:\[(\d+)\])?)?$/);
    const channel = channels.find((c) => c.topic === topic) ?? assert.fail(`no channel ${topic}`);
    const field = parse(channel.schema, { ros2: true }).find((d) => d.name === undefined).definitions.find((f) => f.name === name);
    assert.ok(name === undefined || field, `${topic} has no ${name}`);
    assert.ok(index === undefined || Number(index) < field.arrayLength, whole);
  }
});

test("a parameter is set with the token, answered, and told to those that follow it", { skip, timeout: 60000 }, async () => {
  const [viewer, other] = [await new Viewer({ token: true, subprotocol: "foxglove.sdk.v1" }).ready(), await new Viewer().ready()];
  const NAME = "planner.swing_height";
  viewer.client.getParameters([], "all");
  const all = await viewer.answer("all");
  assert.ok(Object.keys(all).length > 50 && all[NAME] > 0.03 && all[NAME] < 0.07, `${Object.keys(all).length} parameters, ${NAME} ${all[NAME]}`);
  // All of them in one message, as viewers do.
  other.client.subscribeParameterUpdates(Object.keys(all));
  other.client.getParameters([NAME], "before");
  assert.deepEqual(await other.answer("before"), { [NAME]: all[NAME] });
  viewer.client.setParameters([{ name: NAME, value: 0.071, type: "float64" }], "set");
  assert.deepEqual(await viewer.answer("set"), { [NAME]: 0.071 });
  const update = await until("update", () => other.parameters.find(({ id }) => id === undefined));
  assert.deepEqual(update.parameters, [{ name: NAME, value: 0.071, type: "float64" }]);
  // Refused: told why, and what is still there.
  viewer.client.setParameters([{ name: NAME, value: 9 }], "high");
  assert.deepEqual(await viewer.answer("high"), { [NAME]: 0.071 });
  await viewer.told(ERROR, /0\.15/);
  viewer.client.setParameters([{ name: NAME, value: "low" }], "text");
  assert.deepEqual(await viewer.answer("text"), { [NAME]: 0.071 });
  await viewer.told(ERROR, /a number is needed/);
});

test("without the token nothing is set and nothing moves", { skip, timeout: 60000 }, async () => {
  const viewer = await new Viewer().ready();
  viewer.client.setParameters([{ name: "planner.swing_height", value: 0.03 }], "set");
  await viewer.told(ERROR, /planner\.swing_height: refused without the operator's token/);
  assert.deepEqual(await viewer.answer("set"), { "planner.swing_height": 0.071 });
  const channel = viewer.client.advertise({ topic: "command/velocity", encoding: "json", schemaName: "" });
  await viewer.told(ERROR, /command\/velocity: refused without the operator's token/);
  viewer.client.sendMessage(channel, Buffer.from('{"forward": 0.2}'));
  await viewer.told(ERROR, /advertise it first/);
  viewer.client.subscribeConnectionGraph();
  await viewer.told(WARNING, /subscribeConnectionGraph/);
});

test("walks while velocities come, and stands when they come no more", { skip, timeout: 120000 }, async () => {
  const viewer = await new Viewer({ token: true }).ready();
  let [gait, tick] = [0n, 0];
  viewer.subscribe("/gangwerk/controller_state", (state) => { [gait, tick] = [state.gait, Number(state.header.tick)]; });
  await until("standing", () => gait === STANDING && tick > STOPPED, 60000);
  const channel = viewer.client.advertise({ topic: "/command/velocity", encoding: "json", schemaName: "geometry_msgs/Twist" });
  const say = (velocity) => viewer.client.sendMessage(channel, Buffer.from(JSON.stringify(velocity)));
  say({ forward: 9 });
  await viewer.told(ERROR, /\[-2, 2\]/);
  // As a stick that is held: ten times per second.
  const stick = setInterval(say, 100, { linear: { x: 0.2, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0 } });
  try {
    await until("walking", () => gait === WALKING, 60000);
  } finally {
    clearInterval(stick);
  }
  await until("standing again", () => gait === STANDING, 60000);
});

test("strangers' pages, other subprotocols and wrong tokens are refused", { skip, timeout: 60000 }, async () => {
  const status = (url, subprotocols, options) => new Promise((resolve, reject) => {
    const ws = new WebSocket(url, subprotocols, options);
    ws.on("open", () => { ws.terminate(); resolve(101); });
    ws.on("unexpected-response", (_, response) => { response.destroy(); resolve(response.statusCode); });
    ws.on("error", reject);
  });
  const own = [FoxgloveClient.SUPPORTED_SUBPROTOCOL];
  const url = address.split("?")[0];
  assert.equal(await status(url, own, { origin: "http://localhost:8080" }), 101);
  assert.equal(await status(url, own, { origin: "http://evil.example" }), 403);
  assert.equal(await status(address, own, { origin: "null" }), 403);
  assert.equal(await status(url, own, { headers: { host: "evil.example:8765" } }), 403);
  assert.equal(await status(`${url}?token=${"0".repeat(32)}`, own, {}), 403);
  assert.equal(await status(url, ["graphql-ws"], {}), 400);
});

test("a viewer that does not read is cut, and others miss nothing", { skip, timeout: 120000 }, async (t) => {
  const [deaf, viewer] = [await new Viewer().ready(), await new Viewer().ready()];
  const ticks = [];
  viewer.subscribe("/gangwerk/sensors", ({ header }) => ticks.push(Number(header.tick)));
  await until("first cycles", () => ticks.length > 100);
  for (const { id } of deaf.channels) deaf.client.subscribe(id);
  await until("first times", () => deaf.times.length > 10);
  deaf.ws.pause();
  const from = ticks.length;
  await until("10 s of the robot", () => ticks.at(-1) > ticks[from] + 10000, 60000);
  deaf.ws.resume();
  await until("close", () => deaf.closed, 20000);
  const [heard, now] = [Number(deaf.times.at(-1) / 1000000n), ticks.at(-1)];
  t.diagnostic(`cut after tick ${heard}, ${now - heard} ticks ago`);
  assert.ok(now - heard > 4000, "it was cut while it did not read");
  const gaps = ticks.filter((tick, i) => i > 0 && tick !== ticks[i - 1] + 1).length;
  assert.ok(gaps < 5, `${gaps} gaps`);
});

test("what was seen is what the log of the run holds", { skip, timeout: 120000 }, async (t) => {
  await processes.interrupt(robot);
  const { columns, rows } = table(binary(), path.join(processes.folder, "fox.mcap"), "sensors", ["header.tick", "joint_angle"]);
  const names = columns.slice(1).map((name) => name.replace("joint_angle.", ""));
  const logged = new Map(rows.map(([tick, ...angles]) => [tick, angles]));
  for (const [tick, { angle }] of seen.sensors) assert.deepEqual(angle.slice(0, names.length), logged.get(tick), `tick ${tick}`);
  for (const [tick, { name, position }] of seen.joints) {
    assert.deepEqual(name, names);
    assert.deepEqual(position, logged.get(tick), `tick ${tick}`);
  }
  t.diagnostic(`${seen.sensors.size} records and ${seen.joints.size} joint states are equal, of ${rows.length} in the log`);
});
