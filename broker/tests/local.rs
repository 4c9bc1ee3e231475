//! Delivery inside one process.

use broker::LocalBroker;
use broker::local::{Outbox, Reach};
use messages::Command;
use messages::command::VelocityCommand;

#[derive(Default)]
struct Walker {
    heard: Vec<(&'static str, Command)>,
    rounds: u32,
}

const VELOCITY: Command = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.1 });

fn first(walker: &mut Walker, command: &Command, _: &mut Outbox) {
    walker.heard.push(("first", *command));
}

fn second(walker: &mut Walker, command: &Command, outbox: &mut Outbox) {
    walker.heard.push(("second", *command));
    outbox.publish(Command::Start, Reach::Local);
}

fn again(walker: &mut Walker, command: &Command, outbox: &mut Outbox) {
    walker.rounds += 1;
    for _ in 0..walker.rounds.min(3) {
        outbox.publish(*command, Reach::Local);
    }
}

#[test]
fn subscribers_of_the_id_are_called_in_order() {
    let mut broker = LocalBroker::<Walker>::new(None);
    broker.subscribe(VELOCITY.address(), first);
    broker.subscribe(Command::Stop.address(), first);
    broker.subscribe(VELOCITY.address(), second);
    broker.subscribe(Command::Start.address(), first);
    let mut walker = Walker::default();
    broker.publish(&mut walker, &VELOCITY, Reach::Global);
    broker.publish(&mut walker, &Command::Stand, Reach::Local);
    assert_eq!(walker.heard, [("first", VELOCITY), ("second", VELOCITY), ("first", Command::Start)]);
    assert_eq!(broker.lost(), 0);
}

/// Two state machines that answer each other for ever hold up nobody, and what they lose is counted.
#[test]
fn an_endless_conversation_ends() {
    let mut broker = LocalBroker::<Walker>::new(None);
    broker.subscribe(Command::Start.address(), again);
    let mut walker = Walker::default();
    broker.publish(&mut walker, &Command::Start, Reach::Local);
    assert_eq!(walker.rounds, 64);
    assert!(broker.lost() > 0);
    walker.rounds = 0;
    broker.publish(&mut walker, &Command::Stand, Reach::Local);
    assert_eq!(walker.rounds, 0, "what was left over must not come later");
}
