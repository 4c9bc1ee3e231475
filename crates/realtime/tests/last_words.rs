//! A process that dies by its own fault says how and where. Each cause happens in a child: this very program.

use realtime::black_box::{BlackBox, Left};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const CAUSE: &str = "GANGWERK_TEST_CAUSE";
const PLACE: &str = "GANGWERK_TEST_BOX";

/// The child. Not a test of its own: without a cause it does nothing.
#[test]
fn child() {
    let (Ok(cause), Ok(place)) = (std::env::var(CAUSE), std::env::var(PLACE)) else { return };
    let kept: &'static mut BlackBox = Box::leak(Box::new(BlackBox::create(Path::new(&place), 4096).unwrap()));
    if cause == "thread" {
        realtime::last_words::abort_at_panic();
    }
    kept.last_words().listen();
    kept.begin(7);
    kept.keep(3, 42, &[1u64, 2, 3]);
    match cause.as_str() {
        "panic" => panic!("knee joint {} is a number too many", 26),
        "thread" => drop(std::thread::spawn(|| panic!("knee joint 27 is two too many")).join()),
        "abort" => std::process::abort(),
        "fault" => fault(),
        "overflow" => {
            std::hint::black_box(overflow(std::hint::black_box(1)));
        }
        _ => std::process::exit(0),
    }
}

#[inline(never)]
fn fault() {
    // SAFETY: there is none: address 16 is nobody's, and this child is to die of it.
    unsafe { std::ptr::write_volatile(std::hint::black_box(16) as *mut u8, 1) };
}

#[inline(never)]
#[allow(unconditional_recursion)]
fn overflow(depth: u64) -> u64 {
    let room = std::hint::black_box([depth; 64]);
    overflow(depth + 1) + room[depth as usize % 64]
}

fn die_of(cause: &str) -> (Left, Option<i32>) {
    let place: PathBuf = std::env::temp_dir().join(format!("gangwerk-words-{cause}-{}", std::process::id()));
    let status = Command::new(std::env::current_exe().unwrap())
        .args(["child", "--exact", "--nocapture", "--test-threads=1"])
        .env(CAUSE, cause)
        .env(PLACE, &place)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .unwrap();
    let left = Left::read(&place).unwrap();
    std::fs::remove_file(place).unwrap();
    assert_eq!((left.cycles, left.begun_ns, left.entries.len()), (1, 7, 1));
    assert_eq!((left.entries[0].kind, left.entries[0].tick), (3, 42));
    (left, status.signal())
}

#[test]
fn a_panic_leaves_its_message() {
    let (left, _) = die_of("panic");
    assert!(left.message.contains("knee joint 26 is a number too many"), "{left:?}");
    assert!(left.frames.len() > 3, "{left:?}");
}

/// As the executable does it (decision 1): a panic of a thread beside the main one, which would join it and go on.
#[test]
fn a_panic_of_any_thread_ends_the_process() {
    let (left, signal) = die_of("thread");
    assert_eq!(signal, Some(6));
    assert!(left.message.contains("knee joint 27 is two too many"), "{left:?}");
}

#[test]
fn an_abort_leaves_signal_and_stack() {
    let (left, signal) = die_of("abort");
    assert_eq!((left.signal, signal), (6, Some(6)));
    assert!(left.frames.len() > 3, "{left:?}");
}

#[test]
fn a_fault_leaves_its_address_and_still_kills() {
    let (left, signal) = die_of("fault");
    assert_eq!((left.signal, left.address, signal), (11, 16, Some(11)));
    assert!(left.frames.len() > 3, "{left:?}");
}

/// The stack that ran out is not the one that the handler stands on.
#[test]
fn a_stack_that_ran_out_is_seen_too() {
    let (left, signal) = die_of("overflow");
    assert_eq!((left.signal, signal), (11, Some(11)));
    assert_eq!(left.frames.len(), 64, "{left:?}");
}

#[test]
fn an_exit_leaves_no_words() {
    let (left, signal) = die_of("nothing");
    assert_eq!((left.signal, left.message.as_str(), left.frames.len(), signal), (0, "", 0, None));
}
