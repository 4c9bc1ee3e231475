// Machine: how the processes keep their cycles, and how the joints are.

import { h, mark, say } from "../dom.js";
import { state } from "../frames.js";
import { fixed, short } from "../numbers.js";

// Octaves of the server's counts: the first one ends at 1.024 us, the last one is open.
const OCTAVES = 20;
const FIRST_END = 1.024; // us
// Axis of times, logarithmic: an octave is a column.
const [FROM, TO] = [Math.log10(FIRST_END / 2), Math.log10(FIRST_END * 2 ** (OCTAVES - 1))];
const MARKS = [[0, "1 µs"], [1, "10"], [2, "100"], [3, "1 ms"], [4, "10"], [5, "100"]];
const QUANTILES = [["p50", 0.5], ["p99", 0.99], ["p999", 0.999], ["max", 1]];

/** Place [%] of a time [us] on the axis. */
const place = (us) => Math.min(100, Math.max(0, ((Math.log10(Math.max(us, 1e-3)) - FROM) / (TO - FROM)) * 100));

/** Processes and joints. */
export class Machine {
  #processes = h("div", { class: "processes" });
  #rows = new Map();
  #summary = h("p", { class: "hint", role: "status" });
  #joints = h("tbody");
  #jointRows = [];
  #layout = null;

