// Arrow from a point along a vector, thick enough to be seen from afar.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Vector3 } from "three";

const UP = new Vector3(0, 1, 0);
const direction = new Vector3();
// Both of unit length along y, beginning at the origin, so that scaling sets their lengths.
const SHAFT = new CylinderGeometry(1, 1, 1, 10).translate(0, 0.5, 0);
const HEAD = new ConeGeometry(1, 1, 14).translate(0, 0.5, 0);

/** Arrow of a colour; hidden until it is set to a vector long enough to be drawn. */
export class Arrow extends Group {
  #shaft;
  #head;
  #radius;

  constructor(color, radius = 0.012) {
    super();
    this.material = new MeshBasicMaterial({ color, transparent: true, opacity: 0.95 });
    this.#shaft = new Mesh(SHAFT, this.material);
    this.#head = new Mesh(HEAD, this.material);
    this.#radius = radius;
    this.add(this.#shaft, this.#head);
    this.visible = false;
  }

  /** Seen through everything: its beginning is inside of a body. */
  onTop() {
    this.material.depthTest = false;
    this.#shaft.renderOrder = this.#head.renderOrder = 12;
  }

  /** Puts the arrow at (x, y, z) [m], along (dx, dy, dz) [m]; with a vector that is short or NaN it is hidden. */
  set(x, y, z, dx, dy, dz) {
    const length = Math.hypot(dx, dy, dz);
    this.visible = length > 0.02 && Number.isFinite(x + y + z);
    if (!this.visible) return;
    const head = Math.min(0.09, length * 0.5);
    this.position.set(x, y, z);
    this.quaternion.setFromUnitVectors(UP, direction.set(dx / length, dy / length, dz / length));
    this.#shaft.scale.set(this.#radius, length - head, this.#radius);
    this.#head.scale.set(this.#radius * 2.6, head, this.#radius * 2.6);
    this.#head.position.y = length - head;
  }
}
