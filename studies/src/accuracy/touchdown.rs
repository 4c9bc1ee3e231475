//! A mass of 60 kg falls 10 mm onto one contact point: the force jumps, and with it every order falls to one (chart 2).
//!
//! Exact: parabola, then damped oscillation about the static deflection in closed form; the mass does not lift off again.

use std::error::Error;

use contact::point::{self, ContactLaw};
use sim_backend::step_limit::{eigenvalues, euler_limit, runge_kutta_limit};

use crate::search::{NoBorder, Width, border};

use super::system::{SteppingMethod, System, SystemMotion, Times, largest, stepper};
use super::{AccuracyInput, ErrorChart, Part, Point};

pub(super) const PART: Part = charts;

const MASS: f64 = 60.0;
const LAW: ContactLaw = ContactLaw { stiffness: [2e5; 3], damping: [2e3; 3], friction: 0.6, recovery: 0.0 };
/// \[m\]
const FALL: f64 = 0.01;
/// \[m\] Height from which a node counts as touching.
const TOUCH: f64 = 1e-6;
const TIMES: Times = Times { every: 0.01, count: 20 };
const STEPS: [f64; 10] = [5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6];

fn charts(_: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let about =
        "60 kg fall 10 mm onto one contact point, K = 200 kN/m, B = 2 kN s/m, 0.2 s. Reference: closed form.";
    let mut chart =
        ErrorChart::new("touchdown", "Touchdown of a mass", "largest error of the height [m]").about(about);
    let exact = exact();
    let mut add = |method: SteppingMethod| {
        let (motion, point) = method.measure(&mut Mass, &[FALL + TOUCH, 0.0, 0.0], TIMES);
        let error = largest(&motion, &exact, |a, b| (a[0] - b[0]).abs());
        chart.add(Point { scene: "mass".into(), model: "contact point".into(), error, ..point });
    };
    for h in STEPS {
        add(SteppingMethod::Euler(h));
    }
    for h in STEPS {
        add(SteppingMethod::RungeKutta4(h));
    }
    for h in STEPS {
        add(SteppingMethod::Own(LOCATED, h));
    }
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        add(SteppingMethod::Bdf(tolerance));
    }
    // Of the mass at rest on its point.
    let rest = MASS * multibody::GRAVITY_ACCELERATION / LAW.stiffness[2];
    let values = eigenvalues(&[-rest, 0.0, rest], |x, dx| Mass.rate(0.0, x, dx))?;
    chart.limit("Euler", euler_limit(&values));
    chart.limit("RK4", runge_kutta_limit(&values));
    chart.expect_order("Euler", 1.0, 1e-6..=2e-4);
    chart.expect_order("RK4", 1.0, 1e-6..=2e-4);
    chart.expect_order(LOCATED, 4.0, 1e-4..=2e-3);
    Ok(vec![chart])
}

const LOCATED: &str = "RK4, event located";

/// x = (height of the mass, speed, displacement of the node).
struct Mass;

impl System for Mass {
    fn rate(&mut self, _: f64, x: &[f64], dx: &mut [f64]) {
        let a = point::solve(&LAW, [0.0, 0.0, x[2]], [0.0, 0.0, x[1]], x[0] + x[2]);
        (dx[0], dx[1], dx[2]) = (x[1], a.force[2] / MASS + multibody::GRAVITY.z, a.rate[2]);
    }

    /// Runge-Kutta; a step that would end below the ground is cut where it gets there.
    fn own_step(&mut self, t: f64, h: f64, x: &mut [f64]) {
        let open = |x: &[f64]| x[0] + x[2] >= TOUCH;
        let begin = x.to_vec();
        self.runge_kutta(t, h, x);
        if !open(&begin) || open(x) {
            return;
        }
        let [_, below] = border([0.0, h], Width::Absolute(1e-16), |step| {
            x.copy_from_slice(&begin);
            self.parabola(step, x);
            Ok::<_, NoBorder>(open(x))
        })
        .expect("a fall ends below the ground if a step over the contact does");
        x.copy_from_slice(&begin);
        self.parabola(below, x);
        x[0] = x[0].min((TOUCH - x[2]).next_down());
        self.runge_kutta(t + below, h - below, x);
    }
}

impl Mass {
    fn runge_kutta(&mut self, t: f64, h: f64, x: &mut [f64]) {
        stepper(3).runge_kutta_4(t, h, x, |t, x, dx| self.rate(t, x, dx));
    }

    /// A step in the air, which Runge-Kutta makes exactly.
    fn parabola(&self, h: f64, x: &mut [f64]) {
        x[0] += h * (x[1] + 0.5 * h * multibody::GRAVITY.z);
        x[1] += h * multibody::GRAVITY.z;
        x[2] *= (-h * LAW.stiffness[2] / LAW.damping[2]).exp();
    }
}

fn exact() -> SystemMotion {
    let g = multibody::GRAVITY_ACCELERATION;
    let landed = (2.0 * FALL / g).sqrt();
    let (k, decay) = (LAW.stiffness[2] / MASS, 0.5 * LAW.damping[2] / MASS);
    let (rest, o) = (-g / k, (k - decay * decay).sqrt());
    let (p, q) = (-rest, (-g * landed - decay * rest) / o);
    let height = |t: f64| {
        let s = t - landed;
        let swing = p * (o * s).cos() + q * (o * s).sin();
        if s < 0.0 { FALL - 0.5 * g * t * t } else { rest + (-decay * s).exp() * swing }
    };
    let seen = (1..=TIMES.count).map(|k| vec![TOUCH + height(k as f64 * TIMES.every)]);
    SystemMotion { seen: seen.collect(), ..SystemMotion::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::slope;

    #[test]
    fn the_order_falls_to_one_and_locating_the_event_brings_it_back() {
        let of = |method: fn(f64) -> SteppingMethod, steps: &[f64]| {
            let error = |h: &f64| {
                let motion = method(*h).run(&mut Mass, &[FALL + TOUCH, 0.0, 0.0], TIMES);
                [*h, largest(&motion, &exact(), |a, b| (a[0] - b[0]).abs())]
            };
            slope(&steps.iter().map(error).collect::<Vec<_>>())
        };
        let blind = of(SteppingMethod::RungeKutta4, &[2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5]);
        assert!((0.7..1.5).contains(&blind), "{blind}");
        let located = of(|h| SteppingMethod::Own(LOCATED, h), &[2e-3, 1e-3, 5e-4, 2e-4]);
        assert!(located > 3.5, "{located}");
    }
}
