//! A place as objects of a scene. What lies lower than where the robot starts is a hole in what it starts on, over ground that
//! lies lower still.

use std::fmt::Write as _;

use config::Setup;
use config::plant_mismatch::PlantMismatch;
use config::robot::Joint;
use config::sensors::PerJoint;
use config::terrain::{ObjectShape, TerrainObject, TerrainPose};

use super::footprint::Rectangle;
use super::place::{ALONG, Masses, NODES, Place};

/// \[m\] Depth of holes.
pub(super) const DEPTH: f64 = 0.1;
/// \[m\] How far slabs reach.
const WIDE: f64 = 40.0;
/// \[m\] What has another friction lies this little above the ground around it.
const FILM: f64 = 1e-4;
/// \[m\] Of a slope: how long its inclination takes to come and to go, and how long it stays.
pub(super) const TURNS: f64 = 0.5;
pub(super) const HOLDS: f64 = 2.0;
/// \[m\] Distance of the nodes of a height field, and of a slope's.
pub(super) const FIELD_GRID: f64 = 0.3;
const SLOPE_GRID: f64 = 0.1;

/// What a scene needs to be a place.
pub(super) struct Terrain {
    pub(super) objects: Vec<TerrainObject>,
    /// \[m\] @world
    pub(super) ground_height: f64,
    /// \[m\] Along the way: the robot has it behind itself.
    pub(super) end: f64,
}

impl Terrain {
    /// Changes a scene into the place.
    pub(super) fn put(&self, place: &Place, setup: &mut Setup) {
        setup.scene.objects.clone_from(&self.objects);
        let mismatch = &mut setup.scene.plant_mismatch;
        mismatch.ground_height = self.ground_height;
        if let Place::Robot(masses) = place {
            masses.load(mismatch, &setup.robot.joints);
        }
    }

    pub(super) fn of(place: &Place) -> Self {
        let flat = |objects, end| Self { objects, ground_height: 0.0, end };
        match place {
            Place::Step { x, angle, height } => step(*x, *angle, *height),
            Place::Board { area, height } => {
                flat(vec![slab("board", area, [0.0, *height], None)], end_of(area))
            }
            Place::Hole { area } => hole(area),
            Place::Slope { x, .. } => {
                let begin = *x;
                let across = evenly(-1.0, 20, SLOPE_GRID);
                let along = evenly(begin, 30, SLOPE_GRID);
                mesh("hill", along, across, begin + 2.0 * TURNS + HOLDS, |x, y| place.slope_height(x, y))
            }
            Place::Field { x, heights } => {
                let middle = 0.5 * (NODES[1] - 1) as f64;
                let at = |v: f64, n: usize| {
                    let k = (v / FIELD_GRID).round();
                    (k >= 0.0 && k < n as f64).then_some(k as usize)
                };
                let height = |px: f64, y: f64| {
                    let node = [at(px - x, NODES[0]), at(y + middle * FIELD_GRID, NODES[1])];
                    if let [Some(i), Some(j)] = node { heights[NODES[1] * i + j] } else { 0.0 }
                };
                let along = evenly(*x, NODES[0] - 1, FIELD_GRID);
                let across = evenly(-middle * FIELD_GRID, NODES[1] - 1, FIELD_GRID);
                mesh("field", along, across, x + 10.0 * FIELD_GRID, height)
            }
            Place::Patch { area, friction } => {
                flat(vec![slab("patch", area, [-0.02, FILM], Some(*friction))], end_of(area))
            }
            Place::Robot(_) => flat(Vec::new(), ALONG[1]),
        }
    }
}

impl Masses {
    /// Gives the robot of a scene, with these joints, what it weighs.
    pub(super) fn load(&self, mismatch: &mut PlantMismatch, joints: &[Joint]) {
        let mut factors = self.factors.iter().copied().cycle();
        mismatch.torso_mass_factor = factors.next().unwrap_or(1.0);
        let own = joints.iter().map(|joint| joint.name.clone()).zip(factors).collect();
        mismatch.mass_factor = PerJoint { all: None, own };
        (mismatch.torso_cog_shift, mismatch.payload) = (self.cog_shift, self.payload);
    }
}

impl Place {
    /// \[m\] Height of a slope at x, y: along the way the integral of its inclination, across it in proportion to y.
    pub(super) fn slope_height(&self, x: f64, y: f64) -> f64 {
        let Self::Slope { x: begin, angle, slope } = self else { return 0.0 };
        let gone = x - begin;
        let share = (gone / TURNS).min((2.0 * TURNS + HOLDS - gone) / TURNS).clamp(0.0, 1.0);
        // Integral of that trapezoid.
        let risen = |way: f64| 0.5 * way.clamp(0.0, TURNS).powi(2) / TURNS + (way - TURNS).max(0.0);
        let risen = (risen(gone) - risen(gone - TURNS - HOLDS)).clamp(0.0, TURNS + HOLDS);
        slope * (angle.cos() * risen + angle.sin() * y * share)
    }
}

/// \[m\] Where a robot that walks along x has a rectangle behind itself.
fn end_of(area: &Rectangle) -> f64 {
    area.middle[0] + 0.5 * area.size[0].hypot(area.size[1]) + 0.3
}

