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
//! | z_b | height of the body mass point over the zero-moment point, given | m |
//! | y_b | body mass point | m |
//! | z_l, y_l | leg mass point: `leg_height` above the sole frame's origin | m |
//! | gamma | amplitude of a modification of the zero-moment point (4.49) | m |

use crate::boundary::{BoundaryProblem, EndConditions, EndSlopes, F, MAX_KNOTS, PlanarState};
use crate::cog_method::CogSolver;
use crate::feet::{FOOT_PIECES, FootPath};
use crate::verdict::PlanVerdict;
use crate::zmp::{Trapezoid, ZmpProblem};
use config::gait;
use curves::{Cursor, Path, Polyline, Sample};
use multibody::GRAVITY_ACCELERATION as GRAVITY;

/// Pieces of a height path.
pub(crate) const HEIGHT_PIECES: usize = 16;
/// Height of the body mass point over time.
pub(crate) type HeightPath = Path<1, HEIGHT_PIECES>;

/// Height of the zero-moment point over time: the plane in which it is given (4.33) lies there.
pub(crate) type GroundPath = Polyline<1, 24>;

/// Everything that drives the centre of gravity.
#[derive(Clone, Copy)]
pub(crate) struct Forcing<'a> {
    /// Feet: right, left.
    pub feet: &'a [FootPath; 2],
    /// Height of the body mass point \[m\].
    pub height: &'a HeightPath,
    /// Height of the zero-moment point \[m\].
    pub ground: &'a GroundPath,
    /// Reference of the zero-moment point.
    pub zmp: &'a ZmpProblem,
    /// Shapes of the modification of the zero-moment point.
    pub shapes: [Trapezoid; 2],
}

/// Sums over both leg mass points.
#[derive(Clone, Copy, Default)]
struct Legs {
    position: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
}

/// Forces that a motion asks of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GroundDemand {
    /// Least vertical force over the robot's weight.
    pub least_force: f64,
    /// Largest ratio of horizontal to vertical force.
    pub friction: f64,
}

impl GroundDemand {
    /// Nothing asked of it yet.
    pub(crate) const UNTOUCHED: Self = Self { least_force: f64::INFINITY, friction: 0.0 };

    /// With an acceleration of the centre of gravity \[m/s^2\].
    fn with(self, [x, y, z]: [f64; 3]) -> Self {
        let vertical = z + GRAVITY;
        Self {
            least_force: self.least_force.min(vertical / GRAVITY),
            friction: self.friction.max((x * x + y * y).sqrt() / vertical),
        }
    }
}

/// Three-mass model of one robot over one interval of time.
#[derive(Clone)]
pub(crate) struct ThreeMassModel {
    leg: f64,
    body: f64,
    leg_height: f64,
    method: CogSolver,
    legs: Box<[Legs; MAX_KNOTS]>,
    heights: Box<[Sample<1>; MAX_KNOTS]>,
}

/// Reads everything that drives the centre of gravity, in the order of time.
struct ForcingReader<'a> {
    feet: [Cursor<'a, 4, FOOT_PIECES>; 2],
    height: Cursor<'a, 1, HEIGHT_PIECES>,
    ground: &'a GroundPath,
    /// Height of the ground, if it is level.
    level: Option<f64>,
    zmp: &'a ZmpProblem,
    node: usize,
    shapes: [Trapezoid; 2],
}

impl<'a> ForcingReader<'a> {
    fn new(forcing: &Forcing<'a>) -> Self {
        Self {
            feet: [forcing.feet[0].cursor(), forcing.feet[1].cursor()],
            height: forcing.height.cursor(),
            ground: forcing.ground,
            level: level(forcing.ground),
            zmp: forcing.zmp,
            node: 0,
            shapes: forcing.shapes,
        }
    }
}

/// Height of the ground if it is the same everywhere.
fn level(ground: &GroundPath) -> Option<f64> {
    let values = &ground.values[..ground.points as usize];
    let first = values.first().map_or(0.0, |v| v[0]);
    values.iter().all(|v| v[0] == first).then_some(first)
}

impl ThreeMassModel {
    /// For the masses of `model`.
    pub(crate) fn new(model: &gait::GaitModel) -> Self {
        Self {
            leg: model.leg_mass,
            body: 1.0 - 2.0 * model.leg_mass,
            leg_height: model.leg_height,
            method: CogSolver::new(model.cog_method),
            legs: Box::new([Legs::default(); MAX_KNOTS]),
            heights: Box::new([Sample::rest([0.0]); MAX_KNOTS]),
        }
    }

    fn legs(&self, s: &[Sample<4>; 2]) -> Legs {
        let mut legs = Legs::default();
        for d in 0..3 {
            legs.position[d] = s[0].position[d] + s[1].position[d];
            legs.velocity[d] = s[0].velocity[d] + s[1].velocity[d];
            legs.acceleration[d] = s[0].acceleration[d] + s[1].acceleration[d];
        }
        legs.position[2] += 2.0 * self.leg_height;
        legs
    }

    /// The body mass point of a robot whose centre of gravity is `com` (errata on (4.51)-(4.54)).
    pub(crate) fn body(&self, com: &Sample<3>, feet: &[FootPath; 2], t: f64) -> Sample<3> {
        let legs = self.legs(&[feet[0].sample(t), feet[1].sample(t)]);
        let of = |c: &[f64; 3], l: &[f64; 3]| std::array::from_fn(|d| (c[d] - self.leg * l[d]) / self.body);
        Sample {
            position: of(&com.position, &legs.position),
            velocity: of(&com.velocity, &legs.velocity),
            acceleration: of(&com.acceleration, &legs.acceleration),
        }
    }

