//! Master of drives that play tables: from a record of the controller to twelve drives that begin with one SYNC.
//!
//! ```text
//!  Idle ──new tables──► Checking ──► Loading ──► Loaded ──BEGIN_AHEAD cycles before──► Arming ──► Armed ──SYNC──► playing
//!   ▲                       │           │           │                                    │
//!   └──────── refused ◄─────┴───────────┴───────────┘        Disarming ◄── one drive did not answer
//! ```
//!
//! Points are checked some each cycle; only then the first byte goes out. Every answer has to be the echo of its command; a
//! wrong, late or missing one ends it all, and nothing has moved. `BG` names the SYNC to begin with; a drive that does not
//! echo it makes all of them take it back (`PT`). New tables are written beside the running ones and taken over at one of
//! their points. Drives that are no longer led are stopped by `ST`; they brake on their own ramps.

use codec::interpreter::{BG, MP, PT, QP, SAMPLING, ST, Telegram, WS};
use codec::network::{NetworkCommand, NetworkState};
use config::tables::{BEGIN_AHEAD, POINTS_CHECKED, REGISTERS};
use config::{Robot, TableDrives};
use messages::{BusFrames, Detail, EventCode, EventQueue, Frame, JointTables, MAX_JOINTS, TableFault};

use crate::table_admission::{PlacedTables, admit_point, admit_whole, beginning, elsewhere, fault, place};
use crate::telegram_exchange::{TelegramExchange, WrongAnswer};

/// State of the tables to come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableState {
    /// None.
    Idle,
    /// So many points were found good.
    Checking(usize),
    /// They are written into the drives.
    Loading,
    /// The drives have them.
    Loaded,
    /// The drives are told when to begin.
    Arming,
    /// All drives will begin.
    Armed,
    /// The drives are told not to begin.
    Disarming,
    /// The drives are told to stop.
    Stopping,
}

/// What the joint loop knows in a cycle.
pub(crate) struct TableCycle<'a> {
    /// Number of the cycle.
    pub(crate) tick: u64,
    /// True while the motor supply is on.
    pub(crate) powered: bool,
    /// True if all joints are led by targets.
    pub(crate) led: bool,
    /// Angle \[rad\] and speed \[rad/s\] that each joint was led to last.
    pub(crate) setpoint: &'a dyn Fn(usize) -> (f64, f64),
}

/// The master.
#[derive(Clone)]
pub(crate) struct TableMaster {
    robot: Robot,
    drives: TableDrives,
    /// \[rad\] One count of each joint.
    units: [f64; MAX_JOINTS],
    /// \[1\] Samples of the drives in a bus cycle.
    samples: f64,
    state: TableState,
    exchange: TelegramExchange,
    /// Tables to come, and the speeds \[count/T\] with which they begin.
    next: PlacedTables,
    begin: [f64; MAX_JOINTS],
    /// Tables that wait until those to come have begun.
    waiting: Option<Box<JointTables>>,
    room: Option<Box<JointTables>>,
    /// Tables that are played.
    running: PlacedTables,
    runs: bool,
    /// Plan of the newest tables.
    newest: u64,
    /// Cycles since loading began.
    cycles: u64,
    /// Tables were refused, and who leads the joints does not know.
    refused: bool,
    /// Controlword and mode that each drive was sent last.
    sent: [(u32, u64); MAX_JOINTS],
    /// State of each drive by its last heartbeat.
    network: [NetworkState; MAX_JOINTS],
    events: EventQueue,
}

impl TableMaster {
    /// Of a robot whose drives play tables, with a bus cycle of `dt` \[s\].
    pub(crate) fn new(robot: &Robot, dt: f64) -> Option<Self> {
        let drives = robot.tables.clone()?;
        let joints = robot.joints.len();
        Some(Self {
            units: std::array::from_fn(|j| robot.layout.count(j).unwrap_or(f64::NAN)),
            samples: drives.samples(dt),
            exchange: TelegramExchange::new(&robot.layout, joints, dt),
            robot: robot.clone(),
            drives,
            state: TableState::Idle,
            next: PlacedTables::empty(),
            begin: [0.0; MAX_JOINTS],
            waiting: None,
            room: Some(Box::default()),
            running: PlacedTables::empty(),
            runs: false,
            newest: 0,
            cycles: 0,
            refused: false,
            sent: [(u32::MAX, 0); MAX_JOINTS],
            network: [NetworkState::Operational; MAX_JOINTS],
            events: EventQueue::default(),
        })
    }

    /// Where the tables to come are.
    pub(crate) fn state(&self) -> TableState {
        self.state
    }

    /// Events that were not taken yet.
    pub(crate) fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// True if tables were refused since the joints were led last: drives and targets will part.
    pub(crate) fn refused(&self) -> bool {
        self.refused
    }

