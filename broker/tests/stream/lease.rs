//! Who gets the command lease on request, and when.

use std::io::Write;

use broker::message::{service, service_message};
use broker::{StreamClient, keys};
use realtime::clock::{SECOND, now};

use super::crowd::greet;
use super::harness::{System, wait_for};
use super::{answer, command, frame, socket, velocity, with_planner, write_keys};

/// A camera's key took the lease from the operator. He could not even command a velocity of zero, and she walked on after he had
/// closed his connection, for as long as the camera said that it was there.
#[test]
fn a_key_that_moves_nothing_does_not_take_the_lease_from_the_operator() {
    let mut system = System::without_broker("camera");
    let path = system.dir().join("keys");
    write_keys(&path, 0o600);
    let lines = [("cam", "vision"), ("log", "log"), ("both", "log,vision")]
        .map(|(name, domains)| format!("{name} {domains} {}\n", "cd".repeat(32)));
    std::fs::write(&path, lines.concat()).unwrap();
    system.start_broker();
    let _planner = system.spawn("planner");
    wait_for("the planner", || system.line_about("planner").is_some());
    let mut operator = system.stream();
    assert!(operator.publish(&velocity(0.3)).is_ok());
    for key in keys::load(&path).unwrap() {
        let mut camera = StreamClient::connect_tcp(system.tcp(), "camera", Some(&key)).unwrap();
        for over in [false, true] {
            let refused = camera.take_lease(over).unwrap_err();
            assert!(refused.contains("may not hold the command lease"), "{}: {refused}", key.name);
        }
        assert_eq!(operator.publish(&velocity(0.0)), Ok("planner".into()), "{}", key.name);
    }
}

/// It was accepted and over at once: nobody held the lease, and the other operator's walk ended.
#[test]
fn a_request_of_another_time_does_not_take_the_lease_from_anybody() {
    let (system, _planner) = with_planner("old-lease");
    let mut operator = system.stream();
    assert!(operator.publish(&velocity(0.3)).is_ok());
    let mut other = greet(socket(&system));
    let times = [(0, 20), (now() - 2 * SECOND, 20), (now() - SECOND / 9, 20), (u64::MAX, 21)];
    for ((sent_ns, code), sequence) in times.into_iter().zip(2..) {
        other.write_all(&frame(&service_message(service::TAKE_LEASE, sequence, sent_ns, &[1]))).unwrap();
        assert_eq!(answer(&mut other, sequence), code, "sent at {sent_ns}");
        assert_eq!(operator.publish(&velocity(0.1)), Ok("planner".into()), "sent at {sent_ns}");
    }
}

/// The velocity was decided first, and refused: somebody else held the lease.
#[test]
fn a_lease_taken_over_in_one_write_with_a_velocity_comes_before_it() {
    let (system, _planner) = with_planner("one-write");
    let mut holder = system.stream();
    for _ in 0..20 {
        holder.take_lease(true).unwrap();
        let mut other = greet(socket(&system));
        let take = frame(&service_message(service::TAKE_LEASE, 2, now(), &[1]));
        other.write_all(&[take, command(&velocity(0.1), 3, now())].concat()).unwrap();
        let codes = [2, 3].map(|sequence| answer(&mut other, sequence));
        // 20: the machine stood still, and they became too old.
        assert!(codes == [0, 0] || codes.contains(&20), "{codes:?}");
    }
}
