"""Runs scenes, integrators and steps, and writes a point for each; on one processor where `taskset` is there.

usage: sweep.py MADE FILE.json     (MADE: the folder that build.sh made)

The file: {"peer", "version", "points": [...]}, a point being the line that peer.c prints with the names of its model
and initial state (states/NAME.txt) added. Lost runs are points too, with "diverged": true and "state": null.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
INTEGRATORS = ("Euler", "implicitfast", "RK4")
SMOOTH = (1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2)
IMPACT = (1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3)


def runs():
    """(model, state, options) of every point."""
    for model, state in (("lola_flight", "flight"), ("chain_fixed", "chain_fixed"), ("chain_free", "chain")):
        for integrator in INTEGRATORS:
            for step in SMOOTH:
                yield model, state, {"scene": "flight", "integrator": integrator, "step": step, "duration": 1}
    for model in ("lola_stiff", "lola_layer"):
        for integrator in INTEGRATORS:
            for step in IMPACT[1 if integrator == "RK4" else 0:]:
                yield model, "stand", {"scene": "settle", "integrator": integrator, "step": step, "duration": 2}
        for integrator in INTEGRATORS:
            yield model, "stand", {"scene": "stand", "integrator": integrator, "step": 1e-3, "before": 2}
    for more in ({"cone": "pyramidal"}, {"cone": "pyramidal", "solver": "CG"}, {"impratio": 10}, {"noslip": 3}):
        yield "lola_stiff", "stand", {"scene": "stand", "step": 1e-3, "before": 2, **more}
    yield from incline()


def incline():
    stick = {"scene": "incline", "slope": 20, "friction": 0.8, "duration": 3}
    slide = {"scene": "incline", "slope": 30, "friction": 0.3, "duration": 2}
    for cone in ("elliptic", "pyramidal"):
        for degrees in (0, 7.5, 15, 22.5, 30, 37.5, 45):
            yield "block", "block", {**slide, "cone": cone, "direction": degrees, "step": 1e-3}
        for impratio in (1, 10, 100):
            for degrees in (0, 22.5, 45):
                more = {"cone": cone, "impratio": impratio, "direction": degrees}
                yield "block", "block", {**stick, **more, "step": 1e-3}
    yield "block", "block", {**stick, "cone": "elliptic", "noslip": 3, "step": 1e-3}
    for integrator in INTEGRATORS:
        for step in (1e-4, 1e-3, 5e-3):
            for scene in (stick, slide):
                yield "block", "block", {**scene, "cone": "elliptic", "integrator": integrator, "step": step}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    made, output = Path(sys.argv[1]), Path(sys.argv[2])
    pinned = ["taskset", "-c", str(max(os.sched_getaffinity(0)))] if shutil.which("taskset") else []
    points = []
    for model, state, options in runs():
        arguments = [f"{key}={value}" for key, value in options.items()]
        command = [*pinned, made / "peer", made / f"{model}.mjb", HERE / f"states/{state}.txt", *arguments]
        line = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
        points.append({**json.loads(line), "model": model, "initial": state})
    everything = {"peer": "mujoco", "version": points[0]["version"], "points": points}
    output.write_text(json.dumps(everything, indent=1) + "\n")
    lost = sum(point["diverged"] for point in points)
    print(f"{len(points)} points, {lost} of them diverged: {output}")


if __name__ == "__main__":
    main()
