"""Runs the code cells of the notebooks of the Python package, each from top to bottom, and looks at what they found.

usage: python_notebooks.py FILE...
"""

import json
import pathlib
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# What holds when the last cell has run.
FOUND = {
    "walk_and_plot": lambda n: 0.53 < n["speed"] < 0.57 and n["figures"]["ended_by"] == "done" and n["periodic"].sum() > 1000,
    "compare_depths": lambda n: 0.0 < n["apart"].max() < 0.3 and n["error"][1].max() < n["error"][2].max(),
    "survive_pushes": lambda n: (n["survived"] >= 0.1).all() and n["fell"].any() and not n["walking"].fallen and n["told"],
    "tune_gain": lambda n: len(n["refused"]) == 2 and len(set(n["errors"])) == len(n["factors"]) and n["errors"][0] > min(n["errors"]),
    "kinematics_beside_pinocchio": lambda n: len(n["worst"]) == 5 and max(n["worst"].values()) < 1e-10,
}


def run(path):
    """Names that a notebook leaves; refuses outputs, which are nobody's to keep."""
    notebook = json.loads(path.read_text())
    names = {"__name__": "__main__"}
    for k, cell in enumerate(cell for cell in notebook["cells"] if cell["cell_type"] == "code"):
        if cell["outputs"] or cell["execution_count"] is not None:
            raise SystemExit(f"{path.name}: code cell {k} has outputs: clear them before committing it")
        exec(compile("".join(cell["source"]), f"{path.name}, code cell {k}", "exec"), names)
    return names


def main():
    paths = {path.stem: path for path in map(pathlib.Path, sys.argv[1:])}
    if paths.keys() != FOUND.keys():
        return f"notebooks {sorted(paths)}, and checks of {sorted(FOUND)}"
    wrong = []
    for name, path in paths.items():
        begun = time.monotonic()
        names = run(path)
        good = FOUND[name](names)
        pictures = len(plt.get_fignums())
        plt.close("all")
        print(f"{name}: {'good' if good else 'NOT AS EXPECTED'}, {pictures} pictures, {time.monotonic() - begun:.1f} s")
        wrong += [] if good else [name]
    return f"not as expected: {', '.join(wrong)}" if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
