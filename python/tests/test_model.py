"""Kinematics and dynamics against themselves by another route, and against Pinocchio where it is installed (tests/peers/python.sh)."""

import json
import pathlib
import unittest

import numpy as np
from places import MANY, ROOT, rng

import gangwerk

try:
    import pinocchio as pin
except ImportError:
    pin = None

ROBOTS = sorted(path.name for path in (ROOT / "config/robots").iterdir() if path.is_dir())
# Largest difference over the largest entry of a quantity.
TOLERANCE = 1e-10


def state(model, random):
    """A random configuration, velocity, acceleration, force, and a point of a link."""
    quaternion = random.normal(size=4)
    q = np.r_[random.uniform(-2, 2, 3), quaternion / np.linalg.norm(quaternion), random.uniform(-np.pi, np.pi, model.n)]
    v, a, f = random.normal(size=(3, model.nv)) * np.array([[2], [5], [30]])
    return q, v, a, f, str(random.choice(model.link_names)), random.uniform(-0.3, 0.3, 3)


def error(ours, theirs):
    """Largest difference over the largest entry."""
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    assert ours.shape == theirs.shape, (ours.shape, theirs.shape)
    return np.abs(ours - theirs).max() / max(np.abs(theirs).max(), 1e-12)


class Identities(unittest.TestCase):
    def test_every_quantity_by_another_route(self):
        random = rng(11)
        for name in ROBOTS:
            m = gangwerk.Model(name)
            for _ in range(3 * MANY):
                q, v, a, f, link, offset = state(m, random)
                mass, h = m.mass_matrix(q), m.nonlinear_terms(q, v)
                self.assertLess(error(mass @ a + h, m.inverse_dynamics(q, v, a)), 1e-9)
                self.assertLess(error(m.inverse_dynamics(q, v, m.forward_dynamics(q, v, f)), f), 1e-7)
                self.assertLess(error(m.energy(q, v)[0], 0.5 * v @ mass @ v), 1e-9)
                self.assertLess(error(m.momentum(q, v)[:3], m.mass * (m.com_jacobian(q) @ v)), 1e-9)
                self.assertLess(error(m.jacobian(q, link, offset) @ v, m.velocity(q, v, link, offset)), 1e-9)
                # Central differences along the motion.
                step = 1e-6
                ahead, behind = m.integrate(q, v, step), m.integrate(q, v, -step)
                derived = (m.pose(ahead, link, offset) - m.pose(behind, link, offset))[:3, 3] / (2 * step)
                self.assertLess(error(derived, m.velocity(q, v, link, offset)[:3]), 1e-6)
                self.assertLess(error((m.com(ahead) - m.com(behind)) / (2 * step), m.com_jacobian(q) @ v), 1e-6)

    def test_an_own_urdf_is_the_shipped_robot(self):
        for name in ROBOTS:
            shipped = gangwerk.Model(name)
            path = next((ROOT / "config/robots" / name).glob("*.urdf"))
            own = gangwerk.Model.from_urdf(str(path))
            text = gangwerk.Model.from_urdf(path.read_text(), joints=shipped.joint_names)
            self.assertEqual(sorted(own.joint_names), sorted(shipped.joint_names))
            q, v, a, *_ = state(shipped, rng(12))
            np.testing.assert_array_equal(text.inverse_dynamics(q, v, a), shipped.inverse_dynamics(q, v, a))
            place = [shipped.joint_names.index(joint) for joint in own.joint_names]
            order = np.r_[0:6, 6 + np.array(place)]
            theirs = shipped.inverse_dynamics(q, v, a)[order]
            ours = own.inverse_dynamics(np.r_[q[:7], q[7:][place]], v[order], a[order])
            self.assertLess(error(ours, theirs), 1e-10)
            self.assertEqual(own.mass, shipped.mass)

    def test_a_pose_of_the_robots_file_stands_level(self):
        m = gangwerk.Model("lola")
        q = m.neutral("stand")
        feet = [link for link in m.link_names if "foot" in link or "toe" in link]
        self.assertTrue(feet, m.link_names)
        for foot in feet:
            np.testing.assert_allclose(m.pose(q, foot)[:3, :3], np.eye(3), atol=0.02, err_msg=foot)


@unittest.skipIf(pin is None, "Pinocchio is not installed")
class Pinocchio(unittest.TestCase):
    def test_random_configurations(self):
        random, worst = rng(13), {}
        for name in ROBOTS:
            ours = gangwerk.Model(name)
            path = next((ROOT / "config/robots" / name).glob("*.urdf"))
            theirs = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
            data = theirs.createData()
            joints = [theirs.joints[theirs.getJointId(joint)] for joint in ours.joint_names]
            at = np.r_[0:6, [joint.idx_v for joint in joints]].astype(int)
            for _ in range(30 * MANY):
                q, v, a, f, link, offset = state(ours, random)
                q_pin, (v_pin, a_pin, f_pin) = np.empty(theirs.nq), np.empty((3, theirs.nv))
                q_pin[:7] = q[:7]
                for angle, joint in zip(q[7:], joints):
                    q_pin[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 1 else (np.cos(angle), np.sin(angle))
                v_pin[at], a_pin[at], f_pin[at] = v, a, f
                mass = pin.crba(theirs, data, q_pin)
                mass = (np.triu(mass) + np.triu(mass, 1).T)[np.ix_(at, at)]
                pin.forwardKinematics(theirs, data, q_pin, v_pin)
                frame = theirs.getFrameId(link)
                pose = pin.updateFramePlacement(theirs, data, frame) * pin.SE3(np.eye(3), offset)
                # A Jacobian at a point of the frame.
                jacobian = pin.computeFrameJacobian(theirs, data, q_pin, frame, pin.LOCAL_WORLD_ALIGNED)[:, at]
                arm = data.oMf[frame].rotation @ offset
                jacobian[:3] -= pin.skew(arm) @ jacobian[3:]
                found = {
                    "pose": (ours.pose(q, link, offset), pose.homogeneous),
                    "jacobian": (ours.jacobian(q, link, offset), jacobian),
                    "velocity": (ours.velocity(q, v, link, offset), jacobian @ v),
                    "com": (ours.com(q), pin.centerOfMass(theirs, data, q_pin).copy()),
                    "com_jacobian": (ours.com_jacobian(q), pin.jacobianCenterOfMass(theirs, data, q_pin)[:, at]),
                    "mass_matrix": (ours.mass_matrix(q), mass),
                    "nonlinear_terms": (ours.nonlinear_terms(q, v), pin.nonLinearEffects(theirs, data, q_pin, v_pin)[at]),
                    "inverse_dynamics": (ours.inverse_dynamics(q, v, a), pin.rnea(theirs, data, q_pin, v_pin, a_pin)[at]),
                    "forward_dynamics": (ours.forward_dynamics(q, v, f), pin.aba(theirs, data, q_pin, v_pin, f_pin)[at]),
                }
                for quantity, pair in found.items():
                    worst[quantity] = max(worst.get(quantity, 0.0), error(*pair))
        print(f"largest error against Pinocchio, {', '.join(ROBOTS)}, {30 * MANY} configurations each:")
        print(json.dumps({quantity: float(f"{e:.1e}") for quantity, e in worst.items()}))
        self.assertEqual(len(worst), 9)
        self.assertLess(max(worst.values()), TOLERANCE, worst)


if __name__ == "__main__":
    unittest.main()
