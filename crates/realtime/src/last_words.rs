//! Last words of a dying process: signal, address, message of a panic, return addresses.
//!
//! The handler stores into memory that outlives the process, and calls nothing else but the unwinder (`backtrace` of the C
//! library, called once before so that it has loaded what it needs). It does not take the signal away: the process dies of
//! it as it would without.

use std::sync::atomic::{AtomicI64, AtomicPtr, AtomicU8, AtomicU64, Ordering::Relaxed, Ordering::Release};

/// Return addresses kept.
const FRAMES: usize = 64;
/// Room for the message of a panic \[B\].
const MESSAGE: usize = 512;
/// Stack of the handler \[B\]: the process's own may be what ran out.
const STACK: usize = 64 << 10;
/// Signals handled: those a program dies of by its own fault, and the one the supervisor sends to a hung process.
const SIGNALS: [i32; 5] = [libc::SIGSEGV, libc::SIGBUS, libc::SIGILL, libc::SIGFPE, libc::SIGABRT];

/// Last words, in memory that outlives the process.
#[repr(C)]
#[derive(Debug)]
pub struct LastWords {
    signal: AtomicU64,
    address: AtomicU64,
    count: AtomicU64,
    frames: [AtomicI64; FRAMES],
    length: AtomicU64,
    message: [AtomicU8; MESSAGE],
}

static WORDS: AtomicPtr<LastWords> = AtomicPtr::new(std::ptr::null_mut());

impl LastWords {
    /// Takes them down from now on, for signals and panics. Once per process, in its main thread.
    pub fn listen(&'static self) {
        WORDS.store(std::ptr::from_ref(self).cast_mut(), Release);
        // The first call loads the unwinder, which allocates.
        self.trace();
        self.count.store(0, Relaxed);
        let stack: &'static mut [u8] = vec![0; STACK].leak();
        let stack = libc::stack_t { ss_sp: stack.as_mut_ptr().cast(), ss_flags: 0, ss_size: STACK };
        // SAFETY: all-zero bytes are a valid `sigaction`: no flags, an empty mask.
        let mut action: libc::sigaction = unsafe { std::mem::zeroed() };
        action.sa_sigaction = on_signal as *const () as usize;
        action.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK | libc::SA_RESETHAND;
        // SAFETY: the stack is leaked and of the size it says; the handler has the type that SA_SIGINFO asks for.
        unsafe {
            libc::sigaltstack(&stack, std::ptr::null_mut());
            SIGNALS.iter().for_each(|&signal| _ = libc::sigaction(signal, &action, std::ptr::null_mut()));
        }
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            self.write(&info.to_string());
            self.trace();
            before(info);
        }));
    }

    fn write(&self, text: &str) {
        let bytes = &text.as_bytes()[..text.len().min(MESSAGE)];
        self.message.iter().zip(bytes).for_each(|(room, byte)| room.store(*byte, Relaxed));
        self.length.store(bytes.len() as u64, Release);
    }

    /// Stack of the calling thread, unless it is recorded already.
    fn trace(&self) {
        if self.count.load(Relaxed) > 0 {
            return;
        }
        let mut found = [std::ptr::null_mut(); FRAMES];
        // SAFETY: there is room for as many addresses as it is told.
        let count = unsafe { libc::backtrace(found.as_mut_ptr(), FRAMES as i32) };
        for (frame, at) in self.frames.iter().zip(found) {
            frame.store((at as usize).wrapping_sub(anchor()) as i64, Relaxed);
        }
        self.count.store(count.max(0) as u64, Release);
    }

    pub(crate) fn signal(&self) -> u64 {
        self.signal.load(Relaxed)
    }

    pub(crate) fn address(&self) -> u64 {
        self.address.load(Relaxed)
    }

    pub(crate) fn message(&self) -> String {
        let length = (self.length.load(Relaxed) as usize).min(MESSAGE);
        let bytes: Vec<u8> = self.message[..length].iter().map(|b| b.load(Relaxed)).collect();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    pub(crate) fn frames(&self) -> Vec<i64> {
        let count = (self.count.load(Relaxed) as usize).min(FRAMES);
        self.frames[..count].iter().map(|f| f.load(Relaxed)).collect()
    }
}

/// Abort of the whole process at a panic of any of its threads, after its message. Nothing is unwound: a thread that is left
/// would go on with half of the outputs. Once per process, before `LastWords::listen`.
pub fn abort_at_panic() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        before(info);
        std::process::abort();
    }));
}

/// An address of this program, from which others are counted: it lies elsewhere in every process. That of a function may
/// be another one in each crate that names it; this one is not.
pub fn anchor() -> usize {
    (&raw const WORDS).addr()
}

extern "C" fn on_signal(signal: i32, info: *mut libc::siginfo_t, _: *mut libc::c_void) {
    // SAFETY: null, or words that were made 'static in `listen`.
    if let Some(words) = unsafe { WORDS.load(Relaxed).as_ref() } {
        words.signal.store(signal as u64, Relaxed);
        // SAFETY: SA_SIGINFO: the kernel hands over a valid `siginfo_t`; the address is plain bytes for every signal.
        words.address.store(unsafe { (*info).si_addr() } as u64, Relaxed);
        words.trace();
    }
    // SAFETY: async-signal-safe. The action is the default one again (SA_RESETHAND): it ends the process on return.
    unsafe { libc::raise(signal) };
}

/// Asks a process to say where it is and die (SIGABRT).
pub fn abort(pid: u32) {
    // SAFETY: `kill` takes two numbers and touches no memory.
    unsafe { libc::kill(pid as libc::pid_t, libc::SIGABRT) };
}
