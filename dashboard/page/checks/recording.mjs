// Recording of a real walk as state frames of docs/dashboard.md: `gangwerk sim` writes a log, its topics are read as tables.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import os from "node:os";
import path from "node:path";

const G = 9.81;
const MASS = 60.9; // [kg] Lola's
const RATE = 60;
const STEPS = 8;
const PATH = 24;

/** Layout of the frames, as in docs/dashboard.md; `joints` their number, `objects` those of the scene. */
export function layoutOf(joints, objects) {
  const parts = [["time", 1, "s"], ["torso", 7, "m"], ["torso_truth", 7, "m"], ["joint_angle", joints, "rad"], ["joint_truth", joints, "rad"],
    ["wrench", 12, "N"], ["load", 2, "1"], ["force", 6, "N"], ["zmp", 3, "m"], ["zmp_planned", 3, "m"], ["capture_point", 3, "m"], ["com", 3, "m"],
    ["com_planned", 3, "m"], ["com_truth", 3, "m"], ["com_velocity", 3, "m/s"], ["soles", 8, "m"], ["soles_planned", 8, "m"], ["steps", 5 * STEPS, ""],
    ["com_path", 3 * PATH, "m"], ["push", 6, "N"], ["rope", 1, "N"], ["objects", 8 * objects, ""], ["supply", 1, ""], ["power_off_reason", 1, ""],
    ["start_up", 1, ""], ["gait", 1, ""], ["not_standing", 1, ""], ["fallen", 1, ""], ["phase", 2, ""], ["contact", 2, ""], ["temperature", joints, "deg C"],
    ["tracking_error", joints, "rad"], ["drive_error", joints, ""]];
  return parts.filter(([, count]) => count > 0).map(([name, count, unit]) => ({ name, count, unit }));
}

/** Table of a topic: column names, and rows of numbers. */
export function table(binary, log, topic, fields) {
  const csv = execFileSync(binary, ["log", "export", log, topic, ...fields.flatMap((f) => ["--field", f])], { maxBuffer: 1 << 30, encoding: "utf8" });
  const [head, ...lines] = csv.trim().split("\n");
  return { columns: head.split(","), rows: lines.map((line) => line.split(",").map(Number)) };
}

