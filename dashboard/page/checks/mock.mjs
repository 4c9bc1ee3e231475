// Server in place of `gangwerk dashboard` for checks of the page: speaks docs/dashboard.md, plays a recorded walk in a loop,
// refuses what the real one refuses, and keeps what the page sent.

import { execFileSync } from "node:child_process";
import { randomBytes } from "node:crypto";
import { readFileSync } from "node:fs";
import http from "node:http";
import path from "node:path";
import { WebSocketServer } from "ws";
import { record, urdfOf } from "./recording.mjs";

const root = path.join(import.meta.dirname, "../../..");
const LEASE_MS = 500;
const MOST_BYTES = 4096;
const CSP = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'";
const FILES = { "/": ["index.html", "text/html; charset=utf-8"], "/app.js": ["app.js", "text/javascript; charset=utf-8"], "/app.css": ["app.css", "text/css; charset=utf-8"], "/licenses.txt": ["LICENSES.txt", "text/plain; charset=utf-8"] };

/** Commands as `gangwerk topic list` tells them. */
function commandsOf(binary) {
  const text = execFileSync(binary, ["topic", "list"], { encoding: "utf8" });
  const commands = [];
  for (const line of text.slice(text.indexOf("\ncommands")).split("\n").slice(2)) {
    const command = line.match(/^  ([a-z]+\/\S+)\s+(.*)$/);
    const field = line.match(/^      (\S+)\s+\[(\S+), (\S+)\] (\S*)\s+(?:must be given|default (\S+)): (.*)$/);
    if (command) commands.push({ name: command[1], about: command[2], needs_lease: !/stop|end$|sim\/push/.test(command[1]), fields: [] });
    else if (field) commands.at(-1).fields.push({ name: field[1], unit: field[4] || "-", low: Number(field[2]), high: Number(field[3]), default: field[5] === undefined ? null : Number(field[5]), about: field[6] });
  }
  return commands;
}

/** Parameters of a kind that the real ones have, with limits and without. */
const parameters = () => [
  ["controller.inclination_p.x", "N m/rad", 0, 1e4, 1350, "live", "K_P of phi_x (5.3)"], ["controller.inclination_p.y", "N m/rad", 0, 1e4, 1350, "live", "K_P of phi_y (5.2)"],
  ["controller.inclination_d.x", "N m s/rad", 0, 2000, 250, "live", "K_D of phi_x (5.3)"], ["controller.inclination_d.y", "N m s/rad", 0, 2000, 250, "live", "K_D of phi_y (5.2)"],
  ["controller.height_p", "N/m", 0, 5e4, 1e4, "live", "K_P of the height of the centre of gravity (5.4)"], ["controller.force_filter", "s", 1e-4, 0.1, 0.003, "live", "time constant of the force sensor filter"],
  ["controller.feedback", "-", 1, 2, 1, "fixed", "feedback path of figure 5.8"], ["planner.swing_height", "m", 0, 0.15, 0.055, "live", "height of the swing foot z_swing, from the next step on"],
  ["planner.step.width", "m", 0, 1, 0.21, "fixed", "lateral distance of the sole frames W_step"], ["lowlevel.following_error", "rad", 0, null, 0.1, "fixed", "following error at rest that trips the motor supply"],
  ["broker.lease", "s", 0.5, 0.5, 0.5, "constant", "command lease after the last heartbeat of its holder"],
].map(([name, unit, low, high, value, change, about]) => ({ name, unit, low, high, default: value, value, change, about }));

/** Layout of a gamepad as config/joystick.toml has it: what a test changes is its own. */
const joystick = () => ({
  dead_zone: 0.12,
  sticks: { forward: { axis: "ABS_Y", reverse: true, share: 1 }, left: { axis: "ABS_X", reverse: true, share: 1 }, turn: { axis: "ABS_RX", reverse: true, share: 1 } },
  buttons: { dead_man: ["BTN_TL"], emergency_stop: ["BTN_EAST"], stop: ["BTN_WEST", "BTN_NORTH"], walk: ["BTN_SOUTH"], stand: ["BTN_START"], next: ["BTN_SELECT"] },
});

