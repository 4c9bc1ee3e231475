"""Wrong arguments become Python exceptions that name argument, value and range, and never end the interpreter."""

import pathlib
import tempfile
import unittest

import numpy as np
from places import MANY, rng

import gangwerk

REFUSALS = (ValueError, TypeError, gangwerk.Refused, OverflowError, OSError)
CHAIN = gangwerk.Chain("stand")
MODEL = gangwerk.Model("lola")
Q, V = MODEL.neutral("stand"), np.zeros(MODEL.nv)
PLAN = gangwerk.plan("walk_1kmh", "walk/velocity", forward=0.2)
LINK = MODEL.link_names[-1]
URDF = """<robot name="r"><link name="base"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="leg"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hip" type="continuous"><parent link="base"/><child link="leg"/><axis xyz="0 1 0"/></joint></robot>"""

# What is called, and what its message must hold: name of the argument, value, range or what there is.
SAID = [
    (lambda: gangwerk.Chain("walk_60"), ["there is no scene `walk_60`", "walk_60s"]),
    (lambda: gangwerk.Chain("stand", depth=6), ["depth = 6", "[1, 5]"]),
    (lambda: gangwerk.Chain("stand", depth=2.5), ["depth = 2.5", "whole number in [1, 5]"]),
    (lambda: gangwerk.Chain("stand", seed=-1), ["seed = -1", "[0, 18446744073709551615]"]),
    (lambda: gangwerk.Chain("stand", integrator="eulr"), ["integrator `eulr`", "did you mean euler"]),
    (lambda: gangwerk.Chain("stand", integrator="bdf"), ["integrator = 'bdf'", "tolerance"]),
    (lambda: gangwerk.Chain("stand", substeps=0), ["substeps = 0", "[1, 1000]"]),
    (lambda: gangwerk.Chain("stand", depth=3, integrator="euler", substeps=1), ["substeps = 1", "largest stable one", "semi_implicit"]),
    (lambda: gangwerk.Chain("walk_auto", depth=2), ["walk_auto", "auto", "integrator and substeps"]),
    (lambda: gangwerk.Chain("stand", config="/nowhere"), ["/nowhere", "no configuration"]),
    (lambda: CHAIN.step(-1), ["n = -1", "[0, 1000000000]"]),
    (lambda: CHAIN.step(1.5), ["n = 1.5", "whole number"]),
    (lambda: CHAIN.step(10**30), ["n = 1000000", "[0, 1000000000]"]),
    (lambda: CHAIN.run(float("nan")), ["until = nan", "1000000] s"]),
    (lambda: CHAIN.run(-3), ["until = -3", "s"]),
    (lambda: CHAIN.run("soon"), ["until = 'soon'", "must be a number"]),
    (lambda: CHAIN.trace(["sim_state.cog"], 1e-3), ["field `cog`", "com"]),
    (lambda: CHAIN.trace(["sim.com"], 1e-3), ["topic `sim`", "sim_state"]),
    (lambda: CHAIN.trace(["sim_state.com"], 9e5), ["until", "every"]),
    (lambda: CHAIN.trace(["sim_state.com"], 1e-3, every=0), ["every = 0", "[1,"]),
    (lambda: CHAIN.get("com"), ["topic `com`", "TOPIC.FIELD"]),
    (lambda: CHAIN.view("sensors.power"), ["field = 'sensors.power'", "counted"]),
    (lambda: CHAIN.command("walk/fly"), ["topic `walk/fly`"]),
    (lambda: CHAIN.command("walk/velocity", forwards=1), ["field `forwards`", "forward"]),
    (lambda: CHAIN.command("walk/velocity", forward=float("nan")), ["forward = NaN", "[-2, 2] m/s"]),
    (lambda: CHAIN.command("walk/velocity", forward=9), ["forward = 9", "[-2, 2] m/s"]),
    (lambda: CHAIN.command("walk/velocity", forward="fast"), ["forward", "str", "[-2, 2] m/s"]),
    (lambda: CHAIN.command("walk/velocity", **{"forward=1 turn": 1}), ["no field `forward=1 turn`"]),
    (lambda: CHAIN.command("walk/step", length=0.1), ["duration is missing", "[0.3, 5] s"]),
    (lambda: CHAIN.push([0, 0], 0.1), ["force has the shape (2)", "3"]),
    (lambda: CHAIN.push([0, 0, np.inf], 0.1), ["force[2] = inf", "[-5000, 5000]"]),
    (lambda: CHAIN.push("north", 0.1), ["force = 'north'", "array of numbers"]),
    (lambda: CHAIN.push([0, 0, 1], 11), ["duration = 11", "[0, 10] s"]),
    (lambda: CHAIN.push([0, 0, 1], 0.1, at=-1), ["at = -1", "[0, 1000000] s"]),
    (lambda: (CHAIN.copy(), CHAIN.copy().step(0), _pushed_twice()), ["at = 2.05 s", "one at a time"]),
    (lambda: CHAIN.set_parameter("planner.swing_height", float("inf")), ["value = inf"]),
    (lambda: CHAIN.get_parameter("swing"), ["parameter `swing`", "planner.swing_height"]),
    (lambda: CHAIN.log("/nowhere/a.mcap"), ["/nowhere/a.mcap"]),
    (lambda: gangwerk.plan("walk_1kmh", "walk/stop"), ["command = 'walk/stop'", "walk/velocity"]),
    (lambda: gangwerk.plan("walk_1kmh", "walk/velocity", forward=1.9), ["forward = 1.9 m/s: at most"]),
    (lambda: PLAN.sample([[0.0]]), ["times has the shape (1, 1)"]),
    (lambda: PLAN.sample([0.0, np.nan]), ["times[1] = NaN", "[-1000000, 1000000]"]),
    (lambda: gangwerk.Model("lolla"), ["lolla"]),
    (lambda: gangwerk.Model("../../etc"), ["robot = '../../etc'", "config/robots"]),
    (lambda: gangwerk.Model.from_urdf("/nowhere.urdf"), ["urdf = '/nowhere.urdf'"]),
    (lambda: gangwerk.Model.from_urdf("<robot"), ["URDF cannot be read"]),
    (lambda: gangwerk.Model.from_urdf(URDF, base="leg"), ["base"]),
    (lambda: gangwerk.Model.from_urdf(URDF, joints=["knee"]), ["joint `knee`"]),
    (lambda: gangwerk.Model.from_urdf(URDF.replace('value="1"', 'value="-1"')), ["inertia of link `leg`"]),
    (lambda: MODEL.neutral("sit"), ["pose `sit`", "stand"]),
    (lambda: MODEL.com(Q[1:]), [f"q has the shape ({MODEL.nq - 1})", str(MODEL.nq)]),
    (lambda: MODEL.com(Q * 2), ["q[3:7]", "length 1"]),
    (lambda: MODEL.pose(Q, "knee"), ["link `knee`"]),
    (lambda: MODEL.pose(Q, LINK, [0, 0, 1e7]), ["offset[2] = 10000000", "[-1000000, 1000000]"]),
    (lambda: MODEL.inverse_dynamics(Q, V, V + np.nan), ["acceleration[0] = NaN"]),
    (lambda: MODEL.forward_dynamics(Q, V, V[:-1]), ["force has the shape"]),
    (lambda: MODEL.integrate(Q, V, np.nan), ["dt = nan", "[-1000, 1000] s"]),
    (lambda: gangwerk.Log("/nowhere.mcap"), ["/nowhere.mcap"]),
    (lambda: gangwerk.Log(__file__), [pathlib.Path(__file__).name]),
    (lambda: gangwerk.scenes(config="/nowhere"), ["/nowhere"]),
    (lambda: gangwerk.Chian, ["Chian"]),
]


