use super::*;
use crate::inlet::{self, BrokerTable, Gate, Request};
use crate::members::Outgoing;
use crate::message::{MAX_BYTES, Message, domain_mask, write_command};
use crate::observation::Observation;
use config::Setup;
use ipc::{Space, Writer};
use messages::command::{Domain, Priority, VelocityCommand};
use messages::topics::{CONTROLLER_STATE, EVENTS_WATCHDOG, PARAMETERS_CONTROLLER, POWER, SENSORS};
use messages::{Command, ControllerState, Event, EventCode, GaitState, Header, Parameters, Power, Sensors};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use realtime::clock::SECOND;
use tokio::sync::{mpsc, oneshot};

/// Space of a run without processes: what they would write, the test writes.
struct Run {
    space: Option<Space>,
    dir: std::path::PathBuf,
    setup: Setup,
}

impl Run {
    fn new(name: &str) -> Self {
        let dir = std::env::temp_dir().join(format!("gangwerk-watch-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&dir);
        let setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
        Self { space: Some(Space::create(&dir).unwrap()), dir, setup }
    }

    fn space(&self) -> &Space {
        self.space.as_ref().unwrap()
    }

    fn exchange(&self) -> (Exchange<'_>, Gate) {
        let (gate, inlet) = inlet::gate();
        let robot = Observation::open(self.space(), Some(&self.setup)).unwrap();
        (Exchange::new(self.space(), inlet, SECOND).unwrap().showing(robot), gate)
    }

    /// A robot that walks, with a gain that is not the default.
    fn walks(&self) -> Writer<Parameters> {
        let header = Header { tick: 5000, ..Header::default() };
        let space = self.space();
        space.writer(&SENSORS).unwrap().write(&Sensors { header, start_up: 6, ..Sensors::default() });
        space.writer(&POWER).unwrap().write(&Power { header, on: 1, ..Power::default() });
        let gait = GaitState::Walking as u64;
        let state = ControllerState { header, gait, ..ControllerState::default() };
        space.writer(&CONTROLLER_STATE).unwrap().write(&state);
        let mut writer = space.writer(&PARAMETERS_CONTROLLER).unwrap();
        writer.write(&set(4321.0));
        writer
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        drop(self.space.take());
        let _ = std::fs::remove_dir_all(&self.dir);
    }
}

/// Parameters of the stabilizer with this K_P of the height, number 4.
fn set(height_p: f64) -> Parameters {
    let mut parameters = Parameters { count: 16, ..Parameters::default() };
    parameters.values[4] = height_p;
    parameters
}

/// A client whose stream has room for so many frames.
struct Client {
    token: u32,
    answers: mpsc::UnboundedReceiver<Vec<u8>>,
    frames: mpsc::Receiver<Vec<u8>>,
}

impl Client {
    fn join(gate: &Gate, token: u32, room: usize, may: u32) -> Self {
        let (answers, given) = mpsc::unbounded_channel();
        let (frames, subscribed) = mpsc::channel(room);
        let (done, _joined) = oneshot::channel();
        let (name, out) = (format!("client {token}"), Outgoing { answers, frames });
        gate.ask(Request::Join { token, name, may, out, done });
        Self { token, answers: given, frames: subscribed }
    }

    fn watch(&self, gate: &Gate, rate: u16, events: bool) {
        gate.ask(Request::Watch { token: self.token, sequence: 1, rate, events });
    }

    /// Service and payload of the frames that came.
    fn seen(&mut self) -> Vec<(u16, Vec<u8>)> {
        let parsed = |bytes: Vec<u8>| Message::parse(&bytes).map(|m| (m.id, m.payload.to_vec())).unwrap();
        std::iter::from_fn(|| self.frames.try_recv().ok()).map(parsed).collect()
    }

    /// Takes the lease over, gives it back, sets a parameter or commands a velocity.
    fn hand_in(&self, gate: &Gate, what: i32, sequence: u64) {
        let (token, sent_ns) = (self.token, SECOND);
        match what {
            0 => gate.ask(Request::TakeLease { token, sequence, sent_ns, over: true }),
            1 => gate.ask(Request::GiveLease { token, sequence }),
            2 => {
                let name = "controller.height_p".into();
                gate.ask(Request::Set { token, sequence, sent_ns, value: 1e4, name });
            }
            _ => {
                let walk = Command::Velocity(VelocityCommand { forward: 0.2, left: 0.0, turn: 0.0 });
                let stamp = Stamp { sequence, sent_ns, ..Stamp::default() };
                let mut buffer = [0; MAX_BYTES];
                let bytes = write_command(&walk, Priority::Normal, &stamp, &mut buffer).unwrap();
                gate.publish(token, Priority::Normal, bytes);
            }
        }
    }

    /// Sequence and code of the next answer; 0: accepted.
    fn answer(&mut self) -> (u64, u8) {
        let bytes = self.answers.try_recv().unwrap();
        let message = Message::parse(&bytes).unwrap();
        let code = if message.id == service::REFUSED { message.payload[0] } else { 0 };
        (message.stamp.sequence, code)
    }

    /// Code and text of the next answer.
    fn refused(&mut self) -> (u8, String) {
        let bytes = self.answers.try_recv().unwrap();
        let message = Message::parse(&bytes).unwrap();
        assert_eq!(message.id, service::REFUSED);
        (message.payload[0], String::from_utf8_lossy(&message.payload[1..]).into_owned())
    }
}

/// A number of a STATE.
fn number(payload: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(payload[12 + 4 * at..][..4].try_into().unwrap())
}

#[test]
fn who_comes_in_the_middle_of_a_walk_knows_lease_supply_walking_state_and_parameters_at_once() {
    let run = Run::new("retained");
    let mut writer = run.walks();
    let (mut exchange, gate) = run.exchange();
    let all = domain_mask(&Domain::ALL);
    let _holder = Client::join(&gate, 0x8000_0001, 128, all);
    gate.ask(Request::TakeLease { token: 0x8000_0001, sequence: 1, sent_ns: SECOND, over: false });
    exchange.turn(SECOND, &mut |_| {});
    let mut late = Client::join(&gate, 0x8000_0002, 128, 0);
    late.watch(&gate, 0, false);
    exchange.turn(SECOND + 1, &mut |_| {});
    let seen = late.seen();
    let text = |id: u16| -> Vec<String> {
        let of = seen.iter().filter(|(i, _)| *i == id);
        of.map(|(_, payload)| String::from_utf8_lossy(payload).into_owned()).collect()
    };
    assert!(text(service::LEASE)[0].ends_with("client 2147483649"), "who holds the lease");
    assert!(text(service::PARAMETER).iter().any(|p| p.ends_with("planner.swing_height")));
    let told = |value: f64, seen: &[(u16, Vec<u8>)]| {
        let payload = [&value.to_le_bytes()[..], b"controller.height_p"].concat();
        seen.iter().filter(|(id, p)| *id == service::PARAMETER && *p == payload).count()
    };
    assert_eq!(told(4321.0, &seen), 1, "what it is set to, not what the file says");
    let (_, state) = seen.iter().find(|(id, _)| *id == service::STATE).unwrap();
    assert_eq!(state[..8], 5000u64.to_le_bytes());
    let gait = GaitState::Walking as u64 as f32;
    assert_eq!(
        [0, 1, 2, 3].map(|i| number(state, i)),
        [1.0, 0.0, 6.0, gait],
        "supply, reason, start-up, gait"
    );
    // Later only what changes.
    exchange.turn(SECOND + 2, &mut |_| {});
    assert_eq!(late.seen(), []);
    writer.write(&set(4000.0));
    exchange.turn(SECOND + 3, &mut |_| {});
    let seen = late.seen();
    assert_eq!((told(4000.0, &seen), seen.len()), (1, 1));
    // A subscription to commands tells who holds the lease, too.
    gate.ask(Request::Subscribe { token: late.token, sequence: 2, domains: all });
    exchange.turn(SECOND + 4, &mut |_| {});
    assert_eq!(late.seen()[0].0, service::LEASE);
}

#[test]
fn each_client_gets_states_at_its_own_rate() {
    let run = Run::new("rates");
    let _writer = run.walks();
    let (mut exchange, gate) = run.exchange();
    let rates = [1, 7, 50];
    let mut clients: Vec<_> = (0..3).map(|i| Client::join(&gate, 0x8000_0001 + i, 1000, 0)).collect();
    for (client, rate) in clients.iter().zip(rates) {
        client.watch(&gate, rate, false);
    }
    exchange.turn(SECOND, &mut |_| {});
    // The broker looks every 10 ms; once it is stopped for a second, which is not caught up on.
    for k in (1..=200).chain(301..=500) {
        exchange.turn(SECOND + k * SECOND / 100, &mut |_| {});
    }
    for (client, rate) in clients.iter_mut().zip(rates) {
        let states = client.seen().iter().filter(|(id, _)| *id == service::STATE).count() as u16;
        let (least, most) = (1 + 4 * rate, 1 + 4 * rate + 2);
        assert!((least..=most).contains(&states), "{rate} Hz for 4 s: {states}");
    }
}

#[test]
fn who_does_not_read_loses_its_own_messages_only_and_is_told_how_many() {
    let run = Run::new("slow");
    let _writer = run.walks();
    let mut events = run.space().writer::<Event>(&EVENTS_WATCHDOG).unwrap();
    let (mut exchange, gate) = run.exchange();
    let mut fast = Client::join(&gate, 0x8000_0001, 128, 0);
    let mut slow = Client::join(&gate, 0x8000_0002, 30, 0);
    let quiet = Client::join(&gate, 0x8000_0003, 128, 0);
    fast.watch(&gate, 0, true);
    slow.watch(&gate, 0, true);
    exchange.turn(SECOND, &mut |_| {});
    let before = fast.seen().len();
    for detail in 0..500 {
        events.write(&Event { code: EventCode::ResetMissed as u64, detail, ..Event::default() });
        exchange.turn(SECOND + detail, &mut |_| {});
        let expected =
            [&0u64.to_le_bytes()[..], &5u32.to_le_bytes(), &detail.to_le_bytes(), b"watchdog ResetMissed"]
                .concat();
        assert_eq!(fast.seen(), [(service::EVENT, expected)]);
    }
    let read = slow.seen().len();
    assert_eq!(read, 30, "as much as its stream has room for");
    slow.watch(&gate, 0, true);
    exchange.turn(2 * SECOND, &mut |_| {});
    let seen = slow.seen();
    let (_, state) = seen.iter().find(|(id, _)| *id == service::STATE).unwrap();
    let lost = u32::from_le_bytes(state[8..12].try_into().unwrap());
    assert_eq!(lost as usize, before + 500 - read);
    assert_eq!(exchange.statistics().iter().filter(|line| line.contains("lost 0;")).count(), 2);
    assert!(quiet.frames.is_empty(), "who did not ask is not bothered");
}

#[test]
fn a_parameter_is_set_by_name_or_refused_with_the_reason() {
    let run = Run::new("set");
    let (mut exchange, gate) = run.exchange();
    let mut operator = Client::join(&gate, 0x8000_0001, 128, domain_mask(&Domain::ALL));
    let mut stranger = Client::join(&gate, 0x8000_0002, 128, 0);
    let set = |token, sequence, name: &str, value| {
        gate.ask(Request::Set { token, sequence, sent_ns: SECOND, value, name: name.into() });
    };
    set(operator.token, 1, "controller.height_p", 1e4);
    set(operator.token, 2, "planner.swing_height", 0.5);
    set(operator.token, 3, "lowlevel.bus.missed", 10.0);
    set(operator.token, 4, "broker.lease", 10.0);
    set(operator.token, 5, "nothing", 1.0);
    set(stranger.token, 1, "controller.height_p", 1e4);
    exchange.turn(SECOND, &mut |_| {});
    // There is no process here: a command that passes is refused for that.
    for (code, text) in [
        (10, "controller decides about this and is not there"),
        (5, "planner.swing_height = 0.5 is outside of [0, 0.15] m; nothing was changed"),
        (13, "lowlevel.bus.missed is fixed at start: change it in config/system.toml"),
        (13, "broker.lease is a constant of the program"),
        (13, "there is no parameter `nothing`; `gangwerk param list` shows them all"),
    ] {
        assert_eq!(operator.refused(), (code, text.into()));
    }
    assert_eq!(stranger.refused().0, 8);
    gate.ask(Request::Lines { token: stranger.token, sequence: 2, table: BrokerTable::Parameters });
    exchange.turn(SECOND, &mut |_| {});
    let lines: Vec<String> = std::iter::from_fn(|| stranger.answers.try_recv().ok())
        .map(|bytes| String::from_utf8_lossy(Message::parse(&bytes).unwrap().payload).into_owned())
        .collect();
    for expected in [
        "planner.swing_height m 0.0 0.15 0.055 0.055 live ",
        "lowlevel.bus.missed cycles 1.0 1000.0 20.0 20.0 fixed ",
        "broker.lease s 0.5 0.5 0.5 0.5 constant ",
    ] {
        assert!(lines.iter().any(|line| line.starts_with(expected)), "{expected}: {lines:#?}");
    }
}

/// Of 200 parameters set in one write with a velocity, over half were refused as out of order; a lease that was taken over in
/// one write with a velocity came after it. In any order that a client sends, nothing of that is refused.
#[test]
fn whatever_a_client_sends_is_decided_in_its_order() {
    let run = Run::new("in-order");
    let mut runner = TestRunner::deterministic();
    for _ in 0..100 {
        let (mut exchange, gate) = run.exchange();
        let all = domain_mask(&Domain::ALL);
        let mut holder = Client::join(&gate, 0x8000_0001, 128, all);
        let mut operator = Client::join(&gate, 0x8000_0002, 128, all);
        gate.ask(Request::TakeLease { token: holder.token, sequence: 1, sent_ns: SECOND, over: false });
        exchange.turn(SECOND, &mut |_| {});
        holder.answers.try_recv().unwrap();
        let steps = prop::collection::vec(0..4, 1..20).new_tree(&mut runner).unwrap().current();
        for (step, sequence) in steps.iter().zip(1..) {
            operator.hand_in(&gate, *step, sequence);
        }
        exchange.turn(SECOND, &mut |_| {});
        // The lease is the other one's until it is taken over, free once it is given back, and then the next command's.
        let mut mine = false;
        let mut free = false;
        for (step, sequence) in steps.iter().zip(1..) {
            (mine, free) = match step {
                0 => (true, false),
                1 => (false, free || mine),
                _ => (mine || free, false),
            };
            // Nobody is there to decide: what passes the broker is refused for that.
            let code = if *step < 2 {
                0
            } else if mine {
                10
            } else {
                9
            };
            assert_eq!(operator.answer(), (sequence, code), "{steps:?}");
        }
    }
}
