//! The figures a walk is judged by, gathered cycle by cycle.

mod landing;
mod way;

use std::collections::BTreeMap;

use config::Setup;
use messages::{ControllerState, GaitState, MAX_JOINTS, SimState};
use recording::polygon;
use serde::Serialize;

use crate::ending::Ending;
use landing::Landing;
use way::StepRecord;

/// Parts of the names of the joints that carry most while walking (thesis 8.1.1).
const LOADED: [&str; 2] = ["hip_flexion", "knee_flexion"];

/// What `gangwerk sim SCENE --json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Name of the scene.
    pub scene: String,
    /// Name of the robot.
    pub robot: String,
    /// Modelling depth, and the integrator with its steps per bus cycle.
    pub depth: String,
    /// Why that depth, of a scene that leaves it open.
    pub depth_reason: Option<String>,
    /// Events after which the simulation says nothing about the robot, as sentences, each once.
    pub doubts: Vec<String>,
    /// Whether the robot fell.
    pub fell: bool,
    /// What ended the walk: `done`, `asked`, `fell`, `power_off: REASON`, `stopped: REASON`.
    pub ended_by: String,
    /// \[s\] When.
    pub ended_at: f64,
    /// Commands of the scene that were refused.
    pub commands_refused: u64,
    /// \[s\] Simulated time.
    pub duration_s: f64,
    /// \[m\] Way of the torso from the first to the last periodic step.
    pub distance_m: f64,
    /// \[m/s\] Mean speed over that way; zero without two periodic steps.
    pub mean_speed_m_s: f64,
    /// Steps taken.
    pub steps: u64,
    /// \[m\] Mean length of the periodic steps.
    pub step_length_m: f64,
    /// \[s\] Their mean duration.
    pub step_duration_s: f64,
    /// \[rad\] Angle through which the torso turned per step from the first to the last periodic one.
    pub step_turn_rad: f64,
    /// Steps from standing up to the first one as long as the periodic ones (within 3 %), and from the last such one on until
    /// the robot stands again.
    pub steps_to_speed_and_rest: [u64; 2],
    /// \[rad\] Largest inclination error (phi_x, phi_y) while a plan runs.
    pub inclination_error_max_rad: [f64; 2],
    /// \[rad\] Its root mean square.
    pub inclination_error_rms_rad: [f64; 2],
    /// \[rad\] Largest joint tracking error.
    pub joint_tracking_error_max_rad: f64,
    /// \[rad\] The same of hip flexion and knees.
    pub hip_knee_tracking_error_max_rad: f64,
    /// \[rad\] The same on the motors' side of elastic gears.
    pub hip_knee_motor_side_error_max_rad: f64,
    /// \[rad\] The same by joint, links.
    pub tracking_error_by_joint_rad: BTreeMap<String, f64>,
    /// \[rad\] The same by joint, motors.
    pub motor_side_error_by_joint_rad: BTreeMap<String, f64>,
    /// \[N\] Largest normal force of one foot.
    pub peak_normal_force_n: f64,
    /// \[1\] Largest normal force in the first 0.1 s after a landing over the largest desired one of that stance, of the
    /// landing for which this is most: up to 1, the foot is not struck harder than it is to carry.
    pub landing_peak_ratio: f64,
    /// \[1\] By how many weights of the robot the normal force exceeds the desired one at most in those 0.1 s.
    pub landing_excess_weights: f64,
    /// \[m\] Least distance of the zero-moment point to the edge of the hull of the contact points that carry.
    pub zmp_margin_min_m: f64,
    /// \[m, m, rad\] Torso at the end: x, y, heading.
    pub end_pose: [f64; 3],
    /// \[s\] Processor time.
    pub cpu_s: f64,
    /// Simulated time over processor time.
    pub real_time_factor: f64,
    /// Log file, if one was written.
    pub log: Option<String>,
}

impl Figures {
    /// The same of a run that ended like this.
    pub fn ended(self, ending: &Ending) -> Self {
        let (by, ended_at) = ending.end();
        Self {
            fell: ending.fell().is_some(),
            ended_by: by.to_string(),
            ended_at,
            commands_refused: ending.refused,
            doubts: ending.doubts(),
            ..self
        }
    }
}

