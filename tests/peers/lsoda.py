"""scipy's LSODA, of the family of the thesis's LSODE, on two jumps of one degree of freedom: what they cost it.

usage: lsoda.py [--all]      (--all: also tolerances that take minutes)

Prints one line of JSON per run: problem, method, tolerance (relative and absolute alike) or step, f_calls, steps,
smallest step [s], largest error over the output times (every 10 ms) and, for each problem, a line with its constants
and the exact end. Ends with status 1 if a prediction at the end of this file is missed.

Stiction: a joint with the dry friction of the gear HFUC-25-100 under a load that sticks, slides and turns round:
    J w' = T_l(t) - T_f,   T_l = A sin(2 pi t),   T_f = T_0 sgn w, at rest whatever holds it up to T_0
  J = 1 kg m^2, T_0 = 10.4 N m, q(0) = w(0) = 0, 2 s; A = 20 N m ("stiction": rests once, then only turns round) and
  A = 14 N m ("stiction_rests": rests in every half period). Methods:
    lsoda_sign   the law as it stands; at rest T_f jumps between -T_0 and T_0 from call to call
    lsoda_tanh   T_f = T_0 tanh(w / v_s)
    prox_euler   w+ = w + h T_l(t + h) / J, brought h T_0 / J nearer to zero and not through it; q+ = q + h w+
    sign_euler   w+ = w + h (T_l(t) - T_0 sgn w) / J, q+ = q + h w
  Exact: pieces in closed form between the times at which the joint lets go and stops.

Touchdown: a mass above a massless layer of spring and damper
    m v' = f - m g,   z' = v,   f = max(0, -K z - B v) where z <= 0, else 0
  m = 60 kg, K = 2e5 N/m, B = 2e3 N s/m, g = 9.81 m/s^2, v(0) = 0, 0.5 s; z(0) = 0.01 m ("touchdown") and
  0.05 m ("touchdown_bounces": leaves the ground once more). At contact f jumps by B |v|.
  Exact: parabola and damped oscillation in closed form between contact and release.
"""

import json
import math
import sys

import numpy as np
from scipy.integrate import LSODA
from scipy.optimize import brentq

MOST_CALLS = 30_000_000
OUTPUT = 0.01  # [s]
J, T_0, END = 1.0, 10.4, 2.0
M, K, B, G, LANDED = 60.0, 2e5, 2e3, 9.81, 0.5


def first_root(f, start, end, pieces=2000):
    """The first change of sign after `start`, or None."""
    grid = np.linspace(start, end, pieces + 1)[1:]
    values = [f(t) for t in grid]
    for a, b, x, y in zip(grid, grid[1:], values, values[1:]):
        if x * y <= 0 and x != 0:
            return brentq(f, a, b, xtol=1e-15, rtol=1e-15)
    return None


# --- Stiction ---------------------------------------------------------------------------------------------------------

class Stiction:
    """Exact motion: pieces (start, sign of motion or 0, angle at its start), at rest at the start of each."""

    end = END
    start = [0.0, 0.0]

    def __init__(self, name, amplitude):
        self.name, self.amplitude = name, amplitude
        self.constants = {"J": J, "T_0": T_0, "A": amplitude, "end_s": END}
        load = self.load
        self.pieces, t, q = [(0.0, 0, 0.0)], 0.0, 0.0
        while t < END:
            if self.pieces[-1][1] == 0:
                lets_go = first_root(lambda s: abs(load(s)) - T_0, t, END)
                if lets_go is None:
                    break
                t, sign = lets_go, math.copysign(1, load(lets_go))
            else:
                began, sign, q0 = self.pieces[-1]
                stops = first_root(lambda s: self.sliding(s, began, sign, q0)[1], began, END)
                if stops is None:
                    break
                t, q = stops, self.sliding(stops, began, sign, q0)[0]
                sign = math.copysign(1, load(t)) if abs(load(t)) > T_0 else 0
            self.pieces.append((t, sign, q))

    def load(self, t):
        return self.amplitude * math.sin(2 * math.pi * t)

    def sliding(self, t, began, sign, q0):
        """Angle and speed at t of a joint that began to slide at `began`."""
        o, s, A = 2 * math.pi, t - began, self.amplitude
        w = A / o * (math.cos(o * began) - math.cos(o * t)) - sign * T_0 * s
        q = A / o * (s * math.cos(o * began) - (math.sin(o * t) - math.sin(o * began)) / o) - sign * T_0 * s * s / 2
        return q0 + q / J, w / J

    def exact(self, t):
        began, sign, q0 = [p for p in self.pieces if p[0] <= t][-1]
        return self.sliding(t, began, sign, q0) if sign else (q0, 0.0)

    def right_hand_side(self, friction):
        return lambda t, y: (float(y[1]), (self.load(t) - friction(float(y[1]))) / J)