    /// Takes tables of a plan that is newer than the last one; they wait while others are being brought.
    pub(crate) fn take(&mut self, tables: &JointTables) {
        if tables.plan <= self.newest {
            return;
        }
        self.newest = tables.plan;
        let room = self.waiting.take().or_else(|| self.room.take());
        if let Some(mut room) = room {
            *room = *tables;
            self.waiting = Some(room);
        }
    }

    /// Answers of the drives in this cycle.
    pub(crate) fn receive(&mut self, frames: Option<&BusFrames>) {
        self.hear_heartbeats(frames);
        let Self { exchange, next, state, drives, .. } = self;
        let patient = matches!(state, TableState::Disarming | TableState::Stopping);
        let wrong = exchange.receive(frames, patient, |j, i| {
            let command = command(*state, next, j, i);
            if command.letters == WS { command.answer(drives.sampling_us as i32) } else { command }
        });
        let Some((j, i, wrong)) = wrong else { return };
        let points = next.tables.points as usize;
        let point = if *state == TableState::Loading && (1..=points).contains(&i) { i } else { 0 };
        let what = match (*state, wrong) {
            (TableState::Arming, _) => TableFault::NotArmed,
            (_, WrongAnswer::Missing) => TableFault::NoAnswer,
            (TableState::Loading, _) if i == 0 => TableFault::Sampling,
            _ => TableFault::WrongAnswer,
        };
        self.refuse(fault(j, point, what));
    }

    /// Takes heartbeats: a drive that is no longer operational plays nothing.
    fn hear_heartbeats(&mut self, frames: Option<&BusFrames>) {
        let layout = &self.robot.layout;
        let mut lost = None;
        for frame in frames.map(BusFrames::as_slice).unwrap_or_default() {
            let message = layout.find(frame.line, frame.id).map(|i| &layout.messages[i]);
            let joint = message.filter(|m| m.len == frame.len).and_then(|m| m.heartbeat());
            let Some((j, state)) = joint.zip(NetworkState::of(frame.data[0])) else { continue };
            let before = std::mem::replace(&mut self.network[j], state);
            if before == NetworkState::Operational && state != before {
                lost = lost.or(Some(j));
            }
        }
        if let Some(j) = lost {
            self.refuse(fault(j, 0, TableFault::Restarted));
        }
    }

    /// Command to all drives of the network: those that are not operational are started.
    pub(crate) fn network_command(&self) -> Option<NetworkCommand> {
        let waits = self.network.iter().any(|state| *state != NetworkState::Operational);
        waits.then_some(NetworkCommand::Start)
    }

    /// One cycle: what is sent to the interpreters in it is in [`Self::telegrams`].
    pub(crate) fn step(&mut self, cycle: &TableCycle<'_>) {
        self.refused &= cycle.led;
        if !cycle.powered {
            return self.forget();
        }
        self.runs = self.runs && self.running.point_at(cycle.tick, self.samples) != Ok(None);
        // Drives that are no longer led stop playing, and do not begin to.
        let begins = matches!(self.state, TableState::Arming | TableState::Armed | TableState::Disarming);
        if !cycle.led && (self.runs || begins) && self.state != TableState::Stopping {
            self.runs = false;
            self.enter(TableState::Stopping, 1);
        }
        self.cycles += 1;
        let start = self.next.tables.start_tick;
        match self.state {
            TableState::Idle => self.begin_next(),
            TableState::Checking(from) => self.check(from),
            TableState::Loading if self.exchange.is_done() => {
                self.events.push(EventCode::TablesLoaded, Detail::Cycles(self.cycles));
                self.enter(TableState::Loaded, 0);
            }
            TableState::Loaded if cycle.tick + BEGIN_AHEAD >= start => self.arm(cycle),
            TableState::Arming if self.exchange.is_done() => self.enter(TableState::Armed, 0),
            TableState::Arming if cycle.tick + BEGIN_AHEAD / 2 >= start => {
                self.refuse(fault(0, 0, TableFault::NotArmed));
            }
            TableState::Armed if cycle.tick >= start => self.play(),
            TableState::Disarming if self.exchange.is_done() => self.enter(TableState::Idle, 0),
            TableState::Disarming if cycle.tick >= start => self.enter(TableState::Stopping, 1),
            TableState::Stopping if self.exchange.is_done() => self.enter(TableState::Idle, 0),
            _ => {}
        }
        let Self { exchange, next, state, .. } = self;
        exchange.send(|j, i| command(*state, next, j, i));
    }

    /// Telegrams of this cycle.
    pub(crate) fn telegrams(&self) -> &[Frame] {
        self.exchange.telegrams()
    }

