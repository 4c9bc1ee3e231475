//! A solid at a place.

use nalgebra::{Matrix3, Vector3};

use crate::bounds::Bounds;
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::schedule::Schedule;
use crate::triangle::Nearest;

/// A solid with its pose, its friction and what is planned for it.
#[derive(Clone, Debug)]
pub struct Object {
    pub(crate) name: String,
    pub(crate) mesh: Mesh,
    pub(crate) friction: Option<f64>,
    pub(crate) schedule: Schedule,
    pub(crate) present: bool,
    /// \[s\] How far its schedule has come.
    pub(crate) clock: f64,
    /// Its next change is waiting.
    pub(crate) refused: bool,
    /// \[m\] Nearer to a robot it does not move, unless that takes it away from it.
    clearance: f64,
    /// \[m\] @world Height of the ground it lies on.
    ground: f64,
    pose: Pose,
    /// world_from_mesh
    rotation: Matrix3<f64>,
    /// @world around the mesh at its pose.
    bounds: Bounds,
    /// Triangles that lie in or below the ground: no surface of ground and object together.
    buried: Vec<bool>,
    any_buried: bool,
    /// Triangles one can stand on.
    floor: Vec<bool>,
}

/// \[m\] A face this little above the ground lies on it.
const FLUSH: f64 = 1e-6;
/// \[1\] Least upward part of the normal of a face one can stand on: 45 degrees.
const STANDABLE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// \[1\] How many times as deep as the nearest face a face one can stand on may be and still be the one a point came
/// through.
const FLOOR_FAVOUR: f64 = 4.0;

impl Object {
    /// The solid `mesh` for the whole of a run or as `schedule` says; `friction` \[1\] if not that of the robot's soles.
    pub fn new(name: impl Into<String>, mesh: Mesh, friction: Option<f64>, schedule: Schedule) -> Self {
        let pose = schedule.pose(0.0);
        let mut object = Self {
            name: name.into(),
            present: schedule.is_present(0.0),
            clock: 0.0,
            refused: false,
            clearance: 0.0,
            buried: vec![false; mesh.len()],
            floor: vec![false; mesh.len()],
            any_buried: false,
            bounds: Bounds::NOTHING,
            rotation: Matrix3::identity(),
            mesh,
            friction,
            schedule,
            ground: 0.0,
            pose,
        };
        object.place(pose);
        object
    }

    /// The same, but it waits rather than come nearer than `clearance` \[m\] to a robot, as people do.
    pub fn keeping_clear(mut self, clearance: f64) -> Self {
        self.clearance = clearance;
        self
    }

    /// It is not always there, or not always at the same place.
    pub fn moves(&self) -> bool {
        self.schedule.changes()
    }

    /// Name in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The surface, in its own frame.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Its pose.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Is it there now?
    pub fn is_present(&self) -> bool {
        self.present
    }

    /// \[m\] @world The box around it.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// From now on the ground is at `height` \[m\] @world.
    pub(crate) fn lie_on(&mut self, height: f64) {
        self.ground = height;
        self.place(self.pose);
    }

    pub(crate) fn place(&mut self, pose: Pose) {
        self.pose = pose;
        self.rotation = pose.rotation.to_rotation_matrix().into_inner();
        let (rotation, position) = (self.rotation, pose.position);
        let world = |v: Vector3<f64>| rotation * v + position;
        self.bounds = Bounds::of(self.mesh.triangles().iter().flat_map(|t| t.corners.map(world)));
        self.any_buried = false;
        for (i, t) in self.mesh.triangles().iter().enumerate() {
            self.buried[i] = t.corners.iter().all(|v| world(*v).z <= self.ground + FLUSH);
            self.floor[i] = (rotation * t.normal).z >= STANDABLE;
            self.any_buried |= self.buried[i];
        }
    }

    /// Places it at `pose` unless it would enclose one of the `nodes` \[m\] @world there, or come too near to one; says whether it did.
    pub(crate) fn moved_clear_of(&mut self, nodes: &[[f64; 3]], pose: Pose) -> bool {
        let (before, was) = (self.pose, self.nearest(nodes));
        self.place(pose);
        let inside = |p: &[f64; 3]| {
            let p = Vector3::from(*p);
            self.bounds.distance_squared(&p) == 0.0 && self.query(&p, 0.0).is_some_and(|(gap, _)| gap < 0.0)
        };
        let clear = !nodes.iter().any(inside) && self.nearest(nodes) >= was;
        if !clear {
            self.place(before);
        }
        clear
    }

    /// \[m\] Least distance of the `nodes` \[m\] @world that is below its clearance; the clearance if there is none, or it is not there.
    fn nearest(&self, nodes: &[[f64; 3]]) -> f64 {
        let mut nearest = self.clearance;
        for p in nodes.iter().map(|p| Vector3::from(*p)).filter(|_| self.present) {
            if self.bounds.distance_squared(&p) < nearest * nearest {
                nearest = self.query(&p, nearest).map_or(nearest, |(gap, _)| gap.min(nearest));
            }
        }
        nearest
    }

    /// Gap \[m\] and normal @world at `p` \[m\] @world: exact outside, and inside the face the point came through.
    ///
    /// Inside, the nearest face is not always that one: 2 mm below the top of a board and 1 mm from its side, the side
    /// is nearer, but a foot comes from above. A face one can stand on is taken if it is at most four times as deep as
    /// the nearest one; the factor bounds how much deeper than it is a point may seem, and with it the jump of the gap.
    pub(crate) fn query(&self, p: &Vector3<f64>, within: f64) -> Option<(f64, Vector3<f64>)> {
        let local = self.rotation.tr_mul(&(p - self.pose.position));
        let nearest_within = |within| {
            if self.any_buried {
                self.mesh.nearest_of(&local, within, |i| !self.buried[i])
            } else {
                self.mesh.nearest_of(&local, within, |_| true)
            }
        };
        // Inside the box of the mesh a point may be inside the mesh, however far from its surface; but that is rare, and
        // a search with a bound is several times as fast.
        let in_box = self.mesh.bounds().distance_squared(&local) == 0.0;
        let nearest =
            nearest_within(within).or_else(|| if in_box { nearest_within(f64::INFINITY) } else { None })?;
        let mut found = nearest;
        if nearest.gap < 0.0 && (self.rotation * nearest.normal).z < STANDABLE {
            found = self.floor_above(&local, -nearest.gap).unwrap_or(nearest);
        }
        Some((found.gap, self.rotation * found.normal))
    }

    /// The face to stand on right above a point that is `depth` \[m\] inside.
    fn floor_above(&self, local: &Vector3<f64>, depth: f64) -> Option<Nearest> {
        let above =
            |i: usize| self.floor[i] && !self.buried[i] && self.mesh.triangles()[i].height(local) < 0.0;
        let floor = self.mesh.nearest_of(local, FLOOR_FAVOUR * depth, above)?;
        // Beside the face, not below it: it is another step's.
        let normal = self.mesh.triangles()[floor.triangle].normal;
        ((local - floor.point).cross(&normal).norm() <= 1e-9 && floor.gap < 0.0).then_some(floor)
    }
}
