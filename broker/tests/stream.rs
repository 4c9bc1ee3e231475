//! A real broker process and hostile, slow, many and ordinary clients on streams.

#[path = "stream/crowd.rs"]
mod crowd;
mod harness;
#[path = "stream/lease.rs"]
mod lease;

use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::net::UnixStream;
use std::time::Duration;

use broker::doors::{RESERVE, SOCKET, SOCKET_PLACES, TCP_PLACES};
use broker::keys::{self, Key};
use broker::message::{MAX_BYTES, Message, VERSION, schema, service, service_message, write_command};
use broker::stream_client::News;
use broker::{Client, StreamClient};
use harness::{Receive, System, pause, play_role, wait_for};
use messages::command::{Domain, Priority, PushCommand, VelocityCommand};
use messages::command_text::COMMANDS;
use messages::topics::EVENTS_BROKER;
use messages::{Command, CommandSource, Event, EventCode, Reason, Stamp};
use realtime::clock::now;

const SECONDS: Duration = Duration::from_secs(10);
const MOMENT: Duration = Duration::from_millis(20);
const KEYS: &str =
    "# test\nconsole walk,head 000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f\n";

#[test]
fn process() {
    // A planner that carries out what it is told, but refuses to walk faster than 1 m/s.
    play_role(|role, space| {
        let mut planner = Client::start(role, &[Domain::Walk], space).expect("client");
        loop {
            while let Some(live) = planner.next() {
                let verdict = match live.command {
                    Command::Velocity(v) if v.forward > 1.0 => {
                        Err(Reason::Limit { field: 0, low: -0.5, high: 1.0 })
                    }
                    _ => Ok(()),
                };
                planner.answer(&live, verdict);
            }
            pause(1);
        }
    });
}

fn velocity(forward: f64) -> Command {
    Command::Velocity(VelocityCommand { forward, left: 0.0, turn: -0.1 })
}

fn frame(message: &[u8]) -> Vec<u8> {
    [&(message.len() as u32).to_le_bytes(), message].concat()
}

fn command(command: &Command, sequence: u64, sent_ns: u64) -> Vec<u8> {
    let stamp = Stamp { sequence, sent_ns, ..Stamp::default() };
    frame(write_command(command, command.priority(), &stamp, &mut [0; MAX_BYTES]).unwrap())
}

fn hello(version: u16, schema: u64) -> Vec<u8> {
    let payload = [&version.to_le_bytes()[..], &schema.to_le_bytes(), &[0; 16], b"test"].concat();
    frame(&service_message(service::HELLO, 1, now(), &payload))
}

/// The next message on a stream.
fn message(stream: &mut impl Read) -> Vec<u8> {
    let mut length = [0; 4];
    stream.read_exact(&mut length).unwrap();
    let mut message = vec![0; u32::from_le_bytes(length) as usize];
    stream.read_exact(&mut message).unwrap();
    message
}

/// Code of the answer to the frame `sequence`, 0 if it is accepted; news before it are passed over.
fn answer(stream: &mut impl Read, sequence: u64) -> u8 {
    loop {
        let bytes = message(stream);
        let message = Message::parse(&bytes).unwrap();
        match message.id {
            service::ACCEPTED if message.stamp.sequence == sequence => return 0,
            service::LEASE | service::LINE => {}
            _ => {
                assert_eq!(message.stamp.sequence, sequence, "{message:?}");
                return message.payload[0];
            }
        }
    }
}

fn socket(system: &System) -> UnixStream {
    let stream = UnixStream::connect(system.dir().join(SOCKET)).unwrap();
    stream.set_read_timeout(Some(SECONDS)).unwrap();
    stream
}

/// Sends bytes and returns the text of all that comes back until the broker closes the connection.
fn answer_to(system: &System, bytes: &[u8]) -> String {
    let mut stream = socket(system);
    stream.write_all(bytes).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("the broker closes the connection in order");
    String::from_utf8_lossy(&answer).into_owned()
}

