//! A log, as what the measures of stability ask: loads, soles, centre of gravity, and what the feet need to move.
//!
//! Positions and forces are those of the simulated robot. Accelerations are second differences over three cycles, so
//! the first and the last record, and those beside a gap, have none.

use std::path::Path;

use messages::SimState;
use messages::topics::SIM_STATE;
use multibody::{Data, Frame, Model};
use nalgebra::{UnitQuaternion, Vector3};
use recording::polygon::{self, Point};
use recording::{Log, RobotInfo};

use super::cone::{self, Border};
use super::contact_cone;
use super::points::{self, Load};

/// \[N\] A sole that carries less does not count as part of the support.
pub const TOUCHING: f64 = 1.0;
/// \[1\] The wrench of a sole that carries less of the robot's weight says nothing about it: its cone is not asked.
pub const LOADED: f64 = 1.0 / 30.0;

/// One cycle. What is not defined in it is NaN.
#[derive(Clone, Debug)]
pub struct Instant {
    /// \[s\]
    pub time: f64,
    /// Soles that carry something: right, left.
    pub loaded: [bool; 2],
    /// \[m\] @world Convex hull of the contact points that carry.
    pub support: Vec<Point>,
    /// \[m\] @world Zero-moment point.
    pub zmp: Point,
    /// \[m\] @world Foot rotation indicator; in single support.
    pub fri: Point,
    /// \[m\] @world Point of zero rate of angular momentum.
    pub zram: Point,
    /// \[m\] @world p* (3.18).
    pub capture: Point,
    /// \[N m\] @world Rate of the angular momentum about the centre of gravity.
    pub momentum_rate: [f64; 3],
    /// \[1\] Margin to the cone of all contact points that carry.
    pub cone: f64,
    /// \[1\] Margin to the contact-wrench cone of the loaded sole that is nearest to its border, as if it lay flat.
    pub sole_cone: f64,
    /// What that border is.
    pub border: Option<Border>,
    /// \[N\] |m c'' - m g - F - push|: how well accelerations of the log fit its forces.
    pub imbalance: f64,
}

impl Instant {
    /// \[m\] Distance of one of the points to the edge of the support, negative outside; NaN where there is none.
    pub fn margin(&self, point: Point) -> f64 {
        polygon::margin(&self.support, point).unwrap_or(f64::NAN)
    }
}

/// Bodies and soles behind a log.
pub struct LoggedRobot {
    model: Model,
    data: Data,
    info: RobotInfo,
    /// Coefficient of friction of the soles.
    friction: f64,
    /// Where each foot begins: the sensor between ankle and foot.
    feet: [Frame; 2],
    q: Vec<f64>,
    force: Vec<f64>,
}

/// Every cycle of a log in which something carries the robot.
///
/// # Errors
/// The file is no log, or has no simulated robot or no URDF in it.
pub fn read(path: &Path, friction: f64) -> Result<(RobotInfo, String, Vec<Instant>), String> {
    let log = Log::open(path).map_err(|e| e.to_string())?;
    let states = log.records::<SimState>(&SIM_STATE).map_err(|e| e.to_string())?;
    if states.len() < 3 {
        return Err(format!(
            "{}: {} records of sim_state; at least 3 cycles of a simulated robot are needed",
            path.display(),
            states.len()
        ));
    }
    let mut robot =
        LoggedRobot::new(log.robot(), friction).map_err(|e| format!("{}: {e}", path.display()))?;
    let instants: Vec<Instant> =
        states.windows(3).filter_map(|w| robot.instant([&w[0], &w[1], &w[2]])).collect();
    if instants.is_empty() {
        return Err(format!(
            "{}: nothing ever carries the robot: no measure of stability is defined",
            path.display()
        ));
    }
    Ok((log.robot().clone(), log.run().scene.clone(), instants))
}

impl LoggedRobot {
    /// # Errors
    /// The URDF and the names beside it do not fit.
    pub fn new(info: &RobotInfo, friction: f64) -> Result<Self, String> {
        let order: Vec<&str> = info.joints.iter().map(String::as_str).collect();
        let model = Model::from_urdf(&info.urdf, &info.torso, &order).map_err(|e| e.to_string())?;
        let foot =
            |i: usize| model.frame(&info.feet[i].sensor_link, info.feet[i].sensor).map_err(|e| e.to_string());
        let feet = [foot(0)?, foot(1)?];
        let (q, force) = (model.neutral(), vec![0.0; model.nv()]);
        Ok(Self { data: Data::new(&model), feet, info: info.clone(), friction, q, force, model })
    }

