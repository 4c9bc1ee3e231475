//! A simulated slave: passes telegrams on, reads its part of the MDTs and writes its part of the ATs as they go by.
//!
//! | phase | what it does |
//! |---|---|
//! | NRT | nothing, until a beat of CP0 comes |
//! | CP0 | writes its address, learns its topology address |
//! | CP1, CP2 | service channel, device status at the place of its topology address |
//! | CP3, CP4 | the same and its connections, at the places that the master gave it |
//!
//! A phase that may not follow, or a check that did not succeed, ends in NRT. So do beats missed in CP3 and CP4.
//! No clock in here: cycles are told from the cycle counter of the beats.

use crate::device::{Connection, DeviceControl, Idle, Status, Topology};
use crate::header::{CommunicationPhase, Malformed, RingChannel, TelegramHeader, TelegramKind};
use crate::idn;
use crate::layout::{CONNECTION, StationPlaces};
use crate::parameters::SlaveParameters;
use crate::service::Server;
use crate::telegram::{cp0, cp12, long, set_long, set_word, word};

/// The two ports of a slave. Which of them P telegrams come from, a slave learns in CP0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortSide {
    /// In a chain: towards the master's first port.
    Left,
    /// In a chain: towards the master's second port.
    Right,
}

impl PortSide {
    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// Port at which a telegram leaves a slave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exits {
    /// On the left.
    pub left: bool,
    /// On the right.
    pub right: bool,
}

/// Cycles without a beat that an announced phase may take to come.
const SWITCH: u32 = 1000;

/// Counters of a slave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SlaveCounts {
    /// Beats seen, each once.
    pub beats: u64,
    /// Frames that are no telegrams.
    pub malformed: u64,
    /// Frames of other protocols.
    pub foreign: u64,
    /// Phases that may not follow.
    pub phase_errors: u64,
    /// Data for the slave that were taken.
    pub commands: u64,
}

/// One slave.
pub struct Slave {
    address: u16,
    parameters: SlaveParameters,
    server: Server,
    phase: Option<CommunicationPhase>,
    places: StationPlaces,
    topology_address: u16,
    /// The side that P telegrams come from.
    source: Option<PortSide>,
    links: [bool; 2],
    /// The side that is not used: the slave is the end of a line.
    idle: Option<PortSide>,
    seen_on_idle: Option<RingChannel>,
    idle_status: Idle,
    toggle: bool,
    commanded: Option<Topology>,
    cycle: Option<u8>,
    master_valid: bool,
    ring_closed: bool,
    silent: u32,
    switching: bool,
    command: Box<[u8]>,
    command_control: Connection,
    command_new: bool,
    command_missed: u32,
    feedback: Box<[u8]>,
    feedback_control: Connection,
    counts: SlaveCounts,
}

impl Slave {
    /// A slave with this Sercos address, with links on both sides.
    pub fn new(address: u16, command: usize, feedback: usize) -> Self {
        Self {
            address,
            parameters: SlaveParameters::new(address, command, feedback),
            server: Server::default(),
            phase: None,
            places: StationPlaces::default(),
            topology_address: 0,
            source: None,
            links: [true; 2],
            idle: None,
            seen_on_idle: None,
            idle_status: Idle::Link,
            toggle: false,
            commanded: None,
            cycle: None,
            master_valid: false,
            ring_closed: false,
            silent: 0,
            switching: false,
            command: vec![0; command].into(),
            command_control: Connection::default(),
            command_new: false,
            command_missed: 0,
            feedback: vec![0; feedback].into(),
            feedback_control: Connection::default(),
            counts: SlaveCounts::default(),
        }
    }

    /// Sercos address.
    pub fn address(&self) -> u16 {
        self.address
    }

    /// Communication phase; none: NRT.
    pub fn phase(&self) -> Option<CommunicationPhase> {
        self.phase
    }

    /// Counts.
    pub fn counts(&self) -> SlaveCounts {
        self.counts
    }

    /// Whether the master says that the ring is closed.
    pub fn ring_closed(&self) -> bool {
        self.ring_closed
    }

    /// Data for the slave that it did not have yet.
    pub fn take_command(&mut self) -> Option<&[u8]> {
        std::mem::take(&mut self.command_new).then_some(&*self.command)
    }

    /// New data of the slave, for the telegrams from now on; of the length it was made with.
    pub fn set_feedback(&mut self, data: &[u8]) {
        if data.len() == self.feedback.len() {
            self.feedback.copy_from_slice(data);
            self.feedback_control = self.feedback_control.next();
        }
    }

