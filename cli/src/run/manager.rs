//! Notifications to the service manager that started a run, after `sd_notify(3)`: ready, alive, stopping. Does nothing
//! without one.

use realtime::clock::SECOND;
use sd_notify::NotifyState;

/// Environment of the service manager's, which is none of the processes' business.
pub(super) const ENVIRONMENT: [&str; 3] = ["NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"];

/// The line to the service manager.
pub(super) struct Manager {
    /// Between two heartbeats \[ns\]: a third of what the manager bears; none: it wants none.
    every: Option<u64>,
    next: u64,
}

impl Manager {
    pub(super) fn new() -> Self {
        let every = sd_notify::watchdog_enabled().map(|limit| (limit.as_nanos() as u64 / 3).clamp(1, SECOND));
        Self { every, next: 0 }
    }

    /// Everything has been started.
    pub(super) fn ready(&self) {
        tell(NotifyState::Ready);
    }

    /// One look at the processes: a heartbeat, if it is time for one.
    pub(super) fn look(&mut self, now: u64) {
        if let Some(every) = self.every
            && now >= self.next
        {
            self.next = now + every;
            tell(NotifyState::Watchdog);
        }
    }

    /// The run comes to its end.
    pub(super) fn stopping(&self) {
        tell(NotifyState::Stopping);
    }
}

/// A manager that does not listen changes nothing.
fn tell(state: NotifyState) {
    let _ = sd_notify::notify(&[state]);
}
