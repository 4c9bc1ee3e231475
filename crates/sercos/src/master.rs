//! The master: from NRT to CP4, then the exchange of data in every cycle. No clock, no socket, nothing allocated in a
//! cycle.
//!
//! A cycle is [`Master::begin`], sending what [`Master::telegrams`] gives for each port, [`Master::take`] for every
//! frame that comes in, and [`Master::end`].
//!
//! | stage | left when |
//! |---|---|
//! | CP0: who is there | the addresses were the expected ones, in the same order, for 100 cycles |
//! | CP1: device control | all device states are valid |
//! | CP2: parameters | every request is answered, S-0-0127 by every slave with success |
//! | CP3: application | S-0-0128 by every slave with success |
//! | CP4: operation | |
//!
//! Between two phases: [`ANNOUNCED`] beats that announce the next one, then a pause without telegrams.
//!
//! Slaves that missed too many beats are in NRT: they pass telegrams on and take no part ([`Master::fallen`]). Only a start
//! from CP0 takes them back, and that is one for all: [`Master::restart`], when whoever drives the master thinks fit.

mod phases;

use crate::device::{Connection, DeviceControl, Status};
use crate::header::{
    CYCLES, CommunicationPhase, Mac, Malformed, RingChannel, TELEGRAMS, TelegramHeader, TelegramKind,
};
use crate::layout::{CONNECTION, Station, StationPlaces, TelegramLayout};
use crate::programme::{Timing, requests};
use crate::ring::{ReceivedTelegrams, Repair};
use crate::service::{ServiceClient, ServiceRequest};
use crate::telegram::{Telegram, cp0, cp12, early_len, set_long, set_word, word};
use crate::trouble::{RingEvent, StartTrouble};
use std::collections::VecDeque;

/// Cycles of CP0 without the expected ring after which the master gives up.
pub(crate) const GIVE_UP: u32 = 1000;
/// Beats that announce a phase.
pub(crate) const ANNOUNCED: u32 = 3;
/// Pause before a phase \[ns\]; a fast switch takes 20 ms at most.
const PAUSE: u32 = 10_000_000;
/// Timeout of a slave for a step in the service channel \[ns\].
const SERVICE_TIME: u32 = 1_000_000_000;
/// Cycles in CP1 in a row in which everybody must be valid.
const VALID: u32 = 10;
const EVENTS: usize = 32;

/// Parameters of a master.
#[derive(Clone, Debug)]
pub struct MasterSetup {
    /// Cycle time \[ns\].
    pub cycle: u32,
    /// Cycles in a row in which a station's data, or the data for a station, may be missing.
    pub losses: u16,
    /// Beats in a row that may be missing before the slaves go to NRT.
    pub beat_losses: u16,
    /// The slaves that must be there, in any order.
    pub stations: Vec<Station>,
    /// Hardware address of port 1, and of port 2 if there is one: then the slaves form a ring.
    pub ports: [Option<Mac>; 2],
}

/// Stage of the master.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// CP0 to CP3.
    Starting(CommunicationPhase),
    /// CP4.
    Running,
    /// Given up.
    Failed(StartTrouble),
}

/// Counters of the master.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MasterCounts {
    /// Cycles begun.
    pub cycles: u64,
    /// Frames that are no telegrams.
    pub malformed: u64,
    /// Frames of other protocols.
    pub foreign: u64,
    /// Telegrams of another cycle, or of another master.
    pub late: u64,
    /// Cycles of CP4 in which the data of a station were missing, summed over the stations.
    pub missed: u64,
    /// The longest run of them at one station.
    pub longest: u32,
    /// Cycles in which telegrams did not come back as from a closed ring.
    pub open: u64,
}

enum MasterState {
    /// CP0: cycles, and how many of them the addresses have been the same.
    Identify {
        cycles: u32,
        stable: u32,
    },
    /// Beats that announce the next phase.
    Announce(u32),
    /// No telegrams.
    Pause(u32),
    /// CP1: cycles, and in how many everybody was valid.
    Validate {
        cycles: u32,
        valid: u32,
    },
    /// CP2, CP3: requests.
    Ask,
    Run,
    Failed(StartTrouble),
}

/// One station as the master sees it.
struct Node {
    station: Station,
    topology: u16,
    control: DeviceControl,
    status: Option<Status>,
    service: ServiceClient,
    requests: [Vec<ServiceRequest>; 2],
    asked: usize,
    busy: bool,
    command: Box<[u8]>,
    command_control: Connection,
    feedback: Box<[u8]>,
    feedback_control: Connection,
    fresh: bool,
    missed: u32,
    lost: bool,
}

