// Pushes: the arrow of one that acts, and the one that is being drawn out of the body with mouse or finger.

import { Raycaster, Vector2, Vector3 } from "three";
import { Arrow } from "./arrow.js";

const NEWTON_PER_METRE = 250;
const MOST = 400; // [N] that a drag asks for; the form takes more
const LEAST = 5; // [N] below which letting go pushes nobody

const pointer = new Vector2();
const ray = new Raycaster();
const right = new Vector3();
const ahead = new Vector3();

/** Arrows of pushes; a drag that begins on the robot's body calls `pushed(force)` [N] when it ends. */
export class Pushes {
  force = new Vector3();
  dragging = false;
  #acting;
  #drawn;
  #from = new Vector3();
  #start = new Vector2();
  #perPixel = 0;
  #hooks;

  constructor(scene, theme, hooks) {
    this.#hooks = hooks;
    this.#acting = new Arrow(theme.push, 0.018);
    this.#drawn = new Arrow(theme.push, 0.018);
    theme.onChange(() => [this.#acting, this.#drawn].forEach((a) => a.material.color.copy(theme.push)));
    for (const arrow of [this.#acting, this.#drawn]) arrow.onTop();
    this.#drawn.material.opacity = 0.8;
    scene.add(this.#acting, this.#drawn);
  }

  /** Arrow of the push that acts now; the one that is being drawn begins at `from`, where the body has walked to. */
  show(values, at, wanted, from) {
    this.#acting.visible = false;
    if (this.dragging) {
      this.#from.copy(from);
      this.#draw();
    }
    if (!wanted || at < 0) return;
    const s = 1 / NEWTON_PER_METRE;
    this.#acting.set(values[at + 3], values[at + 4], values[at + 5], values[at] * s, values[at + 1] * s, values[at + 2] * s);
  }

  /** Begins a drag if (x, y) [pixels in the canvas] is on the body; says whether it did. */
  begin(event, canvas, camera, body, from) {
    const box = canvas.getBoundingClientRect();
    pointer.set(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    ray.setFromCamera(pointer, camera);
    const hit = body.visible ? ray.intersectObject(body, true)[0] : undefined;
    if (!hit) return false;
    this.dragging = true;
    this.#from.copy(from);
    this.#start.set(event.clientX, event.clientY);
    // Size of a pixel where the body was hit [m].
    this.#perPixel = (2 * hit.distance * Math.tan((camera.fov * Math.PI) / 360)) / box.height;
    this.force.set(0, 0, 0);
    return true;
  }

  /** Goes on with a drag: across the picture is across the robot's ground, up is away from who looks; with `up`, upwards. */
  move(event, camera, up) {
    const across = (event.clientX - this.#start.x) * this.#perPixel * NEWTON_PER_METRE;
    const along = (this.#start.y - event.clientY) * this.#perPixel * NEWTON_PER_METRE;
    right.setFromMatrixColumn(camera.matrixWorld, 0);
    ahead.set(-right.y, right.x, 0).normalize();
    this.force.copy(right).setZ(0).normalize().multiplyScalar(across);
    if (up) this.force.z = along;
    else this.force.addScaledVector(ahead, along);
    this.force.clampLength(0, MOST);
    this.#draw();
    this.#hooks.drawn(this.force, event, event.clientX < this.#start.x);
  }

  #draw() {
    const s = 1 / NEWTON_PER_METRE;
    this.#drawn.set(this.#from.x, this.#from.y, this.#from.z, this.force.x * s, this.force.y * s, this.force.z * s);
  }

  /** Ends a drag: pushes, unless it was given up or is too small to be meant. */
  end(pushes) {
    if (!this.dragging) return;
    this.dragging = false;
    this.#drawn.visible = false;
    this.#hooks.ended();
    if (pushes && this.force.length() >= LEAST) this.#hooks.pushed(this.force);
  }
}
