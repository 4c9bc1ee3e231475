//! Lola's gait in code, and a controller that follows every plan perfectly.

pub(crate) mod checks;
pub(crate) mod feasible;

use config::gait::{CogMethod, CommandLimits, Gait, GaitModel, Obstacles, StabilizerGains, StepSettings};
use messages::{Command, ControllerState, Detail, EventCode, Plan, Record};
use planner::Planner;
use realtime::clock;

/// One cycle \[s\].
pub(crate) const CYCLE: f64 = 1e-3;
/// Support rectangles of Lola's feet: the sole frame lies in the middle of the toe segment.
pub(crate) const SUPPORT: [[f64; 4]; 2] = [[-0.26, 0.04, -0.05, 0.05]; 2];

/// Ranges of Lola's toe joints.
pub(crate) const TOES: [Option<[f64; 2]>; 2] = [Some([-0.7767, 0.1623]), Some([-0.1885, 0.7645])];

pub(crate) fn gait() -> Gait {
    Gait {
        arm_swing: None,
        reaction: None,
        pattern: None,
        step: StepSettings {
            width: 0.21,
            width_min: 0.16,
            swing_height: 0.05,
            double_support: 0.2,
            start_time: 0.9,
            swing_lag: 0.05,
            swing_lead: 0.05,
            first_length: 0.3,
            change: [0.12, 0.1, 0.1],
            change_duration: 0.1,
            by_speed: vec![
                [0.0, 0.0, 1.2],
                [1.0 / 3.6, 0.34, 0.34 * 3.6],
                [2.0 / 3.6, 0.50, 0.9],
                [3.0 / 3.6, 0.58, 0.58 * 3.6 / 3.0],
            ],
        },
        model: GaitModel {
            com_height: 0.80,
            com_forward: -0.10,
            leg_mass: 0.082,
            leg_height: 0.10,
            zmp_margin: 0.02,
            cog_method: CogMethod::Collocation,
            spacing: 0.08,
            friction: 0.5,
        },
        limits: CommandLimits {
            length: [-0.2, 0.66],
            side: [-0.2, 0.2],
            turn: [-0.35, 0.35],
            duration: [0.65, 1.3],
            side_duration: 0.65,
        },
        obstacles: Some(Obstacles {
            distance: 0.04,
            clearance: 0.03,
            height: 0.16,
            length: 0.52,
            tilt: 0.4,
            duration: 1.2,
        }),
        control: StabilizerGains {
            inclination_p: [0.0; 2],
            inclination_d: [0.0; 2],
            height_p: 0.0,
            height_d: 0.0,
            force_shift: 1.0,
            force_gain: [0.0; 3],
            force_feed_forward: 0.0,
            force_blend: [5.0, 50.0],
            position_gain: 0.0,
            modification_limit: [0.0; 3],
            modification_rate: [0.0; 3],
            drift_gain: 0.0,
            inclination_compensation: 0.0,
            planned_deformation: 0.0,
            feedback: 1,
            force_filter: 0.0,
        },
        toes: None,
        heel_strike: None,
    }
}

/// Numbers that are the same in every run.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self((seed + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn range(&mut self, [lo, hi]: [f64; 2]) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    pub(crate) fn below(&mut self, n: u64) -> u64 {
        (self.unit() * n as f64) as u64
    }
}

/// Planner and perfect controller.
pub(crate) struct Robot {
    pub(crate) planner: Planner,
    /// \[s\]
    pub(crate) cycle: f64,
    /// \[us\] What the planner took for its last cycle.
    pub(crate) took: f64,
    pub(crate) tick: u64,
    pub(crate) state: ControllerState,
    pub(crate) active: Box<Plan>,
    pub(crate) next: Option<Box<Plan>>,
    pub(crate) plans: Vec<Box<Plan>>,
    pub(crate) events: Vec<(u64, EventCode, Detail)>,
    /// \[m\] Height over the planning frame below which a sole touches something; it goes no deeper.
    pub(crate) ground: f64,
}

impl Robot {
    /// Hanging over the ground in a pose that is not the walking pose.
    pub(crate) fn new(gait: &Gait) -> Self {
        Self::with_cycle(gait, CYCLE)
    }

    /// The same, with cycles of another length \[s\].
    pub(crate) fn with_cycle(gait: &Gait, cycle: f64) -> Self {
        let mut state = ControllerState::empty();
        state.com = [-0.06, 0.01, 0.85];
        state.feet = [[0.0, -0.1, 0.0, 0.0], [0.01, 0.105, 0.0, 0.0]];
        Self {
            planner: Planner::new(gait, SUPPORT).with_toes(TOES),
            cycle,
            took: 0.0,
            tick: 0,
            state,
            active: Box::new(Plan::empty()),
            next: None,
            plans: Vec::new(),
            events: Vec::new(),
            ground: 0.0,
        }
    }

    /// One cycle.
    pub(crate) fn step(&mut self, commands: &[Command]) {
        self.tick += 1;
        let start = clock::now();
        let out = self.planner.step(self.tick, self.cycle, Some(&self.state), commands);
        self.took = (clock::now() - start) as f64 * 1e-3;
        let tick = self.tick;
        self.events.extend(out.events.drain().map(|(code, detail)| (tick, code, detail)));
        if let Some(plan) = out.plan {
            assert!(plan.start_tick > tick, "a plan from the past");
            self.next = Some(Box::new(*plan));
            self.plans.push(Box::new(*plan));
        }
        if self.next.as_ref().is_some_and(|n| n.start_tick == tick) {
            self.active = self.next.take().expect("just seen");
        }
        self.follow();
    }

    /// Samples the active plan at the present tick.
    fn follow(&mut self) {
        self.state.header.tick = self.tick;
        if self.active.id == 0 {
            return;
        }
        let t = self.time();
        self.state.plan_id = self.active.id;
        self.state.plan_time = t;
        self.state.gait = self.active.state;
        self.state.origin = self.active.origin;
        self.state.com = self.active.body.sample(t).position;
        self.state.feet = [0, 1].map(|i| self.active.feet[i].sample(t).position);
        self.state.phase = [0, 1].map(|i| self.active.phase(i, t) as u64);
        self.state.contact = [0, 1].map(|i| u64::from(self.state.feet[i][2] < self.ground));
    }

    /// Time in the active plan \[s\].
    pub(crate) fn time(&self) -> f64 {
        (self.tick - self.active.start_tick) as f64 * self.cycle
    }

    /// Runs for some time \[s\].
    pub(crate) fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / self.cycle) as u64 {
            self.step(&[]);
        }
    }

    /// Takes the walking pose.
    pub(crate) fn stand(&mut self) {
        self.step(&[Command::Stand]);
        self.run(2.5);
    }
}
