//! Faults between the two ends of the bus: what one end sent in a cycle goes in, what the other one gets comes out.
//!
//! Pure and repeatable: the same faults, seed and frames give the same bits. Nothing allocates after [`Injector::new`].
//!
//! A line has a bus controller at each end. Errors that a checksum or a missing acknowledgement reveals are counted there
//! ([`ErrorCounters`]); the near end's controller tells lowlevel of them by error frames, as Linux does. A controller that
//! leaves the bus takes its line with it until [`Injector::reset`]. What is modelled more simply than on a wire:
//!
//! - A destroyed frame is not sent again in the same cycle, as if no room were left on the line: "corrupted" means lost,
//!   and told. On a line that is [`FaultKind::Shorted`] the repetitions do happen: 32 of them end in bus-off.
//! - A flipped bit that the checksum lets pass ([`FaultKind::Flipped`]) is far more frequent here than the one in 2^15
//!   of all heavily disturbed frames that CAN's checksum of 15 bits promises.
//! - On other buses than CAN there are no such controllers; the faults of frames are the same.

use codec::layout::FrameLayout;
use config::bus_fault::{BusFault, FaultKind, FrameDirection, MOST_LATE};
use messages::bus::MAX_FRAMES;
use messages::{BusFrames, ERROR_FLAG, Frame};

use crate::error_counters::{ErrorCounters, RECOVERY_BITS};
use crate::error_frame::{ErrorFrame, ErrorState};

/// \[bit/s\] Bit rate that recovery is counted with: classic CAN on short lines.
const BIT_RATE: f64 = 1e6;
/// Attempts to send until a controller is off the bus.
const ATTEMPTS: u32 = 32;

/// Faults injected into frames since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Injected {
    /// Lost, for whatever reason.
    pub lost: u64,
    /// Held back for a later cycle.
    pub late: u64,
    /// Sent twice.
    pub duplicated: u64,
    /// With a flipped bit.
    pub flipped: u64,
    /// Error frames to lowlevel.
    pub errors: u64,
}

/// A fault in cycles and lines.
#[derive(Clone, Debug)]
struct Active {
    fault: BusFault,
    /// First cycle, and the first one after it.
    ticks: [u64; 2],
    /// The line it happens to; none: all.
    line: Option<u32>,
}

/// The two bus controllers of a line, and what happens to it now.
#[derive(Clone, Debug, Default)]
struct FaultyLine {
    near: ErrorCounters,
    far: ErrorCounters,
    /// Last message to lowlevel.
    told: ErrorState,
    /// Error in this cycle; nobody acknowledged.
    erred: [bool; 2],
    /// Tick until which all is lost, by way.
    burst: [u64; 2],
    /// Tick from which the controllers may take part again, once told to.
    restart: Option<u64>,
}

/// A frame on its way to a later cycle.
#[derive(Clone, Debug)]
struct DelayedFrame {
    due: u64,
    frame: Frame,
}

/// Brings about the faults of a scene.
#[derive(Clone, Debug)]
pub struct Injector {
    faults: Vec<Active>,
    lines: Vec<FaultyLine>,
    /// \[1\] Cycles that 128 times 11 bits take.
    recovery: u64,
    random: u64,
    /// By way.
    held: [Vec<DelayedFrame>; 2],
    out: [BusFrames; 2],
    injected: Injected,
}

impl Injector {
    /// The faults of a scene with bus cycle `cycle` \[s\], on the lines of a layout. None if there are no faults: then
    /// frames shall go on untouched.
    ///
    /// # Errors
    /// A fault names a node that the layout does not have.
    pub fn new(
        faults: &[BusFault],
        layout: &FrameLayout,
        cycle: f64,
        seed: u64,
    ) -> Result<Option<Self>, String> {
        let faults: Vec<Active> =
            faults.iter().map(|fault| Active::new(fault, layout, cycle)).collect::<Result<_, _>>()?;
        if faults.is_empty() {
            return Ok(None);
        }
        let latest = faults.iter().map(Active::latest).max().unwrap_or(0) as usize;
        let room = || Vec::with_capacity(MAX_FRAMES * latest);
        Ok(Some(Self {
            faults,
            lines: vec![FaultyLine::default(); layout.nodes.len()],
            recovery: (f64::from(RECOVERY_BITS) / BIT_RATE / cycle).ceil() as u64,
            random: seed,
            held: [room(), room()],
            out: [BusFrames::default(); 2],
            injected: Injected::default(),
        }))
    }

    /// Progress so far.
    pub fn injected(&self) -> Injected {
        self.injected
    }

    /// Counters of the controllers of a line: lowlevel's and the node's.
    pub fn counters(&self, line: usize) -> [ErrorCounters; 2] {
        [self.lines[line].near, self.lines[line].far]
    }

    /// Controllers off the bus are told to come back; they do after 128 times 11 bits. For the reset edge.
    pub fn reset(&mut self, tick: u64) {
        let after = tick + self.recovery;
        for line in self.lines.iter_mut().filter(|line| line.is_off()) {
            line.restart.get_or_insert(after);
        }
    }

