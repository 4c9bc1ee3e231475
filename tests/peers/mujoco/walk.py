"""Lola walks in MuJoCo: MuJoCo is the external plant of `gangwerk sim` (docs/external_plant.md), held against our type 2.

usage: walk.py GANGWERK [--all] [--markdown]      stands, leans, walks; fails where less is met than is demanded
       walk.py --serve SOCKET                     the robot for whoever connects, one after the other, soft soles

| what    | model in MuJoCo                                                                                      |
|---------|------------------------------------------------------------------------------------------------------|
| bodies  | of the URDF, floating base, none fused                                                               |
| soles   | soft: the points of robot.toml with its spring and damper (model.py); hard: boxes, MuJoCo's contact  |
| drives  | torque J (60000 (target - angle) + 600 (target's speed - speed)), up to the URDF's effort; J is what |
|         | the rotor is on its joint; type 2's cascade is this: 100/s times 600 rad/s                           |
| ground  | plane; boxes of the scene                                                                            |
| steps   | 0.25 ms, implicitfast, elliptic cones                                                                |

MuJoCo has no tangential spring, only a damper: a loaded point creeps. With the robot's damper (impratio 0.6) the rms of
roll at 2 km/h is 4.5 mrad instead of 3.2, for the feet creep sideways; ten times the normal damper holds them. A point also
carries a fiftieth of its body's inertia (model.py: d), without which steps of 0.25 ms do not bear that damper at landing.

Demanded (by the issue that asked for this, not by what was measured): done to the end as told; speed within 1 % of our
type 2, rms of the inclination errors within 30 %, peak force of a foot within 15 %; on hard soles: done to the end, and no
reading refused by the joint loop. At 5 km/h gears sway, and it is held against type 3.
"""

import csv
import json
import math
import re
import socket
import struct
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import mujoco
import numpy as np
from model import GRAVITY, bodies, floor, free, points, soft

HERE = Path(__file__).resolve().parent
ROBOT = HERE.parents[2] / "config/robots/lola"
STEPS = 4  # per cycle of 1 ms
STIFFNESS, DAMPING = 60_000.0, 600.0  # [1/s^2], [1/s]
HARD = {"solref": [0.005, 1.0]}
CONTACTS = 32
SIDES = ("right", "left")
OFF = 0
NO_SLIP = 10.0  # impratio
IMPEDANCE = 0.02  # d


def model(hello, hard):
    """MuJoCo's model of the robot that the first line on the socket tells of."""
    robot = tomllib.loads((ROBOT / "robot.toml").read_text())
    spec = free(bodies((ROBOT / robot["urdf"]).read_text()))
    for name, inertia in zip(hello["joints"], hello["rotor_inertia"], strict=True):
        joint = spec.joint(name)
        joint.armature = inertia
        effort = abs(joint.actfrcrange[1])
        drive = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, forcerange=[-effort, effort])
        drive.set_to_position(kp=STIFFNESS * inertia, kv=DAMPING * inertia)
    friction = [robot["contact"]["friction"], 0, 0]
    floor(spec, friction)
    for o in hello["objects"]:
        quaternion = np.zeros(4)
        mujoco.mju_euler2Quat(quaternion, np.array(o["pose"]["rotation"]), "XYZ")
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=np.array(o["box"]) / 2, pos=o["pose"]["position"],
                                quat=quaternion, friction=friction, condim=3, contype=1, conaffinity=0)
    for side in SIDES:
        foot = robot["foot"][side]
        spec.body(foot["sensor_link"]).add_site(name=f"{side} sensor", pos=foot["sensor"])
        spec.body(foot["link"]).add_site(name=f"{side} sole", pos=foot["sole"])
    if hard:
        boxes(spec, robot, friction)
    else:
        points(spec, robot)
        soft(spec, robot, IMPEDANCE)
        spec.option.impratio = NO_SLIP
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.timestep = hello["cycle"] / STEPS
    return spec.compile()


def boxes(spec, robot, friction):
    """A box on each segment of a sole, over the hull of its points, 10 mm high."""
    for side in SIDES:
        points = robot["foot"][side]["points"]
        for link in {p["link"] for p in points}:
            corners = np.array([p["at"] for p in points if p["link"] == link])
            low, high = corners.min(axis=0), corners.max(axis=0) + [0, 0, 0.01]
            spec.body(link).add_geom(name=f"{side} {link}", type=mujoco.mjtGeom.mjGEOM_BOX, size=(high - low) / 2,
                                     pos=(high + low) / 2, friction=friction, condim=3, contype=0, conaffinity=1,
                                     priority=1, mass=0, **HARD)


