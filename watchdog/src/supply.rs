//! The state of the motor supply, and the only way from off to on.
//!
//! ```text
//!            Reset edge                Enable edge
//!   Off ───────────────────► Ready ───────────────────► On
//!    ▲    (joint loop alive)   │    (joint loop alive)   │
//!    └─────────────────────────┴─────────────────────────┘
//!        joint loop silent, its trip request, emergency stop
//! ```
//!
//! It starts off, and off is latched. An edge is a command after a pause without that command: who holds a button, or
//! floods the line, gives no edge. The supply's hardware is on only while `toggle` moves, so a dead watchdog is off too.

use messages::{Command, EventCode, Power, WatchdogReset};

/// Watchdog cycles without a command after which the next one counts as an edge.
pub const PAUSE: u32 = 250;

/// The motor supply as the watchdog sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Supply {
    /// Off, with the first reason since the last reset edge.
    Off(EventCode),
    /// Off, reset; the next enable edge switches it on.
    Ready,
    /// On.
    On,
}

/// What the log says of a change of the supply: code and detail.
pub fn supply_event(before: Supply, after: Supply) -> Option<(EventCode, u64)> {
    match (before, after) {
        (Supply::On, Supply::Off(reason)) => Some((EventCode::PowerOff, reason as u64)),
        (Supply::Ready | Supply::Off(_), Supply::On) => Some((EventCode::PowerOn, 0)),
        _ => None,
    }
}

/// What one cycle of the watchdog sees.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs<'a> {
    /// The newest sign of life of the joint loop; none before the first one.
    pub reset: Option<&'a WatchdogReset>,
    /// Commands that came since the last cycle, in order.
    pub commands: &'a [Command],
}

/// What can happen to the supply in one cycle.
#[derive(Clone, Copy, Debug)]
enum Happening {
    Trip(EventCode),
    Reset,
    Enable,
}

/// The watchdog: pure, no clock; time is its own cycles.
#[derive(Clone, Debug)]
pub struct Watchdog {
    limit: u64,
    supply: Supply,
    /// (epoch, tick) of the newest sign of life.
    seen: Option<(u64, u64)>,
    reset_pause: u32,
    enable_pause: u32,
    power: Power,
}

impl Watchdog {
    /// Off. `missed` own cycles without a new sign of life of the joint loop are too many; at least 1.
    pub fn new(missed: u32) -> Self {
        Self {
            limit: u64::from(missed.max(1)),
            supply: Supply::Off(EventCode::None),
            seen: None,
            reset_pause: PAUSE,
            enable_pause: PAUSE,
            power: Power::default(),
        }
    }

    /// The state of the supply.
    pub fn supply(&self) -> Supply {
        self.supply
    }

    /// One cycle: looks for a sign of life, then at the commands in their order.
    pub fn step(&mut self, inputs: &Inputs) -> &Power {
        self.reset_pause = self.reset_pause.saturating_add(1);
        self.enable_pause = self.enable_pause.saturating_add(1);
        self.look_at(inputs.reset);
        let fault = self.fault(inputs.reset);
        if let Some(reason) = fault {
            self.switch(Happening::Trip(reason));
        }
        for command in inputs.commands {
            if let Some(happening) = self.happening(command)
                && (fault.is_none() || matches!(happening, Happening::Trip(_)))
            {
                self.switch(happening);
            }
        }
        self.publish()
    }

    /// Counts own cycles since the last new tick; a joint loop that was started again counts ticks anew.
    fn look_at(&mut self, reset: Option<&WatchdogReset>) {
        match reset.map(|r| r.header) {
            Some(now) if self.seen != Some((now.epoch, now.tick)) => {
                self.seen = Some((now.epoch, now.tick));
                (self.power.header.tick, self.power.header.stamp_ns) = (now.tick, now.stamp_ns);
                self.power.missed = 0;
            }
            _ => self.power.missed = self.power.missed.saturating_add(1),
        }
    }

    /// Why the supply must be off in this cycle, whatever anybody commands.
    fn fault(&self, reset: Option<&WatchdogReset>) -> Option<EventCode> {
        match reset {
            _ if self.seen.is_none() || self.power.missed >= self.limit => Some(EventCode::ResetMissed),
            // A number that is no code is a fault too.
            Some(r) if r.trip != 0 => Some(EventCode::from_number(r.trip).unwrap_or(EventCode::SafeStop)),
            _ => None,
        }
    }

    fn happening(&mut self, command: &Command) -> Option<Happening> {
        let edge = |pause: &mut u32| std::mem::replace(pause, 0) >= PAUSE;
        match command {
            Command::EmergencyStop => Some(Happening::Trip(EventCode::EmergencyStop)),
            Command::Reset => edge(&mut self.reset_pause).then_some(Happening::Reset),
            Command::Enable => edge(&mut self.enable_pause).then_some(Happening::Enable),
            _ => None,
        }
    }

    /// The transition table.
    fn switch(&mut self, happening: Happening) {
        self.supply = match (self.supply, happening) {
            // Never on: nothing to report until something worse than silence before the first sign of life happens.
            (Supply::Off(EventCode::None), Happening::Trip(EventCode::ResetMissed)) => {
                Supply::Off(EventCode::None)
            }
            (Supply::Off(EventCode::None), Happening::Trip(reason)) => Supply::Off(reason),
            (Supply::Off(first), Happening::Trip(_)) => Supply::Off(first),
            (Supply::Ready | Supply::On, Happening::Trip(reason)) => Supply::Off(reason),
            (Supply::Off(_), Happening::Reset) => Supply::Ready,
            (Supply::Ready, Happening::Enable) => Supply::On,
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