/// The master of one ring or line.
pub struct Master {
    setup: MasterSetup,
    layout: TelegramLayout,
    phase: CommunicationPhase,
    state: MasterState,
    nodes: Vec<Node>,
    cycle: u8,
    sent: Box<[[Telegram; 2 * TELEGRAMS]; 2]>,
    in_use: usize,
    /// Number of ATs among them.
    ats: usize,
    received: Box<[[Telegram; TELEGRAMS]; 2]>,
    got: [[bool; TELEGRAMS]; 2],
    /// Ports at which any acknowledge telegram of ours came in, late ones included: in this cycle and in the last one.
    heard: [bool; 2],
    heard_before: [bool; 2],
    seen: [ReceivedTelegrams; 2],
    found: Vec<u16>,
    repair: Repair,
    states: Vec<Option<Status>>,
    controls: Vec<DeviceControl>,
    open: u32,
    broken: bool,
    /// Cycles in a row in which stations that were passed through took no part.
    absent: u32,
    counts: MasterCounts,
    events: VecDeque<RingEvent>,
}

impl Master {
    /// A master in front of its first cycle.
    ///
    /// # Errors
    /// A cycle time or stations that Sercos III cannot have.
    pub fn new(setup: MasterSetup) -> Result<Self, StartTrouble> {
        StartTrouble::check_cycle_time(setup.cycle)?;
        let layout = TelegramLayout::new(&setup.stations).map_err(StartTrouble::Layout)?;
        let timing = Timing { cycle: setup.cycle, losses: setup.losses, beat_losses: setup.beat_losses };
        // All requests of start-up are known beforehand: nothing allocates once a cycle has begun.
        let node = |(i, station): (usize, &Station)| Node {
            station: *station,
            topology: 0,
            control: DeviceControl::default(),
            status: None,
            service: ServiceClient::new(SERVICE_TIME / setup.cycle),
            requests: [CommunicationPhase::Cp2, CommunicationPhase::Cp3]
                .map(|p| requests(p, timing, &setup.stations, &layout, i)),
            asked: 0,
            busy: false,
            command: vec![0; station.command].into(),
            command_control: Connection::default(),
            feedback: vec![0; station.feedback].into(),
            feedback_control: Connection::default(),
            fresh: false,
            missed: 0,
            lost: false,
        };
        let nodes: Vec<_> = setup.stations.iter().enumerate().map(node).collect();
        let count = nodes.len();
        let mut events = VecDeque::with_capacity(EVENTS);
        events.push_back(RingEvent::Phase(CommunicationPhase::Cp0));
        Ok(Self {
            layout,
            phase: CommunicationPhase::Cp0,
            state: MasterState::Identify { cycles: 0, stable: 0 },
            nodes,
            cycle: 0,
            sent: Box::new([[Telegram::EMPTY; 2 * TELEGRAMS]; 2]),
            in_use: 0,
            ats: 0,
            received: Box::new([[Telegram::EMPTY; TELEGRAMS]; 2]),
            got: [[false; TELEGRAMS]; 2],
            heard: [false; 2],
            heard_before: [false; 2],
            seen: [ReceivedTelegrams::default(); 2],
            found: Vec::with_capacity(cp0::SLAVES),
            repair: Repair::new(count),
            states: vec![None; count],
            controls: vec![DeviceControl::default(); count],
            open: 0,
            broken: false,
            absent: 0,
            counts: MasterCounts::default(),
            events,
            setup,
        })
    }

    /// Progress.
    pub fn stage(&self) -> Stage {
        match self.state {
            MasterState::Failed(trouble) => Stage::Failed(trouble),
            MasterState::Run => Stage::Running,
            _ => Stage::Starting(self.phase),
        }
    }

    /// Counts.
    pub fn counts(&self) -> MasterCounts {
        self.counts
    }

    /// Something worth a line in the log.
    pub fn take_event(&mut self) -> Option<RingEvent> {
        self.events.pop_front()
    }

    /// Whether the ring is open; never for a line.
    pub fn is_broken(&self) -> bool {
        self.broken
    }

    /// New data for station `i`, sent from the next cycle on; of the length of its set-up, or ignored.
    pub fn set_command(&mut self, i: usize, data: &[u8]) {
        let node = &mut self.nodes[i];
        if data.len() == node.command.len() {
            node.command.copy_from_slice(data);
            node.command_control = node.command_control.next();
        }
    }

    /// Data of station `i` that came in the cycle that ended last; none if it sent no new ones.
    pub fn feedback(&self, i: usize) -> Option<&[u8]> {
        let node = &self.nodes[i];
        node.fresh.then_some(&*node.feedback)
    }

