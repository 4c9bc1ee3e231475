//! The world that is explored, and the rules beside it.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use broker::admission::{Sender, admit};
use broker::lease::LeaseKeeper;
use messages::command::VelocityCommand;
use messages::{Command, Lease, Live, Power, Stamp, Verdict, WatchdogReset};
use planner::lease::WalkLease;
use sim_backend::power::PowerLine;
use watchdog::{Inputs, Watchdog};

/// \[ns\] Time of one tick: a command that waits for one is in time, for two it is not.
const TICK: u64 = 60_000_000;
/// Ticks that a step of the search may take: all in time, or the end of a lease.
pub(crate) const STEPS: [u64; 2] = [1, 8];
/// \[ticks\] Rule: age of a command that may still move something.
const IN_TIME: u64 = 1;
/// \[ticks\] Rule: silence after which an operator counts as gone.
const GONE: u64 = 9;
/// Frames that an operator may have on the way.
pub(crate) const ON_THE_WAY: usize = 2;

pub(crate) const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.0 });

/// Frame that an operator sends in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Frame {
    Command(Command),
    Ping,
    TakeOver,
    /// The connection is closed and another one opened.
    Reconnect,
}

pub(crate) const FIRST: [Option<Frame>; 9] = [
    None,
    Some(Frame::Command(WALK)),
    Some(Frame::Command(Command::Stop)),
    Some(Frame::Command(Command::Reset)),
    Some(Frame::Command(Command::Enable)),
    Some(Frame::Command(Command::EmergencyStop)),
    Some(Frame::Ping),
    Some(Frame::TakeOver),
    Some(Frame::Reconnect),
];
/// The second operator need not do all that the first one does.
pub(crate) const SECOND: [Option<Frame>; 4] =
    [None, Some(Frame::Command(WALK)), Some(Frame::Ping), Some(Frame::TakeOver)];

