// Ground and objects of a scene.

import { BufferAttribute, BufferGeometry, EdgesGeometry, CanvasTexture, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry, RepeatWrapping, ShadowMaterial, SRGBColorSpace } from "three";

const REACH = 24; // [m] of the ground around the robot
const PER_OBJECT = 8; // there, position, quaternion

/** Ground with a grid of metres under whom the camera follows; objects at their poses. */
export class Surroundings {
  #ground = new Group();
  #shade;
  #objects = [];

  constructor(scene, hello, theme, shadows) {
    // Not lit: its colours are those of the page. Lines are in its texture: long ones of their own are not clipped by every renderer.
    const grid = tile(shadows ? 8 : 2);
    const plane = new Mesh(new PlaneGeometry(REACH * 2, REACH * 2), new MeshBasicMaterial({ map: grid.texture, depthWrite: false }));
    plane.renderOrder = -3;
    const shade = shadows ? cast() : smudge();
    shade.renderOrder = -2;
    theme.onChange(() => grid.paint(theme));
    this.#ground.add(plane);
    this.#shade = shade;
    const { height, tilt } = hello.scene.ground;
    const tilted = new Group();
    tilted.rotation.set(tilt?.[0] ?? 0, tilt?.[1] ?? 0, 0);
    tilted.position.z = height ?? 0;
    tilted.add(this.#ground, shade);
    scene.add(tilted);
    for (const object of hello.scene.objects) {
      const group = solid(object, theme, shadows);
      group.visible = false;
      scene.add(group);
      this.#objects.push(group);
    }
  }

  /** Ground under (x, y), moved by whole metres so that its lines stay; objects at the poses of one state. */
  show(values, at, x, y) {
    if (Number.isFinite(x + y)) {
      this.#ground.position.set(Math.round(x), Math.round(y), 0);
      this.#shade.position.set(x, y, this.#shade.position.z);
    }
    for (let i = 0; i < this.#objects.length; i++) {
      const o = at + PER_OBJECT * i;
      const group = this.#objects[i];
      group.visible = at >= 0 && values[o] === 1 && Number.isFinite(values[o + 1]);
      if (!group.visible) continue;
      group.position.set(values[o + 1], values[o + 2], values[o + 3]);
      group.quaternion.set(values[o + 5], values[o + 6], values[o + 7], values[o + 4]);
    }
  }
}

/** Tile of one metre of ground, with lines every 0.25 m; a high `anisotropy` keeps them sharp far away, at a price. */
function tile(anisotropy) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 512;
  const context = canvas.getContext("2d");
  const texture = new CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(2 * REACH, 2 * REACH);
  texture.anisotropy = anisotropy;
  texture.colorSpace = SRGBColorSpace;
  const paint = (theme) => {
    context.fillStyle = `#${theme.ground.getHexString()}`;
    context.fillRect(0, 0, 512, 512);
    for (const [step, width, color] of [[128, 3, theme.grid], [512, 5, theme["grid-strong"]]]) {
      context.strokeStyle = `#${color.getHexString()}`;
      context.lineWidth = width;
      context.beginPath();
      for (let x = 0; x <= 512; x += step) {
        context.moveTo(x, 0);
        context.lineTo(x, 512);
        context.moveTo(0, x);
        context.lineTo(512, x);
      }
      context.stroke();
    }
    texture.needsUpdate = true;
  };
  return { texture, paint };
}

/** Plane on which the light casts shadows. */
function cast() {
  const plane = new Mesh(new PlaneGeometry(6, 6), new ShadowMaterial({ opacity: 0.3, depthWrite: false }));
  plane.receiveShadow = true;
  return plane;
}

/** Soft spot under the robot, in place of a shadow. */
function smudge() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d");
  const gradient = context.createRadialGradient(32, 32, 2, 32, 32, 32);
  gradient.addColorStop(0, "rgba(0,0,0,.34)");
  gradient.addColorStop(1, "rgba(0,0,0,0)");
  context.fillStyle = gradient;
  context.fillRect(0, 0, 64, 64);
  return new Mesh(new PlaneGeometry(1.3, 1.1), new MeshBasicMaterial({ map: new CanvasTexture(canvas), transparent: true, depthWrite: false }));
}

/** Object from its triangles, with its edges drawn. */
function solid({ vertices, triangles }, theme, shadows) {
  const indexed = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(vertices), 3));
  indexed.setIndex(triangles);
  const geometry = indexed.toNonIndexed();
  geometry.computeVertexNormals();
  const faces = new Mesh(geometry, new MeshLambertMaterial({ side: 2 }));
  faces.castShadow = faces.receiveShadow = shadows;
  const edges = new LineSegments(new EdgesGeometry(geometry, 20), new LineBasicMaterial());
  theme.onChange(() => {
    faces.material.color.copy(theme.object);
    edges.material.color.copy(theme["object-edge"]);
  });
  return new Group().add(faces, edges);
}
