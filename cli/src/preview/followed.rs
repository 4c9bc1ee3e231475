//! Poses of a balanced gait: planner and controller lead a robot that does as it is told and presses as planned.
//!
//! It walks at a speed, or with the longest steps of the gait's table, until one stride is like the one before.

use super::{Pose, Stride};
use config::{Gait, Robot};
use controller::Controller;
use controller::task_space::TaskSpace;
use messages::command::{StepCommand, VelocityCommand};
use messages::{
    Command, ControllerState, EventCode, LEFT, MAX_JOINTS, Plan, RIGHT, Record, Sensors, Step, Words,
};
use nalgebra::{Rotation3, Vector3};
use planner::Planner;

/// \[s\] Cycle of planner and controller.
const CYCLE: f64 = 1e-3;
/// \[s\] Of standing up.
const STANDING: f64 = 4.0;
/// \[s\] Of walking, at most.
const LONGEST: f64 = 60.0;
/// \[m\] Steps whose lengths differ by less are equal.
const EQUAL: f64 = 1e-6;
/// \[m\] Centre of gravity, or sole on the ground, that are further from where they are planned are out of reach.
const OFF: f64 = 5e-3;
/// \[1\] The same of a sole in the air, beyond those: share of its planned height, so that it touches nothing.
const OFF_IN_THE_AIR: f64 = 0.5;
/// \[rad\] The same of a sole's pitch.
const TILT: f64 = 0.05;
/// \[1\] Rounding of a joint at its limit.
const ROUNDING: f64 = 1e-9;
/// Prefixes of joints that are drawn in one chart.
const SIDES: [&str; 2] = ["right_", "left_"];

/// A robot that obeys.
struct Obedient<'a> {
    robot: &'a Robot,
    planner: Planner,
    controller: Controller,
    sensors: Sensors,
    state: ControllerState,
    space: TaskSpace,
    /// The newest plan, and the one that is followed.
    plan: Box<Plan>,
    active: Box<Plan>,
    /// First tick and first step of the plans so far.
    steps: Vec<(u64, Step)>,
    /// First thing that is wrong in the walk, which began at this tick.
    fault: Option<String>,
    began: Option<u64>,
    cycles: Vec<Cycle>,
}

/// Joints and torso in a cycle.
struct Cycle {
    /// \[rad\]
    angles: [f64; MAX_JOINTS],
    /// \[m, m, rad\] Planning frame in I_0.
    origin: [f64; 3],
    /// \[m\] The torso there.
    torso: [f64; 3],
}

/// A stride at `speed` \[m/s\], or with the gait's longest steps, and the first thing that is wrong on the way there.
pub(super) fn stride<'a>(
    gait: &Gait,
    robot: &'a Robot,
    speed: Option<f64>,
) -> Result<(Stride<'a>, Option<String>), String> {
    let mut obedient = Obedient::new(gait, robot)?;
    obedient.stand()?;
    let first = obedient.walk(gait, speed)?;
    let steps = [0, 1].map(|k| obedient.steps[first + k]);
    let end = obedient.steps[first + 2].0;
    let begin = steps[0].0;
    let since = |tick: u64| (tick - begin) as f64 * CYCLE;
    let times = [since(end.min(steps[1].0)), since(end)];
    let step = |k: usize| [since(steps[k].0), since(steps[k].0) + steps[k].1.lift, times[k]];

    // Poses, in the frame where the right foot leaves.
    let mut space = TaskSpace::new(robot).map_err(|e| e.to_string())?;
    let charts = charts(robot);
    let cycles = &obedient.cycles[begin as usize - 1..end as usize];
    let mut poses: Vec<Pose> = cycles.iter().map(|cycle| pose(robot, &mut space, &charts, cycle)).collect();
    let from = poses[0].chains[RIGHT][2].xy().push(0.0);
    for pose in &mut poses {
        let points = pose.chains.iter_mut().flatten().chain(&mut pose.ankles);
        points.chain([&mut pose.torso]).for_each(|point| *point -= from);
    }
    let stride = Stride {
        steps: [step(0), step(1)],
        joints: charts.into_iter().map(|(name, _)| name).collect(),
        pose: Box::new(move |t| poses[((t / CYCLE).round() as usize).min(poses.len() - 1)].clone()),
    };
    Ok((stride, obedient.fault))
}

/// Names of joints, each with that of the right side, or that of neither, and that of the left side.
fn charts(robot: &Robot) -> Vec<(String, [Option<usize>; 2])> {
    let mut charts: Vec<(String, [Option<usize>; 2])> = Vec::new();
    for (j, joint) in robot.joints.iter().enumerate() {
        let side = SIDES.iter().position(|side| joint.name.starts_with(side));
        let name = joint.name[side.map_or(0, |side| SIDES[side].len())..].replace('_', " ");
        let k = charts.iter().position(|(other, _)| *other == name).unwrap_or_else(|| {
            charts.push((name, [None; 2]));
            charts.len() - 1
        });
        charts[k].1[side.unwrap_or(RIGHT)] = Some(j);
    }
    charts
}

