//! Stamp of a command: who gave it, as which of theirs, when, and under which lease; and what makes it too old.
//!
//! The sender takes the time, and everybody who handles the command holds the same time against their own clock: the
//! broker, and again the process in whose cycle the command takes effect. So it does not matter which of them
//! stalled. All clocks are CLOCK_MONOTONIC of one machine; a client on the network learns the broker's clock.

use crate::Command;
use crate::command_answer::Reason;

/// Age at which a command is dropped \[ns\]: an operator sees what the robot does and would command otherwise by now.
pub const MAX_AGE: u64 = 100_000_000;
/// Lead of the sender's clock that is still none \[ns\].
const MAX_LEAD: u64 = 1_000_000;
/// Lifetime of a command lease without a heartbeat of its holder \[ns\].
pub const LEASE: u64 = 500_000_000;

/// Sender and time of a command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Stamp {
    /// Number of the sender's connection; 0: the scene's own timeline.
    pub origin: u32,
    /// Lease under which the broker admitted it; 0: none was needed.
    pub grant: u32,
    /// Number of the command on its connection, from 1, rising.
    pub sequence: u64,
    /// \[ns\] CLOCK_MONOTONIC when the sender gave it.
    pub sent_ns: u64,
}

impl Stamp {
    /// Age at `now_ns` in bounds: neither too old nor from the future, which would never become old.
    ///
    /// # Errors
    /// Too old, or ahead of the clock.
    pub const fn check_age(&self, now_ns: u64) -> Result<(), Reason> {
        if now_ns.saturating_sub(self.sent_ns) > MAX_AGE {
            return Err(Reason::TooOld { age_ns: now_ns - self.sent_ns });
        }
        if self.sent_ns.saturating_sub(now_ns) > MAX_LEAD {
            return Err(Reason::FromTheFuture { lead_ns: self.sent_ns - now_ns });
        }
        Ok(())
    }
}

/// A command lease as a consumer knows it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Lease {
    /// Number of the grant; a take-over keeps it, everybody else gets a new one. 0: nobody holds the lease.
    pub grant: u32,
    /// \[ns\] CLOCK_MONOTONIC until which it holds unless it is renewed.
    pub until_ns: u64,
}

impl Lease {
    /// Whether `grant` still holds at `now_ns`.
    pub const fn covers(&self, grant: u32, now_ns: u64) -> bool {
        self.grant == grant && now_ns <= self.until_ns
    }
}

/// A command and its stamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Live {
    /// Actions to take.
    pub command: Command,
    /// Requester.
    pub stamp: Stamp,
}

impl Live {
    /// A command of the scene's own timeline: of no connection, under no lease, never old.
    pub const fn of_scene(command: Command) -> Self {
        Self { command, stamp: Stamp { origin: 0, grant: 0, sequence: 0, sent_ns: 0 } }
    }

    /// Right of the command to take effect at `now_ns`, while `lease` is the newest that was heard of. Stop, end and
    /// emergency stop always pass.
    ///
    /// # Errors
    /// Too old, from the future, or its sender lost the lease since.
    pub fn check(&self, lease: Lease, now_ns: u64) -> Result<(), Reason> {
        if self.command.always_passes() {
            return Ok(());
        }
        self.stamp.check_age(now_ns)?;
        if self.command.needs_lease() && !lease.covers(self.stamp.grant, now_ns) {
            return Err(Reason::LeaseLost);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::VelocityCommand;

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.4, left: 0.0, turn: 0.0 });

    fn live(command: Command, sent_ns: u64) -> Live {
        Live { command, stamp: Stamp { origin: 1, grant: 7, sequence: 1, sent_ns } }
    }

    #[test]
    fn a_command_is_dropped_at_its_age_and_not_before() {
        let lease = Lease { grant: 7, until_ns: u64::MAX };
        let now = 10 * LEASE;
        assert_eq!(live(WALK, now - MAX_AGE).check(lease, now), Ok(()));
        let old = live(WALK, now - MAX_AGE - 1).check(lease, now);
        assert_eq!(old, Err(Reason::TooOld { age_ns: MAX_AGE + 1 }));
        assert!(matches!(
            live(WALK, now + MAX_LEAD + 1).check(lease, now),
            Err(Reason::FromTheFuture { .. })
        ));
        assert!(live(WALK, u64::MAX).check(lease, 0).is_err());
    }

    #[test]
    fn a_stop_is_never_too_old_and_needs_no_lease() {
        for command in [Command::Stop, Command::End, Command::EmergencyStop] {
            for sent in [0, u64::MAX] {
                assert_eq!(live(command, sent).check(Lease::default(), 10 * LEASE), Ok(()));
            }
        }
    }

    #[test]
    fn what_another_lease_admitted_is_dropped() {
        let now = 10 * LEASE;
        for lease in
            [Lease::default(), Lease { grant: 8, until_ns: u64::MAX }, Lease { grant: 7, until_ns: now - 1 }]
        {
            assert_eq!(live(WALK, now).check(lease, now), Err(Reason::LeaseLost), "{lease:?}");
        }
    }
}