    /// Output at the other end for the frames sent in their header's cycle.
    pub fn pass(&mut self, way: FrameDirection, frames: &BusFrames) -> &BusFrames {
        let (tick, w) = (frames.header.tick, way as usize);
        let mut out = std::mem::take(&mut self.out[w]);
        out.header = frames.header;
        out.count = 0;
        if way == FrameDirection::ToDrives {
            self.begin(tick);
        }
        self.begin_bursts(way, tick);
        self.deliver_held(way, tick, &mut out);
        for frame in frames.as_slice() {
            self.send(way, tick, *frame, &mut out);
        }
        self.reorder(way, tick, &mut out);
        if way == FrameDirection::FromDrives {
            self.tell_errors(&mut out);
        }
        self.out[w] = out;
        &self.out[w]
    }

    /// State of a whole line in this cycle.
    fn begin(&mut self, tick: u64) {
        for i in 0..self.lines.len() {
            let shorted = self.any(FaultKind::Shorted, None, i as u32, tick).is_some();
            let line = &mut self.lines[i];
            if line.restart.is_some_and(|from| tick >= from) {
                line.restart = None;
                line.near.restart();
                line.far.restart();
            }
            if shorted {
                (0..ATTEMPTS).for_each(|_| {
                    line.near.failed_to_send();
                    line.far.failed_to_send();
                });
                line.erred[0] = true;
            }
        }
    }

    /// The first fault of a kind on a line in this cycle.
    fn any(&self, kind: FaultKind, way: Option<FrameDirection>, line: u32, tick: u64) -> Option<&BusFault> {
        let holds = |f: &&Active| {
            f.fault.kind == kind
                && (f.ticks[0]..f.ticks[1]).contains(&tick)
                && f.line.is_none_or(|l| l == line)
                && (way.is_none() || f.fault.way.is_none() || f.fault.way == way)
        };
        self.faults.iter().find(holds).map(|f| &f.fault)
    }

    /// Whether a fault of a kind strikes: its probability, and its cycles.
    fn strikes(&mut self, kind: FaultKind, way: FrameDirection, line: u32, tick: u64) -> Option<u32> {
        let fault = self.any(kind, Some(way), line, tick)?;
        let (share, cycles) = (fault.share, fault.cycles);
        (self.chance() < share).then_some(cycles)
    }

    fn send(&mut self, way: FrameDirection, tick: u64, mut frame: Frame, out: &mut BusFrames) {
        if self.is_lost(way, tick, frame.line) {
            self.injected.lost += 1;
            return;
        }
        if self.strikes(FaultKind::Flipped, way, frame.line, tick).is_some() {
            self.flip(&mut frame);
            self.injected.flipped += 1;
        }
        if let Some(cycles) = self.strikes(FaultKind::Late, way, frame.line, tick) {
            self.hold(way, tick + u64::from(cycles), frame);
            self.injected.late += 1;
            return;
        }
        out.push(&frame);
        if let Some(cycles) = self.strikes(FaultKind::Duplicated, way, frame.line, tick) {
            if cycles == 0 {
                out.push(&frame);
            } else {
                self.hold(way, tick + u64::from(cycles), frame);
            }
            self.injected.duplicated += 1;
        }
    }

    /// Whether a frame never arrives, and what the controllers of its line make of it.
    fn is_lost(&mut self, way: FrameDirection, tick: u64, line: u32) -> bool {
        let i = line as usize;
        match self.lines.get(i) {
            None => return false,
            Some(line) if line.near.state() == ErrorState::Off => return true,
            Some(_) => {}
        }
        let alone = self.lines[i].far.state() == ErrorState::Off;
        if alone || self.any(FaultKind::Pulled, None, line, tick).is_some() {
            self.lines[i].not_acknowledged(way);
            return true;
        }
        if self.any(FaultKind::Silent, None, line, tick).is_some() || self.vanishes(way, tick, i) {
            return true;
        }
        let corrupted = self.strikes(FaultKind::Corrupted, way, line, tick).is_some();
        self.lines[i].transfer(way, corrupted);
        corrupted
    }

    /// Losses without an error: single frames, or all of a line for some cycles.
    fn vanishes(&mut self, way: FrameDirection, tick: u64, i: usize) -> bool {
        if tick < self.lines[i].burst[way as usize] {
            return true;
        }
        let single = self.any(FaultKind::Lost, Some(way), i as u32, tick).filter(|f| f.cycles == 0);
        let share = single.map(|f| f.share);
        share.is_some_and(|share| self.chance() < share)
    }

    /// Losses of some cycles: one draw per line and cycle.
    fn begin_bursts(&mut self, way: FrameDirection, tick: u64) {
        for i in 0..self.lines.len() {
            let burst = self.any(FaultKind::Lost, Some(way), i as u32, tick).filter(|f| f.cycles > 0);
            let Some((share, cycles)) = burst.map(|f| (f.share, f.cycles)) else { continue };
            if tick >= self.lines[i].burst[way as usize] && self.chance() < share {
                self.lines[i].burst[way as usize] = tick + u64::from(cycles);
            }
        }
    }

