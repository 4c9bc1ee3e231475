// Replay: what makes the page that of a recording. Nothing of it is seen while a robot runs.

import { h } from "../dom.js";
import { Layout } from "../layout.js";
import { readAddress, writeAddress } from "./address.js";
import { Bar, digitsOf } from "./bar.js";
import { Cursor } from "./cursor.js";
import { OtherBody } from "./ghost.js";
import { Video, savePicture } from "./shots.js";
import { Store, Tiles } from "./tiles.js";

const SETTLED_MS = 400; // without a change, until the address tells the instant
const JUMP = 1; // [s] by keys

/** Fields that keep the keys of the recording for themselves. */
const writes = (element) => element instanceof HTMLTextAreaElement || element instanceof HTMLSelectElement || (element instanceof HTMLInputElement && element.type !== "range");

/** Recording of a page; `on` once the server shows one. */
export class Replay {
  on = false;
  cursor;
  video = new Video();
  tiles = [];
  #bar;
  #link;
  #hub;
  #view = null;
  #canvas;
  #other = null;
  #replay = null;
  #settles = 0;

  constructor(link, hub, canvas) {
    this.#link = link;
    this.#hub = hub;
    this.#canvas = canvas;
    this.cursor = new Cursor((time, other) => this.#link.send(this.#replay?.other ? { type: "seek", time, other } : { type: "seek", time }), () => this.#settle());
    this.#bar = new Bar(this.cursor, { picture: () => this.picture(), video: () => this.record(), link: () => this.#copy(), offset: (s) => this.#setOffset(s) });
    hub.on("connection", ({ state }) => state !== "open" && this.cursor.forget());
    hub.on("state", () => this.cursor.answered());
    hub.on("recorded", (replay) => this.on && this.#grown(replay));
    hub.on("events", ({ events }) => {
      if (!this.on) return;
      this.#bar.marks.add(events);
      // The list of events keeps as many as a person reads.
      for (const event of events.slice(-500)) hub.say("event", event);
    });
    hub.on("samples", (frame) => this.tiles[0]?.take(frame));
    hub.on("other-samples", (frame) => this.tiles[1]?.take(frame));
    hub.on("window", (message) => this.tiles[message.log]?.done(message));
    window.addEventListener("keydown", (event) => this.on && this.#key(event));
    window.addEventListener("hashchange", () => this.on && this.#open());
  }

  /** Begins to show the recording of a `hello`; false: a robot runs. */
  begin(hello, { view, plots, header, stop }) {
    const { replay } = hello;
    if (!replay) return false;
    this.#replay = replay;
    this.#view = view;
    this.cursor.extent(replay);
    this.cursor.forget();
    this.#bar.marks.clear();
    this.#bar.describe(replay);
    if (this.on) return true;
    this.on = true;
    document.body.dataset.mode = "replay";
    document.body.append(this.#bar.element);
    header.recording = replay.other ? `${replay.log} · ${replay.other.log}` : replay.log;
    // Nothing here moves a robot, and everything that would says so.
    stop.button.replaceChildren(h("strong", {}, "RECORDING"), h("span", {}, "no robot to stop"));
    stop.button.disabled = true;
    for (const panel of document.querySelectorAll(".panel-steer, .panel-tune")) {
      const steer = panel.classList.contains("panel-steer");
      for (const child of panel.children) if (steer) child.inert = true;
      // It scrolls all the same, and the keyboard must come to it.
      if (steer) panel.tabIndex = 0;
      panel.prepend(h("p", { class: "card recording" }, steer ? "This is a recording: there is no robot to steer." : "This is a recording: values are those of its configuration, and cannot be set."));
    }
    const span = (log) => () => (log === 0 ? this.#replay : this.#replay.other);
    this.tiles = [new Tiles(this.#link, 0, span(0), replay.cycle)];
    if (replay.other) {
      this.tiles.push(new Tiles(this.#link, 1, span(1), replay.other.cycle));
      this.#other = new OtherBody(new Layout(replay.other.state), hello.robot.joints.map(({ name }) => name));
    }
    plots.replay(new Store(this.tiles, this.cursor));
    this.#open();
    return true;
  }

  /** The scene of the view was made. */
  built(scene, bodies, theme) {
    this.#other?.build(scene, bodies, theme);
  }

  /** Poses the robot of the other log; whether something changed. */
  posed() {
    return this.#other?.pose() ?? false;
  }

  /** With the screen. */
  refresh(now) {
    if (!this.on) return;
    const wasPlaying = this.cursor.playing;
    this.cursor.tick(now);
    if (wasPlaying && !this.cursor.playing) this.#stopVideo();
    this.#bar.refresh();
    if (this.#settles && now > this.#settles && !this.cursor.playing) {
      this.#settles = 0;
      history.replaceState(null, "", this.address);
    }
  }

  /** Address that opens the recording at this instant. */
  get address() {
    const { token } = readAddress(location.hash);
    return writeAddress({ token, time: this.cursor.time, offset: this.cursor.offset }, digitsOf(this.cursor.cycle));
  }

  /** Body of the other log, for checks. */
  get other() {
    return this.#other?.body ?? null;
  }

  /** Saves what the view shows. */
  async picture() {
    try {
      const bytes = await savePicture(this.#view, this.#name());
      this.#bar.tell(`picture saved: ${Math.round(bytes / 1000)} kB`);
    } catch (error) {
      this.#bar.tell(error.message);
    }
  }

  /** Begins a video, which plays on from the cursor; or ends it. */
  record() {
    if (this.video.running) return this.#stopVideo();
    try {
      this.video.begin(this.#canvas, this.#name(), (bytes) => this.#bar.tell(`video saved: ${Math.round(bytes / 1000)} kB`));
      this.cursor.play(true);
      this.#bar.recording = true;
      this.#bar.tell("recording a video; it ends with the log, or when it is stopped");
    } catch (error) {
      this.#bar.tell(error.message);
    }
  }

  #stopVideo() {
    if (!this.video.running) return;
    this.video.end();
    this.cursor.play(false);
    this.#bar.recording = false;
  }

  #name() {
    return `${this.#replay.log.replace(/\.mcap$/, "")}-${this.cursor.time.toFixed(3)}s`;
  }

  #setOffset(seconds) {
    this.cursor.offset = seconds;
    this.#settle();
  }

  async #copy() {
    history.replaceState(null, "", this.address);
    const told = `this address opens the recording at ${this.cursor.time.toFixed(digitsOf(this.cursor.cycle))} s while this server runs`;
    // Without a right to the clipboard the address bar has it.
    const copied = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
    this.#bar.tell(copied ? `copied: ${told}` : told);
  }

  /** Instant of the address, or the beginning. */
  #open() {
    const { time, offset } = readAddress(location.hash);
    this.cursor.offset = this.#replay.other ? offset : 0;
    this.#bar.offset = this.cursor.offset;
    this.cursor.go(Number.isFinite(time) ? time : this.#replay.first);
  }

  #grown(replay) {
    this.tiles[0]?.grown(this.#replay.last);
    if (this.#replay.other) this.tiles[1]?.grown(this.#replay.other.last);
    this.#replay = replay;
    this.cursor.extent(replay);
    this.#bar.describe(replay);
  }

  #settle() {
    this.#settles = performance.now() + SETTLED_MS;
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || writes(event.target)) return;
    const act = {
      k: () => this.cursor.play(), ",": () => this.cursor.step(-1), ".": () => this.cursor.step(1),
      j: () => this.cursor.go(this.cursor.time - JUMP), l: () => this.cursor.go(this.cursor.time + JUMP),
      n: () => this.#bar.event(1), p: () => this.#bar.event(-1),
    }[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act();
  }
}
