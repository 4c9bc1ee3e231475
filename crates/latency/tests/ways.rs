//! Each way brings what was sent to the other end, in order, and says when there is nobody.

use std::path::{Path, PathBuf};

use latency::{LinkEnd, Opened, raw, system, topics};

type Open = fn(&Path, LinkEnd) -> Opened;

const WAYS: [(&str, Open); 8] = [
    ("topic", |dir, end| topics::open(dir, end, false)),
    ("topic and bell", |dir, end| topics::open(dir, end, true)),
    ("blackboard", raw::blackboard),
    ("publish-subscribe", |dir, end| raw::samples(dir, end, false)),
    ("publish-subscribe and event", |dir, end| raw::samples(dir, end, true)),
    ("POSIX queue", system::posix_queue),
    ("Unix datagram", system::unix_socket),
    ("TCP", system::tcp),
];

/// A directory with a short name: paths of sockets have 107 bytes.
fn place(number: usize) -> PathBuf {
    use std::os::unix::fs::DirBuilderExt;
    let dir = std::env::temp_dir().join(format!("gw-ways-{}-{number}", std::process::id()));
    std::fs::DirBuilder::new().mode(0o700).create(&dir).unwrap();
    dir
}

/// One after the other: iceoryx2 sets the umask of the whole process while it makes its files.
#[test]
fn every_way_brings_what_was_sent_and_tells_who_is_alone() {
    what_is_sent_arrives_once_and_in_order();
    an_end_that_is_alone_is_told_so();
}

fn what_is_sent_arrives_once_and_in_order() {
    for (number, (name, open)) in WAYS.into_iter().enumerate() {
        let dir = place(number);
        let mut near = open(&dir, LinkEnd::Near).unwrap_or_else(|e| panic!("{name}: {e}"));
        std::thread::scope(|scope| {
            let far = || {
                let mut far = open(&dir, LinkEnd::Far).unwrap_or_else(|e| panic!("{name}: {e}"));
                far.send(1).unwrap();
                for expected in 2..200 {
                    assert_eq!(far.receive(), Ok(expected), "{name}");
                    far.send(expected + 1000).unwrap();
                }
            };
            let far = scope.spawn(far);
            assert_eq!(near.receive(), Ok(1), "{name}: the first word is the other end's");
            for stamp in 2..200 {
                near.send(stamp).unwrap();
                assert_eq!(near.receive(), Ok(stamp + 1000), "{name}");
            }
            far.join().unwrap();
        });
        drop(near);
        raw::clear(&dir);
        let _ = std::fs::remove_dir_all(dir); // a space removes its own
    }
}

fn an_end_that_is_alone_is_told_so() {
    for (number, (name, open)) in WAYS.into_iter().enumerate().filter(|(_, (name, _))| *name != "TCP") {
        let dir = place(WAYS.len() + number);
        let mut near = open(&dir, LinkEnd::Near).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(near.receive().is_err(), "{name}: nobody is there");
        drop(near);
        raw::clear(&dir);
        let _ = std::fs::remove_dir_all(dir); // a space removes its own
    }
}