fn pose(
    robot: &Robot,
    space: &mut TaskSpace,
    charts: &[(String, [Option<usize>; 2])],
    cycle: &Cycle,
) -> Pose {
    space.update(&cycle.angles);
    let [x, y, heading] = cycle.origin;
    let upright = Rotation3::from_axis_angle(&Vector3::z_axis(), heading);
    let torso = Vector3::new(x, y, 0.0) + upright * Vector3::from(cycle.torso);
    let place = |p: Vector3<f64>| torso + upright * p;
    let mut pose = Pose {
        ankles: [torso; 2],
        pitch: [0.0; 2],
        torso,
        chains: [Vec::new(), Vec::new()],
        angles: [RIGHT, LEFT].map(|side| {
            charts.iter().map(|(_, joints)| joints[side].map_or(f64::NAN, |j| cycle.angles[j])).collect()
        }),
    };
    for foot in [RIGHT, LEFT] {
        let [rear, front, ..] = robot.feet[foot].support;
        let sole = space.sole(foot);
        let edge = |x: f64| sole.position + sole.rotation * Vector3::new(x, 0.0, 0.0);
        // A toe joint lies under the sole's frame, not over it.
        let leg = space.chain(foot).skip(usize::from(robot.feet[foot].toe.is_some()));
        let chain = [edge(rear), edge(front), sole.position].into_iter().chain(leg).map(place);
        pose.chains[foot] = chain.chain([torso]).collect();
        pose.ankles[foot] = pose.chains[foot][3];
        pose.pitch[foot] = pitch(space, foot);
    }
    pose
}

/// \[rad\] Toes down, against an upright torso.
fn pitch(space: &TaskSpace, foot: usize) -> f64 {
    -space.sole(foot).rotation[(2, 0)].asin()
}

impl<'a> Obedient<'a> {
    fn new(gait: &Gait, robot: &'a Robot) -> Result<Self, String> {
        let pose = robot.poses.get("stand").ok_or("the robot has no pose `stand`")?;
        let mut sensors = Sensors { power: 1, ..Sensors::default() };
        sensors.imu.orientation = [0.0, 0.0, 0.0, 1.0];
        sensors.joint_angle[..pose.len()].copy_from_slice(pose);
        (0..2).for_each(|foot| sensors.foot_wrench[foot].force[2] = 0.5 * robot.weight());
        // Forces are as planned: nothing is to be compensated.
        let mut kinematic = gait.clone();
        (kinematic.control.force_gain, kinematic.control.force_feed_forward) = ([0.0; 3], 0.0);
        kinematic.control.planned_deformation = 0.0;
        Ok(Self {
            robot,
            planner: Planner::of(gait, robot).map_err(|fault| fault.to_string())?,
            controller: Controller::new(robot, &kinematic, CYCLE).map_err(|e| e.to_string())?,
            sensors,
            state: ControllerState::empty(),
            space: TaskSpace::new(robot).map_err(|e| e.to_string())?,
            plan: Box::new(Plan::empty()),
            active: Box::new(Plan::empty()),
            steps: Vec::new(),
            fault: None,
            began: None,
            cycles: vec![],
        })
    }

    /// One cycle.
    fn step(&mut self, commands: &[Command]) -> Result<(), String> {
        self.sensors.header.tick += 1;
        let tick = self.sensors.header.tick;
        let out = self.planner.step(tick, CYCLE, (tick > 1).then_some(&self.state), commands);
        if out.answers.iter().any(Result::is_err) {
            return Err("the gait has no steps for this speed".to_owned());
        }
        // Plans that are less than what was asked are faults of the gait.
        let mut plan_fault = None;
        for (code, detail) in out.events.drain() {
            if matches!(code, EventCode::PlanKept | EventCode::StepsUnchanged | EventCode::PlanRefused) {
                plan_fault = Some(Words::default().sentence(code as u64, detail.pack()));
            }
        }
        if let Some(plan) = out.plan {
            *self.plan = *plan;
            if plan.step_count > 0 {
                self.steps.push((plan.start_tick, plan.steps[0]));
            }
        }
        let (targets, state) = self.controller.step(&self.sensors, (self.plan.id > 0).then_some(&*self.plan));
        self.state = *state;
        if state.plan_id == self.plan.id {
            *self.active = *self.plan;
        }
        self.cycles.push(Cycle {
            angles: self.sensors.joint_angle,
            origin: state.origin,
            torso: state.torso,
        });
        // The robot does as it is told, and its feet carry what they are planned to.
        (self.sensors.joint_angle, self.sensors.joint_speed) = (targets.angle, targets.speed);
        let left = state.load_left * self.robot.weight();
        self.sensors.foot_wrench[RIGHT].force[2] = self.robot.weight() - left;
        self.sensors.foot_wrench[LEFT].force[2] = left;
        if self.fault.is_none()
            && let Some(began) = self.began
        {
            let time = (tick - began) as f64 * CYCLE;
            self.fault = plan_fault
                .or_else(|| self.beyond())
                .map(|fault| format!("not walked as planned: {time:.2} s after the begin {fault}"));
        }
        Ok(())
    }

