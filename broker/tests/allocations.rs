//! The real-time side of the command plane allocates nothing.

mod harness;

use broker::local::{Outbox, Reach};
use broker::{Client, LocalBroker};
use harness::{System, pause, play_role, wait_for};
use messages::Command;
use messages::command::Domain;
use realtime::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn process() {
    play_role(|role, _| panic!("no role {role}"));
}

fn answer(heard: &mut u32, _: &Command, outbox: &mut Outbox) {
    *heard += 1;
    outbox.publish(Command::Stand, Reach::Global);
}

#[test]
fn publishing_and_receiving_allocate_nothing() {
    let mut system = System::start("allocs");
    let mut sender = system.client("sender", &[]);
    let client = system.client("receiver", &[Domain::Walk]);
    let mut local = LocalBroker::<u32>::new(Some(client));
    local.subscribe(Command::Start.address(), answer);
    let (mut heard, mut overflow) = (0, 0);
    allocations::arm();
    for cycle in 0..2000 {
        // Now and then more than the rings hold; and from the middle on there is no broker.
        for _ in 0..if cycle % 500 == 499 { 300 } else { 1 } {
            overflow += u32::from(!sender.publish(&Command::Start));
        }
        local.deliver_received(&mut heard);
        local.publish(&mut heard, &Command::Stop, Reach::Local);
        if cycle == 1000 {
            allocations::disarm();
            system.kill_broker();
            allocations::arm();
        }
        pause(1);
        assert_eq!(allocations::counted(), [0, 0], "cycle {cycle}");
    }
    allocations::disarm();
    assert!(heard > 500 && overflow > 0, "heard {heard}, overflow {overflow}");
    drop(Box::new(0u8));
    allocations::arm();
    drop(std::hint::black_box(Box::new(0u8)));
    assert_eq!(allocations::counted(), [1, 1], "the counter counts");
    allocations::disarm();
    wait_for("the notice", || !sender.statistics().connected);
    let _: Option<&Client> = local.client();
}
