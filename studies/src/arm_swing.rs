//! What swinging arms take from the soles (thesis 4.9): the vertical moment, and how far soles turn on the ground.
//!
//! The moment is that of the ground on the foot that carries more, about its own centre of pressure: the one that friction
//! alone has to bear. Both come from the simulated robot itself, not from its sensors.

use std::path::PathBuf;

use config::Setup;
use drawing::color::{BLACK, GREY, VERMILION};
use drawing::{Chart, Figure};
use messages::{Command, GaitState, SimState};
use serde::Serialize;

use chain::Chain;

use crate::sheet::{self, Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

/// Scenes that are walked, and their speeds for people \[km/h\].
const SCENES: [(&str, f64); 2] = [("walk_2kmh", 2.0), ("walk_3kmh", 3.0)];
/// Arm swings that are tried; the first one is the comparison, the others against it.
const SWINGS: [f64; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];
/// The one that is drawn beside none.
const DRAWN: f64 = 1.0;
/// \[s\] The gait is periodic by then, and is looked at for that long, of which the last ones are drawn.
const TIMES: (f64, f64, f64) = (10.0, 10.0, 3.0);

/// A walk as a row; one that fell has nothing else.
const COLUMNS: &[Column] = &[
    plain("/scene", "scene"),
    fixed("/swing", "arm swing", 1),
    fixed("/moment_nm/0", "moment, rms [N m]", 2),
    fixed("/moment_nm/1", "max [N m]", 2),
    fixed("/turned_mrad", "sole turned [mrad/step]", 1),
    fixed("/inclination_mrad/0", "phi_x [mrad]", 1),
    fixed("/inclination_mrad/1", "phi_y [mrad]", 1),
    fixed("/shoulder_rad", "shoulder [rad]", 2),
    plain("/fell", "fell"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct ArmSwingStudy {
    /// Type of the model: 1, reduced; 2, with motors; 3, with elastic gears.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
    pub depth: u8,
    /// Directory of the pictures.
    #[arg(long, value_name = "DIR", default_value = "runs/study/arm_swing")]
    pub out: PathBuf,
}

impl Study for ArmSwingStudy {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        sheet::make(&self.out)?;
        let mut sheet =
            Sheet::titled("Vertical moment of the stance foot, turn of its sole, inclination error");
        let (mut all, mut figures) = (Vec::new(), Vec::new());
        for (scene, speed) in SCENES {
            let mut setup = Setup::load(given.config, scene)?;
            crate::figures_of_thesis::deepen(&mut setup, self.depth);
            setup.scene.duration = TIMES.0 + TIMES.1;
            setup.scene.commands.retain(|(_, command)| *command != Command::Stop);
            let mut of_swing = |swing: f64| {
                setup.gait.arm_swing = (swing > 0.0).then_some(swing);
                walk(&setup, speed, swing)
            };
            let walks = SWINGS.into_iter().map(&mut of_swing).collect::<Result<Vec<SwingWalk>, _>>()?;
            figures.push((format!("arm_swing_{scene}.png"), draw(&setup, &walks)));
            all.extend(walks);
        }
        sheet.rows("walks", COLUMNS, &all);
        for (name, figure) in figures {
            sheet.draw(&self.out, &name, &figure)?;
        }
        Ok(sheet)
    }
}

/// One walk.
#[derive(Clone, Debug, Serialize)]
struct SwingWalk {
    /// Name of the scene.
    scene: String,
    /// \[km/h\]
    speed_kmh: f64,
    /// Arm's over leg's motion.
    swing: f64,
    /// Whether the robot fell: then nothing else counts.
    fell: bool,
    /// \[N m\] Vertical moment of the stance foot about its centre of pressure: root mean square, largest.
    moment_nm: [f64; 2],
    /// \[mrad\] How far a sole turns on the ground while it carries more than the other: mean of all steps.
    turned_mrad: f64,
    /// \[mrad\] Largest inclination errors phi_x, phi_y.
    inclination_mrad: [f64; 2],
    /// \[rad\] Amplitude of the shoulders.
    shoulder_rad: f64,
    /// (time, moment)
    #[serde(skip)]
    trace: Vec<[f64; 2]>,
}

/// \[N m\] Moment of the ground on a foot about its centre of pressure, vertical.
fn moment(sim: &SimState, foot: usize) -> f64 {
    let ([fx, fy, fz], [mx, my, mz]) = (sim.foot_wrench[foot].force, sim.foot_wrench[foot].moment);
    let (px, py) = (-my / fz, mx / fz);
    mz - (px * fy - py * fx)
}

fn walk(setup: &Setup, speed_kmh: f64, swing: f64) -> Result<SwingWalk, Error> {
    let mut chain = Chain::new(setup)?;
    let mut walk = SwingWalk {
        scene: setup.scene.name.clone(),
        speed_kmh,
        swing,
        fell: false,
        moment_nm: [0.0; 2],
        turned_mrad: f64::NAN,
        inclination_mrad: [0.0; 2],
        shoulder_rad: 0.0,
        trace: Vec::new(),
    };
    let shoulder = setup.robot.arms.map_or(0, |arms| arms.joints[0]);
    let mut shoulders = [f64::INFINITY, f64::NEG_INFINITY];
    let mut turned = Vec::new();
    // The foot that carries, and its heading when it began to.
    let mut stance: Option<(usize, f64)> = None;
    for _ in 0..(setup.scene.duration / setup.scene.cycle).round() as u64 {
        let cycle = chain.step();
        let (sim, state) = (&cycle.sim_state, &cycle.controller_state);
        walk.fell |= sim.fallen == 1;
        if sim.time < TIMES.0 || GaitState::from(state.gait) != GaitState::Walking {
            continue;
        }
        let foot = usize::from(sim.foot_wrench[1].force[2] > sim.foot_wrench[0].force[2]);
        if stance.is_none_or(|(before, _)| before != foot) {
            if let Some((before, heading)) = stance {
                turned.push((sim.feet[before][3] - heading).abs() * 1e3);
            }
            stance = Some((foot, sim.feet[foot][3]));
        }
        let m = moment(sim, foot);
        walk.trace.push([sim.time, m]);
        walk.moment_nm[1] = walk.moment_nm[1].max(m.abs());
        for (most, e) in walk.inclination_mrad.iter_mut().zip(state.inclination_error) {
            *most = most.max(1e3 * e.abs());
        }
        let q = sim.joint_angle[shoulder];
        shoulders = [shoulders[0].min(q), shoulders[1].max(q)];
    }
    let square: f64 = walk.trace.iter().map(|[_, m]| m * m).sum();
    walk.moment_nm[0] = (square / walk.trace.len() as f64).sqrt();
    walk.turned_mrad = turned.iter().sum::<f64>() / turned.len() as f64;
    walk.shoulder_rad = 0.5 * (shoulders[1] - shoulders[0]);
    Ok(walk)
}

fn draw(setup: &Setup, walks: &[SwingWalk]) -> Figure {
    let end = TIMES.0 + TIMES.1;
    let about = format!("{}, scene {}, model type {}", setup.robot.name, setup.scene.name, setup.scene.depth);
    let mut chart =
        Chart::new("vertical moment of the stance foot", "time [s]", "moment [N m]").height(360.0);
    chart.dashed("", vec![[end - TIMES.2, 0.0], [end, 0.0]], GREY);
    for (w, color) in
        walks.iter().filter(|w| !w.fell && (w.swing == 0.0 || w.swing == DRAWN)).zip([VERMILION, BLACK])
    {
        let name = if w.swing == 0.0 { "arms still".into() } else { format!("arm swing {}", w.swing) };
        let points = w.trace.iter().copied().filter(|row| row[0] > end - TIMES.2).collect();
        let draw = if w.swing == 0.0 { Chart::dashed } else { Chart::line };
        draw(&mut chart, &name, points, color);
    }
    Figure::new("Arm swing (thesis 4.9)", &about).with(chart)
}
