// Marks on the ground and in the body: zero-moment points, capture point, centre of gravity.

import { BufferGeometry, CircleGeometry, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, RingGeometry, SphereGeometry, Vector3 } from "three";

const OVER_GROUND = 0.008; // [m]

/** Marks of one state frame, each of its own shape: they are told apart without their colours, too. */
export class Points {
  #marks;
  #plumb;

  constructor(scene, theme) {
    const flat = (geometry, color) => {
      const mesh = new Mesh(geometry, new MeshBasicMaterial({ depthTest: false, transparent: true }));
      mesh.renderOrder = 10;
      theme.onChange(() => mesh.material.color.copy(theme[color]));
      return mesh;
    };
    const cross = (color) => {
      const group = new Group();
      for (const angle of [Math.PI / 4, -Math.PI / 4]) {
        const bar = flat(new RingGeometry(0, 0.032, 4, 1), color);
        bar.scale.set(1, 0.2, 1);
        bar.rotation.z = angle;
        group.add(bar);
      }
      return group;
    };
    this.#marks = [
      { part: "zmp", mesh: flat(new CircleGeometry(0.02, 24), "zmp"), layer: "zmp", lift: OVER_GROUND },
      { part: "zmp_planned", mesh: flat(new RingGeometry(0.024, 0.032, 28), "zmp-planned"), layer: "zmp", lift: OVER_GROUND },
      { part: "capture_point", mesh: cross("capture"), layer: "capture", lift: OVER_GROUND },
      { part: "com", mesh: flat(new SphereGeometry(0.026, 18, 12), "cog"), layer: "cog", lift: 0 },
      { part: "com_planned", mesh: flat(new RingGeometry(0.034, 0.04, 28), "path"), layer: "cog", lift: 0 },
    ];
    for (const { mesh } of this.#marks) scene.add(mesh);
    // Plumb line from the centre of gravity to the ground.
    this.#plumb = new Line(new BufferGeometry().setFromPoints([new Vector3(), new Vector3(0, 0, -1)]), new LineBasicMaterial({ transparent: true, opacity: 0.5 }));
    this.#plumb.frustumCulled = false;
    theme.onChange(() => this.#plumb.material.color.copy(theme.cog));
    scene.add(this.#plumb);
  }

  /** Places the marks of one state; a point that is not known is hidden. */
  show(values, layout, layers) {
    for (let i = 0; i < this.#marks.length; i++) {
      const { part, mesh, layer, lift } = this.#marks[i];
      const at = layout.at(part);
      mesh.visible = layers[layer] && at >= 0 && Number.isFinite(values[at]);
      if (mesh.visible) mesh.position.set(values[at], values[at + 1], values[at + 2] + lift);
    }
    const com = layout.at("com");
    this.#plumb.visible = layers.cog && com >= 0 && Number.isFinite(values[com]);
    if (this.#plumb.visible) {
      // The ground is where the zero-moment point lies; without one the line ends at zero.
      const zmp = layout.at("zmp_planned");
      const ground = zmp >= 0 && Number.isFinite(values[zmp + 2]) ? values[zmp + 2] : 0;
      this.#plumb.position.set(values[com], values[com + 1], values[com + 2]);
      this.#plumb.scale.z = Math.max(0.01, values[com + 2] - ground);
    }
  }
}
