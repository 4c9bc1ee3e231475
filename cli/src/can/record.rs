//! `gangwerk can record INTERFACES FILE`: what is on the lines, into a file.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Duration;

use codec::layout::FrameLayout;
use fieldbus::capture::{Captured, FrameType};
use ipc::{Reader, Run, Space};
use messages::topics::{BUS_RX, BUS_TX};
use messages::{BusFrames, Process};
use realtime::{Stop, clock};

use super::decoder::FrameDecoder;
use super::file::RecordingWriter;
use super::{Only, source};

/// Frames are held back this long \[ns\] and written in the order of time: lines are read one by one.
const HELD: u64 = 200_000_000;
/// Cycles of the bus in shared memory that are held back for the same reason.
const HELD_CYCLES: usize = 64;
/// The bus in shared memory has the frames of CAN FD: bit rate switch, FD.
const SHARED_MEMORY: FrameType = FrameType::Fd { flags: 5 };

/// Recording options.
#[derive(clap::Args)]
pub struct RecordOptions {
    /// Interfaces: can0 or can0,can1 or vcan0-8; or shm: the bus of a running robot in shared memory.
    pub interfaces: String,
    /// Candump log, or MCAP if it ends in .mcap; an existing file is overwritten.
    pub file: PathBuf,
    /// End after this time, in s.
    #[arg(long, value_name = "S", value_parser = source::seconds)]
    pub seconds: Option<f64>,
    /// Only one direction; needs --robot.
    #[arg(long, requires = "robot")]
    pub only: Option<Only>,
    /// Robot whose frames these are.
    #[arg(long, value_name = "NAME")]
    pub robot: Option<String>,
    /// Run directory of the robot, for shm.
    #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
    pub dir: PathBuf,
}

/// Records until Ctrl-C or the end of the time.
///
/// # Errors
/// An interface or the file cannot be used; what was recorded until then is kept.
pub fn run(config: &Path, order: &RecordOptions) -> Result<(), Box<dyn Error>> {
    let decoder = order.robot.as_deref().map(|name| FrameDecoder::load(config, name)).transpose()?;
    if order.interfaces == "shm" {
        return shared_memory(order);
    }
    let names = source::names(&order.interfaces)?;
    let mut sorted = Sorted { writer: None, names, file: &order.file, waiting: Vec::new(), count: 0 };
    let (names, mut decoder) = (sorted.names.clone(), decoder);
    let heard = source::listen(&names, order.seconds, |frame| {
        let wanted = frame.filter(|frame| match &mut decoder {
            Some(decoder) => {
                decoder.learn(frame);
                decoder.goes(frame, order.only)
            }
            None => true,
        });
        sorted.take(wanted)
    });
    if let Some(count) = sorted.finish()? {
        println!("{}: {count} frames of {}", order.file.display(), names.join(", "));
    }
    heard
}

/// Writes frames of several lines in the order of time.
struct Sorted<'a> {
    /// Made with the first call: an interface that cannot be used leaves an old recording alone.
    writer: Option<RecordingWriter>,
    names: Vec<String>,
    file: &'a Path,
    waiting: Vec<Captured>,
    count: u64,
}

impl Sorted<'_> {
    fn take(&mut self, frame: Option<&Captured>) -> Result<(), Box<dyn Error>> {
        if self.writer.is_none() {
            self.writer = Some(RecordingWriter::create(self.file, &self.names)?);
        }
        self.waiting.extend(frame);
        // Sorted in batches: now and then, not with every frame.
        let newest = self.waiting.iter().map(|f| f.time_ns).max().unwrap_or(0);
        let oldest = self.waiting.first().map_or(newest, |f| f.time_ns);
        if newest > oldest + 2 * HELD { self.write_until(newest - HELD) } else { Ok(()) }
    }

    /// Writes what is not newer.
    fn write_until(&mut self, time_ns: u64) -> Result<(), Box<dyn Error>> {
        self.waiting.sort_by_key(|frame| frame.time_ns);
        let ready = self.waiting.partition_point(|frame| frame.time_ns <= time_ns);
        for frame in self.waiting.drain(..ready) {
            if let Some(writer) = &mut self.writer {
                writer.write(&self.names[frame.line as usize], &frame)?;
                self.count += 1;
            }
        }
        Ok(())
    }

    /// Number of frames; none if there was nothing to record from.
    fn finish(mut self) -> Result<Option<u64>, Box<dyn Error>> {
        self.write_until(u64::MAX)?;
        let Some(writer) = self.writer.take() else { return Ok(None) };
        writer.finish()?;
        Ok(Some(self.count))
    }
}

