//! Prediction: the plan's postures on four springs a sole, in equilibrium at every instant.
//!
//! A robot that walks this slowly is, at each instant, a rigid body that rests on the corners of its soles. With the
//! posture given, height z and inclinations a (about x), b (about y) are those of least potential
//!
//! V = k/2 sum min(0, zeta_i)^2 - m g' c, zeta_i = height of corner i over the ground,
//!
//! found downhill from those of the instant before, so that a robot that tips comes to rest where it falls to. While a
//! whole sole of half width b carries, that is the edge of the sole, drawn in by 1 - m g h / K with K = 4 k b^2. What
//! the body is accelerated by is added to gravity, g' = g - c''; its turning is left out. Feet do not slip, gears do not give.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | c | centre of gravity | m | torso, then ground |
//! | k | stiffness of a corner | N/m | |
//! | P | pivot: the middle of the soles by their load, which stays where it is | m | torso |

use config::{Gait, Robot};
use messages::MAX_JOINTS;
use multibody::{Data, Frame, Model};
use nalgebra::{Matrix3, Vector3};
use planner::pattern_check::{WalkedPlan, walk_of};

use super::TILT;
use super::trial::Foothold;

/// \[m/s^2\]
const GRAVITY: f64 = 9.81;
/// Instants of a step at which the robot is looked at.
const INSTANTS: f64 = 240.0;
/// Steps of the search for an equilibrium; a fall takes some dozens.
const ROUNDS: usize = 200;

/// What is not as the plan has it.
#[derive(Clone, Debug)]
pub(super) struct Deviation {
    /// \[rad\] Encoders read as much too much.
    pub(super) zero: [f64; MAX_JOINTS],
    /// \[s\] Joints are as late.
    pub(super) lag: [f64; MAX_JOINTS],
    /// \[rad\] Roll and pitch of the ground.
    pub(super) slope: [f64; 2],
    /// Raised ground.
    pub(super) bump: Option<Bump>,
}

/// Raised ground: x and y from, to \[m\] in the frame in which the right foot stands before the walk, height \[m\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Bump {
    pub(super) area: [[f64; 2]; 2],
    pub(super) height: f64,
    /// \[s\] From this instant of the walk on.
    pub(super) from: f64,
}

impl Deviation {
    pub(super) const NONE: Self =
        Self { zero: [0.0; MAX_JOINTS], lag: [0.0; MAX_JOINTS], slope: [0.0; 2], bump: None };

    fn ground(&self, t: f64, x: f64, y: f64) -> f64 {
        let inside = |b: &&Bump| {
            t >= b.from && [x, y].iter().zip(b.area).all(|(v, [from, to])| (from..to).contains(v))
        };
        self.bump.as_ref().filter(inside).map_or(0.0, |b| b.height)
    }
}

/// A robot and a walk.
pub(super) struct Statics<'a> {
    robot: &'a Robot,
    plans: Vec<WalkedPlan>,
    /// \[s\] Time of a step.
    step: f64,
    model: Model,
    data: Data,
    /// Corners of the soles, right foot first.
    corners: Vec<Frame>,
    q: Vec<f64>,
}

/// A posture: positions \[m\] in the torso.
struct Posture {
    /// \[s\]
    time: f64,
    cog: Vector3<f64>,
    corners: Vec<Vector3<f64>>,
    /// Torso in the ground's frame, as planned.
    torso: Vector3<f64>,
    pivot: Vector3<f64>,
}

/// Height of the pivot's frame over its planned one \[m\], inclinations about x and y \[rad\].
type Rest = Vector3<f64>;

impl<'a> Statics<'a> {
    /// For a pattern; none if it cannot be laid.
    pub(super) fn new(robot: &'a Robot, gait: &Gait) -> Option<Self> {
        let model = robot.model().ok()?;
        let points = robot.feet.iter().flat_map(|foot| &foot.points);
        let corners = points.map(|(link, at)| model.frame(link, *at)).collect::<Result<Vec<_>, _>>().ok()?;
        let (data, q) = (Data::new(&model), model.neutral());
        let step = gait.pattern?.step_time;
        Some(Self { robot, plans: walk_of(gait, robot).ok()?, step, model, data, corners, q })
    }

    /// True if the whole walk is made with a tilt below [`TILT`].
    pub(super) fn walks(&mut self, wrong: &Deviation) -> bool {
        self.tilt(wrong).is_some_and(|tilt| tilt < TILT)
    }

