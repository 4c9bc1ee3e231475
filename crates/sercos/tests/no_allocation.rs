//! A cycle of operation allocates nothing: neither master nor slaves, with a closed ring, a broken one, while it is closed
//! again, and while slaves that fell to NRT are started again.

use realtime::{CountingAllocator, allocations};
use sercos::{Master, MasterSetup, PortSide, Slave, SlaveChain, Stage, Station};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_cycle_allocates_nothing() {
    let stations: Vec<_> = (1..=9).map(|address| Station { address, command: 64, feedback: 128 }).collect();
    let slaves = stations.iter().map(|s| Slave::new(s.address, s.command, s.feedback)).collect();
    let mut chain = SlaveChain::new(slaves, true);
    let ports = [Some([2, 0, 0, 0, 0, 1]), Some([2, 0, 0, 0, 0, 2])];
    let mut master =
        Master::new(MasterSetup { cycle: 1_000_000, losses: 2, beat_losses: 2, stations, ports }).unwrap();
    let mut sent = vec![(PortSide::Left, [0; 1514], 0); 16];
    let mut cycle = |master: &mut Master, chain: &mut SlaveChain| {
        master.begin();
        let mut count = 0;
        for (port, end) in [(0, PortSide::Left), (1, PortSide::Right)] {
            for frame in master.telegrams(port) {
                sent[count].1[..frame.len()].copy_from_slice(frame);
                (sent[count].0, sent[count].2) = (end, frame.len());
                count += 1;
            }
        }
        let mut take =
            |side: PortSide, frame: &[u8]| master.take(if side == PortSide::Left { 0 } else { 1 }, frame);
        for (end, frame, len) in &sent[..count] {
            chain.take(*end, &frame[..*len], &mut take);
        }
        for slave in chain.slaves_mut() {
            slave.take_command();
            slave.set_feedback(&[7; 128]);
        }
        chain.release(&mut take);
        let stage = master.end();
        while master.take_event().is_some() {}
        stage
    };
    while cycle(&mut master, &mut chain) != Stage::Running {}
    allocations::arm();
    for step in 0..1000 {
        match step {
            200 => chain.set_cable(4, false),
            500 => chain.set_cable(4, true),
            _ => {}
        }
        assert_eq!(cycle(&mut master, &mut chain), Stage::Running);
    }
    assert_eq!(master.counts().missed, 0);
    assert!(master.counts().open > 300 && !master.is_broken());
    (0..3).for_each(|_| chain.silence());
    while master.fallen() == 0 {
        cycle(&mut master, &mut chain);
    }
    master.restart();
    while cycle(&mut master, &mut chain) != Stage::Running {}
    let counted = allocations::counted();
    allocations::disarm();
    assert_eq!(counted, [0, 0], "allocations and frees");
}
