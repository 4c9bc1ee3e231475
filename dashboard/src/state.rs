//! The state frame: which numbers it holds, and where each comes from, in one table.

use environment::{Pose, Schedule};
use messages::{ControllerState, Power, Sensors, SimState};
use nalgebra::UnitQuaternion;
use recording::RecordedPose;

use crate::estimate::{Estimate, PATH_POINTS, STEPS};

/// The newest records at one instant; none: not written yet, or by nobody.
pub struct Moment<'a> {
    /// \[s\] Bus cycle.
    pub cycle: f64,
    /// \[N\] Weight of the robot.
    pub weight: f64,
    /// Measured.
    pub sensors: &'a Sensors,
    /// Of the stabilizer.
    pub controller: Option<&'a ControllerState>,
    /// Estimate that follows from both.
    pub estimate: Option<&'a Estimate>,
    /// Motor supply.
    pub power: Option<&'a Power>,
    /// Truth about a simulated robot.
    pub sim: Option<&'a SimState>,
    /// \[m\] @world Point at which pushes act.
    pub pushed_at: Option<[f64; 3]>,
    /// When and where objects are.
    pub objects: &'a [Schedule],
}

/// Count of an entry's numbers.
#[derive(Clone, Copy, Debug)]
enum Count {
    These(usize),
    /// One per joint of the robot.
    Joints,
    /// So many per object of the scene.
    Objects(usize),
}
use Count::{Joints, Objects, These};

