//! Sampling time, integral and integration step of drives with a clock of their own: what a walk costs, and how far its motors
//! are from where they are to be. `gangwerk study servo`.

use std::path::PathBuf;

use ::drives::{CascadePi, ControlLaw, SamplePeriods, Sampling};
use config::Setup;
use config::method::{Integrator, Method};
use drawing::color::{BLUE, GREEN, VERMILION};
use drawing::{Chart, Color, Figure};
use serde::Serialize;

use crate::scorecard::walk;
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

/// The walk.
const SCENE: &str = "archie_walk";
/// \[s\] Periods of the speed loop; each position loop takes twice its own.
const PERIODS: [(f64, Color); 3] = [(80e-6, GREEN), (160e-6, BLUE), (320e-6, VERMILION)];
/// Integration steps in a period.
const STEPS: [u32; 3] = [1, 2, 4];

const COLUMNS: &[Column] = &[
    fixed("/period_s", "speed loop [us]", 0).times(1e6),
    plain("/integral", "integral"),
    fixed("/step_s", "step [us]", 0).times(1e6),
    fixed("/motor_mrad", "hips, knees, motor side [mrad]", 2),
    fixed("/inclination_mrad", "inclination [mrad]", 1),
    fixed("/real_time", "times real time", 1),
    plain("/ended", "ended"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Servo {
    /// Directory of the picture.
    #[arg(long, value_name = "DIR", default_value = "runs/study/servo")]
    pub out: PathBuf,
}

#[derive(Serialize)]
struct Walked {
    period_s: f64,
    integral: bool,
    step_s: f64,
    motor_mrad: f64,
    inclination_mrad: f64,
    real_time: f64,
    ended: Option<String>,
}

impl Study for Servo {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let count = 2 * PERIODS.len() * STEPS.len();
        let mut walks = Vec::new();
        let mut chart = Chart::new(SCENE, "times real time [1]", "hips, knees, motor side [mrad]");
        // A line for each period and law, a point for each step.
        for (period, color) in PERIODS {
            for integral in [true, false] {
                let mut points = Vec::new();
                for steps in STEPS {
                    (given.progress)(walks.len(), count, "speed and error");
                    let walked = one(given, period, integral, steps)?;
                    points.push([walked.real_time, walked.motor_mrad]);
                    walks.push(walked);
                }
                let name = format!("{:.0} us, {}", 1e6 * period, if integral { "PI" } else { "P" });
                if integral {
                    chart.line(&name, points.clone(), color);
                } else {
                    chart.dashed(&name, points.clone(), color);
                }
                chart.dots("", points, 5.0, color);
            }
        }
        let mut sheet = Sheet::default();
        sheet.rows("walks", COLUMNS, &walks);
        let about =
            "Points of a line: 1, 2, 4 integration steps in a period of the speed loop, from right to left.";
        sheet.draw(
            &self.out,
            "servo.png",
            &Figure::new("Sampling time, integral, step", about).with(chart),
        )?;
        Ok(sheet)
    }
}

fn one(given: &Given<'_>, period: f64, integral: bool, steps: u32) -> Result<Walked, Error> {
    let mut setup = Setup::load(given.config, SCENE)?;
    for drive in &mut setup.robot.drives {
        drive.control.sampling = Sampling::Period(SamplePeriods { speed: period, position_every: 2 });
        if let (ControlLaw::CascadePi(law), false) = (drive.control.law, integral) {
            drive.control.law = ControlLaw::CascadePi(CascadePi { speed_integral: 0.0, ..law });
        }
    }
    // Whole periods of the position loop that are nearest to the scene's cycle.
    setup.scene.cycle = 2.0 * period * (0.5 * setup.scene.cycle / period).round();
    let step = period / f64::from(steps);
    let substeps = (setup.scene.cycle / step).round() as u32;
    setup.scene.choose(Method { depth: 3, integrator: Integrator::SemiImplicit, substeps });
    // A step as long as the longest period is longer than the soles allow, and is shown all the same.
    setup.scene.force_step = true;
    let walked = walk::walk(&setup)?;
    let f = &walked.figures;
    Ok(Walked {
        period_s: period,
        integral,
        step_s: step,
        motor_mrad: 1e3 * f.hip_knee_motor_side_error_max_rad,
        inclination_mrad: 1e3 * f.inclination_error_max_rad.iter().copied().fold(0.0, f64::max),
        real_time: f.real_time_factor,
        ended: walked.ended,
    })
}