    /// om2 and right-hand sides at `t`, and what they were made of.
    fn forces(&self, reader: &mut ForcingReader<'_>, t: f64) -> (f64, [f64; F], Legs, Sample<1>) {
        let [right, left] = &mut reader.feet;
        let feet = [right.sample(t), left.sample(t)];
        let legs = self.legs(&feet);
        let z = reader.height.sample(t);
        let ground = reader.level.unwrap_or_else(|| reader.ground.sample(t).0[0]);
        let (z_b, zdd_b) = (z.position[0] - ground, z.acceleration[0]);
        let f_z = self.body * (zdd_b + GRAVITY) + self.leg * (legs.acceleration[2] + 2.0 * GRAVITY); // (4.35)
        let p = reader.zmp.after(t, &mut reader.node);
        let by_z = 1.0 / z_b;
        let scale = by_z / self.body;
        let mut swing = [0.0; 2];
        for l in &feet {
            let (up, z_l) = (l.acceleration[2] + GRAVITY, l.position[2] + self.leg_height - ground);
            for (d, swing) in swing.iter_mut().enumerate() {
                *swing += l.position[d] * up - z_l * l.acceleration[d];
            }
        }
        let r = [0, 1].map(|d| scale * (self.leg * swing[d] - p[d] * f_z)); // (4.38), (4.39)
        let q = reader.shapes.map(|s| -scale * f_z * s.at(t)); // (4.49)
        ((zdd_b + GRAVITY) * by_z, [r[0], r[1], q[0], q[1]], legs, z)
    }

    /// Places knots on all `marks` \[s\], and between them no farther apart than `spacing`, and solves the boundary value
    /// problem there.
    pub(crate) fn solve(&mut self, forcing: &Forcing<'_>, marks: &[f64], spacing: f64) -> PlanVerdict {
        if !place_knots(self.method.solver_mut().problem_mut(), marks, spacing) {
            return PlanVerdict::TooLong;
        }
        // Coefficients at the knots and half-way between them, read in the order of time.
        let last = self.problem().n - 1;
        let mut reader = ForcingReader::new(forcing);
        for i in 0..=last {
            let t = self.problem().t[i];
            let (om2, f, legs, height) = self.forces(&mut reader, t);
            (self.legs[i], self.heights[i]) = (legs, height);
            let half = if i < last {
                self.forces(&mut reader, 0.5 * (t + self.problem().t[i + 1])).1
            } else {
                [0.0; F]
            };
            let problem = self.method.solver_mut().problem_mut();
            (problem.om2[i], problem.f[i], problem.half[i]) = (om2, f, half);
        }
        self.method.solver_mut().solve()
    }

    /// The problem that was solved last.
    fn problem(&self) -> &BoundaryProblem {
        self.method.solver().problem()
    }

    /// Slopes at both ends of the problem that was solved last.
    pub(crate) fn ends(&self) -> EndSlopes {
        self.method.solver().ends()
    }

    /// Position and velocity of the body mass point where the problem that was solved last ends.
    pub(crate) fn end(&self, ends: &EndConditions) -> PlanarState {
        let [r, v, _] = self.method.solver().motion(self.problem().n - 1, ends);
        PlanarState { r, v }
    }

    /// Appends the robot's centre of gravity to `com`: quintics through position, velocity and acceleration at knots.
    /// Returns what the ground must do meanwhile.
    pub(crate) fn write<const N: usize>(&self, ends: &EndConditions, com: &mut Path<3, N>) -> GroundDemand {
        let mut last = self.com(0, ends);
        let mut ground = GroundDemand::UNTOUCHED.with(last.acceleration);
        for i in 1..self.problem().n {
            let next = self.com(i, ends);
            com.push(&last, &next, self.problem().t[i]);
            let by_h = 1.0 / (self.problem().t[i] - self.problem().t[i - 1]);
            // Half-way through a quintic, by Simpson's rule, which is exact for its acceleration.
            let half = std::array::from_fn(|d| {
                1.5 * by_h * (next.velocity[d] - last.velocity[d])
                    - 0.25 * (last.acceleration[d] + next.acceleration[d])
            });
            ground = ground.with(half).with(next.acceleration);
            last = next;
        }
        ground
    }

    fn com(&self, i: usize, ends: &EndConditions) -> Sample<3> {
        let ([r, v, a], z, legs) = (self.method.solver().motion(i, ends), &self.heights[i], &self.legs[i]);
        let of = |b: [f64; 2], z: [f64; 1], l: &[f64; 3]| {
            let b = [b[0], b[1], z[0]];
            std::array::from_fn(|d| self.body * b[d] + self.leg * l[d])
        };
        Sample {
            position: of(r, z.position, &legs.position),
            velocity: of(v, z.velocity, &legs.velocity),
            acceleration: of(a, z.acceleration, &legs.acceleration),
        }
    }
}

/// Knots on all `marks` \[s\], and between them no farther apart than `spacing`; `false` if there is no room.
fn place_knots(problem: &mut BoundaryProblem, marks: &[f64], spacing: f64) -> bool {
    let mut n = 0;
    problem.t[0] = marks[0];
    for pair in marks.windows(2) {
        let pieces = pieces(pair[1] - pair[0], spacing);
        if n + pieces >= MAX_KNOTS {
            return false;
        }
        let step = (pair[1] - pair[0]) / pieces as f64;
        for k in 1..pieces {
            problem.t[n + k] = pair[0] + k as f64 * step;
        }
        n += pieces;
        problem.t[n] = pair[1];
    }
    problem.n = n + 1;
    true
}

/// Pieces no longer than `spacing` that an interval of length `h` is cut into.
pub fn pieces(h: f64, spacing: f64) -> usize {
    ((h / spacing - 1e-6).ceil() as usize).max(1)
}
