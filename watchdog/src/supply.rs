//! The state of the motor supply, and the only way from off to on.
//!
//! ```text
//!            Reset edge                Enable edge
//!   Off ───────────────────► Ready ───────────────────► On
//!    ▲    (joint loop alive)   │    (joint loop alive,   │
//!    │                         │     supply measured off)│
//!    └─────────────────────────┴─────────────────────────┘
//!        joint loop silent, its trip request, emergency stop,
//!        own cycles missed, supply measured off while it is to be on
//! ```
//!
//! It starts off, and off is latched. An edge is a command after a pause without that command: who holds a button, or
//! floods the line, gives no edge. The supply's relay is closed only while `toggle` moves, so a dead watchdog is off too;
//! and it closes only once for each value of `arming`, so a stopped one that goes on leaves it open.

use messages::{Command, Detail, EventCode, Power, Reason, Verdict, WatchdogReset};

/// Watchdog cycles without a command after which the next one counts as an edge.
pub const PAUSE: u32 = 250;

/// Watchdog cycles that the relay may take to close, and the joint loop to measure it.
const CLOSING: u32 = 500;

/// The motor supply as the watchdog sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Supply {
    /// Off, with the first reason since the last reset edge.
    Off(EventCode),
    /// Off, reset; the next enable edge switches it on.
    Ready,
    /// On.
    On,
}

/// Event of a change of the supply: code and detail.
pub fn supply_event(before: Supply, after: Supply) -> Option<(EventCode, Detail)> {
    match (before, after) {
        (Supply::On, Supply::Off(reason)) => Some((EventCode::PowerOff, Detail::Cause(reason))),
        (Supply::Ready | Supply::Off(_), Supply::On) => Some((EventCode::PowerOn, Detail::Nothing)),
        _ => None,
    }
}

/// Answer to the operator: a reset or an enable that has had no effect is refused.
pub fn verdict(command: &Command, before: Supply, after: Supply) -> Verdict {
    let done = match command {
        Command::Reset => after == Supply::Ready || after == Supply::On && before != Supply::On,
        Command::Enable => after == Supply::On,
        _ => true,
    };
    if done { Ok(()) } else { Err(Reason::NotNow) }
}

/// Inputs of one cycle of the watchdog.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs<'a> {
    /// The newest heartbeat of the joint loop; none before the first one.
    pub reset: Option<&'a WatchdogReset>,
    /// Commands that came since the last cycle, in order.
    pub commands: &'a [Command],
    /// \[1\] Own cycles missed since the last one.
    pub skipped: u64,
    /// This look comes so late that whatever held the watchdog up may have held up the joint loop too.
    pub late: bool,
}

/// Changes of the supply in one cycle.
#[derive(Clone, Copy, Debug)]
enum Happening {
    Trip(EventCode),
    Reset,
    Enable,
}

/// Everything that decides what a watchdog does next, numbers as far as they matter: equal states act alike. What it has
/// published is not among it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SupplyState {
    /// The motor supply.
    pub supply: Supply,
    /// Epoch and tick of the newest heartbeat.
    pub seen: Option<(u64, u64)>,
    /// Cycles since the last reset command, up to a pause.
    pub reset_pause: u32,
    /// Cycles since the last enable command, up to a pause.
    pub enable_pause: u32,
    /// Cycles since the supply was switched on in which it was not measured on.
    pub closing: Option<u32>,
    /// Cycles without a heartbeat, up to the limit.
    pub missed: u64,
    /// A late look without a heartbeat was not counted.
    pub forgiven: bool,
}

/// The watchdog: pure, no clock; time is its own cycles.
#[derive(Clone, Debug)]
pub struct Watchdog {
    limit: u64,
    pause: u32,
    most_closing: u32,
    most_skipped: u64,
    supply: Supply,
    /// (epoch, tick) of the newest heartbeat.
    seen: Option<(u64, u64)>,
    reset_pause: u32,
    enable_pause: u32,
    /// Cycles since the supply was switched on in which it was not measured on; none once it was.
    closing: Option<u32>,
    /// A late look without a heartbeat was not counted since the last heartbeat.
    forgiven: bool,
    power: Power,
}

impl Watchdog {
    /// Off. `missed` own cycles without a new heartbeat of the joint loop are too many; one late cycle since the last
    /// heartbeat is not counted. The supply's relay falls after `quiet` cycles without a toggle. Both at least 1.
    pub fn new(missed: u32, quiet: u32) -> Self {
        Self {
            limit: u64::from(missed.max(1)),
            pause: PAUSE,
            most_closing: CLOSING,
            most_skipped: u64::from(quiet.max(1)),
            supply: Supply::Off(EventCode::None),
            seen: None,
            reset_pause: PAUSE,
            enable_pause: PAUSE,
            closing: None,
            forgiven: false,
            power: Power::default(),
        }
    }

    /// The same with other lengths of a pause and of the closing of the relay \[cycles\].
    pub fn with_timing(self, pause: u32, closing: u32) -> Self {
        Self { pause, most_closing: closing, reset_pause: pause, enable_pause: pause, ..self }
    }