    /// \[rad\] Largest tilt of the torso over the walk; none where a leg cannot take its pose.
    pub(super) fn tilt(&mut self, wrong: &Deviation) -> Option<f64> {
        let (mut most, mut rest) = (0.0_f64, Rest::zeros());
        let apart = self.step / INSTANTS;
        let last = self.plans.last()?;
        let count = ((last.began + last.end) / apart) as usize;
        // World's vertical in the frame of the ground.
        let [roll, pitch] = wrong.slope;
        let up = Vector3::new(-pitch.sin(), roll.sin() * pitch.cos(), roll.cos() * pitch.cos());
        for k in 0..=count {
            let t = k as f64 * apart;
            let posture = self.posture(t, wrong)?;
            let around = [self.cog(t - apart)?, self.cog(t)?, self.cog(t + apart)?];
            let acceleration = (around[0] - 2.0 * around[1] + around[2]) / (apart * apart);
            let pull = -GRAVITY * up - acceleration;
            rest = self.settle(&posture, wrong, self.model.mass() * pull, rest);
            most = most.max(turned(&rest, &Vector3::z()).0.dot(&up).clamp(-1.0, 1.0).acos());
            if !(most < TILT) {
                break;
            }
        }
        Some(most)
    }

    /// \[N\] Weight, and where the centre of gravity is planned over the middle of the sole that carries more: to the left,
    /// forward, up \[m\].
    #[cfg(test)]
    pub(super) fn over_stance(&mut self, t: f64) -> Option<(f64, [f64; 3])> {
        let posture = self.posture(t, &Deviation::NONE)?;
        let lever = posture.cog - posture.pivot;
        Some((self.model.mass() * GRAVITY, [lever.y, lever.x, lever.z]))
    }

    /// True if the robot stays upright at an instant that lasts.
    #[cfg(test)]
    pub(super) fn stands(&mut self, t: f64, wrong: &Deviation) -> Option<bool> {
        let posture = self.posture(t, wrong)?;
        let [roll, pitch] = wrong.slope;
        let up = Vector3::new(-pitch.sin(), roll.sin() * pitch.cos(), roll.cos() * pitch.cos());
        let rest = self.settle(&posture, wrong, -self.model.mass() * GRAVITY * up, Rest::zeros());
        Some(rest.yz().norm() < 0.05)
    }

    /// \[N m\] Torque with which gravity turns a joint at `t` \[s\], the sole of the stance foot held.
    pub(super) fn torque(&mut self, t: f64, joint: usize, stance: usize) -> Option<f64> {
        let (angle, weight) = (1e-4, self.model.mass() * GRAVITY);
        let mut height = |by: f64| {
            let mut wrong = Deviation::NONE;
            wrong.zero[joint] = -by;
            let posture = self.posture(t, &wrong)?;
            // The normal of the sole is the vertical.
            let [heel_right, heel_left, toe_right] = [0, 1, 2].map(|k| posture.corners[4 * stance + k]);
            let normal = (toe_right - heel_right).cross(&(heel_left - heel_right)).normalize();
            Some((posture.cog - heel_right).dot(&normal))
        };
        Some(weight * (height(angle)? - height(-angle)?) / (2.0 * angle))
    }

    /// \[1\] Share of the weight that the left foot carries at `t` \[s\].
    pub(super) fn load_left(&self, t: f64) -> f64 {
        let (walked, own) = self.at(t);
        walked.plan.load_left.sample(own).position[0]
    }

    /// Landing with step `k` of the walk, from 0.
    pub(super) fn landing(&self, k: usize) -> Foothold {
        let w = &self.plans[k];
        let s = &w.plan.steps[0];
        let foot = 1 - s.stance as usize;
        let [x, y, _] = s.landing;
        let [from_x, ..] = w.plan.feet[foot].sample(0.0).position;
        let origin = w.plan.origin;
        Foothold {
            foot,
            place: [origin[0] + x, origin[1] + y],
            lifted: w.began + s.lift,
            landed: w.began + s.end,
            way: x - from_x,
        }
    }

    /// Plan that is walked at `t` \[s\] of the walk, and its own time.
    fn at(&self, t: f64) -> (&WalkedPlan, f64) {
        let after = self.plans.partition_point(|w| w.began <= t.max(0.0));
        let walked = &self.plans[after.max(1) - 1];
        (walked, t.max(0.0) - walked.began)
    }

