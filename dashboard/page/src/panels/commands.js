// Form of a command: its fields with unit, range and default, its button, its answer.

import { h, newId } from "../dom.js";
import { Answer } from "../desk.js";
import { range, unitOf } from "../numbers.js";

/** Form of one command as `hello` describes it. `suggested`: values that stand in the fields at first. */
export function commandForm(desk, command, { title, button = "Send", suggested = {} } = {}) {
  const answer = new Answer(`Answer to ${command.name}`);
  const inputs = command.fields.map((field) => numberField(field, suggested[field.name]));
  const form = h("form", { class: "command", novalidate: true, "aria-label": command.name },
    h("div", { class: "command-head" }, h("h3", { title: command.about }, title ?? command.name),
      h("button", { type: "submit" }, button)),
    command.fields.length ? h("div", { class: "fields" }, inputs.map(({ row }) => row)) : null,
    answer.element);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const values = {};
    // A field that is left empty keeps the command's default; without one the server says that it is missing.
    for (const { name, input } of inputs) if (input.value.trim() !== "") values[name] = Number(input.value.replace(",", "."));
    desk.command(command.name, values, answer);
  });
  return form;
}

function numberField({ name, unit, low, high, default: usual, about }, suggested) {
  const id = newId("field");
  const hint = newId("hint");
  const value = suggested ?? usual ?? "";
  const input = h("input", { id, type: "number", step: "any", value, inputmode: "decimal", "aria-describedby": hint, required: usual === null });
  const row = h("div", { class: "field" },
    h("label", { for: id, title: about ?? "" }, name, unitOf(unit) ? h("span", { class: "unit" }, ` ${unitOf(unit)}`) : null),
    input, h("span", { id: hint, class: "hint" }, range(low, high, "")));
  return { name, input, row };
}

/** All commands but those that have a place of their own. */
export class Commands {
  #desk;
  #fine = h("div", { class: "stack" });
  #rest = h("div", { class: "stack" });

  constructor(desk, hub) {
    this.#desk = desk;
    this.element = h("div", { class: "stack" },
      fold("Steps and distances", this.#fine), fold("Other commands", this.#rest));
    hub.on("hello", ({ commands }) => this.#build(commands));
  }

  #build(commands) {
    const fine = ["walk/step", "walk/distance", "walk/platform"];
    const own = new Set([...fine, "walk/velocity", "walk/stop", "system/emergency_stop", "sim/push", "walk/parameter", "stabilize/parameter"]);
    const suggested = {
      "walk/step": { length: 0.2, duration: 0.8 }, "walk/distance": { distance: 1, speed: 0.3 },
      "walk/platform": { distance: 0.5, height: 0.1 }, "sim/lower": { distance: 0.3 }, "head/fixate": { x: 4, y: 0, z: 1 },
    };
    const form = (command) => commandForm(this.#desk, command, { suggested: suggested[command.name] });
    this.#fine.replaceChildren(...commands.filter(({ name }) => fine.includes(name)).map(form));
    this.#rest.replaceChildren(...commands.filter(({ name }) => !own.has(name)).map(form));
  }
}

/** Part of a panel that opens and closes. */
export function fold(title, content, open = false) {
  return h("details", { class: "card fold", open }, h("summary", {}, title), content);
}
