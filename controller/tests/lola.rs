//! The stabilizer on Lola's kinematics, with a robot that does exactly as commanded and presses exactly as desired.

use config::gait::StabilizerGains;
use config::{Gait, Robot, root};
use controller::Controller;
use curves::{Path, Sample};
use messages::{ControllerState, EventCode, GaitState, JointMode, JointTargets, Plan, Sensors};
use std::f64::consts::FRAC_PI_2;

const DT: f64 = 1e-3;

struct Rig {
    robot: Robot,
    controller: Controller,
    sensors: Sensors,
}

impl Rig {
    fn new(pose: &str) -> Self {
        Self::with(pose, |_| {})
    }

    /// With another setting of the stabilizer.
    fn with(pose: &str, set: impl Fn(&mut StabilizerGains)) -> Self {
        let robot = Robot::load(&root(None).join("robots/lola")).unwrap();
        let mut gait = Gait::load(&root(None).join("gaits/lola.toml")).unwrap();
        set(&mut gait.control);
        let controller = Controller::new(&robot, &gait, DT).unwrap();
        let mut sensors = Sensors { power: 1, ..Sensors::default() };
        sensors.imu.orientation = [0.0, 0.0, 0.0, 1.0];
        for (j, q) in robot.poses[pose].iter().enumerate() {
            sensors.joint_angle[j] = *q;
        }
        for wrench in &mut sensors.foot_wrench {
            wrench.force[2] = 298.6;
        }
        Self { robot, controller, sensors }
    }

    /// One cycle; the robot obeys.
    fn cycle(&mut self, plan: Option<&Plan>) -> (JointTargets, ControllerState) {
        self.sensors.header.tick += 1;
        let (targets, state) = self.controller.step(&self.sensors, plan);
        let (targets, state) = (*targets, *state);
        self.sensors.joint_angle = targets.angle;
        self.sensors.joint_speed = targets.speed;
        if state.plan_id > 0 {
            self.sensors.foot_wrench = state.wrench_desired;
        }
        (targets, state)
    }

    /// `true` if the controller has reported this since it was asked last.
    fn reported(&mut self, what: EventCode) -> bool {
        self.controller.events().drain().any(|(code, _)| code == what)
    }

    /// A plan that moves the centre of gravity from where it is by `shift` \[m\] within 1.5 s, feet where they are.
    fn plan(&mut self, shift: [f64; 3]) -> Plan {
        let (_, state) = self.cycle(None);
        let mut plan = Plan { id: 1, start_tick: self.sensors.header.tick + 1, ..Plan::default() };
        // Standing, the stabilizer would learn its inclination from forces that do not move this robot.
        plan.state = GaitState::Walking as u64;
        let to = std::array::from_fn(|d| state.com[d] + shift[d]);
        plan.body = Path::resting(0.0, state.com);
        assert!(plan.body.push(&Sample::rest(state.com), &Sample::rest(to), 1.5));
        plan.torso = Path::resting(0.0, [FRAC_PI_2, FRAC_PI_2, 0.0]);
        plan.feet = state.feet.map(|f| Path::resting(0.0, f));
        plan.toes = [Path::resting(0.0, [0.0]); 2];
        plan.zmp.push(0.0, [state.com[0], state.com[1]]);
        plan.load_left = Path::resting(0.0, [0.5]);
        plan
    }
}

#[test]
fn the_joints_bring_the_centre_of_gravity_where_the_plan_wants_it() {
    let mut rig = Rig::new("stand");
    let plan = rig.plan([0.02, 0.03, -0.06]);
    let mut worst: f64 = 0.0;
    for _ in 0..2000 {
        let (targets, state) = rig.cycle(Some(&plan));
        assert_eq!(targets.mode, JointMode::Track as u64);
        worst = (0..3).fold(worst, |w, d| w.max((state.com[d] - state.com_desired[d]).abs()));
    }
    // One cycle of delay at the peak speed of 75 mm/s is 0.075 mm; modifications may add as much.
    assert!(worst < 4e-4, "{worst} m");
    let (_, state) = rig.cycle(Some(&plan));
    assert!((0..3).all(|d| (state.com[d] - state.com_desired[d]).abs() < 1e-4), "{:?}", state.com);
    assert_eq!(state.limited, 0);
}

#[test]
fn a_plan_beyond_the_length_of_the_legs_is_held_back_and_says_so() {
    let mut rig = Rig::new("stand");
    let plan = rig.plan([0.0, 0.0, 0.15]);
    let (mut state, mut reported) = (ControllerState::default(), false);
    for _ in 0..3000 {
        let (targets, now) = rig.cycle(Some(&plan));
        for (j, joint) in rig.robot.joints.iter().enumerate() {
            let [low, high] = joint.range;
            assert!(targets.angle[j] >= low - 1e-9 && targets.angle[j] <= high + 1e-9, "{}", joint.name);
            assert!(targets.speed[j].abs() <= joint.speed_limit);
        }
        state = now;
        reported |= rig.reported(EventCode::ControlLimited);
    }
    assert!(state.limited > 0, "a straight knee is reported");
    assert!(reported, "as an event");
}

/// Feedback path 2: the same motion with the measured joints in the loop.
#[test]
fn the_measured_joints_may_be_the_feedback() {
    let mut rig = Rig::with("stand", |c| (c.feedback, c.drift_gain) = (2, 20.0));
    let plan = rig.plan([0.02, 0.03, -0.06]);
    let mut state = ControllerState::default();
    for _ in 0..2500 {
        state = rig.cycle(Some(&plan)).1;
    }
    assert!((0..3).all(|d| (state.com[d] - state.com_desired[d]).abs() < 1e-4), "{:?}", state.com);
}

