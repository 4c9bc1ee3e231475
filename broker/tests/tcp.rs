//! A real broker process and hostile, slow, many and ordinary TCP clients.

mod harness;

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::Duration;

use broker::tcp::{CONNECTIONS, RESERVE};
use broker::{Client, TcpClient};
use harness::{System, play_role, wait_for};
use messages::Command;
use messages::command::{Domain, Priority, PushCommand, VelocityCommand};
use messages::topics::EVENTS_BROKER;
use messages::{Event, EventCode};

const SECONDS: Duration = Duration::from_secs(10);

#[test]
fn process() {
    play_role(|role, _| panic!("no role {role}"));
}

fn velocity(forward: f64) -> Command {
    Command::Velocity(VelocityCommand { forward, left: 0.0, turn: -0.1 })
}

/// Sends bytes and returns the text of all that comes back until the broker closes the connection.
fn answer_to(system: &System, bytes: &[u8]) -> String {
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, system.port)).unwrap();
    stream.set_read_timeout(Some(SECONDS)).unwrap();
    stream.write_all(bytes).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("the broker closes the connection in order");
    String::from_utf8_lossy(&answer).into_owned()
}

/// The broker still works.
fn assert_alive(system: &System, client: &mut Client) {
    let text = velocity(0.5);
    assert!(system.tcp().publish(&text).unwrap() >= 1);
    let mut heard = Vec::new();
    wait_for("a command", || {
        heard.extend(client.received());
        !heard.is_empty()
    });
    assert_eq!(heard, [text]);
}

#[test]
fn a_command_arrives_unchanged() {
    let system = System::start("arrives");
    let mut planner = system.client("planner", &[Domain::Walk, Domain::Sim]);
    let mut screen = system.tcp();
    screen.subscribe(&[Domain::Walk, Domain::System]).unwrap();
    let mut operator = system.tcp();
    let push = Command::Push(PushCommand { force: [0.1, -0.0, 1e-300], duration: 0.1 });
    assert_eq!(operator.publish(&velocity(0.1 + 0.2)), Ok(2));
    assert_eq!(operator.publish(&push), Ok(1));
    assert_eq!(operator.publish_as(&Command::Stop, Priority::Low), Ok(2));
    assert_eq!(operator.publish(&Command::EmergencyStop), Ok(1));
    let mut heard = Vec::new();
    wait_for("the commands", || {
        heard.extend(planner.received());
        heard.len() == 3
    });
    assert_eq!(heard, [velocity(0.1 + 0.2), push, Command::Stop]);
    let mut seen = || screen.receive(SECONDS).unwrap();
    assert_eq!(
        [seen(), seen(), seen()],
        [Some(velocity(0.1 + 0.2)), Some(Command::Stop), Some(Command::EmergencyStop)]
    );
    assert_eq!(screen.receive(Duration::from_millis(1)), Ok(None));
    // And the other way, without an echo.
    planner.publish(&Command::Start);
    assert_eq!(screen.receive(SECONDS), Ok(Some(Command::Start)));
    assert_eq!(screen.publish(&Command::Stand), Ok(1));
    assert_eq!(screen.receive(Duration::from_millis(1)), Ok(None));
}

#[test]
fn bad_numbers_are_refused_with_a_reason() {
    let system = System::start("numbers");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut operator = system.tcp();
    for (bad, word) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (3.0, "3"), (-1e308, "-1")] {
        let error = operator.publish(&velocity(bad)).unwrap_err();
        assert!(error.contains("walk/velocity: forward = ") && error.contains(word), "{error}");
        assert!(error.contains("[-2, 2] m/s"), "{error}");
    }
    let error = operator.publish_as(&Command::Start, Priority::High).unwrap_err();
    assert!(error.contains("walk/start cannot be sent with priority High"), "{error}");
    // The connection lives on, and nothing came through.
    assert_eq!(operator.publish(&velocity(1.0)), Ok(1));
    let mut heard = Vec::new();
    wait_for("the good one", || {
        heard.extend(planner.received());
        !heard.is_empty()
    });
    assert_eq!(heard, [velocity(1.0)]);
    assert!(system.line_about("broker").unwrap().contains("refused 5;"));
    let mut events = system.space.reader::<Event>(&EVENTS_BROKER).unwrap();
    let mut refused = 0;
    while let Some(event) = events.follow() {
        refused += usize::from(event.code == EventCode::CommandRefused as u64);
    }
    assert_eq!(refused, 5);
}

#[test]
fn garbage_closes_its_own_connection_only() {
    let system = System::start("garbage");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut bystander = system.tcp();
    let bad: [(&[u8], &str); 6] = [
        (b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", "length 542393671, a frame has 5 to 512 bytes"),
        (&[0xff; 4], "length 4294967295"),
        (&[0; 64], "length 0"),
        (&[5, 0, 0, 0, 1, 0, 4, 0, 9], "priority 9"),
        (&[5, 0, 0, 0, 77, 0, 4, 0, 1], "domain 77"),
        (&[5, 0, 0, 0, 0xff, 0xff, 99, 0, 1], "service 99"),
    ];
    for (bytes, reason) in bad {
        let answer = answer_to(&system, bytes);
        assert!(answer.contains(reason) && answer.contains("not a frame"), "{answer:?}");
    }
    let much: Vec<u8> = (0..1_000_000u32).flat_map(|n| n.wrapping_mul(0x9e37_79b9).to_le_bytes()).collect();
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, system.port)).unwrap();
    let _ = stream.write_all(&much);
    assert_eq!(bystander.publish(&Command::Stop), Ok(1));
    wait_for("the stop", || planner.received().count() == 1);
    assert_alive(&system, &mut planner);
}

