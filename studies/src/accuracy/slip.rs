//! A block on an incline: creep while it should stick, acceleration while it slides, along and across the axes of the
//! friction law (chart 3).
//!
//! Axes of the plane, z its normal; gravity leans. Exact: no creep below the friction angle; above it the block slides
//! with g (sin a - mu cos a), whatever its direction. MuJoCo has an elliptic cone or a pyramid, both regularised.

use std::error::Error;

use contact::point::{self, ContactLaw};
use serde_json::Value;

use super::system::{SteppingMethod, System, SystemMotion, Times, stepper};
use super::{AccuracyInput, ErrorChart, Part, Peers, Point};

pub(super) const PART: Part = charts;

const MASS: f64 = 10.0;
/// \[s\] Motion between 1 s and 2 s is looked at; the layer is at rest by then.
const TIMES: Times = Times { every: 1.0, count: 2 };
const DIRECTIONS: [f64; 7] = [0.0, 7.5, 15.0, 22.5, 30.0, 37.5, 45.0];

fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let title = "A block on an incline, downhill 0 to 45 degrees off the axes";
    let about = "Above: 30 degrees, mu 0.3, slides. Below: 20 degrees, mu 0.8, must not move. A dot at the bottom is zero.";
    let mut slide =
        ErrorChart::new("slip.slides", title, "relative error of the acceleration").about(about).scattered();
    let mut stick = ErrorChart::new("slip.sticks", title, "creep [m/s]").about(about).scattered();
    for direction in DIRECTIONS {
        for step in [1e-3, 1e-4] {
            slide.add(ours(30.0, 0.3, direction, step));
        }
        stick.add(ours(20.0, 0.8, direction, 1e-3));
    }
    for found in given.peers.of(&[("scene", "incline"), ("integrator", "Euler")]) {
        let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
        if number("step_s") != 1e-3 {
            continue;
        }
        let slides = number("slope_deg") == 30.0;
        let relative = (number("acceleration") / number("acceleration_exact") - 1.0).abs();
        let error = if slides { relative } else { number("speed").abs() };
        if slides { &mut slide } else { &mut stick }.add(theirs(given.peers, found, error));
    }
    Ok(vec![slide, stick])
}

fn ours(slope: f64, friction: f64, direction: f64, step: f64) -> Point {
    let mut block = Block::new(slope, friction, direction);
    let start = block.start();
    let (motion, point) = SteppingMethod::Euler(step).measure(&mut block, &start, TIMES);
    let error = if slope == 30.0 { block.acceleration_error(&motion) } else { block.creep(&motion) };
    let (scene, model) = ("incline".to_string(), "contact point".to_string());
    let method = format!("contact point, {}", super::order::in_ms(step));
    Point { scene, model, method, error, solver: Some(format!("{direction}°")), ..point }
}

fn theirs(peers: &Peers, found: &Value, error: f64) -> Point {
    let cone = found["cone"].as_str().unwrap_or_default();
    let impratio = found["impratio"].as_f64().unwrap_or(1.0);
    let noslip = found["noslip"].as_f64().unwrap_or(0.0);
    let name = if noslip == 0.0 { cone.to_string() } else { format!("{cone}, noslip {noslip}") };
    let method = format!("{} {name}", peers.peer);
    let direction = found["direction_deg"].as_f64().unwrap_or(0.0);
    let solver = match impratio {
        1.0 => format!("{direction}°"),
        _ => format!("{direction}°, impratio {impratio}"),
    };
    Point { method, error, solver: Some(solver), ..peers.point(found, |_| error) }
}

/// x = (position, velocity, displacement of the node).
struct Block {
    law: ContactLaw,
    gravity: [f64; 3],
    /// \[m/s^2\] Exact, downhill.
    acceleration: f64,
}

impl Block {
    fn new(slope: f64, friction: f64, direction: f64) -> Self {
        let (a, b, g) = (slope.to_radians(), direction.to_radians(), multibody::GRAVITY_ACCELERATION);
        Self {
            law: ContactLaw { stiffness: [2e4; 3], damping: [1e3; 3], friction, recovery: 200.0 },
            gravity: [g * a.sin() * b.cos(), g * a.sin() * b.sin(), -g * a.cos()],
            acceleration: (g * (a.sin() - friction * a.cos())).max(0.0),
        }
    }

    /// At rest, the node pressed in by the weight.
    fn start(&self) -> [f64; 9] {
        let depth = MASS * -self.gravity[2] / self.law.stiffness[2];
        [0.0, 0.0, -depth, 0.0, 0.0, 0.0, 0.0, 0.0, depth]
    }

    fn acceleration_error(&self, motion: &SystemMotion) -> f64 {
        let speed = |x: &[f64]| x[3].hypot(x[4]);
        match &motion.seen[..] {
            [a, b] => ((speed(b) - speed(a)) / TIMES.every / self.acceleration - 1.0).abs(),
            _ => f64::NAN,
        }
    }

    /// \[m/s\] Way of the node between the two times.
    fn creep(&self, motion: &SystemMotion) -> f64 {
        let node = |x: &[f64], k: usize| x[k] + x[6 + k];
        match &motion.seen[..] {
            [a, b] => (node(b, 0) - node(a, 0)).hypot(node(b, 1) - node(a, 1)) / TIMES.every,
            _ => f64::NAN,
        }
    }
}

impl System for Block {
    fn rate(&mut self, _: f64, x: &[f64], dx: &mut [f64]) {
        let a = point::solve(&self.law, [x[6], x[7], x[8]], [x[3], x[4], x[5]], x[2] + x[8]);
        for k in 0..3 {
            dx[k] = x[3 + k];
            dx[3 + k] = a.force[k] / MASS + self.gravity[k];
            dx[6 + k] = a.rate[k];
        }
    }

    fn own_step(&mut self, t: f64, h: f64, x: &mut [f64]) {
        stepper(9).euler(t, h, x, |t, x, dx| self.rate(t, x, dx));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cone_is_round_and_nothing_creeps() {
        for direction in [0.0, 22.5, 45.0, 71.0] {
            let run = |slope, friction| {
                let mut block = Block::new(slope, friction, direction);
                let start = block.start();
                let motion = SteppingMethod::Euler(1e-3).run(&mut block, &start, TIMES);
                (block, motion)
            };
            let (block, motion) = run(30.0, 0.3);
            assert!(block.acceleration_error(&motion) < 1e-9, "{}", block.acceleration_error(&motion));
            let (block, motion) = run(20.0, 0.8);
            assert!(block.creep(&motion) < 1e-15, "{}", block.creep(&motion));
        }
    }
}
