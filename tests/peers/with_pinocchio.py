"""Compares crates/multibody with Pinocchio.

Random states go to the Rust program `peer` as JSON, its results come back as JSON, and every quantity of every state is
held against Pinocchio's. The error of a quantity is the largest difference of its entries over the largest entry; of
a mass matrix, the largest |dM_ij| / sqrt(M_ii M_jj), so that small links count as much as the whole robot.
Afterwards the comparison itself is tested: every quantity is perturbed by 1e-9 in one entry and must then be refused.

usage: with_pinocchio.py PEER [--states N] [--seed N]
"""

import argparse
import json
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin

TOLERANCE = 1e-10
PERTURBATION = 1e-9
ROOT = pathlib.Path(__file__).resolve().parents[2]
LWA = pin.LOCAL_WORLD_ALIGNED


def talos(name):
    data = pathlib.Path(pin.__file__).parents[4] / "share/example-robot-data/robots"
    return (data / "talos_data/robots" / name).read_text()


class Robot:
    def __init__(self, name, urdf):
        self.name, self.urdf = name, urdf
        root = ET.fromstring(urdf)
        joints = root.findall("joint")
        children = {j.find("child").get("link") for j in joints}
        self.base = next(l.get("name") for l in root.findall("link") if l.get("name") not in children)
        self.joints = self.parents_first(joints)
        self.model = pin.buildModelFromXML(urdf, pin.JointModelFreeFlyer())
        rng = np.random.default_rng(7)
        links = [l.get("name") for l in root.findall("link")]
        self.frames = []
        for link in links:
            offset = rng.uniform(-0.3, 0.3, 3)
            body = self.model.frames[self.model.getBodyId(link)]
            frame = pin.Frame(f"point on {link}", body.parentJoint, self.model.getBodyId(link),
                              body.placement * pin.SE3(np.eye(3), offset), pin.FrameType.OP_FRAME)
            self.frames.append((link, offset, self.model.addFrame(frame)))
        self.data = self.model.createData()
        # Where our coordinates lie in Pinocchio's, which orders joints by its own rule.
        ids = [self.model.getJointId(j) for j in self.joints]
        self.v_at = np.r_[0:6, [self.model.joints[i].idx_v for i in ids]].astype(int)
        self.q_of = [(self.model.joints[i].idx_q, self.model.joints[i].nq) for i in ids]

    def parents_first(self, joints):
        """Movable joints in the order of a walk from the base, which is not Pinocchio's order."""
        order, stack = [], [self.base]
        while stack:
            link = stack.pop()
            for j in (j for j in joints if j.find("parent").get("link") == link):
                if j.get("type") != "fixed":
                    order.append(j.get("name"))
                stack.append(j.find("child").get("link"))
        # A joint in the walk comes after its parent, siblings in any order.
        return order

    def q(self, ours):
        q = np.empty(self.model.nq)
        q[:7] = ours[:7]
        for angle, (at, n) in zip(ours[7:], self.q_of):
            q[at:at + n] = angle if n == 1 else (np.cos(angle), np.sin(angle))
        return q

    def v(self, ours):
        v = np.empty(self.model.nv)
        v[self.v_at] = ours
        return v


def states(robot, count, rng):
    n = len(robot.joints)
    for _ in range(count):
        quaternion = rng.normal(size=4)
        q = np.r_[rng.uniform(-2, 2, 3), quaternion / np.linalg.norm(quaternion), rng.uniform(-np.pi, np.pi, n)]
        k = int(rng.integers(len(robot.frames)))
        yield {"q": q, "v": rng.normal(size=6 + n) * 2, "a": rng.normal(size=6 + n) * 5,
               "force": rng.normal(size=6 + n) * 30, "dt": float(rng.choice([1e-6, 1e-3, 0.1, 1.0])),
               "wrench": rng.normal(size=6) * 100, "frame": k}


