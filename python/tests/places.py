"""Random seeded places that the tests of the package look at: `GANGWERK_SEED` chooses others, `GANGWERK_LONG` more of them."""

import os
import pathlib
import subprocess

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
GANGWERK = os.environ.get("GANGWERK", str(ROOT / "target/release/gangwerk"))
SEED = int(os.environ.get("GANGWERK_SEED", "16"))
MANY = 10 if os.environ.get("GANGWERK_LONG") else 1
# Type, integrator, steps per cycle: each is stable for Lola.
SENSORS = (ROOT / "config/scenes/walk_2kmh_sensors.toml").read_text().split("# Where each number comes from")[1].split("\n", 1)[1]
METHODS = [(1, "euler", 4), (1, "rk4", 4), (2, "semi_implicit", 4), (3, "semi_implicit", 10), (4, "semi_implicit", 10), (5, "semi_implicit", 10)]


# [s] Length of a walk of a type: none takes much longer than the others.
DURATION = {1: 2.5, 2: 1.2, 3: 0.5, 4: 0.12, 5: 0.12}


def rng(salt):
    """Random numbers of one test."""
    return np.random.default_rng([SEED, salt])


def scene(path, random, method, duration, extra=""):
    """Writes a scene of Lola in which she stands up and is told something at a random instant; sensors err by its seed."""
    depth, integrator, substeps = method
    forward, turn = random.uniform(0.1, 0.5), random.uniform(-0.1, 0.1)
    path.write_text(f"""about = "Lola at a random place."
robot = "lola"
gait = "lola"
depth = {depth}
integrator = "{integrator}"
substeps = {substeps}
cycle = 0.001
start_pose = "stand"
duration = {duration}
seed = {random.integers(1, 1 << 40)}

[[command]]
time = {min(0.2, 0.2 * duration)}
topic = "walk/stand"

[[command]]
time = {random.uniform(0.3, 0.9) * duration:.3f}
topic = "walk/velocity"
forward = {forward:.4f}
turn = {turn:.4f}
{extra}
{SENSORS}""")
    return path


def sim(path, *options):
    """`gangwerk sim`; what it printed."""
    done = subprocess.run([GANGWERK, "sim", str(path), *map(str, options)], capture_output=True, text=True)
    assert done.returncode in (0, 3, 4), done.stderr
    return done.stdout


def same(ours, theirs):
    """Name of the first field whose bits differ, of two dicts of arrays; NaN is equal to itself."""
    assert ours.keys() == theirs.keys(), ours.keys() ^ theirs.keys()
    for name in ours:
        a, b = np.ascontiguousarray(ours[name]), np.ascontiguousarray(theirs[name])
        if a.shape != b.shape or a.dtype != b.dtype or a.tobytes() != b.tobytes():
            return name
    return None
