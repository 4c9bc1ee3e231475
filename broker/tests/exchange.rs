//! The broker's turns, one by one: order, limits, bad registrations.

mod harness;

use std::cell::{Cell, RefCell};

use broker::Client;
use broker::exchange::{BrokerEvent, Exchange};
use broker::message::{HEAD, MAX_BYTES, Message, domain_mask, service, service_message, write_command};
use harness::{System, pause, play_role};
use ipc::{QueueReceiver, QueueSender, Space};
use messages::command::{Domain, Priority, VelocityCommand};
use messages::{Command, Reason, Stamp};
use proptest::prelude::*;
use realtime::clock::now;

#[test]
fn process() {
    play_role(|role, _| panic!("no role {role}"));
}

fn velocity(n: u32) -> Command {
    Command::Velocity(VelocityCommand { forward: f64::from(n) / 4096.0, left: 0.0, turn: 0.0 })
}

/// Number of the hand that receives, which decides about walking.
const PLANNER: u32 = 1;

/// Clients without a thread: their queues by hand. One receives, as `planner`; others send.
struct ByHand {
    publish: [QueueSender; 3],
    registration: QueueSender,
    inbox: QueueReceiver,
    sequence: u64,
}

impl ByHand {
    fn new(space: &Space) -> Self {
        let sender = |queue| space.queue_sender(queue, "broker-queues").unwrap();
        Self {
            publish: ["broker-high", "broker-normal", "broker-low"].map(sender),
            registration: sender("broker-service"),
            inbox: space.queue_receiver("client-planner-1-0").unwrap(),
            sequence: 0,
        }
    }

    /// Registers the planner and two senders.
    fn register(&mut self) {
        for (token, name, domains) in
            [(PLANNER, "planner-1-0", &Domain::ALL[..]), (2, "a-1-0", &[]), (3, "b-1-0", &[])]
        {
            let numbers = [token, domain_mask(domains), 0];
            let mut payload: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
            payload.extend(name.bytes());
            assert!(self.registration.send(&service_message(service::REGISTER, 0, now(), &payload)));
        }
    }

    fn publish(&mut self, origin: u32, command: &Command, priority: Priority) {
        self.sequence += 1;
        let stamp = Stamp { origin, sequence: self.sequence, sent_ns: now(), grant: 0 };
        let mut buffer = [0; MAX_BYTES];
        let bytes = write_command(command, priority, &stamp, &mut buffer).unwrap();
        assert!(self.publish[priority as usize].send(bytes));
    }

    /// The commands that came, each accepted.
    fn heard(&mut self) -> Vec<Command> {
        let mut heard = Vec::new();
        while let Some(bytes) = self.inbox.receive() {
            let message = Message::parse(bytes).unwrap();
            let Ok(command) = message.command() else { continue };
            let (origin, sequence) = (message.stamp.origin, message.stamp.sequence);
            let payload = [&PLANNER.to_le_bytes()[..], &origin.to_le_bytes(), &[0]].concat();
            assert!(self.registration.send(&service_message(service::VERDICT, sequence, now(), &payload)));
            heard.push(command);
        }
        heard
    }
}

fn exchange(space: &Space) -> Exchange<'_> {
    Exchange::new(space, broker::inlet::gate().1, now()).unwrap()
}

/// However many messages of a lower class wait, or come in between, none is forwarded before a higher one that waits.
#[test]
fn a_higher_class_passes_a_lower_one() {
    let system = System::without_broker("order");
    let mut exchange = exchange(&system.space);
    let mut hand = ByHand::new(&system.space);
    hand.register();
    exchange.turn(now(), &mut |_| {});
    for n in 0..200 {
        hand.publish(2, &velocity(n), Priority::Low);
    }
    exchange.turn(now(), &mut |_| {});
    assert_eq!(hand.heard().len(), 64, "one turn is bounded");
    hand.publish(3, &Command::Stop, Priority::Normal);
    hand.publish(3, &Command::EmergencyStop, Priority::High);
    hand.publish(3, &Command::EmergencyStop, Priority::High);
    exchange.turn(now(), &mut |_| {});
    let heard = hand.heard();
    assert_eq!(heard[..4], [Command::EmergencyStop, Command::EmergencyStop, Command::Stop, velocity(64)]);
    let mut last = None;
    while exchange.turn(now(), &mut |_| {}) {
        last = hand.heard().last().copied().or(last);
    }
    assert_eq!(last, Some(velocity(199)));
}