    /// A cable was plugged or pulled.
    pub(crate) fn set_link(&mut self, side: PortSide, up: bool) {
        self.links[side as usize] = up;
        if up && self.phase <= Some(CommunicationPhase::Cp0) && self.idle == Some(side) {
            // Nobody can command it yet.
            self.idle =
                [PortSide::Left, PortSide::Right].into_iter().find(|side| !self.links[*side as usize]);
        }
        if !up && self.idle.is_none() {
            self.idle = Some(side);
            self.seen_on_idle = None;
        }
    }

    /// Forwarding of telegrams.
    pub fn topology(&self) -> Topology {
        match self.idle {
            None => Topology::Through,
            Some(side) if Some(side) == self.source => Topology::LoopS,
            Some(_) => Topology::LoopP,
        }
    }

    /// A cycle time went by without a beat: too many of them in CP3 or CP4 end in NRT.
    pub fn silence(&mut self) {
        self.silent += 1;
        let patience = if self.switching { SWITCH } else { self.parameters.beat_losses() };
        if self.phase >= Some(CommunicationPhase::Cp3) && self.silent > patience {
            self.phase = None;
        }
    }

    /// A frame came in on this side: reads and writes its part, and says where the frame goes on.
    pub fn pass(&mut self, from: PortSide, frame: &mut [u8]) -> Exits {
        let header = match TelegramHeader::read(frame) {
            Ok(header) => header,
            Err(Malformed::Foreign) => {
                self.counts.foreign += 1;
                return Exits::default();
            }
            Err(_) => {
                self.counts.malformed += 1;
                return Exits::default();
            }
        };
        if header.is_beat() {
            self.beat(from, &header);
        }
        // The idle port of a loop only listens: what comes there shows whether the ring is closed.
        if self.idle == Some(from) {
            self.seen_on_idle = Some(header.channel);
            return Exits::default();
        }
        // Data are exchanged on the way out; on the way back a telegram only passes.
        let comes_from = match header.channel {
            RingChannel::P => self.source,
            RingChannel::S => self.source.map(PortSide::other),
        };
        let outward = comes_from == Some(from);
        if outward && !header.switching {
            self.process(&header, &mut frame[crate::header::HEADER..]);
        }
        self.exits(from, outward)
    }

    fn exits(&self, from: PortSide, outward: bool) -> Exits {
        let both = self.idle.is_some() && outward;
        let leaves = |side: PortSide| {
            let on = if self.idle.is_some() { both } else { side != from };
            on && self.links[side as usize]
        };
        Exits { left: leaves(PortSide::Left), right: leaves(PortSide::Right) }
    }

    /// The head of MDT0: a new cycle, if it was not seen from the other side before.
    fn beat(&mut self, from: PortSide, header: &TelegramHeader) {
        let same_phase = self.phase == Some(header.phase) || header.switching;
        if same_phase && header.cycle.is_some() && header.cycle == self.cycle {
            return;
        }
        (self.cycle, self.silent, self.switching) = (header.cycle, 0, header.switching);
        self.counts.beats += 1;
        self.idle_status = match (self.idle, self.seen_on_idle.take()) {
            (Some(side), _) if !self.links[side as usize] => Idle::NoLink,
            (None, _) | (_, None) => Idle::Link,
            (_, Some(RingChannel::P)) => Idle::P,
            (_, Some(RingChannel::S)) => Idle::S,
        };
        if !header.switching && self.phase != Some(header.phase) {
            self.enter(from, header);
        }
        self.change_topology();
        self.command_missed += 1; // until this cycle's data are taken
    }

    /// The next phase, the first one, or none.
    fn enter(&mut self, from: PortSide, header: &TelegramHeader) {
        let follows = self.phase.and_then(CommunicationPhase::next) == Some(header.phase);
        let allowed = match header.phase {
            CommunicationPhase::Cp0 => true,
            CommunicationPhase::Cp1 => follows && self.topology_address > 0,
            CommunicationPhase::Cp2 => follows,
            CommunicationPhase::Cp3 => follows && self.parameters.passed(idn::CHECK_CP3),
            CommunicationPhase::Cp4 => follows && self.parameters.passed(idn::CHECK_CP4),
        };
        if !allowed {
            self.counts.phase_errors += u64::from(self.phase.is_some());
            self.phase = None;
            return;
        }
        self.phase = Some(header.phase);
        match header.phase {
            CommunicationPhase::Cp0 => self.begin(from, header.channel),
            CommunicationPhase::Cp3 => self.places = self.parameters.places(),
            CommunicationPhase::Cp4 => self.command_missed = 0,
            CommunicationPhase::Cp1 | CommunicationPhase::Cp2 => {}
        }
    }

    /// CP0: everything as after switching on.
    fn begin(&mut self, from: PortSide, channel: RingChannel) {
        self.parameters.reset();
        self.server = Server::default();
        self.topology_address = 0;
        self.source = Some(if channel == RingChannel::P { from } else { from.other() });
        self.idle = [PortSide::Left, PortSide::Right].into_iter().find(|side| !self.links[*side as usize]);
        (self.toggle, self.commanded) = (false, None);
        (self.command_control, self.command_new) = (Connection::default(), false);
        (self.master_valid, self.ring_closed) = (false, false);
    }

