//! Joint loop, watchdog and simulated robot: Archie, who squats without planner and controller or stands up with them, in
//! cycles of 8 ms.

use codec::interpreter::Telegram;
use config::tables::Playback;
use config::{Setup, root};
use controller::Controller;
use controller::table_builder::{Filled, TableBuilder, TableOrder};
use lowlevel::JointLoop;
use lowlevel::joint_loop::LoopState;
use messages::{
    BusFrames, Command, ControllerState, Detail, EventCode, JointMode, JointTables, JointTargets, Joints,
    Plan, Sensors, TableFault, WatchdogReset,
};
use planner::Planner;
use sim_backend::SimBackend;
use watchdog::{Inputs, Watchdog};

pub(crate) const DT: f64 = 0.008;
/// Samples of 320 us from point to point: 80 ms.
pub(crate) const SPACING: u32 = 250;
/// \[rad\] Amplitude of a squat.
const DEEP: f64 = 0.1;

/// Frames of a cycle, bent on their way.
pub(crate) type Bend = Box<dyn FnMut(u64, &mut BusFrames)>;

/// Planner and controller.
pub(crate) struct Walker {
    planner: Planner,
    pub(crate) controller: Controller,
    pub(crate) plan: Option<Box<Plan>>,
    state: Option<ControllerState>,
}

pub(crate) struct Rig {
    /// In place of the squat.
    pub(crate) walker: Option<Walker>,
    pub(crate) setup: Setup,
    pub(crate) joints: JointLoop,
    pub(crate) watchdog: Watchdog,
    pub(crate) sim: SimBackend,
    pub(crate) reset: WatchdogReset,
    pub(crate) answer: BusFrames,
    pub(crate) sensors: Sensors,
    pub(crate) tick: u64,
    pub(crate) mode: JointMode,
    /// Motion of the joints from this cycle on.
    pub(crate) start: u64,
    pub(crate) length: f64,
    pub(crate) to_drives: Option<Bend>,
    pub(crate) from_drives: Option<Bend>,
    pub(crate) events: Vec<(u64, EventCode, Detail)>,
}

impl Rig {
    /// Archie stands under power, and follows targets that do not move.
    pub(crate) fn standing(playback: Playback) -> Self {
        let mut setup = Setup::load(&root(None), "archie_stand").unwrap();
        setup.robot.play_tables().unwrap();
        setup.robot.tables.as_mut().unwrap().playback = playback;
        (setup.scene.depth, setup.scene.substeps, setup.scene.cycle) = (1, 32, DT);
        setup.scene.pushes.clear();
        Self::new(setup)
    }

    /// Archie under power, as the shipped scene has him on type 1, with planner and controller; nobody has commanded anything.
    pub(crate) fn waiting() -> Self {
        let mut setup = Setup::load(&root(None), "archie_tables").unwrap();
        setup.scene.depth = 1;
        let walker = Walker {
            planner: Planner::of(&setup.gait, &setup.robot).unwrap(),
            controller: Controller::new(&setup.robot, &setup.gait, DT).unwrap(),
            plan: None,
            state: None,
        };
        Self::with(setup, Some(walker))
    }

    pub(crate) fn new(setup: Setup) -> Self {
        Self::with(setup, None)
    }

    fn with(setup: Setup, walker: Option<Walker>) -> Self {
        let (robot, scene, system) = (&setup.robot, &setup.scene, &setup.system);
        let mut sim = SimBackend::new(robot, scene).unwrap().with_relay(system.toggle_missed);
        let waits = walker.is_some();
        let mut rig = Self {
            walker,
            joints: JointLoop::new(robot, system, DT),
            watchdog: Watchdog::new(system.watchdog_missed, system.toggle_missed),
            reset: WatchdogReset::default(),
            answer: *sim.step(None, None).0,
            sim,
            sensors: Sensors::default(),
            tick: 0,
            mode: JointMode::Track,
            start: u64::MAX,
            length: 8.0,
            to_drives: None,
            from_drives: None,
            events: Vec::new(),
            setup,
        };
        for tick in 0..80 {
            let command = match tick {
                5 => Some(Command::Reset),
                30 => Some(Command::Enable),
                _ => None,
            };
            rig.cycle_with(command.as_slice());
        }
        let ready = if waits { LoopState::Hold } else { LoopState::Track };
        assert_eq!(rig.joints.state(), ready, "{:?}", rig.events);
        rig.events.clear();
        rig
    }

    /// Angles at `t` \[s\] of a squat that begins and ends at rest, once or for ever.
    pub(crate) fn squat(&self, t: f64, q: &mut Joints) {
        squat(&self.setup, self.length, t, q);
    }