/** Frames of `scene`: {layout, joints, frames: Float32Array per 1/60 s, ticks, columns and rows of what can be plotted}. */
export function record(binary, scene) {
  const folder = mkdtempSync(path.join(os.tmpdir(), "gangwerk-page-"));
  const log = path.join(folder, "walk.mcap");
  try {
    execFileSync(binary, ["sim", scene, "--log", log], { stdio: "ignore" });
    return frames(binary, log);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

function frames(binary, log) {
  const truth = table(binary, log, "sim_state", ["time", "position", "orientation", "joint_angle", "com", "foot_wrench", "push", "power", "fallen"]);
  const sensors = table(binary, log, "sensors", ["joint_angle", "foot_wrench", "temperature"]);
  const control = table(binary, log, "controller_state", ["origin", "torso", "com", "com_desired", "com_velocity", "dcm", "feet", "feet_desired", "zmp", "zmp_desired", "gait", "phase", "contact", "tracking_error"]);
  const plan = table(binary, log, "plan", ["start_tick", "origin", "step_count", "steps"]);
  const joints = sensors.columns.filter((c) => c.startsWith("joint_angle.")).map((c) => c.slice(12));
  const layout = layoutOf(joints.length, 0);
  const length = layout.reduce((sum, { count }) => sum + count, 0);
  const place = new Map();
  let at = 0;
  for (const { name, count } of layout) {
    place.set(name, at);
    at += count;
  }
  const many = Math.floor((truth.rows.length * RATE) / 1000);
  const first = truth.rows[0];
  const column = (t, name) => t.columns.indexOf(name);
  const of = (t, row, name, n) => t.rows[row].slice(column(t, name), column(t, name) + n);
  const start = of(truth, 0, "position[0]", 3);
  const startTorso = toWorld(of(control, 0, "origin[0]", 3), of(control, 0, "torso[0]", 3));
  // The planning frame begins under the soles, the world where the scene puts the robot.
  const shift = [start[0] - startTorso[0], start[1] - startTorso[1]];
  const list = [];
  const ticks = [];
  for (let k = 0; k < many; k++) {
    const row = Math.min(truth.rows.length - 1, control.rows.length - 1, Math.round((k * 1000) / RATE));
    const frame = new Float32Array(length).fill(NaN);
    const put = (name, values) => frame.set(values, place.get(name));
    const origin = of(control, row, "origin[0]", 3);
    const world = (p) => {
      const [x, y, ...rest] = toWorld(origin, p);
      return [x + shift[0], y + shift[1], ...rest];
    };
    const [qx, qy, qz, qw] = of(truth, row, "orientation[0]", 4);
    const force = [...of(truth, row, "foot_wrench.right.force[0]", 3), ...of(truth, row, "foot_wrench.left.force[0]", 3)];
    put("time", [row / 1000]);
    put("torso", [...world(of(control, row, "torso[0]", 3)), qw, qx, qy, qz]);
    put("torso_truth", [...of(truth, row, "position[0]", 3), qw, qx, qy, qz]);
    put("joint_angle", of(sensors, row, `joint_angle.${joints[0]}`, joints.length));
    put("joint_truth", of(truth, row, `joint_angle.${joints[0]}`, joints.length));
    put("load", [force[2] / (MASS * G), force[5] / (MASS * G)]);
    put("force", force);
    for (const [name, from] of [["zmp", "zmp[0]"], ["zmp_planned", "zmp_desired[0]"], ["capture_point", "dcm[0]"]]) put(name, world([...of(control, row, from, 2), 0]));
    for (const [name, from] of [["com", "com[0]"], ["com_planned", "com_desired[0]"]]) put(name, world(of(control, row, from, 3)));
    put("com_truth", of(truth, row, "com[0]", 3));
    put("com_velocity", of(control, row, "com_velocity[0]", 3));
    const now = plan.rows.findLast((p) => p[column(plan, "start_tick")] <= row);
    if (now) putSteps(frame, place.get("steps"), now, plan, shift, row);
    // Way of the centre of gravity that was planned afterwards: what the plan said, as far as it was not changed.
    for (let i = 0; i < PATH; i++) {
      const later = Math.min(control.rows.length - 1, row + i * 100);
      const [x, y, z] = toWorld(of(control, later, "origin[0]", 3), of(control, later, "com_desired[0]", 3));
      frame.set([x + shift[0], y + shift[1], z], place.get("com_path") + 3 * i);
    }
    put("push", [...of(truth, row, "push[0]", 3), ...of(truth, row, "com[0]", 3)]);
    put("rope", [0]);
    put("supply", of(truth, row, "power", 1));
    put("power_off_reason", [0]);
    put("start_up", [6]);
    put("gait", of(control, row, "gait", 1));
    put("not_standing", [0]);
    put("fallen", of(truth, row, "fallen", 1));
    put("phase", of(control, row, "phase[0]", 2));
    put("contact", of(control, row, "contact[0]", 2));
    put("temperature", of(sensors, row, `temperature.${joints[0]}`, joints.length));
    put("tracking_error", of(control, row, `tracking_error.${joints[0]}`, joints.length));
    put("drive_error", new Array(joints.length).fill(0));
    list.push(frame);
    ticks.push(row);
  }
  const series = [["sensors", sensors], ["sim_state", truth], ["controller_state", control]];
  return { layout, place, joints, frames: list, ticks, first, series };
}

/** Point (or pose) of a planning frame in the frame that it is given in. */
function toWorld([x, y, heading], [px, py, pz = 0, h]) {
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const place = [x + c * px - s * py, y + s * px + c * py, pz];
  return h === undefined ? place : [...place, h + heading];
}

/** Landings of a plan that lie ahead. */
function putSteps(frame, at, now, plan, shift, row) {
  const value = (name) => now[plan.columns.indexOf(name)];
  const origin = [0, 1, 2].map((i) => value(`origin[${i}]`));
  let shown = 0;
  for (let i = 0; i < value("step_count"); i++) {
    if (row - value("start_tick") > 1000 * value(`steps[${i}].end`)) continue;
    const [x, y, heading] = [0, 1, 2].map((k) => value(`steps[${i}].landing[${k}]`));
    const place = toWorld(origin, [x, y, 0]);
    frame.set([1 - value(`steps[${i}].stance`), place[0] + shift[0], place[1] + shift[1], 0, heading + origin[2]], at + 5 * shown++);
  }
}

/** Description of the robot in the tree of sources. */
export const urdfOf = (root, robot) => readFileSync(path.join(root, "config/robots", robot, `${robot}.urdf`), "utf8");