/// A plan in which the left foot comes down from 5 cm and steps on something 2 cm high.
#[test]
fn a_foot_that_touches_early_stays_where_it_is_until_it_carries() {
    let mut rig = Rig::new("stand");
    let mut plan = rig.plan([0.0; 3]);
    let [x, y, _, heading] = rig.cycle(None).1.feet[1];
    plan.load_left = Path::resting(0.0, [0.0]);
    plan.feet[1] = Path::resting(0.0, [x, y, 0.0, heading]);
    let at = |z: f64| Sample::rest([x, y, z, heading]);
    assert!(plan.feet[1].push(&at(0.0), &at(0.05), 0.5) && plan.feet[1].push(&at(0.05), &at(0.0), 1.0));
    plan.start_tick = rig.sensors.header.tick + 1;
    let (mut lowest, mut heights) = (f64::INFINITY, Vec::new());
    for _ in 0..1100 {
        let (_, state) = rig.cycle(Some(&plan));
        // A stiff, thin obstacle below the left foot on its way down.
        let down = state.plan_time > 0.5;
        let depth = if down { 0.02 - state.feet[1][2] } else { 0.0 };
        rig.sensors.foot_wrench[1] =
            messages::Wrench { force: [0.0, 0.0, (1e5 * depth).max(0.0)], moment: [0.0; 3] };
        if down {
            lowest = f64::min(lowest, state.feet[1][2]);
            heights.push(state.modification[1][0]);
        }
    }
    assert!(lowest > 0.017, "pressed in by {} m", 0.02 - lowest);
    let kept = heights[heights.len() - 1];
    assert!((0.015..0.025).contains(&kept), "held up by {kept} m");
}

/// Feet in one place have no line between them to shift normal forces along (5.11): nothing blows up.
#[test]
fn feet_together_move_nothing_violently() {
    let mut rig = Rig::new("stand");
    let mut plan = rig.plan([0.0; 3]);
    for foot in &mut plan.feet {
        *foot = Path::resting(0.0, [0.0; 4]);
    }
    for _ in 0..500 {
        let (targets, state) = rig.cycle(Some(&plan));
        assert!(targets.angle.iter().chain(&targets.speed).all(|x| x.is_finite()));
        let wrench = &state.wrench_desired;
        assert!(wrench.iter().all(|w| w.force[2].abs() < 1300.0 && w.moment[0].abs() < 100.0), "{wrench:?}");
    }
}

#[test]
fn without_a_plan_the_joints_hold() {
    let mut rig = Rig::new("crouch");
    let before = rig.sensors.joint_angle;
    for _ in 0..100 {
        let (targets, state) = rig.cycle(None);
        assert_eq!((targets.mode, state.plan_id), (JointMode::Hold as u64, 0));
    }
    assert_eq!(rig.sensors.joint_angle, before);
}

#[test]
fn nan_from_the_sensors_is_bridged_for_a_while_and_then_a_stop() {
    for which in 0..4 {
        let mut rig = Rig::new("stand");
        let plan = rig.plan([0.0, 0.02, 0.0]);
        for _ in 0..50 {
            rig.cycle(Some(&plan));
        }
        let spoil = |s: &mut Sensors| match which {
            0 => s.imu.angular_velocity[1] = f64::NAN,
            1 => s.foot_wrench[0].moment[0] = f64::INFINITY,
            2 => s.imu.orientation = [f64::NAN; 4],
            _ => s.joint_speed[23] = f64::NEG_INFINITY,
        };
        for _ in 0..10 {
            let good = rig.sensors;
            spoil(&mut rig.sensors);
            let (targets, _) = rig.cycle(Some(&plan));
            assert_eq!(targets.mode, JointMode::Track as u64, "case {which}: bridged");
            assert!(targets.angle.iter().chain(&targets.speed).all(|x| x.is_finite()), "case {which}");
            rig.sensors.imu = good.imu;
        }
        let (_, state) = rig.cycle(Some(&plan));
        assert!(
            (0..3).all(|d| (state.com[d] - state.com_desired[d]).abs() < 1e-3),
            "case {which}: recovered"
        );
        let mut mode = 0;
        for _ in 0..30 {
            spoil(&mut rig.sensors);
            let (targets, _) = rig.cycle(Some(&plan));
            assert!(targets.angle.iter().chain(&targets.speed).all(|x| x.is_finite()), "case {which}");
            mode = targets.mode;
        }
        assert_eq!(mode, JointMode::Stop as u64, "case {which}");
    }
}

#[test]
fn falling_and_being_lifted_end_in_a_stop() {
    let mut rig = Rig::new("stand");
    let plan = rig.plan([0.0; 3]);
    rig.cycle(Some(&plan));
    rig.sensors.imu.orientation = [(0.3f64).sin(), 0.0, 0.0, (0.3f64).cos()]; // 0.6 rad of roll
    let (targets, _) = rig.cycle(Some(&plan));
    assert_eq!(targets.mode, JointMode::Stop as u64);
    assert!(rig.reported(EventCode::Fallen));

    let mut rig = Rig::new("stand");
    let plan = rig.plan([0.0; 3]);
    let mut mode = 0;
    for _ in 0..300 {
        let (targets, _) = rig.cycle(Some(&plan));
        rig.sensors.foot_wrench = Sensors::default().foot_wrench;
        mode = targets.mode;
        if mode == JointMode::Stop as u64 {
            break;
        }
    }
    assert_eq!(mode, JointMode::Stop as u64);
    assert!(rig.reported(EventCode::Lifted));
}
