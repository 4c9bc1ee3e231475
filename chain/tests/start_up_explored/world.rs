//! The world that is explored: operator, watchdog, relay, joint loop and drives, one bus cycle at a time.

use std::hash::{DefaultHasher, Hash, Hasher};

use codec::frames::{DriveCommand, decode_targets, encode_sensors};
use drives::cia402::{DriveFault, DriveInputs, DriveState, DriveStateMachine, REFERENCED};
use lowlevel::JointLoop;
use lowlevel::start_up::StartUpTiming;
use messages::{BusFrames, Command, Header, JointMode, JointTargets, Power, Sensors, StartUp, WatchdogReset};
use sim_backend::power::PowerLine;
use watchdog::{Inputs, Supply, Watchdog};

use crate::start_up_explored::robot::{DT, JOINTS, WEIGHT};
use crate::start_up_explored::rules::{Rules, Seen};

/// Cycles of silence after which a drive with torque has a fault, and the relay falls.
const SILENT: u32 = 2;
/// Cycles for which a reset is passed on.
pub(crate) const RESET: u32 = 2;
/// \[rad\] Where the controller wants all joints; without torque they hang at 0.
const WANTED: f64 = 0.1;
/// \[rad\] How much less a joint reads that does not know its angle.
const ORIGIN: f64 = 0.3;
/// \[N\] Both feet on their sensors while they hang.
const HANGS: f64 = -30.0;

/// One thing that happens in a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Happens {
    Nothing,
    Said(&'static [Command]),
    /// The feet are put down, or lifted.
    Crane,
    /// The controller begins or ends to hold the joints instead of leading them.
    Holds,
    /// It wants a controlled stop.
    Stop,
    /// No targets come.
    NoTargets,
    /// The drive of a joint has a fault.
    Fault(usize),
    /// The drive of a joint starts again.
    Restart(usize),
    /// A joint no longer knows its angle.
    Forgets(usize),
    /// A bit of a statusword arrives bent.
    Bent(usize, u16),
    /// The supply bit of a local controller arrives bent.
    SupplyBent(usize),
    /// The frames of a local controller are lost; of both.
    Lost(usize),
    AllLost,
    /// The joint loop stands still.
    Stall,
    /// The relay falls by itself.
    RelayFalls,
}

const COMMANDS: [&[Command]; 6] = [
    &[Command::Reset],
    &[Command::Enable],
    &[Command::Reset, Command::Enable],
    &[Command::EmergencyStop],
    &[Command::Home],
    &[Command::ZeroForce],
];
/// Bits of a statusword that say something.
const BITS: [u16; 7] = [0, 1, 2, 3, 5, 6, 15];

impl Happens {
    /// True for a bit that arrives bent.
    fn bends(self) -> bool {
        matches!(self, Self::Bent(..) | Self::SupplyBent(_))
    }

    /// All of them, with what they cost of the faults that a history may have.
    pub(crate) fn all() -> Vec<(Self, u8)> {
        let mut all = vec![(Self::Nothing, 0), (Self::Crane, 0), (Self::Holds, 0)];
        all.extend(COMMANDS.map(|said| (Self::Said(said), 0)));
        all.extend(
            [Self::Stop, Self::NoTargets, Self::Stall, Self::RelayFalls, Self::AllLost].map(|h| (h, 1)),
        );
        for j in 0..JOINTS {
            all.extend([Self::Fault(j), Self::Restart(j), Self::Forgets(j)].map(|h| (h, 1)));
            all.extend(BITS.map(|bit| (Self::Bent(j, bit), 1)));
        }
        all.extend([0, 1].map(|node| (Self::SupplyBent(node), 1)));
        all.extend([0, 1].map(|node| (Self::Lost(node), 1)));
        all
    }
}

#[derive(Clone)]
pub(crate) struct World {
    now: u64,
    tick: u64,
    joints: JointLoop,
    dog: Watchdog,
    power: Power,
    reset: WatchdogReset,
    relay: PowerLine,
    drives: [DriveStateMachine; JOINTS],
    known: [bool; JOINTS],
    angle: [f64; JOINTS],
    /// The feet carry.
    lowered: bool,
    holds: bool,
    told: DriveCommand,
    /// Cycles since the drives were told anything.
    silent: u32,
    targets: JointTargets,
    /// A bit was bent, and not everything heard as it is since: what is said twice in a row is believed.
    lied: bool,
    /// State of the start-up that the joint loop passed on.
    start_up: u64,
    rules: Rules,
}

