"""The chain from Python is the one of `gangwerk sim`, can be copied, pushed, commanded and looked at."""

import json
import pathlib
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np
from places import DURATION, GANGWERK, MANY, METHODS, rng, same, scene, sim

import gangwerk


class InDirectory(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)


def everything(chain, until):
    """All fields of every cycle."""
    return chain.trace([name for name, _, _ in chain.fields()], until)


class SameBytes(InDirectory):
    def test_a_chain_writes_the_log_of_gangwerk_sim(self):
        """Every type once, and further ones by chance: the files are equal, byte by byte, and so are the figures."""
        random = rng(1)
        methods = METHODS + [METHODS[i] for i in random.integers(0, 4, 4 * (MANY - 1))]
        for k, method in enumerate(methods):
            duration = DURATION[method[0]] * (1 if MANY == 1 else 2)
            path = scene(self.place / f"place{k}.toml", random, method, duration)
            theirs = json.loads(sim(path, "--json", "--log", self.place / "sim.mcap"))
            chain = gangwerk.Chain(str(path))
            chain.log(self.place / "python.mcap")
            # In pieces, which must not matter.
            chain.step(int(random.integers(0, 800 * duration)))
            figures = chain.run()
            chain.end_log()
            equal = subprocess.run([GANGWERK, "log", "compare", self.place / "sim.mcap", self.place / "python.mcap"], capture_output=True, text=True)
            self.assertEqual(equal.returncode, 0, f"{method}: {equal.stdout}")
            said = subprocess.run([GANGWERK, "-V"], capture_output=True, text=True).stdout
            if gangwerk.version in said:
                files = [(self.place / name).read_bytes() for name in ("sim.mcap", "python.mcap")]
                self.assertEqual(files[0], files[1], "the files, with all that is about them")
            self.assertEqual({name: theirs[name] for name in figures}, figures)
            self.assertGreater(len(figures), 25)

    def test_depth_and_seed_are_those_of_a_scene_that_says_them(self):
        random = rng(2)
        for depth, integrator, substeps in METHODS[:4]:
            path = scene(self.place / "one.toml", random, METHODS[0], 1.5)
            seed = int(random.integers(1, 1 << 40))
            text = path.read_text()
            lines = {"depth": depth, "integrator": f'"{integrator}"', "substeps": substeps, "seed": seed}
            said = "\n".join(f"{line.split(' = ')[0]} = {lines.pop(line.split(' = ')[0])}" if line.split(" = ")[0] in lines else line for line in text.splitlines())
            self.assertEqual(lines, {})
            (self.place / "two.toml").write_text(said)
            given = gangwerk.Chain(str(path), depth=depth, integrator=integrator, substeps=substeps, seed=seed)
            read = gangwerk.Chain(str(self.place / "two.toml"))
            ours, theirs = everything(given, 1.5), everything(read, 1.5)
            self.assertIsNone(same(ours, theirs))
            other = everything(gangwerk.Chain(str(path), depth=depth, integrator=integrator, substeps=substeps, seed=seed + 1), 1.5)
            self.assertIsNotNone(same(ours, other), "another seed is another walk")