/// A system with a planner that answers by itself.
fn with_planner(name: &str) -> (System, harness::Killed) {
    let system = System::start(name);
    let planner = system.spawn("planner");
    wait_for("the planner", || system.line_about("planner").is_some());
    (system, planner)
}

fn key() -> Key {
    let path = std::env::temp_dir().join(format!(
        "gangwerk-key-{}-{:?}",
        std::process::id(),
        std::thread::current().id()
    ));
    write_keys(&path, 0o600);
    let key = keys::load(&path).unwrap().remove(0);
    std::fs::remove_file(path).unwrap();
    key
}

fn write_keys(path: &std::path::Path, mode: u32) {
    use std::os::unix::fs::PermissionsExt;
    std::fs::write(path, KEYS).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
}

#[test]
fn every_command_is_answered_by_the_process_that_decides() {
    let (system, _planner) = with_planner("answers");
    let mut operator = system.stream();
    assert_eq!(operator.publish(&velocity(0.5)), Ok("planner".into()));
    let refused = operator.publish(&velocity(1.5)).unwrap_err();
    assert_eq!(refused, "walk/velocity refused by planner: forward = 1.5 m/s: at most 1");
    assert_eq!(operator.publish(&Command::Stop), Ok("planner".into()));
    let nobody = operator.publish(&Command::Reset).unwrap_err();
    assert_eq!(nobody, "watchdog decides about this and is not there");
    // As many as one connection may have on their way, and more: each has its own answer.
    let sent: Vec<u64> = (0..500).map(|_| operator.send(&velocity(0.1)).unwrap()).collect();
    for sequence in sent {
        let answer = operator.answer(sequence).unwrap();
        assert!(answer.code == 0 || answer.text.contains("ms old"), "{answer:?}");
    }
}

#[test]
fn a_command_arrives_unchanged() {
    let system = System::start("arrives");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut screen = system.stream();
    screen.subscribe(&[Domain::Walk, Domain::System]).unwrap();
    let mut operator = system.stream();
    operator.send(&velocity(0.1 + 0.2)).unwrap();
    operator.send_as(&Command::Stop, Priority::Low).unwrap();
    let mut heard = Vec::new();
    wait_for("the commands", || {
        heard.extend(planner.received());
        heard.len() == 2
    });
    assert_eq!(heard, [velocity(0.1 + 0.2), Command::Stop]);
    let mut seen = || screen.receive(SECONDS).unwrap();
    assert_eq!([seen(), seen()], [Some(velocity(0.1 + 0.2)), Some(Command::Stop)]);
    assert_eq!(screen.receive(MOMENT), Ok(None));
}

#[test]
fn bad_numbers_are_refused_with_a_reason() {
    let (system, _planner) = with_planner("numbers");
    let mut operator = system.stream();
    for (bad, word) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (3.0, "3"), (-1e308, "-1")] {
        let error = operator.publish(&velocity(bad)).unwrap_err();
        assert!(error.contains("walk/velocity: forward = ") && error.contains(word), "{error}");
        assert!(error.contains("[-2, 2] m/s"), "{error}");
    }
    let sequence = operator.send_as(&Command::Start, Priority::High).unwrap();
    let error = operator.answer(sequence).unwrap().text;
    assert!(error.contains("walk/start cannot be sent with priority High"), "{error}");
    // The connection lives on.
    assert_eq!(operator.publish(&velocity(1.0)), Ok("planner".into()));
    assert!(system.line_about("broker").unwrap().contains("refused 5;"));
    let mut events = system.space.reader::<Event>(&EVENTS_BROKER).unwrap();
    let mut refused = 0;
    while let Some(event) = events.follow() {
        refused += usize::from(event.code == EventCode::CommandRefused as u64);
    }
    assert_eq!(refused, 5);
}

