//! The command lease: one client at a time moves the robot, for as long as it shows that it is there.
//!
//! It is granted with the first command that needs it, renewed by everything its holder sends, and over 500 ms after
//! the holder was last heard, at once when its connection closes. Somebody else gets it then, under a new number, or
//! earlier by an explicit take-over, under the same number: the walk goes on in other hands. Processes that carry out
//! commands know the number: what was commanded under one that is over comes to a stop.
//!
//! Renewals count from the time that the *sender* gave: what waited in the socket of a stalled broker renews nothing.

use messages::Lease;
use messages::command_stamp::LEASE;

/// Numbers of grants have 24 bits, so that number and end of a lease are one atomic word for a control cycle.
const GRANTS: u32 = 0x00ff_ffff;

/// Holder of the lease, and its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LeaseKeeper {
    holder: Option<Holder>,
    /// Number of the newest grant.
    grant: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Holder {
    token: u32,
    /// \[ns\] Time of its last message, by its own clock.
    heard_ns: u64,
}

impl LeaseKeeper {
    /// Nobody holds the lease. Numbers begin after `seed`, a time: a broker that was started again gives no number that
    /// the one before gave shortly ago.
    pub const fn new(seed: u64) -> Self {
        Self { holder: None, grant: seed as u32 & GRANTS }
    }

    /// Holder at `now_ns`; none if nobody was heard in time.
    pub fn holder(&self, now_ns: u64) -> Option<u32> {
        self.holder.filter(|h| now_ns <= h.heard_ns + LEASE).map(|h| h.token)
    }

    /// State of the lease for those who carry out commands.
    pub fn state(&self, now_ns: u64) -> Lease {
        match self.holder.filter(|h| now_ns <= h.heard_ns + LEASE) {
            Some(h) => Lease { grant: self.grant, until_ns: h.heard_ns + LEASE },
            None => Lease::default(),
        }
    }

    /// Number of the grant under which a command of `token`, sent at `sent_ns`, may pass; takes the lease if it is free.
    ///
    /// # Errors
    /// Somebody else holds it: who.
    pub fn admit(&mut self, token: u32, sent_ns: u64, now_ns: u64) -> Result<u32, u32> {
        match self.holder(now_ns) {
            Some(other) if other != token => return Err(other),
            Some(_) => {}
            None => {
                self.grant = if self.grant >= GRANTS { 1 } else { self.grant + 1 };
                self.holder = Some(Holder { token, heard_ns: sent_ns.min(now_ns) });
            }
        }
        self.renew(token, sent_ns, now_ns);
        Ok(self.grant)
    }

    /// Heartbeat of `token`, sent at `sent_ns`. One that comes after the end renews nothing.
    pub fn renew(&mut self, token: u32, sent_ns: u64, now_ns: u64) {
        if self.holder(now_ns) == Some(token)
            && let Some(holder) = &mut self.holder
        {
            holder.heard_ns = holder.heard_ns.max(sent_ns.min(now_ns));
        }
    }

    /// Take-over by `token`: whose lease it was. What was commanded under it goes on.
    pub fn take_over(&mut self, token: u32, sent_ns: u64, now_ns: u64) -> Option<u32> {
        let former = self.holder(now_ns).filter(|&former| former != token);
        match (&mut self.holder, former) {
            (Some(holder), Some(_)) => *holder = Holder { token, heard_ns: sent_ns.min(now_ns) },
            _ => _ = self.admit(token, sent_ns, now_ns),
        }
        former
    }

    /// `token` gives the lease back, or its connection is closed; whether it held it.
    pub fn release(&mut self, token: u32) -> bool {
        let held = self.holder.is_some_and(|h| h.token == token);
        if held {
            self.holder = None;
        }
        held
    }

    /// Whose lease has just run out.
    pub fn expire(&mut self, now_ns: u64) -> Option<u32> {
        let over = self.holder.filter(|h| now_ns > h.heard_ns + LEASE)?;
        self.holder = None;
        Some(over.token)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn one_holds_it_until_half_a_second_after_it_was_heard() {
        let mut lease = LeaseKeeper::new(7);
        assert_eq!(lease.admit(1, 100, 100), Ok(8));
        assert_eq!(lease.admit(2, 200, 200), Err(1));
        lease.renew(1, 300, 300);
        assert_eq!(lease.state(300), Lease { grant: 8, until_ns: 300 + LEASE });
        assert_eq!((lease.holder(300 + LEASE), lease.expire(300 + LEASE)), (Some(1), None));
        assert_eq!((lease.holder(301 + LEASE), lease.expire(301 + LEASE)), (None, Some(1)));
        assert_eq!(lease.admit(2, 302 + LEASE, 302 + LEASE), Ok(9));
    }

    /// The broker stood still; what its clients sent meanwhile lies in its sockets.
    #[test]
    fn a_heartbeat_counts_from_when_it_was_sent() {
        let mut lease = LeaseKeeper::new(0);
        assert_eq!(lease.admit(1, 0, 0), Ok(1));
        let after = 3 * LEASE;
        lease.renew(1, LEASE / 2, after);
        assert_eq!(lease.state(after), Lease::default());
        assert_eq!(lease.admit(2, after, after), Ok(2), "a new number: the walk of the first is over");
        lease.renew(1, after, after);
        assert_eq!(lease.holder(after), Some(2));
        lease.renew(2, u64::MAX, after);
        assert_eq!(lease.state(after).until_ns, after + LEASE, "a clock that is ahead gains nothing");
    }

    #[test]
    fn a_take_over_keeps_the_number_and_names_the_former_holder() {
        let mut lease = LeaseKeeper::new(0);
        assert_eq!(lease.take_over(5, 1, 1), None);
        assert_eq!(lease.take_over(6, 2, 2), Some(5));
        assert_eq!((lease.holder(2), lease.state(2).grant), (Some(6), 1));
        assert_eq!(lease.take_over(6, 3, 3), None);
        assert!(!lease.release(5) && lease.release(6));
        assert_eq!(lease.state(3), Lease::default());
    }

    proptest! {
        /// Whatever happens, one number never has two holders unless the second took it over, and nobody holds the lease
        /// later than [`LEASE`] after it was last heard.
        #[test]
        fn no_grant_changes_hands_by_itself(steps in prop::collection::vec((0u8..5, 1u32..4, 0u64..400_000_000, 0u64..400_000_000), 0..60)) {
            let mut lease = LeaseKeeper::new(0);
            let (mut now, mut heard, mut owner) = (1_000_000_000, [0u64; 4], (0, 0));
            for (what, token, wait, age) in steps {
                now += wait;
                let sent = now - age;
                let before = lease.holder(now);
                match what {
                    0 => _ = lease.admit(token, sent, now),
                    1 => lease.renew(token, sent, now),
                    2 => _ = lease.release(token),
                    3 => _ = lease.expire(now),
                    _ => {
                        lease.take_over(token, sent, now);
                        owner = (lease.state(now).grant, token);
                    }
                }
                heard[token as usize] = heard[token as usize].max(sent);
                if let Some(holder) = lease.holder(now) {
                    prop_assert!(now <= heard[holder as usize] + LEASE);
                    let grant = lease.state(now).grant;
                    prop_assert!(owner.0 != grant || owner.1 == holder, "grant {grant}: {owner:?}, now {holder}");
                    prop_assert!(what == 4 || before.is_none_or(|b| b == holder));
                    owner = (grant, holder);
                }
            }
        }
    }
}
