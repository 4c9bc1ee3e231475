//! Admission of one command: rights of its sender, sequence, age, lease. No clock and no socket: time is an argument.

use messages::command::Priority;
use messages::{Command, Reason, Stamp};

use crate::lease::LeaseKeeper;

/// State of a sender, as the broker keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sender {
    /// Number of its connection.
    pub token: u32,
    /// Domains that it may command: bit n for domain n.
    pub may: u32,
    /// Highest sequence so far of each class: a higher class passes a lower one on the way.
    pub last: [u64; 3],
}

/// Reason of the broker for not passing a command on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Denied {
    /// Age or sequence.
    Reason(Reason),
    /// The sender may not command this domain.
    NoAccess,
    /// Another one holds the lease: the number of its connection.
    LeaseHeld(u32),
}

impl Sender {
    const fn may_command(&self, command: &Command) -> bool {
        self.may & 1 << command.address().0 as u16 != 0
    }
}

/// Grant under which the command may pass; 0 if it needs none. Stop and emergency stop always pass, end if its sender may.
///
/// # Errors
/// The right, age, sequence or lease that is missing. A refused command uses its sequence up.
pub fn admit(
    sender: &mut Sender,
    lease: &mut LeaseKeeper,
    command: &Command,
    class: Priority,
    stamp: &Stamp,
    now_ns: u64,
) -> Result<u32, Denied> {
    // Nothing that was sent before an emergency stop comes after it.
    let last = sender.last[class as usize].max(sender.last[Priority::High as usize]);
    sender.last[class as usize] = last.max(stamp.sequence);
    // Whatever its holder sends is a sign of life; only what moves the robot takes a lease that is free.
    lease.renew(sender.token, stamp.sent_ns, now_ns);
    // Ending all processes is no matter of old or new, but of who may.
    let ends = *command == Command::End && !sender.may_command(command);
    if command.always_passes() && !ends {
        return Ok(0);
    }
    if stamp.sequence <= last {
        return Err(Denied::Reason(Reason::Replayed { sequence: stamp.sequence, last }));
    }
    stamp.check_age(now_ns).map_err(Denied::Reason)?;
    if !sender.may_command(command) {
        return Err(Denied::NoAccess);
    }
    match command.needs_lease() {
        true => lease.admit(sender.token, stamp.sent_ns, now_ns).map_err(Denied::LeaseHeld),
        false => Ok(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::{Domain, VelocityCommand};
    use messages::command_stamp::{LEASE, MAX_AGE};
    use messages::command_text::COMMANDS;

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.4, left: 0.0, turn: 0.0 });
    const NOW: u64 = 10_000_000_000;

    fn sender(may: &[Domain]) -> Sender {
        Sender { token: 3, may: crate::message::domain_mask(may), last: [0, 5, 0] }
    }

    fn stamp(sequence: u64, sent_ns: u64) -> Stamp {
        Stamp { sequence, sent_ns, ..Stamp::default() }
    }

    #[test]
    fn replayed_reordered_old_and_unauthorized_commands_are_denied() {
        let mut lease = LeaseKeeper::new(0);
        let mut admit = |sequence, sent, may: &[Domain]| {
            super::admit(&mut sender(may), &mut lease, &WALK, Priority::Normal, &stamp(sequence, sent), NOW)
        };
        let walk = [Domain::Walk];
        for sequence in [0, 4, 5] {
            let denied = Denied::Reason(Reason::Replayed { sequence, last: 5 });
            assert_eq!(admit(sequence, NOW, &walk), Err(denied));
        }
        let old = Denied::Reason(Reason::TooOld { age_ns: MAX_AGE + 1 });
        assert_eq!(admit(6, NOW - MAX_AGE - 1, &walk), Err(old));
        assert!(matches!(admit(6, NOW + MAX_AGE, &walk), Err(Denied::Reason(Reason::FromTheFuture { .. }))));
        assert_eq!(admit(6, NOW, &[Domain::System, Domain::Head]), Err(Denied::NoAccess));
        assert_eq!(lease.holder(NOW), None, "what is denied takes no lease");
    }

    #[test]
    fn whatever_its_holder_sends_renews_the_lease() {
        let (mut sender, mut lease) = (sender(&Domain::ALL), LeaseKeeper::new(0));
        let mut admit = |n, sent, now| {
            super::admit(&mut sender, &mut lease, &WALK, Priority::Normal, &stamp(n, sent), now)
        };
        assert_eq!(admit(6, NOW, NOW), Ok(1));
        let sent = NOW + 3 * MAX_AGE;
        assert!(admit(7, sent, sent + 2 * MAX_AGE).is_err(), "too old");
        assert_eq!(lease.state(sent + 2 * MAX_AGE).until_ns, sent + LEASE);
    }

    #[test]
    fn a_refused_command_uses_its_sequence_up() {
        let (mut sender, mut lease) = (sender(&Domain::ALL), LeaseKeeper::new(0));
        assert!(super::admit(&mut sender, &mut lease, &WALK, Priority::Normal, &stamp(9, 0), NOW).is_err());
        assert!(super::admit(&mut sender, &mut lease, &WALK, Priority::Normal, &stamp(9, NOW), NOW).is_err());
        assert_eq!(
            super::admit(&mut sender, &mut lease, &WALK, Priority::Normal, &stamp(10, NOW), NOW),
            Ok(1)
        );
    }

    #[test]
    fn what_was_sent_before_an_emergency_stop_does_not_come_after_it() {
        let (mut sender, mut lease) = (sender(&Domain::ALL), LeaseKeeper::new(0));
        let mut admit =
            |command, class, n| super::admit(&mut sender, &mut lease, command, class, &stamp(n, NOW), NOW);
        assert_eq!(admit(&Command::EmergencyStop, Priority::High, 8), Ok(0));
        for class in [Priority::Normal, Priority::Low] {
            assert!(matches!(
                admit(&WALK, class, 7),
                Err(Denied::Reason(Reason::Replayed { sequence: 7, last: 8 }))
            ));
        }
        assert_eq!(admit(&WALK, Priority::Normal, 10), Ok(1));
        assert_eq!(admit(&WALK, Priority::Low, 9), Ok(1), "a lower class may be passed");
    }

    /// Nothing moves without the lease, and nothing that stops is ever denied.
    #[test]
    fn every_command_of_the_table_needs_the_lease_or_cannot_move_the_robot() {
        let mut lease = LeaseKeeper::new(0);
        assert_eq!(lease.admit(1, NOW, NOW), Ok(1));
        for info in COMMANDS {
            let command = info.example();
            let admitted = super::admit(
                &mut sender(&Domain::ALL),
                &mut lease,
                &command,
                command.priority(),
                &stamp(6, NOW),
                NOW,
            );
            match info.name {
                "system/emergency_stop"
                | "walk/stop"
                | "system/end"
                | "sim/push"
                | "vision/box"
                | "vision/gone" => {
                    assert_eq!(admitted, Ok(0), "{}", info.name);
                }
                name => assert_eq!(admitted, Err(Denied::LeaseHeld(1)), "{name}"),
            }
            if command.always_passes() {
                let rights = if command == Command::End { &[Domain::System][..] } else { &[] };
                let worst = super::admit(
                    &mut sender(rights),
                    &mut lease,
                    &command,
                    command.priority(),
                    &stamp(0, 0),
                    NOW,
                );
                assert_eq!(worst, Ok(0), "{}", info.name);
            }
        }
    }
}
