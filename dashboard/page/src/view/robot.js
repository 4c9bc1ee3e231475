// The robot from its URDF: solid where it believes to be, and a ghost where the simulation knows it is.

import { Box3, MeshBasicMaterial, MeshLambertMaterial, Quaternion } from "three";
import URDFLoader from "urdf-loader";
import { bridgeGaps } from "./outlines.js";

const turn = new Quaternion();

/** Body of a robot: its links as objects of the scene, and its joints in the order of the state frame. */
export class Body {
  #joints;
  #rest;

  constructor(robot, names) {
    this.root = robot;
    this.root.visible = false;
    this.#joints = names.map((name) => robot.joints[name]);
    this.#rest = this.#joints.map((joint) => joint?.quaternion.clone());
  }

  /** Link by name, or undefined. */
  link(name) {
    return this.root.links[name];
  }

  /** Poses torso and joints: 7 numbers at `pose`, joint angles at `angles`; hidden while the pose is not known. */
  pose(values, pose, angles) {
    const known = pose >= 0 && Number.isFinite(values[pose]) && Number.isFinite(values[pose + 3]);
    this.root.visible = known;
    if (!known) return;
    this.root.position.set(values[pose], values[pose + 1], values[pose + 2]);
    this.root.quaternion.set(values[pose + 4], values[pose + 5], values[pose + 6], values[pose + 3]);
    for (let i = 0; i < this.#joints.length; i++) {
      const joint = this.#joints[i];
      const angle = values[angles + i];
      if (!joint || !Number.isFinite(angle)) continue;
      joint.quaternion.copy(this.#rest[i]).multiply(turn.setFromAxisAngle(joint.axis, angle));
    }
    this.root.updateMatrixWorld(true);
  }

  /** Angle [rad] of the i-th joint as the scene graph has it, or NaN: for checks of what is drawn. */
  angle(i) {
    const joint = this.#joints[i];
    if (!joint) return NaN;
    const q = this.#rest[i].clone().invert().multiply(joint.quaternion);
    return 2 * Math.atan2(q.x * joint.axis.x + q.y * joint.axis.y + q.z * joint.axis.z, q.w);
  }
}

/** Both bodies of a description, `solid` and `ghost`; names of links that were `mended`; its `height` [m] with all joints at zero. */
export function makeBodies(urdf, hello, theme, shadows) {
  const names = hello.robot.joints.map((joint) => joint.name);
  const loader = new URDFLoader();
  // Meshes come from the server of the page and from nowhere else.
  loader.packages = () => "/meshes";
  const robot = loader.parse(urdf);
  const mended = bridgeGaps(robot);
  const extent = new Box3().setFromObject(robot);
  const ghost = robot.clone();
  paint(robot, theme, shadows);
  haunt(ghost, theme);
  return { solid: new Body(robot, names), ghost: new Body(ghost, names), mended, height: extent.max.z - extent.min.z };
}

/** Shades of the solid robot: bright links and dark frames of the URDF become the page's two colours. */
function paint(robot, theme, shadows) {
  const hull = new MeshLambertMaterial();
  const frame = new MeshLambertMaterial();
  theme.onChange(() => {
    hull.color.copy(theme.hull);
    frame.color.copy(theme.frame);
  });
  robot.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const { name, color } = mesh.material;
    mesh.material = name === "dark" || color.r + color.g + color.b < 0.9 ? frame : hull;
    mesh.castShadow = shadows;
  });
}

/** Ghost: see-through, and drawn after the solid robot so that it does not hide it. */
export function haunt(robot, theme, color = "ghost", opacity = 0.3) {
  // Behind the solid one by a little: where both are the same, only the solid one is seen.
  const material = new MeshBasicMaterial({ transparent: true, opacity, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 60 });
  theme.onChange(() => material.color.copy(theme[color]));
  robot.traverse((mesh) => {
    if (!mesh.isMesh) return;
    mesh.material = material;
    mesh.renderOrder = 5;
  });
}
