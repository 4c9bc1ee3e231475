//! Real processes, a real broker process, shared memory.

mod harness;

use std::time::Duration;

use broker::Client;
use broker::client::Answered;
use harness::{Killed, Receive, System, pause, play_role, wait_for};
use messages::command::{Domain, Priority, PushCommand, VelocityCommand};
use messages::command_stamp::LEASE;
use messages::topics::EVENTS_BROKER;
use messages::{Command, CommandSource, Event, EventCode, Lease};
use realtime::clock::now;
use rustix::process::{Pid, Signal, kill_process};

fn velocity(n: u32) -> Command {
    Command::Velocity(VelocityCommand { forward: f64::from(n) / 4096.0, left: 0.0, turn: 0.0 })
}

/// The other processes of these tests: `planner` answers every velocity with a stop.
#[test]
fn process() {
    play_role(|role, space| {
        let mut client = Client::start(role, &[Domain::Walk], space).expect("client");
        let mut answers = Vec::new();
        loop {
            answers.extend(client.received().filter_map(|c| match c {
                Command::Velocity(_) if role == "planner" => Some(Command::Stop),
                _ => None,
            }));
            answers.drain(..).for_each(|answer| _ = client.publish(&answer));
            pause(1);
        }
    });
}

fn signal(Killed(process): &Killed, signal: Signal) {
    kill_process(Pid::from_child(process), signal).expect("signal");
}

#[test]
fn a_command_goes_to_another_process_and_back() {
    let system = System::start("echo");
    let mut client = system.client("operator", &[Domain::Walk]);
    let mut other = system.client("other", &[Domain::System, Domain::Sim]);
    let echo = system.spawn("planner");
    wait_for("the echo", || system.line_about("planner").is_some());
    let sequence = client.publish(&velocity(1024)).expect("room");
    let mut heard = Vec::new();
    wait_for("the answer", || {
        heard.extend(client.received());
        !heard.is_empty()
    });
    drop(echo);
    assert_eq!(heard, [Command::Stop], "its own message must not come back");
    let mut answered = None;
    wait_for("the acceptance", || {
        answered = client.answered();
        answered.is_some()
    });
    assert_eq!(answered, Some(Answered { sequence, code: 0 }));
    assert_eq!(other.received().count(), 0, "not its domain");
}

/// Through sender, broker and receiver: of the messages published after the emergency stop, those may come before it
/// that the sender's thread was just carrying out (at most a ring), and one in the broker and the receiver each.
#[test]
fn an_emergency_stop_passes_a_flood() {
    let system = System::start("flood");
    let mut flood = system.client("flood", &[]);
    let mut watchdog = system.client("watchdog", &[Domain::System]);
    for _ in 0..20 {
        let (mut published, mut overtaking) = (0, 0);
        let marked = Command::Enable;
        wait_for("the emergency stop", || {
            for _ in 0..200 {
                let command = if published < 400 { Command::Reset } else { marked };
                flood.publish_as(&command, Priority::Low);
                published += 1;
                if published == 400 {
                    flood.publish(&Command::EmergencyStop);
                }
            }
            let heard: Vec<_> = watchdog.received().collect();
            let stop = heard.iter().position(|c| *c == Command::EmergencyStop);
            let before = heard[..stop.unwrap_or(heard.len())].iter().filter(|c| **c == marked).count();
            overtaking += before;
            stop.is_some()
        });
        assert!(overtaking <= 130, "{overtaking} messages came before the emergency stop");
        // The next round begins with empty queues.
        let mut quiet = 0;
        wait_for("the end of the flood", || {
            quiet = if watchdog.received().count() == 0 { quiet + 1 } else { 0 };
            quiet > 10
        });
    }
}

