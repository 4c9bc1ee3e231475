//! `power` and `watchdog_reset`: the motor supply and what keeps it on.

use crate::{Header, record};

record! {
    /// State of the motor supply. Written by watchdog.
    ///
    /// The supply is on only while `toggle` moves: a dead watchdog is a switched-off robot. The relay closes once for each
    /// `arming` of a watchdog: whatever made it fall, it takes another reset edge and another enable edge.
    record Power {
        /// Tick of the last reset the watchdog has seen.
        header: Header,
        /// \[1\] Counts up once per cycle while the supply shall be on.
        toggle: u64,
        /// \[1\] 1: supply on. Latched: once 0 it stays 0 until a reset edge and then an enable edge.
        on: u64,
        /// \[1\] Counts the pairs of a reset edge and an enable edge, of this writer.
        arming: u64,
        /// \[1\] Cause of its being off: an [`EventCode`](crate::EventCode), 0 while on.
        reason: u64,
        /// \[1\] Watchdog cycles since the last reset was seen.
        missed: u64,
    }
}

record! {
    /// The heartbeat of the joint loop. Written by lowlevel once per cycle.
    record WatchdogReset {
        /// Tick of the bus cycle.
        header: Header,
        /// \[1\] 0: all is well; otherwise the [`EventCode`](crate::EventCode) for which power shall go off.
        trip: u64,
        /// \[1\] 1 while the motor supply is on, as measured at the robot.
        supply: u64,
    }
}
