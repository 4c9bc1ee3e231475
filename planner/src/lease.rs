//! Lease of the walk: a walk that an operator commanded ends when he is gone; one of the scene's own timeline goes on.
//!
//! The broker reports who holds the command lease and until when. Here nothing is asked of the broker: when it is silent, the
//! time that it reported last runs out. Time is an argument; only what a lease admitted ever ends by it, so that a run without
//! live commands is the same, bit for bit, whatever the clock says.

use messages::{Command, Lease, Live, Verdict};

/// Grant under which the robot walks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct WalkLease {
    /// 0: nobody's walk can be lost.
    grant: u32,
}

impl WalkLease {
    /// Grant of the walk, if its lease is over at `now_ns`; reported once. The robot then has to stop.
    pub fn lost(&mut self, received: Lease, now_ns: u64) -> Option<u32> {
        if self.grant == 0 || received.covers(self.grant, now_ns) {
            return None;
        }
        Some(std::mem::take(&mut self.grant))
    }

    /// The planner took a command, or refused it.
    pub fn follow(&mut self, live: &Live, verdict: Verdict) {
        use Command::{Distance, End, Platform, Start, Stop, Velocity};
        match live.command {
            // A stop that was lost on the way is no stop: only what was accepted counts.
            Start | Velocity(_) | Distance(_) | Platform(_) if verdict.is_ok() => {
                self.grant = live.stamp.grant;
            }
            Stop | End if verdict.is_ok() => self.grant = 0,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::VelocityCommand;
    use messages::{Reason, Stamp};

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.0 });
    const RECEIVED: Lease = Lease { grant: 7, until_ns: 500 };

    fn live(command: Command, grant: u32) -> Live {
        Live { command, stamp: Stamp { origin: 1, grant, ..Stamp::default() } }
    }

    fn walking() -> WalkLease {
        let mut walk = WalkLease::default();
        walk.follow(&live(WALK, 7), Ok(()));
        assert_eq!(walk.lost(RECEIVED, 500), None);
        walk
    }

    #[test]
    fn a_walk_ends_with_its_lease_and_once() {
        let mut walk = walking();
        assert_eq!(walk.lost(RECEIVED, 501), Some(7), "the broker fell silent");
        assert_eq!(walk.lost(RECEIVED, 502), None);
        assert_eq!(walking().lost(Lease::default(), 1), Some(7), "released");
        assert_eq!(walking().lost(Lease { grant: 8, until_ns: 900 }, 1), Some(7), "somebody else's");
        assert_eq!(walking().lost(Lease { until_ns: 900, ..RECEIVED }, 899), None, "renewed, or taken over");
    }

    #[test]
    fn what_the_scene_commands_needs_no_lease() {
        let mut walk = WalkLease::default();
        walk.follow(&Live::of_scene(WALK), Ok(()));
        assert_eq!(walk.lost(Lease::default(), u64::MAX), None);
        let mut walk = walking();
        walk.follow(&Live::of_scene(Command::Start), Ok(()));
        assert_eq!(walk.lost(Lease::default(), u64::MAX), None, "the scene has taken it over");
    }

    #[test]
    fn a_refused_command_changes_nothing_and_a_stop_ends_it() {
        let mut walk = walking();
        walk.follow(&live(WALK, 9), Err(Reason::NotStanding));
        walk.follow(&live(Command::Stand, 9), Ok(()));
        assert_eq!(walk.lost(Lease::default(), 1), Some(7));
        let mut walk = walking();
        walk.follow(&live(Command::Stop, 0), Ok(()));
        assert_eq!(walk.lost(Lease::default(), 1), None);
    }
}
