// Events of a recording as marks on its time bar.

import { h } from "../dom.js";

const NEAR = 6; // [pixels] from a mark

/** Strip of marks over the time from `first` to `last`; `chosen(event)` when one is pressed. */
export class Marks {
  events = [];
  element = h("canvas", { class: "marks", height: 10, "aria-hidden": "true" });
  #first = 0;
  #last = 1;

  constructor(chosen) {
    this.element.addEventListener("click", (click) => {
      const event = this.#under(click);
      if (event) chosen(event);
    });
    this.element.addEventListener("pointermove", (move) => {
      const event = this.#under(move);
      this.element.title = event ? words(event) : "";
      this.element.style.cursor = event ? "pointer" : "default";
    });
    new ResizeObserver(() => this.draw()).observe(this.element);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /** Takes some more events. */
  add(events) {
    this.events.push(...events);
    // Processes write each for itself, and a chunk may hold what belongs before the last one's end.
    this.events.sort((a, b) => a.time - b.time);
    this.draw();
  }

  clear() {
    this.events.length = 0;
    this.draw();
  }

  extent(first, last) {
    [this.#first, this.#last] = [first, Math.max(last, first + 1e-6)];
    this.draw();
  }

  /** The next event after `time` in direction 1, or before it in direction -1; or undefined. */
  next(time, direction, least) {
    return direction > 0 ? this.events.find((e) => e.time > time + least / 2) : this.events.findLast((e) => e.time < time - least / 2);
  }

  draw() {
    const canvas = this.element;
    const width = canvas.clientWidth;
    if (width === 0) return;
    canvas.width = width * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
    const context = canvas.getContext("2d");
    context.fillStyle = getComputedStyle(canvas).color;
    let before = -1;
    for (const { time } of this.events) {
      const x = Math.round(this.#x(time, canvas.width));
      // Where several fall on one pixel, one mark is drawn.
      if (x !== before) context.fillRect(x - 1, 0, Math.max(2, devicePixelRatio), canvas.height);
      before = x;
    }
  }

  #x(time, width) {
    return ((time - this.#first) / (this.#last - this.#first)) * width;
  }

  #under({ offsetX }) {
    const width = this.element.clientWidth;
    let [nearest, distance] = [null, NEAR];
    for (const event of this.events) {
      const d = Math.abs(this.#x(event.time, width) - offsetX);
      if (d < distance) [nearest, distance] = [event, d];
    }
    return nearest;
  }
}

/** An event in one line. */
export const words = ({ time, process, text }) => `${time.toFixed(3)} s · ${process}: ${text}`;
