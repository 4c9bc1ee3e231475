// Tuning: parameters of all processes, with search, undo and a gait file to keep what was found.

import { h, mark, newId, say, toggle } from "../dom.js";
import { Answer } from "../desk.js";
import { exact, range, unitOf } from "../numbers.js";
import { gaitFile } from "./gait_file.js";

/** Table of parameters. */
export class Tune {
  #desk;
  #rows = new Map();
  #body = h("div", { class: "parameters" });
  #search = h("input", { id: newId("search"), type: "search", placeholder: "name, unit or meaning", autocomplete: "off", spellcheck: "false" });
  #answer = new Answer("Answer to undo and reset");
  #count = h("span", { class: "hint", role: "status" });
  #undo = h("button", { type: "button" }, "Undo");
  #resetAll = h("button", { type: "button" }, "Reset all");
  #save = h("button", { type: "button" }, "Save as gait file");
  #done = [];
  #only = { live: true, changed: false };
  #about = "";

  constructor(desk, hub) {
    this.#desk = desk;
    this.#search.addEventListener("input", () => this.#filter());
    this.#undo.addEventListener("click", () => this.#takeBack());
    this.#resetAll.addEventListener("click", () => this.#reset([...this.#rows.values()].filter(changed)));
    this.#save.addEventListener("click", () => this.#download());
    this.element = h("div", { class: "panel-fill" },
      h("div", { class: "filter" }, h("label", { for: this.#search.id }, "Search"), this.#search, this.#count),
      h("div", { class: "row" },
        toggle("Can be set", true, (on) => { this.#only.live = on; this.#filter(); }),
        toggle("Changed", false, (on) => { this.#only.changed = on; this.#filter(); }),
        h("span", { class: "spring" }), this.#undo, this.#resetAll, this.#save),
      this.#answer.element, this.#body);
    hub.on("hello", (hello) => this.#build(hello));
    hub.on("parameter", ({ name, value }) => this.#take(name, value));
    this.#buttons();
  }

  #build({ parameters, robot, scene }) {
    this.#about = `Found on ${robot.name} in scene ${scene.name}: copy these lines over those of the gait file.`;
    this.#rows.clear();
    this.#done.length = 0;
    this.#body.replaceChildren();
    let process = "";
    for (const parameter of parameters) {
      const of = parameter.name.slice(0, parameter.name.indexOf("."));
      if (of !== process) {
        process = of;
        this.#body.append(h("h3", { class: "process" }, of));
      }
      const row = this.#row(parameter, of);
      this.#rows.set(parameter.name, row);
      this.#body.append(row.element);
    }
    this.#filter();
    this.#buttons();
  }

  #row(parameter, process) {
    const { name, unit, low, high, default: usual, value, change, about } = parameter;
    const id = newId("parameter");
    const live = change === "live";
    const answer = new Answer(`Answer to ${name}`);
    const input = h("input", { id, type: "number", step: "any", value: exact(value), inputmode: "decimal", readonly: !live, "aria-describedby": `${id}-about` });
    const reset = h("button", { type: "button", class: "quiet small", "aria-label": `Reset ${name} to ${exact(usual ?? value)}` }, "Reset");
    const row = { ...parameter, process, live, input, reset, answer, words: `${name} ${unit} ${about}`.toLowerCase() };
    const commit = () => this.#commit(row);
    input.addEventListener("change", commit);
    reset.addEventListener("click", () => this.#reset([row]));
    row.element = h("div", { class: "parameter", "data-live": String(live) },
      h("label", { for: id }, h("span", { class: "dot", "aria-hidden": "true" }), name.slice(process.length + 1)),
      h("span", { class: "value" }, input, h("span", { class: "unit" }, unitOf(unit))), live ? reset : h("span", { class: "hint" }, change),
      h("span", { id: `${id}-about`, class: "hint wide" }, `${about} · ${range(low, high, "")} · default ${exact(usual ?? value)}`),
      answer.element);
    this.#mark(row);
    return row;
  }

  async #commit(row) {
    const value = Number(row.input.value);
    if (row.input.value.trim() === "" || !Number.isFinite(value)) {
      row.input.value = exact(row.value);
      return;
    }
    if (value === row.value) return;
    await this.#send(row, value, row.answer, true);
  }

  /** Sends a value; what is refused stands in its field as before. `remember`: undo can take it back. */
  async #send(row, value, answer, remember) {
    const before = row.value;
    const { accepted } = await this.#desk.set(row.name, value, answer);
    if (accepted) {
      if (remember) this.#done.push({ name: row.name, value: before });
      this.#take(row.name, value);
    } else row.input.value = exact(row.value);
    this.#buttons();
    return accepted;
  }

  async #takeBack() {
    const last = this.#done.pop();
    if (last && !(await this.#send(this.#rows.get(last.name), last.value, this.#answer, false))) this.#done.push(last);
    this.#buttons();
  }

  async #reset(rows) {
    for (const row of rows) {
      if (row.live && changed(row) && !(await this.#send(row, row.default, rows.length > 1 ? this.#answer : row.answer, true))) return;
    }
  }

  /** Value as the robot has it now, whoever set it. */
  #take(name, value) {
    const row = this.#rows.get(name);
    if (!row) return;
    row.value = value;
    // Typing is not interrupted.
    if (document.activeElement !== row.input || Number(row.input.value) === value) row.input.value = exact(value);
    this.#mark(row);
    this.#filter();
    this.#buttons();
  }

  #mark(row) {
    mark(row.element, "data-changed", String(changed(row)));
    row.reset.disabled = !changed(row);
  }

  #buttons() {
    this.#undo.disabled = this.#done.length === 0;
    const any = [...this.#rows.values()].some(changed);
    this.#resetAll.disabled = this.#save.disabled = !any;
  }

  #filter() {
    const wanted = this.#search.value.trim().toLowerCase();
    let shown = 0;
    const processes = new Set();
    for (const row of this.#rows.values()) {
      const fits = row.words.includes(wanted) && (!this.#only.live || row.live) && (!this.#only.changed || changed(row));
      row.element.hidden = !fits;
      if (fits) {
        shown++;
        processes.add(row.process);
      }
    }
    for (const title of this.#body.querySelectorAll(".process")) title.hidden = !processes.has(title.textContent);
    say(this.#count, `${shown} of ${this.#rows.size}`);
  }

  #download() {
    const text = gaitFile([...this.#rows.values()].filter(({ live }) => live), this.#about);
    const url = URL.createObjectURL(new Blob([text], { type: "application/toml" }));
    const link = h("a", { href: url, download: "gait_changes.toml" });
    link.click();
    URL.revokeObjectURL(url);
  }
}

/** A value that is not the one of the configuration; f32 rounding on the way is no change. */
const changed = ({ value, default: usual }) => usual !== null && usual !== undefined && Math.abs(value - usual) > 1e-6 * Math.max(1e-6, Math.abs(usual));