class Robot:
    """The robot in MuJoCo, in the order of Gangwerk's joints."""

    def __init__(self, hello, hard):
        self.m = model(hello, hard)
        self.d = mujoco.MjData(self.m)
        joints = [self.m.joint(name) for name in hello["joints"]]
        self.q = np.array([j.qposadr[0] for j in joints])
        self.v = np.array([j.dofadr[0] for j in joints])
        x, y, z, w = hello["orientation"]
        self.d.qpos[:7] = [*hello["position"], w, x, y, z]
        self.d.qpos[self.q] = self.angle = np.array(hello["joint_angle"])
        self.speed = np.zeros(len(joints))
        self.torso = self.m.body(1).id
        self.sites = {f"{side} {what}": self.m.site(f"{side} {what}").id for side in SIDES for what in ("sensor", "sole")}
        # -1: no foot; 0: right; 1: left
        names = [self.m.geom(i).name for i in range(self.m.ngeom)]
        self.foot = np.array([SIDES.index(n.split()[0]) if n.startswith(SIDES) and " " in n else -1 for n in names])
        self.gain, self.bias = self.m.actuator_gainprm.copy(), self.m.actuator_biasprm.copy()

    def step(self, push, angle, speed, task):
        m, d = self.m, self.d
        d.xfrc_applied[self.torso, :3] = push
        on = (task != OFF)[:, None]
        m.actuator_gainprm[:], m.actuator_biasprm[:] = self.gain * on, self.bias * on
        for k in range(1, STEPS + 1):
            # The targets are where the cycle ends.
            s = k / STEPS
            between = self.angle + s * (angle - self.angle), self.speed + s * (speed - self.speed)
            d.ctrl[:] = between[0] + DAMPING / STIFFNESS * between[1]
            mujoco.mj_step(m, d)
        self.angle, self.speed = angle, speed
        mujoco.mj_forward(m, d)

    def answer(self):
        """The numbers of docs/external_plant.md."""
        m, d = self.m, self.d
        q, v = d.qpos[self.q], d.qvel[self.v]
        attitude = d.xmat[self.torso].reshape(3, 3)
        # Forces of the contacts, world axes, on the feet: MuJoCo's are on the second geom, in axes whose first is normal.
        contact, force = d.contact, np.zeros((d.ncon, 3))
        if d.ncon:
            local = d.efc_force[contact.efc_address[:, None] + np.arange(3)] * (contact.efc_address >= 0)[:, None]
            force = np.einsum("ni,nij->nj", local, contact.frame.reshape(-1, 3, 3))
        feet = self.foot[contact.geom] if d.ncon else np.zeros((0, 2), int)
        force *= np.where(feet[:, 1] >= 0, 1.0, -1.0)[:, None]
        of = feet.max(axis=1, initial=-1)
        sensed, ground, soles = [], [], []
        for i, side in enumerate(SIDES):
            f, at = force[of == i], contact.pos[of == i] if d.ncon else np.zeros((0, 3))
            sensor, sole = self.sites[f"{side} sensor"], self.sites[f"{side} sole"]
            turn = d.site_xmat[sensor].reshape(3, 3).T
            moment = [np.cross(at - d.site_xpos[site], f).sum(axis=0) for site in (sensor, sole)]
            sensed += [turn @ f.sum(axis=0), turn @ moment[0]]
            ground += [f.sum(axis=0), moment[1]]
            x = d.site_xmat[sole].reshape(3, 3)[:, 0]
            soles += [d.site_xpos[sole], [math.atan2(x[1], x[0])]]
        orientation = np.roll(d.qpos[3:7], -1)
        gyro = d.qvel[3:6]
        specific = attitude.T @ (d.qacc[:3] - GRAVITY)
        imu = [orientation, gyro, specific]
        truth = [d.qpos[:3], orientation, attitude.T @ d.qvel[:3], gyro, d.subtree_com[self.torso]]
        # Contact points that carry: places and normals, zeros behind the last.
        points = np.zeros((CONTACTS, 6))
        carrying = np.flatnonzero((of >= 0) & (np.linalg.norm(force, axis=1) > 0))[:CONTACTS]
        if carrying.size:
            out = np.where(feet[:, 1] >= 0, 1.0, -1.0)[:, None] * contact.frame[:, :3]
            points[: carrying.size] = np.hstack([contact.pos, out])[carrying]
        contacts = [[carrying.size], points.ravel()]
        return np.concatenate(
            [q, v, q, v, d.actuator_force * math.nan, *sensed, *imu, *truth, *ground, *soles, *contacts]
        )


