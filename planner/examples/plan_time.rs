//! How long a plan takes, and how well its motion meets its zero-moment point.
//!
//! `cargo run --release -p planner --example plan_time`

#[path = "../tests/robot/mod.rs"]
mod robot;

use messages::{Command, command::VelocityCommand};
use realtime::clock;
use robot::{Robot, checks};

fn main() {
    println!("speed    spacing  pieces  error of the zero-moment point   time per plan: median   p99");
    for (kmh, spacing) in [(1.0, 0.08), (2.0, 0.16), (2.0, 0.08), (2.0, 0.06), (3.0, 0.08)] {
        let mut gait = robot::gait();
        gait.model.spacing = spacing;
        let mut r = Robot::new(&gait);
        r.stand();
        r.step(&[Command::Velocity(VelocityCommand { forward: kmh / 3.6, left: 0.0, turn: 0.0 })]);
        let mut times = Vec::new();
        while times.len() < 300 {
            let made = r.plans.len();
            let start = clock::now();
            r.step(&[]);
            let took = (clock::now() - start) as f64 * 1e-3;
            if r.plans.len() > made && r.plans.len() > 10 {
                times.push(took);
            }
        }
        times.sort_by(f64::total_cmp);
        let plan = r.plans.last().expect("made");
        let error = checks::zmp_error(plan, &gait) * 1e3;
        let (median, p99) = (times[times.len() / 2], times[times.len() * 99 / 100]);
        println!(
            "{kmh} km/h   {spacing:.2} s   {:3}     {error:8.3} mm                       {median:6.1} us   {p99:6.1} us",
            plan.com.pieces
        );
    }
}
