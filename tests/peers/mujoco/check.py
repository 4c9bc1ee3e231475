"""Checks that MuJoCo simulates what we simulate, before its points are drawn beside ours.

usage: check.py OUR_PEER MADE     (the example `peer` of crates/multibody; the folder that build.sh made)

- states.py still writes the states that are here;
- mass matrix and nonlinear terms, in our coordinates, are those of crates/multibody; and the comparison would notice;
- a state comes back as it went in;
- free flight: orders of convergence, momentum, energy;
- standing: the ground carries the weight; a point of lola_layer sinks by what the spring of robot.toml gives way;
- block on an incline: slides with the acceleration of the friction cone, or of the pyramid.
"""

import json
import math
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROBOT = HERE.parents[2] / "config/robots/lola"
G = 9.81
TOLERANCE = 1e-9
PERTURBATION = 1e-8
failed = []


def expect(what, value, low, high):
    good = low <= value <= high
    if not good:
        failed.append(what)
    print(f"  {what:58s} {value:12.5e} {'' if good else f'NOT IN {low:g} .. {high:g}'}")


def read(path):
    rows = {line.split()[0]: line.split()[1:] for line in path.read_text().splitlines() if not line.startswith("#")}
    return rows["joints"], np.array(rows["q"], float), np.array(rows["v"], float)


def write(path, joints, q, v):
    rows = [["joints", *joints], ["q", *map(repr, q.tolist())], ["v", *map(repr, v.tolist())]]
    path.write_text("\n".join(" ".join(row) for row in rows) + "\n")


class Peer:
    def __init__(self, made):
        self.made = made

    def __call__(self, model, state, scene, **options):
        path = state if isinstance(state, Path) else HERE / f"states/{state}.txt"
        arguments = [f"{k}={v}" for k, v in {"scene": scene, "runs": 1, **options}.items()]
        command = [self.made / "peer", self.made / f"{model}.mjb", path, *arguments]
        return json.loads(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)


def states(made, scratch):
    subprocess.run([sys.executable, HERE / "states.py", ROBOT, made, scratch], check=True)
    print("states")
    for path in sorted((HERE / "states").glob("*.txt")):
        joints, *now = read(scratch / path.name)
        joints_here, *here = read(path)
        same = joints == joints_here
        difference = max(np.abs(a - b).max() for a, b in zip(now, here)) if same else math.inf
        expect(f"{path.name}: away from its formula", difference, 0, 1e-12)


def distance(name, ours, theirs):
    """Relative difference; of a mass matrix to sqrt(M_ii M_jj), so that small links count as the whole robot does."""
    if name == "mass_matrix":
        own = np.sqrt(np.diag(theirs))
        return (np.abs(ours - theirs) / np.outer(own, own)).max()
    return np.abs(ours - theirs).max() / np.abs(theirs).max()


def dynamics(our_peer, peer, scratch, model, urdf, base, state, count=20):
    """M and h of the state and of random ones."""
    joints, q, v = read(HERE / f"states/{state}.txt")
    rng = np.random.default_rng(3)
    cases = [(q, v)]
    for _ in range(count):
        quaternion = rng.normal(size=4)
        pose = np.r_[rng.uniform(-2, 2, 3), quaternion / np.linalg.norm(quaternion)]
        cases.append((np.r_[pose, rng.uniform(-np.pi, np.pi, len(joints))], 2 * rng.normal(size=v.size)))
    rest = {"a": [0.0] * v.size, "force": [0.0] * v.size, "wrench": [0.0] * 6, "frame": 0, "dt": 0.0}
    request = {"urdf": urdf, "base": base, "joints": joints, "frames": [[base, [0, 0, 0]]],
               "states": [{"q": q.tolist(), "v": v.tolist(), **rest} for q, v in cases]}
    answer = subprocess.run([our_peer], input=json.dumps(request), stdout=subprocess.PIPE, text=True, check=True)
    worst, unnoticed = {"mass_matrix": 0.0, "nonlinear_terms": 0.0}, []
    for (q, v), own in zip(cases, json.loads(answer.stdout), strict=True):
        write(scratch / "case.txt", joints, q, v)
        theirs = peer(model, scratch / "case.txt", "dynamics")
        for name in worst:
            a = np.array(own[name])
            b = np.array(theirs[name]).reshape(a.shape)
            e = distance(name, a, b)
            worst[name] = max(worst[name], e if math.isfinite(e) else math.inf)
            a.flat[np.abs(a).argmax()] *= 1 + PERTURBATION
            if distance(name, a, b) <= TOLERANCE:
                unnoticed.append(name)
    print(f"{model}: {len(joints)} joints, {len(cases)} states, {theirs['mass_kg']:.3f} kg")
    for name, e in worst.items():
        expect(f"{name}: relative difference", e, 0, TOLERANCE)
    expect(f"differences of {PERTURBATION:g} that were not noticed", len(unnoticed), 0, 0)
    return theirs["mass_kg"]


