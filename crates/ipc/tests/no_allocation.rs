//! What a control cycle does with its ports allocates and frees nothing, whoever joins meanwhile.

mod place;

use ipc::Space;
use messages::topics::{PLAN, SENSORS};
use messages::{Plan, Process, Sensors};
use place::RunDir;
use realtime::allocations;
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: realtime::CountingAllocator = realtime::CountingAllocator;

#[test]
fn cycles_allocate_nothing() {
    let dir = RunDir::new("allocation");
    let system = Space::create(dir.path()).unwrap();
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let mut sensors = lowlevel.writer::<Sensors>(&SENSORS).unwrap();
    let mut plans = planner.writer::<Plan>(&PLAN).unwrap();
    let mut newest = planner.reader::<Sensors>(&SENSORS).unwrap();
    let mut every = system.reader::<Sensors>(&SENSORS).unwrap();
    let mut plan_reader = system.reader::<Plan>(&PLAN).unwrap();
    let waiter = planner.waiter(Process::Planner).unwrap();
    let bell = lowlevel.bell(&SENSORS).unwrap();
    let (record, plan) = (Sensors::default(), Plan::default());

    let mut cycles = |n: u64| {
        for k in 0..n {
            sensors.write(&record);
            bell.ring();
            assert!(waiter.wait(Duration::from_millis(1)));
            assert!(!waiter.wait(Duration::from_micros(1)));
            assert!(newest.refresh() && newest.held().is_some() && newest.latest().is_some());
            assert!(every.follow().is_some());
            if k % 10 == 0 {
                plans.write(&plan);
                assert!(plan_reader.newer().is_some());
            }
        }
    };
    cycles(10);
    allocations::arm();
    cycles(10_000);
    let counted = allocations::counted();
    allocations::disarm();
    assert_eq!(counted, [0, 0]);

    // Observers that come and go are no business of the writer's.
    let observer = Space::open(dir.path(), Process::Observer).unwrap();
    let readers: Vec<_> = (0..8).map(|_| observer.reader::<Sensors>(&SENSORS).unwrap()).collect();
    allocations::arm();
    cycles(100);
    assert_eq!(allocations::counted(), [0, 0]);
    allocations::disarm();
    drop(readers);
    allocations::arm();
    cycles(100);
    assert_eq!(allocations::counted(), [0, 0]);
    allocations::disarm();

    // The check itself: one box is seen.
    allocations::arm();
    std::hint::black_box(Box::new(1u64));
    assert_eq!(allocations::counted(), [1, 1]);
    allocations::disarm();
}

#[test]
fn a_bell_that_connected_does_not_allocate_at_the_first_ring() {
    let dir = RunDir::new("connect");
    let _system = Space::create(dir.path()).unwrap();
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let bell = lowlevel.bell(&SENSORS).unwrap();
    let waiter = planner.waiter(Process::Planner).unwrap();
    bell.connect();
    allocations::arm();
    bell.ring();
    assert_eq!(allocations::counted(), [0, 0]);
    allocations::disarm();
    assert!(waiter.wait(Duration::from_secs(1)));
}
