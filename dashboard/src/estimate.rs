//! Poses as the robot believes them, in the world: those of the log's `/tf` and `/markers`, at the instant of a frame.

use std::collections::VecDeque;

use config::Setup;
use messages::plan::BodyPoint;
use messages::{ControllerState, Plan, RIGHT, Sensors};
use multibody::{Data, Frame, Model};
use recording::{RecordedPose, odometry};

/// Plans that are kept: the stabilizer follows one of the newest.
const PLANS: usize = 4;
/// Points of the planned way of the centre of gravity.
pub const PATH_POINTS: usize = 24;
/// Steps of a plan.
pub const STEPS: usize = 8;

/// Kinematics of the robot, and where its odometry began.
pub struct PoseEstimator {
    model: Model,
    data: Data,
    q: Vec<f64>,
    /// Sole frame of the right foot.
    sole: Frame,
    /// Frames of the force sensors, right and left.
    sensors: [Frame; 2],
    /// world_from_odom
    start: RecordedPose,
    /// \[m\] Centre of gravity of the torso alone in its frame, where pushes act.
    torso_cog: [f64; 3],
    plans: VecDeque<Box<Plan>>,
}

/// Estimate at one instant; world frame. NaN: not known.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// world_from_torso; none before the stabilizer knows it.
    pub torso: Option<RecordedPose>,
    /// world_from_planning
    pub planning: RecordedPose,
    /// \[m\] Height of the zero-moment point over the planning frame.
    pub ground: f64,
    /// \[N\] Force of the ground on each foot.
    pub force: [[f64; 3]; 2],
    /// Steps that are not done: foot, x, y, z \[m\], heading \[rad\].
    pub steps: [[f64; 5]; STEPS],
    /// \[m\] Planned way of the centre of gravity from now on.
    pub path: [[f64; 3]; PATH_POINTS],
}

impl PoseEstimator {
    /// Of this robot; `simulated`: in the world in which the scene puts it.
    ///
    /// # Errors
    /// The robot's files do not fit together.
    pub fn new(setup: &Setup, simulated: bool) -> Result<Self, String> {
        let robot = &setup.robot;
        let model = robot.model().map_err(|e| e.to_string())?;
        let frame = |link: &str, at| model.frame(link, at).map_err(|e| e.to_string());
        let sole = frame(&robot.feet[RIGHT].link, robot.feet[RIGHT].sole)?;
        let [right, left] = [0, 1].map(|i| frame(&robot.feet[i].sensor_link, robot.feet[i].sensor));
        let sensors = [right?, left?];
        let start = if simulated { setup.start().map_err(|e| e.to_string())?.into() } else { [0.0; 3] };
        let (data, q, torso_cog) = (Data::new(&model), model.neutral(), model.base_cog().into());
        let start = RecordedPose::moved(start);
        Ok(Self { model, data, q, sole, sensors, start, torso_cog, plans: VecDeque::new() })
    }

    /// Keeps a plan for as long as the stabilizer may follow it.
    pub fn keep(&mut self, plan: &Plan) {
        if self.plans.len() == PLANS {
            self.plans.pop_front();
        }
        self.plans.push_back(Box::new(*plan));
    }

    /// Forgets all plans: the next instant may be before them.
    pub fn forget(&mut self) {
        self.plans.clear();
    }

    /// Point of the torso at which pushes act, in the world; `torso`: world_from_torso.
    pub fn pushed_at(&self, torso: &RecordedPose) -> [f64; 3] {
        torso.place(self.torso_cog)
    }

    /// Estimate from sensors, stabilizer and the plan that it follows.
    pub fn see(&mut self, sensors: &Sensors, state: &ControllerState) -> Estimate {
        // Poses of sole and sensors in the torso frame: the torso is put at the origin.
        let n = self.q.len() - 7;
        self.q[7..].copy_from_slice(&sensors.joint_angle[..n]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        let pose = |frame| {
            let (position, orientation) = self.model.frame_place(&self.data, frame);
            RecordedPose { position, orientation }
        };
        let plan = self.plans.iter().find(|plan| plan.id == state.plan_id);
        let height = plan.map_or(0.0, |plan| plan.height);
        let torso = odometry::torso(sensors, state, height, &pose(&self.sole)).map(|odom_from_torso| {
            // Inclination, heading and place as in the log, but in the simulated world.
            self.start.then(&odom_from_torso)
        });
        let planning = self.start.then(&odometry::planning_frame(state, height));
        let force = |i: usize| {
            let turn = torso.map(|torso: RecordedPose| torso.then(&pose(&self.sensors[i])).orientation);
            turn.map_or([f64::NAN; 3], |orientation| {
                RecordedPose { position: [0.0; 3], orientation }.place(sensors.foot_wrench[i].force)
            })
        };
        let force = [force(0), force(1)];
        let mut estimate = Estimate {
            torso,
            planning,
            ground: 0.0,
            force,
            steps: [[f64::NAN; 5]; STEPS],
            path: [[f64::NAN; 3]; PATH_POINTS],
        };
        if let Some(plan) = plan {
            estimate.plan(plan, state);
        }
        estimate
    }
}

impl Estimate {
    /// Plan from now on.
    fn plan(&mut self, plan: &Plan, state: &ControllerState) {
        let (now, end) = (state.plan_time, plan.end());
        self.ground = plan.zmp_height.sample(now).0[0];
        let steps = plan.steps.iter().take(plan.step_count as usize).filter(|step| step.end > now);
        for (row, step) in self.steps.iter_mut().zip(steps) {
            let foot = 1 - (step.stance as usize).min(1);
            let [x, y, heading] = step.landing;
            let z = plan.feet[foot].sample(step.end).position[2];
            let [x, y, z] = self.planning.place([x, y, z]);
            *row = [foot as f64, x, y, z, heading + self.planning.heading()];
        }
        // A pattern leads the torso and knows of no centre of gravity.
        if plan.leads == BodyPoint::CentreOfGravity as u64 {
            let last = (PATH_POINTS - 1) as f64;
            for (k, point) in self.path.iter_mut().enumerate() {
                let t = now + (end - now).max(0.0) * k as f64 / last;
                *point = self.planning.place(plan.body.sample(t).position);
            }
        }
    }

    /// A point of the planning frame in the world.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        self.planning.place(point)
    }

    /// The same of a point on the ground.
    pub fn on_ground(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        self.planning.place([x, y, self.ground])
    }

    /// A direction of the planning frame in the world.
    pub fn turn(&self, v: [f64; 3]) -> [f64; 3] {
        RecordedPose { position: [0.0; 3], ..self.planning }.place(v)
    }
}