/// A frame that is one, with a payload that is none: refused, and the connection goes on.
#[test]
fn a_payload_that_is_no_command_is_refused() {
    let system = System::start("payload");
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, system.port)).unwrap();
    stream.set_read_timeout(Some(SECONDS)).unwrap();
    let mut ask = |message: &[u8]| {
        let frame = [&(message.len() as u32).to_le_bytes(), message].concat();
        stream.write_all(&frame).unwrap();
        let mut length = [0; 4];
        stream.read_exact(&mut length).unwrap();
        let mut answer = vec![0; u32::from_le_bytes(length) as usize];
        stream.read_exact(&mut answer).unwrap();
        String::from_utf8_lossy(&answer[6..]).into_owned()
    };
    for n in 0..40 {
        // walk/velocity, cut or with something left over; and an address that names another command.
        let mut message = vec![1, 0, 4, 0, 1];
        message.extend(std::iter::once(8).chain([0; 27]).chain([7; 12]).take(n));
        let answer = ask(&message);
        assert!(n == 28 || answer.contains("not a command"), "{n}: {answer}");
    }
    let other = ask(&[1, 0, 4, 0, 1, 1, 0, 0, 0]);
    assert!(other.contains("message (1, 4) carries system/reset"), "{other}");
}

#[test]
fn who_stops_writing_still_gets_the_answers() {
    let system = System::start("shut");
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, system.port)).unwrap();
    let stop = [9, 0, 0, 0, 1, 0, 2, 0, 1, 6, 0, 0, 0];
    stream.write_all(&stop.repeat(3)).unwrap();
    stream.shutdown(std::net::Shutdown::Write).unwrap();
    let mut answers = Vec::new();
    stream.read_to_end(&mut answers).unwrap();
    assert_eq!(answers, [9, 0, 0, 0, 0xff, 0xff, 16, 0, 2, 0, 0, 0, 0].repeat(3));
}

#[test]
fn silence_after_half_a_frame_ends_the_connection() {
    let system = System::start("half");
    let answer = answer_to(&system, &[40, 0, 0, 0, 1, 0]);
    assert!(answer.contains("the rest of a frame did not come in time"), "{answer:?}");
    let answer = answer_to(&system, &[]);
    assert!(answer.contains("a frame did not come in time"), "{answer:?}");
}

#[test]
fn too_many_connections_leave_room_for_an_emergency_stop() {
    let system = System::start("many");
    let mut watchdog = system.client("watchdog", &[Domain::System, Domain::Walk]);
    let mut first = system.tcp();
    assert_eq!(first.publish(&velocity(0.1)), Ok(1));
    let connect = |_| TcpStream::connect((Ipv4Addr::LOCALHOST, system.port)).unwrap();
    let crowd: Vec<_> = (0..100).map(connect).collect();
    assert!(crowd.len() > CONNECTIONS + RESERVE);
    let refused = system.tcp().publish(&Command::Start).unwrap_err();
    assert!(refused.contains("too many connections"), "{refused}");
    // Nor does anything else that calls itself urgent.
    let answer = answer_to(&system, &[9, 0, 0, 0, 0xff, 0xff, 3, 0, 0, 0xff, 0, 0, 0]);
    assert!(answer.contains("too many connections"), "{answer}");
    assert_eq!(system.tcp().publish(&Command::EmergencyStop), Ok(1));
    // Who was there before is served on.
    assert_eq!(first.publish(&velocity(0.2)), Ok(1));
    let mut heard = Vec::new();
    wait_for("the commands", || {
        heard.extend(watchdog.received());
        heard.len() == 3
    });
    assert!(heard.contains(&Command::EmergencyStop) && !heard.contains(&Command::Start));
    // Those who say nothing are sent away, and there is room again.
    wait_for("room", || system.tcp().publish(&Command::Stand).is_ok());
    drop(crowd);
}

#[test]
fn one_flooding_client_is_held_back() {
    let system = System::start("ration");
    let mut flood = system.tcp();
    let mut other = system.tcp();
    let refused =
        (0..3000).filter(|_| flood.publish(&Command::Stop).is_err_and(|e| e.contains("more slowly"))).count();
    assert!(refused > 0, "nothing held it back");
    assert_eq!(other.publish(&Command::Stop), Ok(0), "another client has its own ration");
    for _ in 0..100 {
        assert_eq!(flood.publish(&Command::EmergencyStop), Ok(0), "an emergency stop is never rationed");
    }
}

#[test]
fn a_taken_port_and_an_absent_broker_are_named() {
    let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = taken.local_addr().unwrap().port();
    let error = broker::tcp::bind(port).unwrap_err();
    assert!(
        error.contains(&format!("127.0.0.1:{port}")) && error.contains("tcp_port in system.toml"),
        "{error}"
    );
    drop(taken);
    let error = TcpClient::connect(port).unwrap_err();
    assert!(
        error.contains(&format!("no broker on 127.0.0.1:{port}")) && error.contains("gangwerk run"),
        "{error}"
    );
    assert!(broker::tcp::bind(0).unwrap().local_addr().unwrap().ip().is_loopback());
}