/// Two operators: one moves the robot, the other may stop it, or take over by saying so.
#[test]
fn one_client_at_a_time_holds_the_lease() {
    let (system, _planner) = with_planner("lease");
    let (mut first, mut second) = (system.stream(), system.stream());
    assert!(first.publish(&velocity(0.3)).is_ok());
    let refused = second.publish(&velocity(0.2)).unwrap_err();
    assert!(refused.contains("test (user") && refused.contains("holds the command lease"), "{refused}");
    assert!(second.take_lease(false).unwrap_err().contains("holds the command lease"));
    assert!(second.publish(&Command::Stop).is_ok(), "anybody may stop");
    second.take_lease(true).unwrap();
    assert!(second.publish(&velocity(0.2)).is_ok());
    assert!(first.publish(&velocity(0.3)).is_err());
    let mut told = Vec::new();
    while let Some(news) = first.news(MOMENT).unwrap() {
        told.extend(if let News::Lease(grant, _) = news { Some(grant) } else { None });
    }
    assert!(
        told.len() >= 2 && told.windows(2).all(|g| g[0] == g[1]),
        "a take-over keeps the number: {told:?}"
    );
    drop(second);
    wait_for("the lease", || first.publish(&velocity(0.1)).is_ok());
}

#[test]
fn replayed_and_reordered_frames_move_nothing() {
    let system = System::start("replay");
    let mut planner = system.client("planner", &[Domain::Walk]);
    let mut stream = socket(&system);
    let (fast, slow) = (command(&velocity(0.9), 3, now()), command(&velocity(0.1), 2, now()));
    stream.write_all(&[hello(VERSION, schema()), fast.clone(), fast, slow].concat()).unwrap();
    let mut heard = Vec::new();
    wait_for("the first", || {
        heard.extend(planner.received());
        !heard.is_empty()
    });
    let mut text = String::new();
    wait_for("two refusals", || {
        let mut chunk = [0; 4096];
        let n = stream.read(&mut chunk).unwrap();
        text += &String::from_utf8_lossy(&chunk[..n]);
        text.matches("replayed, or out of order").count() == 2
    });
    heard.extend(planner.received());
    assert_eq!(heard, [velocity(0.9)]);
}

#[test]
fn garbage_closes_its_own_connection_only() {
    let (system, _planner) = with_planner("garbage");
    let mut bystander = system.stream();
    let mut service_99 = service_message(99, 2, now(), &[]);
    let mut bad_class = service_99.clone();
    bad_class[4] = 9;
    let mut bad_domain = service_99.clone();
    bad_domain[..2].copy_from_slice(&[77, 0]);
    let mut not_zero = service_99.clone();
    not_zero[5] = 1;
    service_99 = [hello(VERSION, schema()), frame(&service_99)].concat();
    let bad: [(Vec<u8>, &str); 8] = [
        (
            b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n".to_vec(),
            "length 542393671, a frame has 32 to 512 bytes",
        ),
        (vec![0xff; 4], "length 4294967295"),
        (vec![0; 64], "length 0"),
        (frame(&bad_class), "priority 9"),
        (frame(&bad_domain), "domain 77"),
        (frame(&not_zero), "bytes 5 to 7"),
        (frame(&service_message(service::STATISTICS, 0, 0, &[])), "sequence 0"),
        (service_99, "service 99"),
    ];
    for (bytes, reason) in bad {
        let answer = answer_to(&system, &bytes);
        assert!(answer.contains(reason) && answer.contains("not a frame"), "{answer:?}");
    }
    let much: Vec<u8> = (0..1_000_000u32).flat_map(|n| n.wrapping_mul(0x9e37_79b9).to_le_bytes()).collect();
    let _ = socket(&system).write_all(&much);
    assert_eq!(bystander.publish(&velocity(0.5)), Ok("planner".into()));
}

/// A frame that is one, with a payload that is none: refused, and the connection goes on.
#[test]
fn a_payload_that_is_no_command_is_refused() {
    let system = System::start("payload");
    let mut stream = socket(&system);
    stream.write_all(&hello(VERSION, schema())).unwrap();
    let next = |stream: &mut UnixStream| String::from_utf8_lossy(&message(stream)[32..]).into_owned();
    next(&mut stream);
    let whole = command(&velocity(0.1), 2, now());
    for n in 0..28 {
        // walk/velocity, cut at every byte of its payload.
        let mut message = whole[4..36 + n].to_vec();
        message[16] = 2 + n as u8;
        stream.write_all(&frame(&message)).unwrap();
        let text = next(&mut stream);
        assert!(text.contains("not a command"), "{n}: {text}");
    }
}

