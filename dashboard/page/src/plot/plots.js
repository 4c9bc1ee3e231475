// Plots: panes over one window of time, the subscription of their fields, and what is kept between visits.

import { h, mark, newId, say } from "../dom.js";
import { recall, remember } from "../store.js";
import { Pane } from "./pane.js";
import { Rings } from "./rings.js";

const MINUTES = 3;
const DRAW_MS = 80;
const MOST_FIELDS = 64;
const WINDOWS = [2, 5, 10, 30, 60, 180];
const RATES = [100, 200, 500, 1000];
const KEPT = "gangwerk.plots";
// Of a recording: rows per second, and rows of one window.
const FULL = 1000;
const MOST_ROWS = 60000;
// Fields that are looked at first; of these the ones that the robot has.
const FIRST = [
  ["sim_state.foot_wrench.right.force[2]", "sim_state.foot_wrench.left.force[2]"],
  ["controller_state.inclination_error[0]", "controller_state.inclination_error[1]"],
  ["sensors.joint_angle.right_knee_flexion", "sensors.joint_angle.left_knee_flexion"],
];

/** Panel of plots. Call `refresh` with each picture; it draws while the panel is seen. */
export class Plots {
  #link;
  #panes = [];
  #rings = null;
  #fields = [];
  #units = new Map();
  #window = 10;
  #rate = 200;
  #frozen = null;
  #place = h("div", { class: "panes" });
  #pause = h("button", { type: "button", "aria-pressed": "false" }, "Pause");
  #state = h("span", { class: "hint", role: "status" });
  #drawn = 0;
  #choice;
  /** Samples of a recording, in place of what came last. */
  #store = null;

  constructor(link, hub) {
    this.#link = link;
    this.#recall();
    this.#makeRings();
    const length = choice("Window", WINDOWS, this.#window, (s) => (s < 60 ? `${s} s` : `${s / 60} min`), (s) => { this.#window = s; this.#live(); this.#remember(); if (this.#store) this.#subscribe(); });
    const rate = choice("Rate", RATES, this.#rate, (r) => `${r} /s`, (r) => { this.#rate = r; this.#makeRings(); this.#subscribe(); this.#remember(); });
    this.#pause.addEventListener("click", () => (this.#frozen ? this.#live() : this.#freeze(...this.#span())));
    this.#choice = rate;
    this.element = h("div", { class: "panel-fill" },
      h("div", { class: "row" }, length, rate, this.#pause, h("button", { type: "button", onclick: () => this.#addPane([]) }, "Add pane"), h("span", { class: "spring" }), this.#state),
      this.#place);
    hub.on("hello", (hello) => this.#begin(hello));
    hub.on("connection", ({ state }) => { if (state !== "open") say(this.#state, ""); });
    hub.on("plotting", ({ fields, rate: sent, other, why }) => {
      (this.#store ?? this.#rings).expect(fields, other);
      say(this.#state, why ? `refused: ${why}` : fields.length ? `${fields.length} fields at ${Math.round(sent)} /s` : "");
    });
    hub.on("samples", (frame) => this.#store ?? this.#rings.take(frame));
    // Lines and axes have the colours of the scheme when they were made.
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#panes.forEach((pane) => pane.rebuild()));
  }

  /** Plots a recording from now on: the window lies around its cursor, at the full rate as far as it is not too long. */
  replay(store) {
    this.#store = store;
    this.#choice.hidden = true;
    for (const pane of this.#panes) pane.rebuild();
    this.#subscribe();
  }

  /** Draws the panes if their time has come. */
  refresh(now) {
    if (now - this.#drawn < DRAW_MS || this.element.offsetParent === null) return;
    this.#drawn = now;
    const [from, to] = this.#frozen ?? this.#span();
    if (!Number.isFinite(to)) return;
    this.#store?.want(from, to, now);
    for (const pane of this.#panes) pane.draw(this.#store ?? this.#rings, from, to);
  }

  #begin({ fields, run }) {
    this.#fields = fields;
    this.#units = new Map(fields.map(({ name, unit }) => [name, unit]));
    if (run !== this.#run) this.#rings.clear();
    this.#run = run;
    if (this.#panes.length === 0) {
      const kept = this.#kept ?? FIRST;
      for (const names of kept) {
        const known = names.filter((name) => this.#units.has(name));
        if (known.length || names.length === 0) this.#addPane(known);
      }
      if (this.#panes.length === 0) this.#addPane([]);
    }
    this.#subscribe();
    this.#live();
  }

  #run;
  #kept = null;

  #addPane(fields) {
    const pane = new Pane(fields, {
      fields: () => this.#fields,
      store: () => this.#store,
      unit: (name) => this.#units.get(name) ?? "",
      changed: () => { this.#subscribe(); this.#remember(); },
      remove: () => {
        this.#panes.splice(this.#panes.indexOf(pane), 1);
        pane.element.remove();
        this.#subscribe();
        this.#remember();
      },
      zoomed: (from, to) => this.#freeze(from, to),
      unzoomed: () => this.#live(),
    });
    this.#panes.push(pane);
    this.#place.append(pane.element);
    this.#remember();
  }

  /** All fields of all panes, each once; those that this robot does not have are left out. */
  #subscribe() {
    const wanted = [...new Set(this.#panes.flatMap(({ fields }) => fields))].filter((name) => this.#units.has(name)).slice(0, MOST_FIELDS);
    (this.#store ?? this.#rings).keep(wanted);
    const rate = this.#store ? Math.min(FULL, MOST_ROWS / this.#window) : this.#rate;
    this.#link.send({ type: "plot", fields: wanted, rate });
  }

  #makeRings() {
    this.#rings = new Rings(MINUTES * 60 * this.#rate);
  }

  #span() {
    if (this.#store) return this.#store.span(this.#window);
    // Until the window is full it fills from the left.
    const from = Math.max(this.#rings.oldest, this.#rings.newest - this.#window);
    return [from, from + this.#window];
  }

  #freeze(from, to) {
    this.#frozen = [from, to];
    say(this.#pause, "Live");
    this.#pause.setAttribute("aria-pressed", "true");
  }

  #live() {
    this.#frozen = null;
    say(this.#pause, "Pause");
    this.#pause.setAttribute("aria-pressed", "false");
  }

  #remember() {
    remember("localStorage", KEPT, JSON.stringify({ panes: this.#panes.map(({ fields }) => fields), window: this.#window, rate: this.#rate }));
  }

  /** What was looked at on the last visit; a text that is none of ours is forgotten. */
  #recall() {
    try {
      const { panes, window: seconds, rate } = JSON.parse(recall("localStorage", KEPT) ?? "{}");
      if (WINDOWS.includes(seconds)) this.#window = seconds;
      if (RATES.includes(rate)) this.#rate = rate;
      if (Array.isArray(panes) && panes.length && panes.every((p) => Array.isArray(p))) this.#kept = panes;
    } catch {
      // The next change writes over it.
    }
  }
}

/** Choice of one of some numbers, a button each: a list that opens would keep the space bar from the emergency stop. */
function choice(label, values, now, words, chosen) {
  const id = newId("choice");
  const buttons = values.map((v) => h("button", { type: "button", class: "toggle", "aria-pressed": String(v === now), onclick: () => {
    for (const [i, button] of buttons.entries()) mark(button, "aria-pressed", String(values[i] === v));
    chosen(v);
  } }, words(v)));
  return h("span", { class: "choice", role: "group", "aria-labelledby": id }, h("span", { id }, label), buttons);
}
