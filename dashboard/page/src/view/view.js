// The 3-D view: builds the scene of a run, poses it by the newest state, draws it with the screen.

import { Color, DirectionalLight, Fog, HemisphereLight, Scene, Vector3, WebGLRenderer } from "three";
import { state } from "../frames.js";
import { FollowCamera } from "./camera.js";
import { ComPath, Footsteps } from "./footsteps.js";
import { Points } from "./points.js";
import { Pushes } from "./pushes.js";
import { makeBodies } from "./robot.js";
import { Soles } from "./soles.js";
import { Support } from "./support.js";
import { Surroundings } from "./surroundings.js";
import { Theme } from "./theme.js";

/** Parts of the picture that can be shown and hidden. */
export const LAYERS = { truth: true, force: true, zmp: true, support: true, capture: true, cog: true, steps: true, path: true, push: true };

const SLOW = 14; // pictures per second below which they get coarser
const COARSEST = 0.6; // pixels of a picture per pixel of the page

const torso = new Vector3();

/** View of one canvas. `hooks`: drawn(force, event, leftwards), ended(), pushed(force), canPush(), failed(why); built(scene, bodies, theme) and posed() add a body of somebody else's. */
export class View {
  layers = { ...LAYERS };
  bodies = null;
  measure = { frames: 0, perSecond: 0, firstPicture: NaN, tick: NaN };
  #renderer;
  #scene = new Scene();
  #camera;
  #theme = new Theme();
  #hooks;
  #canvas;
  #layout = null;
  #parts = null;
  #drawn = -1;
  #posed = 0;
  #dirty = true;
  #second = { since: 0, frames: 0 };
  #light;
  #shadows;

  constructor(canvas, hooks) {
    this.#canvas = canvas;
    this.#hooks = hooks;
    if (!this.#makeRenderer()) {
      hooks.failed("No picture of the robot: this browser has no WebGL 2. Everything else works.");
      return;
    }
    // Ours go first: a drag on the body pushes and does not turn the camera.
    this.#listen();
    this.#camera = new FollowCamera(canvas, () => { this.#dirty = true; });
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    requestAnimationFrame((now) => this.#frame(now));
  }

  /** Renderer with smooth edges and shadows; where a processor draws there is time for neither. False: none at all. */
  #makeRenderer() {
    const canvas = this.#canvas;
    const wanted = { alpha: true, depth: true, stencil: false, powerPreference: "high-performance" };
    let context = canvas.getContext("webgl2", { ...wanted, antialias: true, failIfMajorPerformanceCaveat: true });
    this.#shadows = context !== null && !drawnBySoftware(context);
    context ??= canvas.getContext("webgl2", wanted);
    if (!context) return false;
    this.#renderer = new WebGLRenderer({ canvas, context });
    // Asking each shader for errors waits for its compiler: a fifth of the time to the first picture.
    this.#renderer.debug.checkShaderErrors = false;
    this.#renderer.setPixelRatio(this.#shadows ? Math.min(2, devicePixelRatio) : 1);
    this.#renderer.shadowMap.enabled = this.#shadows;
    return true;
  }