    /// Cycles in a row without data of station `i`.
    pub fn missed(&self, i: usize) -> u32 {
        self.nodes[i].missed
    }

    /// Stations that are there and have taken no part for longer than permitted: they fell to NRT.
    pub fn fallen(&self) -> usize {
        let absent = self.nodes.iter().filter(|n| n.status.is_none());
        if self.absent > u32::from(self.setup.losses) { absent.count() } else { 0 }
    }

    /// Starts all stations anew from CP0, between two cycles. Before that no telegram is sent for so long that every one of
    /// them is in NRT.
    pub fn restart(&mut self) {
        let silence = (u32::from(self.setup.beat_losses) + 2).max(PAUSE / self.setup.cycle);
        (self.phase, self.state) = (CommunicationPhase::Cp0, MasterState::Pause(silence));
        (self.open, self.broken, self.absent) = (0, false, 0);
        self.found.clear();
        self.repair.reset();
        for node in &mut self.nodes {
            node.control = DeviceControl::default();
            node.status = None;
            node.service = ServiceClient::new(SERVICE_TIME / self.setup.cycle);
            node.feedback_control = Connection::default();
            node.fresh = false;
        }
        self.tell(RingEvent::Restart);
    }

    /// Begins a cycle: writes its telegrams.
    pub fn begin(&mut self) {
        self.counts.cycles += 1;
        self.cycle = (self.cycle + 1) % CYCLES;
        self.got = Default::default();
        self.heard_before = std::mem::take(&mut self.heard);
        self.seen = [ReceivedTelegrams::default(); 2];
        self.in_use = 0;
        match self.state {
            MasterState::Failed(_) | MasterState::Pause(_) => {}
            MasterState::Announce(_) => self.add(TelegramKind::Mdt, 0, crate::header::MIN_DATA),
            _ => self.write_telegrams(),
        }
    }

    /// The telegrams of this cycle for port 1 (0) or port 2 (1), in their order.
    pub fn telegrams(&self, port: usize) -> impl Iterator<Item = &[u8]> {
        let used = if self.setup.ports[port].is_some() { self.in_use } else { 0 };
        self.sent[port][..used].iter().map(Telegram::bytes)
    }

    /// Takes a frame that came in at port 1 (0) or port 2 (1).
    pub fn take(&mut self, port: usize, frame: &[u8]) {
        let header = match TelegramHeader::read(frame) {
            Ok(header) => header,
            Err(Malformed::Foreign) => return self.counts.foreign += 1,
            Err(_) => return self.counts.malformed += 1,
        };
        let ours = self.setup.ports.contains(&Some(header.source));
        self.heard[port] |= ours && header.kind == TelegramKind::At;
        if !ours || header.cycle != Some(self.cycle) || header.phase != self.phase || header.switching {
            self.counts.late += u64::from(!header.switching);
            return;
        }
        if header.kind == TelegramKind::Mdt {
            return;
        }
        let number = usize::from(header.number);
        if number == 0 {
            match header.channel {
                RingChannel::P => self.seen[port].p = true,
                RingChannel::S => self.seen[port].s = true,
            }
        }
        // What an idle port lets out comes from the far side of an end: the end's own line has the data.
        if self.got[port][number] && !self.adds_stations(port, number, frame) {
            return;
        }
        self.got[port][number] = true;
        self.received[port][number].copy_from(frame);
    }

    /// Whether a second telegram of the same number at a port has more stations than the first.
    fn adds_stations(&self, port: usize, number: usize, frame: &[u8]) -> bool {
        let valid = |data: &[u8]| {
            let of = |i: usize| self.places(i).status;
            let here = (0..self.nodes.len()).filter(|&i| of(i).telegram == number);
            here.filter(|&i| Status(word(data, of(i).offset)).valid()).count()
        };
        self.phase > CommunicationPhase::Cp0
            && valid(&frame[crate::header::HEADER..]) > valid(self.received[port][number].data())
    }

    /// Whether nothing more is to be waited for: every telegram is back at both ports of a closed ring; of an open one, at
    /// the ports where telegrams came in the last cycle.
    pub fn is_complete(&self) -> bool {
        if self.in_use == 0 || matches!(self.state, MasterState::Announce(_)) {
            return true;
        }
        let all = |port: usize| self.got[port][..self.ats].iter().all(|got| *got);
        let ring = self.setup.ports[1].is_some() && !self.broken;
        let done = |port: usize| all(port) || !(ring || self.heard_before[port]);
        done(0) && done(1) && (all(0) || all(1))
    }