  constructor(hub) {
    const axis = h("div", { class: "time-axis", "aria-hidden": "true" }, MARKS.map(([x, text]) => h("span", { style: `left:${place(10 ** x)}%` }, text)));
    this.element = h("div", { class: "stack" },
      h("section", { class: "card", "aria-labelledby": "cycles-title" },
        h("h2", { id: "cycles-title" }, "Cycles"), this.#summary,
        h("p", { class: "legend" }, h("span", { class: "key execution" }), "execution ", h("span", { class: "key lateness" }), "lateness · columns: cycles by octaves, logarithmic; bars: half, 99 %, 99.9 %, all of the cycles are below"),
        this.#processes, axis),
      h("section", { class: "card", "aria-labelledby": "joints-title" },
        h("h2", { id: "joints-title" }, "Joints"),
        h("div", { class: "scroll", tabindex: 0, role: "region", "aria-labelledby": "joints-title" },
          h("table", {}, h("thead", {}, h("tr", {}, ["Joint", "Angle", "Range", "Error", "Temp.", "Drive"].map((t) => h("th", { scope: "col" }, t)))), this.#joints))));
    hub.on("layout", (layout) => { this.#layout = layout; });
    hub.on("hello", ({ robot }) => this.#build(robot.joints));
    hub.on("processes", (message) => this.#take(message));
  }

  #build(joints) {
    this.#jointRows = joints.map(({ name, low, high }) => {
      const cells = { angle: h("td", { class: "number" }), error: h("td", { class: "number" }), temperature: h("td", { class: "number" }), drive: h("td", { class: "number" }) };
      const needle = h("span", { class: "needle" });
      const title = `${fixed(low * 57.29578, 0)}° … ${fixed(high * 57.29578, 0)}°`;
      const element = h("tr", {}, h("th", { scope: "row" }, name.replaceAll("_", " ")), cells.angle, h("td", {}, h("span", { class: "track", title }, needle)), cells.error, cells.temperature, cells.drive);
      return { ...cells, needle, low, high, element };
    });
    this.#joints.replaceChildren(...this.#jointRows.map(({ element }) => element));
  }

  /** Joints by the newest state; call it a few times per second while the panel is seen. */
  refresh() {
    const layout = this.#layout;
    if (!layout || state.values.length === 0) return;
    const [angle, error, temperature, drive] = ["joint_angle", "tracking_error", "temperature", "drive_error"].map((part) => layout.at(part));
    const value = (at, i) => (at < 0 ? NaN : state.values[at + i]);
    for (const [i, row] of this.#jointRows.entries()) {
      const a = value(angle, i);
      say(row.angle, Number.isFinite(a) ? `${fixed(a * 57.29578, 1)}°` : "–");
      const share = (a - row.low) / (row.high - row.low);
      if (Number.isFinite(share)) row.needle.style.left = `${Math.min(100, Math.max(0, share * 100)).toFixed(1)}%`;
      mark(row.needle, "data-near", String(share < 0.03 || share > 0.97));
      const e = value(error, i);
      say(row.error, Number.isFinite(e) ? `${fixed(e * 57.29578, 2)}°` : "–");
      const t = value(temperature, i);
      say(row.temperature, Number.isFinite(t) ? `${fixed(t, 0)} °C` : "–");
      const fault = value(drive, i);
      say(row.drive, !Number.isFinite(fault) ? "–" : fault === 0 ? "ok" : `fault ${fault.toString(16)}`);
      mark(row.element, "data-fault", String(Number.isFinite(fault) && fault !== 0));
    }
  }

  #take({ list, real_time_factor: factor, estimated_error: error, model }) {
    const parts = [];
    if (model) parts.push(model);
    if (factor !== null && factor !== undefined) parts.push(`${fixed(factor, 2)} × real time`);
    if (error !== null && error !== undefined) parts.push(`estimated error ${short(error)} of the tolerance`);
    say(this.#summary, parts.join(" · "));
    for (const process of list) this.#show(process);
  }

  #show(process) {
    let row = this.#rows.get(process.name);
    if (!row) {
      row = { name: h("span", { class: "process-name" }), numbers: h("span", { class: "hint" }), execution: strip("execution"), lateness: strip("lateness"), columns: ["execution", "lateness"].map((kind) => [kind, columns(kind)]) };
      row.element = h("div", { class: "process-row" }, h("div", { class: "process-head" }, row.name, row.numbers), row.columns.map(([kind, { element }]) => [element, row[kind].element]).flat());
      this.#rows.set(process.name, row);
      this.#processes.append(row.element);
    }
    say(row.name, process.name);
    mark(row.element, "data-state", process.state);
    const cycles = process.cycles ?? null;
    const parts = [process.state === "running" ? "" : process.state, process.degraded ? "no real-time priority" : "",
      cycles === null ? "" : `${cycles} cycles`, process.overruns ? `${process.overruns} late` : "", process.skipped ? `${process.skipped} skipped` : ""];
    say(row.numbers, parts.filter(Boolean).join(" · "));
    row.execution.show(process.execution_us, "execution");
    row.lateness.show(process.lateness_us, "lateness");
    for (const [kind, { show }] of row.columns) show(process[`${kind}_octaves`]);
  }
}

/** Cycles by octaves of their times: a column each, its height the logarithm of its count. */
function columns(kind) {
  const bars = Array.from({ length: OCTAVES }, () => h("span"));
  const element = h("div", { class: `columns ${kind}`, role: "img" }, bars);
  return {
    element,
    show(counts) {
      element.hidden = !counts;
      if (!counts) return;
      const most = Math.max(1, ...counts);
      // One cycle is seen beside a million.
      for (const [i, bar] of bars.entries()) bar.style.height = `${((100 * Math.log10(1 + 9 * counts[i])) / Math.log10(1 + 9 * most)).toFixed(1)}%`;
      const words = counts.map((count, i) => (count ? `${count} ${i < OCTAVES - 1 ? `below ${short(FIRST_END * 2 ** i)} µs` : "longer"}` : "")).filter(Boolean);
      mark(element, "aria-label", `cycles by octaves of ${kind}: ${words.join(", ")}`);
      element.title = element.getAttribute("aria-label");
    },
  };
}

/** Distribution of times as far as four quantiles tell it: a bar to each of them, the fainter the rarer. */
function strip(kind) {
  const bars = QUANTILES.map(() => h("span", { class: "bar" }));
  const text = h("span", { class: "strip-text" });
  const element = h("div", { class: `strip ${kind}`, role: "img" }, [...bars].reverse(), text);
  return {
    element,
    show(quantiles, what) {
      element.hidden = !quantiles;
      if (!quantiles) return;
      const words = [];
      for (const [i, [key]] of QUANTILES.entries()) {
        const us = quantiles[key];
        bars[i].style.width = `${us === null || us === undefined ? 0 : place(us)}%`;
        if (us !== null && us !== undefined) words.push(`${key} ${short(us)} µs`);
      }
      say(text, `99 % ${short(quantiles.p99)} µs`);
      mark(element, "aria-label", `${what}: ${words.join(", ")}`);
      element.title = `${what}: ${words.join(", ")}`;
    },
  };
}