    /// Sole or centre of gravity that is not where it is planned, and the first joint that is held at a limit.
    fn beyond(&mut self) -> Option<String> {
        let state = &self.state;
        let apart = |a: &[f64], b: &[f64]| (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt();
        let off = |what: &str, off: f64, bound: f64, unit: &str| {
            let text =
                || format!("the {what} is {off:.1} {unit} from where it is planned (at most {bound:.1})");
            (!(off <= bound)).then(text)
        };
        self.space.update(&self.cycles[self.cycles.len() - 1].angles);
        let tilt = |foot: usize| {
            let [rear, front, ..] = self.robot.feet[foot].support;
            let (_, planned) = self.active.sole(foot, state.plan_time, [rear, front]);
            (pitch(&self.space, foot) - planned.position[0]).abs().to_degrees()
        };
        let places = [RIGHT, LEFT].into_iter().find_map(|foot| {
            let what = format!("{} sole", super::SIDES[foot]);
            let (is, planned) = (&state.feet[foot], &state.feet_desired[foot]);
            // The other foot stands.
            let height = (planned[2] - state.feet_desired[1 - foot][2]).max(0.0);
            let bound = OFF + OFF_IN_THE_AIR * height;
            off(&what, 1e3 * apart(is, planned), 1e3 * bound, "mm")
                .or_else(|| off(&what, tilt(foot), TILT.to_degrees(), "deg"))
        });
        let body = || off("centre of gravity", 1e3 * apart(&state.com, &state.com_desired), 1e3 * OFF, "mm");
        // A joint at a limit is mostly why.
        let held = || {
            self.robot.joints.iter().enumerate().find_map(|(j, joint)| {
                let (angle, speed) = (self.sensors.joint_angle[j], self.sensors.joint_speed[j].abs());
                let ([low, high], limit, name) = (joint.range, joint.speed_limit, &joint.name);
                if angle <= low + ROUNDING || angle >= high - ROUNDING {
                    let [angle, low, high] = [angle, low, high].map(f64::to_degrees);
                    return Some(format!(
                        "; joint {name} is held at {angle:.1} deg by its range, {low:.1} to {high:.1} deg"
                    ));
                }
                let fast = speed >= limit * (1.0 - ROUNDING);
                fast.then(|| format!("; joint {name} is held at {speed:.3} rad/s by its limit"))
            })
        };
        places.or_else(body).map(|place| place + &held().unwrap_or_default())
    }

    /// Stands up.
    fn stand(&mut self) -> Result<(), String> {
        self.step(&[])?;
        self.step(&[Command::Stand])?;
        for _ in 0..(STANDING / CYCLE) as u64 {
            self.step(&[])?;
        }
        Ok(())
    }

    /// Walks until two strides are alike: the first plan of the last one that is whole.
    fn walk(&mut self, gait: &Gait, speed: Option<f64>) -> Result<usize, String> {
        let &[_, length, duration] = gait.step.by_speed.last().ok_or("the gait has no steps")?;
        self.began = Some(self.sensors.header.tick);
        self.step(&match speed {
            Some(forward) => vec![Command::Velocity(VelocityCommand { forward, left: 0.0, turn: 0.0 })],
            None => {
                vec![Command::Step(StepCommand { length, side: 0.0, turn: 0.0, duration }), Command::Start]
            }
        })?;
        // Looked at where a step of the left foot's stance begins: two steps before are alike the two before them.
        for _ in 0..(LONGEST / CYCLE) as u64 {
            self.step(&[])?;
            if let [.., a, b, c, d, next] = self.steps[..]
                && a.1.stance as usize == LEFT
                && self.sensors.header.tick == next.0
            {
                let length = |s: &Step| s.landing[0] - s.foothold[0];
                let alike = |x: &Step, y: &Step| {
                    (length(x) - length(y)).abs() < EQUAL && (x.end - y.end).abs() < EQUAL
                };
                if alike(&a.1, &c.1) && alike(&b.1, &d.1) {
                    return Ok(self.steps.len() - 3);
                }
            }
        }
        let whole = self.steps.len().saturating_sub(3);
        let first = (0..whole).rev().find(|&k| self.steps[k].1.stance as usize == LEFT);
        first.ok_or_else(|| {
            let why = self.fault.clone().unwrap_or_else(|| "nothing is planned".to_owned());
            format!("the robot makes no whole stride: {why}")
        })
    }
}