/// n intervals from `begin` on.
fn evenly(begin: f64, n: usize, interval: f64) -> Vec<f64> {
    (0..=n).map(|k| begin + k as f64 * interval).collect()
}

/// A step from an edge through (x, 0) on, up or down.
fn step(x: f64, angle: f64, height: f64) -> Terrain {
    // The slab lies behind the edge, or is what the robot starts on.
    let ahead = if height > 0.0 { 0.5 * WIDE } else { -0.5 * WIDE };
    let (sin, cos) = angle.sin_cos();
    let area = Rectangle { middle: [x + ahead * cos, ahead * sin], angle, size: [WIDE; 2] };
    let range = if height > 0.0 { [0.0, height] } else { [height, 0.0] };
    let objects = vec![slab("step", &area, range, None)];
    Terrain { objects, ground_height: height.min(0.0), end: x + 0.6 }
}

/// A floor with a hole: four slabs that overlap in the corners, so that no sole meets a seam.
fn hole(area: &Rectangle) -> Terrain {
    let (sin, cos) = area.angle.sin_cos();
    let sides = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
    let side = |[along, across]: [f64; 2]| {
        let [a, b] = [along * 0.5 * (area.size[0] + WIDE), across * 0.5 * (area.size[1] + WIDE)];
        let middle = [area.middle[0] + a * cos - b * sin, area.middle[1] + a * sin + b * cos];
        // Long enough to overlap with both of its neighbours.
        let size = if along == 0.0 { [3.0 * WIDE, WIDE] } else { [WIDE, 3.0 * WIDE] };
        slab("floor", &Rectangle { middle, angle: area.angle, size }, [-DEPTH, 0.0], None)
    };
    Terrain { objects: sides.map(side).into(), ground_height: -DEPTH, end: end_of(area) }
}

/// A box over a rectangle, between two heights \[m\].
fn slab(name: &str, area: &Rectangle, [bottom, top]: [f64; 2], friction: Option<f64>) -> TerrainObject {
    let [x, y] = area.middle;
    TerrainObject {
        friction,
        ..object(
            name,
            ObjectShape::Box([area.size[0], area.size[1], top - bottom]),
            TerrainPose { position: [x, y, 0.5 * (bottom + top)], rotation: [0.0, 0.0, area.angle] },
        )
    }
}

fn object(name: &str, shape: ObjectShape, pose: TerrainPose) -> TerrainObject {
    TerrainObject {
        name: name.into(),
        shape,
        pose,
        friction: None,
        appears: 0.0,
        vanishes: f64::INFINITY,
        keeps_clear: 0.0,
        known: false,
        poses: Vec::new(),
    }
}

/// A floor of these heights at the nodes, straight between them, level far from them; with ground that lies lower.
fn mesh(name: &str, mut x: Vec<f64>, mut y: Vec<f64>, end: f64, height: impl Fn(f64, f64) -> f64) -> Terrain {
    x.insert(0, -WIDE);
    x.push(WIDE);
    y.insert(0, y[0] - 2.0);
    y.push(y[y.len() - 1] + 2.0);
    let tops: Vec<f64> = x.iter().flat_map(|x| y.iter().map(|y| height(*x, *y))).collect();
    let bottom = tops.iter().copied().fold(0.0, f64::min) - DEPTH;
    let shape = ObjectShape::Mesh {
        file: format!("{name}.obj").into(),
        bytes: wavefront(&x, &y, &tops, bottom).into_bytes().into(),
        scale: 1.0,
    };
    let pose = TerrainPose { position: [0.0; 3], rotation: [0.0; 3] };
    Terrain { objects: vec![object(name, shape, pose)], ground_height: bottom, end: end + 0.3 }
}

/// A solid between these heights over a grid, x by x, and a level bottom, as a Wavefront file.
fn wavefront(x: &[f64], y: &[f64], tops: &[f64], bottom: f64) -> String {
    let (n, m) = (x.len(), y.len());
    let mut text = String::new();
    for low in [false, true] {
        for (k, top) in tops.iter().enumerate() {
            let z = if low { bottom } else { *top };
            writeln!(text, "v {} {} {z}", x[k / m], y[k % m]).expect("into memory");
        }
    }
    // Each face as four corners, counter-clockwise from outside.
    let (top, low) = (|i: usize, j: usize| m * i + j + 1, |i: usize, j: usize| m * (n + i) + j + 1);
    let mut face = |[a, b, c, d]: [usize; 4]| {
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").expect("into memory");
    };
    for i in 0..n - 1 {
        for j in 0..m - 1 {
            face([top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1)]);
            face([low(i, j), low(i, j + 1), low(i + 1, j + 1), low(i + 1, j)]);
        }
        face([low(i, 0), low(i + 1, 0), top(i + 1, 0), top(i, 0)]);
        face([low(i + 1, m - 1), low(i, m - 1), top(i, m - 1), top(i + 1, m - 1)]);
    }
    for j in 0..m - 1 {
        face([low(0, j + 1), low(0, j), top(0, j), top(0, j + 1)]);
        face([low(n - 1, j), low(n - 1, j + 1), top(n - 1, j + 1), top(n - 1, j)]);
    }
    text
}
