//! `gangwerk can stat`: what is how often, how regularly, and how much of the lines it takes.

use std::error::Error;
use std::path::{Path, PathBuf};

use fieldbus::bits;
use fieldbus::capture::{BASE_BITS, Captured, ERROR, EXTENDED, EXTENDED_BITS, REMOTE};
use fieldbus::clock_steps::ClockSteps;
use fieldbus::load::{BIT_RATE, DATA_BIT_RATE};
use fieldbus::load_course::LoadCourse;
use fieldbus::statistics::{BitRates, IdentifierStatistics, Statistics};
use serde::Serialize;

use super::dictionary::{Dictionary, Source};
use super::{file, load_picture, source};

/// Input of the statistics.
#[derive(clap::Args)]
pub struct StatOptions {
    /// A recording, or interfaces: can0 or can0,can1 or vcan0-8.
    pub source: String,
    /// Whose frames these are.
    #[command(flatten)]
    pub words: Source,
    /// Bit rate in bit/s of classic CAN and of the arbitration of CAN FD.
    #[arg(long, default_value_t = BIT_RATE, value_parser = rate)]
    pub bitrate: f64,
    /// Bit rate in bit/s of the data of CAN FD.
    #[arg(long, default_value_t = DATA_BIT_RATE, value_parser = rate)]
    pub data_bitrate: f64,
    /// End after this time, in s; interfaces only.
    #[arg(long, value_name = "S", value_parser = source::seconds)]
    pub seconds: Option<f64>,
    /// Draw the load of the lines over time into this file.
    #[arg(long, value_name = "FILE")]
    pub png: Option<PathBuf>,
    /// One JSON object on standard output instead of tables.
    #[arg(long)]
    pub json: bool,
    /// Leave broken lines out, and tell how many.
    #[arg(long)]
    pub lenient: bool,
}

/// Bit rate that some CAN controller has.
fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| format!("`{text}` is not a number of bits per second"))?;
    let sensible = (1e3..=2e7).contains(&rate);
    sensible.then_some(rate).ok_or_else(|| format!("{rate} bit/s: 1e3 to 2e7"))
}

/// All figures.
#[derive(Serialize)]
struct TrafficReport {
    /// As far as it is known: what passed while the clock was put back is not.
    seconds: f64,
    clock_steps: usize,
    bitrate: f64,
    data_bitrate: f64,
    lines: Vec<LineRate>,
    messages: Vec<MessageRate>,
}

#[derive(Serialize)]
struct LineRate {
    interface: String,
    frames: u64,
    error_frames: u64,
    bytes: u64,
    /// Share of the time; none for a recording of one instant.
    load: Option<f64>,
}

#[derive(Serialize)]
struct MessageRate {
    interface: String,
    id: String,
    /// Empty if unknown.
    name: String,
    frames: u64,
    rate: f64,
    period_min: f64,
    period_mean: f64,
    period_max: f64,
    bytes: u64,
    missing: u64,
    repeated: u64,
}

/// Counts and prints.
///
/// # Errors
/// The source cannot be read, or the picture not be written.
pub fn run(config: &Path, order: &StatOptions) -> Result<(), Box<dyn Error>> {
    let rates = BitRates { nominal: order.bitrate, data: order.data_bitrate };
    let mut count = Count {
        dictionary: order.words.load(config)?,
        statistics: Statistics::new(rates),
        course: LoadCourse::default(),
        rates,
        clock_steps: 0,
    };
    let names = if source::is_file(&order.source) {
        let capture = file::read(Path::new(&order.source), order.lenient)?;
        if let Some(dictionary) = &mut count.dictionary {
            capture.frames.iter().for_each(|frame| dictionary.learn(frame));
        }
        let mut steps = capture.steps.iter().map(|step| step.at).peekable();
        for (i, frame) in capture.frames.iter().enumerate() {
            count.add(frame, steps.next_if_eq(&i).is_some());
        }
        capture.lines
    } else {
        let names = source::names(&order.source)?;
        let (mut clock, mut stretch) = (ClockSteps::default(), 0);
        source::listen(&names, order.seconds, |frame| {
            if let Some(frame) = frame {
                if let Some(dictionary) = &mut count.dictionary {
                    dictionary.learn(frame);
                }
                let now = clock.stretch(frame.line, frame.time_ns);
                count.add(frame, now > stretch);
                stretch = now.max(stretch);
            }
            Ok(())
        })?;
        names
    };
    if let Some(png) = &order.png {
        load_picture::figure(&count.course, &names, &order.source).save(png)?;
        eprintln!("{}", png.display());
    }
    let report = count.report(&names);
    println!("{}", if order.json { serde_json::to_string(&report)? } else { table(&report) });
    Ok(())
}

