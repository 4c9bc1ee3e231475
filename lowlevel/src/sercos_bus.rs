//! Near end of a Sercos ring: the master.

use std::error::Error;
use std::time::Duration;

use messages::{BusFrames, Detail, EventCode, EventQueue};
use realtime::clock;
use sercos::packing::{Interfaces, Packing, stations};
use sercos::{MasterSetup, Near, RingEvent, Stage};

use crate::fieldbus::{BusSettings, Fieldbus, RunControl};

/// In lockstep: between two looks whether to end.
const LOOK: u64 = clock::SECOND / 50;
/// In lockstep: telegrams that go another way than in the cycle before are not waited for longer than this \[ns\].
const GRACE: u64 = clock::SECOND / 10;
/// While starting: how long a telegram may be under way \[ns\].
const UNDER_WAY: u64 = 3 * clock::SECOND / 1000;

/// A ring or line of slaves, one for each local controller.
pub(crate) struct SercosBus {
    near: Near,
    settings: BusSettings,
    commands: Packing,
    feedback: Packing,
    rx: BusFrames,
    /// Cycle that is to be answered.
    asked: u64,
    /// Telegrams have been sent, and the cycle has not been ended.
    open: bool,
    /// The motor supply is off.
    idle: bool,
}

impl SercosBus {
    /// Opens the interfaces. Nothing is sent.
    pub(crate) fn new(settings: BusSettings, place: &str) -> Result<Self, Box<dyn Error>> {
        let Interfaces { near: (first, second), .. } = place.parse()?;
        let setup = MasterSetup {
            cycle: u32::try_from(settings.period_ns)?,
            losses: settings.losses,
            beat_losses: settings.losses,
            stations: stations(&settings.layout),
            ports: [None; 2],
        };
        let near = Near::open(&first, second.as_deref(), setup)?;
        Ok(Self {
            near,
            commands: Packing::new(&settings.layout, true),
            feedback: Packing::new(&settings.layout, false),
            rx: BusFrames::default(),
            asked: 0,
            open: false,
            idle: true,
            settings,
        })
    }

    fn nodes(&self) -> usize {
        self.settings.layout.nodes.len()
    }

    /// The frames of the cycle that has just ended.
    fn unpack(&mut self) {
        self.open = false;
        self.rx.count = 0;
        self.rx.header.tick = self.asked;
        for node in 0..self.nodes() {
            if let Some(data) = self.near.master().feedback(node) {
                self.feedback.unpack(&self.settings.layout, node, data, &mut self.rx);
            }
        }
    }

    /// Slaves that fell out of operation are started again, all of them. While some still work and the motor supply is on,
    /// that waits: they would lose their data.
    fn take_back(&mut self) {
        let fallen = self.near.master().fallen();
        let failed = matches!(self.near.master().stage(), Stage::Failed(_));
        if failed || fallen == self.nodes() || fallen > 0 && self.idle {
            self.near.master_mut().restart();
        }
    }

    /// One cycle of the start; of real time in lockstep, too: whoever is switched on needs it.
    fn start_cycle(&mut self, begun: u64) -> Stage {
        clock::sleep_until(begun + self.settings.period_ns);
        self.near.send();
        self.near.receive_all(UNDER_WAY)
    }
}

impl Fieldbus for SercosBus {
    fn start(&mut self, run: &dyn RunControl) -> Result<bool, Box<dyn Error>> {
        let mut received = vec![false; self.nodes()];
        let begun = clock::now();
        while !run.is_ending() {
            match self.start_cycle(clock::now()) {
                Stage::Failed(trouble) => return Err(format!("lowlevel: {trouble}").into()),
                Stage::Starting(_) => continue,
                Stage::Running => {}
            }
            // The first data of each slave: where its drives are, before anything is commanded.
            for (node, received) in received.iter_mut().enumerate() {
                if let Some(data) = self.near.master().feedback(node).filter(|_| !*received) {
                    self.feedback.unpack(&self.settings.layout, node, data, &mut self.rx);
                    *received = true;
                }
            }
            if received.iter().all(|received| *received) {
                return Ok(true);
            }
            if clock::now() - begun > self.settings.patience_ns + 10 * clock::SECOND {
                let silent = received.iter().position(|received| !received).unwrap_or(0);
                return Err(format!(
                    "lowlevel: sercos: slave {} ({}) is in CP4 and sends no data; switch it off and on",
                    silent + 1,
                    self.settings.layout.nodes[silent]
                )
                .into());
            }
        }
        Ok(false)
    }

    fn set_idle(&mut self, idle: bool) {
        self.idle = idle;
    }

    fn send(&mut self, frames: &BusFrames) {
        self.take_back();
        self.asked = frames.header.tick;
        self.commands.pack(&self.settings.layout, frames);
        for node in 0..self.nodes() {
            if let Some(data) = self.commands.data(node) {
                self.near.master_mut().set_command(node, data);
            }
        }
        self.near.send();
        self.open = true;
    }

    fn receive(&mut self) -> Option<&BusFrames> {
        if self.open {
            self.near.receive();
            self.unpack();
        }
        (self.asked > 0 || self.rx.count > 0).then_some(&self.rx)
    }

    fn wait(&mut self, run: &dyn RunControl, _: u64) -> Result<bool, Box<dyn Error>> {
        let begun = clock::now();
        while self.open && !run.is_ending() {
            let waited = clock::now() - begun;
            if self.near.drain() || self.near.master().has_some() && waited > GRACE {
                self.near.end();
                self.unpack();
                return Ok(true);
            }
            if waited > self.settings.patience_ns {
                let seconds = Duration::from_nanos(self.settings.patience_ns).as_secs_f64();
                return Err(format!(
                    "lowlevel: no telegram came back from the Sercos slaves within {seconds} s; are they running, and \
                     their cables plugged?"
                )
                .into());
            }
            self.near.wait(LOOK);
        }
        Ok(!run.is_ending())
    }

    fn report(&mut self, events: &mut EventQueue) {
        while let Some(event) = self.near.master_mut().take_event() {
            match event {
                RingEvent::RingBroken(before, behind) => {
                    let stations = Detail::Stations(before.unwrap_or(0), behind.unwrap_or(0));
                    events.push(EventCode::RingBroken, stations);
                }
                RingEvent::RingClosed => events.push(EventCode::RingClosed, Detail::Nothing),
                RingEvent::Restart => events.push(EventCode::BusRestart, Detail::Nothing),
                // Silent nodes are reported by the joint loop, on every bus the same.
                RingEvent::Phase(_) | RingEvent::Lost(_) | RingEvent::Back(_) => {}
            }
        }
    }
}
