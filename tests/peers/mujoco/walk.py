"""Lola walks in MuJoCo: MuJoCo is the external plant of `gangwerk sim` (docs/external_plant.md), held against our type 2.

usage: walk.py GANGWERK [--all] [--markdown]

| what    | model in MuJoCo                                                                                     |
|---------|-----------------------------------------------------------------------------------------------------|
| bodies  | of the URDF, floating base, none fused                                                              |
| soles   | soft: the points of robot.toml with its spring and damper (model.py); hard: boxes, MuJoCo's contact |
| drives  | torque J (60000 (target - angle) + 600 (speed's target - speed)), up to the URDF's effort; J is what|
|         | the rotor is on its joint; the loop is type 2's cascade: 100/s times 600 rad/s                      |
| ground  | plane; boxes of the scene                                                                           |
| steps   | 0.25 ms, implicitfast, elliptic cones                                                               |

Demanded (not measured here first): done to the end as told; speed within 1 % of our type 2, rms of the inclination error
within 30 %, peak force of a foot within 15 %; on hard soles: done to the end, and no reading refused by the joint loop.
"""

import json
import math
import os
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
SIDES = ("right", "left")
OFF = 0
NO_SLIP = 10.0  # impratio


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
        soft(spec, robot)
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
        return np.concatenate([q, v, q, v, d.actuator_force * math.nan, *sensed, *imu, *truth, *ground, *soles])


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
        command = [gangwerk, "sim", str(scene), "--json", "--plant", path, *(["--log", log] if log else [])]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as sim:
            connection, _ = door.accept()
            with connection, connection.makefile("rwb") as stream:
                serve(stream, hard)
            out = sim.stdout.read()
        return json.loads(out), sim.returncode


def ours(gangwerk, scene):
    run = subprocess.run([gangwerk, "sim", str(scene), "--json"], stdout=subprocess.PIPE, text=True)
    return json.loads(run.stdout), run.returncode


if __name__ == "__main__":
    print(json.dumps(in_mujoco(sys.argv[1], sys.argv[2], hard="--hard" in sys.argv, log=os.environ.get("LOG")), indent=1))