#[test]
fn who_stops_writing_still_gets_the_answers() {
    let (system, _planner) = with_planner("shut");
    let mut stream = socket(&system);
    let stops = (1..4).map(|n| command(&Command::Stop, n, now())).collect::<Vec<_>>().concat();
    stream.write_all(&stops).unwrap();
    stream.shutdown(std::net::Shutdown::Write).unwrap();
    let mut answers = Vec::new();
    stream.read_to_end(&mut answers).unwrap();
    assert_eq!(String::from_utf8_lossy(&answers).matches("planner").count(), 3);
}

#[test]
fn another_version_or_table_of_commands_is_refused_with_both() {
    let system = System::start("version");
    for (version, table) in [(VERSION + 1, schema()), (VERSION, schema() + 1)] {
        let answer = answer_to(&system, &hello(version, table));
        assert!(answer.contains(&format!("version {version} with schema {table:016x}")), "{answer}");
        assert!(
            answer.contains(&format!("this broker version {VERSION} with schema {:016x}", schema())),
            "{answer}"
        );
    }
}

#[test]
fn silence_ends_the_connection() {
    let system = System::start("half");
    let answer = answer_to(&system, &[40, 0, 0, 0, 1, 0]);
    assert!(answer.contains("the rest of a frame did not come in time"), "{answer:?}");
    let answer = answer_to(&system, &[]);
    assert!(answer.contains("a frame did not come in time"), "{answer:?}");
}

/// Every command there is, from everybody who may not give it: nothing moves.
#[test]
fn strangers_can_stop_the_robot_and_nothing_else() {
    let system = System::without_broker("strangers");
    write_keys(&system.dir().join("keys"), 0o600);
    let mut system = system;
    system.start_broker();
    let mut everybody = system.client("planner", &Domain::ALL);
    let address = system.tcp();
    for info in COMMANDS {
        let mut stranger = StreamClient::connect_tcp(address, "stranger", None).unwrap();
        let sequence = stranger.send(&info.example()).unwrap();
        if matches!(info.name, "walk/stop" | "system/emergency_stop") {
            let mut heard = Vec::new();
            wait_for("the stop", || {
                heard.extend(everybody.received());
                !heard.is_empty()
            });
            assert_eq!(heard, [info.example()]);
        } else {
            let answer = stranger.answer(sequence).unwrap();
            // What is out of range is refused even before anybody asks who sent it.
            assert!([5, 8].contains(&answer.code), "{}: {answer:?}", info.name);
        }
        // Without a word of greeting, and with numbers in range.
        let mut raw = TcpStream::connect(address).unwrap();
        let _ = raw.write_all(&command(&velocity(0.4), 1, now()));
        assert!(stranger.take_lease(true).unwrap_err().contains("may not hold the command lease"));
    }
    pause(50);
    assert_eq!(everybody.received().count(), 0);
    assert!(StreamClient::connect_tcp(address, "reader", None).unwrap().statistics().is_ok());
}

#[test]
fn a_key_opens_its_domains_and_a_wrong_one_nothing() {
    let mut system = System::without_broker("keys");
    write_keys(&system.dir().join("keys"), 0o600);
    system.start_broker();
    let mut planner = system.client("planner", &[Domain::Walk, Domain::System]);
    let right = key();
    let mut console = StreamClient::connect_tcp(system.tcp(), "console", Some(&right)).unwrap();
    let walk = console.send(&velocity(0.2)).unwrap();
    let mut heard = Vec::new();
    wait_for("the command", || {
        heard.extend(planner.received());
        !heard.is_empty()
    });
    assert_eq!(heard, [velocity(0.2)]);
    assert_eq!(console.answer(walk).unwrap().accepted(), Ok("planner".into()));
    let other = console.publish(&Command::Enable).unwrap_err();
    assert!(other.contains("may not command `system`"), "{other}");
    drop(console);
    // Another secret under the same name; another name.
    let path = system.dir().join("other");
    std::fs::write(&path, KEYS.replace("0001", "ff01")).unwrap();
    std::fs::set_permissions(&path, std::os::unix::fs::PermissionsExt::from_mode(0o600)).unwrap();
    let wrong = keys::load(&path).unwrap().remove(0);
    let mut nobody = right;
    nobody.name = "nobody".into();
    for key in [wrong, nobody] {
        let error = StreamClient::connect_tcp(system.tcp(), "console", Some(&key)).err().unwrap();
        assert!(error.contains("not known, or the frame is not authentic"), "{error}");
    }
    pause(20);
    assert_eq!(planner.received().count(), 0);
}

