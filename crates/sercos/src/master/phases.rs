//! End of the master's cycle, phase by phase: evaluates what came in and decides what comes next.

use super::{ANNOUNCED, GIVE_UP, Master, MasterState, Node, VALID};
use crate::device::{Connection, Status, Topology};
use crate::header::CommunicationPhase;
use crate::layout::CONNECTION;
use crate::ring::{RingShape, STABLE};
use crate::service::Progress;
use crate::telegram::{cp0, long, word};
use crate::trouble::{RingEvent, StartTrouble};

impl Master {
    fn shape(&self) -> RingShape {
        RingShape::of(self.seen[0], self.seen[1])
    }

    fn wanted_shape(&self) -> RingShape {
        if self.setup.ports[1].is_some() { RingShape::Ring } else { RingShape::LineP }
    }

    pub(super) fn identify(&mut self, cycles: u32, stable: u32) {
        let port = if self.setup.ports[1].is_some() { 1 } else { 0 };
        let trouble = self.check_ring(port);
        let data = self.received[port][0].data();
        let same = trouble.is_none() && cp0::addresses(data).eq(self.found.iter().copied());
        let stable = if same { stable + 1 } else { 0 };
        if trouble.is_none() && !same {
            self.found.clear();
            self.found.extend(cp0::addresses(data).take(cp0::SLAVES));
        }
        self.state = match trouble {
            Some(trouble) if cycles >= GIVE_UP => MasterState::Failed(trouble),
            None if stable >= STABLE => {
                self.number_nodes();
                self.switch()
            }
            None if cycles >= GIVE_UP => MasterState::Failed(StartTrouble::Unstable),
            _ => MasterState::Identify { cycles, stable },
        };
    }

    /// Problem of the ring in this cycle of CP0.
    fn check_ring(&self, port: usize) -> Option<StartTrouble> {
        match self.shape() {
            RingShape::Nothing => return Some(StartTrouble::NoTelegrams),
            shape if shape != self.wanted_shape() => return Some(StartTrouble::Shape(shape)),
            _ => {}
        }
        let data = self.received[port][0].data();
        let expected = |address| self.nodes.iter().any(|n| n.station.address == address);
        let seen = |address| cp0::addresses(data).filter(|a| *a == address).count();
        if let Some(address) = cp0::addresses(data).find(|a| !expected(*a) || seen(*a) > 1) {
            return Some(StartTrouble::Stranger(address));
        }
        let (found, expected) = (cp0::addresses(data).count(), self.nodes.len());
        if found == 0 {
            return Some(StartTrouble::Count { found, expected });
        }
        self.nodes.iter().map(|n| n.station.address).find(|a| seen(*a) == 0).map(StartTrouble::Missing)
    }

    fn number_nodes(&mut self) {
        for node in &mut self.nodes {
            let place = self.found.iter().position(|a| *a == node.station.address);
            node.topology = place.map_or(0, |i| i as u16 + 1);
        }
    }

    /// The next phase is announced.
    fn switch(&mut self) -> MasterState {
        self.phase = self.phase.next().unwrap_or(CommunicationPhase::Cp4);
        MasterState::Announce(ANNOUNCED - 1)
    }

    pub(super) fn enter_next(&mut self) {
        self.tell(RingEvent::Phase(self.phase));
        for node in &mut self.nodes {
            (node.asked, node.busy) = (0, false);
        }
        self.state = match self.phase {
            CommunicationPhase::Cp0 => MasterState::Identify { cycles: 0, stable: 0 },
            CommunicationPhase::Cp1 => MasterState::Validate { cycles: 0, valid: 0 },
            CommunicationPhase::Cp2 | CommunicationPhase::Cp3 => MasterState::Ask,
            CommunicationPhase::Cp4 => MasterState::Run,
        };
    }

    /// The telegram of station `i` with its data, from the port where they are valid.
    fn answer(&self, i: usize) -> Option<usize> {
        let status = self.places(i).status;
        (0..2).find(|&port| {
            self.got[port][status.telegram]
                && Status(word(self.received[port][status.telegram].data(), status.offset)).valid()
        })
    }

    /// Device states of all stations, events and repair of the ring.
    fn look(&mut self) {
        for i in 0..self.nodes.len() {
            let status = self.places(i).status;
            let found = self
                .answer(i)
                .map(|port| Status(word(self.received[port][status.telegram].data(), status.offset)));
            self.nodes[i].status = found;
            (self.states[i], self.controls[i]) = (found, self.nodes[i].control);
        }
        self.watch_ring();
        if self.setup.ports[1].is_some() {
            self.repair.step(&self.states, &mut self.controls);
            for (node, control) in self.nodes.iter_mut().zip(&self.controls) {
                node.control = *control;
            }
        }
    }