    /// The state of the supply.
    pub fn supply(&self) -> Supply {
        self.supply
    }

    /// The same, started again in place of one that died: a command counts as an edge after a whole pause only, because
    /// nobody knows what was held before.
    pub fn restarted(self) -> Self {
        Self { reset_pause: 0, enable_pause: 0, ..self }
    }

    /// The state that decides what it does next.
    pub fn state(&self) -> SupplyState {
        SupplyState {
            supply: self.supply,
            seen: self.seen,
            reset_pause: self.reset_pause.min(self.pause),
            enable_pause: self.enable_pause.min(self.pause),
            closing: self.closing,
            missed: self.power.missed.min(self.limit),
            forgiven: self.forgiven,
        }
    }

    /// One cycle: looks for a heartbeat, then at the commands in their order.
    pub fn step(&mut self, inputs: &Inputs) -> &Power {
        self.reset_pause = self.reset_pause.saturating_add(1);
        self.enable_pause = self.enable_pause.saturating_add(1);
        self.look_at(inputs);
        let fault = self.fault(inputs);
        if let Some(reason) = fault {
            self.switch(Happening::Trip(reason), inputs.reset);
        }
        for command in inputs.commands {
            if let Some(happening) = self.happening(command)
                && (fault.is_none() || matches!(happening, Happening::Trip(_)))
            {
                self.switch(happening, inputs.reset);
            }
        }
        self.publish()
    }

    /// Counts own cycles since the last new tick; a joint loop that was started again counts ticks anew.
    fn look_at(&mut self, inputs: &Inputs) {
        match inputs.reset.map(|r| r.header) {
            Some(now) if self.seen != Some((now.epoch, now.tick)) => {
                self.seen = Some((now.epoch, now.tick));
                (self.power.header.tick, self.power.header.stamp_ns) = (now.tick, now.stamp_ns);
                (self.power.missed, self.forgiven) = (0, false);
            }
            // A stall of the whole machine takes time from both, and the watchdog wakes first: once, a late look is no
            // evidence against the joint loop.
            _ if inputs.late && !self.forgiven => self.forgiven = true,
            _ => self.power.missed = self.power.missed.saturating_add(1),
        }
        let measured = inputs.reset.is_some_and(|r| r.supply == 1);
        self.closing = self.closing.filter(|_| !measured).map(|cycles| cycles.saturating_add(1));
    }

    /// Reason for the supply to be off in this cycle, whatever anybody commands.
    fn fault(&self, inputs: &Inputs) -> Option<EventCode> {
        match inputs.reset {
            _ if inputs.skipped >= self.most_skipped => Some(EventCode::WatchdogSilent),
            _ if self.seen.is_none() || self.power.missed >= self.limit => Some(EventCode::ResetMissed),
            // A number that is no code is a fault too.
            Some(r) if r.trip != 0 => Some(EventCode::from_number(r.trip).unwrap_or(EventCode::SafeStop)),
            Some(r)
                if r.supply != 1
                    && self.supply == Supply::On
                    && self.closing.is_none_or(|n| n > self.most_closing) =>
            {
                Some(EventCode::SupplyLost)
            }
            _ => None,
        }
    }

    fn happening(&mut self, command: &Command) -> Option<Happening> {
        let edge = |pause: &mut u32| std::mem::replace(pause, 0) >= self.pause;
        match command {
            Command::EmergencyStop => Some(Happening::Trip(EventCode::EmergencyStop)),
            Command::Reset => edge(&mut self.reset_pause).then_some(Happening::Reset),
            Command::Enable => edge(&mut self.enable_pause).then_some(Happening::Enable),
            _ => None,
        }
    }

    /// The transition table.
    fn switch(&mut self, happening: Happening, reset: Option<&WatchdogReset>) {
        let open = reset.is_some_and(|r| r.supply == 0);
        self.supply = match (self.supply, happening) {
            // Never on: nothing to report until something worse than silence before the first heartbeat happens.
            (Supply::Off(EventCode::None), Happening::Trip(EventCode::ResetMissed)) => {
                Supply::Off(EventCode::None)
            }
            (Supply::Off(EventCode::None), Happening::Trip(reason)) => Supply::Off(reason),
            (Supply::Off(first), Happening::Trip(_)) => Supply::Off(first),
            (Supply::Ready | Supply::On, Happening::Trip(reason)) => Supply::Off(reason),
            (Supply::Off(_), Happening::Reset) => Supply::Ready,
            // Only an open relay can be closed: one that is still closed was armed by somebody else's edges.
            (Supply::Ready, Happening::Enable) if open => {
                self.power.arming += 1;
                self.closing = Some(0);
                Supply::On
            }
            (same, Happening::Reset | Happening::Enable) => same,
        };
    }

    fn publish(&mut self) -> &Power {
        self.power.on = u64::from(self.supply == Supply::On);
        self.power.toggle += self.power.on;
        self.power.reason = if let Supply::Off(reason) = self.supply { reason as u64 } else { 0 };
        &self.power
    }
}