/// Gathers [`Figures`].
#[derive(Clone, Debug, Default)]
pub struct Gatherer {
    ending: Ending,
    time: f64,
    error_max: [f64; 2],
    error_square: [f64; 2],
    cycles: f64,
    /// \[rad\] Largest tracking errors of links and motors.
    tracking: [[f64; MAX_JOINTS]; 2],
    /// \[rad\] Links less motors when the last cycle ended, which is when the next one measures.
    twist: [f64; MAX_JOINTS],
    force: f64,
    landing: [Landing; 2],
    margin: Option<f64>,
    way: StepRecord,
    end_pose: [f64; 3],
}

impl Gatherer {
    /// One cycle.
    pub fn add(&mut self, sim: &SimState, state: &ControllerState) {
        self.time = sim.time;
        let gait = if sim.fallen == 1 { GaitState::Fallen } else { state.gait.into() };
        self.ending.see(sim.time, sim.power == 1, gait);
        // True state of the simulated robot: from the first cycle on.
        let [x, y, z, w] = sim.orientation;
        let heading = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
        self.end_pose = [sim.position[0], sim.position[1], heading];
        for w in &sim.foot_wrench {
            self.force = self.force.max(w.force[2]);
        }
        let twist = std::array::from_fn(|j| sim.joint_angle[j] - sim.motor_angle[j]);
        let twist = std::mem::replace(&mut self.twist, twist);
        if state.plan_id == 0 {
            return;
        }
        // Errors against the plan: from the first plan on.
        self.cycles += 1.0;
        for i in 0..2 {
            let e = state.inclination_error[i];
            self.error_max[i] = self.error_max[i].max(e.abs());
            self.error_square[i] += e * e;
        }
        for (j, (link, twist)) in state.tracking_error.iter().zip(twist).enumerate() {
            for (side, error) in [*link, link + twist].into_iter().enumerate() {
                self.tracking[side][j] = self.tracking[side][j].max(error.abs());
            }
        }
        // Landings: a standing foot is put down by nobody.
        if matches!(GaitState::from(state.gait), GaitState::Walking | GaitState::Stopping) {
            for i in 0..2 {
                self.landing[i].add(sim.time, sim.foot_wrench[i].force[2], state.wrench_desired[i].force[2]);
            }
        }
        // Of the truth: the stabilizer takes its soles for flat, and does not know of a heel that is up.
        let at = polygon::zero_moment_point(sim).filter(|_| sim.fallen == 0);
        if let Some(margin) = at.and_then(|p| polygon::margin(&polygon::support_polygon(sim), p)) {
            self.margin = Some(self.margin.map_or(margin, |m| m.min(margin)));
        }
        self.way.add(sim, state, heading);
    }