impl Frame {
    fn number(self) -> usize {
        FIRST.iter().position(|f| *f == Some(self)).unwrap()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Broker {
    Runs,
    Stops,
    Dies,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Process {
    Runs,
    /// Its cycle comes before its courier does.
    Hurries,
    Stops,
}

/// Rule that is broken on purpose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Broken {
    Nothing,
    /// Processes take what the broker admitted, whenever it comes.
    Age,
    /// The walk does not end with its lease.
    Lease,
    /// A stop becomes too old like everything else.
    Stop,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct OnTheWay {
    token: u32,
    frame: Frame,
    sequence: u64,
    sent: u64,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Operator {
    token: u32,
    issued: u64,
    pub(crate) wire: Vec<OnTheWay>,
}

/// A process's end: its queue, what its courier told it of the lease.
#[derive(Clone, Debug, Default)]
struct End {
    queue: Vec<Live>,
    heard: Lease,
}

#[derive(Clone)]
pub(crate) struct World {
    broken: Broken,
    /// \[ticks\]
    now: u64,
    pub(crate) operators: [Operator; 2],
    tokens: u32,
    keeper: LeaseKeeper,
    senders: Vec<Sender>,
    told: Lease,
    planner: End,
    guard: End,
    walk: WalkLease,
    pub(crate) walking: bool,
    dog: Watchdog,
    skipped: u64,
    power: Power,
    reset: WatchdogReset,
    pub(crate) relay: PowerLine,
    rules: Rules,
}

/// Rules, seen from outside, and what they keep.
#[derive(Clone, Debug, Default, Hash)]
struct Rules {
    /// Connection that may move the robot, and when it last showed that it is there; by what the broker has handled.
    owner: Option<(u32, u64)>,
    /// When each connection last sent anything, newest connection last.
    life: Vec<(u32, u64)>,
    /// Connections whose walk goes on: who commanded it, and who took it over since, each with when
    /// it commanded, or the broker handled that it takes over.
    walks_for: Vec<(u32, u64)>,
    /// When the newest stop was sent that has come to the planner's queue.
    stop: Option<u64>,
    /// When the newest emergency stop was sent that has come to the watchdog's queue.
    off: Option<u64>,
    /// 0: nothing; 1: a reset was taken since the supply was off; 2: an enable after it.
    edges: u8,
}

impl World {
    pub(crate) fn new(broken: Broken) -> Self {
        let mut world = Self {
            broken,
            now: 100,
            operators: Default::default(),
            tokens: 0,
            keeper: LeaseKeeper::new(0),
            senders: Vec::new(),
            told: Lease::default(),
            planner: End::default(),
            guard: End::default(),
            walk: WalkLease::default(),
            walking: false,
            dog: Watchdog::new(2, 3).with_timing(1, 1),
            skipped: 0,
            power: Power::default(),
            reset: WatchdogReset::default(),
            relay: PowerLine::falling_after(3),
            rules: Rules::default(),
        };
        world.connect(0);
        world.connect(1);
        world
    }

    fn connect(&mut self, i: usize) {
        self.tokens += 1;
        self.operators[i] = Operator { token: self.tokens, issued: 0, ..self.operators[i].clone() };
        self.senders.push(Sender { token: self.tokens, may: u32::MAX, last: [0; 3] });
    }

    fn send(&mut self, i: usize, frame: Frame) {
        let operator = &mut self.operators[i];
        operator.issued += 1;
        let (token, sequence, sent) = (operator.token, operator.issued, self.now);
        operator.wire.push(OnTheWay { token, frame, sequence, sent });
        self.rules.life.retain(|(t, _)| *t != token);
        self.rules.life.push((token, sent));
        if frame == Frame::Reconnect {
            self.connect(i);
        }
    }

    /// The broker's work of a tick: commands by class, then everything else, then what is a matter of time.
    fn broker(&mut self) -> Result<(), &'static str> {
        let now = self.now * TICK;
        let mut all: Vec<OnTheWay> =
            self.operators.iter_mut().flat_map(|o| std::mem::take(&mut o.wire)).collect();
        all.sort_by_key(|m| match m.frame {
            Frame::Command(command) => command.priority() as u8,
            _ => u8::MAX,
        });
        for m in all {
            match m.frame {
                Frame::Command(command) => self.forward(m, command)?,
                Frame::Ping => self.keeper.renew(m.token, m.sent * TICK, now),
                Frame::TakeOver => {
                    if self.senders.iter().any(|s| s.token == m.token) {
                        _ = self.keeper.take_over(m.token, m.sent * TICK, now);
                        self.rules.owner = None;
                    }
                }
                Frame::Reconnect => {
                    self.keeper.release(m.token);
                    self.senders.retain(|s| s.token != m.token);
                    self.rules.closed(m.token);
                }
            }
            self.rules.shows_life(m.token, m.sent, self.now);
            if m.frame == Frame::TakeOver {
                self.rules.owner = Some((m.token, m.sent));
                self.rules.walks_for.push((m.token, self.now));
            }
        }
        self.keeper.expire(now);
        self.told = self.keeper.state(now);
        Ok(())
    }

    fn forward(&mut self, m: OnTheWay, command: Command) -> Result<(), &'static str> {
        let now = self.now * TICK;
        let mut stamp = Stamp { origin: m.token, grant: 0, sequence: m.sequence, sent_ns: m.sent * TICK };
        let mut stranger = Sender { token: m.token, may: 0, last: [0; 3] };
        let sender = self.senders.iter_mut().find(|s| s.token == m.token).unwrap_or(&mut stranger);
        let Ok(grant) = admit(sender, &mut self.keeper, &command, command.priority(), &stamp, now) else {
            // A stop that is given in good order is never refused.
            let stops = matches!(command, Command::Stop | Command::EmergencyStop);
            return if stops { Err("the broker refused a stop") } else { Ok(()) };
        };
        stamp.grant = grant;
        let live = Live { command, stamp };
        match command {
            Command::Stop => self.rules.stop = Some(m.sent),
            Command::EmergencyStop => self.rules.off = Some(m.sent),
            _ => self.rules.moves(&m, self.now)?,
        }
        match command {
            Command::Stop | Command::Velocity(_) => self.planner.queue.push(live),
            _ => self.guard.queue.push(live),
        }
        Ok(())
    }

    /// Commands that came and may take effect, urgent commands first.
    fn take(&mut self, end: fn(&mut Self) -> &mut End, how: Process) -> Result<Vec<Live>, &'static str> {
        let (told, now, broken) = (self.told, self.now, self.broken);
        let end = end(self);
        let mut came = Vec::new();
        if how == Process::Runs {
            end.heard = told;
            came = std::mem::take(&mut end.queue);
            came.sort_by_key(|live| live.command.priority() as u8);
        }
        let stops = |live: &Live| matches!(live.command, Command::Stop | Command::EmergencyStop);
        came.retain(|live| match broken {
            Broken::Age => stops(live) || end.heard.grant == live.stamp.grant,
            Broken::Stop => {
                live.check(end.heard, now * TICK).is_ok() && live.stamp.check_age(now * TICK).is_ok()
            }
            _ => live.check(end.heard, now * TICK).is_ok(),
        });
        match came.iter().any(|live| !stops(live) && now - live.stamp.sent_ns / TICK > IN_TIME) {
            true => Err("an old command took effect"),
            false => Ok(came),
        }
    }

    fn plan(&mut self, how: Process) -> Result<(), &'static str> {
        let came = self.take(|w| &mut w.planner, how)?;
        if self.broken != Broken::Lease && self.walk.lost(self.planner.heard, self.now * TICK).is_some() {
            self.walking = false;
        }
        let mut newest = 0;
        for live in came {
            let verdict: Verdict = match live.command {
                Command::Velocity(_) if self.reset.supply == 0 => Err(messages::Reason::NotStanding),
                _ => Ok(()),
            };
            self.walk.follow(&live, verdict);
            if verdict.is_ok() {
                self.walking = live.command != Command::Stop;
                let sent = live.stamp.sent_ns / TICK;
                newest = newest.max(sent);
                if self.walking {
                    self.rules.walks_for.retain(|(_, taken)| *taken >= sent);
                    self.rules.walks_for.push((live.stamp.origin, sent));
                }
            }
        }
        // Power off ends plan and wish.
        self.walking &= self.reset.supply == 1;
        if how == Process::Runs
            && let Some(sent) = self.rules.stop.take()
            && self.walking
            && newest < sent
        {
            return Err("a stop was lost");
        }
        let there =
            |(t, _): &(u32, u64)| self.rules.life.iter().any(|(l, sent)| l == t && self.now - sent < GONE);
        match self.walking && !self.rules.walks_for.iter().any(there) {
            true => Err("it walks for somebody who is gone"),
            false => Ok(()),
        }
    }