#[test]
fn a_key_file_that_others_can_read_is_refused() {
    let path = std::env::temp_dir().join(format!("gangwerk-open-key-{}", std::process::id()));
    write_keys(&path, 0o640);
    let error = keys::load(&path).unwrap_err();
    std::fs::remove_file(path).unwrap();
    assert!(error.contains("mode 0640, must be 0600"), "{error}");
}

#[test]
fn too_many_connections_leave_room_for_an_emergency_stop() {
    let system = System::start("many");
    let mut watchdog = system.client("watchdog", &[Domain::System]);
    let mut first = system.stream();
    let crowd: Vec<_> = (0..SOCKET_PLACES.total + 2 * RESERVE).map(|_| socket(&system)).collect();
    let refused = StreamClient::connect(system.dir(), "late").unwrap().statistics().unwrap_err();
    assert!(refused.contains("too many connections"), "{refused}");
    let mut late = socket(&system);
    late.write_all(&command(&Command::EmergencyStop, 1, now())).unwrap();
    wait_for("the emergency stop", || watchdog.received().any(|c| c == Command::EmergencyStop));
    // Earlier clients are served on.
    assert!(first.statistics().is_ok());
    // Those who say nothing are sent away, and there is room again.
    wait_for("room", || {
        StreamClient::connect(system.dir(), "late").is_ok_and(|mut late| late.statistics().is_ok())
    });
    drop(crowd);
}

/// 32 idle connections of somebody else locked the operator out: now each door has its own places, and each peer a share.
#[test]
fn strangers_on_tcp_do_not_lock_the_operator_out() {
    let system = System::start("idle");
    let mut crowd = Vec::new();
    for _ in 0..2 * TCP_PLACES.total {
        crowd.push(TcpStream::connect(system.tcp()).unwrap());
    }
    assert!(system.stream().statistics().is_ok());
}

#[test]
fn one_flooding_client_is_held_back() {
    let (system, _planner) = with_planner("ration");
    let mut flood = system.stream();
    let mut refused = 0;
    for _ in 0..100 {
        let sent: Vec<u64> = (0..60).map(|_| flood.send(&velocity(0.1)).unwrap()).collect();
        let answers: Vec<_> = sent.into_iter().map(|n| flood.answer(n).unwrap()).collect();
        refused += answers.iter().filter(|a| a.text.contains("send more slowly")).count();
    }
    // How many are held back is a matter of the machine's speed; nobody waits for ever, and everything is answered.
    assert!(refused < 6000);
    assert_eq!(system.stream().publish(&Command::Stop), Ok("planner".into()));
    let push = Command::Push(PushCommand { force: [0.0; 3], duration: 0.1 });
    assert!(system.stream().publish(&push).unwrap_err().contains("sim-backend"), "a push needs no lease");
}

#[test]
fn a_taken_port_and_an_absent_broker_are_named() {
    let system = System::start("taken");
    let address = system.tcp();
    let error = broker::doors::bind_tcp(address, &[]).unwrap_err();
    assert!(error.contains(&address.to_string()) && error.contains("tcp_listen in system.toml"), "{error}");
    let error = StreamClient::connect(std::path::Path::new("/nowhere"), "x").err().unwrap();
    assert!(error.contains("no broker at /nowhere/broker.sock") && error.contains("gangwerk run"), "{error}");
}