class Copies(InDirectory):
    def test_a_restored_chain_goes_on_with_the_same_bytes(self):
        """From a random instant, with a push and a command still to come; the pads and the adaptive integrator too."""
        random = rng(3)
        bdf = "\n".join(["depth = 2", 'integrator = "bdf"', "tolerance = 1e-6", "substeps = 1"])
        for method in METHODS + ["bdf"]:
            length = 0.1 if method == "bdf" else DURATION[method[0]]
            path = scene(self.place / "walk.toml", random, METHODS[2] if method == "bdf" else method, 8.0)
            if method == "bdf":
                text = path.read_text().replace('depth = 2\nintegrator = "semi_implicit"\nsubsteps = 4', bdf)
                path.write_text(text)
                self.assertIn("bdf", text)
            chain = gangwerk.Chain(str(path))
            chain.run(random.uniform(0.2, 0.9) * length)
            chain.push([5.0, -4.0, 0.0], 0.1, at=chain.time + random.uniform(0.3, 0.6) * length)
            chain.set_parameter("planner.swing_height", 0.06)
            state, copy = chain.save(), chain.copy()
            at = chain.time
            end = at + length
            first = everything(chain, end)
            self.assertIsNone(same(first, everything(copy, end)), f"{method}: a copy")
            self.assertEqual([str(e) for e in chain.events()], [str(e) for e in copy.events()])
            self.assertEqual(chain.figures(), copy.figures())
            chain.restore(state)
            self.assertEqual(chain.time, at)
            self.assertIsNone(same(first, everything(chain, end)), f"{method}: restored")
            # Twice, and after somebody has disturbed it.
            chain.restore(state)
            chain.command("walk/stop")
            chain.run(end)
            chain.restore(state)
            self.assertIsNone(same(first, everything(chain, end)), f"{method}: restored after another future")

    def test_a_state_of_another_scene_is_refused(self):
        state = gangwerk.Chain("walk_1kmh").save()
        with self.assertRaisesRegex(ValueError, "state is one of walk_1kmh .*: this is walk_2kmh"):
            gangwerk.Chain("walk_2kmh").restore(state)