    /// Tables of the squat.
    pub(crate) fn tables(&self, plan: u64, start_tick: u64, points: usize, cyclic: bool) -> Box<JointTables> {
        let mut builder = TableBuilder::new(&self.setup.robot).unwrap();
        assert!(builder.begin(&TableOrder { plan, start_tick, spacing: SPACING, points, cyclic }));
        while builder.fill(|t, q| self.squat(t, q)) != Filled::Complete {}
        let mut tables = Box::new(*builder.tables());
        if !cyclic {
            // At rest for the last two points.
            for of in &mut tables.counts {
                of[points - 1] = of[points - 2];
            }
        }
        tables
    }

    pub(crate) fn lead(&self, points: usize) -> u64 {
        self.setup.robot.tables.as_ref().unwrap().lead(&self.setup.robot.layout, DT, points)
    }

    pub(crate) fn cycle(&mut self) {
        self.cycle_with(&[]);
    }

    pub(crate) fn cycles(&mut self, n: u64) {
        (0..n).for_each(|_| self.cycle());
    }

    pub(crate) fn cycle_with(&mut self, commands: &[Command]) {
        self.tick += 1;
        let tick = self.tick;
        if let Some(bend) = &mut self.from_drives {
            bend(tick, &mut self.answer);
        }
        self.sensors = *self.joints.receive(tick, tick * 8_000_000, Some(&self.answer));
        let targets = self.targets(commands);
        let (frames, reset) = self.joints.send(Some(&targets), None);
        let mut frames = *frames;
        self.reset = *reset;
        let inputs = Inputs { reset: Some(&self.reset), commands, skipped: 0, late: false };
        let power = *self.watchdog.step(&inputs);
        if let Some(bend) = &mut self.to_drives {
            bend(tick, &mut frames);
        }
        let (answer, _) = self.sim.step(Some(&frames), Some(&power));
        self.answer = *answer;
        let joints = self.joints.events().drain().map(|(code, detail)| (tick, code, detail));
        self.events.extend(joints);
        self.events.extend(self.sim.events().drain().map(|(code, detail)| (tick, code, detail)));
    }

    /// Targets: where the joints are to be when the cycle ends.
    fn targets(&mut self, commands: &[Command]) -> JointTargets {
        if let Some(walker) = &mut self.walker {
            let output = walker.planner.step(self.tick, DT, walker.state.as_ref(), commands);
            walker.plan = output.plan.map(|plan| Box::new(*plan)).or(walker.plan.take());
            let (targets, state) = walker.controller.step(&self.sensors, walker.plan.as_deref());
            let (targets, state) = (*targets, *state);
            walker.state = Some(state);
            if let Some(tables) = walker.controller.tables() {
                self.joints.take_tables(tables);
            }
            return targets;
        }
        let mut targets = JointTargets { mode: self.mode as u64, ..JointTargets::default() };
        targets.header.tick = self.tick;
        let t = (self.tick + 1).saturating_sub(self.start) as f64 * DT;
        self.squat(t, &mut targets.angle);
        let mut before = targets.angle;
        self.squat((t - 1e-5).max(0.0), &mut before);
        for j in 0..12 {
            targets.speed[j] = (targets.angle[j] - before[j]) / 1e-5;
        }
        targets
    }

    pub(crate) fn angles(&self) -> Vec<f64> {
        self.sim.state().joint_angle[..12].to_vec()
    }

    pub(crate) fn when(&self, wanted: EventCode) -> Option<u64> {
        self.events.iter().find(|(_, code, _)| *code == wanted).map(|(tick, ..)| *tick)
    }

    pub(crate) fn refusal(&self) -> Option<(usize, usize, TableFault)> {
        self.events.iter().find_map(|(_, _, detail)| match *detail {
            Detail::Table { joint, point, fault } => Some((joint, point, fault)),
            _ => None,
        })
    }
}

pub(crate) fn squat(setup: &Setup, length: f64, t: f64, q: &mut Joints) {
    q[..12].copy_from_slice(&setup.robot.poses["stand"]);
    let a = 0.5 * DEEP * (1.0 - (std::f64::consts::TAU * t / length).cos());
    for (leg, side) in [(0, 1.0), (6, -1.0)] {
        q[leg + 2] -= side * a;
        q[leg + 3] += side * 2.0 * a;
        q[leg + 4] -= side * a;
    }
}

/// Telegrams with these letters among frames.
pub(crate) fn telegrams(frames: &BusFrames, letters: [u8; 2]) -> usize {
    let of = |frame: &&messages::Frame| frame.id >= 0x300 && frame.id < 0x310;
    frames
        .as_slice()
        .iter()
        .filter(of)
        .filter(|f| Telegram::of(f).is_some_and(|t| t.letters == letters))
        .count()
}