    /// A topology that was commanded in the last cycle holds from now on.
    fn change_topology(&mut self) {
        let Some((commanded, source)) = self.commanded.take().zip(self.source) else {
            return;
        };
        self.idle = match commanded {
            Topology::Through if self.links == [true; 2] => None,
            Topology::Through => self.idle, // without a link it cannot
            Topology::LoopP => Some(source.other()),
            Topology::LoopS => Some(source),
        };
    }

    fn process(&mut self, header: &TelegramHeader, data: &mut [u8]) {
        if self.phase != Some(header.phase) {
            return;
        }
        let telegram = usize::from(header.number);
        let is = |place: crate::layout::DataPlace| place.telegram == telegram;
        match (header.phase, header.kind) {
            (CommunicationPhase::Cp0, TelegramKind::Mdt) => {}
            (CommunicationPhase::Cp0, TelegramKind::At) => self.write_address(header, data),
            (CommunicationPhase::Cp1 | CommunicationPhase::Cp2, kind) => {
                self.process_early(kind, telegram, data);
            }
            // CP3 and CP4: each field may lie in another telegram.
            (_, TelegramKind::Mdt) => {
                let places = self.places;
                if is(places.mdt_service) {
                    self.read_service(data, places.mdt_service.offset, header.phase);
                }
                if is(places.control) {
                    self.read_control(DeviceControl(word(data, places.control.offset)));
                }
                if is(places.command) && header.phase == CommunicationPhase::Cp4 {
                    self.read_command(data, places.command.offset);
                }
            }
            (phase, TelegramKind::At) => {
                let places = self.places;
                if is(places.at_service) {
                    self.write_service(data, places.at_service.offset);
                }
                if is(places.status) {
                    set_word(data, places.status.offset, self.status().0);
                }
                if is(places.feedback) && phase == CommunicationPhase::Cp4 {
                    self.write_feedback(data, places.feedback.offset);
                }
            }
        }
    }

    fn write_address(&mut self, header: &TelegramHeader, data: &mut [u8]) {
        if header.number == 0
            && let Some(place) = cp0::enter(data, self.address)
            && header.channel == RingChannel::P
        {
            self.topology_address = place;
        }
    }

    fn process_early(&mut self, kind: TelegramKind, telegram: usize, data: &mut [u8]) {
        let (own, service) = cp12::service(self.topology_address);
        let (_, device) = cp12::device(self.topology_address);
        if own != telegram || self.topology_address == 0 {
            return;
        }
        match kind {
            TelegramKind::Mdt => {
                self.read_control(DeviceControl(word(data, device)));
                if let Some(phase @ CommunicationPhase::Cp2) = self.phase {
                    self.read_service(data, service, phase);
                }
            }
            TelegramKind::At => {
                self.write_service(data, service);
                set_word(data, device, self.status().0);
            }
        }
    }

    fn read_service(&mut self, data: &[u8], at: usize, phase: CommunicationPhase) {
        self.server.take(word(data, at), long(data, at + 2), &mut self.parameters, phase);
    }

    fn write_service(&self, data: &mut [u8], at: usize) {
        let (status, info) = self.server.give();
        set_word(data, at, status);
        set_long(data, at + 2, info);
    }

    fn read_control(&mut self, control: DeviceControl) {
        self.master_valid = control.valid();
        self.ring_closed = control.valid() && control.ring_closed();
        if control.valid() && control.toggle() != self.toggle {
            self.toggle = control.toggle();
            self.commanded = control.topology();
        }
    }

    fn status(&self) -> Status {
        let error = self.phase == Some(CommunicationPhase::Cp4)
            && self.command_missed > self.parameters.command_losses();
        Status::new(self.toggle, self.topology(), self.idle_status, true).with_connection_error(error)
    }

    fn read_command(&mut self, data: &[u8], at: usize) {
        let control = Connection(word(data, at));
        let Some(payload) = data.get(at + CONNECTION..at + CONNECTION + self.command.len()) else {
            return;
        };
        if self.master_valid && control.ready() && control.counter() != self.command_control.counter() {
            self.command.copy_from_slice(payload);
            (self.command_control, self.command_new, self.command_missed) = (control, true, 0);
            self.counts.commands += 1;
        }
    }

    fn write_feedback(&self, data: &mut [u8], at: usize) {
        if let Some(place) = data.get_mut(at + CONNECTION..at + CONNECTION + self.feedback.len()) {
            place.copy_from_slice(&self.feedback);
            set_word(data, at, self.feedback_control.0);
        }
    }
}
