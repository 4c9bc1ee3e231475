//! Course of a run to its end: pure, time is an argument.
//!
//! ```text
//! first Ctrl-C ──► walk/stop over the broker ──► it stands ──► end
//!                      │ not passed on within 0.5 s
//!                      └──► the planner is ended: its plan is walked to its end, standing ──► end
//!                           in lockstep, within 3 s ──► end
//! second Ctrl-C ─► emergency stop on its own line ──► end
//! death or hang ─► aftermath for the log ──► end
//! ```

use ipc::Mode;
use messages::Process;
use realtime::clock::SECOND;

/// Timeout for the broker to pass a stop on.
const BROKER_PATIENCE: u64 = SECOND / 2;
/// The same in lockstep, where nothing is walked to its end without a planner: a broker that was only stopped gets its time.
const LOCKSTEP_BROKER_PATIENCE: u64 = 3 * SECOND;
/// After a first request to end the robot gets this long to come to a stand: in lockstep by its own time too, which may be slower.
const STAND_PATIENCE: u64 = 8 * SECOND;
/// After the death of a process of the chain the run goes on this long, so that the log shows what the robot did.
const AFTERMATH: u64 = 3 * SECOND;
/// After the death of the planner: its last plan is walked to its end, up to seven steps and the time to come to rest.
const LAST_PLAN: u64 = 12 * SECOND;

/// Observation of one check.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CourseObservation {
    /// Somebody asked for the end since the last look.
    pub(super) asked: bool,
    /// The broker has passed the stop on.
    pub(super) passed: bool,
    /// The robot stands.
    pub(super) stands: bool,
    /// Time of the robot \[ns\].
    pub(super) robot_time: u64,
    /// The joint loop has done the scene.
    pub(super) finished: bool,
}

/// Actions to take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Act {
    /// Nothing.
    GoOn,
    /// Ask the robot to stand, over the broker.
    Stand,
    /// End the planner: the stop did not get through.
    EndPlanner,
    /// Emergency stop, then the end.
    EmergencyStop,
    /// End all processes.
    Finish,
}

/// The way of a run to its end.
#[derive(Clone, Debug)]
pub(super) struct Course {
    mode: Mode,
    /// When somebody asked for the end, by the clock and by the robot's time \[ns\].
    asked_at: Option<(u64, u64)>,
    passed: bool,
    planner_ended: bool,
    end_at: Option<u64>,
}

impl Course {
    pub(super) fn new(mode: Mode) -> Self {
        Self { mode, asked_at: None, passed: false, planner_ended: false, end_at: None }
    }

    /// Whether somebody asked for the end.
    pub(super) fn asked(&self) -> bool {
        self.asked_at.is_some()
    }

    /// Whether the end is near, so that a process that ends as asked is no death.
    pub(super) fn is_ending(&self, process: Process) -> bool {
        self.end_at.is_some() || self.planner_ended && process == Process::Planner
    }

    /// A process of the chain was lost; broker and logger are started again, and the run goes on.
    pub(super) fn lost(&mut self, process: Process, now: u64) {
        if matches!(process, Process::Broker | Process::Logger) {
            return;
        }
        let aftermath = if process == Process::Planner { LAST_PLAN } else { AFTERMATH };
        // What is worse shortens what was granted before: nobody stabilizes the rest of a plan without a controller.
        let end = now + aftermath;
        self.end_at = Some(self.end_at.map_or(end, |before| before.min(end)));
    }

