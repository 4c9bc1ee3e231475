// Walking: speed, sideways and turn by sliders that act at once; stop.

import { h, newId, say } from "../dom.js";
import { Answer } from "../desk.js";
import { fixed, range } from "../numbers.js";

const EVERY_MS = 100; // a slider that moves sends no oftener

const SLIDERS = [
  { name: "forward", label: "Forward", unit: "m/s", low: "back", high: "ahead" },
  { name: "left", label: "Sideways", unit: "m/s", low: "right", high: "left", flip: true },
  { name: "turn", label: "Turn", unit: "rad/s", low: "right", high: "left", flip: true },
];

/** Sliders of walk/velocity. */
export class Walk {
  #desk;
  #sliders = {};
  #answer = new Answer("Answer to walking");
  #timer = 0;
  #sent = 0;
  #spot = 0; // [s] a step on the spot
  #order = 0; // count of what a step on the spot must not undo: velocities, stops, halts

  constructor(desk, hub) {
    this.#desk = desk;
    const rows = SLIDERS.map((about) => this.#row(about));
    this.element = h("section", { class: "card", "aria-labelledby": "walk-title" },
      h("div", { class: "card-head" }, h("h2", { id: "walk-title" }, "Walk"),
        h("button", { type: "button", class: "halt", onclick: () => this.stop() }, "Stop walking")),
      rows, this.#answer.element);
    hub.on("hello", (hello) => this.#fit(hello));
    // Without the lease this page moves nothing: sliders that still showed a speed would be wrong.
    let mine = false;
    hub.on("lease", (lease) => {
      if (mine && !lease.mine) this.#rest();
      mine = lease.mine;
    });
    hub.on("connection", ({ state }) => {
      if (state === "lost") this.#rest();
    });
    hub.on("halt", () => this.#rest());
    // The planner counts the silence of who steers by its own clock, and may stop her before the broker takes the lease.
    hub.on("event", ({ name, text, time }) => {
      if (name !== "LeaseLost" || !mine) return;
      this.#rest();
      this.#answer.tell({ accepted: false, text }, "walk", time);
    });
  }

  /** Walks at the speed of the sliders; from standing sliders at a fifth of the greatest speed. */
  start(answer) {
    const { forward, left, turn } = this.#sliders;
    if ([forward, left, turn].every(({ input }) => Number(input.value) === 0)) {
      forward.input.value = String(Math.round((Number(forward.input.max) / 5) * 100) / 100);
      this.#show(forward);
    }
    return this.#send(answer ?? this.#answer);
  }

  /** Comes to a stand: sliders to zero. */
  stop() {
    this.#rest();
    return this.#desk.command("walk/stop", {}, this.#answer);
  }

  /** Walks at these velocities; the sliders go with them. */
  steer(values) {
    for (const [name, value] of Object.entries(values)) {
      this.#sliders[name].input.value = String(value);
      this.#show(this.#sliders[name]);
    }
    this.#soon();
  }

  /** Walks in place, unless something else came before the step was accepted. */
  async onTheSpot() {
    this.#rest();
    const order = this.#order;
    const { accepted } = await this.#desk.command("walk/step", { length: 0, side: 0, turn: 0, duration: this.#spot }, this.#answer);
    if (accepted && order === this.#order) await this.#desk.command("walk/start", {}, this.#answer);
  }

  /** Takes the walking pose. */
  stand() {
    return this.#desk.command("walk/stand", {}, this.#answer);
  }

  /** Takes the lease from nobody. */
  lease() {
    return this.#desk.lease({ take: true, over: false }, this.#answer);
  }

  /** Gives the lease back: that stops a walk of this page, and nobody else's. */
  giveUp() {
    this.#rest();
    return this.#desk.lease({ give: true });
  }

  /** Says why nothing is sent. */
  tell(text) {
    this.#answer.tell({ accepted: false, text }, "gamepad", this.#desk.time);
  }

  /** Sliders to zero without a command. */
  #rest() {
    this.#order++;
    clearTimeout(this.#timer);
    for (const slider of Object.values(this.#sliders)) {
      slider.input.value = "0";
      this.#show(slider);
    }
  }

  #row({ name, label, unit, low, high, flip }) {
    const id = newId("slider");
    const input = h("input", { id, type: "range", min: -1, max: 1, step: 0.01, value: 0, class: flip ? "flip" : "" });
    const slider = { name, label, unit, input, value: h("output", { for: id, class: "slider-value" }), ends: h("span", { class: "ends" }), low, high, flip };
    this.#sliders[name] = slider;
    input.addEventListener("input", () => {
      this.#show(slider);
      this.#soon();
    });
    const zero = h("button", { type: "button", class: "quiet small", title: `${label} to zero`, "aria-label": `0: ${label} to zero` }, "0");
    zero.addEventListener("click", () => {
      input.value = "0";
      this.#show(slider);
      this.#soon();
    });
    this.#show(slider);
    return h("div", { class: "slider" }, h("label", { for: id }, label), input, slider.value, zero, slider.ends);
  }

  /** Ranges of the gait, within those of the command. */
  #fit({ commands, gait }) {
    const velocity = commands.find(({ name }) => name === "walk/velocity");
    if (!velocity) return;
    this.#spot = gait.on_the_spot;
    for (const field of velocity.fields) {
      const slider = this.#sliders[field.name];
      if (!slider) continue;
      const [least, most] = gait.velocity[field.name];
      slider.input.min = String(least);
      slider.input.max = String(most);
      slider.input.step = "0.01";
      // Notch of the track at zero.
      const zero = (0 - least) / (most - least);
      slider.input.style.setProperty("--zero", `${100 * (slider.flip ? 1 - zero : zero)}%`);
      slider.about = field.about;
      say(slider.ends, `${range(least, most, slider.unit)} · ${slider.flip ? `${slider.high} ↔ ${slider.low}` : `${slider.low} ↔ ${slider.high}`}`);
      this.#show(slider);
    }
  }

  #show({ input, value, unit, label }) {
    say(value, `${fixed(Number(input.value), 2)} ${unit}`);
    input.setAttribute("aria-valuetext", `${label} ${input.value} ${unit}`);
  }

  /** Sends soon: at once after a rest, else at the end of the present interval, so that the last value is always sent. */
  #soon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#send(this.#answer), Math.max(0, this.#sent + EVERY_MS - performance.now()));
  }

  #send(answer) {
    this.#order++;
    this.#sent = performance.now();
    const values = {};
    for (const { name, input } of Object.values(this.#sliders)) values[name] = Number(input.value);
    return this.#desk.command("walk/velocity", values, answer);
  }
}
