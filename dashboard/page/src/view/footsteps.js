// Planned footsteps: outlines of soles where they will land, with their numbers; and the planned way of the centre of gravity.

import { BufferAttribute, BufferGeometry, CanvasTexture, Group, Line, LineBasicMaterial, LineLoop, Sprite, SpriteMaterial, Vector3 } from "three";

const PER_STEP = 5; // foot, x, y, z, heading
const OVER_GROUND = 0.005; // [m]

/** Outlines of the planned steps. */
export class Footsteps {
  #steps = [];

  constructor(scene, hello, theme, most) {
    for (let i = 0; i < most; i++) {
      const step = { group: new Group(), outlines: [] };
      for (const foot of hello.robot.feet) {
        const [x0, x1, y0, y1] = foot.support;
        const outline = new LineLoop(rounded(x0, x1, y0, y1, 0.025), new LineBasicMaterial());
        step.outlines.push(outline);
        step.group.add(outline);
      }
      const [x0, x1] = hello.robot.feet[0].support;
      step.number = numeral(i + 1);
      step.number.position.x = (x0 + x1) / 2;
      step.group.add(step.number);
      theme.onChange(() => {
        step.outlines[0].material.color.copy(theme["step-right"]);
        step.outlines[1].material.color.copy(theme["step-left"]);
        step.number.material.color.copy(theme.cog);
      });
      step.group.visible = false;
      scene.add(step.group);
      this.#steps.push(step);
    }
  }

  /** Steps of one state; those that are NaN are not planned. Returns how many are shown. */
  show(values, at, wanted) {
    let shown = 0;
    for (let i = 0; i < this.#steps.length; i++) {
      const { group, outlines } = this.#steps[i];
      const s = at + PER_STEP * i;
      group.visible = wanted && at >= 0 && Number.isFinite(values[s + 1]);
      if (!group.visible) continue;
      shown++;
      outlines[0].visible = values[s] === 0;
      outlines[1].visible = values[s] === 1;
      group.position.set(values[s + 1], values[s + 2], values[s + 3] + OVER_GROUND);
      group.rotation.z = values[s + 4];
    }
    return shown;
  }
}

/** Outline of a sole with rounded corners of radius r. */
function rounded(x0, x1, y0, y1, r) {
  const points = [];
  const corners = [[x1 - r, y1 - r, 0], [x0 + r, y1 - r, 1], [x0 + r, y0 + r, 2], [x1 - r, y0 + r, 3]];
  for (const [x, y, quarter] of corners) {
    for (let k = 0; k <= 4; k++) {
      const angle = (quarter + k / 4) * (Math.PI / 2);
      points.push(new Vector3(x + r * Math.cos(angle), y + r * Math.sin(angle), 0));
    }
  }
  return new BufferGeometry().setFromPoints(points);
}

/** Number that stands on the ground and turns to who looks. */
function numeral(n) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d");
  context.font = "600 46px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = "#fff";
  context.fillText(String(n), 32, 35);
  const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthWrite: false }));
  sprite.scale.set(0.1, 0.1, 1);
  sprite.position.z = 0.03;
  return sprite;
}

/** Planned way of the centre of gravity. */
export class ComPath {
  #line;
  #positions;

  constructor(scene, theme, points) {
    this.#positions = new Float32Array(3 * points);
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(this.#positions, 3));
    this.#line = new Line(geometry, new LineBasicMaterial());
    this.#line.frustumCulled = false;
    theme.onChange(() => this.#line.material.color.copy(theme.path));
    scene.add(this.#line);
  }

  /** Way from now on; it ends at the first point that is NaN. */
  show(values, at, wanted) {
    let points = 0;
    if (wanted && at >= 0) {
      while (3 * points < this.#positions.length && Number.isFinite(values[at + 3 * points])) points++;
      for (let i = 0; i < 3 * points; i++) this.#positions[i] = values[at + i];
    }
    this.#line.visible = points > 1;
    this.#line.geometry.setDrawRange(0, points);
    this.#line.geometry.attributes.position.needsUpdate = true;
  }
}
