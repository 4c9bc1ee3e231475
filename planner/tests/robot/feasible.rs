//! Whether a plan can be walked: by other routes than the planner's, and at few instants, so that many plans can be asked.

use super::checks::{foot, hull, inside, sole};
use curves::Path;
use messages::{GaitState, Plan};

const G: f64 = 9.81;

/// What was worst about plans.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Worst {
    /// \[m\] Least distance of the planned zero-moment point from the edge of the support polygon.
    pub(crate) zmp: f64,
    /// \[m\] Least distance of the pressure point that both feet share (4.64) from the edges of their soles.
    pub(crate) shared: f64,
    /// \[m\] Least distance of the zero-moment point from the edge of what the soles can carry together.
    pub(crate) sole: f64,
    /// Most friction asked for.
    pub(crate) friction: f64,
    /// Least vertical force over the weight.
    pub(crate) force: f64,
    /// Largest jump of a position, velocity or acceleration at a knot.
    pub(crate) jump: f64,
}

impl Worst {
    pub(crate) const NONE: Self = Self {
        zmp: f64::INFINITY,
        shared: f64::INFINITY,
        sole: f64::INFINITY,
        friction: 0.0,
        force: f64::INFINITY,
        jump: 0.0,
    };

    pub(crate) fn and(self, o: Self) -> Self {
        Self {
            zmp: self.zmp.min(o.zmp),
            shared: self.shared.min(o.shared),
            sole: self.sole.min(o.sole),
            friction: self.friction.max(o.friction),
            force: self.force.min(o.force),
            jump: self.jump.max(o.jump),
        }
    }

    /// All of one plan.
    pub(crate) fn of(plan: &Plan) -> Self {
        let mut worst = Self { jump: jumps(plan), ..Self::NONE };
        worst.ground(plan);
        worst.support(plan);
        worst
    }

    /// Forces on the robot's mass, at knots and between them.
    fn ground(&mut self, plan: &Plan) {
        let mut begin = plan.body.start;
        for &end in &plan.body.ends[..plan.body.pieces as usize] {
            for k in 0..4 {
                let a = plan.body.sample(begin + 0.25 * f64::from(k) * (end - begin)).acceleration;
                self.friction = self.friction.max(a[0].hypot(a[1]) / (a[2] + G));
                self.force = self.force.min(a[2] / G + 1.0);
            }
            begin = end;
        }
    }

    /// The zero-moment point at its kinks, where it is worst, seen from the phases before and after; and the pressure
    /// points of the feet there and at some instants between.
    fn support(&mut self, plan: &Plan) {
        let n = plan.zmp.points as usize;
        assert!(
            plan.zmp.values[..n].iter().flatten().all(|x| x.is_finite()),
            "plan {}: zero-moment point",
            plan.id
        );
        let steps = &plan.steps[..plan.step_count as usize];
        let (mut polygon, mut known) = (Vec::new(), usize::MAX);
        for k in 0..n - 1 {
            let (begin, end) = (plan.zmp.times[k], plan.zmp.times[k + 1]);
            let middle = 0.5 * (begin + end);
            let step = steps.iter().position(|s| middle < s.end).unwrap_or(steps.len());
            let up = steps.get(step).filter(|s| middle > s.lift).map(|s| 1 - s.stance as usize);
            let phase = 2 * step + usize::from(up.is_some());
            if phase != known {
                known = phase;
                let feet = (0..2).filter(|&i| Some(i) != up);
                polygon = hull(feet.flat_map(|i| sole(i, foot(plan, i, middle))).collect());
            }
            for p in [plan.zmp.values[k], plan.zmp.values[k + 1]] {
                self.zmp = self.zmp.min(inside(&polygon, p));
            }
            if up.is_none() && plan.state != GaitState::Standing as u64 {
                for j in 0..=4 {
                    let [shared, sole] = pressure(plan, begin + 0.25 * f64::from(j) * (end - begin));
                    self.shared = self.shared.min(shared);
                    self.sole = self.sole.min(sole);
                }
            }
        }
    }
}

/// Both feet on the ground: least distance of the shared pressure point from the edge of a sole (4.64), and of the
/// zero-moment point from the edge of all points that pressure points in both soles can add up to.
fn pressure(plan: &Plan, t: f64) -> [f64; 2] {
    let rho = plan.load_left.sample(t).position[0];
    let feet = [foot(plan, 0, t), foot(plan, 1, t)];
    let p = plan.zmp.sample(t).0;
    let e = [0, 1].map(|d| p[d] - (1.0 - rho) * feet[0][d] - rho * feet[1][d]);
    let of = |i: usize, load: f64| {
        if load > 1e-9 { inside(&sole(i, [0.0, 0.0, feet[i][2]]), e) } else { f64::INFINITY }
    };
    let (right, left) = (sole(0, feet[0]), sole(1, feet[1]));
    let sums =
        right.iter().flat_map(|a| left.iter().map(|b| [0, 1].map(|d| (1.0 - rho) * a[d] + rho * b[d])));
    [of(0, 1.0 - rho).min(of(1, rho)), inside(&hull(sums.collect()), p)]
}

/// Largest jump at a knot of any path of a plan.
pub(crate) fn jumps(plan: &Plan) -> f64 {
    let mut worst = jump(&plan.body).max(jump(&plan.torso)).max(jump(&plan.load_left));
    for i in 0..2 {
        worst = worst.max(jump(&plan.feet[i])).max(jump(&plan.pitch[i])).max(jump(&plan.toes[i]));
    }
    worst
}

/// Largest difference of position, velocity and acceleration between the end of a piece and the begin of the next one;
/// infinite if its origin or a coefficient is not finite (a NaN would be lost in the next maximum).
fn jump<const D: usize, const N: usize>(path: &Path<D, N>) -> f64 {
    let n = path.pieces as usize;
    let mut worst = if path.origin.iter().all(|x| x.is_finite()) { 0.0f64 } else { f64::INFINITY };
    let mut begin = path.start;
    for i in 0..n {
        let h = path.ends[i] - begin;
        begin = path.ends[i];
        for d in 0..D {
            let c = &path.coefficients[i][d];
            let end = derivatives(c, h);
            if !end.iter().chain(c).all(|x| x.is_finite()) {
                return f64::INFINITY;
            }
            if i + 1 < n {
                let next = derivatives(&path.coefficients[i + 1][d], 0.0);
                worst = end.iter().zip(next).map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
            }
        }
    }
    worst
}

fn derivatives(c: &[f64; 6], t: f64) -> [f64; 3] {
    let power = |k: i32| t.powi(k);
    let sum = |f: &dyn Fn(i32) -> f64| (0..6).map(|k| c[k as usize] * f(k)).sum();
    [
        sum(&|k| power(k)),
        sum(&|k| if k < 1 { 0.0 } else { f64::from(k) * power(k - 1) }),
        sum(&|k| if k < 2 { 0.0 } else { f64::from(k * (k - 1)) * power(k - 2) }),
    ]
}
