// Soles coloured by load, and the forces of the ground on them.

import { BoxGeometry, Mesh, MeshBasicMaterial, Object3D, Vector3 } from "three";
import { Arrow } from "./arrow.js";
import { outline } from "./outlines.js";

const METRES_PER_WEIGHT = 0.55; // length of the arrow of a foot that carries the whole robot
const RIM = 0.014; // [m] of the slab beyond the sole, so that it is seen from above
const G = 9.81;

/** Slabs under both feet and arrows on them. */
export class Soles {
  #slabs = [];
  #arrows = [];
  #weight;
  #theme;
  /** Corners of both soles in the world, [m]: 4 of the right foot, 4 of the left one. */
  corners = Array.from({ length: 8 }, () => new Vector3());
  #local = [];

  constructor(scene, hello, solid, theme) {
    this.#theme = theme;
    this.#weight = hello.robot.mass_kg * G;
    for (const foot of hello.robot.feet) {
      const [x0, x1, y0, y1] = foot.support;
      const slab = makeSlab(foot, solid.link(foot.link));
      const frame = new Object3D();
      frame.position.fromArray(foot.sole);
      frame.add(slab);
      solid.link(foot.link)?.add(frame);
      this.#local.push({ frame, corners: [[x0, y0], [x1, y0], [x1, y1], [x0, y1]] });
      this.#slabs.push(slab);
      const arrow = new Arrow(theme.force);
      this.#arrows.push(arrow);
      scene.add(arrow);
    }
    theme.onChange(() => this.#arrows.forEach((arrow) => arrow.material.color.copy(theme.force)));
  }

  /** Colours, arrows and corners of one state; call it after the robot was posed. */
  show(values, layout, forces) {
    const load = layout.at("load");
    const force = layout.at("force");
    const scale = METRES_PER_WEIGHT / this.#weight;
    for (let i = 0; i < this.#slabs.length; i++) {
      shade(this.#slabs[i].material.color, load >= 0 ? values[load + i] : 0, this.#theme);
      const { frame, corners } = this.#local[i];
      for (let k = 0; k < 4; k++) {
        this.corners[4 * i + k].set(corners[k][0], corners[k][1], 0).applyMatrix4(frame.matrixWorld);
      }
      const arrow = this.#arrows[i];
      arrow.visible = false;
      if (!forces || force < 0) continue;
      // From the middle of the sole that presses.
      const place = this.corners[4 * i];
      const across = this.corners[4 * i + 2];
      const f = force + 3 * i;
      arrow.set((place.x + across.x) / 2, (place.y + across.y) / 2, (place.z + across.z) / 2,
        values[f] * scale, values[f + 1] * scale, values[f + 2] * scale);
    }
  }
}

/** Slab in the sole frame under support and outline of a foot, and a rim beyond. */
function makeSlab({ sole, support }, link) {
  let [x0, x1, y0, y1] = support;
  const box = link ? outline(link) : null;
  if (box && !box.isEmpty()) {
    [x0, x1] = [Math.min(x0, box.min.x - sole[0]), Math.max(x1, box.max.x - sole[0])];
    [y0, y1] = [Math.min(y0, box.min.y - sole[1]), Math.max(y1, box.max.y - sole[1])];
  }
  const slab = new Mesh(new BoxGeometry(x1 - x0 + 2 * RIM, y1 - y0 + 2 * RIM, 0.012), new MeshBasicMaterial());
  slab.position.set((x0 + x1) / 2, (y0 + y1) / 2, 0.002);
  return slab;
}

const STOPS = [["load-none", 0], ["load-some", 0.25], ["load-full", 1], ["load-over", 1.6]];

/** Colour of a load: none, some, the whole weight, far over it. */
function shade(color, load, theme) {
  const x = Number.isFinite(load) ? Math.max(0, load) : 0;
  let i = 0;
  while (i < STOPS.length - 2 && x > STOPS[i + 1][1]) i++;
  const [from, a] = STOPS[i];
  const [to, b] = STOPS[i + 1];
  color.lerpColors(theme[from], theme[to], Math.min(1, (x - a) / (b - a)));
}
