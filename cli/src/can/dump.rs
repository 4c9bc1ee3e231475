//! `gangwerk can dump`: frames as text, and what they carry.

use std::error::Error;
use std::path::Path;

use fieldbus::candump_line;
use fieldbus::capture::Captured;

use super::dictionary::{Dictionary, Meaning, Source};
use super::{Only, file, source};

/// Output options.
#[derive(clap::Args)]
pub struct DumpOptions {
    /// A recording, or interfaces: can0 or can0,can1 or vcan0-8.
    pub source: String,
    /// Whose frames these are.
    #[command(flatten)]
    pub words: Source,
    /// Only one direction; needs --robot.
    #[arg(long, requires = "robot")]
    pub only: Option<Only>,
    /// End after this time, in s; interfaces only.
    #[arg(long, value_name = "S", value_parser = source::seconds)]
    pub seconds: Option<f64>,
    /// Leave broken lines out, and tell how many.
    #[arg(long)]
    pub lenient: bool,
}

/// Prints frames.
///
/// # Errors
/// The source cannot be read.
pub fn run(config: &Path, order: &DumpOptions) -> Result<(), Box<dyn Error>> {
    let dictionary = order.words.load(config)?;
    let mut page = Page { dictionary, only: order.only, unknown: 0, wrong_length: 0 };
    if source::is_file(&order.source) {
        let capture = file::read(Path::new(&order.source), order.lenient)?;
        if let Some(dictionary) = &mut page.dictionary {
            capture.frames.iter().for_each(|frame| dictionary.learn(frame));
        }
        capture.frames.iter().for_each(|frame| page.print(&capture.lines[frame.line as usize], frame));
    } else {
        let names = source::names(&order.source)?;
        source::listen(&names, order.seconds, |frame| {
            if let Some(frame) = frame {
                if let Some(dictionary) = &mut page.dictionary {
                    dictionary.learn(frame);
                }
                page.print(&names[frame.line as usize], frame);
            }
            Ok(())
        })?;
    }
    if page.unknown + page.wrong_length > 0 {
        eprintln!(
            "{} frames with identifiers that the DBC file does not know, {} of another length than their message",
            page.unknown, page.wrong_length
        );
    }
    Ok(())
}

struct Page {
    dictionary: Option<Dictionary>,
    only: Option<Only>,
    unknown: u64,
    wrong_length: u64,
}

impl Page {
    fn print(&mut self, name: &str, frame: &Captured) {
        let mut text = String::new();
        candump_line::write(&mut text, name, 0, frame);
        let Some(dictionary) = &self.dictionary else { return println!("{text}") };
        if !dictionary.goes(frame, self.only) {
            return;
        }
        if frame.is_error() {
            return println!("{text}  error frame");
        }
        match dictionary.meaning(frame) {
            Meaning::Unknown => {
                self.unknown += 1;
                println!("{text}  unknown");
            }
            Meaning::WrongLength(name, len) => {
                self.wrong_length += 1;
                println!("{text}  {name}: {} bytes, but its message has {len}", frame.len);
            }
            Meaning::Known(name, signals) => println!("{text}  {name}\n{}", signals.trim_end()),
        }
    }
}
