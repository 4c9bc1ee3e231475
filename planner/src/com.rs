//! Centre-of-gravity trajectory of the three-mass model (thesis 4.6.3, 4.6.5; errata 2.6, 2.8, 2.9).
//!
//! `y_b.. = om2 y_b + r` with `om2 = (z_b.. + g) / z_b` and
//! `r = (-p F_z + sum m_l (y_l (z_l.. + g) - z_l y_l..)) / (m_b z_b)`, the same for x and y when the moment is written
//! through the zero-moment point p. All masses are shares of the robot's mass, which therefore never appears.
//!
//! Given is the height of the body mass point, not of the robot's centre of gravity, which a swing leg lifts by some
//! millimetres: so om2 is constant while walking, and what swings stands on the right-hand side alone, where kinks at
//! knots cost no accuracy.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | m_b, m_l | masses of the body and of one leg over the robot's | 1 |
//! | z_b | height of the body mass point, given | m |
//! | y_b | body mass point | m |
//! | z_l, y_l | leg mass point: `leg_height` above the sole frame's origin | m |
//! | gamma | amplitude of a modification of the zero-moment point (4.49) | m |

use crate::collocation::{Collocation, F, LEFT, MAX_KNOTS, RIGHT, State, U};
use crate::feet::FootPath;
use crate::zmp::{Chain, Shape};
use config::gait;
use curves::{Path, Sample};

/// \[m/s^2\] Gravity, downwards.
pub const GRAVITY: f64 = 9.81;

/// Height of the body mass point over time.
pub type HeightPath = Path<1, 16>;

/// Everything that drives the centre of gravity.
#[derive(Clone, Copy)]
pub struct Drive<'a> {
    /// Feet: right, left.
    pub feet: &'a [FootPath; 2],
    /// Height of the body mass point \[m\].
    pub height: &'a HeightPath,
    /// Reference of the zero-moment point.
    pub zmp: &'a Chain,
    /// Where the zero-moment point may be modified.
    pub shapes: [Shape; 2],
}

/// Sums over both leg mass points.
#[derive(Clone, Copy, Default)]
struct Legs {
    position: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
}

/// Collocation of the three-mass model over one interval.
pub struct ComSolver {
    leg: f64,
    body: f64,
    leg_height: f64,
    problem: Box<Collocation>,
    legs: Box<[Legs; MAX_KNOTS]>,
}

impl ComSolver {
    /// A solver for the masses of `model`.
    pub fn new(model: &gait::Model) -> Self {
        Self {
            leg: model.leg_mass,
            body: 1.0 - 2.0 * model.leg_mass,
            leg_height: model.leg_height,
            problem: Box::new(Collocation::new()),
            legs: Box::new([Legs::default(); MAX_KNOTS]),
        }
    }

    fn legs(&self, feet: &[FootPath; 2], t: f64) -> ([Sample<4>; 2], Legs) {
        let s = [feet[0].sample(t), feet[1].sample(t)];
        let sum = |f: fn(&Sample<4>) -> &[f64; 4]| std::array::from_fn(|d| f(&s[0])[d] + f(&s[1])[d]);
        let mut legs = Legs {
            position: sum(|s| &s.position),
            velocity: sum(|s| &s.velocity),
            acceleration: sum(|s| &s.acceleration),
        };
        legs.position[2] += 2.0 * self.leg_height;
        (s, legs)
    }

    /// The body mass point of a robot whose centre of gravity is `com` (errata on (4.51)-(4.54)).
    pub fn body(&self, com: &Sample<3>, feet: &[FootPath; 2], t: f64) -> Sample<3> {
        let (_, legs) = self.legs(feet, t);
        let of = |c: &[f64; 3], l: &[f64; 3]| std::array::from_fn(|d| (c[d] - self.leg * l[d]) / self.body);
        Sample {
            position: of(&com.position, &legs.position),
            velocity: of(&com.velocity, &legs.velocity),
            acceleration: of(&com.acceleration, &legs.acceleration),
        }
    }

