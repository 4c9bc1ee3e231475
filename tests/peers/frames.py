"""Holds the frames of a log against Pinocchio: forward kinematics of /joint_states must give the frames of /tf.

usage: frames.py LOG

Angles at equal stamps must agree within 1e-6 rad and places within 1e-6 m, for the robot as it believes to be; the true one,
under truth/, within what the bus rounds off. Checks also that frames are one tree from `world`, that none of /tf_static is
repeated in /tf, and that /rosout holds lines. Ends with status 1 at the first difference.
"""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from rosbags.highlevel import AnyReader

BELIEVED = 1e-6
TRUTH = 1e-4


def pose(t):
    p, q = t.transform.translation, t.transform.rotation
    return pin.SE3(pin.Quaternion(q.w, q.x, q.y, q.z).toRotationMatrix(), np.array([p.x, p.y, p.z]))


def read(path):
    """URDF, joint states by stamp, frames by stamp of the believed and the true robot, static frames, lines."""
    urdf, joints, frames, static, lines = "", {}, ({}, {}), {}, []
    with AnyReader([Path(path)]) as reader:
        for connection, time, raw in reader.messages():
            topic = connection.topic
            if topic not in ("/robot_description", "/joint_states", "/tf", "/truth/tf", "/tf_static", "/rosout"):
                continue
            message = reader.deserialize(raw, connection.msgtype)
            if topic == "/robot_description":
                urdf = message.data
            elif topic == "/joint_states":
                joints[time] = dict(zip(message.name, message.position))
            elif topic == "/tf_static":
                static = {t.child_frame_id: (t.header.frame_id, pose(t)) for t in message.transforms}
            elif topic == "/rosout":
                lines.append((message.level, message.name, message.msg))
            else:
                tree = {t.child_frame_id: (t.header.frame_id, pose(t)) for t in message.transforms}
                frames[topic == "/truth/tf"][time] = tree
    return urdf, joints, frames, static, lines


def place(tree, frame, root):
    """root_from_frame."""
    at = pin.SE3.Identity()
    for _ in range(99):
        if frame == root:
            return at
        if frame not in tree:
            sys.exit(f"{frame} does not lead to {root}")
        parent, step = tree[frame]
        frame, at = parent, step * at
    sys.exit(f"{frame}: the frames go round in a circle")


def worst(model, data, joints, trees, static, prefix):
    """Largest difference of angle [rad] and place [m] of a frame against the torso."""
    torso = model.frames[1].name
    angle, way, count = 0.0, 0.0, 0
    names = [f.name for f in model.frames if f.type == pin.FrameType.BODY]
    for time, tree in trees.items():
        repeated = set(tree) & set(static)
        if repeated:
            sys.exit(f"frames of /tf_static in /tf: {sorted(repeated)}")
        if time not in joints:
            continue
        q = pin.neutral(model)
        for name, value in joints[time].items():
            q[model.joints[model.getJointId(name)].idx_q] = value
        pin.framesForwardKinematics(model, data, q)
        base = data.oMf[model.getFrameId(torso)]
        both = {**tree, **static}
        for name in names:
            if prefix + name not in both:
                sys.exit(f"{prefix}{name} is in neither /tf nor /tf_static")
            ours = place(both, prefix + name, prefix + torso)
            theirs = base.actInv(data.oMf[model.getFrameId(name)])
            difference = theirs.actInv(ours)
            angle = max(angle, np.linalg.norm(pin.log3(difference.rotation)))
            way = max(way, np.linalg.norm(difference.translation))
        place(both, prefix + torso, "world")
        count += 1
    if prefix and count == 0:
        print("truth/: no stamp is that of a /joint_states, as in real time")
    elif count < 50:
        sys.exit(f"only {count} messages of /tf have a /joint_states of the same stamp")
    print(f"{prefix or 'believed'}: {count} instants, {len(names)} frames: {angle:.2e} rad, {way:.2e} m")
    return angle, way


def main():
    urdf, joints, (believed, true), static, lines = read(sys.argv[1])
    model = pin.buildModelFromXML(urdf)
    data = model.createData()
    found = worst(model, data, joints, believed, static, "")
    if max(found) > BELIEVED:
        sys.exit(f"/tf is not where /joint_states lead to: {found}")
    if true and max(worst(model, data, joints, true, static, "truth/")) > TRUTH:
        sys.exit("the simulated robot is not where /joint_states lead to")
    if not any(name == "planner" for _, name, _ in lines):
        sys.exit(f"/rosout: no line of the planner in {lines}")
    print(f"/rosout: {len(lines)} lines, the last one {lines[-1]}")


main()