/// Name, count, unit, and where the i-th number comes from.
type Entry = (&'static str, Count, &'static str, fn(&Moment<'_>, usize) -> Option<f64>);

#[rustfmt::skip]
const ENTRIES: &[Entry] = &[
    ("time", These(1), "s", |m, _| Some(m.sensors.header.tick as f64 * m.cycle)),
    ("torso", These(7), "m, 1", |m, i| Some(pose(&m.estimate?.torso?, i))),
    ("torso_truth", These(7), "m, 1", |m, i| Some(pose(&truth(m.sim?), i))),
    ("joint_angle", Joints, "rad", |m, i| Some(m.sensors.joint_angle[i])),
    ("joint_truth", Joints, "rad", |m, i| Some(m.sim?.joint_angle[i])),
    ("wrench", These(12), "N, N m", |m, i| { let w = &m.sensors.foot_wrench[i / 6]; Some(if i % 6 < 3 { w.force[i % 6] } else { w.moment[i % 6 - 3] }) }),
    ("load", These(2), "1", |m, i| Some(m.estimate?.force[i][2] / m.weight)),
    ("force", These(6), "N", |m, i| Some(m.estimate?.force[i / 3][i % 3])),
    ("zmp", These(3), "m", |m, i| Some(m.estimate?.on_ground(m.controller?.zmp)[i])),
    ("zmp_planned", These(3), "m", |m, i| Some(m.estimate?.on_ground(m.controller?.zmp_desired)[i])),
    ("capture_point", These(3), "m", |m, i| Some(m.estimate?.on_ground(m.controller?.dcm)[i])),
    ("com", These(3), "m", |m, i| Some(m.estimate?.place(m.controller?.com)[i])),
    ("com_planned", These(3), "m", |m, i| Some(m.estimate?.place(m.controller?.com_desired)[i])),
    ("com_truth", These(3), "m", |m, i| Some(m.sim?.com[i])),
    ("com_velocity", These(3), "m/s", |m, i| Some(m.estimate?.turn(m.controller?.com_velocity)[i])),
    ("soles", These(8), "m, rad", |m, i| Some(sole(m.estimate?, &m.controller?.feet[i / 4], i % 4))),
    ("soles_planned", These(8), "m, rad", |m, i| Some(sole(m.estimate?, &m.controller?.feet_desired[i / 4], i % 4))),
    ("steps", These(5 * STEPS), "1, m, rad", |m, i| Some(m.estimate?.steps[i / 5][i % 5])),
    ("com_path", These(3 * PATH_POINTS), "m", |m, i| Some(m.estimate?.path[i / 3][i % 3])),
    ("push", These(6), "N, m", |m, i| if i < 3 { Some(m.sim?.push[i]) } else { Some(m.pushed_at?[i - 3]) }),
    ("rope", These(1), "N", |m, _| Some(m.sim?.rope)),
    ("objects", Objects(8), "1, m, 1", |m, i| object(m, i / 8, i % 8)),
    ("supply", These(1), "", |m, _| Some(m.power?.on as f64)),
    ("power_off_reason", These(1), "", |m, _| Some(m.power?.reason as f64)),
    ("start_up", These(1), "", |m, _| Some(m.sensors.start_up as f64)),
    ("gait", These(1), "", |m, _| Some(m.controller?.gait as f64)),
    ("not_standing", These(1), "", |m, _| Some(m.controller?.not_standing as f64)),
    ("fallen", These(1), "", |m, _| Some(m.sim?.fallen as f64)),
    ("phase", These(2), "", |m, i| Some(m.controller?.phase[i] as f64)),
    ("contact", These(2), "", |m, i| Some(m.controller?.contact[i] as f64)),
    ("temperature", Joints, "deg C", |m, i| Some(m.sensors.temperature[i])),
    ("tracking_error", Joints, "rad", |m, i| Some(m.controller?.tracking_error[i])),
    ("drive_error", Joints, "", |m, i| Some(m.sensors.drive_error[i].into())),
];

/// An entry of a robot's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayoutEntry {
    /// Name.
    pub name: &'static str,
    /// Numbers.
    pub count: usize,
    /// Unit.
    pub unit: &'static str,
}

/// Entries of the frame of a robot with so many joints in a scene with so many objects.
pub fn layout(joints: usize, objects: usize) -> Vec<LayoutEntry> {
    let entry = |&(name, count, unit, _): &Entry| {
        let count = match count {
            These(n) => n,
            Joints => joints,
            Objects(each) => each * objects,
        };
        LayoutEntry { name, count, unit }
    };
    ENTRIES.iter().map(entry).collect()
}

/// The content of a frame, f32 by f32.
pub fn frame(moment: &Moment<'_>, layout: &[LayoutEntry]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(2048);
    for ((.., get), entry) in ENTRIES.iter().zip(layout) {
        for i in 0..entry.count {
            bytes.extend((get(moment, i).unwrap_or(f64::NAN) as f32).to_le_bytes());
        }
    }
    bytes
}

/// The i-th number of position and quaternion w x y z.
fn pose(pose: &RecordedPose, i: usize) -> f64 {
    let [x, y, z, w] = pose.orientation;
    if i < 3 { pose.position[i] } else { [w, x, y, z][i - 3] }
}

/// world_from_torso of the simulated robot.
pub fn truth(sim: &SimState) -> RecordedPose {
    RecordedPose { position: sim.position, orientation: sim.orientation }
}

/// A number of a sole frame of the planning frame, in the world.
fn sole(estimate: &Estimate, &[x, y, z, heading]: &[f64; 4], i: usize) -> f64 {
    if i < 3 { estimate.place([x, y, z])[i] } else { heading + estimate.planning.heading() }
}

/// Presence and pose of an object at the time of the simulation.
fn object(moment: &Moment<'_>, object: usize, i: usize) -> Option<f64> {
    let (schedule, sim) = (&moment.objects[object], moment.sim?);
    let moving = moment.objects[..object].iter().filter(|s| s.changes()).count();
    let late = if schedule.changes() { *sim.object_delay.get(moving)? } else { 0.0 };
    let time = sim.time - late;
    let Pose { position, rotation } = schedule.pose(time);
    let [x, y, z, w] = <[f64; 4]>::from(UnitQuaternion::into_inner(rotation).coords);
    Some(match i {
        0 => f64::from(u8::from(schedule.is_present(time))),
        1..=3 => position[i - 1],
        _ => [w, x, y, z][i - 4],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame is as long as its layout, and each number is where the layout says.
    #[test]
    fn numbers_are_where_the_layout_says() {
        let mut sensors = Sensors::default();
        (sensors.header.tick, sensors.start_up) = (2500, 6);
        sensors.joint_angle = std::array::from_fn(|j| j as f64);
        sensors.foot_wrench[1].moment[2] = 17.0;
        let mut sim = SimState { time: 2.0, fallen: 1, ..SimState::default() };
        (sim.position, sim.orientation) = ([1.0, 2.0, 3.0], [0.1, 0.2, 0.3, 0.9]);
        let there = Pose::new([4.0, 5.0, 6.0], [0.0; 3]);
        let gone = || Schedule::new(0.0, 1.0, there, &[]);
        let objects = [Schedule::fixed(Pose::identity()), gone(), gone()];
        sim.object_delay[1] = 1.5;
        let layout = layout(24, objects.len());
        let moment = Moment {
            cycle: 0.001,
            weight: 600.0,
            sensors: &sensors,
            controller: None,
            estimate: None,
            power: None,
            sim: Some(&sim),
            pushed_at: None,
            objects: &objects,
        };
        // Length, then numbers by the names of the layout.
        let bytes = frame(&moment, &layout);
        assert_eq!(bytes.len(), 4 * layout.iter().map(|e| e.count).sum::<usize>());
        let numbers: Vec<f32> =
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        let at = |name: &str| {
            let before = layout.iter().take_while(|e| e.name != name);
            let start: usize = before.map(|e| e.count).sum();
            &numbers[start..start + layout.iter().find(|e| e.name == name).unwrap().count]
        };
        assert_eq!(at("time"), [2.5]);
        assert_eq!(at("torso_truth"), [1.0, 2.0, 3.0, 0.9, 0.1, 0.2, 0.3]);
        assert_eq!((at("joint_angle")[23], at("wrench")[11], at("start_up")[0]), (23.0, 17.0, 6.0));
        assert_eq!(at("objects")[..8], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!(at("objects")[8..12], [0.0, 4.0, 5.0, 6.0]);
        assert_eq!(at("objects")[16], 1.0, "later than planned, so still there");
        assert!(at("torso").iter().chain(at("zmp")).chain(at("supply")).all(|x| x.is_nan()));
    }

    /// The table of the protocol's page is this one.
    #[test]
    fn the_document_has_every_entry_in_this_order() {
        let page = include_str!("../../docs/dashboard.md");
        let table = page.split("**Kind 1").nth(1).unwrap().split("**Kind 2").next().unwrap();
        let rows = table.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| name"));
        let named: Vec<&str> =
            rows.flat_map(|row| row.split('|').nth(1).unwrap().split(',').map(str::trim)).collect();
        let entries: Vec<&str> = ENTRIES.iter().map(|e| e.0).collect();
        assert_eq!(named, entries);
    }
}
