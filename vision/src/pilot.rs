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

/// \[m\] Radius of the disc that has to go through: shoulders with arms that swing, and what odometry, cells and swaying need; and of the
/// one for which ways are sought.
const CLEARANCE: f64 = 0.48;
const ROOMY: f64 = 0.6;
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
/// \[rad\] How far down it looks: the floor 2.2 m ahead in the middle of its picture; how far to the side before it turns there.
const DOWN: f64 = 0.65;
const ASIDE: f64 = 0.6;
/// \[m\] How far ahead of it a point lies to whose side it looks at the least, and how far away the point that is told: so far that
/// steps do not move it.
const AHEAD: f64 = 2.0;
const FAR: f64 = 100.0;
/// \[rad\] Change of the direction that is worth a command, and \[s\] after which it is told again: a datagram may have been lost.
const CHANGED: f64 = 0.07;
const AGAIN: f64 = 1.0;
/// \[rad\] Nearer to the camera's axis than this an arc begins that is walked: what is not seen is not free.
const VIEW: f64 = 0.6;
/// \[rad\] Least inclination of the camera with which it sees the floor before the robot.
const SEES_FLOOR: f64 = 0.5;

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

/// An arc that it could go.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// \[1/m\]
    curvature: f64,
    /// \[m\] Free for it, and on average of that and what is free for somebody wider.
    free: f64,
    roomy: f64,
}

/// The pilot.
#[derive(Clone, Debug)]
pub struct Pilot {
    speeds: Speeds,
    map: LocalMap,
    /// \[s\] When the robot was last on a cell of the floor.
    visits: BTreeMap<[i32; 2], f64>,
    course: Course,
    /// \[rad\] @I_0, \[s\] Direction that was told, and when.
    told: Option<(f64, f64)>,
}

impl Pilot {
    /// One that has seen nothing.
    pub fn new(speeds: Speeds) -> Self {
        let map = LocalMap::default();
        Self { speeds, map, visits: BTreeMap::new(), course: Course::Arc(0.0), told: None }
    }

    /// Answer to `trigger`, at which the cameras saw these points \[m\] @camera. None if it does not say where the robot is.
    pub fn answer(&mut self, trigger: &Trigger, points: &[[f64; 3]]) -> Option<Answer> {
        let time = trigger.stamp as f64 * 1e-9;
        let [torso, camera, right, left] = poses(&trigger.odometry, &trigger.frames)?;
        let [x, y] = without_sway(&torso, [&right, &left]);
        let points: Vec<[f64; 3]> = points.iter().map(|p| camera.place(*p)).collect();
        self.map.add(time, [camera.position[0], camera.position[1]], &points);
        self.visits.insert(visit([x, y]), time);
        // What stands around the robot, seen from it; and the arcs between, of which none is free that is not seen.
        let (sin, cos) = torso.heading().sin_cos();
        let taken = self.map.taken([x, y], LENGTH + ROOMY).map(|[px, py]| {
            let [dx, dy] = [px - x, py - y];
            [cos * dx + sin * dy, cos * dy - sin * dx]
        });
        let taken: Vec<[f64; 2]> = taken.collect();
        let place = |[dx, dy]: [f64; 2]| [x + cos * dx - sin * dy, y + sin * dx + cos * dy];
        let aside = wrapped(camera.heading() - torso.heading());
        let looks_down = camera.place([1.0, 0.0, 0.0])[2] - camera.position[2] < -SEES_FLOOR.sin();
        let is_seen = |k: f64| {
            let [ahead, left] = tentacles::place(k, 1.0);
            looks_down && wrapped(left.atan2(ahead) - aside).abs() < VIEW
        };
        let ways = tentacles::curvatures().map(|curvature| {
            let free =
                |width| if is_seen(curvature) { tentacles::free(curvature, width, &taken) } else { 0.0 };
            Way { curvature, free: free(CLEARANCE), roomy: 0.5 * (free(CLEARANCE) + free(ROOMY)) }
        });
        let velocity = self.choose(time, &ways, place);
        let look = self.look(time, torso.heading()).map(|heading| {
            let ahead = FAR * DOWN.cos();
            let [cx, cy, cz] = camera.position;
            FixateCommand {
                point: [cx + ahead * heading.cos(), cy + ahead * heading.sin(), cz - FAR * DOWN.sin()],
            }
        });
        Some(Answer { velocity, look })
    }