def euler(problem, step, prox):
    """Fixed steps; returns errors, and the largest speed while the exact joint rests."""
    q = w = error = creep = 0.0
    load = problem.load
    n = round(problem.end / step)
    every = round(OUTPUT / step)
    for k in range(n):
        if prox:
            w += step * load((k + 1) * step) / J
            w = math.copysign(max(abs(w) - step * T_0 / J, 0.0), w)
            q += step * w
        else:
            sign = (w > 0) - (w < 0)
            q, w = q + step * w, w + step * (load(k * step) - T_0 * sign) / J
        exact_q, exact_w = problem.exact((k + 1) * step)
        if (k + 1) % every == 0:
            error = max(error, abs(q - exact_q))
        if exact_w == 0.0 and problem.exact((k - 20) * step if k > 20 else 0.0)[1] == 0.0:
            creep = max(creep, abs(w))  # at rest for 20 steps already
    return {"step_s": step, "f_calls": n, "steps": n, "smallest_step_s": step, "error": error, "speed_at_rest": creep}


# --- Touchdown --------------------------------------------------------------------------------------------------------

class Touchdown:
    """Exact motion: pieces (start, in contact, height, speed at its start)."""

    end = LANDED

    def __init__(self, name, fall):
        self.name, self.start = name, [fall, 0.0]
        self.constants = {"m": M, "K": K, "B": B, "g": G, "z_0": fall, "end_s": LANDED}
        self.pieces = [(0.0, False, fall, 0.0)]
        while True:
            began, contact, z, v = self.pieces[-1]
            piece = lambda t: self.moving(t - began, contact, z, v)
            # In contact until the force is gone; in the air until there is ground and a force again.
            ends = (lambda t: self.force(*piece(t))) if contact else (lambda t: self.would_push(*piece(t)))
            t = first_root(ends, began, LANDED)
            if t is None:
                break
            self.pieces.append((t, not contact, *piece(t)))

    @staticmethod
    def force(z, v):
        return -K * z - B * v

    @staticmethod
    def would_push(z, v):
        return min(-z, -K * z - B * v)

    @staticmethod
    def moving(s, contact, z, v):
        if not contact:
            return z + v * s - G * s * s / 2, v - G * s
        rest, damping = -M * G / K, B / (2 * M)
        o = math.sqrt(K / M - damping**2)
        a, b = z - rest, (v + damping * (z - rest)) / o
        decay, c, d = math.exp(-damping * s), math.cos(o * s), math.sin(o * s)
        x = decay * (a * c + b * d)
        return rest + x, -damping * x + decay * o * (b * c - a * d)

    def exact(self, t):
        began, contact, z, v = [p for p in self.pieces if p[0] <= t][-1]
        return self.moving(t - began, contact, z, v)

    @staticmethod
    def right_hand_side():
        def rate(_, y):
            z, v = y
            return v, (max(0.0, -K * z - B * v) if z <= 0 else 0.0) / M - G
        return rate


# --- LSODA ------------------------------------------------------------------------------------------------------------