class Operator(InDirectory):
    def standing(self, **options):
        chain = gangwerk.Chain("stand", **options)
        chain.run(4.0)
        self.assertEqual(chain.gait, "standing")
        return chain

    def test_commands_are_answered_as_by_the_broker(self):
        chain = gangwerk.Chain("stand")
        with self.assertRaisesRegex(gangwerk.Refused, "^walk/velocity refused by planner: .*walk/stand") as caught:
            chain.command("walk/velocity", forward=0.3)
        self.assertIn(caught.exception.code, (31, 32))
        chain = self.standing()
        tick = chain.tick
        with self.assertRaisesRegex(gangwerk.Refused, "walk/velocity refused by planner: forward = 1.9 m/s: at most [0-9.]+$") as caught:
            chain.command("walk/velocity", forward=1.9)
        self.assertEqual(caught.exception.code, 30)
        with self.assertRaisesRegex(gangwerk.Refused, "system/reset refused by watchdog: no effect"):
            chain.command("system/reset")
        with self.assertRaisesRegex(gangwerk.Refused, "joint/home refused by lowlevel"):
            chain.command("joint/home")
        with self.assertRaisesRegex(gangwerk.Refused, "sim/lower refused by sim-backend"):
            chain.command("sim/lower", distance=0.1)
        with self.assertRaisesRegex(gangwerk.Refused, "system/end .* no supervisor"):
            chain.command("system/end")
        self.assertEqual((chain.command("walk/velocity", forward=0.3), chain.command("head/joints", pan=0.2)), ("planner", "controller"))
        self.assertEqual(chain.tick, tick, "the answer takes no time")
        begin = chain.torso_position[0]
        chain.run(8.0)
        self.assertEqual(chain.gait, "walking")
        self.assertGreater(chain.torso_position[0] - begin, 0.5)
        # In the order in which they were given.
        self.assertEqual([chain.command("walk/stop"), chain.command("walk/velocity", forward=0.2)], ["planner"] * 2)
        chain.run(12.0)
        self.assertEqual(chain.gait, "walking")
        self.assertEqual(chain.command("system/emergency_stop"), "watchdog")
        chain.step(5)
        self.assertFalse(chain.powered)
        told = [event for event in chain.events() if event.name == "PowerOff"]
        self.assertEqual(len(told), 1)
        self.assertIn("system/reset", told[0].text)
        self.assertAlmostEqual(told[0].time, 12.0, delta=0.01)

    def test_a_push_is_that_of_a_scene(self):
        random = rng(4)
        for _ in range(3 * MANY):
            at, force, duration = random.uniform(1.0, 2.0), random.uniform(-60, 60, 3), random.uniform(0.01, 0.2)
            place = random.bit_generator.state
            path = scene(self.place / "plain.toml", random, METHODS[0], 3.0)
            random.bit_generator.state = place
            numbers = ", ".join(map(repr, force.tolist()))
            pushed = scene(self.place / "pushed.toml", random, METHODS[0], 3.0, f"\n[[push]]\ntime = {at!r}\nforce = [{numbers}]\nduration = {duration!r}\n")
            chain = gangwerk.Chain(str(path))
            chain.push(force, duration, at=at)
            ours = everything(chain, 3.0)
            self.assertIsNone(same(ours, everything(gangwerk.Chain(str(pushed)), 3.0)))
            acting = np.abs(ours["sim_state.push"]).max(axis=1) > 0
            self.assertAlmostEqual(acting.sum() * 1e-3, duration, delta=1.1e-3)

    def test_five_lines_survive_pushes(self):
        chain = gangwerk.Chain("walk_1kmh")
        chain.run(6.0)
        survived = {}
        for impulse in (0.05, 0.15, 0.65):  # N s/kg, to the left
            pushed = chain.copy()
            pushed.push([0, impulse * 60.9 / 0.1, 0], duration=0.1)
            survived[impulse] = not pushed.run(11.0)["fell"]
        self.assertTrue(survived[0.05] and not survived[0.65], survived)
        self.assertFalse(chain.fallen)

    def test_parameters_are_those_of_the_registry(self):
        chain = self.standing()
        height = chain.parameters()["planner.swing_height"]
        self.assertEqual((height.unit, height.change, height.value), ("m", "live", height.default))
        self.assertEqual(chain.set_parameter("planner.swing_height", 0.08), "planner")
        chain.step()
        self.assertEqual(chain.get_parameter("planner.swing_height"), 0.08)
        self.assertEqual(chain.parameters()["planner.swing_height"].default, height.default)
        self.assertEqual(chain.set_parameter("height_p", 1234.0), "controller")
        chain.step()
        self.assertEqual(chain.get_parameter("controller.height_p"), 1234.0)
        with self.assertRaisesRegex(gangwerk.Refused, r"0.5 is outside of \[0, 0.15\] m"):
            chain.set_parameter("planner.swing_height", 0.5)
        with self.assertRaisesRegex(gangwerk.Refused, "fixed at start: change it in config/system.toml"):
            chain.set_parameter("lowlevel.bus.missed", 10)
        with self.assertRaisesRegex(ValueError, "did you mean planner.swing_height"):
            chain.set_parameter("swing_hieght", 0.05)


