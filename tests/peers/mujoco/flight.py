"""Lola flies for a second without contact and drives, in our dynamics and in MuJoCo's, by the same method (RK4).

usage: flight.py OUR_FLIGHT MADE     (the example `flight` of crates/multibody; the folder that build.sh made)

- with steps of 0.1 ms, where the method's error is below rounding of a second's work, both ends are the same;
- with 1 ms and 4 ms both errors are the method's: they fall with the fourth power of the step, in both programs;
- a robot whose torso is heavier by a millionth is told apart.
"""

import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROBOT = HERE.parents[2] / "config/robots/lola"
STATE = HERE / "states/flight.txt"
failed = []


def expect(what, value, low, high):
    good = low <= value <= high
    if not good:
        failed.append(what)
    print(f"  {what:58s} {value:12.5e} {'' if good else f'NOT IN {low:g} .. {high:g}'}")


def ours(program, urdf, base, step):
    command = [program, urdf, base, STATE, str(step), "1"]
    return np.array(json.loads(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout))


def theirs(made, step):
    options = ["scene=flight", "integrator=RK4", f"step={step}", "duration=1", "runs=1"]
    command = [made / "peer", made / "lola_flight.mjb", STATE, *options]
    return np.array(json.loads(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)["state"])


def distance(a, b):
    """Largest difference; a quaternion and its negative are the same orientation."""
    turned = min(np.abs(a[3:7] - b[3:7]).max(), np.abs(a[3:7] + b[3:7]).max())
    return max(np.abs(np.delete(a - b, range(3, 7))).max(), turned)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, made = sys.argv[1], Path(sys.argv[2])
    robot = tomllib.loads((ROBOT / "robot.toml").read_text())
    urdf, base = ROBOT / robot["urdf"], robot["torso"]
    exact = theirs(made, 1e-4)
    print("free flight of Lola, 1 s, coordinates [m, rad] and speeds [m/s, rad/s]")
    expect("same end with steps of 0.1 ms", distance(ours(program, urdf, base, 1e-4), exact), 0, 1e-9)
    for name, fly in (("ours", lambda h: ours(program, urdf, base, h)), ("MuJoCo's", lambda h: theirs(made, h))):
        errors = [distance(fly(h), exact) for h in (4e-3, 1e-3)]
        expect(f"{name}: error with 1 ms", errors[1], 0, 1e-5)
        expect(f"{name}: order from 4 ms to 1 ms", np.log(errors[0] / errors[1]) / np.log(4), 3.7, 4.3)
    with tempfile.TemporaryDirectory() as scratch:
        heavier = Path(scratch) / "lola.urdf"
        heavier.write_text(heavier_torso(urdf.read_text(), base))
        expect("a millionth more mass of the torso", distance(ours(program, heavier, base, 1e-4), exact), 1e-8, 1)
    if failed:
        sys.exit(f"FAILED: {', '.join(failed)}")


def heavier_torso(text, base):
    begin = text.index('<mass value="', text.index(f'<link name="{base}"')) + len('<mass value="')
    end = text.index('"', begin)
    return f"{text[:begin]}{float(text[begin:end]) * (1 + 1e-6)!r}{text[end:]}"


if __name__ == "__main__":
    main()
