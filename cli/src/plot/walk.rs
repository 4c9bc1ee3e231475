//! A log, loaded for drawing.

use drawing::Point;
use messages::topics::{CONTROLLER_STATE, SENSORS};
use messages::{ControllerState, Joints, MAX_JOINTS, Sensors};
use recording::polygon::{convex_hull, sole_corners};
use recording::{FrameTree, Log, LogEnd, RobotInfo};
use std::collections::HashMap;
use std::path::Path;

/// \[N\] A foot that carries less does not count as loaded.
const LOADED: f64 = 30.0;
/// \[s\] A footprint is where a foot stood at least this long.
const FOOTHOLD: f64 = 0.15;

/// Inputs of the figures.
pub(super) struct WalkData {
    /// Robot, scene, duration: the line under every title.
    pub(super) about: String,
    pub(super) robot: RobotInfo,
    /// One entry per cycle.
    pub(super) cycles: Vec<CycleData>,
    /// Frames of the simulated robot, thinned; empty if the log has none.
    pub(super) frames: Vec<FrameTree>,
    /// Stamp of time zero \[ns\].
    pub(super) start_ns: u64,
}

/// One cycle of the stabilizer. Positions are in the frame of the first plan.
pub(super) struct CycleData {
    /// \[s\] Time since the beginning of the log.
    pub(super) time: f64,
    pub(super) state: ControllerState,
    /// \[N\] Measured vertical forces: right, left; NaN if the sensor record is missing.
    pub(super) force_z: [f64; 2],
    /// \[rad\] Measured joint angles; NaN if the sensor record is missing.
    pub(super) angle: Joints,
}

/// Place where a foot stood.
pub(super) struct Footprint {
    /// 0 right, 1 left.
    pub(super) foot: usize,
    pub(super) corners: [Point; 4],
}

impl WalkData {
    pub(super) fn load(path: &Path) -> Result<Self, String> {
        let log = Log::open(path).map_err(|e| e.to_string())?;
        let mut sensed = HashMap::new();
        let end = log
            .each_record(&SENSORS, |s: &Sensors| {
                sensed.insert(s.header.tick, (s.foot_wrench.map(|w| w.force[2]), s.joint_angle));
            })
            .map_err(|e| e.to_string())?;
        let states = log.records::<ControllerState>(&CONTROLLER_STATE).map_err(|e| e.to_string())?;
        let first =
            states.first().ok_or_else(|| format!("{}: no record of controller_state", path.display()))?;
        let start_ns = first.header.stamp_ns;
        // Before the first plan nothing is desired and nothing has a frame.
        let cycles: Vec<CycleData> = states
            .into_iter()
            .filter(|state| state.plan_id > 0)
            .map(|state| {
                let sensed = sensed.get(&state.header.tick).copied();
                let (force_z, angle) = sensed.unwrap_or(([f64::NAN; 2], [f64::NAN; MAX_JOINTS]));
                CycleData { time: seconds(state.header.stamp_ns, start_ns), force_z, angle, state }
            })
            .collect();
        let duration =
            cycles.last().ok_or_else(|| format!("{}: no plan was ever active", path.display()))?.time;
        let cut = if end == LogEnd::Complete { "" } else { "  ·  log was cut off" };
        let (robot, run) = (log.robot().clone(), log.run());
        let about = format!(
            "{}  ·  {}  ·  {duration:.1} s  ·  software {}{cut}",
            robot.name, run.scene, run.software
        );
        let frames = log.frames().map_err(|e| e.to_string())?;
        Ok(Self { about, robot, cycles, frames, start_ns })
    }

    /// Time of every cycle against a value of it.
    pub(super) fn over_time(&self, value: impl Fn(&CycleData) -> f64) -> Vec<Point> {
        self.cycles.iter().map(|c| [c.time, value(c)]).collect()
    }

    /// Positions of every cycle.
    pub(super) fn path(&self, position: impl Fn(&CycleData) -> Point) -> Vec<Point> {
        self.cycles.iter().map(position).collect()
    }

    /// Every place where a foot stood, in the order of time.
    pub(super) fn footprints(&self) -> Vec<Footprint> {
        let mut prints = Vec::new();
        for foot in 0..2 {
            for stance in self.cycles.chunk_by(|a, b| a.loaded(foot) == b.loaded(foot)) {
                let (first, middle, last) =
                    (&stance[0], &stance[stance.len() / 2], &stance[stance.len() - 1]);
                if first.loaded(foot) && last.time - first.time >= FOOTHOLD {
                    prints.push((first.time, Footprint { foot, corners: middle.corners(&self.robot, foot) }));
                }
            }
        }
        prints.sort_by(|a, b| a.0.total_cmp(&b.0));
        prints.into_iter().map(|(_, print)| print).collect()
    }
}

impl CycleData {
    /// A point of the planning frame of the active plan in the frame of the first plan.
    pub(super) fn place(&self, [x, y]: Point) -> Point {
        let [ox, oy, heading] = self.state.origin;
        let (sin, cos) = heading.sin_cos();
        [ox + cos * x - sin * y, oy + sin * x + cos * y]
    }

    pub(super) fn loaded(&self, foot: usize) -> bool {
        self.force_z[foot] > LOADED
    }

    /// Corners of the measured sole.
    fn corners(&self, robot: &RobotInfo, foot: usize) -> [Point; 4] {
        sole_corners(&self.state.feet[foot], &robot.feet[foot].support).map(|p| self.place(p))
    }

    /// Support polygon of the loaded feet; empty in flight.
    pub(super) fn support(&self, robot: &RobotInfo) -> Vec<Point> {
        let feet = (0..2).filter(|&foot| self.loaded(foot));
        convex_hull(&feet.flat_map(|foot| self.corners(robot, foot)).collect::<Vec<_>>())
    }
}

pub(super) fn seconds(stamp_ns: u64, start_ns: u64) -> f64 {
    (stamp_ns as f64 - start_ns as f64) * 1e-9
}
