//! Too many connections and too many frames: whoever stops the robot is heard, and who has a key gets in.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};

use broker::StreamClient;
use broker::doors::{RESERVE, SOCKET_PLACES, TCP_PLACES};
use broker::message::{Message, VERSION, domain_mask, schema, service, service_message};
use messages::Command;
use messages::command::Domain;
use realtime::clock::now;

use super::harness::{Killed, System, wait_for};
use super::{
    SECONDS, answer, command, frame, hello, key, message, socket, velocity, with_planner, write_keys,
};

/// A client that says HELLO, and nothing more; the broker knows it.
pub(super) fn greet<S: Read + Write>(mut stream: S) -> S {
    stream.write_all(&hello(VERSION, schema())).unwrap();
    assert_eq!(Message::parse(&message(&mut stream)).unwrap().id, service::WELCOME);
    stream
}

/// A connection from an address of this machine; to the broker each of them is somebody else.
fn from(address: [u8; 4], to: SocketAddr) -> TcpStream {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build().unwrap();
    let stream = runtime.block_on(async {
        let socket = tokio::net::TcpSocket::new_v4().unwrap();
        socket.bind((Ipv4Addr::from(address), 0).into()).unwrap();
        socket.connect(to).await.unwrap().into_std().unwrap()
    });
    stream.set_nonblocking(false).unwrap();
    stream.set_read_timeout(Some(SECONDS)).unwrap();
    stream
}

/// A system with a key for TCP, and a planner that answers by itself.
fn with_key(name: &str) -> (System, Killed) {
    let mut system = System::without_broker(name);
    write_keys(&system.dir().join("keys"), 0o600);
    system.start_broker();
    let planner = system.spawn("planner");
    wait_for("the planner", || system.line_about("planner").is_some());
    (system, planner)
}

/// 40 of 40 stops of a client that sent too many velocities were refused.
#[test]
fn whoever_sends_too_much_still_stops_the_robot() {
    let (system, _planner) = with_planner("busy");
    let stranger = StreamClient::connect_tcp(system.tcp(), "stranger", None).unwrap();
    for mut client in [system.stream(), stranger] {
        // As long as it takes until enough of its rounds are beyond its ration.
        let mut crowded = 0;
        for _ in 0..1000 {
            let sent: Vec<u64> = (0..59).map(|_| client.send(&velocity(0.1)).unwrap()).collect();
            let stop = client.send(&Command::Stop).unwrap();
            let busy = sent.into_iter().filter(|n| client.answer(*n).unwrap().code == 6).count();
            assert_eq!(client.answer(stop).unwrap().accepted(), Ok("planner".into()));
            crowded += usize::from(busy > 0);
            if crowded == 20 {
                break;
            }
        }
        assert!(crowded > 0, "nothing was beyond the ration");
    }
}

/// With 64 connections of one user, `gangwerk topic pub walk/stop` was told that there are too many: for its HELLO.
#[test]
fn beyond_the_places_clients_stop_the_robot_in_their_ordinary_way() {
    let (system, _planner) = with_planner("full");
    let mut watchdog = system.client("watchdog", &[Domain::System]);
    // Two more, for those connections of this test that are just being closed.
    let _crowd: Vec<_> = (0..SOCKET_PLACES.each + 2).map(|_| greet(socket(&system))).collect();
    for _ in 0..2 * RESERVE {
        let mut late = StreamClient::connect(system.dir(), "late").unwrap();
        late.subscribe(&[Domain::Walk, Domain::System]).unwrap();
        late.ping().unwrap();
        assert_eq!(late.publish(&Command::Stop), Ok("planner".into()));
        let off = late.send(&Command::EmergencyStop).unwrap();
        wait_for("the emergency stop", || watchdog.received().any(|c| c == Command::EmergencyStop));
        assert_eq!(late.answer(off).unwrap().accepted(), Ok("watchdog".into()));
    }
    // The Python client learns the commands first.
    let mut python = greet(socket(&system));
    python.write_all(&frame(&service_message(service::DESCRIBE, 2, now(), &[]))).unwrap();
    assert_eq!(answer(&mut python, 2), 0);
    python.write_all(&command(&Command::Stop, 3, now())).unwrap();
    assert_eq!(answer(&mut python, 3), 0);
    // More than a stop is not for them.
    let late = || StreamClient::connect(system.dir(), "late").unwrap();
    for refused in [
        late().publish(&velocity(0.1)).map(drop),
        late().publish(&Command::End).map(drop),
        late().take_lease(true),
        late().statistics().map(drop),
        late().watch(0, false).map(drop),
    ] {
        let refused = refused.unwrap_err();
        assert!(refused.contains("too many connections"), "{refused}");
    }
}

/// 16 connections without a key locked the operator with a key out of the same address, and two addresses everybody.
#[test]
fn a_crowd_without_a_key_does_not_keep_a_key_out() {
    let (system, _planner) = with_key("crowd");
    let console = || StreamClient::connect_tcp(system.tcp(), "console", Some(&key())).unwrap();
    let crowd =
        |address| -> Vec<_> { (0..TCP_PLACES.each).map(|_| greet(from(address, system.tcp()))).collect() };
    let mut held = vec![crowd([127, 0, 0, 1])];
    let mut first = console();
    assert_eq!(first.publish(&velocity(0.2)), Ok("planner".into()));
    held.extend([crowd([127, 0, 0, 2]), crowd([127, 0, 0, 3])]);
    let mut second = console();
    assert_eq!(second.publish(&Command::Stop), Ok("planner".into()));
    // However many come, who has proved a key stays.
    held.extend([[127, 0, 0, 1], [127, 0, 0, 2], [127, 0, 0, 4], [127, 0, 0, 5]].map(crowd));
    assert!(first.publish(&velocity(0.1)).is_ok() && second.publish(&Command::Stop).is_ok());
    // Where all places are taken by keys, one more stops the robot and does nothing else.
    let _keys: Vec<_> = (2..TCP_PLACES.each).map(|_| console()).collect();
    let mut late = console();
    assert_eq!(late.publish(&Command::Stop), Ok("planner".into()));
    assert!(late.publish(&velocity(0.1)).unwrap_err().contains("too many connections"));
}

/// Domains of a WELCOME, and whether a proof is awaited.
fn welcome(mut stream: impl Read + Write, names: &[u8]) -> (u32, u8) {
    let payload = [&VERSION.to_le_bytes()[..], &[0; 8], &[0; 16], names].concat();
    stream.write_all(&frame(&service_message(service::HELLO, 1, now(), &payload))).unwrap();
    let welcome = message(&mut stream);
    let payload = Message::parse(&welcome).unwrap().payload;
    (u32::from_le_bytes(payload[30..34].try_into().unwrap()), payload[34])
}

/// It said 0 to everybody with a key.
#[test]
fn a_welcome_says_what_the_connection_may_command() {
    let (system, _planner) = with_key("welcome");
    let tcp = || from([127, 0, 0, 1], system.tcp());
    assert_eq!(welcome(socket(&system), b"x"), (domain_mask(&Domain::ALL), 0));
    assert_eq!(welcome(tcp(), b"x"), (0, 0));
    let may = domain_mask(&[Domain::Walk, Domain::Head]);
    assert_eq!(welcome(tcp(), b"x\0console"), (may, 1), "once it has proved the key");
}
