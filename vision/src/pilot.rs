//! Pilot (thesis 6.1): with each trigger, one velocity and one point to look at, from what the cameras saw at it.
//!
//! It walks along the best tentacle, slower the shorter that is, and turns on the spot where there is none. No map of the whole
//! and no goal: what draws it is floor on which it has not been for some minutes.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};

use gateway::trigger::{Frames, Odometry, Trigger};
use messages::command::{FixateCommand, VelocityCommand};
use recording::{RecordedPose, odometry};

use crate::local_map::LocalMap;
use crate::tentacles::{self, ARCS, LENGTH, SHARPEST};

/// \[m\] Radius of the disc that has to go through: half of the shoulders with arms, and what odometry, cells and swaying need.
const CLEARANCE: f64 = 0.48;
/// \[m\] Free way below which nobody walks, that which full speed takes beyond it, and the least one after a turn on the spot.
const STOP: f64 = 0.3;
const BRAKE: f64 = 0.9;
const START: f64 = 0.8;
/// \[1\] Least share of the speed that is worth a step.
const LEAST: f64 = 0.15;
/// \[m/s\] How fast a turn on the spot gives up what it wants to find: where nothing is free any more, less has to do.
const CONTENT: f64 = 0.02;
/// \[1\] Costs of a change from the sharpest arc to a straight one, and of floor where the robot was just now.
const CHANGE: f64 = 0.25;
const KNOWN: f64 = 0.8;
/// \[s\] In which a visit is forgotten to a third, and \[m\] the cells of floor that are visited.
const FORGOTTEN: f64 = 150.0;
const VISIT: f64 = 0.5;
/// \[m\] How far ahead the robot looks at the floor; \[m\] a change of that point that is worth a command; \[rad\] how far to the side
/// it looks before it turns there.
const AHEAD: f64 = 2.2;
const MOVED: f64 = 0.15;
const ASIDE: f64 = 0.6;
/// \[rad\] Nearer to the camera's axis than this an arc begins that is walked: what is not seen is not free.
const VIEW: f64 = 0.6;
/// \[1\] Share of what the camera looks beside a point that is made good for with each trigger, and \[m\] the most of it.
const LEARNED: f64 = 0.1;
const MOST_BESIDE: f64 = 20.0;

/// Limits of the velocities.
#[derive(Clone, Copy, Debug)]
pub struct Speeds {
    /// \[m/s\] Ahead, with a free way.
    pub forward: f64,
    /// \[rad/s\] On the spot.
    pub turn: f64,
}

/// Answer to a trigger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Where to go.
    pub velocity: VelocityCommand,
    /// Where to look, if that is news.
    pub look: Option<FixateCommand>,
}

/// Way that the pilot goes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Course {
    /// Along an arc of this curvature \[1/m\].
    Arc(f64),
    /// On the spot, to the left (1) or right (-1), since this time \[s\].
    Turn(f64, f64),
}

/// The pilot.
#[derive(Clone, Debug)]
pub struct Pilot {
    speeds: Speeds,
    map: LocalMap,
    /// \[s\] When the robot was last on a cell of the floor.
    visits: BTreeMap<[i32; 2], f64>,
    course: Course,
    /// \[m\] @I_0 Point that is to be looked at, and the one that was told.
    wanted: Option<[f64; 2]>,
    told: Option<[f64; 2]>,
    /// \[m\] @I_0 From the one to the other. The head reckons where it is by gyroscopes, triggers by footholds: after some minutes
    /// they are metres apart.
    beside: [f64; 2],
}

impl Pilot {
    /// One that has seen nothing.
    pub fn new(speeds: Speeds) -> Self {
        let map = LocalMap::default();
        Self {
            speeds,
            map,
            visits: BTreeMap::new(),
            course: Course::Arc(0.0),
            wanted: None,
            told: None,
            beside: [0.0; 2],
        }
    }

