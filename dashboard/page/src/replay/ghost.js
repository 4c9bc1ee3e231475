// The robot of the other log: a ghost of its own colour in the same view.

import { other } from "../frames.js";
import { Body, haunt } from "../view/robot.js";

/** Ghost of the second log, posed by its newest state. */
export class OtherBody {
  body = null;
  #layout;
  #posed = -1;
  #names;

  constructor(layout, names) {
    this.#layout = layout;
    this.#names = names;
  }

  /** Another scene: a copy of its ghost, which has the outlines and no shade. */
  build(scene, bodies, theme) {
    const root = bodies.ghost.root.clone();
    haunt(root, theme, "other", 0.5);
    this.body = new Body(root, this.#names);
    scene.add(root);
    this.#posed = -1;
  }

  /** Poses it if its state is new; whether it was. */
  pose() {
    const { values, count } = other;
    if (!this.body || count === this.#posed || values.length !== this.#layout.length) return false;
    this.#posed = count;
    const estimate = this.#layout.at("torso");
    // As the solid robot: where it believes to be, else where the simulation knows it is.
    const known = Number.isFinite(values[estimate]);
    this.body.pose(values, known ? estimate : this.#layout.at("torso_truth"), this.#layout.at("joint_angle"));
    return true;
  }
}
