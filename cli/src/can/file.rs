//! Recordings on disk: MCAP, by the ending of its name, and text, by what stands in it; written are MCAP and candump logs.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use fieldbus::candump;
use fieldbus::capture::{Capture, CaptureDirection, Captured, FrameType};
use fieldbus::text_log::{self, Strictness};
use recording::LogEnd;
use recording::traffic::{CanFrame, TrafficWriter, read_traffic};

/// Whether a file is, or is to become, MCAP.
fn is_mcap(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"))
}

/// Reads a recording, in the order of time; what a lenient reader leaves out, and steps of the clock, are told on standard
/// error.
pub(super) fn read(path: &Path, lenient: bool) -> Result<Capture, Box<dyn Error>> {
    let strictness = if lenient { Strictness::Lenient } else { Strictness::Strict };
    let capture = if is_mcap(path) {
        read_mcap(path, lenient)?
    } else {
        let (capture, broken) = text_log::read(path, strictness)?;
        if broken.count > 0 {
            eprintln!("left out: {broken}");
        }
        capture
    };
    if let Some(first) = capture.steps.first() {
        let most = capture.steps.iter().map(|step| step.back_ns).max().unwrap_or(0) as f64 * 1e-9;
        let at = capture.frames[first.at].time_ns as f64 * 1e-9;
        eprintln!(
            "{}: the clock was put back, {} times, by up to {most:.6} s, first to {at:.6} s: there the order of the file \
             counts, and the time between the frames is not known",
            path.display(),
            capture.steps.len(),
        );
    }
    Ok(capture)
}

fn read_mcap(path: &Path, lenient: bool) -> Result<Capture, Box<dyn Error>> {
    let mut capture = Capture::default();
    let mut broken = 0;
    let end = read_traffic(path, |frame| match captured(frame) {
        Some(mut one) => {
            one.line = capture.line(frame.line);
            capture.frames.push(one);
        }
        None => broken += 1,
    })?;
    let path = path.display();
    let mut wrong = Vec::new();
    if broken > 0 {
        wrong.push(format!("{broken} frames are longer than a frame can be"));
    }
    if let LogEnd::Truncated(messages) = end {
        wrong.push(format!("it ends in the middle, behind frame {messages}"));
    }
    let wrong = wrong.join("; ");
    match (wrong.is_empty(), lenient) {
        (true, _) => {}
        (false, true) => eprintln!("{path}: {wrong}"),
        (false, false) => {
            return Err(
                format!("{path}: {wrong}. Nothing was done; --lenient takes what can be read.").into()
            );
        }
    }
    capture.sort();
    Ok(capture)
}

/// A frame of a log; none if it is longer than its form allows.
fn captured(frame: &CanFrame<'_>) -> Option<Captured> {
    let form = match frame.form {
        0 => FrameType::Classic { code: frame.flags },
        _ => FrameType::Fd { flags: frame.flags },
    };
    let most = if frame.form == 0 { 8 } else { 64 };
    if frame.data.len() > most || usize::from(frame.len) > most {
        return None;
    }
    let mut data = [0; 64];
    data[..frame.data.len()].copy_from_slice(frame.data);
    let way = match frame.way {
        1 => Some(CaptureDirection::Received),
        2 => Some(CaptureDirection::Sent),
        _ => None,
    };
    Some(Captured { time_ns: frame.stamp_ns, line: 0, id: frame.id, len: frame.len, data, form, way })
}

/// A recording being written.
pub(super) enum RecordingWriter {
    Candump(candump::CandumpWriter<BufWriter<File>>),
    Mcap(Box<TrafficWriter>),
}

impl RecordingWriter {
    /// Makes the file; an existing one is overwritten.
    pub(super) fn create(path: &Path, lines: &[String]) -> Result<Self, Box<dyn Error>> {
        if is_mcap(path) {
            return Ok(Self::Mcap(Box::new(TrafficWriter::create(path)?)));
        }
        // Readers go by these endings.
        let other = path.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
        if let Some(ending @ ("asc" | "trc" | "blf")) = other.as_deref() {
            let path = path.display();
            return Err(format!(
                "{path}: files .{ending} are read, not written; take .log (candump) or .mcap"
            )
            .into());
        }
        let file = File::create(path).map_err(|e| {
            format!("{}: cannot make it: {e}; choose a directory that exists and is writable", path.display())
        })?;
        Ok(Self::Candump(candump::CandumpWriter::new(BufWriter::new(file), lines)))
    }

    pub(super) fn write(&mut self, name: &str, frame: &Captured) -> Result<(), Box<dyn Error>> {
        match self {
            Self::Candump(writer) => Ok(writer.write(name, frame).map_err(full)?),
            Self::Mcap(writer) => {
                let (form, flags) = match frame.form {
                    FrameType::Classic { code } => (0, code),
                    FrameType::Fd { flags } => (1, flags),
                };
                let way = frame.way.map_or(0, |way| if way == CaptureDirection::Received { 1 } else { 2 });
                let (stamp_ns, data) = (frame.time_ns, frame.payload());
                Ok(writer.write(&CanFrame {
                    stamp_ns,
                    line: name,
                    id: frame.id,
                    form,
                    flags,
                    way,
                    len: frame.len,
                    data,
                })?)
            }
        }
    }

    pub(super) fn finish(self) -> Result<(), Box<dyn Error>> {
        match self {
            Self::Candump(mut writer) => Ok(writer.finish().map_err(full)?),
            Self::Mcap(writer) => Ok(writer.finish()?),
        }
    }
}

fn full(error: std::io::Error) -> String {
    format!("the recording can no longer be written: {error}; is the disk full?")
}

/// Writes a whole recording.
pub(super) fn write(path: &Path, capture: &Capture) -> Result<(), Box<dyn Error>> {
    let mut writer = RecordingWriter::create(path, &capture.lines)?;
    for frame in &capture.frames {
        writer.write(&capture.lines[frame.line as usize], frame)?;
    }
    writer.finish()
}
