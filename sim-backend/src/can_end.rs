//! Far end of the CAN lines: a cycle is whole when every line has been synchronized.
//!
//! A line that lets a cycle pass is broken and is not waited for until it sends again: its frames stay missing.

use std::error::Error;
use std::time::Duration;

use codec::layout::{Carries, FrameLayout, MAX_NODES};
use codec::network::NetworkCommand;
use daemon::Daemon;
use fieldbus::{BusEnd, BusLines};
use messages::{BusFrames, Frame};
use realtime::clock;

use crate::far_end::FarEnd;

/// In lockstep: between two looks whether to end.
const LOOK: Duration = Duration::from_millis(20);
/// In lockstep: a line may be this much later than the first \[ns\].
const GRACE: u64 = clock::SECOND;

/// Drives on CAN lines.
pub(crate) struct CanEnd {
    lines: BusLines,
    layout: FrameLayout,
    inbox: BusFrames,
    gathering: Gathering,
    whole: BusFrames,
    answer: BusFrames,
    period_ns: u64,
}

/// Frames of the cycle that is coming in.
struct Gathering {
    frames: BusFrames,
    /// Lines (bits) that were synchronized in it.
    synced: u32,
    /// Place in the frames at which each line was.
    synced_at: [usize; MAX_NODES],
    /// Lines that are waited for.
    alive: u32,
    /// Lines whose drives were started, or need not be.
    started: u32,
    /// Its tick, once one line was synchronized; until then the last one's.
    tick: u64,
}

/// All lines of a layout, as bits.
fn every_line(layout: &FrameLayout) -> u32 {
    ((1u64 << layout.nodes.len()) - 1) as u32
}

/// Result of a frame.
#[derive(Debug, PartialEq, Eq)]
enum FrameResult {
    More,
    Whole,
    /// This line was asked for the state before the first cycle.
    Asked(u32),
}

impl CanEnd {
    /// Opens all lines.
    pub(crate) fn new(d: &Daemon, fd: bool, interfaces: &[String]) -> Result<Self, Box<dyn Error>> {
        let layout = d.setup.robot.layout.clone();
        let lines = BusLines::open(interfaces, &layout, fd, BusEnd::Far)?;
        let gathering = Gathering::new(&layout);
        let empty = BusFrames::default;
        let (inbox, whole, answer) = (empty(), empty(), empty());
        Ok(Self { lines, layout, inbox, gathering, whole, answer, period_ns: d.period_ns() })
    }

    /// Takes frames out of the inbox until a cycle is whole.
    fn gather(&mut self) -> bool {
        let count = self.inbox.count as usize;
        for i in 0..count {
            match self.gathering.take(&self.layout, &self.inbox.frames[i]) {
                FrameResult::More => {}
                FrameResult::Asked(line) => self.lines.send_on(line, &self.answer),
                FrameResult::Whole => {
                    self.inbox.frames.copy_within(i + 1..count, 0);
                    self.inbox.count = (count - i - 1) as u64;
                    self.finish();
                    return true;
                }
            }
        }
        self.inbox.count = 0;
        false
    }

    /// The gathered cycle, whole or not, is the one that is held.
    fn finish(&mut self) {
        self.whole = self.gathering.frames;
        self.whole.header.tick = self.gathering.tick;
        self.whole.header.stamp_ns = self.gathering.tick * self.period_ns;
        self.gathering.next();
    }
}

impl FarEnd for CanEnd {
    fn refresh(&mut self) -> bool {
        let whole = self.gather() || self.lines.receive(&mut self.inbox) > 0 && self.gather();
        if whole {
            self.whole.header.stamp_ns = clock::now();
        }
        whole
    }

    fn held(&self) -> Option<&BusFrames> {
        (self.whole.header.tick > 0).then_some(&self.whole)
    }

    fn answer(&mut self, _: &Daemon, frames: &BusFrames) {
        self.answer = *frames;
        // A controller that was not started yet is silent.
        let started = self.gathering.started;
        if started == every_line(&self.layout) {
            return self.lines.send(frames);
        }
        for line in (0..MAX_NODES as u32).filter(|line| started >> line & 1 == 1) {
            self.lines.send_on(line, frames);
        }
    }

    fn wait(&mut self, at_most: Duration) {
        self.lines.wait(None, at_most);
    }

    fn next(&mut self, d: &Daemon) -> Result<bool, Box<dyn Error>> {
        let begun = clock::now();
        let mut first = None;
        while !d.stop.asked() {
            if self.gather() {
                return Ok(true);
            }
            if self.lines.receive(&mut self.inbox) > 0 {
                continue;
            }
            let now = clock::now();
            if self.gathering.synced != 0 && now - *first.get_or_insert(now) > GRACE {
                self.gathering.alive = self.gathering.synced;
                self.finish();
                return Ok(true);
            }
            // Before the first cycle lowlevel may still be starting.
            if now - begun > d.patience().as_nanos() as u64 && self.gathering.tick > 0 {
                let seconds = d.patience().as_secs_f64();
                return Err(format!(
                    "sim-backend: lockstep: lowlevel sent nothing on the CAN lines for {seconds} s; is it running?"
                )
                .into());
            }
            // Lines are synchronized in their order.
            let last = (self.gathering.alive & !self.gathering.synced).checked_ilog2();
            self.lines.wait(last.map(|line| line as usize), LOOK);
        }
        Ok(false)
    }
}