def lsoda(problem, rhs, tolerance):
    solver = LSODA(rhs, 0.0, problem.start, problem.end, rtol=tolerance, atol=tolerance)
    error, smallest, steps, k = 0.0, math.inf, 0, 1
    while solver.status == "running" and solver.nfev < MOST_CALLS:
        solver.step()
        if solver.status == "failed":
            break
        steps += 1
        smallest = min(smallest, solver.t - solver.t_old)
        if k * OUTPUT <= solver.t:
            between = solver.dense_output()
            while k * OUTPUT <= solver.t and k * OUTPUT <= problem.end:
                error = max(error, abs(between(k * OUTPUT)[0] - problem.exact(k * OUTPUT)[0]))
                k += 1
    done = solver.status == "finished"
    return {"tolerance": tolerance, "f_calls": solver.nfev, "steps": steps, "smallest_step_s": smallest,
            "finished": done, "until_s": solver.t, "error": error}


def run(problem, method, result, **more):
    line = {"problem": problem.name, "method": method, **more, **result}
    print(json.dumps(line), flush=True)
    return line


def sign(w):
    return T_0 * ((w > 0) - (w < 0))


def friction(problem, tolerances):
    """All methods on one joint."""
    signs = [run(problem, "lsoda_sign", lsoda(problem, problem.right_hand_side(sign), t)) for t in tolerances]
    tanhs = []
    for v_s in (1e-2, 1e-3, 1e-4):
        rhs = problem.right_hand_side(lambda w: T_0 * math.tanh(w / v_s))
        tanhs.append(run(problem, "lsoda_tanh", lsoda(problem, rhs, 1e-8), v_s=v_s))
    proxes = [run(problem, "prox_euler", euler(problem, h, prox=True)) for h in (1e-3, 5e-4)]
    return signs, tanhs, proxes, run(problem, "sign_euler", euler(problem, 1e-3, prox=False))


def main():
    tolerances = [1e-2, 1e-3, 1e-4] + ([1e-5, 1e-6] if "--all" in sys.argv[1:] else [])
    stiction, rests = Stiction("stiction", 20.0), Stiction("stiction_rests", 14.0)
    falls = Touchdown("touchdown", 0.01), Touchdown("touchdown_bounces", 0.05)
    for problem in (stiction, rests, *falls):
        q, w = problem.exact(problem.end)
        print(json.dumps({"problem": problem.name, **problem.constants, "exact_end": [q, w],
                          "exact_events_s": [piece[0] for piece in problem.pieces[1:]]}))
    joints = [friction(problem, tolerances) for problem in (stiction, rests)]
    landings = [[run(p, "lsoda", lsoda(p, p.right_hand_side(), t)) for t in (1e-4, 1e-6, 1e-8, 1e-10)] for p in falls]
    predictions = {}
    for problem, (signs, tanhs, proxes, explicit) in zip((stiction, rests), joints):
        calls, smooth = [r["f_calls"] for r in signs], [r["error"] for r in tanhs]
        chatter = explicit["speed_at_rest"] * J / (1e-3 * T_0)
        predictions |= {
            f"{problem.name}: calls of the sign law grow at least 5 times per decade": calls[2] > 5 * calls[1],
            f"{problem.name}: the smooth law needs less than a tenth": max(r["f_calls"] for r in tanhs) < calls[2] / 10,
            f"{problem.name}: its error falls with v_s": smooth[0] > 5 * smooth[1] > 25 * smooth[2],
            f"{problem.name}: the prox step rests where the joint rests": all(r["speed_at_rest"] == 0 for r in proxes),
            f"{problem.name}: the prox step is of first order": 1.8 < proxes[0]["error"] / proxes[1]["error"] < 2.2,
            # From just above zero one step goes to h (|T_l| + T_0) / J below at most, |T_l| <= T_0 at rest.
            f"{problem.name}: explicit steps chatter by h T_0 / J": 1 <= chatter <= 2,
        }
    for problem, runs in zip(falls, landings):
        predictions |= {
            f"{problem.name}: survived at every tolerance": all(r["finished"] for r in runs),
            f"{problem.name}: the error falls": runs[0]["error"] > runs[2]["error"] and runs[3]["error"] < 1e-8,
        }
    missed = [what for what, met in predictions.items() if not met]
    sys.exit(f"missed: {'; '.join(missed)}" if missed else 0)


if __name__ == "__main__":
    main()
