//! The request to end: SIGTERM, SIGINT, SIGHUP and the parent's death, taken by a thread of their own so that no control
//! cycle is interrupted.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Signal of the parent's death. The kernel sends it once for each thread of the parent that had the child in turn, so it is none
/// that somebody else sends, too.
const PARENT_DIED: libc::c_int = libc::SIGUSR1;

/// Asked to end? Cheap to copy, to be looked at once per cycle.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Blocks the signals, but SIGHUP if it is ignored, in this thread and every thread it starts from now on, and starts the
    /// thread that takes them. To be called first in `main`, while the process has one thread.
    pub fn on_signals() -> io::Result<Self> {
        let set = block()?;
        let stop = Self::default();
        let asked = stop.clone();
        std::thread::Builder::new().name("signals".into()).stack_size(64 << 10).spawn(move || {
            let mut first = true;
            loop {
                let mut signal = 0;
                // SAFETY: `set` is an initialised set and `signal` a writable integer, both of this thread.
                if unsafe { libc::sigwait(&set, &mut signal) } == 0 && (first || signal != PARENT_DIED) {
                    first = false;
                    asked.ask();
                }
            }
        })?;
        Ok(stop)
    }

    /// Whether the process shall end.
    pub fn asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Request to end since the last call, taken: the first one may be met gently, the second at once. The parent's death is no
    /// second one.
    pub fn taken(&self) -> bool {
        self.0.swap(false, Ordering::Relaxed)
    }

    /// Asks it to end.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
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
        let wanted = [libc::SIGTERM, libc::SIGINT, libc::SIGHUP, PARENT_DIED];
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