def _pushed_twice():
    chain = CHAIN.copy()
    chain.push([0, 0, 1], 0.1, at=2.0)
    chain.push([0, 0, 1], 0.1, at=2.05)


class Arguments(unittest.TestCase):
    def test_what_is_wrong_is_named(self):
        for k, (call, words) in enumerate(SAID):
            with self.subTest(k=k, words=words):
                with self.assertRaises(REFUSALS + (AttributeError,)) as caught:
                    call()
                missing = [word for word in words if word not in str(caught.exception)]
                self.assertFalse(missing, str(caught.exception))

    def test_a_refusal_changes_nothing(self):
        before = CHAIN.tick, CHAIN.get("sim_state.com").tobytes(), CHAIN.figures()
        for call, _ in SAID:
            try:
                call()
            except Exception:
                pass
        self.assertEqual(before, (CHAIN.tick, CHAIN.get("sim_state.com").tobytes(), CHAIN.figures()))

    def test_nothing_ends_the_interpreter(self):
        """Every public callable with arguments from a pool of nonsense: it answers, or raises."""
        random = rng(7)
        nan, inf = float("nan"), float("inf")
        pool = [None, "", "lola", "stand", "walk/velocity", "sim_state.com", LINK, "\0", "é" * 300, b"x", 0, 1, -1, 7, 2**63, 10**40, 0.5, nan, inf, -inf, 1e308,
                [], [nan] * 3, [1, 2, 3], [[1], [2, 3]], Q, V, Q * nan, np.zeros(0), np.zeros((2, 3)), np.ones(MODEL.nq), 1e6 * np.ones(MODEL.nv), np.array(["a"]),
                {}, object(), CHAIN.save(), CHAIN, PLAN, MODEL, True, 1j]
        with tempfile.TemporaryDirectory() as place:
            chain = gangwerk.Chain("stand")
            mute = {"log", "step", "run", "trace"}
            calls = [getattr(of, name) for of in (chain, MODEL, PLAN) for name in dir(of) if not name.startswith("_") and name not in mute and callable(getattr(of, name))]
            calls += [gangwerk.Chain, gangwerk.Model, gangwerk.Model.from_urdf, gangwerk.plan, gangwerk.Log, gangwerk.scenes, gangwerk.State, gangwerk.Plan, gangwerk.Event]
            keys = ["depth", "seed", "integrator", "substeps", "config", "at", "offset", "fields", "begin", "end", "base", "joints", "forward", "every", "until"]
            raised = 0
            for call in calls:
                for _ in range(30 * MANY):
                    given = [pool[i] for i in random.integers(0, len(pool), random.integers(0, 4))]
                    named = {keys[i]: pool[j] for i, j in random.integers(0, min(len(keys), len(pool)), (random.integers(0, 3), 2))}
                    try:
                        call(*given, **named)
                    except REFUSALS:
                        raised += 1
            # Those that may take long, briefly.
            for call in (chain.step, chain.run, chain.trace):
                for value in pool:
                    if not isinstance(value, (int, float)) or not 0 <= value <= 1e9:
                        try:
                            call(value)
                        except REFUSALS:
                            raised += 1
        self.assertGreater(raised, 500)
        self.assertGreaterEqual(chain.tick, 0)
        chain.step(10)


if __name__ == "__main__":
    unittest.main()