    /// One bit of identifier, length or payload.
    fn flip(&mut self, frame: &mut Frame) {
        let bits = 11 + 4 + 8 * frame.len.min(64);
        let bit = (self.chance() * f64::from(bits)) as u32;
        match bit {
            0..11 => frame.id ^= 1 << bit,
            11..15 => frame.len = (frame.len ^ 1 << (bit - 11)).min(64),
            _ => frame.data[(bit as usize - 15) / 8] ^= 1 << ((bit - 15) % 8),
        }
    }

    /// A frame that finds no room is lost.
    fn hold(&mut self, way: FrameDirection, due: u64, frame: Frame) {
        let held = &mut self.held[way as usize];
        if held.len() < held.capacity() {
            held.push(DelayedFrame { due, frame });
        } else {
            self.injected.lost += 1;
        }
    }

    /// What was held back comes before what is sent now, in the order it was sent.
    fn deliver_held(&mut self, way: FrameDirection, tick: u64, out: &mut BusFrames) {
        let Self { held, lines, injected, .. } = self;
        held[way as usize].retain(|held| {
            if held.due > tick {
                return true;
            }
            let passes = lines.get(held.frame.line as usize).is_none_or(|line| !line.is_off());
            if !(passes && out.push(&held.frame)) {
                injected.lost += 1;
            }
            false
        });
    }

    /// Swaps frames of the same line (Fisher and Yates).
    fn reorder(&mut self, way: FrameDirection, tick: u64, out: &mut BusFrames) {
        for line in 0..self.lines.len() as u32 {
            if self.strikes(FaultKind::Reordered, way, line, tick).is_none() {
                continue;
            }
            let count = out.as_slice().len();
            for i in (1..count).rev() {
                let j = (self.chance() * (i + 1) as f64) as usize;
                if out.frames[i].line == line && out.frames[j].line == line {
                    out.frames.swap(i, j);
                }
            }
        }
    }

    /// Frames of lowlevel's controllers after this cycle.
    fn tell_errors(&mut self, out: &mut BusFrames) {
        for (i, line) in self.lines.iter_mut().enumerate() {
            let state = line.near.state();
            let [bus_error, no_acknowledge] = std::mem::take(&mut line.erred);
            if state == line.told && !bus_error && !no_acknowledge {
                continue;
            }
            let restarted = line.told == ErrorState::Off && state != ErrorState::Off;
            let said = ErrorFrame {
                state: (state != line.told).then_some(state),
                restarted,
                no_acknowledge,
                bus_error,
                counters: Some(line.near.bytes()),
            };
            line.told = state;
            let (id, data) = said.encode();
            let mut frame = Frame { line: i as u32, id, len: 8, ..Frame::default() };
            frame.data[..8].copy_from_slice(&data);
            debug_assert!(id & ERROR_FLAG != 0);
            self.injected.errors += u64::from(out.push(&frame));
        }
    }

    /// Uniform in [0, 1): SplitMix64.
    fn chance(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.random;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / 2f64.powi(53)
    }
}

impl Active {
    fn new(fault: &BusFault, layout: &FrameLayout, cycle: f64) -> Result<Self, String> {
        let line = |name: &String| match layout.nodes.iter().position(|node| node == name) {
            Some(i) => Ok(i as u32),
            None => Err(format!("no node `{name}` on the bus; there is {}", layout.nodes.join(", "))),
        };
        let first = (fault.time / cycle).round() as u64;
        // Rust's cast saturates: a fault without an end.
        let after = first.saturating_add(((fault.duration / cycle).round() as u64).max(1));
        Ok(Self {
            line: fault.node.as_ref().map(line).transpose()?,
            ticks: [first, after],
            fault: fault.clone(),
        })
    }

    /// By how many cycles frames may come later.
    fn latest(&self) -> u32 {
        match self.fault.kind {
            FaultKind::Late | FaultKind::Duplicated => self.fault.cycles.min(MOST_LATE),
            _ => 0,
        }
    }
}

impl FaultyLine {
    /// Whether one of the two controllers has left the bus.
    fn is_off(&self) -> bool {
        self.near.state() == ErrorState::Off || self.far.state() == ErrorState::Off
    }

    /// A frame to a cable that ends nowhere.
    fn not_acknowledged(&mut self, way: FrameDirection) {
        match way {
            FrameDirection::ToDrives => {
                self.near.not_acknowledged();
                self.erred[1] = true;
            }
            FrameDirection::FromDrives => self.far.not_acknowledged(),
        }
    }

    /// A frame on the wire, destroyed or not.
    fn transfer(&mut self, way: FrameDirection, destroyed: bool) {
        let (sender, receiver) = match way {
            FrameDirection::ToDrives => (&mut self.near, &mut self.far),
            FrameDirection::FromDrives => (&mut self.far, &mut self.near),
        };
        if destroyed {
            sender.failed_to_send();
            receiver.failed_to_receive();
            self.erred[0] = true;
        } else {
            sender.sent();
            receiver.received();
        }
    }
}
