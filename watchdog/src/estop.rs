//! The emergency stop's own way into the watchdog: a thread that listens on its line, above all others in priority.
//!
//! ```text
//! datagram ──► thread: asked += 1 ──► next cycle: EmergencyStop, supply off ──► served = asked ──► thread: answer
//! ```
//!
//! A request stays until a cycle has written a power record that says off: it is never lost, and never answered before. A
//! flood stops the robot with its first datagram; what it costs afterwards is bounded (`BATCH` per `PAUSE`).

use ipc::{Asker, Datagram, StopAnswer, StopLine};
use messages::Power;
use realtime::{Granted, ThreadSchedule, clock, prepare_side_thread};
use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::{Acquire, Release};
use std::sync::mpsc;
use std::time::Duration;

/// Requests answered together, and the time from one such lot to the next \[ns\].
const BATCH: usize = 64;
const PAUSE: u64 = 5_000_000;
/// Wait for the supply to be off before the answer "pending", and period of the check \[ns\].
const OUTCOME: u64 = 20_000_000;
const LOOK: u64 = 100_000;
/// Between two looks whether the watchdog is gone.
const IDLE: Duration = Duration::from_millis(100);
const STACK: usize = 256 << 10;

/// State shared by thread and cycle. Each number has one writer.
#[derive(Debug, Default)]
struct Shared {
    /// Requests so far, and who sent the newest; the thread's.
    asked: AtomicU64,
    from: AtomicU64,
    /// Number of them acted on, and time since when the supply is off; written by the cycle.
    served: AtomicU64,
    tick: AtomicU64,
    stamp_ns: AtomicU64,
}

/// The cycle's end. Dropping it ends the thread.
#[derive(Debug)]
pub struct EmergencyStop {
    shared: Arc<Shared>,
    /// Requests that this cycle acts on.
    taken: u64,
    off: bool,
}

impl EmergencyStop {
    /// Starts the thread; says what it was granted.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub fn listen(line: StopLine, schedule: ThreadSchedule) -> io::Result<(Self, Granted)> {
        let shared = Arc::new(Shared::default());
        let (far, (told, granted)) = (shared.clone(), mpsc::channel());
        let work = move || {
            let granted = prepare_side_thread(&schedule);
            let _ = told.send(granted);
            while Arc::strong_count(&far) > 1 {
                if line.wait(IDLE) {
                    let begun = clock::now();
                    answer_lot(&line, &far);
                    clock::sleep_until(begun + PAUSE);
                }
            }
        };
        std::thread::Builder::new().name("estop".into()).stack_size(STACK).spawn(work)?;
        let granted = granted.recv().map_err(io::Error::other)?;
        Ok((Self { shared, taken: 0, off: false }, granted))
    }

    /// Whether somebody asks for the stop in this cycle, and who.
    pub fn asked(&mut self) -> Option<Asker> {
        self.taken = self.shared.asked.load(Acquire);
        if self.taken == self.shared.served.load(Acquire) {
            return None;
        }
        let from = self.shared.from.load(Acquire);
        Some(Asker { pid: from as u32, uid: (from >> 32) as u32 })
    }

    /// Says what became of it, once the cycle's power record is written.
    pub fn written(&mut self, power: &Power) {
        let off = power.on == 0;
        if off && !self.off {
            self.shared.tick.store(power.header.tick, Release);
            self.shared.stamp_ns.store(clock::now(), Release);
        }
        self.off = off;
        if off {
            self.shared.served.store(self.taken, Release);
        }
    }
}

/// One lot: asks with the very first datagram, then reads the rest, waits for the outcome and tells everybody.
fn answer_lot(line: &StopLine, shared: &Shared) {
    let mut waiting = [const { None }; BATCH];
    for place in &mut waiting {
        let Some(Datagram { from, answer_to }) = line.receive() else { break };
        shared.from.store(u64::from(from.uid) << 32 | u64::from(from.pid), Release);
        shared.asked.fetch_add(1, Release);
        *place = answer_to;
    }
    let answer = outcome(shared);
    for to in waiting.iter().flatten() {
        line.answer(to, answer);
    }
}

/// Outcome of all requests so far. Polled instead of being woken: the cycle makes no system call for it.
fn outcome(shared: &Shared) -> StopAnswer {
    let (asked, begun) = (shared.asked.load(Acquire), clock::now());
    let mut look = begun;
    while shared.served.load(Acquire) < asked {
        if look > begun + OUTCOME {
            return StopAnswer::Pending;
        }
        look += LOOK;
        clock::sleep_until(look);
    }
    StopAnswer::Off { tick: shared.tick.load(Acquire), stamp_ns: shared.stamp_ns.load(Acquire) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ipc::{StopButton, StopName};

    fn rig(name: &str) -> (EmergencyStop, StopButton) {
        let dir = std::env::temp_dir().join(format!("gangwerk-estop-{}-{name}", std::process::id()));
        let line = StopLine::bind(&dir).unwrap();
        let (stop, granted) = EmergencyStop::listen(line, ThreadSchedule::ORDINARY).unwrap();
        assert!(!granted.degraded());
        (stop, StopButton::new(&StopName::own(&dir)).unwrap())
    }

    fn record(tick: u64, on: u64) -> Power {
        let mut power = Power { on, ..Power::default() };
        power.header.tick = tick;
        power
    }

    const SOON: Duration = Duration::from_secs(10);

    /// The next cycle in which somebody asks.
    fn next(stop: &mut EmergencyStop) -> Asker {
        loop {
            if let Some(asker) = stop.asked() {
                return asker;
            }
            clock::sleep_until(clock::now() + LOOK);
        }
    }

    #[test]
    fn a_request_stays_until_the_supply_is_off_and_is_answered_with_that_tick() {
        let (mut stop, button) = rig("stays");
        assert_eq!(stop.asked(), None);
        stop.written(&record(1, 1));
        button.press().unwrap();
        assert_eq!(next(&mut stop).pid, std::process::id());
        stop.written(&record(2, 1)); // nobody cut the supply: it asks again
        assert!(stop.asked().is_some());
        assert_eq!(button.answer(SOON), Some(StopAnswer::Pending));
        stop.written(&record(3, 0));
        assert_eq!(stop.asked(), None);
        stop.written(&record(4, 0));
        button.press().unwrap();
        next(&mut stop);
        stop.written(&record(5, 0));
        let answer = button.answer(SOON);
        assert!(matches!(answer, Some(StopAnswer::Off { tick: 3, .. })), "{answer:?}");
    }

    #[test]
    fn a_request_between_look_and_record_waits_for_the_next_record() {
        let (mut stop, button) = rig("between");
        assert_eq!(stop.asked(), None);
        button.press().unwrap();
        while stop.shared.asked.load(Acquire) == 0 {
            clock::sleep_until(clock::now() + LOOK);
        }
        stop.written(&record(7, 0)); // off for another reason: this cycle had not seen the request
        assert!(stop.asked().is_some());
    }
}
