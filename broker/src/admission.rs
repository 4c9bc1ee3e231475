//! Admission of one command, or of a request for the lease: rights of its sender, sequence, age, lease. No clock and no
//! socket: time is an argument.

use messages::command::{Domain, Priority};
use messages::command_text::COMMANDS;
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

/// Reason of the broker for not passing a command on, or not giving the lease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Denied {
    /// Age or sequence.
    Reason(Reason),
    /// The sender may not command this domain, or nothing that needs the lease.
    NoAccess,
    /// Another one holds the lease: the number of its connection.
    LeaseHeld(u32),
}

impl Sender {
    const fn commands(&self, domain: Domain) -> bool {
        self.may & 1 << domain as u16 != 0
    }

    const fn may_command(&self, command: &Command) -> bool {
        self.commands(command.address().0)
    }

    /// Right to some command that needs the lease.
    fn may_hold_lease(&self) -> bool {
        let commands = COMMANDS.iter().map(|info| info.example());
        commands.filter(Command::needs_lease).any(|command| self.may_command(&command))
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
    // Whatever its holder sends is a heartbeat; only what moves the robot takes a lease that is free.
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

/// The lease on request; whose it was, if it was somebody else's. `over`: also from whoever holds it.
///
/// # Errors
/// The right or age that is missing, or who holds the lease and keeps it.
pub fn take_lease(
    sender: &Sender,
    lease: &mut LeaseKeeper,
    stamp: &Stamp,
    over: bool,
    now_ns: u64,
) -> Result<Option<u32>, Denied> {
    lease.renew(sender.token, stamp.sent_ns, now_ns);
    if !sender.may_hold_lease() {
        return Err(Denied::NoAccess);
    }
    // A lease that begins long ago would be over at once, and with it the walk of the former holder.
    stamp.check_age(now_ns).map_err(Denied::Reason)?;
    // Taking over a walk takes the right to end it.
    let over = over && sender.commands(Domain::Walk);
    match lease.holder(now_ns).filter(|holder| *holder != sender.token) {
        Some(holder) if !over => Err(Denied::LeaseHeld(holder)),
        _ => Ok(lease.take_over(sender.token, stamp.sent_ns, now_ns)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::VelocityCommand;
    use messages::command_stamp::{LEASE, MAX_AGE};
    use proptest::prelude::*;

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

    /// A camera's key took the lease from the operator, who could neither steer nor end his walk any more.
    #[test]
    fn who_can_command_nothing_under_the_lease_holds_none_and_who_cannot_walk_takes_none_over() {
        for domain in Domain::ALL {
            let take = |lease: &mut LeaseKeeper, over| {
                super::take_lease(&sender(&[domain]), lease, &stamp(6, NOW), over, NOW)
            };
            let holds = !matches!(domain, Domain::Log | Domain::Vision);
            for over in [false, true] {
                let mut free = LeaseKeeper::new(0);
                let expected = if holds { Ok(None) } else { Err(Denied::NoAccess) };
                assert_eq!(take(&mut free, over), expected, "{domain:?}");
                assert_eq!(free.holder(NOW), holds.then_some(3), "{domain:?}");
                let mut held = LeaseKeeper::new(0);
                assert_eq!(held.admit(1, NOW, NOW), Ok(1));
                let takes = over && domain == Domain::Walk;
                let expected = match holds {
                    true if takes => Ok(Some(1)),
                    true => Err(Denied::LeaseHeld(1)),
                    false => Err(Denied::NoAccess),
                };
                assert_eq!(take(&mut held, over), expected, "{domain:?}");
                assert_eq!(held.holder(NOW), Some(if takes { 3 } else { 1 }), "{domain:?}");
            }
        }
    }

    proptest! {
        /// A request of two seconds ago was accepted: the lease was over at once, and with it the walk of its holder.
        #[test]
        fn a_request_for_the_lease_is_taken_at_the_age_of_a_command_and_not_after(
            sent in prop_oneof![
                Just(0), Just(u64::MAX), 0..NOW, NOW - 2 * MAX_AGE..=NOW, NOW..NOW + MAX_AGE,
                Just(NOW - MAX_AGE), Just(NOW - MAX_AGE - 1),
            ],
            over: bool,
            held: bool,
        ) {
            let mut lease = LeaseKeeper::new(0);
            if held {
                lease.admit(1, NOW, NOW).unwrap();
            }
            let taken = super::take_lease(&sender(&[Domain::Walk]), &mut lease, &stamp(6, sent), over, NOW);
            let command = super::admit(
                &mut sender(&[Domain::Walk]), &mut LeaseKeeper::new(0), &WALK, Priority::Normal, &stamp(6, sent), NOW,
            );
            match command {
                Err(denied) => {
                    prop_assert_eq!(taken, Err(denied));
                    prop_assert_eq!(lease.holder(NOW), held.then_some(1));
                }
                Ok(_) => prop_assert_eq!(taken.is_ok(), over || !held),
            }
        }
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
