// Layer over the 3-D view: layers with their colours, camera, speed, frame rate, and the push that is being drawn.

import { Vector3 } from "three";
import { h, mark, say, toggle } from "../dom.js";
import { fixed } from "../numbers.js";
import { LAYERS } from "./view.js";

const NAMES = {
  truth: ["Truth", "ghost: where the simulation knows that she is"],
  force: ["Forces", "of the ground on each foot"],
  support: ["Support", "hull of the soles that carry"],
  zmp: ["ZMP", "zero-moment point: disc measured, ring planned"],
  capture: ["Capture point", "where she would have to step to come to rest"],
  cog: ["CoG", "centre of gravity: ball measured, ring planned"],
  steps: ["Steps", "where the next feet land, with their numbers"],
  path: ["Path", "planned way of the centre of gravity"],
  push: ["Pushes", "external force on the torso"],
};

/** Overlay of a view. */
export class Hud {
  #label = h("div", { class: "push-label", hidden: true, role: "status" });
  #numbers = h("div", { class: "hud-numbers" });
  #rate = h("span", { class: "hint" });
  #view;
  #layout = null;

  constructor(view, hub) {
    this.#view = view;
    const layers = Object.keys(LAYERS).map((name) => toggle(
      [h("span", { class: `swatch layer-${name}`, "aria-hidden": "true" }), NAMES[name][0]], true, (on) => view.layer(name, on), { title: NAMES[name][1] }));
    const looks = ["corner", "side", "front", "top"].map((name) => h("button", { type: "button", class: "quiet", onclick: () => view.look(name) }, name));
    this.element = h("div", { class: "hud" },
      h("div", { class: "hud-top" }, this.#numbers,
        h("div", { class: "looks", role: "group", "aria-label": "Camera" }, toggle("Follow", true, (on) => { view.follow = on; }), looks)),
      h("div", { class: "layers", role: "group", "aria-label": "Shown in the picture" }, layers, this.#rate), this.#label);
    hub.on("layout", (layout) => { this.#layout = layout; });
  }

  /** Label of a push that is being drawn, at its tip: on the other side of the pointer than its arrow. */
  draw(words, event, leftwards) {
    say(this.#label, words);
    this.#label.hidden = false;
    const box = this.element.getBoundingClientRect();
    const width = this.#label.offsetWidth;
    const x = event.clientX - box.left + (leftwards ? -14 - width : 14);
    this.#label.style.transform = `translate(${Math.min(box.width - width - 4, Math.max(4, x))}px, ${Math.max(4, event.clientY - box.top - 14)}px)`;
  }

  /** The push is over. */
  drawn() {
    this.#label.hidden = true;
  }

  /** Numbers of the newest state; call it a few times per second. */
  refresh(values) {
    say(this.#rate, `${Math.round(this.#view.measure.perSecond)} frames/s`);
    if (!this.#layout || values.length === 0) return;
    const v = this.#layout.at("com_velocity");
    const load = this.#layout.at("load");
    const parts = [];
    if (v >= 0 && Number.isFinite(values[v])) parts.push(`${fixed(speed.set(values[v], values[v + 1], 0).length(), 2)} m/s`);
    if (load >= 0 && Number.isFinite(values[load])) parts.push(`load ${percent(values[load + 1])} left, ${percent(values[load])} right`);
    say(this.#numbers, parts.join(" · "));
    mark(this.#numbers, "data-empty", String(parts.length === 0));
  }
}

const speed = new Vector3();
const percent = (x) => `${fixed(x * 100, 0)} %`;