    /// One look.
    pub(super) fn step(&mut self, now: u64, seen: CourseObservation) -> Act {
        self.passed |= seen.passed;
        if seen.asked && self.asked() {
            return Act::EmergencyStop;
        }
        if seen.finished || self.end_at.is_some_and(|end| now > end) {
            return Act::Finish;
        }
        if seen.asked {
            self.asked_at = Some((now, seen.robot_time));
            return Act::Stand;
        }
        let Some((asked, asked_of_robot)) = self.asked_at else { return Act::GoOn };
        let lockstep = self.mode == Mode::Lockstep;
        let patience = if self.planner_ended { LAST_PLAN } else { STAND_PATIENCE };
        let slower = lockstep && seen.robot_time <= asked_of_robot + patience;
        if seen.stands || now > asked + patience && !slower {
            return Act::Finish;
        }
        let patience = if lockstep { LOCKSTEP_BROKER_PATIENCE } else { BROKER_PATIENCE };
        if !self.passed && !self.planner_ended && now > asked + patience {
            // In lockstep everybody waits for the planner: nothing would be walked to its end.
            self.planner_ended = true;
            return if lockstep { Act::Finish } else { Act::EndPlanner };
        }
        Act::GoOn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: CourseObservation =
        CourseObservation { asked: false, passed: false, stands: false, finished: false, robot_time: 0 };
    const ASKED: CourseObservation = CourseObservation { asked: true, ..NOTHING };

    fn asked() -> Course {
        asked_in(Mode::RealTime)
    }

    fn asked_in(mode: Mode) -> Course {
        let mut course = Course::new(mode);
        assert_eq!(course.step(0, NOTHING), Act::GoOn);
        assert_eq!(course.step(1, ASKED), Act::Stand);
        course
    }

    #[test]
    fn a_stop_that_the_broker_passes_on_ends_with_the_stand() {
        let mut course = asked();
        assert_eq!(course.step(2, CourseObservation { passed: true, ..NOTHING }), Act::GoOn);
        assert_eq!(course.step(2 * SECOND, NOTHING), Act::GoOn);
        assert_eq!(course.step(3 * SECOND, CourseObservation { stands: true, ..NOTHING }), Act::Finish);
    }

    /// With the broker dead the robot walked on for 8.6 s.
    #[test]
    fn a_stop_that_nobody_passes_on_ends_the_planner() {
        let mut course = asked();
        assert_eq!(course.step(SECOND / 2, NOTHING), Act::GoOn);
        assert_eq!(course.step(SECOND / 2 + 2, NOTHING), Act::EndPlanner);
        assert!(course.is_ending(Process::Planner) && !course.is_ending(Process::Controller));
        assert_eq!(course.step(10 * SECOND, NOTHING), Act::GoOn, "its plan is walked to its end");
        assert_eq!(course.step(13 * SECOND, NOTHING), Act::Finish);
    }

    /// With a broker that was stopped for a second, or on a machine a third as fast, the supply went off while she walked.
    #[test]
    fn in_lockstep_a_slow_robot_comes_to_a_stand_and_a_stopped_broker_passes_the_stop_on() {
        let mut course = asked_in(Mode::Lockstep);
        assert_eq!(course.step(SECOND, NOTHING), Act::GoOn);
        for s in 1..24 {
            let seen = CourseObservation { passed: true, robot_time: s * SECOND / 3, ..NOTHING };
            assert_eq!(course.step(s * SECOND, seen), Act::GoOn, "{s} s");
        }
        let seen = CourseObservation { robot_time: 9 * SECOND, ..NOTHING };
        assert_eq!(course.step(27 * SECOND, seen), Act::Finish, "she does not stand");
        // One that is faster than the clock gets no less.
        let mut course = asked_in(Mode::Lockstep);
        let seen = CourseObservation { passed: true, robot_time: 100 * SECOND, ..NOTHING };
        assert_eq!(course.step(5 * SECOND, seen), Act::GoOn);
        assert_eq!(asked_in(Mode::Lockstep).step(4 * SECOND, NOTHING), Act::Finish, "nobody passes it on");
    }

    #[test]
    fn a_second_request_is_an_emergency_stop_at_any_time() {
        for now in [2, SECOND, 7 * SECOND, 20 * SECOND] {
            assert_eq!(asked().step(now, ASKED), Act::EmergencyStop);
        }
    }

    #[test]
    fn a_loss_ends_the_run_and_a_worse_one_ends_it_sooner() {
        let mut course = Course::new(Mode::RealTime);
        course.lost(Process::Broker, 0);
        assert_eq!(course.step(100 * SECOND, NOTHING), Act::GoOn);
        course.lost(Process::Planner, 100 * SECOND);
        assert_eq!(course.step(111 * SECOND, NOTHING), Act::GoOn);
        course.lost(Process::Controller, 101 * SECOND);
        assert_eq!(course.step(105 * SECOND, NOTHING), Act::Finish);
    }
}