    /// om2 and right-hand sides at `t`.
    fn forces(&self, drive: &Drive, t: f64) -> (f64, [f64; F], Legs) {
        let (feet, legs) = self.legs(drive.feet, t);
        let z = drive.height.sample(t);
        let (z_b, zdd_b) = (z.position[0], z.acceleration[0]);
        let f_z = self.body * (zdd_b + GRAVITY) + self.leg * (legs.acceleration[2] + 2.0 * GRAVITY); // (4.35)
        let p = drive.zmp.at(t);
        let scale = 1.0 / (self.body * z_b);
        let r = [0, 1].map(|d| {
            let swing: f64 = feet
                .iter()
                .map(|l| {
                    l.position[d] * (l.acceleration[2] + GRAVITY)
                        - (l.position[2] + self.leg_height) * l.acceleration[d]
                })
                .sum();
            scale * (self.leg * swing - p[d] * f_z) // (4.38), (4.39)
        });
        let q = [0, 1].map(|j| -scale * f_z * drive.shapes[j].at(t)); // (4.49)
        ((zdd_b + GRAVITY) / z_b, [r[0], r[1], q[0], q[1]], legs)
    }

    /// Places knots on all `marks` \[s\], and between them no farther apart than `spacing`, and solves (4.50).
    pub fn solve(&mut self, drive: &Drive, marks: &[f64], spacing: f64) {
        let mut n = 0;
        self.problem.t[0] = marks[0];
        for pair in marks.windows(2) {
            let pieces = pieces(pair[1] - pair[0], spacing);
            for k in 1..=pieces {
                n += 1;
                if n >= MAX_KNOTS {
                    return;
                }
                let s = k as f64 / pieces as f64;
                self.problem.t[n] = if k == pieces { pair[1] } else { pair[0] + s * (pair[1] - pair[0]) };
            }
        }
        self.problem.n = n + 1;
        for i in 0..=n {
            let t = self.problem.t[i];
            let (om2, f, legs) = self.forces(drive, t);
            self.problem.om2[i] = om2;
            self.problem.f[i] = f;
            self.legs[i] = legs;
            if i < n {
                self.problem.half[i] = self.forces(drive, 0.5 * (t + self.problem.t[i + 1])).1;
            }
        }
        self.problem.solve();
    }

    /// The problem that was solved last.
    pub fn problem(&self) -> &Collocation {
        &self.problem
    }

    /// Appends the robot's centre of gravity to `com`: quintics through position, velocity and acceleration at knots.
    pub fn write<const N: usize>(
        &self,
        begin: &State,
        end: &State,
        gamma: &[[f64; 2]; 2],
        height: &HeightPath,
        com: &mut Path<3, N>,
    ) {
        let mut last = self.com(0, begin, end, gamma, height);
        for i in 1..self.problem.n {
            let next = self.com(i, begin, end, gamma, height);
            com.push(&last, &next, self.problem.t[i]);
            last = next;
        }
    }

    fn com(
        &self,
        i: usize,
        begin: &State,
        end: &State,
        gamma: &[[f64; 2]; 2],
        height: &HeightPath,
    ) -> Sample<3> {
        let p = &self.problem;
        let slope = p.slope(i);
        let z = height.sample(p.t[i]);
        let of = |b: f64, l: f64| self.body * b + self.leg * l;
        let mut com = Sample::rest([0.0, 0.0, of(z.position[0], self.legs[i].position[2])]);
        com.velocity[2] = of(z.velocity[0], self.legs[i].velocity[2]);
        com.acceleration[2] = of(z.acceleration[0], self.legs[i].acceleration[2]);
        for d in 0..2 {
            let sum = |u: &[f64; U]| {
                u[d] + gamma[0][d] * u[2] + gamma[1][d] * u[3] + begin.r[d] * u[LEFT] + end.r[d] * u[RIGHT]
            };
            let f = p.f[i][d] + gamma[0][d] * p.f[i][2] + gamma[1][d] * p.f[i][3];
            let body = [sum(&p.u[i]), sum(&slope), p.om2[i] * sum(&p.u[i]) + f];
            com.position[d] = of(body[0], self.legs[i].position[d]);
            com.velocity[d] = of(body[1], self.legs[i].velocity[d]);
            com.acceleration[d] = of(body[2], self.legs[i].acceleration[d]);
        }
        com
    }
}

/// Pieces no longer than `spacing` that an interval of length `h` is cut into.
pub fn pieces(h: f64, spacing: f64) -> usize {
    ((h / spacing - 1e-6).ceil() as usize).max(1)
}