    /// Direction \[rad\] @I_0 to tell the head of a torso with this heading, if that is news.
    fn look(&mut self, time: f64, heading: f64) -> Option<f64> {
        let aside = match self.course {
            Course::Arc(k) => {
                let [ahead, left] = tentacles::place(k, AHEAD.min(FRAC_PI_2 / k.abs()));
                left.atan2(ahead)
            }
            Course::Turn(side, _) => side * ASIDE,
        };
        let told = heading + aside;
        let is_old =
            |(before, then): (f64, f64)| wrapped(told - before).abs() > CHANGED || time - then > AGAIN;
        let is_news = self.told.is_none_or(is_old);
        is_news.then(|| {
            self.told = Some((told, time));
            told
        })
    }

    /// The next course, and its velocity.
    fn choose(
        &mut self,
        time: f64,
        ways: &[Way; ARCS],
        place: impl Fn([f64; 2]) -> [f64; 2],
    ) -> VelocityCommand {
        let (last, least) = match self.course {
            Course::Arc(k) => (k, STOP + LEAST * BRAKE),
            Course::Turn(_, since) => (0.0, (START - CONTENT * (time - since)).max(STOP + LEAST * BRAKE)),
        };
        let cost = |way: &Way| {
            let longest = tentacles::free(way.curvature, CLEARANCE, &[]);
            // Floor along the way, each quarter of it.
            let known: f64 = (1..=4)
                .map(|i| tentacles::place(way.curvature, way.free * f64::from(i) / 4.0))
                .map(|at| self.known(time, place(at)))
                .sum();
            1.0 - way.roomy / longest + CHANGE * (way.curvature - last).abs() / SHARPEST + KNOWN * known / 4.0
        };
        let passable = ways.iter().filter(|way| way.free > least);
        let best = passable.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(&Way { curvature, free, .. }) = best else { return self.turn(time, ways) };
        self.course = Course::Arc(curvature);
        let forward = self.speeds.forward * ((free - STOP) / BRAKE).min(1.0);
        VelocityCommand { forward, left: 0.0, turn: curvature * forward }
    }

