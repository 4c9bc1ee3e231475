"""Cycles per second of processor time through the package: one `step()` per call, and many; median of some rounds."""

import statistics
import time

import gangwerk

METHODS = [("walk_1kmh", 1, "euler", 4), ("walk_1kmh", 1, "euler", 1), ("walk_1kmh", 2, "semi_implicit", 4), ("walk_1kmh", 3, "semi_implicit", 10)]
ROUNDS, CYCLES = 5, 2000


def rate(do):
    """Median rate of CYCLES cycles."""
    rounds = []
    for _ in range(ROUNDS):
        begun = time.process_time()
        do()
        rounds.append(CYCLES / (time.process_time() - begun))
    return statistics.median(rounds)


def main():
    for scene, depth, integrator, substeps in METHODS:
        standing = gangwerk.Chain(scene, depth=depth, integrator=integrator, substeps=substeps)
        standing.run(5.0)
        one, many = standing.copy(), standing.copy()

        def each():
            for _ in range(CYCLES):
                one.step()

        begun = time.process_time()
        for _ in range(20):
            standing.copy()
        copy = (time.process_time() - begun) / 20
        print(f"type {depth}, {integrator} x {substeps}, walking: step() {rate(each):.0f} cycles/s, step({CYCLES}) "
              f"{rate(lambda: many.step(CYCLES)):.0f} cycles/s, copy() {1e6 * copy:.0f} us")


if __name__ == "__main__":
    main()