/// The frames of bus cycles as a recording: an interface `shmN` for each node.
pub struct Traffic {
    writer: RecordingWriter,
    form: FrameType,
    /// Frames so far.
    pub count: u64,
}

impl Traffic {
    /// Makes the file, for frames of this layout or, if none is known, of CAN FD; an existing one is overwritten.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn create(path: &Path, layout: Option<&FrameLayout>) -> Result<Self, Box<dyn Error>> {
        let form =
            if layout.is_some_and(FrameLayout::is_classic) { FrameType::CLASSIC } else { SHARED_MEMORY };
        Ok(Self { writer: RecordingWriter::create(path, &[])?, form, count: 0 })
    }

    /// Appends one direction of a cycle, at the stamp of its header.
    ///
    /// # Errors
    /// The file can no longer be written.
    pub fn write(&mut self, frames: &BusFrames) -> Result<(), Box<dyn Error>> {
        for frame in frames.as_slice() {
            let captured = Captured::of(frame, frames.header.stamp_ns, self.form);
            self.writer.write(&format!("shm{}", frame.line), &captured)?;
            self.count += 1;
        }
        Ok(())
    }

    /// Closes the file.
    ///
    /// # Errors
    /// The file can no longer be written.
    pub fn finish(self) -> Result<(), Box<dyn Error>> {
        self.writer.finish()
    }
}

/// The bus between lowlevel and the simulated robot, from its topics.
fn shared_memory(order: &RecordOptions) -> Result<(), Box<dyn Error>> {
    let stop = Stop::on_signals()?;
    let run = Run::load(&order.dir)?;
    let space = Space::open(&run.dir, Process::Observer)?;
    let mut to: Reader<BusFrames> = space.reader(&BUS_TX)?;
    let mut from: Reader<BusFrames> = space.reader(&BUS_RX)?;
    let mut traffic = Traffic::create(&order.file, None)?;
    eprintln!("listening on the bus of scene {}; Ctrl-C ends it", run.scene);
    let end = order.seconds.map(|s| clock::now() + (s * 1e9) as u64);
    // By tick, and what was told before what was answered.
    let mut waiting: BTreeMap<(u64, Only), BusFrames> = BTreeMap::new();
    while !stop.asked() && end.is_none_or(|end| clock::now() < end) {
        let before = waiting.len();
        for (reader, only) in [(&mut to, Only::ToDrives), (&mut from, Only::FromDrives)] {
            while let Some(frames) = reader.follow() {
                waiting.insert((frames.header.tick, only), *frames);
            }
        }
        if waiting.len() == before {
            std::thread::park_timeout(Duration::from_micros(200));
        }
        while waiting.len() > HELD_CYCLES {
            put_first(&mut traffic, order.only, &mut waiting)?;
        }
    }
    while !waiting.is_empty() {
        put_first(&mut traffic, order.only, &mut waiting)?;
    }
    let count = traffic.count;
    traffic.finish()?;
    println!("{}: {count} frames, {} cycles lost", order.file.display(), to.lost() + from.lost());
    Ok(())
}

/// Writes the oldest of the cycles that wait, if it goes the way that is wanted.
fn put_first(
    traffic: &mut Traffic,
    wanted: Option<Only>,
    waiting: &mut BTreeMap<(u64, Only), BusFrames>,
) -> Result<(), Box<dyn Error>> {
    match waiting.pop_first() {
        Some(((_, only), frames)) if wanted.is_none_or(|wanted| wanted == only) => traffic.write(&frames),
        _ => Ok(()),
    }
}