class Looked(unittest.TestCase):
    def test_views_follow_and_copies_do_not(self):
        chain = gangwerk.Chain("walk_1kmh")
        chain.run(1.0)
        view, copy = chain.view("sim_state.joint_angle"), chain.joint_angle
        self.assertIs(chain.view("sim_state.joint_angle").base, view.base)
        np.testing.assert_array_equal(view, copy)
        state = chain.save()
        chain.run(1.5)
        self.assertGreater(np.abs(view - copy).max(), 1e-4)
        np.testing.assert_array_equal(view, chain.joint_angle)
        chain.restore(state)
        np.testing.assert_array_equal(view, copy)
        with self.assertRaises(ValueError):
            view[0] = 1.0
        feet = chain.view("sim_state.foot_wrench.force")
        del chain
        self.assertGreater(feet[:, 2].sum(), 300.0, "a view outlives its chain")

    def test_what_is_seen_makes_sense(self):
        chain = gangwerk.Chain("walk_2kmh")
        chain.run(8.0)
        n = len(chain.joint_names)
        self.assertEqual((chain.joint_angle.shape, chain.joint_speed.shape, chain.joint_target.shape), ((n,),) * 3)
        self.assertLess(np.abs(chain.joint_angle - chain.joint_target).max(), 0.1)
        self.assertAlmostEqual(np.linalg.norm(chain.torso_orientation), 1.0)
        self.assertTrue(0.7 < chain.com[2] < 1.1, chain.com)
        self.assertTrue(chain.powered and not chain.fallen)
        trace = chain.trace(["sim_state.com", "sim_state.foot_wrench.force", "sensors.header.tick", "sensors.joint_speed", "sim_state.joint_angle"], 10.0, every=5)
        self.assertEqual(trace["sim_state.foot_wrench.force"].shape, (400, 2, 3))
        self.assertAlmostEqual(trace["sim_state.foot_wrench.force"][:, :, 2].sum(axis=1).mean(), 60.9 * 9.81, delta=15)
        self.assertEqual(trace["sensors.header.tick"].dtype, np.uint64)
        speed = np.polyfit(trace["time"], trace["sim_state.com"][:, 0], 1)[0]
        self.assertAlmostEqual(speed, chain.run(10.0)["mean_speed_m_s"], delta=0.03)
        # Measured speeds are the derivatives of true angles, but for the filter.
        derived = np.gradient(trace["sim_state.joint_angle"], trace["time"], axis=0)
        self.assertGreater(np.corrcoef(derived[:, 3], trace["sensors.joint_speed"][:, 3])[0, 1], 0.9)
        units = {name: unit for name, unit, _ in chain.fields()}
        self.assertEqual((units["sim_state.joint_angle"], units["sim_state.feet"], units["sensors.joint_speed"]), ("rad", "m, m, m, rad", "rad/s"))

    def test_a_plan_is_walked(self):
        """What is planned for a velocity has its speed, keeps the zero-moment point under the soles, and ends at rest."""
        random = rng(5)
        for forward in random.uniform(0.1, 0.5, 2 * MANY):
            plan = gangwerk.plan("walk_2kmh", "walk/velocity", forward=forward)
            times = np.linspace(0, plan.end, 400)
            way = plan.sample(times)
            self.assertEqual(plan.state, "starting")
            self.assertEqual((way["com"].shape, way["feet"].shape, way["zmp"].shape), ((400, 3), (400, 2, 4), (400, 2)))
            # Two routes to the velocity.
            np.testing.assert_allclose(np.gradient(way["com"], times, axis=0)[5:-5], way["com_velocity"][5:-5], atol=0.03)
            self.assertLess(np.abs(way["com_velocity"][-1]).max(), 1e-6)
            for step in plan.steps:
                middle = plan.sample([0.5 * (step["lift"] + step["end"])])
                sole = middle["feet"][0, 0 if step["stance"] == "right" else 1]
                ahead, left = np.array([[np.cos(sole[3]), np.sin(sole[3])], [-np.sin(sole[3]), np.cos(sole[3])]]) @ (middle["zmp"][0] - sole[:2])
                # Sole of Lola, from her robot.toml [m].
                self.assertTrue(-0.255 < ahead < 0.035 and abs(left) < 0.04, (ahead, left))
                np.testing.assert_allclose(sole[:2], step["foothold"][:2], atol=1e-6)
            longest = max(step["landing"][0] - step["foothold"][0] for step in plan.steps)
            self.assertGreater(longest, 0.05)

    def test_others_run_while_a_chain_does(self):
        chain = gangwerk.Chain("walk_1kmh")
        stop, count = threading.Event(), [0]

        def other():
            while not stop.is_set():
                count[0] += 1
                time.sleep(1e-4)

        thread = threading.Thread(target=other)
        thread.start()
        before = count[0]
        chain.step(8000)
        counted = count[0] - before
        stop.set()
        thread.join()
        self.assertGreater(counted, 50, "the interpreter's lock was held")


if __name__ == "__main__":
    unittest.main()