impl Gathering {
    fn new(layout: &FrameLayout) -> Self {
        let all = every_line(layout);
        let managed = layout.messages.iter().filter(|m| m.manages_network());
        Self {
            frames: BusFrames::default(),
            synced: 0,
            synced_at: [0; MAX_NODES],
            alive: all,
            started: managed.fold(all, |bits, m| bits & !(1 << m.node)),
            tick: 0,
        }
    }

    fn take(&mut self, layout: &FrameLayout, frame: &Frame) -> FrameResult {
        let message = layout.find(frame.line, frame.id).map(|i| &layout.messages[i]);
        let line = 1u32 << frame.line;
        if message.is_some_and(|m| m.manages_network()) && frame.data[0] == NetworkCommand::Start as u8 {
            self.started |= line;
        }
        let counter = message
            .filter(|m| m.is_sync() && m.len == frame.len)
            .and_then(|m| m.signals.iter().find(|s| s.carries == Carries::Counter));
        let Some(counter) = counter else {
            self.frames.push(frame);
            return FrameResult::More;
        };
        // The tick is the next one with these low bits.
        let ahead = (counter.get(&frame.data) as u64).wrapping_sub(self.tick) & ((1 << counter.bits) - 1);
        if ahead == 0 && self.synced == 0 {
            if self.tick == 0 {
                self.frames.count = 0;
                let started = self.started & line != 0;
                return if started { FrameResult::Asked(frame.line) } else { FrameResult::More };
            }
            // A repeated one, or a broken line that speaks again, too late for this cycle.
            self.alive |= line;
            return FrameResult::More;
        }
        if ahead > 0 && self.synced != 0 {
            // The next cycle begins, and this one is not whole: those who missed it are not waited for.
            self.alive = self.synced;
            self.give_up();
        }
        self.tick += ahead;
        self.alive |= line;
        self.frames.push(frame);
        self.synced |= line;
        self.synced_at[frame.line as usize] = self.frames.count as usize;
        if self.synced & self.alive == self.alive { FrameResult::Whole } else { FrameResult::More }
    }

    /// Forgets what belongs to the cycle that was not whole.
    fn give_up(&mut self) {
        let mut kept = 0;
        for i in 0..self.frames.count as usize {
            let line = self.frames.frames[i].line as usize;
            if self.synced >> line & 1 == 0 || i >= self.synced_at[line] {
                self.frames.frames[kept] = self.frames.frames[i];
                kept += 1;
            }
        }
        self.frames.count = kept as u64;
        self.synced = 0;
    }

    /// The next cycle.
    fn next(&mut self) {
        self.frames.count = 0;
        self.synced = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use codec::frames::{DriveCommand, encode_targets, look};
    use config::Robot;

    fn layout() -> FrameLayout {
        Robot::load(&config::root(None).join("robots/lola")).unwrap().classic.unwrap()
    }

    fn cycle(layout: &FrameLayout, tick: u64) -> BusFrames {
        let mut command = DriveCommand::default();
        command.targets.header.tick = tick;
        let mut frames = BusFrames::default();
        encode_targets(layout, &command, &mut frames);
        frames
    }

    /// Results of the frames; and which nodes were complete in the last whole cycle.
    fn take_all(g: &mut Gathering, layout: &FrameLayout, frames: &[Frame]) -> (Vec<FrameResult>, Vec<bool>) {
        let (mut steps, mut complete) = (Vec::new(), Vec::new());
        for frame in frames {
            let step = g.take(layout, frame);
            if step == FrameResult::Whole {
                g.frames.header.tick = g.tick;
                let seen = look(layout, true, &g.frames);
                complete = (0..layout.nodes.len()).map(|n| seen.complete(n)).collect();
                g.next();
            }
            if step != FrameResult::More {
                steps.push(step);
            }
        }
        (steps, complete)
    }

    #[test]
    fn a_cycle_is_whole_with_the_last_sync_and_its_tick_goes_on_beyond_the_counter() {
        let layout = layout();
        let mut g = Gathering::new(&layout);
        assert_eq!(take_all(&mut g, &layout, cycle(&layout, 0).as_slice()).0.len(), 9);
        for tick in 1..600 {
            let all = (vec![FrameResult::Whole], vec![true; 9]);
            assert_eq!(take_all(&mut g, &layout, cycle(&layout, tick).as_slice()), all);
            assert_eq!(g.tick, tick);
        }
    }

    #[test]
    fn a_broken_line_is_waited_for_once_and_again_when_it_speaks() {
        let layout = layout();
        let mut g = Gathering::new(&layout);
        let without = |tick: u64| -> Vec<Frame> {
            cycle(&layout, tick).as_slice().iter().filter(|f| f.line != 8).copied().collect()
        };
        let all = |missing: bool| {
            (vec![FrameResult::Whole], (0..9).map(|n| n != 8 || !missing).collect::<Vec<_>>())
        };
        assert_eq!(take_all(&mut g, &layout, cycle(&layout, 1).as_slice()), all(false));
        assert_eq!(take_all(&mut g, &layout, &without(2)).0, []);
        assert_eq!(take_all(&mut g, &layout, &without(3)), all(true), "2 was given up with the next cycle");
        assert_eq!(take_all(&mut g, &layout, &without(4)), all(true));
        // Line 8 speaks last: this cycle is closed without it, the next one waits for it.
        assert_eq!(take_all(&mut g, &layout, cycle(&layout, 5).as_slice()), all(true));
        assert_eq!(take_all(&mut g, &layout, cycle(&layout, 6).as_slice()), all(false));
    }
}