    /// Answer to `trigger`, at which the cameras saw these points \[m\] @camera. None if it does not say where the robot is.
    pub fn answer(&mut self, trigger: &Trigger, points: &[[f64; 3]]) -> Option<Answer> {
        let time = trigger.stamp as f64 * 1e-9;
        let (torso, camera) = poses(&trigger.odometry, &trigger.frames)?;
        let [x, y, _] = torso.position;
        let points: Vec<[f64; 3]> = points.iter().map(|p| camera.place(*p)).collect();
        self.map.add(time, [camera.position[0], camera.position[1]], &points);
        self.visits.insert(visit([x, y]), time);
        // What stands around the robot, seen from it.
        let (sin, cos) = torso.heading().sin_cos();
        let taken = self.map.taken([x, y], LENGTH + CLEARANCE).map(|[px, py]| {
            let [dx, dy] = [px - x, py - y];
            [cos * dx + sin * dy, cos * dy - sin * dx]
        });
        let taken: Vec<[f64; 2]> = taken.collect();
        let place = |[dx, dy]: [f64; 2]| [x + cos * dx - sin * dy, y + sin * dx + cos * dy];
        let aside = camera.heading() - torso.heading();
        let is_seen = |k: f64| {
            let [ahead, left] = tentacles::place(k, 1.0);
            wrapped(left.atan2(ahead) - aside).abs() < VIEW
        };
        let arcs = tentacles::curvatures()
            .map(|k| (k, if is_seen(k) { tentacles::free(k, CLEARANCE, &taken) } else { 0.0 }));
        let velocity = self.choose(time, &arcs, place);
        self.learn(&camera);
        let wanted = place(match self.course {
            Course::Arc(k) => tentacles::place(k, AHEAD.min(FRAC_PI_2 / k.abs())),
            Course::Turn(side, _) => [AHEAD * ASIDE.cos(), side * AHEAD * ASIDE.sin()],
        });
        self.wanted = Some(wanted);
        let look = [wanted[0] + self.beside[0], wanted[1] + self.beside[1]];
        let moved = self.told.is_none_or(|at| (at[0] - look[0]).hypot(at[1] - look[1]) > MOVED);
        self.told = if moved { Some(look) } else { self.told };
        let look = moved.then_some(FixateCommand { point: [look[0], look[1], 0.0] });
        Some(Answer { velocity, look })
    }

    /// Learns from where the camera's axis meets the floor how far beside the wanted point it is.
    fn learn(&mut self, camera: &RecordedPose) {
        let [x, y, z] = camera.position;
        let end = camera.place([1.0, 0.0, 0.0]);
        let (Some(wanted), true) = (self.wanted, end[2] < z) else { return };
        let way = z / (z - end[2]);
        let met = [x + way * (end[0] - x), y + way * (end[1] - y)];
        for i in 0..2 {
            let missed = (wanted[i] - met[i]).clamp(-AHEAD, AHEAD);
            self.beside[i] = (self.beside[i] + LEARNED * missed).clamp(-MOST_BESIDE, MOST_BESIDE);
        }
    }

    /// The next course, and its velocity.
    fn choose(
        &mut self,
        time: f64,
        arcs: &[(f64, f64); ARCS],
        place: impl Fn([f64; 2]) -> [f64; 2],
    ) -> VelocityCommand {
        let (last, least) = match self.course {
            Course::Arc(k) => (k, STOP + LEAST * BRAKE),
            Course::Turn(_, since) => (0.0, (START - CONTENT * (time - since)).max(STOP + LEAST * BRAKE)),
        };
        let cost = |&(k, free): &(f64, f64)| {
            let longest = tentacles::free(k, CLEARANCE, &[]);
            // Floor along the way, each half metre of it.
            let known: f64 = (1..=4)
                .map(|i| self.known(time, place(tentacles::place(k, free * f64::from(i) / 4.0))))
                .sum();
            1.0 - free / longest + CHANGE * (k - last).abs() / SHARPEST + KNOWN * known / 4.0
        };
        let passable = arcs.iter().filter(|(_, free)| *free > least);
        let best = passable.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(&(curvature, free)) = best else {
            // To the side on which more is free, and on to that side until a way is found.
            if let Course::Arc(_) = self.course {
                let sum = |left: bool| {
                    arcs.iter().filter(|(k, _)| (*k > 0.0) == left).map(|(_, free)| free).sum::<f64>()
                };
                self.course = Course::Turn(if sum(true) >= sum(false) { 1.0 } else { -1.0 }, time);
            }
            let Course::Turn(side, _) = self.course else { unreachable!("set above") };
            return VelocityCommand { forward: 0.0, left: 0.0, turn: side * self.speeds.turn };
        };
        self.course = Course::Arc(curvature);
        let forward = self.speeds.forward * ((free - STOP) / BRAKE).min(1.0);
        VelocityCommand { forward, left: 0.0, turn: curvature * forward }
    }

    /// \[1\] How well a place of the floor is known: 1 where the robot was just now, 0 where it never was.
    fn known(&self, time: f64, at: [f64; 2]) -> f64 {
        self.visits.get(&visit(at)).map_or(0.0, |then| ((then - time) / FORGOTTEN).exp())
    }
}

fn visit(at: [f64; 2]) -> [i32; 2] {
    at.map(|x| (x / VISIT).floor() as i32)
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Torso and camera @I_0, if the trigger knows them.
fn poses(odometry: &Odometry, frames: &Frames) -> Option<(RecordedPose, RecordedPose)> {
    let planning = odometry::frame(odometry.place);
    let [torso, camera] = [&frames.torso, &frames.camera].map(|frame| planning.then(frame));
    let known = |pose: &RecordedPose| pose.position.iter().chain(&pose.orientation).all(|x| x.is_finite());
    (known(&torso) && known(&camera)).then_some((torso, camera))
}