def reference(r, s):
    """All quantities of one state as Pinocchio has them, in our order of joints."""
    m, d, at = r.model, r.data, r.v_at
    q, v, a = r.q(s["q"]), r.v(s["v"]), r.v(s["a"])
    frame = r.frames[s["frame"]][2]
    out = {}
    mass = pin.crba(m, d, q)
    mass = np.triu(mass) + np.triu(mass, 1).T
    out["mass_matrix"] = mass[np.ix_(at, at)]
    h = pin.nonLinearEffects(m, d, q, v)[at]
    out["nonlinear_terms"] = h
    out["inverse_dynamics"] = pin.rnea(m, d, q, v, a)[at]
    out["forward_dynamics"] = pin.aba(m, d, q, v, r.v(s["force"]))[at]
    out["articulated"] = out["forward_dynamics"]
    out["base_mass"] = out["mass_matrix"][:6, :6]
    out["base_bias"] = h[:6] + out["mass_matrix"][:6, 6:] @ s["a"][6:]
    out["solve"] = np.linalg.solve(out["mass_matrix"], s["force"])

    pin.forwardKinematics(m, d, q, v, 0 * a)
    pin.updateFramePlacements(m, d)
    positions = [d.oMf[f].translation.copy() for _, _, f in r.frames]
    rotations = [d.oMf[f].rotation.copy() for _, _, f in r.frames]
    velocities = [pin.getFrameVelocity(m, d, f, LWA).vector for _, _, f in r.frames]
    biases = [pin.getFrameClassicalAcceleration(m, d, f, LWA).vector for _, _, f in r.frames]
    out["positions"], out["rotations"] = np.array(positions), np.array(rotations)
    out["velocities"], out["biases"] = np.array(velocities), np.array(biases)
    jacobian = pin.computeFrameJacobian(m, d, q, frame, LWA)[:, at]
    out["jacobian"], out["jacobian_of_joints"] = jacobian, jacobian[:, 6:]
    out["wrench"] = jacobian.T @ s["wrench"]

    pin.centerOfMass(m, d, q, v, 0 * a)
    out["cog"], out["cog_velocity"], out["cog_bias"] = d.com[0].copy(), d.vcom[0].copy(), d.acom[0].copy()
    jacobian = pin.jacobianCenterOfMass(m, d, q)[:, at]
    out["cog_jacobian"], out["cog_jacobian_of_joints"] = jacobian, jacobian[:, 6:]
    momentum = pin.computeCentroidalMomentum(m, d, q, v)
    out["momentum"], out["angular_momentum"] = momentum.linear.copy(), momentum.angular.copy()
    out["energy"] = np.array([pin.computeKineticEnergy(m, d, q, v), pin.computePotentialEnergy(m, d, q)])

    following = pin.integrate(m, q, v * s["dt"])
    out["integrate"] = one_cover(following[:7])
    return out


def one_cover(pose):
    """Of the two quaternions of a rotation the one whose largest entry is positive."""
    quaternion = np.array(pose[3:])
    return np.r_[pose[:3], quaternion * np.sign(quaternion[np.abs(quaternion).argmax()])]


def error(name, ours, peer):
    if name in ("mass_matrix", "base_mass"):
        own_scale = np.sqrt(np.diag(peer))
        return (np.abs(ours - peer) / np.outer(own_scale, own_scale)).max()
    scale = np.abs(peer).max()
    return np.abs(ours - peer).max() / (scale if scale > 0 else 1.0)


def compare(peers, ours):
    """Largest error of each quantity over all states; NaN counts as infinitely wrong."""
    worst = {}
    for peer, own in zip(peers, ours):
        for name, value in peer.items():
            e = error(name, np.array(own[name]).reshape(value.shape), value)
            worst[name] = max(worst.get(name, 0.0), e if np.isfinite(e) else np.inf)
    return worst


def comparison_notices(peers, ours):
    """Names of the quantities whose perturbation would not be noticed."""
    missed = []
    for name in peers[0]:
        k = len(peers) // 2
        value = np.array(ours[k][name], dtype=float)
        at = np.unravel_index(np.abs(value).argmax(), value.shape)
        value[at] *= 1 + PERTURBATION
        wrong = list(ours)
        wrong[k] = {**ours[k], name: value}
        if compare(peers, wrong)[name] <= TOLERANCE:
            missed.append(name)
    return missed


def run(peer, robot, count, seed):
    rng = np.random.default_rng(seed)
    cases = list(states(robot, count, rng))
    listed = [{k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in s.items()} for s in cases]
    request = {"urdf": robot.urdf, "base": robot.base, "joints": robot.joints,
               "frames": [[link, offset.tolist()] for link, offset, _ in robot.frames], "states": listed}
    answer = subprocess.run([peer], input=json.dumps(request), stdout=subprocess.PIPE, text=True, check=True)
    ours = json.loads(answer.stdout)
    for own in ours:
        own["integrate"] = one_cover(own["integrate"])
    assert len(ours) == count, f"{len(ours)} answers to {count} states"
    peers = [reference(robot, s) for s in cases]
    worst = compare(peers, ours)
    print(f"{robot.name}: {len(robot.joints)} joints, {len(robot.frames)} frames, {count} states, "
          f"mass {pin.computeTotalMass(robot.model):.3f} kg")
    for name, e in worst.items():
        print(f"  {name:24s} {e:9.2e} {'' if e <= TOLERANCE else 'ABOVE ' + str(TOLERANCE)}")
    missed = comparison_notices(peers, ours)
    if missed:
        print(f"  a perturbation of {PERTURBATION} was not noticed in: {', '.join(missed)}")
    return all(e <= TOLERANCE for e in worst.values()) and not missed


def main():
    parser = argparse.ArgumentParser(description="compare crates/multibody with Pinocchio")
    parser.add_argument("peer")
    parser.add_argument("--states", type=int, default=250)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    robots = [Robot("lola", (ROOT / "config/robots/lola/lola.urdf").read_text()),
              Robot("talos_reduced", talos("talos_reduced.urdf")), Robot("talos_full_v2", talos("talos_full_v2.urdf"))]
    good = [run(options.peer, robot, options.states, options.seed) for robot in robots]
    print("all within", TOLERANCE) if all(good) else print("FAILED")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
