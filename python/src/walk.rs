//! A walk: the chain of a scene, what it has told so far, and the pushes still to come.
//!
//! All of it can be cloned: a copy that goes on gives the same bytes as the original.

use std::error::Error;
use std::sync::Arc;

use chain::Chain;
use chain::ending::Ending;
use chain::figures::{Figures, Gatherer};
use config::Setup;
use messages::command::PushCommand;
use messages::{Command, Detail, EventCode, Process, Reason};

/// \[s\] Rounding of an instant that is a whole number of cycles.
const ROUNDING: f64 = 1e-9;

/// Something a process told, in the cycle that ended at this tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Told {
    /// Tick.
    pub(crate) tick: u64,
    /// Process.
    pub(crate) process: Process,
    /// Code.
    pub(crate) code: EventCode,
    /// Detail.
    pub(crate) detail: Detail,
}

/// Outcome of a command: the process that took it, or the process that refused it, with number and text of the reason.
pub(crate) type Answer = Result<&'static str, (u8, String)>;

/// A walk so far.
#[derive(Clone)]
pub(crate) struct Walk {
    /// Configuration that is walked.
    pub(crate) setup: Arc<Setup>,
    /// The processes.
    pub(crate) chain: Chain,
    ending: Ending,
    gatherer: Gatherer,
    /// Events that nobody has asked for yet.
    pub(crate) told: Vec<Told>,
    /// Pushes still to begin \[s\], ascending; none of them overlap.
    pushes: Vec<(f64, PushCommand)>,
    /// \[s\] End of the push that is under way.
    pushed_until: f64,
}

impl Walk {
    /// The begin of a scene.
    ///
    /// # Errors
    /// The configuration does not fit together.
    pub(crate) fn new(setup: Setup) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            chain: Chain::new(&setup)?,
            setup: Arc::new(setup),
            ending: Ending::default(),
            gatherer: Gatherer::default(),
            told: Vec::new(),
            pushes: Vec::new(),
            pushed_until: 0.0,
        })
    }

    /// \[s\] Time: cycles so far.
    pub(crate) fn time(&self) -> f64 {
        self.chain.tick() as f64 * self.chain.cycle()
    }

    /// One cycle.
    pub(crate) fn step(&mut self) {
        // As a push of the scene: it acts in the cycles whose middle lies between its begin and its end.
        let (now, middle) = (self.chain.robot().time(), 0.5 * self.chain.cycle());
        while let Some((at, push)) = self.pushes.first().filter(|(at, _)| *at <= now + middle).copied() {
            self.pushed_until = at + push.duration;
            self.chain.push(&PushCommand { duration: self.pushed_until - now, ..push });
            self.pushes.remove(0);
        }
        let cycle = self.chain.step();
        let tick = cycle.sensors.header.tick;
        let told = cycle.events.iter().map(|&(process, code, detail)| Told { tick, process, code, detail });
        self.told.extend(told);
        let time = tick as f64 * self.setup.scene.cycle;
        self.ending.follow(time, cycle);
        self.gatherer.add(&cycle.sim_state, &cycle.controller_state);
    }

    /// Whether the robot lies, or the simulation has lost its numbers, for so long that nothing more comes.
    pub(crate) fn is_over(&self) -> bool {
        self.ending.is_over(self.time())
    }

    /// When it fell \[s\], if it did.
    pub(crate) fn fell(&self) -> Option<f64> {
        self.ending.fell()
    }

    /// Figures so far, those of the clock aside.
    pub(crate) fn figures(&self) -> Figures {
        self.gatherer.figures(&self.setup, 0.0, None).ended(&self.ending)
    }

    /// A push that begins at `at` \[s\], or in the next cycle.
    ///
    /// # Errors
    /// It would begin in the past, or act at the same time as another one.
    pub(crate) fn push(&mut self, push: PushCommand, at: Option<f64>) -> Result<(), String> {
        let now = self.chain.robot().time();
        let at = at.unwrap_or(now);
        if at < now - ROUNDING {
            return Err(format!("at = {at} s lies before the next cycle, which begins at {now:.4} s"));
        }
        let meets = |&(begin, other): &(f64, PushCommand)| {
            at < begin + other.duration - ROUNDING && begin < at + push.duration - ROUNDING
        };
        if at < self.pushed_until - ROUNDING || self.pushes.iter().any(meets) {
            return Err(format!(
                "at = {at} s: another push acts in the {} s from then on, and there is one at a time",
                push.duration
            ));
        }
        let place = self.pushes.partition_point(|(begin, _)| *begin <= at);
        self.pushes.insert(place, (at, push));
        Ok(())
    }

    /// A command, taken by its process in the next cycle; the answer is that of a copy, which runs this cycle now.
    pub(crate) fn command(&mut self, command: &Command) -> Answer {
        if *command == Command::End {
            return Err((
                Reason::NotNow.code(),
                "there is no supervisor in one process; walk/stop ends the walk".into(),
            ));
        }
        let mut ahead = self.chain.clone();
        ahead.command(command);
        let answers = &ahead.step().answers;
        let verdict = answers.iter().rev().find(|(other, _)| other == command).map(|(_, verdict)| *verdict);
        self.chain.command(command);
        match verdict {
            Some(Ok(())) => Ok(command.decided_by()),
            Some(Err(reason)) => Err((reason.code(), reason.text(command))),
            None => Err((Reason::NotNow.code(), "too many commands in one cycle: step first".into())),
        }
    }
}