  /** Scene of another run. */
  build(hello, urdf, layout) {
    if (!this.#renderer) return;
    this.#theme.forget();
    dispose(this.#scene);
    this.#scene = new Scene();
    this.#scene.background = new Color();
    this.#scene.fog = new Fog(0, 7, 19);
    this.#theme.onChange(() => {
      this.#scene.background.copy(this.#theme.sky);
      this.#scene.fog.color.copy(this.#theme.sky);
      this.#dirty = true;
    });
    this.#lights();
    const theme = this.#theme;
    this.bodies = makeBodies(urdf, hello, theme, this.#shadows);
    this.#scene.add(this.bodies.solid.root, this.bodies.ghost.root);
    this.#parts = {
      surroundings: new Surroundings(this.#scene, hello, theme, this.#shadows),
      support: new Support(this.#scene, theme),
      footsteps: new Footsteps(this.#scene, hello, theme, layout.count("steps") / 5),
      path: new ComPath(this.#scene, theme, layout.count("com_path") / 3),
      soles: new Soles(this.#scene, hello, this.bodies.solid, theme),
      points: new Points(this.#scene, theme),
      pushes: new Pushes(this.#scene, theme, this.#hooks),
    };
    this.#layout = layout;
    this.#drawn = -1;
    this.#hooks.built?.(this.#scene, this.bodies, theme);
    this.#camera.fit(this.bodies.height);
    this.#camera.restart();
  }

  /** Camera that stays with the robot, or where it is. */
  set follow(on) {
    if (this.#camera) this.#camera.follow = on;
    this.#dirty = true;
  }

  /** Camera to a direction by name: corner, side, front, top. */
  look(name) {
    this.#camera?.look(name);
  }

  /** Shows or hides a layer. */
  layer(name, on) {
    this.layers[name] = on;
    this.#drawn = -1;
  }

  /** Place of the robot in the page [CSS pixels], or null: for labels beside it. */
  place() {
    if (!this.bodies?.solid.root.visible) return null;
    const p = this.bodies.solid.root.position.clone().project(this.#camera.camera);
    const box = this.#canvas.getBoundingClientRect();
    return { x: box.left + ((p.x + 1) / 2) * box.width, y: box.top + ((1 - p.y) / 2) * box.height };
  }

  /** What is seen now, as a PNG; null without WebGL. */
  picture() {
    if (!this.#renderer) return Promise.resolve(null);
    // The drawing buffer lasts until the browser has shown it: taken at once, it is whole.
    this.#renderer.render(this.#scene, this.#camera.camera);
    return new Promise((resolve) => this.#canvas.toBlob(resolve, "image/png"));
  }

  /** Place of the camera [m]. */
  eye() {
    return this.#camera.camera.position.toArray();
  }

  /** One picture, if state or camera changed since the last one. */
  #frame(now) {
    requestAnimationFrame((t) => this.#frame(t));
    if (this.#layout && state.count !== this.#drawn && state.values.length === this.#layout.length) {
      this.#pose(state.values, this.#layout, (now - this.#posed) / 1000);
      this.#posed = now;
      this.#drawn = state.count;
      this.measure.tick = state.tick;
      this.#dirty = true;
    }
    if (this.#hooks.posed?.()) this.#dirty = true;
    if (this.#dirty) {
      this.#dirty = false;
      this.#renderer.render(this.#scene, this.#camera.camera);
      this.#count(now);
    }
  }

  #pose(values, layout, seconds) {
    const { solid, ghost } = this.bodies;
    const parts = this.#parts;
    const estimate = layout.at("torso");
    const truth = layout.at("torso_truth");
    // Without an estimate (nothing planned yet) the truth is all that is known: it is drawn solid.
    const known = estimate >= 0 && Number.isFinite(values[estimate]);
    const body = known ? estimate : truth;
    solid.pose(values, body, layout.at("joint_angle"));
    ghost.pose(values, known && this.layers.truth ? truth : -1, layout.at(layout.at("joint_truth") >= 0 ? "joint_truth" : "joint_angle"));
    const x = values[body];
    const y = values[body + 1];
    parts.surroundings.show(values, layout.at("objects"), x, y);
    parts.soles.show(values, layout, this.layers.force);
    parts.support.show(parts.soles.corners, values, layout.at("load"), this.layers.support);
    parts.points.show(values, layout, this.layers);
    parts.footsteps.show(values, layout.at("steps"), this.layers.steps);
    parts.path.show(values, layout.at("com_path"), this.layers.path);
    parts.pushes.show(values, layout.at("push"), this.layers.push, this.#pushPoint());
    this.#camera.track(x, y, groundUnder(values, layout), seconds);
    if (this.#shadows && Number.isFinite(x + y)) {
      this.#light.position.set(x + 1.6, y - 2.2, 4.5);
      this.#light.target.position.set(x, y, 0.5);
      this.#light.target.updateMatrixWorld();
    }
  }

  #lights() {
    const sky = new HemisphereLight(0xffffff, 0x8a93a0, 1.7);
    sky.position.set(0, 0, 1);
    this.#light = new DirectionalLight(0xffffff, 2.1);
    this.#light.position.set(1.6, -2.2, 4.5);
    this.#light.castShadow = this.#shadows;
    this.#light.shadow.mapSize.set(2048, 2048);
    this.#light.shadow.radius = 4;
    Object.assign(this.#light.shadow.camera, { left: -2, right: 2, top: 2, bottom: -2, near: 1, far: 9 });
    this.#scene.add(sky, this.#light, this.#light.target);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.#canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.#camera.resize(width, height);
    this.#dirty = true;
  }

  #count(now) {
    const measure = this.measure;
    if (this.bodies?.solid.root.visible && Number.isNaN(measure.firstPicture)) measure.firstPicture = performance.now();
    measure.frames++;
    this.#second.frames++;
    if (now - this.#second.since < 1000) return;
    measure.perSecond = (this.#second.frames * 1000) / (now - this.#second.since);
    this.#second.since = now;
    this.#second.frames = 0;
    this.#coarsen();
  }

  /** Fewer pixels where a processor draws too slowly: motion says more than sharp edges. */
  #coarsen() {
    const ratio = this.#renderer.getPixelRatio();
    if (this.#shadows || this.measure.perSecond > SLOW || ratio <= COARSEST) return;
    this.#renderer.setPixelRatio(Math.max(COARSEST, ratio - 0.2));
    this.#resize();
  }

  /** Drags on the body, with mouse, pen or finger. */
  #listen() {
    const canvas = this.#canvas;
    canvas.addEventListener("pointerdown", (event) => {
      const pushes = this.#parts?.pushes;
      if (!pushes || event.button !== 0 || pushes.dragging || !this.#hooks.canPush()) return;
      if (!pushes.begin(event, canvas, this.#camera.camera, this.bodies.solid.root, this.#pushPoint())) return;
      this.#camera.enabled = false;
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.#parts?.pushes.dragging) return;
      this.#parts.pushes.move(event, this.#camera.camera, event.shiftKey);
      this.#dirty = true;
    });
    const end = (pushes) => {
      this.#parts?.pushes.end(pushes);
      this.#camera.enabled = true;
      this.#dirty = true;
    };
    canvas.addEventListener("pointerup", () => end(true));
    canvas.addEventListener("pointercancel", () => end(false));
    document.addEventListener("keydown", ({ key }) => key === "Escape" && end(false));
  }

  /** Where a push acts: the torso's middle as the server says it, else the torso's origin. */
  #pushPoint() {
    const at = this.#layout.at("push");
    const known = at >= 0 && Number.isFinite(state.values[at + 3]);
    return known ? torso.fromArray(state.values, at + 3) : torso.copy(this.bodies.solid.root.position);
  }
}

/** Height of the ground on which the robot stands [m]: that of the zero-moment point, else 0. */
function groundUnder(values, layout) {
  const at = layout.at("zmp_planned");
  return at >= 0 && Number.isFinite(values[at + 2]) ? values[at + 2] : 0;
}

/** Whether the processor draws in place of a graphics card, by the name of who draws. */
function drawnBySoftware(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : gl.getParameter(gl.RENDERER);
  return /swiftshader|llvmpipe|software/i.test(name);
}

/** Gives back what a scene holds on the graphics card. */
function dispose(scene) {
  scene.traverse((object) => {
    object.geometry?.dispose();
    object.material?.map?.dispose();
    object.material?.dispose();
  });
}