    fn watch(&mut self, how: Process) -> Result<(), &'static str> {
        let came = self.take(|w| &mut w.guard, how)?;
        self.reset.header.tick = 1 - self.reset.header.tick;
        let commands: Vec<Command> = came.iter().map(|live| live.command).collect();
        let skipped = std::mem::take(&mut self.skipped);
        let was = self.power.on;
        self.power =
            *self.dog.step(&Inputs { reset: Some(&self.reset), commands: &commands, skipped, late: false });
        if was == 1 && self.power.on == 0 {
            self.rules.edges = 0;
        }
        for command in commands {
            self.rules.edges = match (command, self.rules.edges) {
                (Command::EmergencyStop, _) => 0,
                (Command::Reset, 0) => 1,
                (Command::Enable, 1) => 2,
                (_, edges) => edges,
            };
        }
        if how == Process::Runs
            && let Some(sent) = self.rules.off.take()
            && self.power.on == 1
            && came.iter().all(|live| live.command != Command::Enable || live.stamp.sent_ns / TICK < sent)
        {
            return Err("an emergency stop was lost");
        }
        Ok(())
    }

    pub(crate) fn step(
        &mut self,
        ticks: u64,
        sent: [Option<Frame>; 2],
        runs: (Broker, Process, Process),
    ) -> Result<(), &'static str> {
        self.now += ticks;
        for (i, frame) in sent.into_iter().enumerate() {
            frame.into_iter().for_each(|frame| self.send(i, frame));
        }
        match runs.0 {
            Broker::Runs => self.broker()?,
            Broker::Stops => {}
            Broker::Dies => {
                // What was on the way is lost, and everybody has to come again.
                (self.keeper, self.senders) = (LeaseKeeper::new(1000 * self.now), Vec::new());
                self.rules.owner = None;
                self.operators.iter_mut().for_each(|o| o.wire.clear());
                (0..2).for_each(|i| self.connect(i));
            }
        }
        if runs.1 != Process::Stops {
            self.plan(runs.1)?;
        }
        match runs.2 {
            Process::Stops => self.skipped += ticks,
            how => self.watch(how)?,
        }
        let was = self.relay.is_closed();
        let closed = self.relay.step(Some(&self.power));
        self.reset.supply = u64::from(closed);
        if closed && !was && self.rules.edges < 2 {
            return Err("the relay closed without reset and enable");
        }
        Ok(())
    }

    /// All that decides what can happen next, with times counted from now and numbers from each other.
    pub(crate) fn key(&self) -> u64 {
        let mut h = DefaultHasher::new();
        let ago = |t: u64| (self.now - t).min(GONE + 1);
        let until = |l: Lease| (l.until_ns / TICK + GONE).saturating_sub(self.now);
        let token = |t: u32| {
            self.operators.iter().position(|o| o.token == t).map_or(self.tokens - t + 2, |i| i as u32)
        };
        let holder = self.keeper.holder(self.now * TICK).map(token);
        let state = self.keeper.state(self.now * TICK);
        (holder, until(state), (self.told.grant == state.grant, until(self.told))).hash(&mut h);
        for o in &self.operators {
            let last = self.senders.iter().find(|s| s.token == o.token).map(|s| s.last.map(|n| o.issued - n));
            last.hash(&mut h);
            for m in &o.wire {
                (token(m.token), m.frame.number(), ago(m.sent)).hash(&mut h);
            }
        }
        for end in [&self.planner, &self.guard] {
            (end.heard.grant == self.told.grant, until(end.heard)).hash(&mut h);
            for l in &end.queue {
                let same = [self.told.grant, end.heard.grant].map(|g| l.stamp.grant == g);
                (
                    l.command.address().1,
                    l.command.decided_by(),
                    token(l.stamp.origin),
                    same,
                    ago(l.stamp.sent_ns / TICK),
                )
                    .hash(&mut h);
            }
        }
        // The number of the walk's grant is its own; whether it is the one that was heard decides.
        let mut probe = self.walk;
        let lost = probe.lost(Lease { until_ns: u64::MAX, ..self.planner.heard }, self.now * TICK).is_some();
        let mut other = self.walk;
        let lost_to_told = other.lost(Lease { until_ns: u64::MAX, ..self.told }, self.now * TICK).is_some();
        (self.walk == WalkLease::default(), lost, lost_to_told, self.walking).hash(&mut h);
        let (quiet, toggle, (epoch, arming)) = self.relay.state();
        let newer = (self.power.header.epoch, self.power.arming).cmp(&(epoch, arming));
        (self.dog.state(), self.skipped.min(3), self.power.on, quiet, toggle == self.power.toggle, newer)
            .hash(&mut h);
        (self.relay.is_closed(), self.reset.header.tick, self.reset.supply).hash(&mut h);
        let r = &self.rules;
        (r.owner.map(|(t, sent)| (token(t), ago(sent))), r.stop.map(ago), r.off.map(ago), r.edges)
            .hash(&mut h);
        let newest = r
            .walks_for
            .iter()
            .filter_map(|(t, _)| r.life.iter().find(|(l, _)| l == t))
            .map(|(_, s)| ago(*s))
            .min();
        let takers: BTreeSet<_> = r.walks_for.iter().map(|&(t, sent)| (token(t).min(3), ago(sent))).collect();
        (newest, takers).hash(&mut h);
        h.finish()
    }
}

impl Rules {
    /// A frame of a connection was handled; it counts only if its sender had not been silent for too long by then.
    fn shows_life(&mut self, token: u32, sent: u64, now: u64) {
        if let Some((owner, life)) = &mut self.owner
            && *owner == token
            && now - *life < GONE
        {
            *life = sent.max(*life);
        }
    }

    /// A command that moves something was passed on.
    fn moves(&mut self, m: &OnTheWay, now: u64) -> Result<(), &'static str> {
        match self.owner {
            Some((owner, life)) if owner != m.token && now - life < GONE => Err("two command at once"),
            Some((owner, life)) if owner == m.token && now - life < GONE => Ok(()),
            _ => {
                self.owner = Some((m.token, m.sent));
                Ok(())
            }
        }
    }

    fn closed(&mut self, token: u32) {
        self.owner = self.owner.filter(|(owner, _)| *owner != token);
    }
}