/** Picture of a scene without a way. */
const STANDS = { way: [[0, 0]], objects: [], pushes: [] };
/** Scenes of a server that starts runs: one with a depth, one that leaves it open, one with a mistake. */
const SCENES = [
  { name: "demo", about: "Lola stands up, walks, turns and stops.", robot: "lola", duration: 34, depth: 1, integrator: "euler", view: { way: [[0, 0], [4, 0], [4.5, 0.5]], objects: [[[1, -0.2], [1.5, 0.4]]], pushes: [[2, 0, 0, 200]] } },
  { name: "walk_auto", about: "Lola walks with the cheapest model that is accurate enough.", robot: "lola", duration: 6, depth: null, integrator: null, view: STANDS },
  { name: "wrong", problem: "config/scenes/wrong.toml: line 3: dept: unknown key; the nearest is `depth`" },
  ...Array.from({ length: 40 }, (_, i) => ({ name: `walk_with_a_rather_long_name_${i}`, about: "Lola walks straight on and stops, with a sentence about it that is longer than the panel is wide.", robot: "lola", duration: 20, depth: 3, integrator: "semi_implicit", view: STANDS })),
];
const START_MS = 400;

/** A running mock: {url, received, close, ...}; `received` are all messages of all pages, in their order. */
export class Mock {
  received = [];
  token = randomBytes(16).toString("hex");
  lost = 0;
  #http;
  #sockets = new Set();
  #lease = { holder: "", socket: null, until: 0 };
  #started = performance.now();
  #stopped = null;
  #timers = [];
  #run = 1;
  robot = true;
  /** State of the run as a server of --start tells it; null: it starts none. */
  run = null;
  #next = 0;
  joystick = joystick();
  push = [0, 0, 0, 0];