    /// The figures so far.
    pub fn figures(&self, setup: &Setup, cpu_s: f64, log: Option<String>) -> Figures {
        let Setup { scene, robot, .. } = setup;
        let periodic = self.way.periodic();
        // A stride is two steps; only the periodic part of the walk counts.
        let per_step = |x: f64| x / (2.0 * periodic.strides).max(1.0);
        let by_joint = |errors: [f64; MAX_JOINTS]| -> BTreeMap<String, f64> {
            robot.joints.iter().map(|j| j.name.clone()).zip(errors).collect()
        };
        let [link, motor] = self.tracking.map(by_joint);
        let loaded = |errors: &BTreeMap<String, f64>| {
            let of = errors.iter().filter(|(name, _)| LOADED.iter().any(|part| name.contains(part)));
            of.map(|(_, e)| *e).fold(0.0, f64::max)
        };
        let worst = |value: fn(&Landing) -> f64| self.landing.iter().map(value).fold(0.0, f64::max);
        // Ending, and the reason for the depth, are filled in by whoever ran the scene.
        let n = self.cycles.max(1.0);
        Figures {
            scene: scene.name.clone(),
            robot: scene.robot.clone(),
            depth: format!("{}, {:?} x {}", scene.model(), scene.integrator, scene.substeps),
            depth_reason: None,
            doubts: Vec::new(),
            fell: false,
            ended_by: String::new(),
            ended_at: 0.0,
            commands_refused: 0,
            duration_s: self.time,
            distance_m: periodic.distance,
            mean_speed_m_s: if periodic.span > 0.0 { periodic.distance / periodic.span } else { 0.0 },
            steps: self.way.steps(),
            step_length_m: per_step(periodic.distance),
            step_duration_s: per_step(periodic.span),
            step_turn_rad: per_step(periodic.turn),
            steps_to_speed_and_rest: self.way.to_speed_and_rest(per_step(periodic.distance)),
            inclination_error_max_rad: self.error_max,
            inclination_error_rms_rad: self.error_square.map(|s| (s / n).sqrt()),
            joint_tracking_error_max_rad: self.tracking[0].iter().copied().fold(0.0, f64::max),
            hip_knee_tracking_error_max_rad: loaded(&link),
            hip_knee_motor_side_error_max_rad: loaded(&motor),
            tracking_error_by_joint_rad: link,
            motor_side_error_by_joint_rad: motor,
            peak_normal_force_n: self.force,
            landing_peak_ratio: worst(Landing::ratio),
            landing_excess_weights: worst(Landing::excess) / robot.weight(),
            zmp_margin_min_m: self.margin.unwrap_or(f64::NAN),
            end_pose: self.end_pose,
            cpu_s,
            real_time_factor: if cpu_s > 0.0 { self.time / cpu_s } else { 0.0 },
            log,
        }
        .ended(&self.ending)
    }
}

/// The figures as lines for people.
pub fn table(f: &Figures) -> String {
    let milli = |x: [f64; 2]| format!("{:.1}, {:.1} mrad", 1e3 * x[0], 1e3 * x[1]);
    let rows = [
        ("scene", format!("{} ({}, {})", f.scene, f.robot, f.depth)),
        ("ended by", format!("{}, at {:.3} s", f.ended_by, f.ended_at)),
        ("fell", if f.fell { "yes".into() } else { "no".into() }),
        ("commands refused", f.commands_refused.to_string()),
        ("duration", format!("{:.1} s, {} steps", f.duration_s, f.steps)),
        ("walking speed", format!("{:.3} m/s = {:.2} km/h", f.mean_speed_m_s, 3.6 * f.mean_speed_m_s)),
        ("inclination error, max", milli(f.inclination_error_max_rad)),
        ("inclination error, rms", milli(f.inclination_error_rms_rad)),
        ("periodic step", format!("{:.3} m, {:.3} s", f.step_length_m, f.step_duration_s)),
        ("joint tracking error, max", format!("{:.2e} rad", f.joint_tracking_error_max_rad)),
        (
            "of hip flexion and knees",
            format!(
                "{:.2e} rad; motor side {:.2e} rad",
                f.hip_knee_tracking_error_max_rad, f.hip_knee_motor_side_error_max_rad
            ),
        ),
        ("normal force of a foot, max", format!("{:.0} N", f.peak_normal_force_n)),
        (
            "landing, max",
            format!(
                "{:.2} of the stance's desired force, {:.2} weights over it",
                f.landing_peak_ratio, f.landing_excess_weights
            ),
        ),
        ("ZMP to edge of support, min", format!("{:.1} mm", 1e3 * f.zmp_margin_min_m)),
        (
            "end pose",
            format!("x {:.2} m, y {:.2} m, heading {:.2} rad", f.end_pose[0], f.end_pose[1], f.end_pose[2]),
        ),
        ("real-time factor", if f.cpu_s > 0.0 { format!("{:.0}", f.real_time_factor) } else { "-".into() }),
        ("log", f.log.clone().unwrap_or_else(|| "-".into())),
    ];
    let doubts = f.doubts.iter().map(|doubt| ("not to be trusted", doubt.clone()));
    rows.into_iter()
        .chain(doubts)
        .map(|(name, value)| format!("{name:29}{value}"))
        .collect::<Vec<_>>()
        .join("\n")
}