impl World {
    /// Without power; the second joint knows its angle or not.
    pub(crate) fn new(known: bool) -> Self {
        let (robot, system) = &*crate::start_up_explored::SMALL;
        let mut drives = [DriveStateMachine::default(); JOINTS];
        drives.iter_mut().for_each(|drive| _ = drive.step(&DriveInputs::default()));
        Self {
            now: 0,
            tick: 0,
            joints: JointLoop::new(robot, system, DT).with_timing(StartUpTiming {
                landed: 2,
                zero: 2,
                reset: RESET,
            }),
            dog: Watchdog::new(SILENT, SILENT).with_timing(1, 2),
            power: Power::default(),
            reset: WatchdogReset::default(),
            relay: PowerLine::falling_after(SILENT),
            drives,
            known: [true, known, true],
            angle: [0.0; JOINTS],
            lowered: false,
            holds: false,
            told: DriveCommand::default(),
            silent: 0,
            targets: JointTargets::default(),
            lied: false,
            start_up: 0,
            rules: Rules::default(),
        }
    }

    /// Frames from the local controllers.
    fn frames(&self, happens: Happens) -> Option<BusFrames> {
        let header = Header { tick: self.tick, stamp_ns: 0, epoch: 0 };
        let mut said = Sensors { header, power: u64::from(self.relay.is_closed()), ..Sensors::default() };
        for j in 0..JOINTS {
            let referenced = if self.known[j] { REFERENCED } else { 0 };
            let bent = match happens {
                Happens::Bent(k, bit) if k == j => 1 << bit,
                _ => 0,
            };
            said.drive_status[j] = u32::from((self.drives[j].statusword() | referenced) ^ bent);
            said.drive_error[j] = self.drives[j].error().map_or(0, |fault| fault as u32);
            said.joint_angle[j] = self.angle[j] - if self.known[j] { 0.0 } else { ORIGIN };
        }
        for wrench in &mut said.foot_wrench {
            wrench.force[2] = 0.5 * (HANGS + if self.lowered { WEIGHT } else { 0.0 });
        }
        let layout = &crate::start_up_explored::SMALL.0.layout;
        let mut frames = BusFrames::default();
        encode_sensors(layout, &said, &mut frames);
        let all = frames;
        if let Happens::SupplyBent(node) = happens {
            // The bit after the counter.
            let mut own = frames.frames[..frames.count as usize].iter_mut().filter(|f| f.line == node as u32);
            own.next().unwrap().data[1] ^= 1;
        }
        if let Happens::Lost(node) = happens {
            frames.count = 0;
            all.as_slice().iter().filter(|f| f.line != node as u32).for_each(|f| _ = frames.push(f));
        }
        (happens != Happens::AllLost).then_some(frames)
    }

    /// Joint loop: what it reads, and what it tells the drives.
    fn run_joints(&mut self, happens: Happens, commands: &[Command]) -> Seen {
        let frames = self.frames(happens);
        let sensors = self.joints.receive(self.tick, self.now * (DT * 1e9) as u64, frames.as_ref());
        self.start_up = sensors.start_up;
        for command in commands {
            if matches!(command, Command::Reset | Command::Home | Command::ZeroForce) {
                _ = self.joints.command(command);
            }
        }
        if happens != Happens::NoTargets {
            let mode = match (happens, self.holds) {
                (Happens::Stop, _) => JointMode::Stop,
                (_, true) => JointMode::Hold,
                _ => JointMode::Track,
            };
            self.targets = JointTargets { mode: mode as u64, ..JointTargets::default() };
            self.targets.header.tick = self.tick;
            self.targets.angle[..JOINTS].fill(WANTED);
        }
        let before = self.joints.state();
        let (frames, reset) = self.joints.send(Some(&self.targets), None);
        self.reset = WatchdogReset { header: self.reset.header, ..*reset };
        self.reset.header.tick = self.tick;
        decode_targets(&crate::start_up_explored::SMALL.0.layout, frames, &mut self.told);
        self.joints.events().drain().for_each(drop);
        Seen {
            happens,
            before,
            after: self.joints.state(),
            start_up: self.start_up,
            powered: self.relay.is_closed(),
            on: self.drives.map(|drive| drive.state() == DriveState::OperationEnabled),
            torque: self.drives.map(|drive| drive.drives()),
            known: self.known,
            carried: self.lowered,
            home: self.told.targets.mode == JointMode::Home as u64,
            control: std::array::from_fn(|j| self.told.control[j] as u16),
        }
    }

    /// True if this may happen now.
    pub(crate) fn may(&self, happens: Happens) -> bool {
        !self.lied || !happens.bends()
    }

