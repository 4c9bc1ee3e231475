//! Records and events that the controller publishes: all of them are written here.

use messages::{
    BodyPoint, ControlLimit, ControllerState, Detail, EventCode, EventQueue, GaitState, JointMode,
    JointTargets, Parameters, Plan, Sensors, StartUp,
};
use std::f64::consts::FRAC_PI_2;

use super::cycle::CycleClock;
use super::joints::JointState;
use crate::contact_force::FootWrench;
use crate::estimate::TaskEstimate;
use crate::force_control::Modification;
use crate::plan_follower::{Desired, PlanFollower};
use crate::watch::{FALLING, SafetyWatch};
use config::gait::StabilizerGains;
use config::parameters::STABILIZER;

/// \[s\] Minimum time between reports of the same limit.
const QUIET: f64 = 1.0;

/// Records and events of one controller.
#[derive(Clone, Default)]
pub(super) struct Telemetry {
    pub(super) targets: JointTargets,
    pub(super) state: ControllerState,
    pub(super) events: EventQueue,
    /// Ticks at which each kind of limit was met last.
    met: [Option<u64>; 3],
}

/// Limits that a cycle met.
#[derive(Clone, Copy)]
pub(super) struct MetLimits {
    /// The task is nearly singular and damped.
    pub(super) damped: bool,
    /// A modification is at its limit.
    pub(super) modification: bool,
    /// Number of joints that are held.
    pub(super) joints: u64,
}

/// Outcome of a cycle that is to be published.
pub(super) struct CycleOutcome<'a> {
    pub(super) plan: &'a PlanFollower,
    /// Joints are led to targets.
    pub(super) leads: bool,
    pub(super) watch: &'a SafetyWatch,
    pub(super) joints: &'a JointState,
    pub(super) modification: &'a Modification,
    /// lambda_d1, if the robot was stabilized.
    pub(super) wrenches: Option<[FootWrench; 2]>,
    /// \[rad\] q_d - q
    pub(super) lag: &'a [f64],
    /// \[m\] Desired centre of gravity.
    pub(super) com: [f64; 3],
    pub(super) now: &'a Desired,
    /// Reference of the measured errors: the plan, or the upright robot before there is one.
    pub(super) reference: &'a Desired,
    pub(super) estimate: &'a TaskEstimate,
    /// \[rad\] Roll and pitch that are taken away from what the IMU reads.
    pub(super) trim: [f64; 2],
    /// \[1\] @I_0 Rise of the ground per metre.
    pub(super) slope: [f64; 2],
    /// \[m, m, rad\] @I_0 Torso as the camera head believes it, less odometry's.
    pub(super) head_offset: [f64; 3],
}

impl Telemetry {
    /// Counts limits. An event where a nearly singular task begins to be damped, a modification or a joint meets its limit,
    /// each once until it was quiet for [`QUIET`].
    pub(super) fn note_limits(&mut self, limits: &MetLimits, clock: &CycleClock) {
        self.state.limited += u64::from(limits.damped) + u64::from(limits.modification) + limits.joints;
        let met = [limits.damped, limits.modification, limits.joints > 0];
        let tick = clock.tick();
        for (i, limit) in ControlLimit::ALL.into_iter().enumerate().filter(|(i, _)| met[*i]) {
            let last = self.met[i].replace(tick);
            let since = |last| tick.saturating_sub(last) as f64 * clock.dt;
            if last.is_none_or(|last| since(last) > QUIET) {
                self.events.push(EventCode::ControlLimited, Detail::Limit(limit));
            }
        }
    }

    /// Writes the records of a cycle.
    pub(super) fn report(&mut self, sensors: &Sensors, clock: &CycleClock, outcome: &CycleOutcome<'_>) {
        let CycleOutcome { plan, watch, joints, now, estimate, .. } = *outcome;
        let t = plan.time(sensors.header.tick, clock.dt);
        self.targets.header = sensors.header;
        self.targets.mode = match (outcome.leads, watch.stopped()) {
            (_, Some(_)) => JointMode::Stop,
            (false, _) => JointMode::Hold,
            _ => JointMode::Track,
        } as u64;
        self.targets.angle = joints.angle;
        self.targets.speed = joints.speed.into();

        // The walk: which plan, where in it, on which feet.
        let gait = gait(sensors, outcome, t);
        let s = &mut self.state;
        s.header = sensors.header;
        s.plan_id = plan.id();
        s.plan_time = t;
        s.gait = gait as u64;
        s.contact = watch.contact().map(u64::from);
        s.phase = [0, 1].map(|foot| plan.plan().phase(foot, t) as u64);
        s.not_standing = u64::from(match StartUp::from_number(sensors.start_up) {
            StartUp::Off => sensors.power == 0,
            _ if matches!(gait, GaitState::Fallen | GaitState::Halted) => true,
            other => !other.stands(),
        });

        // Desired task space, and the measured one beside it.
        let Plan { origin, .. } = plan.plan();
        s.origin = *origin;
        s.com_desired = outcome.com;
        s.feet_desired = now.feet.map(|f| f.position);
        s.zmp_desired = now.zmp;
        s.load_left = now.load[1];
        s.tracking_error.copy_from_slice(outcome.lag);
        estimate.report(outcome.reference, s);
        s.inclination_trim = outcome.trim;
        s.ground_slope = outcome.slope;
        s.head_offset = outcome.head_offset;
        if plan.id() == 0 || plan.plan().leads != BodyPoint::CentreOfGravity as u64 {
            s.dcm_error = [f64::NAN; 2];
        }
        for foot in 0..2 {
            let m = outcome.modification.value.fixed_rows::<3>(3 * foot);
            s.modification[foot] = [m[0], -m[1], m[2]]; // z, s1, s0: s1 is minus roll, s0 is pitch (errata 2.4)
        }
        for (record, w) in s.wrench_desired.iter_mut().zip(outcome.wrenches.iter().flatten()) {
            (record.force, record.moment) = (w.force.into(), w.moment.into());
        }
    }
}

/// Gait state of the robot. None for a robot that has fallen or was stopped.
fn gait(sensors: &Sensors, outcome: &CycleOutcome<'_>, t: f64) -> GaitState {
    let CycleOutcome { plan, watch, estimate, .. } = *outcome;
    // Without a plan nobody watches the inclination; an IMU that says nothing yet is no fall.
    let lies = (0..2).any(|i| (FRAC_PI_2 - estimate.angles[i]).abs() > FALLING);
    match watch.stopped() {
        Some(EventCode::Fallen) => GaitState::Fallen,
        _ if plan.id() == 0 && lies => GaitState::Fallen,
        Some(_) => GaitState::Halted,
        None if StartUp::from_number(sensors.start_up) == StartUp::Stopped => GaitState::Halted,
        None => plan.gait(t),
    }
}

/// Writes the present values of all parameters.
pub(super) fn report_parameters(control: &StabilizerGains, record: &mut Parameters) {
    record.count = STABILIZER.len() as u64;
    for (value, p) in record.values.iter_mut().zip(STABILIZER) {
        *value = p.get(control);
    }
}