  constructor(binary, scene = "walk_2kmh") {
    this.recording = record(binary, scene);
    this.scene = scene;
    this.commands = commandsOf(binary);
    this.parameters = parameters();
    this.urdf = urdfOf(root, "lola");
    this.ranges = new Map(this.urdf.match(/<joint [\s\S]*?<\/joint>/g).map((j) => [j.match(/name="([^"]+)"/)[1], [Number(j.match(/lower="([^"]+)"/)?.[1]), Number(j.match(/upper="([^"]+)"/)?.[1]), Number(j.match(/velocity="([^"]+)"/)?.[1])]]));
  }

  /** Listens on a port (0: any). */
  async listen(port = 0) {
    this.#http = http.createServer((request, response) => this.#serve(request, response));
    const server = new WebSocketServer({ noServer: true, maxPayload: MOST_BYTES });
    this.#http.on("upgrade", (request, socket, head) => {
      const url = new URL(request.url, "http://localhost");
      if (url.pathname !== "/socket" || url.searchParams.get("token") !== this.token || request.headers.origin !== `http://${request.headers.host}`) {
        socket.end("HTTP/1.1 403 Forbidden\r\nconnection: close\r\n\r\n");
        return;
      }
      server.handleUpgrade(request, socket, head, (client) => this.#welcome(client));
    });
    await new Promise((resolve) => this.#http.listen(port, "127.0.0.1", resolve));
    this.port = this.#http.address().port;
    this.url = `http://127.0.0.1:${this.port}/#${this.token}`;
    this.#timers = [setInterval(() => this.#state(), 1000 / 60), setInterval(() => this.#samples(), 33), setInterval(() => this.#slow(), 500), setInterval(() => this.#expire(), 50)];
    return this;
  }

  /** Ends it; the port is free afterwards. */
  async close() {
    this.#timers.forEach(clearInterval);
    for (const { client } of this.#sockets) client.terminate();
    this.#http.closeAllConnections();
    await new Promise((resolve) => this.#http.close(resolve));
  }

  /** Cuts all connections, as a network does. */
  cut() {
    for (const { client } of this.#sockets) client.terminate();
  }

  /** Robot gone or there: its run ends, or another one begins. */
  setRobot(there) {
    this.robot = there;
    if (there) {
      this.#run++;
      this.#stopped = null;
      this.#started = performance.now();
    }
    for (const socket of this.#sockets) {
      if (there) this.#hello(socket);
      this.#send(socket, this.#link());
    }
  }

  /** Starts runs from now on, of which there is this one. */
  setRun(state, scene = "", why = "") {
    clearTimeout(this.#next);
    this.run = { type: "run", state, scene, why };
    for (const socket of this.#sockets) this.#send(socket, this.run);
  }

  /** Tells all pages of an event. */
  event(process, name, text) {
    for (const s of this.#sockets) this.#send(s, { type: "event", tick: this.#tick(), time: this.#tick() / 1000, process, name, text });
  }

  /** Values that the next frames have: name of a part, and numbers. */
  override = {};
  /** Time that answers take [ms]. */
  late = 0;

  #link = () => ({ type: "link", robot: this.robot, broker: this.robot, why: this.robot ? "" : "no robot runs in this directory: gangwerk run SCENE starts one" });

  #serve(request, response) {
    const headers = { "content-security-policy": CSP, "x-content-type-options": "nosniff", "cache-control": "no-store" };
    const { pathname } = new URL(request.url, "http://localhost");
    const file = FILES[pathname];
    if (request.method !== "GET") response.writeHead(405, headers).end();
    else if (file) response.writeHead(200, { ...headers, "content-type": file[1] }).end(readFileSync(path.join(import.meta.dirname, "../dist", file[0])));
    else if (pathname === "/robot.urdf" && this.robot) response.writeHead(200, { ...headers, "content-type": "application/xml" }).end(this.urdf);
    else response.writeHead(404, headers).end();
  }

  #welcome(client) {
    const socket = { client, plot: [], rate: 0, sent: 0, name: `dashboard page ${this.#sockets.size + 1}` };
    this.#sockets.add(socket);
    if (this.robot) this.#hello(socket);
    this.#send(socket, this.#link());
    this.#send(socket, this.#leaseOf(socket));
    if (this.run) this.#send(socket, { type: "scenes", list: SCENES });
    if (this.run) this.#send(socket, this.run);
    this.#send(socket, { type: "event", tick: 210, time: 0.21, process: "planner", name: "PlanMade", text: "a plan of the mock" });
    client.on("message", (data) => this.#take(socket, JSON.parse(data)));
    client.on("error", () => {});
    client.on("close", () => {
      this.#sockets.delete(socket);
      if (this.#lease.socket === socket) this.#give();
    });
  }

  #hello(socket) {
    socket.plot = [];
    const { layout, joints, series } = this.recording;
    const sole = { sole: [0.04, 0, -0.02], support: [-0.255, 0.035, -0.04, 0.04], sensor: [0, 0, -0.03] };
    this.#send(socket, {
      type: "hello", version: 1, run: this.#run, mode: "lockstep", cycle: 0.001,
      robot: { name: "lola", mass_kg: 60.9, torso_link: "torso", joints: joints.map((name) => ({ name, low: this.ranges.get(name)[0], high: this.ranges.get(name)[1], speed: this.ranges.get(name)[2] })),
        feet: ["right", "left"].map((side) => ({ link: `${side}_toe`, sensor_link: `${side}_foot`, ...sole })) },
      scene: { name: this.scene, about: "Recorded walk.", model: "type 2", simulated: true, crane: false, duration: 20, objects: [], ground: { height: 0, tilt: [0, 0] } },
      state: layout, fields: series.flatMap(([topic, { columns }]) => columns.map((c) => ({ name: `${topic}.${c}`, unit: /angle|error/.test(c) ? "rad" : /force/.test(c) ? "N" : "m" }))),
      commands: this.commands, parameters: this.parameters,
      gait: { speed: 0.94, velocity: { forward: [-0.28, 0.94], left: [-0.14, 0.14], turn: [-0.49, 0.49] }, on_the_spot: 0.8, length: [-0.2, 0.66], side: [-0.2, 0.2], turn: [-0.349, 0.349], duration: [0.7, 1.2] },
      joystick: this.joystick,
    });
  }

  #send(socket, message) {
    if (socket.client.readyState === 1) socket.client.send(JSON.stringify(message));
  }

  #leaseOf = (socket) => ({ type: "lease", holder: this.#lease.holder, mine: this.#lease.socket === socket });

  #grant(socket) {
    this.#lease = { holder: socket.name, socket, until: performance.now() + LEASE_MS };
    for (const s of this.#sockets) this.#send(s, this.#leaseOf(s));
  }

  #give() {
    this.#lease = { holder: "", socket: null, until: 0 };
    for (const s of this.#sockets) this.#send(s, this.#leaseOf(s));
  }

  /** Somebody else who holds the lease, for checks of take-over. */
  stranger(name) {
    this.#lease = { holder: name, socket: {}, until: Infinity };
    for (const s of this.#sockets) this.#send(s, this.#leaseOf(s));
  }

  /** Forgets what a check has set. */
  calm() {
    this.override = {};
    this.late = 0;
    this.#stopped = null;
    this.#give();
    this.joystick = joystick();
    this.parameters = parameters();
  }

  get holder() {
    return this.#lease.holder;
  }

  #expire() {
    if (this.#lease.socket && performance.now() > this.#lease.until) this.#give();
  }

  #take(socket, message) {
    this.received.push({ ...message, at: performance.now() });
    if (message.type !== "plot" && this.#lease.socket === socket) this.#lease.until = performance.now() + LEASE_MS;
    const answer = (accepted, text) => {
      const send = () => this.#send(socket, { type: "answer", id: message.id, accepted, text });
      this.late ? setTimeout(send, this.late) : send();
    };
    switch (message.type) {
      case "plot":
        Object.assign(socket, { plot: message.fields, rate: message.rate, sent: this.#tick() });
        this.#send(socket, { type: "plotting", fields: message.fields, rate: message.rate });
        break;
      case "lease":
        if (message.give) this.#lease.socket === socket && this.#give();
        else if (this.#lease.socket && this.#lease.socket !== socket && !message.over) return answer(false, `${this.#lease.holder} holds the lease`);
        else this.#grant(socket);
        answer(true, "broker");
        break;
      case "emergency_stop":
        this.#stopped ??= this.#frame();
        answer(true, "the motor supply is off");
        break;
      case "set":
        this.#set(socket, message, answer);
        break;
      case "command":
        this.#command(socket, message, answer);
        break;
      case "start":
        this.#start(message, answer);
        break;
      case "end":
        if (this.run?.state !== "running") return answer(false, "no run was started here");
        this.setRun("stopping", this.run.scene);
        this.#next = setTimeout(() => { this.setRobot(false); this.setRun("none"); }, START_MS);
        answer(true, `${this.run.scene} is ending: its robot comes to a stand first`);
        break;
    }
  }

  /** A start of type 5 fails, as one does whose robot lacks data. */
  #start({ scene, depth }, answer) {
    if (!this.run) return answer(false, "this dashboard starts and ends no runs");
    if (!SCENES.some(({ name }) => name === scene)) return answer(false, `there is no scene ${scene}`);
    if (this.run.state !== "none") return answer(false, `${this.run.scene} runs already; end it first`);
    this.setRun("starting", scene);
    this.#next = setTimeout(() => {
      if (depth === 5) return this.setRun("none", "", `${scene} ended (exit status: 1)\nerror: robot lola has no [contact.pads]`);
      this.setRobot(true);
      this.setRun("running", scene);
    }, START_MS);
    answer(true, `${scene} is starting`);
  }

  #mayMove(socket) {
    if (this.#lease.socket && this.#lease.socket !== socket) return `${this.#lease.holder} holds the lease`;
    if (!this.#lease.socket) this.#grant(socket);
    return "";
  }

  #set(socket, { name, value }, answer) {
    const parameter = this.parameters.find((p) => p.name === name);
    if (!parameter) return answer(false, `${name} is no parameter`);
    if (parameter.change !== "live") return answer(false, `${name} is fixed at start: config/gaits/lola.toml`);
    if (value < parameter.low || (parameter.high !== null && value > parameter.high)) return answer(false, `${name} = ${value} is outside of [${parameter.low}, ${parameter.high}] ${parameter.unit}`);
    const held = this.#mayMove(socket);
    if (held) return answer(false, held);
    parameter.value = value;
    answer(true, name.split(".")[0]);
    for (const s of this.#sockets) this.#send(s, { type: "parameter", name, value });
  }

  #command(socket, { name, values }, answer) {
    const command = this.commands.find((c) => c.name === name);
    if (!command) return answer(false, `${name} is no command`);
    for (const field of command.fields) {
      const value = values[field.name] ?? field.default;
      if (value === null) return answer(false, `${name}: ${field.name} must be given`);
      if (!(value >= field.low && value <= field.high)) return answer(false, `${field.name} = ${value} is outside of [${field.low}, ${field.high}] ${field.unit}`);
    }
    const held = command.needs_lease ? this.#mayMove(socket) : "";
    if (held) return answer(false, held);
    if (name === "sim/push") this.push = [values["force.x"], values["force.y"], values["force.z"], performance.now() + 1000 * values.duration];
    if (name === "system/enable") this.#stopped = null;
    answer(true, { walk: "planner", sim: "sim-backend", joint: "lowlevel", system: "watchdog" }[name.split("/")[0]] ?? "controller");
  }

  /** From the begin of the recording again: a check of some seconds does not meet its end. */
  rewind() {
    this.#started = performance.now();
  }

  #frame() {
    return Math.floor(((performance.now() - this.#started) / 1000) * 60) % this.recording.frames.length;
  }

  #tick() {
    return this.recording.ticks[this.#stopped ?? this.#frame()];
  }

  #state() {
    if (!this.robot) return;
    const { frames, place } = this.recording;
    // Once: time goes on while a frame is made.
    const at = this.#stopped ?? this.#frame();
    const frame = frames[at].slice();
    const put = (name, values) => frame.set(values, place.get(name));
    if (performance.now() < this.push[3]) put("push", this.push.slice(0, 3));
    for (const [name, values] of Object.entries(this.override)) put(name, values);
    if (this.#stopped !== null) {
      put("supply", [0]);
      put("start_up", [0]);
    }
    const buffer = Buffer.alloc(16 + 4 * frame.length);
    buffer.writeUInt8(1, 0);
    buffer.writeUInt32LE(this.lost, 4);
    buffer.writeBigUInt64LE(BigInt(this.recording.ticks[at]), 8);
    Buffer.from(frame.buffer).copy(buffer, 16);
    for (const { client } of this.#sockets) if (client.readyState === 1) client.send(buffer);
  }

  #samples() {
    if (!this.robot) return;
    const now = this.#tick();
    for (const socket of this.#sockets) {
      if (socket.plot.length === 0) continue;
      if (now < socket.sent) socket.sent = now;
      const step = Math.max(1, Math.round(1000 / socket.rate));
      const ticks = [];
      for (let t = Math.ceil(socket.sent / step) * step; t < now; t += step) ticks.push(t);
      socket.sent = now;
      const columns = socket.plot.map((name) => {
        const dot = name.indexOf(".");
        const [, series] = this.recording.series.find(([topic]) => topic === name.slice(0, dot));
        return { rows: series.rows, c: series.columns.indexOf(name.slice(dot + 1)) };
      });
      const stride = 8 + 4 * columns.length;
      const buffer = Buffer.alloc(20 + stride * ticks.length);
      buffer.writeUInt8(2, 0);
      buffer.writeBigUInt64LE(BigInt(now), 8);
      buffer.writeUInt16LE(columns.length, 16);
      buffer.writeUInt16LE(ticks.length, 18);
      for (const [r, tick] of ticks.entries()) {
        buffer.writeDoubleLE(tick / 1000, 20 + r * stride);
        for (const [i, { rows, c }] of columns.entries()) buffer.writeFloatLE(rows[Math.min(tick, rows.length - 1)][c], 28 + r * stride + 4 * i);
      }
      if (socket.client.readyState === 1) socket.client.send(buffer);
    }
  }

  #slow() {
    if (!this.robot) return;
    const times = (p50) => ({ p50, p99: p50 * 3, p999: p50 * 6, max: p50 * 15 });
    // A thousand cycles about the median, fewer around it, one that was late.
    const octaves = (us) => Array.from({ length: 20 }, (_, i) => (i === 15 ? 1 : Math.floor(1000 / 10 ** Math.abs(i - Math.ceil(Math.log2(us / 1.024))))));
    const list = [["watchdog", 4], ["sim-backend", 120], ["lowlevel", 30], ["planner", 15], ["controller", 70]].map(([name, us]) => (
      { name, state: "running", degraded: false, cycles: this.#tick(), overruns: 0, skipped: 0, lateness_us: times(6), execution_us: times(us), lateness_octaves: octaves(6), execution_octaves: octaves(us) }));
    list.push({ name: "broker", state: "running", degraded: false, cycles: null, overruns: null, skipped: null, lateness_us: null, execution_us: null, lateness_octaves: null, execution_octaves: null });
    for (const socket of this.#sockets) this.#send(socket, { type: "processes", real_time_factor: 1, estimated_error: null, model: "type 2, semi_implicit", list });
  }
}

// node mock.mjs BINARY [SCENE] [PORT]: for work at the page.
if (process.argv[1] === import.meta.filename) {
  const [binary, scene = "walk_2kmh", port = "8720"] = process.argv.slice(2);
  console.log((await new Mock(binary, scene).listen(Number(port))).url);
}
