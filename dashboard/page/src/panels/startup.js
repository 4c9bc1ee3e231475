// Start-up: from no power to walking, one button after the other.

import { h, mark, say } from "../dom.js";
import { Answer } from "../desk.js";
import { state } from "../frames.js";
import { START_UP, STEPS, nextAction } from "../words.js";

const BUTTONS = {
  power: { text: "Power on", title: "system/reset, then system/enable" },
  home: { text: "Home", title: "joint/home" },
  zero: { text: "Zero", title: "joint/zero_force" },
  lower: { text: "Lower", title: "sim/lower distance=0.3" },
  stand: { text: "Stand", title: "walk/stand" },
  walk: { text: "Walk", title: "walk/velocity at the sliders" },
};
const LOWER = 0.3; // [m] of rope: the soles hang 0.1 m over the ground in the scenes that have a crane
const EDGE_MS = 150; // between reset and enable: two edges in two cycles

/** Row of the start-up's steps; the next one is marked, and a sentence says what to do. */
export class StartUp {
  #buttons = {};
  #advice = h("p", { class: "advice", role: "status" });
  #layout = null;
  #actions;
  #answer = new Answer("Answer to the start-up");

  constructor(desk, hub, walk) {
    this.#actions = {
      power: () => this.#power(desk),
      home: () => desk.command("joint/home", {}, this.#answer),
      zero: () => desk.command("joint/zero_force", {}, this.#answer),
      lower: () => desk.command("sim/lower", { distance: LOWER }, this.#answer),
      stand: () => desk.command("walk/stand", {}, this.#answer),
      walk: () => walk.start(this.#answer),
    };
    const row = h("ol", { class: "steps" });
    for (const step of STEPS) {
      const { text, title } = BUTTONS[step];
      this.#buttons[step] = h("button", { type: "button", title, onclick: this.#actions[step] }, text);
      row.append(h("li", {}, this.#buttons[step]));
    }
    this.element = h("section", { class: "card", "aria-label": "Start-up" }, this.#advice, row, this.#answer.element);
    hub.on("layout", (layout) => { this.#layout = layout; });
    hub.on("hello", ({ commands }) => {
      const known = new Set(commands.map(({ name }) => name));
      // A real robot is lowered by hand: nothing to press.
      this.#buttons.lower.parentElement.hidden = !known.has("sim/lower");
    });
  }

  /** Does the step that comes next, as its button would; walking is left to the sticks. */
  next() {
    const { step, text } = this.#next() ?? {};
    if (step && step !== "walk") this.#actions[step]();
    else if (text) this.#answer.tell({ accepted: false, text }, "next step", state.values[this.#layout.at("time")]);
  }

  #next() {
    if (!this.#layout || state.values.length === 0) return null;
    const value = (name) => state.values[this.#layout.at(name)];
    return nextAction(value("supply"), value("start_up"), value("gait"));
  }

  /** Marks the step that comes next. */
  refresh() {
    const next = this.#next();
    if (!next) return;
    const { step, text, bad } = next;
    say(this.#advice, text);
    mark(this.#advice, "data-bad", String(bad ?? false));
    this.#advice.title = START_UP[state.values[this.#layout.at("start_up")]] ?? "";
    const at = STEPS.indexOf(step);
    for (const [i, name] of STEPS.entries()) {
      mark(this.#buttons[name], "data-step", at < 0 ? "open" : i < at ? "done" : i === at ? "next" : "open");
      if (i === at) mark(this.#buttons[name], "aria-current", "step");
      else this.#buttons[name].removeAttribute("aria-current");
    }
  }

  /** Supply on: forgets the reason for which it is off, then enables. */
  async #power(desk) {
    const reset = await desk.command("system/reset", {}, this.#answer);
    if (!reset.accepted) return;
    await new Promise((resolve) => setTimeout(resolve, EDGE_MS));
    await desk.command("system/enable", {}, this.#answer);
  }
}