#[test]
fn a_stopped_process_loses_its_own_messages_only() {
    let system = System::start("stopped");
    let sleeper = system.spawn("sleeper");
    let mut awake = system.client("planner", &[Domain::Walk]);
    let mut sender = system.client("sender", &[]);
    wait_for("the sleeper", || system.line_about("sleeper").is_some());
    signal(&sleeper, Signal::STOP);
    let mut heard = Vec::new();
    for n in 0..1000 {
        assert!(sender.publish(&velocity(n)).is_some());
        if n % 50 == 49 {
            wait_for("what was sent", || {
                heard.extend(awake.received());
                heard.len() == n as usize + 1
            });
        }
    }
    signal(&sleeper, Signal::CONT);
    wait_for("the report of the loss", || {
        system.line_about("sleeper").is_some_and(|line| !line.contains("lost 0;"))
    });
    let expected: Vec<_> = (0..1000).map(velocity).collect();
    assert_eq!(heard, expected, "the others get everything, in order");
    assert_eq!((awake.statistics().lost_in, sender.statistics().lost_out), (0, 0));
    let mut events = system.space.reader::<Event>(&EVENTS_BROKER).unwrap();
    wait_for("the event", || {
        events.follow().is_some_and(|e| e.code == EventCode::MessagesLost as u64 && e.detail > 0)
    });
    drop(sleeper);
}

#[test]
fn a_killed_client_is_let_go() {
    let system = System::start("killed");
    let mut awake = system.client("planner", &[Domain::Walk]);
    let mut sender = system.client("sender", &[]);
    let victim = system.spawn("victim");
    wait_for("the victim", || system.line_about("victim").is_some());
    drop(victim);
    for n in 0..100 {
        assert!(sender.publish(&velocity(n)).is_some());
    }
    let mut heard = 0;
    wait_for("what was sent", || {
        heard += awake.received().count();
        heard == 100
    });
    wait_for("the end of the victim's registration", || system.line_about("victim").is_none());
    let again = system.spawn("victim");
    wait_for("the next victim", || system.line_about("victim").is_some());
    drop(again);
}

#[test]
fn clients_outlive_the_broker() {
    let mut system = System::start("restart");
    let mut sender = system.client("sender", &[Domain::Sim]);
    let mut receiver = system.client("planner", &[Domain::Walk]);
    for life in 0..3 {
        assert!(sender.publish(&velocity(life)).is_some());
        let mut heard = Vec::new();
        wait_for("the command", || {
            heard.extend(receiver.received());
            !heard.is_empty()
        });
        assert_eq!(heard, [velocity(life)]);
        system.kill_broker();
        wait_for("the notice of the broker's end", || !sender.statistics().connected);
        wait_for("the notice of the broker's end", || !receiver.statistics().connected);
        assert!(sender.publish(&velocity(7)).is_some(), "publishing without a broker is an ordinary call");
        wait_for("the count of the loss", || sender.statistics().lost_out == u64::from(life) + 1);
        system.space.clear_dead();
        system.start_broker();
        wait_for("the registration", || sender.statistics().connected && receiver.statistics().connected);
        // What was sent to nobody must not move the robot later.
        pause(20);
        assert_eq!(receiver.received().count(), 0);
    }
}

/// Nothing of this test waits: the rings fill up, and that is all.
#[test]
fn without_a_broker_publishing_never_waits() {
    let system = System::without_broker("alone");
    let mut client = Client::start("alone", &[Domain::Walk], &system.space).unwrap();
    for n in 0..100_000 {
        client.publish(&velocity(n % 1000));
    }
    assert_eq!(client.received().count(), 0);
    wait_for("the count of all losses", || client.statistics().lost_out == 100_000);
    assert!(!client.statistics().connected);
}

#[test]
fn a_broker_that_is_asked_to_end_ends() {
    let system = System::without_broker("ends");
    assert_eq!(system.spawn("broker that ends").0.wait().unwrap().code(), Some(0));
    let mut events = system.space.reader::<Event>(&EVENTS_BROKER).unwrap();
    let codes: Vec<_> = std::iter::from_fn(|| events.follow().map(|e| e.code)).collect();
    assert_eq!(codes, [EventCode::Started as u64, EventCode::Ended as u64]);
}

#[test]
fn a_second_broker_is_refused() {
    let system = System::start("second");
    let second = system.spawn("broker").0.wait().unwrap();
    assert_eq!(second.code(), Some(2));
    let mut client = system.stream();
    client.subscribe(&[Domain::Walk]).unwrap();
    let refused = system.stream().publish(&Command::Stop).unwrap_err();
    assert_eq!(refused, "planner decides about this and is not there");
    assert_eq!(client.receive(Duration::from_secs(10)), Ok(Some(Command::Stop)), "the first one goes on");
}

