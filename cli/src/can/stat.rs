//! `gangwerk can stat`: what is how often, how regularly, and how much of the lines it takes.

use std::error::Error;
use std::path::Path;

use fieldbus::capture::{BASE_BITS, Captured, ERROR, EXTENDED, EXTENDED_BITS, REMOTE};
use fieldbus::cycles::counter;
use fieldbus::statistics::{BitRates, Row, Statistics};
use serde::Serialize;

use super::decoder::Decoder;
use super::{file, source};

/// What to count.
#[derive(clap::Args)]
pub struct Order {
    /// A recording, or interfaces: can0 or can0,can1 or vcan0-8.
    pub source: String,
    /// Robot whose frames these are: names messages, and finds gaps in their counters.
    #[arg(long, value_name = "NAME")]
    pub robot: Option<String>,
    /// Bit rate in bit/s of classic CAN and of the arbitration of CAN FD.
    #[arg(long, default_value_t = 1e6, value_parser = rate)]
    pub bitrate: f64,
    /// Bit rate in bit/s of the data of CAN FD.
    #[arg(long, default_value_t = 4e6, value_parser = rate)]
    pub data_bitrate: f64,
    /// End after this time, in s; interfaces only.
    #[arg(long, value_name = "S", value_parser = source::seconds)]
    pub seconds: Option<f64>,
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
struct Report {
    seconds: f64,
    bitrate: f64,
    data_bitrate: f64,
    lines: Vec<Line>,
    messages: Vec<Message>,
}

#[derive(Serialize)]
struct Line {
    interface: String,
    frames: u64,
    error_frames: u64,
    bytes: u64,
    /// Share of the time; none for a recording of one instant.
    load: Option<f64>,
}

#[derive(Serialize)]
struct Message {
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
/// The source cannot be read.
pub fn run(config: &Path, order: &Order) -> Result<(), Box<dyn Error>> {
    let mut decoder = order.robot.as_deref().map(|name| Decoder::load(config, name)).transpose()?;
    let rates = BitRates { nominal: order.bitrate, data: order.data_bitrate };
    let mut statistics = Statistics::new(rates);
    let names = if source::is_file(&order.source) {
        let capture = file::read(Path::new(&order.source), order.lenient)?;
        if let Some(decoder) = &mut decoder {
            capture.frames.iter().for_each(|frame| decoder.learn(frame));
        }
        capture.frames.iter().for_each(|frame| statistics.add(frame, count(decoder.as_ref(), frame)));
        capture.lines
    } else {
        let names = source::names(&order.source)?;
        source::listen(&names, order.seconds, |frame| {
            if let Some(frame) = frame {
                if let Some(decoder) = &mut decoder {
                    decoder.learn(frame);
                }
                statistics.add(frame, count(decoder.as_ref(), frame));
            }
            Ok(())
        })?;
        names
    };
    let report = report(&statistics, &names, decoder.as_ref(), rates);
    println!("{}", if order.json { serde_json::to_string(&report)? } else { table(&report) });
    Ok(())
}

fn count(decoder: Option<&Decoder>, frame: &Captured) -> Option<(u64, u32)> {
    counter(decoder?.message(frame)?, frame)
}

fn report(statistics: &Statistics, names: &[String], decoder: Option<&Decoder>, rates: BitRates) -> Report {
    let seconds = statistics.seconds();
    let line = |(line, total): (u32, &fieldbus::statistics::LineTotal)| Line {
        interface: names[line as usize].clone(),
        frames: total.count,
        error_frames: total.errors,
        bytes: total.bytes,
        load: Some(statistics.load(total)).filter(|load| load.is_finite()),
    };
    let message = |(line, id, row): (u32, u32, &Row)| Message {
        interface: names[line as usize].clone(),
        id: identifier(id),
        name: name(decoder, line, id),
        frames: row.count,
        rate: if row.span > 0.0 { 1.0 / row.mean() } else { 0.0 },
        period_min: row.shortest,
        period_mean: row.mean(),
        period_max: row.longest,
        bytes: row.bytes,
        missing: row.missing,
        repeated: row.repeated,
    };
    Report {
        seconds,
        bitrate: rates.nominal,
        data_bitrate: rates.data,
        lines: statistics.lines().map(line).collect(),
        messages: statistics.rows().map(message).collect(),
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

fn name(decoder: Option<&Decoder>, line: u32, id: u32) -> String {
    let Some(decoder) = decoder else { return String::new() };
    if id & ERROR != 0 {
        return "error frame".into();
    }
    let layout = decoder.layout();
    let node = decoder.owners.nodes(layout, line, id).next();
    let message = node.and_then(|node| layout.find(node as u32, id));
    message.map_or_else(|| "unknown".into(), |i| layout.messages[i].name.clone())
}

fn table(r: &Report) -> String {
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
    for l in &r.lines {
        let load = l.load.map_or("-".into(), |load| format!("{:.1} %", 100.0 * load));
        text += &format!(
            "{:12} {:>8} frames, {} bytes, {} error frames, bus load {load}\n",
            l.interface, l.frames, l.bytes, l.error_frames
        );
    }
    text.trim_end().to_owned()
}
