"""Loads robot descriptions in Pinocchio and MuJoCo and compares what each of them understood.

usage: urdf.py ROBOT_DIRECTORY...

Total mass, order, axes and ranges of the joints, then, at random poses, the centre of gravity and the mass matrix of
the joints with the upper body held. Ends with status 1 at the first difference.
"""

import sys
import tomllib
from pathlib import Path

import mujoco
import numpy as np
import pinocchio

POSES = 50
TOLERANCE = 1e-9


def same(what, a, b, tolerance=TOLERANCE):
    """Largest difference of two arrays; ends the program if it is too large."""
    difference = float(np.max(np.abs(np.asarray(a) - np.asarray(b))))
    if not difference <= tolerance:
        sys.exit(f"{what}: differs by {difference:g}")
    return difference


def compare(directory):
    robot = tomllib.loads((directory / "robot.toml").read_text())
    names = [joint["name"] for joint in robot["joint"]]
    urdf = (directory / robot["urdf"]).read_text()

    # With a fixed base Pinocchio leaves the base's mass out of the centre of gravity.
    pin = pinocchio.buildModelFromXML(urdf, pinocchio.JointModelFreeFlyer())
    # Keep the upper body as a body of its own, and the masses as they are written.
    option = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco>'
    mj = mujoco.MjModel.from_xml_string(urdf.replace("</robot>", f"{option}</robot>"))
    pin_data, mj_data = pin.createData(), mujoco.MjData(mj)

    # Pinocchio sorts joints by name, MuJoCo keeps the order of the file; arrays follow robot.toml.
    p = [pin.joints[pin.getJointId(name)].idx_v for name in names]
    p_q = [pin.joints[pin.getJointId(name)].idx_q for name in names]
    m = [mj.jnt_dofadr[mj.joint(name).id] for name in names]
    if [mj.joint(i).name for i in range(mj.njnt)] != names:
        sys.exit("MuJoCo's joints are not in the order of robot.toml")
    if pin.nv != 6 + len(names) or mj.nv != len(names):
        sys.exit(f"{len(names)} joints in robot.toml, {pin.nv - 6} in Pinocchio, {mj.nv} in MuJoCo")

    mass = sum(i.mass for i in pin.inertias)
    same("total mass", mass, mj.body_mass.sum())
    same("total mass in robot.toml", mass, robot["total_mass"])
    same("lower ranges", pin.lowerPositionLimit[p_q], mj.jnt_range[:, 0])
    same("upper ranges", pin.upperPositionLimit[p_q], mj.jnt_range[:, 1])

    random = np.random.default_rng(1)
    worst = {"axes": 0.0, "centre of gravity": 0.0, "mass matrix": 0.0}
    for _ in range(POSES):
        q = random.uniform(mj.jnt_range[:, 0], mj.jnt_range[:, 1])
        q_pin, q_mj = pinocchio.neutral(pin), np.zeros(mj.nq)
        q_pin[p_q], q_mj[m] = q, q
        mj_data.qpos[:] = q_mj
        mujoco.mj_forward(mj, mj_data)
        matrix = np.zeros((mj.nv, mj.nv))
        for column, unit in enumerate(np.eye(mj.nv)):
            mujoco.mj_mulM(mj, mj_data, matrix[column], unit)

        pinocchio.computeJointJacobians(pin, pin_data, q_pin)
        frame = pinocchio.LOCAL_WORLD_ALIGNED
        axes = [pinocchio.getJointJacobian(pin, pin_data, pin.getJointId(n), frame)[3:, i] for n, i in zip(names, p)]
        cog = pinocchio.centerOfMass(pin, pin_data, q_pin)
        crba = pinocchio.crba(pin, pin_data, q_pin)
        crba = np.triu(crba) + np.triu(crba, 1).T

        body = mj_data.xipos * mj.body_mass[:, None]
        for what, a, b in (
            ("axes", axes, mj_data.xaxis),
            ("centre of gravity", cog, body.sum(axis=0) / mj.body_mass.sum()),
            ("mass matrix", crba[np.ix_(p, p)], matrix[np.ix_(m, m)]),
        ):
            worst[what] = max(worst[what], same(what, a, b))
    figures = ", ".join(f"{what} {difference:.1e}" for what, difference in worst.items())
    print(f"{directory.name}: {len(names)} joints, {mass:.3f} kg; largest differences: {figures}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for argument in sys.argv[1:]:
        compare(Path(argument))
