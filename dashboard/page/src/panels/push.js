// Pushes by numbers: what a drag on the body does, for the keyboard.

import { h } from "../dom.js";
import { Answer } from "../desk.js";
import { fixed } from "../numbers.js";
import { commandForm } from "./commands.js";

const tenths = (force) => force.toArray().map((v) => Math.round(v * 10) / 10);

/** Form of sim/push, and the duration that drags use. */
export class Push {
  answer = new Answer("Answer to the push by dragging");
  possible = false;
  #desk;
  #place = h("div");
  #card;

  constructor(desk, hub) {
    this.#desk = desk;
    this.#card = h("section", { class: "card", "aria-labelledby": "push-title" },
      h("div", { class: "card-head" }, h("h2", { id: "push-title" }, "Push"), h("span", { class: "hint" }, "or drag on her body; Shift: upwards")),
      this.answer.element, this.#place);
    this.element = this.#card;
    hub.on("hello", ({ commands, scene }) => {
      const command = commands.find(({ name }) => name === "sim/push");
      this.possible = Boolean(command) && scene.simulated !== false;
      this.#card.hidden = !this.possible;
      if (!this.possible) return;
      this.#place.replaceChildren(commandForm(desk, command, { title: "By numbers", button: "Push", suggested: { "force.y": 40, duration: 0.1 } }));
    });
  }

  /** Duration [s] of a push by dragging: that of the form. */
  get duration() {
    const field = [...this.#place.querySelectorAll(".field")].at(-1)?.querySelector("input");
    const seconds = Number(field?.value);
    return seconds > 0 ? seconds : 0.1;
  }

  /** Pushes with a force [N] in the world. */
  send(force) {
    const [x, y, z] = tenths(force);
    this.#desk.command("sim/push", { "force.x": x, "force.y": y, "force.z": z, duration: this.duration }, this.answer);
  }

  /** Words for a force that is being drawn: for what `send` would send, to the last digit. */
  words(force) {
    const n = Math.hypot(...tenths(force));
    return `${fixed(n, 0)} N × ${fixed(this.duration, 2)} s = ${fixed(n * this.duration, 1)} N s`;
  }
}
