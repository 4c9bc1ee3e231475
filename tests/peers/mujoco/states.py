"""Writes the initial states of the runs; every number follows from a formula below, so that others can make it again.

usage: states.py ROBOT_DIRECTORY MODEL_DIRECTORY OUTPUT_DIRECTORY

A file: comments after #, then `joints NAME...`, `q ...` (base position in the world [m], base quaternion x y z w, joint
angles [rad]), `v ...` (velocity [m/s] and angular velocity [rad/s] of the base in the base frame, joint speeds
[rad/s]). Numbers have as many digits as it takes to read the same double again.

flight.txt  joint k = 1, 2, ... in the order of robot.toml, with range_deg lo..hi:
              angle  = (pi/180) (lo + (hi - lo) (0.5 + 0.4 sin k)),  speed = 1.5 sin(2 k)
            base: position (0, 0, 1), quaternion (0.1, -0.2, 0.3, 0.9) / sqrt(0.95),
                  velocity (0.3, -0.2, 0.1), angular velocity (0.5, -0.4, 0.3)
chain.txt   same base (its velocity only where the base is free), angle = sin k, speed = 1.5 sin(2 k)
chain_fixed.txt  angles and speeds of chain.txt, base upright and at rest at the origin
stand.txt   pose_deg.stand of robot.toml at rest, base upright, lowest contact point 10 mm above z = 0
block.txt   block of 0.1 m height, resting on z = 0
"""

import math
import sys
import tomllib
from pathlib import Path

import mujoco

DROP = 0.010  # [m]


def base():
    length = math.sqrt(0.95)
    return [0.0, 0.0, 1.0] + [c / length for c in (0.1, -0.2, 0.3, 0.9)], [0.3, -0.2, 0.1, 0.5, -0.4, 0.3]


def flight(robot):
    q, v = base()
    for k, joint in enumerate(robot["joint"], 1):
        low, high = joint["range_deg"]
        q.append(math.pi / 180 * (low + (high - low) * (0.5 + 0.4 * math.sin(k))))
        v.append(1.5 * math.sin(2 * k))
    return q, v


def chain(joints, fixed):
    q, v = base() if not fixed else ([0.0] * 6 + [1.0], [0.0] * 6)
    ks = range(1, len(joints) + 1)
    return q + [math.sin(k) for k in ks], v + [1.5 * math.sin(2 * k) for k in ks]


def stand(robot, model):
    angles = [math.pi / 180 * robot["pose_deg"]["stand"][joint["name"]] for joint in robot["joint"]]
    data = mujoco.MjData(model)
    data.qpos[:7] = [0, 0, 0, 1, 0, 0, 0]
    for joint, angle in zip(robot["joint"], angles):
        data.joint(joint["name"]).qpos[0] = angle
    mujoco.mj_kinematics(model, data)
    points = model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE
    height = DROP - float(data.geom_xpos[points, 2].min())
    return [0.0, 0.0, height, 0.0, 0.0, 0.0, 1.0] + angles, [0.0] * (6 + len(angles))


def write(path, joints, state):
    q, v = state
    numbers = {"q": q, "v": v}
    lines = [f"# Formula: {path.name} in tests/peers/mujoco/states.py, which wrote this file."]
    lines.append(" ".join(["joints", *joints]))
    lines += [" ".join([name, *(repr(float(x)) for x in row)]) for name, row in numbers.items()]
    path.write_text("\n".join(lines) + "\n")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    directory, models, output = (Path(a) for a in sys.argv[1:])
    robot = tomllib.loads((directory / "robot.toml").read_text())
    names = [joint["name"] for joint in robot["joint"]]
    links = ["hip", "knee", "ankle"]
    output.mkdir(parents=True, exist_ok=True)
    write(output / "flight.txt", names, flight(robot))
    write(output / "chain.txt", links, chain(links, fixed=False))
    write(output / "chain_fixed.txt", links, chain(links, fixed=True))
    feet = mujoco.MjModel.from_binary_path(str(models / "lola_stiff.mjb"))
    write(output / "stand.txt", names, stand(robot, feet))
    write(output / "block.txt", [], ([0, 0, 0.05, 0, 0, 0, 1], [0] * 6))


if __name__ == "__main__":
    main()
