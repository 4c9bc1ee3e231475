//! The real-time side of the command plane allocates nothing.

mod harness;

use broker::Client;
use harness::{System, pause, play_role, wait_for};
use messages::command::Domain;
use messages::{Command, CommandSource};
use realtime::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn process() {
    play_role(|role, _| panic!("no role {role}"));
}

/// Use of a client by a control cycle: commands in, verdicts and commands out, answers in.
fn cycle(client: &mut Client, heard: &mut u32) {
    while let Some(live) = client.next() {
        client.answer(&live, Ok(()));
        *heard += 1;
    }
    client.publish(&Command::Stop);
    while client.answered().is_some() {}
    std::hint::black_box(client.lease());
}

#[test]
fn publishing_and_receiving_allocate_nothing() {
    let mut system = System::start("allocs");
    let mut sender = system.client("sender", &[]);
    let mut planner = system.client("planner", &[Domain::Walk]);
    let (mut heard, mut overflow) = (0, 0);
    allocations::arm();
    for round in 0..2000 {
        // Now and then more than the rings hold; and from the middle on there is no broker.
        for _ in 0..if round % 500 == 499 { 300 } else { 1 } {
            overflow += u32::from(sender.publish(&Command::Start).is_none());
        }
        cycle(&mut planner, &mut heard);
        if round == 1000 {
            allocations::disarm();
            system.kill_broker();
            allocations::arm();
        }
        pause(1);
        assert_eq!(allocations::counted(), [0, 0], "round {round}");
    }
    allocations::disarm();
    assert!(heard > 500 && overflow > 0, "heard {heard}, overflow {overflow}");
    drop(Box::new(0u8));
    allocations::arm();
    drop(std::hint::black_box(Box::new(0u8)));
    assert_eq!(allocations::counted(), [1, 1], "the counter counts");
    allocations::disarm();
    wait_for("the notice", || !sender.statistics().connected);
}