    /// On the spot: to the side on which more is free, and on to that side until a way is found.
    fn turn(&mut self, time: f64, ways: &[Way; ARCS]) -> VelocityCommand {
        let side = match self.course {
            Course::Turn(side, _) => side,
            Course::Arc(_) => ways.iter().map(|way| way.curvature.signum() * way.free).sum::<f64>().signum(),
        };
        if let Course::Arc(_) = self.course {
            self.course = Course::Turn(side, time);
        }
        VelocityCommand { forward: 0.0, left: 0.0, turn: side * self.speeds.turn }
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

/// \[m\] @I_0 Place of the torso along its heading, and of the middle between the soles across it: where it is without its sway.
fn without_sway(torso: &RecordedPose, soles: [&RecordedPose; 2]) -> [f64; 2] {
    let (sin, cos) = torso.heading().sin_cos();
    let [x, y] = [0, 1].map(|i| torso.position[i]);
    let [dx, dy] = [0, 1].map(|i| 0.5 * (soles[0].position[i] + soles[1].position[i]) - torso.position[i]);
    let left = cos * dy - sin * dx;
    [x - sin * left, y + cos * left]
}

/// Torso, camera, right and left sole @I_0, if the trigger knows them.
fn poses(odometry: &Odometry, frames: &Frames) -> Option<[RecordedPose; 4]> {
    let planning = odometry::frame(odometry.place);
    let [right, left] = &frames.soles;
    let poses = [&frames.torso, &frames.camera, right, left].map(|frame| planning.then(frame));
    let known = |pose: &RecordedPose| pose.position.iter().chain(&pose.orientation).all(|x| x.is_finite());
    poses.iter().all(known).then_some(poses)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gateway::Cause;

    const SPEEDS: Speeds = Speeds { forward: 0.3, turn: 0.2 };

    /// A trigger of a robot at the origin of I_0 that looks 0.6 rad down, `aside` \[rad\] to the left.
    fn trigger(number: u64, aside: f64) -> Trigger {
        let down =
            RecordedPose { position: [0.1, 0.0, 1.7], orientation: [0.0, 0.3_f64.sin(), 0.0, 0.3_f64.cos()] };
        let camera = odometry::frame([0.0, 0.0, 0.0, aside]).then(&down);
        let torso = RecordedPose::moved([0.0, 0.0, 1.0]);
        let place = [0.0; 4];
        Trigger {
            sender: 1,
            sequence: number,
            stamp: 100_000_000 * number,
            cycle: 100 * number,
            flags: 1,
            gait: 1,
            odometry: Odometry { place, place_error: 0.0, heading_error: 0.0, way: 0.0 },
            frames: Frames { camera, torso, soles: [RecordedPose::IDENTITY; 2] },
            accepted: 0,
            refused: [0; Cause::ALL.len()],
        }
    }

    /// Points of upright walls from one place on the floor to another \[m\] @I_0, as that trigger's camera sees them.
    fn walls(trigger: &Trigger, ends: &[[[f64; 2]; 2]]) -> Vec<[f64; 3]> {
        let points = ends.iter().flat_map(|[a, b]| {
            (0..400).map(move |k| {
                let share = f64::from(k / 4) / 100.0;
                let [x, y] = [0, 1].map(|i| a[i] + share * (b[i] - a[i]));
                RecordedPose::moved([x, y, 0.2 * f64::from(k % 4 + 1)])
            })
        });
        points.map(|p| p.seen_from(&trigger.frames.camera).position).collect()
    }

    fn velocity(ends: &[[[f64; 2]; 2]], aside: f64) -> VelocityCommand {
        let trigger = trigger(1, aside);
        Pilot::new(SPEEDS).answer(&trigger, &walls(&trigger, ends)).unwrap().velocity
    }

    #[test]
    fn walks_where_it_is_free_slower_before_walls_and_turns_at_them() {
        let free = velocity(&[], 0.0);
        assert_eq!((free.forward, free.turn), (0.3, 0.0));
        // Across the way, 1.2 m ahead, all around: 0.7 m are free.
        let around = |ahead: f64| {
            [[[ahead, -3.0], [ahead, 3.0]], [[-1.0, 0.7], [3.0, 0.7]], [[-1.0, -0.7], [3.0, -0.7]]]
        };
        let slow = velocity(&around(1.2), 0.0);
        assert!((0.05..0.2).contains(&slow.forward), "{slow:?}");
        let turns = velocity(&around(0.8), 0.0);
        assert!(turns.forward == 0.0 && turns.turn.abs() == 0.2, "{turns:?}");
    }

    #[test]
    fn goes_around_a_box_on_the_side_that_is_free() {
        for side in [-1.0, 1.0] {
            let past = velocity(&[[[1.2, 0.1 * side], [1.2, 0.6 * side]]], 0.0);
            assert!(past.forward > 0.1 && past.turn * side < 0.0, "{side}: {past:?}");
        }
    }

    #[test]
    fn does_not_walk_where_it_does_not_look() {
        assert_eq!(velocity(&[], 1.5).forward, 0.0);
        let mut up = trigger(1, 0.0);
        up.frames.camera.orientation = RecordedPose::IDENTITY.orientation;
        assert_eq!(Pilot::new(SPEEDS).answer(&up, &[]).unwrap().velocity.forward, 0.0);
    }

    /// Between walls 1.04 m apart, wherever the torso sways to.
    #[test]
    fn walks_through_a_gap_however_it_sways() {
        for heading in [0.0, 1.0, -2.5] {
            for sway in [-0.07, 0.0, 0.07] {
                let mut trigger = trigger(1, 0.0);
                let place = odometry::frame([0.0, 0.0, 0.0, heading]);
                let swayed = RecordedPose::moved([0.0, sway, 0.0]);
                let Frames { camera, torso, soles } = &mut trigger.frames;
                [*camera, *torso] = [&*camera, &*torso].map(|frame| place.then(&swayed.then(frame)));
                *soles = [-0.12, 0.12].map(|left| place.then(&RecordedPose::moved([0.0, left, 0.0])));
                let ends = [-0.52, 0.52].map(|y| [[0.3, y], [3.0, y]].map(|[x, y]| place.place([x, y, 0.0])));
                let ends = ends.map(|wall| wall.map(|[x, y, _]| [x, y]));
                let answer = Pilot::new(SPEEDS).answer(&trigger, &walls(&trigger, &ends)).unwrap();
                assert_eq!((answer.velocity.forward, answer.velocity.turn), (0.3, 0.0), "{heading} {sway}");
            }
        }
    }

    #[test]
    fn a_robot_that_does_not_know_where_it_is_gets_no_answer() {
        let mut lost = trigger(1, 0.0);
        lost.frames = Frames::UNKNOWN;
        assert_eq!(Pilot::new(SPEEDS).answer(&lost, &[]), None);
    }

    /// Of ten answers a second some get lost: the head is told until it looks there, at a height that may be told.
    #[test]
    fn a_direction_is_told_again() {
        let (mut pilot, mut told) = (Pilot::new(SPEEDS), Vec::new());
        for number in 1..=50 {
            told.extend(pilot.answer(&trigger(number, 0.0), &[]).unwrap().look);
        }
        assert!((4..=6).contains(&told.len()), "{} times in 5 s", told.len());
        assert!(told.iter().all(|look| (-100.0..0.0).contains(&look.point[2])), "{told:?}");
    }
}
