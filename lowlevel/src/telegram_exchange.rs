//! Exchange of telegrams with the interpreters of all drives: the same number of commands to each, every answer checked.
//!
//! Each line carries as many commands in a cycle as it has room for with their answers ([`codec::room`]); both lines at a time.

use codec::interpreter::Telegram;
use codec::layout::FrameLayout;
use codec::room::telegrams_per_cycle;
use messages::{BusFrames, Frame, MAX_FRAMES, MAX_JOINTS};

/// Cycles without an awaited answer after which it is missing.
pub(crate) const ANSWER_CYCLES: u32 = 8;
/// Commands that may wait for their answers in one drive.
const WINDOW: u32 = 16;

/// What is wrong with an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WrongAnswer {
    Different,
    Missing,
}

/// One drive's part.
#[derive(Clone, Copy, Debug, Default)]
struct Exchanged {
    sent: u32,
    answered: u32,
    /// Cycles since an answer, while one is awaited.
    waited: u32,
}

/// The exchange.
#[derive(Clone, Debug)]
pub(crate) struct TelegramExchange {
    layout: FrameLayout,
    joints: usize,
    per_cycle: usize,
    /// Commands to each drive; 0: nothing is exchanged.
    count: u32,
    drives: [Exchanged; MAX_JOINTS],
    out: Vec<Frame>,
}

impl TelegramExchange {
    /// With the drives of these joints, in bus cycles of `dt` \[s\].
    pub(crate) fn new(layout: &FrameLayout, joints: usize, dt: f64) -> Self {
        Self {
            per_cycle: telegrams_per_cycle(layout, dt),
            layout: layout.clone(),
            joints,
            count: 0,
            drives: [Exchanged::default(); MAX_JOINTS],
            out: Vec::with_capacity(MAX_FRAMES),
        }
    }

    /// Begins to exchange `count` commands with each drive; 0: nothing more is sent, and no answer awaited.
    pub(crate) fn begin(&mut self, count: usize) {
        self.count = count as u32;
        self.drives = [Exchanged::default(); MAX_JOINTS];
    }

    /// True if every command was answered.
    pub(crate) fn is_done(&self) -> bool {
        self.drives[..self.joints].iter().all(|drive| drive.answered == self.count)
    }

    /// Answers of a cycle: the first that is not what `expected` says of a joint's command, with both numbers. With `patient`,
    /// answers are awaited for ever, and others let pass.
    pub(crate) fn receive(
        &mut self,
        frames: Option<&BusFrames>,
        patient: bool,
        expected: impl Fn(usize, usize) -> Telegram,
    ) -> Option<(usize, usize, WrongAnswer)> {
        if self.count == 0 {
            return None;
        }
        let waiting = |drive: &Exchanged| drive.answered < drive.sent;
        self.drives.iter_mut().filter(|d| waiting(d)).for_each(|d| d.waited = d.waited.saturating_add(1));
        let mut wrong = None;
        for frame in frames.map(BusFrames::as_slice).unwrap_or_default() {
            let message = self.layout.find(frame.line, frame.id).map(|i| &self.layout.messages[i]);
            let Some(j) = message.filter(|m| !m.to_drives).and_then(|m| m.interpreter()) else { continue };
            let drive = &mut self.drives[j];
            let i = drive.answered as usize;
            if waiting(drive) && Telegram::of(frame) == Some(expected(j, i)) {
                (drive.answered, drive.waited) = (drive.answered + 1, 0);
            } else if !patient {
                wrong = wrong.or(Some((j, i, WrongAnswer::Different)));
            }
        }
        let late = |drive: &Exchanged| waiting(drive) && drive.waited > ANSWER_CYCLES;
        if patient {
            // Asked once more.
            let asked = self.drives.iter_mut().filter(|drive| late(drive));
            asked.for_each(|drive| (drive.sent, drive.waited) = (drive.answered, 0));
            return None;
        }
        wrong.or_else(|| {
            let j = self.drives[..self.joints].iter().position(late)?;
            Some((j, self.drives[j].answered as usize, WrongAnswer::Missing))
        })
    }

    /// Commands of this cycle.
    pub(crate) fn send(&mut self, command: impl Fn(usize, usize) -> Telegram) -> &[Frame] {
        self.out.clear();
        let mut left = [self.per_cycle; codec::layout::MAX_NODES];
        // One to each drive, then one more to each, while there is room.
        let mut sent = self.count > 0;
        while std::mem::take(&mut sent) {
            for j in 0..self.joints {
                let Some(to) = self.layout.interpreter(true, j) else { continue };
                let drive = &mut self.drives[j];
                let room = &mut left[to.node];
                let open = drive.sent - drive.answered;
                if *room == 0 || drive.sent == self.count || open >= WINDOW || self.out.len() == MAX_FRAMES {
                    continue;
                }
                self.out.push(command(j, drive.sent as usize).frame(to.node as u32, to.id));
                drive.sent += 1;
                *room -= 1;
                sent = true;
            }
        }
        &self.out
    }

    /// Sends nothing in this cycle.
    pub(crate) fn pause(&mut self) {
        self.out.clear();
    }

    /// Telegrams of this cycle.
    pub(crate) fn telegrams(&self) -> &[Frame] {
        &self.out
    }
}
