// Time bar of a recording: play, step, drag, speed, events, picture, video, link.

import { h, mark, newId, say } from "../dom.js";
import { Marks, words } from "./marks.js";

const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10];

/** Bar under the view. `hooks`: picture(), video(), link(), offset(seconds). */
export class Bar {
  marks;
  #cursor;
  #play = h("button", { type: "button", class: "play", "aria-keyshortcuts": "k" }, "Play");
  #slider = h("input", { type: "range", class: "time-slider", "aria-label": "Time in the recording" });
  #time = h("span", { class: "time-text" });
  #speed = h("select", { id: newId("speed") }, SPEEDS.map((s) => h("option", { value: s, selected: s === 1 }, `× ${s}`)));
  #offset = h("input", { id: newId("offset"), type: "number", step: "any", value: 0 });
  #offsetField;
  #video;
  #status = h("p", { class: "hint replay-status", role: "status" });
  #missing = h("p", { class: "hint replay-missing" });

  constructor(cursor, hooks) {
    this.#cursor = cursor;
    this.marks = new Marks((event) => this.#to(event));
    const button = (text, label, keys, act) => h("button", { type: "button", "aria-label": label, title: `${label} (${keys.toUpperCase()})`, "aria-keyshortcuts": keys, onclick: act }, text);
    this.#play.addEventListener("click", () => cursor.play());
    this.#slider.addEventListener("input", () => {
      cursor.playing = false;
      cursor.go(Number(this.#slider.value));
    });
    this.#speed.addEventListener("change", () => { cursor.speed = Number(this.#speed.value); });
    this.#offset.addEventListener("input", () => hooks.offset(Number(this.#offset.value.replace(",", ".")) || 0));
    this.#offsetField = h("span", { class: "choice offset", hidden: true },
      h("span", { class: "swatch layer-other", "aria-hidden": "true" }), h("label", { for: this.#offset.id }, "Other log later by"), this.#offset, h("span", { class: "unit" }, "s"));
    this.#video = h("button", { type: "button", "aria-pressed": "false", onclick: hooks.video }, "Video");
    this.element = h("section", { class: "replay-bar", "aria-label": "Recording" },
      h("div", { class: "row" },
        button("‹ event", "Event before", "p", () => this.event(-1)), button("− cycle", "One cycle back", ",", () => cursor.step(-1)), this.#play,
        button("+ cycle", "One cycle on", ".", () => cursor.step(1)), button("event ›", "Next event", "n", () => this.event(1)),
        this.#time, h("span", { class: "choice" }, h("label", { for: this.#speed.id }, "Speed"), this.#speed), this.#offsetField, h("span", { class: "spring" }),
        h("button", { type: "button", onclick: hooks.picture }, "Picture"), this.#video, h("button", { type: "button", onclick: hooks.link }, "Link")),
      h("div", { class: "time-line" }, this.marks.element, this.#slider), this.#status, this.#missing);
  }

  /** Another log: its extent, and what it lacks. */
  describe(replay) {
    const { first, last, cycle, complete, missing, other, log } = replay;
    Object.assign(this.#slider, { min: first, max: last, step: cycle });
    this.marks.extent(first, last);
    this.#offsetField.hidden = !other;
    const lacks = [...missing, ...(other?.missing ?? []).map((m) => `${other.log}: ${m}`)];
    if (!complete) lacks.unshift(`${log} has no end: it was cut, or is still being written`);
    say(this.#missing, lacks.join(" · "));
    this.#missing.hidden = lacks.length === 0;
    this.refresh();
  }

  /** Goes to the next event in a direction. */
  event(direction) {
    const event = this.marks.next(this.#cursor.time, direction, this.#cursor.cycle);
    if (event) this.#to(event);
    else this.tell(direction > 0 ? "no event after this" : "no event before this");
  }

  #to(event) {
    this.#cursor.playing = false;
    this.#cursor.go(event.time);
    this.tell(words(event));
  }

  /** A sentence under the bar, read aloud. */
  tell(text) {
    say(this.#status, text);
  }

  /** Offset as it was in the address. */
  set offset(seconds) {
    this.#offset.value = String(seconds);
  }

  /** Whether a video is being recorded. */
  set recording(on) {
    mark(this.#video, "aria-pressed", String(on));
    say(this.#video, on ? "Stop video" : "Video");
  }

  /** Brings it up to date; with the screen. */
  refresh() {
    const { time, last, playing, cycle } = this.#cursor;
    const digits = digitsOf(cycle);
    const text = `${time.toFixed(digits)} s`;
    say(this.#time, `${text} of ${last.toFixed(digits)} s`);
    say(this.#play, playing ? "Pause" : "Play");
    mark(this.#slider, "aria-valuetext", text);
    if (document.activeElement !== this.#slider || playing || Number(this.#slider.value) !== time) this.#slider.value = String(time);
  }
}

/** Digits behind the point of a time in whole cycles. */
export const digitsOf = (cycle) => Math.min(6, Math.max(3, Math.ceil(-Math.log10(cycle) - 1e-9)));
