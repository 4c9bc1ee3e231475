//! `/markers`: ground, planned steps, centre of gravity, zero-moment point, support polygon.

use messages::record::Visit;
use messages::{ControllerState, Sensors, SimState};

use crate::cdr::CdrEncoder;
use crate::links::RecordedPose;
use crate::odometry::{Planned, planning_frame};
use crate::polygon::{Point, contact_height, convex_hull, sole_corners, support_polygon, zero_moment_point};
use crate::robot::RobotInfo;
use crate::standard::{ODOM, TRUTH, WORLD, header};

/// \[N\] A foot that carries less does not count for the support polygon that is drawn.
const LOADED: f64 = 10.0;
/// \[m\] Length and width of the ground that is drawn.
const GROUND: f64 = 20.0;

const BLUE: [f32; 4] = [0.0, 0.45, 0.70, 1.0];
const VERMILION: [f32; 4] = [0.84, 0.37, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 0.62, 0.45, 1.0];
const PURPLE: [f32; 4] = [0.80, 0.47, 0.65, 1.0];
const GREY: [f32; 4] = [0.6, 0.6, 0.6, 0.4];

/// Numbers of `visualization_msgs/Marker`.
#[derive(Clone, Copy)]
enum MarkerShape {
    Cube = 1,
    Sphere = 2,
    LineStrip = 4,
    LineList = 5,
}

struct Marker {
    frame: &'static str,
    name: String,
    shape: MarkerShape,
    at: [f64; 3],
    size: [f64; 3],
    color: [f32; 4],
    points: Vec<[f64; 3]>,
}

impl Marker {
    fn sphere(frame: &'static str, name: String, at: [f64; 3], size: f64, color: [f32; 4]) -> Self {
        Self { frame, name, shape: MarkerShape::Sphere, at, size: [size; 3], color, points: Vec::new() }
    }

    fn lines(
        frame: &'static str,
        name: String,
        shape: MarkerShape,
        color: [f32; 4],
        points: Vec<[f64; 3]>,
    ) -> Self {
        Self { frame, name, shape, at: [0.0; 3], size: [0.005; 3], color, points }
    }

    /// Nothing to be seen of it at present.
    fn is_gone(&self) -> bool {
        let lines = matches!(self.shape, MarkerShape::LineStrip | MarkerShape::LineList);
        lines && self.points.is_empty() || self.at.iter().any(|x| !x.is_finite())
    }

    fn encode(&self, e: &mut CdrEncoder, stamp_ns: u64) {
        header(e, stamp_ns, self.frame);
        e.string(&self.name);
        // Id, shape, action: 0 shows, 2 takes away.
        for number in [0, self.shape as i32, 2 * i32::from(self.is_gone())] {
            e.i32(number);
        }
        e.f64s(&self.at.map(|x| if x.is_finite() { x } else { 0.0 }));
        e.f64s(&RecordedPose::IDENTITY.orientation);
        e.f64s(&self.size);
        self.color.into_iter().for_each(|c| e.f32(c));
        e.stamp(0); // lifetime: for ever
        e.u8(0); // frame_locked
        e.count(self.points.len());
        self.points.iter().for_each(|point| e.f64s(point));
        e.count(0); // colors
        e.string(""); // texture_resource
        header(e, 0, ""); // texture
        e.string("");
        e.count(0);
        e.count(0); // uv_coordinates
        e.string(""); // text
        e.string(""); // mesh_resource
        e.string(""); // mesh_file
        e.count(0);
        e.u8(0); // mesh_use_embedded_materials
    }
}

fn encode(e: &mut CdrEncoder, stamp_ns: u64, markers: &[Marker]) {
    e.begin().count(markers.len());
    markers.iter().for_each(|marker| marker.encode(e, stamp_ns));
}

/// `visualization_msgs/MarkerArray`: what the robot believes.
pub(crate) fn believed(
    e: &mut CdrEncoder,
    stamp_ns: u64,
    robot: &RobotInfo,
    (sensors, state): (&Sensors, &ControllerState),
    plan: &Planned,
) {
    let frame = planning_frame(state, plan.height);
    let on_ground = |[x, y]: Point| frame.place([x, y, 0.0]);
    let loaded = (0..2).filter(|&i| sensors.foot_wrench[i].force[2] > LOADED);
    let corners: Vec<Point> =
        loaded.flat_map(|i| sole_corners(&state.feet[i], &robot.feet[i].support)).collect();
    // A step's sole is where it lands; lines are given by their ends.
    let outline = |step: &messages::plan::Step| {
        let swing = 1 - (step.stance as usize).min(1);
        let [x, y, heading] = step.landing;
        let corners = sole_corners(&[x, y, 0.0, heading], &robot.feet[swing].support).map(on_ground);
        (0..4).flat_map(|i| [corners[i], corners[(i + 1) % 4]]).collect::<Vec<_>>()
    };
    let steps = plan.steps.iter().flat_map(outline).collect();
    let ground = Marker {
        frame: WORLD,
        name: "ground".into(),
        shape: MarkerShape::Cube,
        at: [0.0, 0.0, -0.005],
        size: [GROUND, GROUND, 0.01],
        color: GREY,
        points: Vec::new(),
    };
    let polygon = closed(&convex_hull(&corners)).into_iter().map(on_ground).collect();
    let markers = [
        ground,
        Marker::lines(ODOM, "planned_steps".into(), MarkerShape::LineList, PURPLE, steps),
        Marker::sphere(ODOM, "centre_of_gravity".into(), frame.place(state.com), 0.05, BLUE),
        Marker::sphere(ODOM, "zero_moment_point".into(), on_ground(state.zmp), 0.03, VERMILION),
        Marker::lines(ODOM, "support_polygon".into(), MarkerShape::LineStrip, GREEN, polygon),
    ];
    encode(e, stamp_ns, &markers);
}

/// The same of the simulated robot, under names of their own.
pub(crate) fn truth(e: &mut CdrEncoder, stamp_ns: u64, state: &SimState) {
    let name = |name: &str| format!("{TRUTH}{name}");
    let z = contact_height(state).unwrap_or(0.0);
    let at = zero_moment_point(state).map_or([f64::NAN; 3], |[x, y]| [x, y, z]);
    let polygon = closed(&support_polygon(state)).into_iter().map(|[x, y]| [x, y, z]).collect();
    let markers = [
        Marker::sphere(WORLD, name("centre_of_gravity"), state.com, 0.05, BLUE),
        Marker::sphere(WORLD, name("zero_moment_point"), at, 0.03, VERMILION),
        Marker::lines(WORLD, name("support_polygon"), MarkerShape::LineStrip, GREEN, polygon),
    ];
    encode(e, stamp_ns, &markers);
}

/// The same points, and the first one again.
fn closed(points: &[Point]) -> Vec<Point> {
    points.iter().chain(points.first()).copied().collect()
}