/// Counts so far.
struct Count {
    dictionary: Option<Dictionary>,
    statistics: Statistics,
    course: LoadCourse,
    rates: BitRates,
    clock_steps: usize,
}

impl Count {
    /// One more frame; `put_back`: before it the clock was put back.
    fn add(&mut self, frame: &Captured, put_back: bool) {
        if put_back {
            self.statistics.clock_was_put_back();
            self.clock_steps += 1;
        }
        let counter = self.dictionary.as_ref().and_then(|dictionary| dictionary.counter(frame));
        self.statistics.add(frame, counter);
        if !frame.is_error() {
            let occupied = bits::of(frame).seconds(self.rates.nominal, self.rates.data);
            self.course.add(frame.line, self.statistics.elapsed_ns(), occupied);
        }
    }

    fn report(&self, names: &[String]) -> TrafficReport {
        let line = |(line, total): (u32, &fieldbus::statistics::LineTotal)| LineRate {
            interface: names[line as usize].clone(),
            frames: total.count,
            error_frames: total.errors,
            bytes: total.bytes,
            load: Some(self.statistics.load(total)).filter(|load| load.is_finite()),
        };
        let name = |line, id| self.dictionary.as_ref().map_or_else(String::new, |words| words.name(line, id));
        let message = |(line, id, row): (u32, u32, &IdentifierStatistics)| MessageRate {
            interface: names[line as usize].clone(),
            id: identifier(id),
            name: name(line, id),
            frames: row.count,
            rate: if row.span > 0.0 { 1.0 / row.mean() } else { 0.0 },
            period_min: row.shortest,
            period_mean: row.mean(),
            period_max: row.longest,
            bytes: row.bytes,
            missing: row.missing,
            repeated: row.repeated,
        };
        TrafficReport {
            seconds: self.statistics.seconds(),
            clock_steps: self.clock_steps,
            bitrate: self.rates.nominal,
            data_bitrate: self.rates.data,
            lines: self.statistics.lines().map(line).collect(),
            messages: self.statistics.rows().map(message).collect(),
        }
    }
}

/// As candump writes it; remote frames with an R.
fn identifier(id: u32) -> String {
    let remote = if id & (REMOTE | ERROR) == REMOTE { "R" } else { "" };
    match id {
        _ if id & ERROR != 0 => format!("{:08X}", id & (ERROR | EXTENDED_BITS)),
        _ if id & EXTENDED != 0 => format!("{:08X}{remote}", id & EXTENDED_BITS),
        _ => format!("{:03X}{remote}", id & BASE_BITS),
    }
}

fn table(r: &TrafficReport) -> String {
    let mut text = format!(
        "{:12} {:>9} {:28} {:>8} {:>9} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8}\n",
        "interface",
        "id",
        "message",
        "frames",
        "rate/Hz",
        "min/ms",
        "mean/ms",
        "max/ms",
        "bytes",
        "missing",
        "repeated"
    );
    for m in &r.messages {
        let ms = |seconds: f64| format!("{:.3}", 1e3 * seconds);
        text += &format!(
            "{:12} {:>9} {:28} {:>8} {:>9.1} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8}\n",
            m.interface,
            m.id,
            m.name,
            m.frames,
            m.rate,
            ms(m.period_min),
            ms(m.period_mean),
            ms(m.period_max),
            m.bytes,
            m.missing,
            m.repeated
        );
    }
    text += &format!(
        "\nover {:.3} s at {} bit/s, data of CAN FD at {} bit/s; stuff bits counted, error frames not\n",
        r.seconds, r.bitrate, r.data_bitrate
    );
    if r.clock_steps > 0 {
        text += &format!(
            "the clock was put back {} times: what passed meanwhile is not counted\n",
            r.clock_steps
        );
    }
    for l in &r.lines {
        let load = l.load.map_or("-".into(), |load| format!("{:.1} %", 100.0 * load));
        text += &format!(
            "{:12} {:>8} frames, {} bytes, {} error frames, bus load {load}\n",
            l.interface, l.frames, l.bytes, l.error_frames
        );
    }
    text.trim_end().to_owned()
}
