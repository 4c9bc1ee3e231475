//! `cycle_inputs/PROCESS` and `commands/PROCESS`: what a cycle began with. With the records that these name, the same
//! step does the same again (`gangwerk replay`).

use crate::command::Domain;
use crate::command_text::MAX_FIELDS;
use crate::{Command, Header, Live, Process, Reason, Stamp, Verdict, record};

/// Most topics that one step reads.
pub const MAX_USED: usize = 3;

record! {
    /// Which record of a topic was used.
    part Used {
        /// \[1\] Its writer's epoch; 0: there was none yet.
        epoch: u64,
        /// \[1\] Its tick; of `frames_in` its number, from 1.
        tick: u64,
    }
}

record! {
    /// Inputs of one cycle of a process, besides its configuration. Written by every cyclic process at the end of
    /// each cycle.
    record CycleInputs {
        /// Tick and stamp that the process knew in this cycle.
        header: Header,
        /// \[1\] Cycles of this process so far, this one included.
        cycle: u64,
        /// \[1\] Commands of this cycle, in `commands/PROCESS`, refused ones included.
        commands: u64,
        /// \[1\] Own cycles missed since the last one; of watchdog only.
        skipped: u64,
        /// \[1\] 1: the look came late; of watchdog only.
        late: u64,
        /// \[1\] [`EventCode`](crate::EventCode) for which the run-time system wants a controlled stop; of lowlevel only.
        cause: u64,
        /// The records used, in the order of [`inputs_of`].
        used: [Used; MAX_USED],
    }
}

/// Topics that the step of a process reads, in the order of [`CycleInputs::used`].
pub const fn inputs_of(process: Process) -> &'static [&'static str] {
    match process {
        Process::Planner => &["controller_state"],
        Process::Controller => &["sensors", "plan"],
        Process::Lowlevel => &["joint_targets", "frames_in", "joint_tables"],
        Process::Watchdog => &["watchdog_reset"],
        _ => &[],
    }
}

impl Used {
    /// The record with this header, if there is one.
    pub fn of(header: Option<&Header>) -> Self {
        header.map_or(Self::default(), |h| Self { epoch: h.epoch, tick: h.tick })
    }
}

record! {
    /// A command, and what became of it in the process that took it or left it out.
    record CommandTaken {
        /// Tick and stamp of the cycle.
        header: Header,
        /// \[1\] Number of the cycle, as in [`CycleInputs`].
        cycle: u64,
        /// \[1\] Connection of the sender; 0: the scene's own timeline, or the process itself.
        origin: u64,
        /// \[1\] Lease under which it was admitted; 0: none was needed.
        grant: u64,
        /// \[1\] Number of the command on its connection.
        sequence: u64,
        /// \[ns\] CLOCK_MONOTONIC when it was given.
        sent_ns: u64,
        /// \[1\] Domain of the message.
        domain: u64,
        /// \[1\] Its number in the domain.
        id: u64,
        /// Its numbers, in the order of `gangwerk topic list`.
        values: [f64; MAX_FIELDS],
        /// \[1\] 1: the step saw it; 0: it was left out before, as too old or without the lease.
        seen: u64,
        /// \[1\] 0: accepted; otherwise the number of the reason, as in the protocol.
        refused: u64,
        /// \[1\] Of the reason: field; age or lead \[ns\]; sequence; code of the event.
        about: u64,
        /// \[1\] Of the reason: last sequence; detail of the event.
        detail: u64,
        /// Least and greatest value, if the reason is a limit.
        limits: [f64; 2],
    }
}

impl CommandTaken {
    /// The command of a cycle. `seen`: the step saw it.
    pub fn new(header: Header, cycle: u64, live: &Live, verdict: &Verdict, seen: bool) -> Self {
        let Stamp { origin, grant, sequence, sent_ns } = live.stamp;
        let (domain, id) = live.command.address();
        let mut taken = Self {
            header,
            cycle,
            origin: origin.into(),
            grant: grant.into(),
            sequence,
            sent_ns,
            domain: domain as u64,
            id: id.into(),
            values: std::array::from_fn(|i| live.command.value(i)),
            seen: seen.into(),
            ..Self::default()
        };
        // A refusal has up to two numbers and two limits, by kind of reason; `verdict` reads them back.
        let Err(reason) = *verdict else { return taken };
        taken.refused = reason.code().into();
        (taken.about, taken.detail) = match reason {
            Reason::TooOld { age_ns: ns } | Reason::FromTheFuture { lead_ns: ns } => (ns, 0),
            Reason::Replayed { sequence, last } => (sequence, last),
            Reason::Limit { field, low, high } => {
                taken.limits = [low, high];
                (field.into(), 0)
            }
            Reason::Loaded { load, most } => {
                taken.limits = [0.0, most];
                (load as u64, 0)
            }
            Reason::Event { code, detail } => (code as u64, detail.pack()),
            Reason::LeaseLost | Reason::NotStanding | Reason::NotNow => (0, 0),
        };
        taken
    }

    /// The command; none if the numbers are those of no command.
    pub fn command(&self) -> Option<Command> {
        let domain = Domain::try_from(u16::try_from(self.domain).ok()?).ok()?;
        Command::of_values((domain, u16::try_from(self.id).ok()?), &self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_text::COMMANDS;

    #[test]
    fn every_command_comes_back_from_its_record_bit_for_bit() {
        for info in COMMANDS {
            let values = [3.0, -0.1, f64::MIN_POSITIVE, 1.0 / 3.0, 0.7, 1.1, 1e9, -0.0, 0.3];
            let command = Command::of_values(info.example().address(), &values).unwrap();
            let live = Live::of_scene(command);
            let taken = CommandTaken::new(Header::default(), 1, &live, &Ok(()), true);
            assert_eq!(taken.command(), Some(command), "{}", info.name);
        }
        let nobody = CommandTaken { domain: 1, id: 99, ..CommandTaken::default() };
        assert_eq!(nobody.command(), None);
    }

    #[test]
    fn a_refusal_keeps_its_numbers() {
        let refused = Err(Reason::Limit { field: 2, low: -0.3, high: 1.4 });
        let live = Live::of_scene(Command::Stop);
        let taken = CommandTaken::new(Header::default(), 7, &live, &refused, true);
        assert_eq!((taken.refused, taken.about, taken.limits), (30, 2, [-0.3, 1.4]));
    }
}
