//! A master and a chain of slaves that are joined in memory: one call is one cycle.

use sercos::header::Mac;
use sercos::{Master, MasterSetup, PortSide, RingEvent, Slave, SlaveChain, Stage, Station};

/// Hardware addresses of the master's ports.
pub(crate) const MACS: [Mac; 2] = [[2, 0, 0, 0, 0, 1], [2, 0, 0, 0, 0, 2]];
/// Losses in a row that are permitted.
pub(crate) const LOSSES: u16 = 2;

/// Both sides.
pub(crate) struct Wire {
    pub(crate) master: Master,
    pub(crate) chain: SlaveChain,
    pub(crate) events: Vec<RingEvent>,
}

/// Stations with these addresses, each with some data of its own length.
pub(crate) fn stations(addresses: &[u16]) -> Vec<Station> {
    let station = |(i, a): (usize, &u16)| Station { address: *a, command: 8 + 4 * i, feedback: 12 + 2 * i };
    addresses.iter().enumerate().map(station).collect()
}

pub(crate) fn setup(addresses: &[u16], two_ports: bool) -> MasterSetup {
    MasterSetup {
        cycle: 1_000_000,
        losses: LOSSES,
        beat_losses: LOSSES,
        stations: stations(addresses),
        ports: [Some(MACS[0]), two_ports.then_some(MACS[1])],
    }
}

impl Wire {
    /// A ring, or a line, of slaves with these addresses in this order.
    pub(crate) fn new(addresses: &[u16], two_ports: bool) -> Self {
        let setup = setup(addresses, two_ports);
        let slaves = setup.stations.iter().map(|s| Slave::new(s.address, s.command, s.feedback)).collect();
        let mut chain = SlaveChain::new(slaves, false);
        if !two_ports {
            chain.set_cable(addresses.len(), false);
        }
        Self { master: Master::new(setup).unwrap(), chain, events: Vec::new() }
    }

    /// One cycle.
    pub(crate) fn cycle(&mut self) -> Stage {
        self.cycle_with(|_, _| true)
    }

    /// One cycle; a telegram that comes back, at this port, may be lost.
    pub(crate) fn cycle_with(&mut self, mut keeps: impl FnMut(usize, &[u8]) -> bool) -> Stage {
        self.master.begin();
        let mut sent: Vec<(PortSide, Vec<u8>)> = Vec::new();
        for (port, end) in [(0, PortSide::Left), (1, PortSide::Right)] {
            sent.extend(self.master.telegrams(port).map(|t| (end, t.to_vec())));
        }
        if sent.is_empty() {
            self.chain.silence();
        }
        for (end, frame) in sent {
            let master = &mut self.master;
            self.chain.take(end, &frame, &mut |side, frame| {
                let port = if side == PortSide::Left { 0 } else { 1 };
                if keeps(port, frame) {
                    master.take(port, frame);
                }
            });
        }
        let stage = self.master.end();
        self.events.extend(std::iter::from_fn(|| self.master.take_event()));
        stage
    }

    /// Cycles until operation, at most so many.
    pub(crate) fn start(&mut self, most: u32) -> u32 {
        for cycle in 1..=most {
            match self.cycle() {
                Stage::Running => return cycle,
                Stage::Failed(trouble) => panic!("{trouble}"),
                Stage::Starting(_) => {}
            }
        }
        panic!("not in CP4 after {most} cycles: {:?}", self.master.stage());
    }

    /// A cycle of operation with data that name station and number of the exchange, both ways.
    pub(crate) fn exchange(&mut self, number: u8) -> Stage {
        for i in 0..self.chain.slaves().len() {
            self.master.set_command(i, &vec![number ^ i as u8; 8 + 4 * i]);
        }
        for (i, slave) in self.chain.slaves_mut().iter_mut().enumerate() {
            slave.set_feedback(&vec![number.wrapping_mul(3) ^ i as u8; 12 + 2 * i]);
        }
        self.cycle()
    }
}
