// One pane of plots: some fields over one axis of time.

import uPlot from "uplot";
import { h, newId, say } from "../dom.js";
import { exact, short, unitOf } from "../numbers.js";
import { fieldSearch } from "./search.js";

const COLORS = 8;
const HEIGHT = 150;

/** Pane with its fields, its search and its drawing. `hooks`: fields(), store(), unit(name), changed(), remove(), zoomed(from, to), unzoomed(). */
export class Pane {
  fields = [];
  #hooks;
  #plot = null;
  #place = h("div", { class: "plot-place", tabindex: 0, role: "group" });
  #chips = h("div", { class: "plot-chips" });
  #data = [[]];
  #shown = [];

  constructor(fields, hooks) {
    this.#hooks = hooks;
    this.fields = fields;
    const title = newId("pane");
    this.#place.setAttribute("aria-label", "Plot: arrow keys move the cursor, plus and minus zoom");
    this.element = h("section", { class: "pane", "aria-label": "Pane of plots", id: title },
      h("div", { class: "pane-head" }, this.#chips, fieldSearch("Add a field to this pane", hooks.fields, (name) => this.#add(name)),
        h("button", { type: "button", class: "quiet small", "aria-label": "Remove this pane", onclick: hooks.remove }, "✕")),
      this.#place);
    this.#place.addEventListener("keydown", (event) => this.#key(event));
    new ResizeObserver(() => this.#plot?.setSize({ width: this.#place.clientWidth, height: HEIGHT })).observe(this.#place);
    this.rebuild();
  }

  /** Width of the drawing in pixels: as many columns are asked of the rings. */
  get columns() {
    return Math.max(50, Math.round((this.#plot?.bbox.width ?? 600) / devicePixelRatio));
  }

  /** Draws [from, to] out of the rings. */
  draw(rings, from, to) {
    if (!this.#plot || this.#place.clientWidth === 0) return;
    rings.picture(this.fields, from, to, this.columns, this.#data);
    this.#plot.setData(this.#data, false);
    this.#plot.setScale("x", { min: from, max: to });
  }

  /** Drawing for the present fields and colours. */
  rebuild() {
    this.#plot?.destroy();
    // Of two logs each field has two lines, those of the other one dashed.
    const store = this.#hooks.store();
    const doubled = store?.doubled ?? false;
    this.#data = [[], ...this.fields.map(() => []), ...(doubled ? this.fields.map(() => []) : [])];
    const style = getComputedStyle(document.documentElement);
    const ink = style.getPropertyValue("--dim").trim();
    const lines = style.getPropertyValue("--line").trim();
    const axis = { stroke: ink, grid: { stroke: lines, width: 1 }, ticks: { stroke: lines, width: 1 }, font: "11px system-ui, sans-serif" };
    const series = this.fields.map((field, i) => ({
      label: this.#short(field), stroke: style.getPropertyValue(`--plot-${i % COLORS}`).trim(), width: 1.5, spanGaps: true, points: { show: false },
      value: (_, v) => short(v),
    }));
    if (doubled) series.push(...series.map((line) => ({ ...line, dash: [6, 4] })));
    this.#plot = new uPlot({
      width: this.#place.clientWidth || 400, height: HEIGHT, legend: { show: false },
      cursor: { sync: { key: "time" }, drag: { x: true, y: false, setScale: false }, points: { size: 6 } },
      scales: { x: { time: false }, y: { range: spread } },
      axes: [{ ...axis, size: 26, values: (_, ticks) => ticks.map((t) => `${+t.toFixed(3)} s`) }, { ...axis, size: 60, values: (_, ticks) => ticks.map(tick) }],
      series: [{ value: (_, v) => `${short(v)} s` }, ...series],
      hooks: {
        setCursor: [() => this.#values()],
        setSelect: [(u) => u.select.width > 4 && this.#hooks.zoomed(u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x"))],
        setData: [() => this.#values()],
        draw: [(u) => store && instant(u, store.cursor, ink)],
      },
    }, this.#data, this.#place);
    this.#plot.over.addEventListener("dblclick", () => this.#hooks.unzoomed());
    this.#tell();
  }

  #add(name) {
    if (this.fields.includes(name) || this.fields.length >= COLORS) return;
    this.fields.push(name);
    this.#hooks.changed();
    this.rebuild();
  }

  #tell() {
    this.#shown = [];
    this.#chips.replaceChildren(...this.fields.map((field, i) => {
      const value = h("span", { class: "plot-value" });
      const remove = h("button", { type: "button", class: "quiet", "aria-label": `Remove ${field}` }, "✕");
      const chip = h("span", { class: "plot-chip", title: field, style: `--color:var(--plot-${i % COLORS})` },
        h("span", { class: "swatch" }), this.#short(field), " ", value, remove);
      remove.addEventListener("click", () => {
        this.fields.splice(this.fields.indexOf(field), 1);
        this.#hooks.changed();
        this.rebuild();
      });
      this.#shown.push(value);
      return chip;
    }));
  }

  /** Values under the cursor, or the newest ones. */
  #values() {
    const plot = this.#plot;
    if (!plot) return;
    const store = this.#hooks.store();
    // Without a pointer, the values of the instant that is shown.
    const under = plot.cursor.idx ?? (store && this.#data[0].length ? plot.valToIdx(store.cursor) : null);
    for (const [i, place] of this.#shown.entries()) {
      const column = this.#data[i + 1];
      if (!column) continue;
      let at = under ?? column.length - 1;
      while ((under === null || store) && at >= 0 && column[at] === null) at--;
      const value = column[at];
      const text = value === null || value === undefined ? "–" : `${short(value)} ${unitOf(this.#hooks.unit(this.fields[i]))}`;
      say(place, text);
    }
  }

  #short(field) {
    // The topic goes without saying where the rest is clear.
    return field.slice(field.indexOf(".") + 1).replaceAll("_", " ");
  }

  #key(event) {
    const plot = this.#plot;
    const width = plot.over.clientWidth;
    const { min, max } = plot.scales.x;
    const left = plot.cursor.left >= 0 ? plot.cursor.left : width / 2;
    const step = event.shiftKey ? width / 10 : width / 100;
    if (event.key === "ArrowLeft") plot.setCursor({ left: Math.max(0, left - step), top: 10 });
    else if (event.key === "ArrowRight") plot.setCursor({ left: Math.min(width, left + step), top: 10 });
    else if (event.key === "+" || event.key === "=") {
      const at = plot.posToVal(left, "x");
      this.#hooks.zoomed(at - (at - min) / 2, at + (max - at) / 2);
    } else if (event.key === "-" || event.key === "Escape") this.#hooks.unzoomed();
    else return;
    event.preventDefault();
  }
}

/** Number at the axis of values: whole, with an exponent where it would not fit. */
const tick = (t) => (t !== 0 && Math.abs(t) < 1e-3 ? Number(t.toPrecision(3)).toExponential() : exact(t)).replaceAll("-", "−");

/** Line at the instant of a recording that is shown. */
function instant(plot, time, ink) {
  const { left, top, width, height } = plot.bbox;
  const x = Math.round(plot.valToPos(time, "x", true));
  if (x < left || x > left + width) return;
  plot.ctx.fillStyle = ink;
  plot.ctx.fillRect(x, top, Math.max(1, devicePixelRatio), height);
}

/** Range of the values with some air; of a constant a little around it. */
function spread(_plot, low, high) {
  if (low === null || low === undefined) return [-1, 1];
  const air = high > low ? (high - low) * 0.06 : Math.max(1e-6, Math.abs(low) * 0.1);
  return [low - air, high + air];
}