    /// The middle one of three cycles; none without load, or if they do not follow each other.
    pub fn instant(&mut self, [before, now, after]: [&SimState; 3]) -> Option<Instant> {
        let h = now.time - before.time;
        let even = h > 0.0 && ((after.time - now.time) - h).abs() < 0.01 * h;
        let loaded = now.foot_wrench.map(|w| w.force[2] > TOUCHING);
        if !even || !loaded.contains(&true) || now.fallen == 1 {
            return None;
        }
        let place = |i: usize| Vector3::from_column_slice(&now.feet[i][..3]);
        let loads = [0, 1].map(|i| Load::of(&now.foot_wrench[i], place(i)));
        let soles: Vec<usize> = (0..2).filter(|&i| loaded[i]).collect();
        let (z, support) = (polygon::contact_height(now)?, polygon::support_polygon(now));

        // Motion by differences over three cycles; the ground's force and the push must account for it.
        let com = Vector3::from(now.com);
        let (earlier, later) = (Vector3::from(before.com), Vector3::from(after.com));
        let velocity = (later - earlier) / (2.0 * h);
        let acceleration = (later - 2.0 * com + earlier) / (h * h);
        let ground = loads[0] + loads[1];
        let (push, pushed) = self.push(now);
        let other = (pushed - com).cross(&push);
        let balance = (acceleration - multibody::GRAVITY) * self.model.mass() - ground.force - push;
        // Friction cones: of the nearest flat sole, and of all contact points.
        let (sole_cone, border) = self.sole_cone(now, &soles);
        let cone = Some(ground.force.z).filter(|f| *f > LOADED * self.weight());
        let cone = cone.and_then(|_| contact_cone::margin(now.carrying(), &ground, self.friction));
        let or_none = |p: Option<Point>| p.unwrap_or([f64::NAN; 2]);
        let fri = match soles[..] {
            [foot] => {
                points::foot_rotation(&loads[foot], &self.foot_inertia([before, now, after], foot, h), z)
            }
            _ => None,
        };
        Some(Instant {
            time: now.time,
            loaded,
            support,
            zmp: or_none(points::zmp(&ground, z)),
            fri: or_none(fri),
            zram: or_none(points::zero_rate(&ground, &com, &other, z)),
            capture: or_none(points::capture(&com, &velocity, z)),
            momentum_rate: points::momentum_rate(&ground, &com, &other).into(),
            cone: cone.unwrap_or(f64::NAN),
            sole_cone,
            border,
            imbalance: balance.norm(),
        })
    }

    /// \[N\]
    fn weight(&self) -> f64 {
        self.model.mass() * multibody::GRAVITY_ACCELERATION
    }

    /// The push and where it acts: at the torso's own centre of gravity.
    fn push(&self, s: &SimState) -> (Vector3<f64>, Vector3<f64>) {
        let at = Vector3::from(s.position) + orientation(s) * self.model.base_cog();
        (Vector3::from(s.push), at)
    }

    /// Margin of the loaded sole that is nearest to its border.
    fn sole_cone(&self, s: &SimState, soles: &[usize]) -> (f64, Option<Border>) {
        let heavy = |i: &&usize| s.foot_wrench[**i].force[2] > LOADED * self.weight();
        let of = |&i: &usize| {
            let [back, front, right, left] = self.info.feet[i].support;
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -s.feet[i][3]);
            let (force, moment) =
                (turn * Vector3::from(s.foot_wrench[i].force), turn * Vector3::from(s.foot_wrench[i].moment));
            let middle = Vector3::new(0.5 * (back + front), 0.5 * (right + left), 0.0);
            let half = [0.5 * (front - back), 0.5 * (left - right)];
            cone::margin(&force, &(moment - middle.cross(&force)), half, self.friction)
        };
        let least = soles.iter().filter(heavy).filter_map(of).min_by(|a, b| a.0.total_cmp(&b.0));
        least.map_or((f64::NAN, None), |(margin, border)| (margin, Some(border)))
    }

    /// F_a, T_a of a foot: what its bodies need for their motion, less what they need at rest.
    fn foot_inertia(&mut self, [before, now, after]: [&SimState; 3], foot: usize, h: f64) -> Load {
        let n = self.model.n();
        let base = |s: &SimState| {
            let ([a, b, c], [d, e, f]) = (s.velocity, s.angular_velocity);
            [a, b, c, d, e, f]
        };
        let (mut v, mut acceleration) = (vec![0.0; 6 + n], vec![0.0; 6 + n]);
        v[..6].copy_from_slice(&base(now));
        for (a, (early, late)) in acceleration.iter_mut().zip(base(before).into_iter().zip(base(after))) {
            *a = (late - early) / (2.0 * h);
        }
        for j in 0..n {
            let [early, q, late] = [before, now, after].map(|s| s.joint_angle[j]);
            v[6 + j] = (late - early) / (2.0 * h);
            acceleration[6 + j] = (late - 2.0 * q + early) / (h * h);
        }
        self.q[..3].copy_from_slice(&now.position);
        self.q[3..7].copy_from_slice(&now.orientation);
        self.q[7..].copy_from_slice(&now.joint_angle[..n]);
        let moving = self.carried(foot, &v, &acceleration);
        let rest = vec![0.0; 6 + n];
        moving - self.carried(foot, &rest, &rest)
    }

    fn carried(&mut self, foot: usize, v: &[f64], acceleration: &[f64]) -> Load {
        let Self { model, data, q, force, feet, .. } = self;
        model.forward_kinematics(data, q);
        model.inverse_dynamics(data, q, v, acceleration, force);
        let (force, moment) = model.carried_wrench(data, &feet[foot]);
        let at = model.frame_position(data, &feet[foot]);
        Load { force, moment: moment + at.cross(&force) }
    }
}

