//! The far end of a Sercos ring: a slave for each local controller of the simulated robot.
//!
//! The slaves pass telegrams on whenever they come. The acknowledge telegrams of a cycle with new commands wait until
//! the robot has moved, so that they bring the answer to these commands, as on the other buses.

use std::error::Error;
use std::time::Duration;

use codec::layout::FrameLayout;
use daemon::Daemon;
use messages::BusFrames;
use realtime::clock;
use sercos::packing::{Interfaces, Packing, stations, sync_counter};
use sercos::{CommunicationPhase, Far, Slave};

use crate::far_end::FarEnd;

/// In lockstep: between two looks whether to end.
const LOOK: u64 = clock::SECOND / 50;
/// In lockstep: the telegrams of one port may be this much later than those of the other \[ns\].
const GRACE: u64 = clock::SECOND / 20;

/// Slaves in a ring or a line.
pub(crate) struct SercosEnd {
    far: Far,
    layout: FrameLayout,
    commands: Packing,
    feedback: Packing,
    /// Commands of the cycle that is coming in.
    gathered: BusFrames,
    /// Nodes that have them.
    have: Vec<bool>,
    /// When the first of them was there \[ns\].
    since: Option<u64>,
    tick: u64,
    whole: BusFrames,
    period_ns: u64,
    grace: u64,
    /// Until when cycles without telegrams were counted \[ns\].
    counted: u64,
}

impl SercosEnd {
    /// Opens the interfaces.
    pub(crate) fn new(d: &Daemon, place: &str) -> Result<Self, Box<dyn Error>> {
        let interfaces: Interfaces = place.parse()?;
        let (first, second) = interfaces.far.ok_or_else(|| {
            format!(
                "sim-backend: bus `sercos:{place}` has no interface for the simulated robot; add it (sercos:NEAR/FAR), or \
                 use --no-robot if there is a real one"
            )
        })?;
        let layout = d.setup.robot.layout.clone();
        let slaves: Vec<_> =
            stations(&layout).iter().map(|s| Slave::new(s.address, s.command, s.feedback)).collect();
        // In real time the robot answers within the cycle, complete or not.
        let grace = if d.mode == ipc::Mode::Lockstep { GRACE } else { d.period_ns() / 4 };
        Ok(Self {
            have: vec![false; slaves.len()],
            far: Far::open(&first, second.as_deref(), slaves, true)?,
            commands: Packing::new(&layout, true),
            feedback: Packing::new(&layout, false),
            layout,
            gathered: BusFrames::default(),
            since: None,
            tick: 0,
            whole: BusFrames::default(),
            period_ns: d.period_ns(),
            grace,
            counted: clock::now(),
        })
    }

    /// Passes telegrams on; whether a cycle is whole: every slave has its commands, or those that are missing have had
    /// time enough.
    fn gather(&mut self) -> bool {
        self.far.pass();
        for (node, slave) in self.far.chain_mut().slaves_mut().iter_mut().enumerate() {
            let operating = slave.phase() == Some(CommunicationPhase::Cp4);
            let Some(data) = slave.take_command().filter(|_| operating) else { continue };
            if std::mem::replace(&mut self.have[node], true) {
                continue; // of the next cycle already: the robot was too slow for this one
            }
            self.commands.unpack(&self.layout, node, data, &mut self.gathered);
        }
        if !self.have.contains(&true) {
            self.far.answer(); // nothing new to answer to
            return false;
        }
        let now = clock::now();
        let since = *self.since.get_or_insert(now);
        if self.have.contains(&false) && now - since < self.grace {
            return false;
        }
        self.finish(now);
        true
    }

    /// The gathered cycle is the one that is held.
    fn finish(&mut self, now: u64) {
        let found = self.gathered.as_slice().iter().find_map(|f| sync_counter(&self.layout, f));
        if let Some((counter, bits)) = found {
            // The tick is the next one with these low bits.
            self.tick += counter.wrapping_sub(self.tick) & ((1 << bits) - 1);
        }
        self.gathered.header.tick = self.tick;
        self.gathered.header.stamp_ns = now;
        std::mem::swap(&mut self.whole, &mut self.gathered);
        self.gathered.count = 0;
        self.have.fill(false);
        self.since = None;
    }
}

impl FarEnd for SercosEnd {
    fn refresh(&mut self) -> bool {
        self.gather()
    }

    fn held(&self) -> Option<&BusFrames> {
        (self.whole.header.tick > 0).then_some(&self.whole)
    }

    fn answer(&mut self, _: &Daemon, frames: &BusFrames) {
        self.feedback.pack(&self.layout, frames);
        for (node, slave) in self.far.chain_mut().slaves_mut().iter_mut().enumerate() {
            if let Some(data) = self.feedback.data(node) {
                slave.set_feedback(data);
            }
        }
        self.far.answer();
    }

    fn wait(&mut self, at_most: Duration) {
        let at_most = at_most.as_nanos() as u64;
        let at_most = if self.since.is_some() { at_most.min(self.grace) } else { at_most };
        let came = self.far.await_telegrams(at_most);
        let now = clock::now();
        // Of real time only: in lockstep nobody knows how long a cycle takes.
        let periods = if came { 0 } else { (now - self.counted) / self.period_ns };
        (0..periods).for_each(|_| self.far.chain_mut().silence());
        self.counted = if came { now } else { self.counted + periods * self.period_ns };
    }

    fn next(&mut self, d: &Daemon) -> Result<bool, Box<dyn Error>> {
        let begun = clock::now();
        while !d.stop.asked() {
            if self.gather() {
                self.whole.header.stamp_ns = self.tick * self.period_ns;
                return Ok(true);
            }
            // Before the first cycle lowlevel may still be starting.
            if clock::now() - begun > d.patience().as_nanos() as u64 && self.tick > 0 {
                let seconds = d.patience().as_secs_f64();
                return Err(format!(
                    "sim-backend: lockstep: lowlevel sent no telegrams for {seconds} s; is it running?"
                )
                .into());
            }
            self.far.await_telegrams(LOOK.min(if self.since.is_some() { self.grace } else { LOOK }));
        }
        Ok(false)
    }
}
