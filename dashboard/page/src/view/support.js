// Support polygon: hull of the corners of the soles that carry.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineLoop, Mesh, MeshBasicMaterial } from "three";

const MOST = 8; // corners of two soles
const CARRIES = 0.02; // share of the weight from which a sole counts
const OVER_GROUND = 0.004; // [m]

/** Filled hull with an edge, on the ground under the soles. */
export class Support {
  #fill;
  #edge;
  #positions = new Float32Array(3 * MOST);
  #sorted = new Array(MOST).fill(null);
  #hull = new Array(2 * MOST).fill(null);

  constructor(scene, theme) {
    const attribute = new BufferAttribute(this.#positions, 3);
    const filled = new BufferGeometry().setAttribute("position", attribute);
    const fan = [];
    for (let i = 2; i < MOST; i++) fan.push(0, i - 1, i);
    filled.setIndex(fan);
    const edged = new BufferGeometry().setAttribute("position", attribute);
    this.#fill = new Mesh(filled, new MeshBasicMaterial({ transparent: true, opacity: 0.18, depthWrite: false, side: 2 }));
    this.#edge = new LineLoop(edged, new LineBasicMaterial({ transparent: true, opacity: 0.9 }));
    for (const part of [this.#fill, this.#edge]) {
      part.frustumCulled = false;
      part.renderOrder = 1;
      scene.add(part);
    }
    theme.onChange(() => {
      this.#fill.material.color.copy(theme["load-full"]);
      this.#edge.material.color.copy(theme["load-full"]);
    });
  }

  /** Hull of the corners of loaded soles: `corners` 4 of the right foot, 4 of the left; `values[load..]` their loads. */
  show(corners, values, load, wanted) {
    let count = 0;
    if (wanted && load >= 0) {
      for (let i = 0; i < MOST; i++) if (values[load + (i >> 2)] > CARRIES) this.#sorted[count++] = corners[i];
    }
    const n = count >= 3 ? this.#chain(count) : 0;
    this.#fill.visible = this.#edge.visible = n >= 3;
    if (n < 3) return;
    for (let i = 0; i < n; i++) {
      const p = this.#hull[i];
      this.#positions[3 * i] = p.x;
      this.#positions[3 * i + 1] = p.y;
      this.#positions[3 * i + 2] = p.z + OVER_GROUND;
    }
    this.#fill.geometry.attributes.position.needsUpdate = true;
    this.#fill.geometry.setDrawRange(0, 3 * (n - 2));
    this.#edge.geometry.setDrawRange(0, n);
  }

  /** Andrew's monotone chain over the first `count` of `#sorted`, into `#hull`; the number of corners of the hull. */
  #chain(count) {
    const points = this.#sorted;
    // Insertion: eight points, and no garbage of a sort.
    for (let i = 1; i < count; i++) {
      const p = points[i];
      let j = i - 1;
      while (j >= 0 && (points[j].x > p.x || (points[j].x === p.x && points[j].y > p.y))) {
        points[j + 1] = points[j];
        j--;
      }
      points[j + 1] = p;
    }
    const hull = this.#hull;
    let n = 0;
    for (let i = 0; i < count; i++) {
      while (n >= 2 && !left(hull[n - 2], hull[n - 1], points[i])) n--;
      hull[n++] = points[i];
    }
    const lower = n + 1;
    for (let i = count - 2; i >= 0; i--) {
      while (n >= lower && !left(hull[n - 2], hull[n - 1], points[i])) n--;
      hull[n++] = points[i];
    }
    return n - 1;
  }
}

/** Turn to the left at b on the way from a to c. */
const left = (a, b, c) => (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 1e-12;