    /// Drives (bits) that are sent their controlword in this cycle: those for which it is new, and one of each line in turn.
    pub(crate) fn due(&mut self, tick: u64, control: &[u32; MAX_JOINTS], mode: u64) -> u32 {
        let (mut bits, mut places) = (0, [0u64; codec::layout::MAX_NODES]);
        let joints = self.robot.joints.len();
        let lines = self.robot.layout.nodes.len().max(1);
        for j in 0..joints {
            let line = self.robot.layout.interpreter(true, j).map_or(0, |m| m.node);
            let turn = places[line] == tick % joints.div_ceil(lines) as u64;
            places[line] += 1;
            let new = std::mem::replace(&mut self.sent[j], (control[j], mode)) != (control[j], mode);
            bits |= u32::from(new || turn) << j;
        }
        bits
    }

    fn enter(&mut self, state: TableState, commands: usize) {
        self.state = state;
        self.exchange.begin(commands);
    }

    /// Without supply no drive plays or holds anything.
    fn forget(&mut self) {
        if self.state != TableState::Idle {
            self.enter(TableState::Idle, 0);
        }
        self.room = self.waiting.take().or_else(|| self.room.take());
        self.runs = false;
        self.exchange.pause();
    }

    fn refuse(&mut self, why: Detail) {
        self.events.push(EventCode::TablesRefused, why);
        self.refused = true;
        match self.state {
            TableState::Arming | TableState::Armed => self.enter(TableState::Disarming, 1),
            _ => self.enter(TableState::Idle, 0),
        }
    }

    /// Tables that wait are the next ones.
    fn begin_next(&mut self) {
        let Some(tables) = self.waiting.take() else { return };
        self.room = Some(std::mem::replace(&mut self.next.tables, tables));
        let Self { next, robot, units, samples, .. } = self;
        let running = Some(&self.running).filter(|_| self.runs);
        let good = admit_whole(&next.tables, robot, units, *samples)
            .and_then(|()| place(next.tables.points as usize, running))
            .and_then(|first| {
                next.first = first;
                beginning(&next.tables, running, *samples, robot.joints.len())
            });
        match good {
            Ok(begin) => (self.begin, self.state) = (begin, TableState::Checking(0)),
            Err(why) => self.refuse(why),
        }
    }

    /// Checks some more points.
    fn check(&mut self, from: usize) {
        let points = self.next.tables.points as usize;
        let to = (from + POINTS_CHECKED).min(points);
        let period = self.next.tables.spacing as f64 * f64::from(self.drives.sampling_us) * 1e-6;
        let check = |i| admit_point(&self.next.tables, &self.robot, i, &self.begin, period);
        match (from..to).try_for_each(check) {
            Err(why) => self.refuse(why),
            Ok(()) if to < points => self.state = TableState::Checking(to),
            Ok(()) => {
                self.cycles = 0;
                self.enter(TableState::Loading, points + REGISTERS);
            }
        }
    }

    /// Announces the begin, if the joints are where the tables begin.
    fn arm(&mut self, cycle: &TableCycle<'_>) {
        let t = &self.next.tables;
        let joints = self.robot.joints.len();
        let late = cycle.tick + BEGIN_AHEAD > t.start_tick || !cycle.led;
        let late = late.then_some(fault(0, 0, TableFault::Late));
        let away = || elsewhere(t, joints, cycle.setpoint).filter(|_| !self.runs);
        match late.or_else(away) {
            Some(why) => self.refuse(why),
            None => self.enter(TableState::Arming, 1),
        }
    }

    /// The drives have begun with the SYNC of this cycle.
    fn play(&mut self) {
        std::mem::swap(&mut self.running, &mut self.next);
        self.runs = true;
        self.events.push(EventCode::TablesBegun, Detail::Plan(self.running.tables.plan));
        self.enter(TableState::Idle, 0);
    }
}

/// Command `i` to the drive of joint `j`.
fn command(state: TableState, next: &PlacedTables, j: usize, i: usize) -> Telegram {
    let (t, first, points) = (&next.tables, next.first, next.tables.points as usize);
    match state {
        TableState::Arming => Telegram::set(BG, 0, i32::from(t.start_tick as u8)),
        TableState::Disarming => Telegram::set(PT, 0, first as i32),
        TableState::Stopping => Telegram::set(ST, 0, 0),
        _ if i == 0 => Telegram::ask(WS, SAMPLING),
        _ if i <= points => Telegram::set(QP, (first + i - 1) as u16, t.of(j)[i - 1]),
        _ => match i - points {
            1 => Telegram::set(MP, 1, first as i32),
            2 => Telegram::set(MP, 2, next.last() as i32),
            3 => Telegram::set(MP, 3, t.cyclic as i32),
            4 => Telegram::set(MP, 4, t.spacing as i32),
            _ => Telegram::set(PT, 0, first as i32),
        },
    }
}