/// A client that floods in class Low has filled the process that decides, and a line behind it. What the process holds
/// already is answered first; what waits in the line is passed.
#[test]
fn a_flood_of_low_priority_delays_a_normal_command_by_no_more_than_the_process_holds() {
    const HELD: usize = 96;
    let system = System::without_broker("flood");
    let mut exchange = exchange(&system.space);
    let mut hand = ByHand::new(&system.space);
    hand.register();
    exchange.turn(now(), &mut |_| {});
    for n in 0..250 {
        hand.publish(2, &velocity(n), Priority::Low);
    }
    for _ in 0..8 {
        exchange.turn(now(), &mut |_| {});
    }
    hand.publish(3, &Command::Stop, Priority::Normal);
    hand.publish(3, &Command::EmergencyStop, Priority::High);
    exchange.turn(now(), &mut |_| {});
    let mut heard = hand.heard();
    assert_eq!(heard.len(), HELD + 1, "the process holds no more, and the emergency stop waits for no room");
    assert_eq!(heard[HELD], Command::EmergencyStop);
    while exchange.turn(now(), &mut |_| {}) {
        heard.extend(hand.heard());
    }
    let lower =
        heard.iter().take_while(|c| **c != Command::Stop).filter(|c| matches!(c, Command::Velocity(_)));
    assert_eq!(lower.count(), HELD, "commands of class Low that came before the normal one");
    assert_eq!(heard.len(), 252, "and none is lost");
}

#[test]
fn a_class_is_not_a_matter_of_taste() {
    let system = System::without_broker("class");
    let mut exchange = exchange(&system.space);
    let mut hand = ByHand::new(&system.space);
    hand.register();
    exchange.turn(now(), &mut |_| {});
    let mut reports = Vec::new();
    hand.publish(3, &Command::Stop, Priority::High);
    hand.publish(3, &Command::EmergencyStop, Priority::Low);
    let mut buffer = [0; MAX_BYTES];
    let stamp = Stamp { origin: 2, sequence: 9, sent_ns: now(), grant: 0 };
    let low = write_command(&velocity(1), Priority::Low, &stamp, &mut buffer).unwrap().to_vec();
    assert!(hand.publish[0].send(&low), "a low message in the high queue");
    assert!(hand.publish[1].send(&[1, 2]), "less than a head");
    exchange.turn(now(), &mut |report| reports.push(report));
    assert_eq!(hand.heard(), []);
    let denied = reports.iter().filter(|r| matches!(r, BrokerEvent::Denied(..)));
    assert_eq!(denied.count(), 0, "none of them is a command that could stand in the log");
    let address = |(d, i): (Domain, u16)| (d as u32) << 16 | u32::from(i);
    let velocity = address(velocity(1).address());
    for expected in [address(Command::Stop.address()), 0, velocity, u32::MAX] {
        assert!(reports.contains(&BrokerEvent::Refused(expected)), "{expected:#x} is not in {reports:x?}");
    }
    assert!(exchange.statistics()[0].contains("refused 4;"));
}

#[test]
fn a_command_that_the_broker_itself_refuses_is_reported_with_its_reason() {
    let system = System::without_broker("denied");
    let mut exchange = exchange(&system.space);
    let mut hand = ByHand::new(&system.space);
    hand.register();
    exchange.turn(now(), &mut |_| {});
    hand.publish(2, &velocity(1), Priority::Normal);
    hand.publish(3, &velocity(2), Priority::Normal);
    hand.publish(2, &Command::Reset, Priority::Normal);
    let mut denied = Vec::new();
    exchange.turn(now(), &mut |report| {
        if let BrokerEvent::Denied(live, code) = report {
            denied.push((live.stamp.origin, live.stamp.sequence, live.command, code));
        }
    });
    // Somebody else holds the lease; there is no watchdog.
    assert_eq!(denied, [(3, 2, velocity(2), 9), (2, 3, Command::Reset, 10)]);
}