    fn watch_ring(&mut self) {
        if self.shape() == self.wanted_shape() {
            self.open = 0;
            if std::mem::take(&mut self.broken) {
                self.tell(RingEvent::RingClosed);
            }
            return;
        }
        self.open += 1;
        self.counts.open += 1;
        if self.setup.ports[1].is_some() && !self.broken && self.open > u32::from(self.setup.losses) {
            self.broken = true;
            let end = |topology| {
                let is = |n: &&Node| n.status.and_then(Status::topology) == Some(topology);
                self.nodes.iter().find(is).map(|n| n.station.address)
            };
            let ends = (end(Topology::LoopP), end(Topology::LoopS));
            self.tell(RingEvent::RingBroken(ends.0, ends.1));
        }
    }

    pub(super) fn validate(&mut self, cycles: u32, valid: u32) {
        self.look();
        let silent = self.nodes.iter().find(|n| n.status.is_none()).map(|n| n.station.address);
        self.state = match silent {
            None if valid >= VALID => self.switch(),
            None => MasterState::Validate { cycles, valid: valid + 1 },
            Some(address) if cycles >= GIVE_UP => {
                MasterState::Failed(StartTrouble::Silent { address, phase: self.phase })
            }
            Some(_) => MasterState::Validate { cycles, valid: 0 },
        };
    }

    pub(super) fn ask(&mut self) {
        self.look();
        let mut done = true;
        for i in 0..self.nodes.len() {
            match self.ask_station(i) {
                Ok(finished) => done &= finished,
                Err(trouble) => return self.state = MasterState::Failed(trouble),
            }
        }
        if done {
            self.state = self.switch();
        }
    }

    /// One step with station `i`; whether it has answered everything.
    fn ask_station(&mut self, i: usize) -> Result<bool, StartTrouble> {
        let (answer, place) = (self.answer(i), self.places(i).at_service);
        let list = usize::from(self.phase == CommunicationPhase::Cp3);
        let node = &mut self.nodes[i];
        // A request under way: one step of the handshake per cycle.
        if node.busy {
            let progress = match answer {
                Some(port) => {
                    let data = self.received[port][place.telegram].data();
                    node.service.take(word(data, place.offset), long(data, place.offset + 2))
                }
                None => node.service.wait(),
            };
            match progress {
                Progress::Idle | Progress::Busy => return Ok(false),
                Progress::Done => (node.busy, node.asked) = (false, node.asked + 1),
                Progress::Refused(refusal) => {
                    let (address, idn) = (node.station.address, node.requests[list][node.asked].idn());
                    return Err(StartTrouble::Refused { address, idn, refusal });
                }
            }
        }
        let Some(request) = node.requests[list].get(node.asked) else {
            return Ok(true);
        };
        node.service.ask(*request);
        node.busy = true;
        Ok(false)
    }

    pub(super) fn run(&mut self) {
        self.look();
        let absent = self.nodes.iter().filter(|n| n.status.is_none()).count();
        // Slaves that are absent because of a cable, or of lost telegrams, have not fallen back.
        let passed = self.shape() == self.wanted_shape() || absent == self.nodes.len() && self.has_some();
        self.absent = if absent > 0 && passed { self.absent + 1 } else { 0 };
        for i in 0..self.nodes.len() {
            self.nodes[i].fresh = self.take_feedback(i);
            self.count(i);
        }
    }

    /// New data of station `i`, if there are any.
    fn take_feedback(&mut self, i: usize) -> bool {
        let place = self.places(i).feedback;
        let Some(port) = self.answer(i).filter(|port| self.got[*port][place.telegram]) else {
            return false;
        };
        let (node, data) = (&mut self.nodes[i], self.received[port][place.telegram].data());
        let control = Connection(word(data, place.offset));
        let from = place.offset + CONNECTION;
        let Some(payload) = data.get(from..from + node.feedback.len()) else {
            return false;
        };
        if !control.ready() || control.counter() == node.feedback_control.counter() {
            return false;
        }
        node.feedback.copy_from_slice(payload);
        node.feedback_control = control;
        true
    }

    fn count(&mut self, i: usize) {
        let node = &mut self.nodes[i];
        let address = node.station.address;
        if node.fresh {
            node.missed = 0;
            if std::mem::take(&mut node.lost) {
                self.tell(RingEvent::Back(address));
            }
            return;
        }
        if !node.feedback_control.ready() {
            return; // has not begun
        }
        node.missed += 1;
        let (missed, before) = (node.missed, node.lost);
        node.lost |= missed > u32::from(self.setup.losses);
        let lost = node.lost && !before;
        self.counts.missed += 1;
        self.counts.longest = self.counts.longest.max(missed);
        if lost {
            self.tell(RingEvent::Lost(address));
        }
    }
}