    /// Whether any acknowledge telegram of this cycle has come in.
    pub fn has_some(&self) -> bool {
        self.got.as_flattened().contains(&true)
    }

    /// Ends the cycle: looks at what came in.
    pub fn end(&mut self) -> Stage {
        match self.state {
            MasterState::Identify { cycles, stable } => self.identify(cycles + 1, stable),
            MasterState::Announce(left) if left > 0 => self.state = MasterState::Announce(left - 1),
            MasterState::Announce(_) => self.state = MasterState::Pause(PAUSE / self.setup.cycle),
            MasterState::Pause(left) if left > 0 => self.state = MasterState::Pause(left - 1),
            MasterState::Pause(_) => self.enter_next(),
            MasterState::Validate { cycles, valid } => self.validate(cycles + 1, valid),
            MasterState::Ask => self.ask(),
            MasterState::Run => self.run(),
            MasterState::Failed(_) => {}
        }
        self.stage()
    }

    fn tell(&mut self, event: RingEvent) {
        if self.events.len() < EVENTS {
            self.events.push_back(event);
        }
    }

    // Telegrams.

    fn add(&mut self, kind: TelegramKind, number: usize, len: usize) {
        for (port, channel) in [RingChannel::P, RingChannel::S].into_iter().enumerate() {
            let header = TelegramHeader {
                source: self.setup.ports[port].unwrap_or_default(),
                channel,
                kind,
                number: number as u8,
                phase: self.phase,
                switching: matches!(self.state, MasterState::Announce(_)),
                cycle: Some(self.cycle),
            };
            self.sent[port][self.in_use].begin(&header, len);
        }
        self.in_use += 1;
    }

    fn write_telegrams(&mut self) {
        let lengths = |kind| match (self.phase, kind) {
            (CommunicationPhase::Cp3 | CommunicationPhase::Cp4, TelegramKind::Mdt) => self.layout.mdt,
            (CommunicationPhase::Cp3 | CommunicationPhase::Cp4, TelegramKind::At) => self.layout.at,
            (CommunicationPhase::Cp0, kind) => [early_len(kind, self.phase), 0, 0, 0],
            (_, kind) => [early_len(kind, self.phase), early_len(kind, self.phase), 0, 0],
        };
        let (mdt, at) = (lengths(TelegramKind::Mdt), lengths(TelegramKind::At));
        self.ats = at.iter().filter(|len| **len > 0).count();
        for (kind, lengths) in [(TelegramKind::Mdt, mdt), (TelegramKind::At, at)] {
            for (number, len) in lengths.into_iter().enumerate().filter(|(_, len)| *len > 0) {
                self.add(kind, number, len);
            }
        }
        for port in 0..2 {
            match self.phase {
                CommunicationPhase::Cp0 => {
                    set_long(self.sent[port][0].data_mut(), 0, cp0::VERSION);
                    cp0::clear(self.sent[port][1].data_mut());
                }
                _ => (0..self.nodes.len()).for_each(|i| self.write_station(port, i)),
            }
        }
    }

    fn write_station(&mut self, port: usize, i: usize) {
        let (places, closed) = (self.places(i), !self.broken && self.setup.ports[1].is_some());
        let (node, sent) = (&mut self.nodes[i], &mut self.sent[port]);
        node.control = node.control.with(true, closed);
        set_word(sent[places.control.telegram].data_mut(), places.control.offset, node.control.0);
        if self.phase >= CommunicationPhase::Cp2 {
            let (control, info) = node.service.give();
            let data = sent[places.mdt_service.telegram].data_mut();
            set_word(data, places.mdt_service.offset, control);
            set_long(data, places.mdt_service.offset + 2, info);
        }
        if self.phase == CommunicationPhase::Cp4 {
            let (data, at) = (sent[places.command.telegram].data_mut(), places.command.offset);
            set_word(data, at, node.command_control.0);
            data[at + CONNECTION..at + CONNECTION + node.command.len()].copy_from_slice(&node.command);
        }
    }

    fn places(&self, i: usize) -> StationPlaces {
        if self.phase >= CommunicationPhase::Cp3 {
            return self.layout.places[i];
        }
        let topology = self.nodes[i].topology;
        let place = |(telegram, offset)| crate::layout::DataPlace { telegram, offset };
        let (service, device) = (place(cp12::service(topology)), place(cp12::device(topology)));
        StationPlaces {
            mdt_service: service,
            at_service: service,
            control: device,
            status: device,
            ..StationPlaces::default()
        }
    }
}