    fn posture(&mut self, t: f64, wrong: &Deviation) -> Option<Posture> {
        let mut angles = self.angles(t)?;
        for (j, angle) in angles.iter_mut().enumerate() {
            if wrong.lag[j] != 0.0 {
                *angle = self.angles(t - wrong.lag[j])?[j];
            }
            *angle -= wrong.zero[j];
        }
        let n = self.model.n();
        self.q[7..].copy_from_slice(&angles[..n]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        let corners: Vec<_> = self.corners.iter().map(|f| self.model.frame_position(&self.data, f)).collect();
        let cog = self.model.cog(&mut self.data);
        let (walked, own) = self.at(t);
        let origin = walked.plan.origin;
        let torso =
            Vector3::from(walked.plan.body.sample(own).position) + Vector3::new(origin[0], origin[1], 0.0);
        let left = self.load_left(t);
        let middle = |foot: usize| corners[4 * foot..4 * foot + 4].iter().sum::<Vector3<f64>>() / 4.0;
        let pivot = middle(0) * (1.0 - left) + middle(1) * left;
        Some(Posture { time: t, cog, corners, torso, pivot })
    }

    fn angles(&self, t: f64) -> Option<[f64; MAX_JOINTS]> {
        let (walked, own) = self.at(t);
        let mut angles = [0.0; MAX_JOINTS];
        self.robot.angles_of_plan(&walked.plan, own, &mut angles).ok().map(|()| angles)
    }

    /// \[m\] Planned centre of gravity.
    fn cog(&mut self, t: f64) -> Option<Vector3<f64>> {
        self.posture(t, &Deviation::NONE).map(|p| p.torso + p.cog)
    }

    /// Equilibrium under the force `pull` \[N\] on the centre of gravity, downhill from `rest`: Newton's steps, each damped
    /// until it leads down.
    fn settle(&self, p: &Posture, wrong: &Deviation, pull: Vector3<f64>, mut rest: Rest) -> Rest {
        let k = self.robot.contact.normal_stiffness;
        let lever = p.cog - p.pivot;
        let planned = p.torso + p.pivot;
        let feet: Vec<_> = p.corners.iter().map(|c| (c - p.pivot, c + p.torso)).collect();
        // Work of the force, and of the layers that the corners sink into; gradient and Hessian with it.
        let potential = |rest: &Rest| {
            let (at, slopes, curves) = turned(rest, &lever);
            let mut value = -(pull.dot(&at) + pull.z * rest[0]);
            let mut gradient = -Vector3::new(pull.z, pull.dot(&slopes[0]), pull.dot(&slopes[1]));
            let mut hessian = Matrix3::zeros();
            let bend = |h: &mut Matrix3<f64>, c: [f64; 3]| {
                h[(1, 1)] += c[0];
                h[(1, 2)] += c[1];
                h[(2, 1)] += c[1];
                h[(2, 2)] += c[2];
            };
            bend(&mut hessian, curves.map(|c| -pull.dot(&c)));
            for (arm, place) in &feet {
                let (at, slopes, curves) = turned(rest, arm);
                let deep = planned.z + rest[0] + at.z - wrong.ground(p.time, place.x, place.y);
                if deep < 0.0 {
                    let slope = Vector3::new(1.0, slopes[0].z, slopes[1].z);
                    value += 0.5 * k * deep * deep;
                    gradient += k * deep * slope;
                    hessian += k * slope * slope.transpose();
                    bend(&mut hessian, curves.map(|c| k * deep * c.z));
                }
            }
            (value, gradient, hessian)
        };
        // Newton's steps (Levenberg's damping): one that leads up is tried shorter.
        let (mut value, mut gradient, mut hessian) = potential(&rest);
        let mut damping = 0.0;
        for _ in 0..ROUNDS {
            if gradient.norm() < 1e-6 || rest.yz().norm() > 2.0 * TILT {
                break;
            }
            let damped = hessian + Matrix3::from_diagonal_element(damping);
            let tried = damped.cholesky().map(|l| rest - l.solve(&gradient));
            match tried.map(|to| (to, potential(&to))) {
                Some((to, next)) if next.0 <= value => {
                    rest = to;
                    (value, gradient, hessian) = next;
                    damping *= 0.2;
                }
                _ => damping = (4.0 * damping).max(1.0),
            }
        }
        rest
    }
}

/// R_y(b) R_x(a) p; its derivatives by a and b; by aa, ab, bb.
fn turned(rest: &Rest, p: &Vector3<f64>) -> (Vector3<f64>, [Vector3<f64>; 2], [Vector3<f64>; 3]) {
    let ((sa, ca), (sb, cb)) = (rest[1].sin_cos(), rest[2].sin_cos());
    let (x, y, z) = (p.x, p.y * ca - p.z * sa, p.y * sa + p.z * ca);
    let about_y = |x: f64, z: f64| [x * cb + z * sb, z * cb - x * sb];
    let of = |[x, z]: [f64; 2], y: f64| Vector3::new(x, y, z);
    let ([fx, fz], [gx, gz]) = (about_y(x, z), about_y(0.0, y));
    (
        of([fx, fz], y),
        [of([gx, gz], -z), of([fz, -fx], 0.0)],
        [of(about_y(0.0, -z), -y), of([gz, -gx], 0.0), of([-fx, -fz], 0.0)],
    )
}
