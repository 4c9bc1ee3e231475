//! `gangwerk sweep`: arguments, progress with the time left, and where rows come from.

use std::error::Error;
use std::io::{stdin, stdout};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressStyle};
use studies::Given;
use studies::sweep::{SweepOrder, collect, piece, run};

use crate::study::{SheetForm, print};

pub(super) const HELP: &str = "\
Rows go to rows.tsv as they come; who is interrupted starts the same command again, and it goes on. At the end stand
table.parquet and, if the file has [map], maps.png. On many machines: python3 -m gangwerk.sweep --help.

  gangwerk sweep config/sweeps/push.toml --out runs/push";

/// The arguments.
#[derive(clap::Args)]
pub(super) struct SweepArguments {
    /// A sweep file, for example config/sweeps/push.toml: docs/sweeps.md.
    file: PathBuf,
    /// Directory of rows, table and maps.
    #[arg(long, value_name = "DIR", default_value = "runs/sweep")]
    out: PathBuf,
    /// Walks at a time; default: one on each core.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    cores: Option<u16>,
    /// Only these walks, on one core, as lines on standard output; for who walks a part of it elsewhere.
    #[arg(long, value_name = "FROM..TO", value_parser = walks, requires = "identity", conflicts_with = "collect")]
    walks: Option<Range<u64>>,
    /// Identity of the sweep as it was begun; another one is refused.
    #[arg(long, value_name = "TEXT", requires = "walks")]
    identity: Option<String>,
    /// Rows come from standard input; identity and the walks that are left are told first, as a line of JSON.
    #[arg(long)]
    collect: bool,
    #[command(flatten)]
    form: SheetForm,
}

fn walks(text: &str) -> Result<Range<u64>, String> {
    let ends = text.split_once("..").and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    ends.ok_or_else(|| "it takes two whole numbers, as in 0..100".into())
}

/// Carries out a sweep, or a part of it.
pub(super) fn main(config: &Path, arguments: &SweepArguments) -> Result<ExitCode, Box<dyn Error>> {
    let order = SweepOrder::load(config, &arguments.file, &program()?)?;
    if let (Some(walks), Some(identity)) = (&arguments.walks, &arguments.identity) {
        piece(&order, walks.clone(), identity, &mut stdout().lock())?;
        return Ok(ExitCode::SUCCESS);
    }
    let bar = ProgressBar::new(order.walks());
    bar.set_style(ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}, {eta} left")?);
    // What an earlier start has walked says nothing about the time that the rest takes.
    let begun = std::sync::Once::new();
    let progress = |done: usize, _: usize, what: &str| {
        begun.call_once(|| {
            bar.set_position(done as u64 - 1);
            bar.reset_eta();
            bar.set_message(what.to_owned());
        });
        bar.set_position(done as u64);
    };
    let given = Given { config, progress: &progress };
    let sheet = if arguments.collect {
        collect(&order, &arguments.out, (&mut stdin().lock(), &mut stdout().lock()), &given)
    } else {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        run(&order, &arguments.out, arguments.cores.map_or(all, usize::from), &given)
    };
    bar.finish_and_clear();
    print(&sheet?, &arguments.form);
    Ok(ExitCode::SUCCESS)
}

/// Version and contents of this program: two builds of one version may walk differently.
fn program() -> Result<String, Box<dyn Error>> {
    use std::hash::{DefaultHasher, Hasher};
    let mut hash = DefaultHasher::new();
    hash.write(&std::fs::read(std::env::current_exe()?)?);
    Ok(format!("gangwerk {}, program {:016x}", cli::VERSION, hash.finish()))
}