def there_and_back(peer, model, state):
    _, q, v = read(HERE / f"states/{state}.txt")
    back = np.array(peer(model, state, "flight", step=1e-9, duration=1e-9)["state"])
    # In a nanosecond accelerations of some 100 rad/s^2 change speeds by 1e-7.
    expect(f"{state}.txt comes back, coordinates", np.abs(back[:q.size] - q).max(), 0, 1e-8)
    expect(f"{state}.txt comes back, speeds", np.abs(back[q.size:] - v).max(), 0, 1e-6)


def flight(peer, model, state, mass):
    """Differences between steps h, h/2, h/4 fall by 2^order."""
    print(f"flight, {model}")
    there_and_back(peer, model, state)
    for integrator, order, step in (("RK4", 4, 2e-3), ("Euler", 1, 1e-3), ("implicitfast", 1, 1e-3)):
        runs = [peer(model, state, "flight", integrator=integrator, step=step / 2**k, duration=0.5) for k in range(3)]
        s = [np.array(run["state"]) for run in runs]
        measured = math.log2(np.abs(s[0] - s[1]).max() / np.abs(s[1] - s[2]).max())
        expect(f"{integrator}: order", measured, order - 0.15, order + 0.15)
    ends = [peer(model, state, "flight", integrator="RK4", step=2.5e-4, duration=t) for t in (0.25, 0.5)]
    if mass:  # the base is free
        change = np.subtract(ends[1]["momentum"], ends[0]["momentum"])
        expect("momentum against m g t [N s]", np.abs(change - [0, 0, -mass * G * 0.25]).max(), 0, 1e-8)
        turn = np.subtract(ends[1]["angular_momentum"], ends[0]["angular_momentum"])
        expect("change of the angular momentum [N m s]", np.abs(turn).max(), 0, 1e-8)
    expect("change of the energy [J]", abs(ends[1]["energy_j"] - ends[1]["energy_start_j"]), 0, 1e-7)


def standing(peer, robot, mass):
    print("standing")
    contact = robot["contact"]
    for model in ("lola_stiff", "lola_layer"):
        end = peer(model, "stand", "settle", integrator="implicitfast", step=5e-4, duration=2)
        carried = end["force_right_n"][2] + end["force_left_n"][2]
        expect(f"{model}: force of the ground / weight", carried / (mass * G), 0.9998, 1.0002)
        expect(f"{model}: contacts", end["contacts"], 16, 16)
        # All the momentum that gravity gave in 2 s was taken.
        expect(f"{model}: impulse / (m g T)", end["impulse_ns"] / (mass * G * 2), 0.9998, 1.0002)
    sunk = mass * G / (16 * contact["normal_stiffness"])
    expect("lola_layer: depth of the points / m g / (16 K)", end["penetration_m"] / sunk, 0.9998, 1.0002)


def incline(peer):
    print("block on an incline")
    slide = {"slope": 30, "friction": 0.3, "direction": 45, "duration": 2}
    cone = peer("block", "block", "incline", cone="elliptic", **slide)["acceleration"]
    pyramid = peer("block", "block", "incline", cone="pyramidal", **slide)["acceleration"]
    down, across = G * math.sin(math.pi / 6), G * math.cos(math.pi / 6) * 0.3
    expect("slides: elliptic cone / exact", cone / (down - across), 0.98, 1.02)
    # Along an edge of the pyramid |f_x| + |f_y| <= mu f_n holds back with mu / sqrt 2 only.
    expect("slides: pyramid at 45 deg / its own law", pyramid / (down - across / math.sqrt(2)), 0.98, 1.02)
    stick = [peer("block", "block", "incline", cone="elliptic", impratio=r, duration=2)["speed"] for r in (1, 10)]
    expect("sticks: creep falls with impratio 10 by", stick[0] / stick[1], 9.5, 10.5)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    our_peer, made = sys.argv[1], Path(sys.argv[2])
    robot = tomllib.loads((ROBOT / "robot.toml").read_text())
    peer = Peer(made)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        states(made, scratch)
        lola, limbs = (ROBOT / robot["urdf"]).read_text(), (HERE / "chain.urdf").read_text()
        mass = dynamics(our_peer, peer, scratch, "lola_flight", lola, robot["torso"], "flight")
        chain = dynamics(our_peer, peer, scratch, "chain_free", limbs, "torso", "chain")
    flight(peer, "lola_flight", "flight", mass)
    flight(peer, "chain_free", "chain", chain)
    flight(peer, "chain_fixed", "chain_fixed", None)
    standing(peer, robot, mass)
    incline(peer)
    if failed:
        sys.exit(f"FAILED: {', '.join(failed)}")
    print("MuJoCo simulates the same robot")


if __name__ == "__main__":
    main()