    /// One bus cycle; what the rules have against it.
    pub(crate) fn step(&mut self, happens: Happens) -> Result<(), &'static str> {
        self.now += 1;
        let commands: &[Command] = if let Happens::Said(said) = happens { said } else { &[] };
        match happens {
            Happens::Crane => self.lowered ^= true,
            Happens::Holds => self.holds ^= true,
            Happens::Forgets(j) => self.known[j] = false,
            Happens::Restart(j) => {
                self.drives[j] = DriveStateMachine::default();
                self.drives[j].step(&DriveInputs::default());
            }
            _ => {}
        }
        let runs = happens != Happens::Stall;
        self.rules.hear(commands);
        if runs {
            self.tick += 1;
            let seen = self.run_joints(happens, commands);
            self.rules.judge(&seen)?;
            let partly = matches!(happens, Happens::Lost(_) | Happens::AllLost);
            self.lied = happens.bends() || partly && self.lied;
        }
        self.silent = if runs { 0 } else { self.silent + 1 };
        // Supply, then drives.
        self.power = *self.dog.step(&Inputs { reset: Some(&self.reset), commands, ..Inputs::default() });
        let told = (happens != Happens::RelayFalls).then_some(&self.power);
        let closed = self.relay.step(told);
        self.rules.relay(closed);
        self.run_drives(happens, runs, closed)
    }

    fn run_drives(&mut self, happens: Happens, told: bool, supply: bool) -> Result<(), &'static str> {
        let home = self.told.targets.mode == JointMode::Home as u64;
        for j in 0..JOINTS {
            let drive = &mut self.drives[j];
            let silent = drive.drives() && self.silent > SILENT;
            let hot = (happens == Happens::Fault(j)).then_some(DriveFault::OverTemperature);
            let before = drive.error();
            drive.step(&DriveInputs {
                control: told.then_some(self.told.control[j] as u16),
                supply,
                permit: home || self.known[j],
                fault: hot.or(silent.then_some(DriveFault::Heartbeat)),
                still: true,
            });
            if before.is_some() && drive.error().is_none() && happens != Happens::Restart(j) {
                self.rules.forgets_fault()?;
            }
            if !drive.drives() {
                self.angle[j] = 0.0;
            } else if drive.state() == DriveState::OperationEnabled {
                if home && !self.known[j] {
                    self.rules.searches()?;
                    self.known[j] = true;
                } else if told && !home && self.known[j] {
                    let goal = self.told.targets.angle[j];
                    if (goal - self.angle[j]).abs() > 1e-3 {
                        self.rules.moves()?;
                    }
                    self.angle[j] = goal;
                }
            }
        }
        Ok(())
    }

    /// All that decides what can happen next, with numbers counted from each other.
    pub(crate) fn key(&self) -> u64 {
        let mut h = DefaultHasher::new();
        self.joints.hash_state(&mut h);
        // For which reason the supply is off makes no difference, but none is one.
        let mut dog = self.dog.state();
        if matches!(dog.supply, Supply::Off(reason) if reason != messages::EventCode::None) {
            dog.supply = Supply::Off(messages::EventCode::SafeStop);
        }
        let seen = dog.seen.map(|(_, tick)| tick == self.reset.header.tick);
        (dog.supply, seen, dog.reset_pause, dog.enable_pause, dog.closing.map(|n| n.min(4))).hash(&mut h);
        (dog.missed, self.reset.supply, self.reset.trip != 0, self.power.on).hash(&mut h);
        let (quiet, toggle, (epoch, arming)) = self.relay.state();
        let newer = (self.power.header.epoch, self.power.arming).cmp(&(epoch, arming));
        (quiet, toggle == self.power.toggle, newer, self.relay.is_closed()).hash(&mut h);
        for (j, drive) in self.drives.iter().enumerate() {
            let control = self.told.control[j];
            (drive.state() as u8, drive.error().map(|f| f as u16), control).hash(&mut h);
            (self.known[j], self.angle[j].to_bits()).hash(&mut h);
            self.told.targets.angle[j].to_bits().hash(&mut h);
        }
        (
            self.lied,
            self.lowered,
            self.holds,
            self.silent.min(SILENT + 1),
            self.told.targets.mode,
            self.targets.mode,
        )
            .hash(&mut h);
        self.rules.hash(&mut h);
        h.finish()
    }

    /// State of the start-up, as the joint loop told it last.
    pub(crate) fn start_up(&self) -> StartUp {
        StartUp::from_number(self.start_up)
    }

    /// Joints that are where the controller wants them.
    pub(crate) fn led(&self) -> usize {
        self.angle.iter().filter(|angle| (**angle - WANTED).abs() < 1e-6).count()
    }

    /// In words, for a message.
    pub(crate) fn show(&self) -> String {
        let drives = self.drives.map(|drive| drive.state());
        format!("{:?}, {:?}, drives {drives:?}, {:?}", self.joints.state(), self.start_up(), self.rules)
    }
}
