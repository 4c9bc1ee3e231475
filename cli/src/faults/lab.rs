//! Inputs and findings of every scenario.

use config::Setup;
use harness::Site;
use messages::Process;

use super::robot::RobotUnderTest;
use super::scene::WALK;

/// \[s\] Simulated time between which a walking robot is hurt: two strides.
const WALKS: [f64; 2] = [3.6, 5.2];

/// Pseudo-random numbers: the same of the same seed.
#[derive(Clone, Debug)]
pub(super) struct Random(pub(super) u64);

impl Random {
    /// In \[0, 1).
    pub(super) fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1u64 << 31) as f64
    }

    /// Between two numbers.
    pub(super) fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.share()
    }

    /// One of these.
    pub(super) fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[((all.len() as f64 * self.share()) as usize).min(all.len() - 1)]
    }
}

/// Observations of one fault.
#[derive(Clone, Debug, Default)]
pub(super) struct FaultObservation {
    pub(super) fault: &'static str,
    /// Observed behaviour.
    pub(super) reaction: String,
    /// From fault to reaction, in bus cycles and \[ms\].
    pub(super) cycles: Option<u64>,
    pub(super) ms: Option<f64>,
    /// Unmet part of the expectation.
    pub(super) unmet: Vec<String>,
}

impl FaultObservation {
    pub(super) fn new(fault: &'static str, reaction: impl Into<String>) -> Self {
        Self { fault, reaction: reaction.into(), ..Self::default() }
    }

    /// The reaction came after so many bus cycles.
    pub(super) fn after(mut self, cycles: Option<u64>, robot: &RobotUnderTest) -> Self {
        self.cycles = cycles;
        self.ms = cycles.map(|n| n as f64 * robot.setup.scene.cycle * 1e3);
        self
    }

    /// The reaction came after so much wall time \[ms\].
    pub(super) fn after_ms(mut self, ms: f64) -> Self {
        self.ms = Some(ms);
        self
    }

    /// It is demanded that the reaction came within so many cycles.
    pub(super) fn within(self, most: u64) -> Self {
        let met = self.cycles.is_some_and(|n| n <= most);
        self.demand(met, format!("within {most} cycles"))
    }

    pub(super) fn demand(mut self, met: bool, what: impl Into<String>) -> Self {
        if !met {
            self.unmet.push(what.into());
        }
        self
    }

    /// It is demanded that the robot walks on.
    pub(super) fn walks(mut self, robot: &RobotUnderTest) -> Self {
        self.unmet.extend(robot.walks_on().map(str::to_owned));
        self
    }
}

/// Finding of a scenario, and the disturbance from outside that spoilt it, if any.
pub(super) type Found = Result<(Vec<FaultObservation>, Option<String>), String>;

/// The laboratory.
pub(super) struct Lab {
    pub(super) exe: String,
    pub(super) random: Random,
}

impl Lab {
    /// A place whose watchdog bears a machine that is shared with others.
    pub(super) fn patient(&self) -> Site {
        Site::patient(&self.exe)
    }

    /// An instant of the walk \[s\].
    pub(super) fn instant(&mut self) -> f64 {
        self.random.between(WALKS)
    }

    /// A robot that walks, at the instant of the fault.
    pub(super) fn walking(&mut self, site: Site, more: &[&str]) -> Result<RobotUnderTest, String> {
        let at = self.instant();
        let mut robot = RobotUnderTest::start(site, WALK, more)?;
        robot.until(at)?;
        robot.mark();
        Ok(robot)
    }

    /// A robot that walks and whose process is killed in mid-stride.
    pub(super) fn killed(
        &mut self,
        site: Site,
        victim: Process,
        signal: harness::Signal,
    ) -> Result<RobotUnderTest, String> {
        let robot = self.walking(site, &["--no-log"])?;
        robot.run.signal(victim, signal);
        Ok(robot)
    }
}

/// Limits from the robot's configuration.
pub(super) fn limits(setup: &Setup) -> (u64, u64) {
    (u64::from(setup.system.watchdog_missed), u64::from(setup.system.targets_missed))
}
