//! The request to end: SIGTERM, SIGINT, SIGQUIT, SIGTSTP, SIGHUP and the parent's death, taken by a thread of their own so
//! that no control cycle is interrupted.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Signal of the parent's death. The kernel sends it once for each thread of the parent that had the child in turn, so it is none
/// that somebody else sends, too.
const PARENT_DIED: libc::c_int = libc::SIGUSR1;

/// Signals that follow each other within this time \[ns\] are one request: `timeout` sends its own to the child and then to the group,
/// kernel and shell tell in turn that a terminal was closed.
const ECHO: u64 = crate::clock::SECOND / 20;

/// Time of the last request \[ns\].
#[derive(Default)]
struct LastRequest(Option<u64>);

impl LastRequest {
    /// True of a signal that is another request.
    fn is_followed_by(&mut self, signal: libc::c_int, now: u64) -> bool {
        let another = self.0.is_none_or(|last| signal != PARENT_DIED && now > last + ECHO);
        self.0 = if another { Some(now) } else { self.0 };
        another
    }
}

/// Asked to end? Cheap to copy, to be looked at once per cycle.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicU32>);

impl Stop {
    /// Blocks the signals, but SIGHUP if it is ignored, in this thread and every thread it starts from now on, and starts the
    /// thread that takes them. To be called first in `main`, while the process has one thread.
    pub fn on_signals() -> io::Result<Self> {
        let set = block()?;
        let stop = Self::default();
        let asked = stop.clone();
        std::thread::Builder::new().name("signals".into()).stack_size(64 << 10).spawn(move || {
            let mut last = LastRequest::default();
            loop {
                let mut signal = 0;
                // SAFETY: `set` is an initialised set and `signal` a writable integer, both of this thread.
                let taken = unsafe { libc::sigwait(&set, &mut signal) } == 0;
                if taken && last.is_followed_by(signal, crate::clock::now()) {
                    asked.ask();
                }
            }
        })?;
        Ok(stop)
    }

    /// Whether the process shall end.
    pub fn asked(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 0
    }

    /// A request to end, taken: the first one may be met gently, the second at once. Two stay two, however late somebody looks. The
    /// parent's death is no second one.
    pub fn taken(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1)).is_ok()
    }

    /// Asks it to end.
    pub fn ask(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// From now on this process is asked to end when the thread that started it ends, killed or not.
    pub fn with_parent() -> io::Result<()> {
        // SAFETY: PR_SET_PDEATHSIG takes a signal number and touches no memory.
        match unsafe { libc::prctl(libc::PR_SET_PDEATHSIG, PARENT_DIED) } {
            0 => Ok(()),
            _ => Err(io::Error::last_os_error()),
        }
    }
}

/// A program that writes to a pipe nobody reads any more ends quietly, as `gangwerk topic list | head` should.
pub fn end_with_reader() {
    // SAFETY: SIGPIPE gets its default action back; no handler is involved.
    unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
}

/// A file that reaches the limit of its size (`ulimit -f`) is an error of who writes it, as a full disk is, for this process and
/// those that it starts; by default the kernel ends the process (SIGXFSZ).
pub fn ignore_sigxfsz() {
    // SAFETY: SIGXFSZ is ignored; no handler is involved.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

/// Asks another process to end (SIGTERM). A process that is gone has ended.
pub fn terminate(pid: u32) {
    // SAFETY: `kill` takes two numbers and touches no memory.
    unsafe { libc::kill(pid as libc::pid_t, libc::SIGTERM) };
}

fn block() -> io::Result<libc::sigset_t> {
    // Started by nohup it goes on without its terminal: SIGHUP stays ignored. One that is blocked would be taken all the same.
    let left_alone = is_ignored(libc::SIGHUP);
    // SAFETY: a signal set is plain bytes; `sigemptyset` then gives it its meaning.
    let mut set: libc::sigset_t = unsafe { std::mem::zeroed() };
    // SAFETY: `set` is a writable signal set and the numbers are signals of this platform; the old mask is not asked
    // for.
    let error = unsafe {
        libc::sigemptyset(&mut set);
        // Ctrl-\ and Ctrl-Z, too: a robot whose supervisor the terminal stopped would walk on without it.
        let wanted = [libc::SIGTERM, libc::SIGINT, libc::SIGQUIT, libc::SIGTSTP, libc::SIGHUP, PARENT_DIED];
        for signal in wanted.into_iter().filter(|signal| *signal != libc::SIGHUP || !left_alone) {
            libc::sigaddset(&mut set, signal);
        }
        libc::pthread_sigmask(libc::SIG_BLOCK, &set, std::ptr::null_mut())
    };
    if error == 0 { Ok(set) } else { Err(io::Error::from_raw_os_error(error)) }
}

fn is_ignored(signal: libc::c_int) -> bool {
    // SAFETY: an action is plain bytes, and the call only reads the present one into it.
    let action = unsafe {
        let mut action: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &mut action);
        action
    };
    action.sa_sigaction == libc::SIG_IGN
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A late look took two for one: the supervisor stopped the robot gently where its emergency stop was asked for.
    #[test]
    fn two_requests_stay_two_however_late_somebody_looks() {
        let stop = Stop::default();
        stop.ask();
        stop.ask();
        assert!(stop.asked());
        assert_eq!([stop.taken(), stop.taken(), stop.taken()], [true, true, false]);
        assert!(!stop.asked());
    }

    #[test]
    fn signals_of_one_request_are_one() {
        let mut last = LastRequest::default();
        let all =
            [(libc::SIGTERM, 0), (libc::SIGHUP, ECHO), (PARENT_DIED, 9 * ECHO), (libc::SIGTERM, 9 * ECHO)];
        assert_eq!(all.map(|(signal, now)| last.is_followed_by(signal, now)), [true, false, false, true]);
        let mut last = LastRequest::default();
        assert_eq!([0, ECHO + 1].map(|now| last.is_followed_by(libc::SIGINT, now)), [true, true]);
        assert!(LastRequest::default().is_followed_by(PARENT_DIED, 0));
    }
}
