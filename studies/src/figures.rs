//! The figures a walk is judged by, gathered cycle by cycle.

use messages::{ControllerState, GaitState, LEFT, RIGHT, SimState};
use serde::Serialize;

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
    /// Whether the robot fell.
    pub fell: bool,
    /// \[s\] Simulated time.
    pub duration_s: f64,
    /// \[m\] Way of the torso from the first to the last periodic step.
    pub distance_m: f64,
    /// \[m/s\] Mean speed over that way; zero without two periodic steps.
    pub mean_speed_m_s: f64,
    /// Steps taken.
    pub steps: u64,
    /// \[rad\] Largest inclination error (phi_x, phi_y) while a plan runs.
    pub inclination_error_max_rad: [f64; 2],
    /// \[rad\] Its root mean square.
    pub inclination_error_rms_rad: [f64; 2],
    /// \[rad\] Largest joint tracking error.
    pub joint_tracking_error_max_rad: f64,
    /// \[N\] Largest normal force of one foot.
    pub peak_normal_force_n: f64,
    /// \[m\] Least distance of the measured zero-moment point to the edge of the support polygon.
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

/// Gathers [`Figures`].
#[derive(Clone, Debug, Default)]
pub struct Gatherer {
    fell: bool,
    time: f64,
    steps: u64,
    error_max: [f64; 2],
    error_square: [f64; 2],
    cycles: f64,
    tracking: f64,
    force: f64,
    margin: Option<f64>,
    /// Stance foot of the last cycle.
    stance: Option<usize>,
    /// When and where the torso was each time the right foot took over while walking.
    strides: Vec<(f64, [f64; 2])>,
    end_pose: [f64; 3],
}

impl Gatherer {
    /// One cycle.
    pub fn add(&mut self, sim: &SimState, state: &ControllerState) {
        self.fell |= sim.fallen == 1;
        self.time = sim.time;
        let [x, y, z, w] = sim.orientation;
        let heading = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
        self.end_pose = [sim.position[0], sim.position[1], heading];
        for w in &sim.foot_wrench {
            self.force = self.force.max(w.force[2]);
        }
        if state.plan_id == 0 {
            return;
        }
        self.cycles += 1.0;
        for i in 0..2 {
            let e = state.inclination_error[i];
            self.error_max[i] = self.error_max[i].max(e.abs());
            self.error_square[i] += e * e;
        }
        self.tracking = state.tracking_error.iter().fold(self.tracking, |m, e| m.max(e.abs()));
        if state.zmp_margin.is_finite() {
            self.margin = Some(self.margin.map_or(state.zmp_margin, |m| m.min(state.zmp_margin)));
        }
        self.count_step(sim, state);
    }

    /// A step begins when the planned load has moved to one foot alone.
    fn count_step(&mut self, sim: &SimState, state: &ControllerState) {
        let stance = match state.load_left {
            l if l >= 1.0 => LEFT,
            l if l <= 0.0 => RIGHT,
            _ => return,
        };
        let gait = GaitState::from(state.gait);
        if self.stance == Some(stance)
            || !matches!(gait, GaitState::Starting | GaitState::Walking | GaitState::Stopping)
        {
            return;
        }
        self.stance = Some(stance);
        self.steps += 1;
        // Every second step: the torso sways from side to side, and the sway is no way made.
        if gait == GaitState::Walking && stance == RIGHT {
            self.strides.push((sim.time, [sim.position[0], sim.position[1]]));
        }
    }

    /// (time, distance) from the first to the last periodic step: the longest run of strides that are alike, each
    /// within 1 % of the duration and 3 % of the length of the one before.
    fn periodic(&self) -> (f64, f64) {
        let stride = |pair: &[(f64, [f64; 2])]| {
            let ((t0, a), (t1, b)) = (pair[0], pair[1]);
            (t1 - t0, (b[0] - a[0]).hypot(b[1] - a[1]))
        };
        let alike = |a: (f64, f64), b: (f64, f64)| {
            (a.0 - b.0).abs() <= 0.01 * a.0 && (a.1 - b.1).abs() <= 0.03 * a.1.max(0.1)
        };
        let (mut best, mut run, mut last) = ((0.0, 0.0), (0.0, 0.0), None);
        for now in self.strides.windows(2).map(stride) {
            run = match last {
                Some(before) if alike(before, now) => (run.0 + now.0, run.1 + now.1),
                _ => now,
            };
            if run.0 > best.0 {
                best = run;
            }
            last = Some(now);
        }
        best
    }

    /// The figures so far.
    pub fn figures(&self, scene: &config::Scene, cpu_s: f64, log: Option<String>) -> Figures {
        let (span, distance) = self.periodic();
        let n = self.cycles.max(1.0);
        Figures {
            scene: scene.name.clone(),
            robot: scene.robot.clone(),
            depth: format!("type {}, {:?} x {}", scene.depth, scene.integrator, scene.substeps),
            depth_reason: None,
            fell: self.fell,
            duration_s: self.time,
            distance_m: distance,
            mean_speed_m_s: if span > 0.0 { distance / span } else { 0.0 },
            steps: self.steps,
            inclination_error_max_rad: self.error_max,
            inclination_error_rms_rad: self.error_square.map(|s| (s / n).sqrt()),
            joint_tracking_error_max_rad: self.tracking,
            peak_normal_force_n: self.force,
            zmp_margin_min_m: self.margin.unwrap_or(f64::NAN),
            end_pose: self.end_pose,
            cpu_s,
            real_time_factor: if cpu_s > 0.0 { self.time / cpu_s } else { 0.0 },
            log,
        }
    }
}

/// The figures as lines for people.
pub fn table(f: &Figures) -> String {
    let milli = |x: [f64; 2]| format!("{:.1}, {:.1} mrad", 1e3 * x[0], 1e3 * x[1]);
    let rows = [
        ("scene", format!("{} ({}, {})", f.scene, f.robot, f.depth)),
        ("fell", if f.fell { "yes".into() } else { "no".into() }),
        ("duration", format!("{:.1} s, {} steps", f.duration_s, f.steps)),
        ("walking speed", format!("{:.3} m/s = {:.2} km/h", f.mean_speed_m_s, 3.6 * f.mean_speed_m_s)),
        ("inclination error, max", milli(f.inclination_error_max_rad)),
        ("inclination error, rms", milli(f.inclination_error_rms_rad)),
        ("joint tracking error, max", format!("{:.2e} rad", f.joint_tracking_error_max_rad)),
        ("normal force of a foot, max", format!("{:.0} N", f.peak_normal_force_n)),
        ("ZMP to edge of support, min", format!("{:.1} mm", 1e3 * f.zmp_margin_min_m)),
        (
            "end pose",
            format!("x {:.2} m, y {:.2} m, heading {:.2} rad", f.end_pose[0], f.end_pose[1], f.end_pose[2]),
        ),
        ("real-time factor", if f.cpu_s > 0.0 { format!("{:.0}", f.real_time_factor) } else { "-".into() }),
        ("log", f.log.clone().unwrap_or_else(|| "-".into())),
    ];
    rows.iter().map(|(name, value)| format!("{name:29}{value}")).collect::<Vec<_>>().join("\n")
}