def serve(stream, hard):
    """Answers until Gangwerk ends."""
    hello = json.loads(stream.readline())
    assert hello["gangwerk_plant"] == 1, hello
    n = len(hello["joints"])
    robot = Robot(hello, hard)
    while head := stream.read(16):
        tick, count = struct.unpack("<QQ", head)
        numbers = np.frombuffer(stream.read(8 * count))
        robot.step(numbers[1:4], *numbers[4:].reshape(3, n))
        answer = robot.answer()
        stream.write(struct.pack("<QQ", tick, answer.size) + answer.tobytes())
        stream.flush()


def in_mujoco(gangwerk, scene, hard=False, log=None):
    """Figures of a scene, as `gangwerk sim --json` prints them, and its exit code."""
    with tempfile.TemporaryDirectory() as scratch, socket.socket(socket.AF_UNIX) as door:
        path = f"{scratch}/plant.sock"
        door.bind(path)
        door.listen(1)
        command = [gangwerk, "sim", scene, "--json", "--plant", path, *(["--log", log] if log else [])]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as sim:
            connection, _ = door.accept()
            with connection, connection.makefile("rwb") as stream:
                serve(stream, hard)
            out = sim.stdout.read()
        return json.loads(out), sim.returncode


def ours(gangwerk, scene, log=None):
    command = [gangwerk, "sim", scene, "--json", *(["--log", log] if log else [])]
    run = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    return json.loads(run.stdout), run.returncode


def scene(scratch, name, depth=2, text=None):
    """Path of a shipped scene, or of one with this text, on another type."""
    text = text or (ROBOT.parents[1] / f"scenes/{name}.toml").read_text()
    for key, value in {"depth": depth, "integrator": '"semi_implicit"', "substeps": STEPS}.items():
        text = re.sub(rf"(?m)^{key} = .*", f"{key} = {value}", text)
    path = Path(scratch) / f"{name}.toml"
    path.write_text(text)
    return str(path)


def exported(gangwerk, log, topic, at):
    """Row of a log's topic at a time [s]."""
    command = [gangwerk, "log", "export", log, topic, "--csv"]
    rows = csv.DictReader(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines())
    return min(({k: float(v) for k, v in row.items()} for row in rows), key=lambda row: abs(row["time"] - at))


class Demands:
    """What is demanded, and whether it is met."""

    def __init__(self):
        self.broken = []

    def expect(self, what, value, low, high):
        good = low <= value <= high
        if not good:
            self.broken.append(what)
        print(f"  {what:66s} {value:12.5g} {'' if good else f'NOT IN {low:g} .. {high:g}'}", flush=True)


LEAN = """
[[push]]
time = 3.0
duration = 5.0
force = {force}
"""


def standing(gangwerk, demands, scratch):
    """Forces of standing by the weight; a lean under 15 N, forwards and to the left, against ours."""
    robot = tomllib.loads((ROBOT / "robot.toml").read_text())
    weight = robot["total_mass"] * -GRAVITY[2]
    stand = (ROBOT.parents[1] / "scenes/stand.toml").read_text()
    for way, force, axis in (("forwards", [15.0, 0.0, 0.0], 1), ("to the left", [0.0, 15.0, 0.0], 0)):
        text, seen = stand + LEAN.format(force=force), []
        path = scene(scratch, "lean", text=text)
        for run, log in ((ours, f"{scratch}/ours.mcap"), (in_mujoco, f"{scratch}/mujoco.mcap")):
            _, code = run(gangwerk, path, log=log)
            demands.expect(f"lean {way}, {run.__name__}: exit code", code, 0, 0)
            seen.append([exported(gangwerk, log, "sim_state", at) for at in (2.9, 7.8)])
        loads = [[s[0][f"foot_wrench.{side}.force[2]"] for side in SIDES] for s in seen]
        demands.expect("standing: force of both feet / weight", sum(loads[1]) / weight, 0.9999, 1.0001)
        for i, side in enumerate(SIDES):
            demands.expect(f"standing: force of the {side} foot less ours [N]", loads[1][i] - loads[0][i], -1, 1)
        tilt = [2 * (s[1][f"orientation[{axis}]"] - s[0][f"orientation[{axis}]"]) for s in seen]
        demands.expect(f"lean {way} under 15 N, ours [mrad]", 1e3 * abs(tilt[0]), 10, 30)
        demands.expect(f"lean {way}: MuJoCo's / ours", tilt[1] / tilt[0], 0.97, 1.03)