/// A turn that took longer than a millisecond refused what came meanwhile as from the future: 118 of 1234 of an operator's,
/// while strangers asked for the parameters. The clock of this test goes on by 3 ms with each reading, and a command is
/// sent just before it is read.
#[test]
fn what_comes_while_a_turn_goes_on_is_not_from_the_future() {
    const STEP: u64 = 3_000_000;
    let system = System::without_broker("long");
    let mut exchange = exchange(&system.space);
    let mut hand = ByHand::new(&system.space);
    hand.register();
    let begun = now();
    exchange.turn(begun, &mut |_| {});
    // The first reading is the turn's beginning.
    for n in 1..=30 {
        let stamp = Stamp { origin: 3, sequence: n, sent_ns: begun + n * STEP, grant: 0 };
        let mut buffer = [0; MAX_BYTES];
        let bytes = write_command(&velocity(n as u32), Priority::Normal, &stamp, &mut buffer).unwrap();
        assert!(hand.publish[Priority::Normal as usize].send(bytes));
    }
    let readings = Cell::new(0);
    let clock = || begun + readings.replace(readings.get() + 1) * STEP;
    let mut denied = Vec::new();
    exchange.turn_by(&clock, &mut |report| denied.push(report));
    assert_eq!(denied, []);
    assert_eq!(hand.heard(), (1..=30).map(velocity).collect::<Vec<_>>());
    // Whose clock is ahead is still refused, by more than a millisecond.
    for (n, lead, passes) in [(31, 900_000, true), (32, 1_100_000, false)] {
        let stamp = Stamp { origin: 3, sequence: n, sent_ns: clock() + STEP + lead, grant: 0 };
        let mut buffer = [0; MAX_BYTES];
        let bytes = write_command(&Command::Stand, Priority::Normal, &stamp, &mut buffer).unwrap();
        assert!(hand.publish[Priority::Normal as usize].send(bytes));
        exchange.turn(stamp.sent_ns - lead, &mut |_| {});
        assert_eq!(hand.heard().len(), usize::from(passes), "{lead} ns ahead");
    }
}

/// A control cycle that does not look for a while loses what has no room, and still gets the emergency stop first.
#[test]
fn a_cycle_that_does_not_look_loses_its_own_messages() {
    // Where the machine stands still for longer than a command lives, some of the 500 get too old: then once more.
    assert!((0..5).any(|_| flood_of_a_blind_cycle()), "commands got too old five times");
}

/// One round; false: a command got too old on its way.
fn flood_of_a_blind_cycle() -> bool {
    let system = System::start("blind");
    let mut blind = system.client("watchdog", &[Domain::Walk, Domain::System]);
    let mut seeing = system.client("planner", &[Domain::Walk]);
    let mut sender = system.client("sender", &[]);
    let too_old = Reason::TooOld { age_ns: 0 }.code();
    let mut seen = 0;
    for n in 0..500 {
        while sender.publish(&velocity(n)).is_none() {
            pause(1);
        }
        if n % 50 == 49 {
            let mut refused = false;
            harness::wait_for("what was sent", || {
                seen += seeing.received().count();
                refused |= std::iter::from_fn(|| sender.answered()).any(|answer| answer.code == too_old);
                refused || seen == n as usize + 1
            });
            if refused {
                return false;
            }
        }
    }
    sender.publish(&Command::EmergencyStop);
    harness::wait_for("the count", || blind.waiting() == 129 && blind.statistics().lost_in == 372);
    // What waited so long that it became too old is left out; the emergency stop never is.
    assert_eq!(blind.received().next(), Some(Command::EmergencyStop));
    assert_eq!((seen, seeing.statistics().lost_in), (500, 0));
    true
}

/// Before the broker is there for the first time, commands wait a moment for it.
#[test]
fn a_command_at_the_start_is_not_lost() {
    let system = System::start("early");
    let mut receiver = system.client("planner", &[Domain::Walk]);
    let mut sender = Client::start("sender", &[], &system.space).unwrap();
    assert!(sender.publish(&Command::Start).is_some());
    let mut heard = Vec::new();
    harness::wait_for("the command", || {
        heard.extend(receiver.received());
        !heard.is_empty()
    });
    assert_eq!(heard, [Command::Start]);
}

#[test]
fn noise_in_the_queues_never_panics() {
    let system = System::without_broker("noise");
    let both = RefCell::new((exchange(&system.space), ByHand::new(&system.space)));
    proptest!(ProptestConfig::with_cases(2000), |(
        mut noise in prop::collection::vec(any::<u8>(), 0..MAX_BYTES),
        place in 0usize..4,
        service in any::<bool>(),
        id in 0u8..8,
    )| {
        if service && noise.len() > HEAD {
            noise[..8].copy_from_slice(&[0xff, 0xff, id, 0, 2, 0, 0, 0]);
        }
        let (exchange, hand) = &mut *both.borrow_mut();
        let queue = if place == 3 { &mut hand.registration } else { &mut hand.publish[place] };
        prop_assert!(queue.send(&noise));
        while exchange.turn(now(), &mut |_| {}) {}
    });
    let (mut exchange, mut hand) = both.into_inner();
    hand.register();
    hand.publish(3, &Command::Stop, Priority::Normal);
    while exchange.turn(now(), &mut |_| {}) {}
    hand.publish(3, &Command::Stop, Priority::Normal);
    while exchange.turn(now(), &mut |_| {}) {}
    assert!(hand.heard().contains(&Command::Stop));
    assert!(exchange.statistics().len() <= 33, "no more clients than there is room for");
}