/// Issue 10, item 3: a command that waited in a process that stood still takes no effect when the process goes on, wherever
/// it stood still. Here the consumer's cycle does not look for 150 ms.
#[test]
fn an_old_command_is_dropped_in_the_cycle_that_would_take_it() {
    let system = System::start("old");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut sender = system.client("sender", &[]);
    let old = sender.publish(&velocity(7)).unwrap();
    let stop = sender.publish(&Command::Stop).unwrap();
    pause(150);
    wait_for("both", || planner.waiting() == 2);
    assert_eq!(planner.received().collect::<Vec<_>>(), [Command::Stop], "a stop is never too old");
    let mut answers = Vec::new();
    wait_for("the answers", || {
        answers.extend(sender.answered());
        answers.len() == 2
    });
    assert_eq!(answers, [Answered { sequence: old, code: 20 }, Answered { sequence: stop, code: 0 }]);
}

/// The same with a broker that stands still.
#[test]
fn a_stalled_broker_forwards_no_old_command() {
    let mut system = System::start("stalled");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut client = system.stream();
    client.publish(&Command::Push(PushCommand { force: [0.0; 3], duration: 0.0 })).unwrap_err();
    system.signal_broker(Signal::STOP);
    let walk = client.send(&velocity(7)).unwrap();
    let stop = client.send(&Command::Stop).unwrap();
    pause(150);
    system.signal_broker(Signal::CONT);
    let mut heard = Vec::new();
    wait_for("the stop", || {
        heard.extend(planner.received());
        !heard.is_empty()
    });
    assert_eq!(heard, [Command::Stop]);
    let refused = client.answer(walk).unwrap();
    assert!(refused.code == 20 && refused.text.contains("ms old, at most 100 ms"), "{refused:?}");
    assert_eq!(client.answer(stop).unwrap().accepted(), Ok("planner".into()));
}

/// A client that closes its link commands nothing any more, neither by what is on its way nor by what goes on.
#[test]
fn a_closed_connection_loses_its_lease_and_its_commands() {
    let system = System::start("closed");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut client = system.stream();
    client.send(&velocity(7)).unwrap();
    wait_for("the command", || planner.waiting() == 1);
    assert_ne!(planner.lease(), Lease::default());
    drop(client);
    wait_for("the end of the lease", || planner.lease() == Lease::default());
    assert_eq!(planner.received().count(), 0, "it had not been looked at yet");
}

/// The holder stands still, or is killed without a word: half a second later its lease is over for everybody, and also
/// when the broker itself is dead.
#[test]
fn a_silent_holder_and_a_dead_broker_end_the_lease() {
    let mut system = System::start("silent");
    let planner = system.client("planner", &[Domain::Walk]);
    let mut client = system.stream();
    client.take_lease(false).unwrap();
    wait_for("the lease", || {
        planner.lease().covers(planner.lease().grant, now()) && planner.lease().grant != 0
    });
    let first = planner.lease();
    pause(300);
    client.ping().unwrap();
    wait_for("the renewal", || planner.lease().until_ns > first.until_ns);
    assert_eq!(planner.lease().grant, first.grant);
    // Nothing is sent from here on.
    wait_for("the end", || planner.lease() == Lease::default());
    client.take_lease(false).unwrap();
    wait_for("the next lease", || planner.lease().grant != 0);
    let second = planner.lease();
    assert_ne!(second.grant, first.grant, "what was commanded under the first does not come back");
    system.kill_broker();
    wait_for("the end by its time", || !planner.lease().covers(second.grant, now()));
    assert!(planner.lease().until_ns <= second.until_ns + LEASE);
}

#[test]
fn a_process_that_hangs_is_named_to_the_operator() {
    let system = System::start("hangs");
    let _planner = system.client("planner", &[Domain::Walk]); // nobody looks at what comes
    let refused = system.stream().publish(&Command::Stand).unwrap_err();
    assert!(refused.contains("planner has not answered in time"), "{refused}");
}