HEAD = """| scene | robot | done | speed [m/s] | inclination error, rms x, y [mrad] | peak force of a foot [N] |
|---|---|---|---|---|---|"""


def row(name, robot, figures):
    x, y = (1e3 * r for r in figures["inclination_error_rms_rad"])
    return (f"| {name} | {robot} | {figures['ended_by']} | {figures['mean_speed_m_s']:.3f} | {x:.1f}, {y:.1f} | "
            f"{figures['peak_normal_force_n']:.0f} |")


def distance(row, page):
    """Greatest relative difference of the row's numbers from those of the page's row with the same words; infinite without."""
    def words(line):
        return re.findall(r"[a-z]\w*", line, re.I), [float(x) for x in re.findall(r"(?<!\w)\d+\.?\d*", line)]

    (name, numbers), lines = words(row), map(words, page)
    same = [theirs for words, theirs in lines if words == name and len(theirs) == len(numbers)]
    return max((abs(a / b - 1) for a, b in zip(numbers, same[0]) if a != b), default=0) if same else math.inf


def walking(gangwerk, demands, scratch, name, hard):
    """Walks a scene; its rows of the table."""
    depth = 3 if name == "walk_5kmh" else 2
    path = scene(scratch, name, depth)
    own, _ = ours(gangwerk, path)
    soft_soles, code = in_mujoco(gangwerk, path)
    rows = [row(name, f"type {depth}", own), row(name, "MuJoCo", soft_soles)]
    demands.expect(f"{name}: exit code", code, 0, 0)
    key = "mean_speed_m_s"
    demands.expect(f"{name}: speed / ours", soft_soles[key] / own[key], 0.99, 1.01)
    for k, axis in enumerate("xy"):
        a, b = (f["inclination_error_rms_rad"][k] for f in (soft_soles, own))
        demands.expect(f"{name}: inclination error about {axis}, rms / ours", a / b, 0.7, 1.3)
    key = "peak_normal_force_n"
    demands.expect(f"{name}: peak force of a foot / ours", soft_soles[key] / own[key], 0.85, 1.15)
    if hard:
        log = f"{scratch}/hard.mcap"
        hard_soles, code = in_mujoco(gangwerk, path, hard=True, log=log)
        rows.append(row(name, "MuJoCo, hard soles", hard_soles))
        demands.expect(f"{name}, hard soles: exit code", code, 0, 0)
        told = subprocess.run([gangwerk, "log", "show", log], stdout=subprocess.PIPE, text=True, check=True).stdout
        demands.expect(f"{name}, hard soles: readings refused", told.count("reading was refused"), 0, 0)
    return rows


def main():
    if sys.argv[1:2] == ["--serve"]:
        with socket.socket(socket.AF_UNIX) as door:
            door.bind(sys.argv[2])
            door.listen(1)
            while True:
                connection, _ = door.accept()
                with connection, connection.makefile("rwb") as stream:
                    serve(stream, False)
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    gangwerk, every, markdown = sys.argv[1], "--all" in sys.argv, "--markdown" in sys.argv
    demands, rows = Demands(), []
    with tempfile.TemporaryDirectory() as scratch:
        standing(gangwerk, demands, scratch)
        # Of the short form, what was hardest: 2 km/h, and hard soles at the speed whose readings were refused once.
        walks = [("walk_1kmh", True), ("walk_2kmh", True), ("walk_3kmh", True), ("walk_5kmh", True), ("walk_sideways", True),
                 ("board_2cm", True)] if every else [("walk_2kmh", True)]
        for name, hard in walks:
            rows += walking(gangwerk, demands, scratch, name, hard)
    if markdown:
        print(HEAD, *rows, sep="\n")
    else:
        page = (HERE.parents[2] / "docs/accuracy.md").read_text().splitlines()
        # Hard soles amplify the last bit of a processor.
        worst = max(distance(row, page) for row in rows if "hard" not in row)
        demands.expect("docs/accuracy.md: greatest difference of a number", worst, 0, 0.03)
    if demands.broken:
        sys.exit(f"FAILED: {', '.join(demands.broken)}")
    print("Lola walks in MuJoCo as in our model")


if __name__ == "__main__":
    main()