fn orientation(s: &SimState) -> UnitQuaternion<f64> {
    let [x, y, z, w] = s.orientation;
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use chain::Chain;
    use config::Setup;
    use nalgebra::Point3;
    use recording::polygon::{convex_hull, margin, sole_corners, support_polygon, zero_moment_point};

    /// \[m\] Nodes of a foot in the air find their rest within some milliseconds; below this they may still touch.
    const NEAR: f64 = 1.5e-3;

    /// While a heel is up, the support is what of the sole is on the ground. The zero-moment point is always inside, as forces
    /// that only push have it; inside of the full rectangles it seemed to be up to centimetres further from the edge, or outside.
    /// The points are those that kinematics alone has below the ground.
    #[test]
    fn a_heel_that_is_up_is_no_support() {
        let setup = Setup::load(&config::root(None), "walk_3kmh").unwrap();
        let model = setup.robot.model().unwrap();
        let places: Vec<_> = setup.robot.feet.iter().flat_map(|f| &f.points).collect();
        let nodes: Vec<_> = places.iter().map(|(link, at)| model.frame(link, *at).unwrap()).collect();
        let (mut data, mut q, mut height) = (Data::new(&model), model.neutral(), vec![0.0; nodes.len()]);
        let (mut chain, mut most, mut heel_up, mut cycles) = (Chain::new(&setup).unwrap(), 0.0, 0, 0);
        for _ in 0..10_000 {
            let s = chain.step().sim_state;
            q[..3].copy_from_slice(&s.position);
            q[3..7].copy_from_slice(&s.orientation);
            q[7..].copy_from_slice(&s.joint_angle[..model.n()]);
            model.forward_kinematics(&mut data, &q);
            for (node, before) in nodes.iter().zip(&mut height) {
                let at = model.frame_pose(&data, node) * Point3::origin();
                let apart = |c: &messages::ContactPoint| (c.place[0] - at.x).hypot(c.place[1] - at.y);
                let carries = s.carrying().iter().any(|c| apart(c) < 0.015);
                // One that leaves the ground faster than its layer follows carries nothing any more.
                let sinks = at.z < std::mem::replace(before, at.z);
                assert!(carries || !sinks || at.z > -NEAR, "{} m and carries nothing at {} s", at.z, s.time);
                assert!(!carries || at.z < NEAR, "{} m above the ground and carries at {} s", at.z, s.time);
            }
            let Some(zmp) = zero_moment_point(&s) else { continue };
            cycles += 1;
            let inside = margin(&support_polygon(&s), zmp).unwrap();
            assert!(inside > -1e-5, "{inside} m at {} s", s.time);
            // As it was reckoned before: whole soles of what carries anything.
            let soles = (0..2).filter(|&i| s.foot_wrench[i].force[2] > TOUCHING);
            let corners = soles.flat_map(|i| sole_corners(&s.feet[i], &setup.robot.feet[i].support));
            let as_if_flat = margin(&convex_hull(&corners.collect::<Vec<_>>()), zmp).unwrap_or(0.0);
            most = f64::max(most, as_if_flat - inside);
            heel_up += usize::from(as_if_flat - inside > 1e-3);
        }
        let share = heel_up as f64 / f64::from(cycles);
        assert!(most > 0.03 && share > 0.03, "{most} m, {share}");
    }
}
