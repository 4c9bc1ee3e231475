// Camera: orbits by mouse, touch and keys, and follows the robot.

import { PerspectiveCamera, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const KEY_TURN = 0.12; // [rad] per press
const KEY_ZOOM = 1.15;
const JUMP = 1.5; // [m]
const LAG = 0.12; // [s] behind the robot
// Of a robot of 1.8 m: height of the point looked at [m], and directions from which it is looked at by name: distance [m], angle from above, angle about z [rad].
const HEIGHT = 0.78;
const VIEWS = { corner: [3.7, 1.2, -0.8], side: [3.6, 1.45, -Math.PI / 2], front: [3.5, 1.4, 0], top: [3.8, 0.02, -Math.PI / 2] };

const offset = new Vector3();
const target = new Vector3();
const spherical = new Spherical();

/** Camera with its controls. It stays at the same offset from the robot while it follows. */
export class FollowCamera {
  follow = true;
  #controls;
  #changed;
  #started = false;
  #size = 1;

  constructor(canvas, changed) {
    this.camera = new PerspectiveCamera(38, 1, 0.1, 60);
    this.camera.up.set(0, 0, 1);
    this.#changed = changed;
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.minDistance = 0.5;
    this.#controls.maxDistance = 15;
    this.#controls.maxPolarAngle = 1.57;
    this.#controls.addEventListener("change", changed);
    this.#controls.target.set(0, 0, HEIGHT);
    this.look("corner");
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  /** Whether drags on the canvas move the camera. */
  set enabled(on) {
    this.#controls.enabled = on;
  }

  /** Distances for a robot of another height [m]. */
  fit(height) {
    this.#size = height / 1.8;
    this.#controls.target.z = HEIGHT * this.#size;
    this.look("corner");
  }

  /** Looks at the robot from a direction by name. */
  look(name) {
    const [distance, ...angles] = VIEWS[name];
    spherical.set(distance * this.#size, ...angles);
    this.#place();
  }

  /** Goes along with the robot at (x, y, z) [m]: at once in the first state, smoothly after it. */
  track(x, y, z, seconds) {
    if (!this.follow || !Number.isFinite(x + y + z)) return;
    // Its height is smoothed more than its way: walking is no swell for who watches.
    target.set(x, y, HEIGHT * this.#size + z);
    offset.subVectors(target, this.#controls.target);
    // Farther than a robot walks from one picture to the next: another place, gone to at once.
    if (this.#started && offset.lengthSq() < JUMP * JUMP) offset.multiplyScalar(1 - Math.exp(-seconds / LAG)).setZ(offset.z * 0.3);
    this.#started = true;
    this.#controls.target.add(offset);
    this.camera.position.add(offset);
    this.camera.lookAt(this.#controls.target);
  }

  /** The next state is taken to at once: another run begins somewhere else. */
  restart() {
    this.#started = false;
  }

  /** Shape of the picture, in pixels. */
  resize(width, height) {
    this.camera.aspect = width / height;
    // A narrow picture needs the whole robot, too.
    this.camera.fov = this.camera.aspect < 1 ? 50 : 38;
    this.camera.updateProjectionMatrix();
  }

  #place() {
    // Spherical has y up, the world z.
    offset.setFromSpherical(spherical);
    this.camera.position.set(offset.z, offset.x, offset.y).add(this.#controls.target);
    this.camera.lookAt(this.#controls.target);
    this.#controls.update();
    this.#changed();
  }

  #key(event) {
    const turn = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    const zoom = { "+": 1 / KEY_ZOOM, "=": 1 / KEY_ZOOM, "-": KEY_ZOOM }[event.key];
    if (!turn && !zoom) return;
    event.preventDefault();
    offset.subVectors(this.camera.position, this.#controls.target);
    spherical.setFromVector3(target.set(offset.y, offset.z, offset.x));
    if (turn) {
      spherical.phi = Math.min(1.57, Math.max(0.02, spherical.phi + turn[0] * KEY_TURN));
      spherical.theta += turn[1] * KEY_TURN;
    } else spherical.radius = Math.min(15, Math.max(0.5, spherical.radius * zoom));
    this.#place();
  }
}
