//! `gangwerk faults`: the command around [`cli::faults`].

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use cli::faults::{self, FaultVerdict, FaultsOptions};

/// Random kills and stops of `--long`.
const LONG: &str = "1000";

#[derive(clap::Args)]
pub(crate) struct FaultTableArguments {
    /// Seed of all instants.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only these faults, for example: F3,F22
    #[arg(long, value_name = "FAULTS", value_delimiter = ',')]
    only: Vec<String>,
    /// Random kills and stops instead, so many.
    #[arg(long, value_name = "COUNT", num_args = 0..=1, default_missing_value = LONG, conflicts_with = "only")]
    long: Option<u32>,
    /// Write the table as JSON, too.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the table into the section of this document that is made for it, for example docs/safety.md.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

/// Marks between which the table stands in a document.
const MARKS: [&str; 2] = ["<!-- faults -->\n", "<!-- /faults -->"];

pub(crate) fn run(arguments: &FaultTableArguments) -> Result<ExitCode, Box<dyn Error>> {
    let exe = std::env::current_exe()?.display().to_string();
    println!("seed {}", arguments.seed);
    let red = match arguments.long {
        Some(count) => long(&exe, arguments.seed, count),
        None => table(arguments, exe)?,
    };
    Ok(if red == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn table(arguments: &FaultTableArguments, exe: String) -> Result<usize, Box<dyn Error>> {
    let order = FaultsOptions { exe, seed: arguments.seed, only: arguments.only.clone() };
    let rows = faults::run(&order, |row| println!("{}", faults::line(row)))?;
    let of = |verdict| rows.iter().filter(|row| row.verdict == verdict).count();
    let red = of(FaultVerdict::NotMet);
    println!(
        "{} met, {red} not met, {} not tried at a robot",
        of(FaultVerdict::Met),
        of(FaultVerdict::NotApplicable)
    );
    if let Some(file) = &arguments.json {
        std::fs::write(file, serde_json::to_string_pretty(&rows)?)?;
    }
    if let Some(file) = &arguments.markdown {
        let text = std::fs::read_to_string(file)?;
        let parts =
            text.split_once(MARKS[0]).and_then(|(before, rest)| Some((before, rest.split_once(MARKS[1])?.1)));
        let (before, after) = parts.ok_or_else(|| format!("{}: has no {:?}", file.display(), MARKS))?;
        std::fs::write(file, [before, MARKS[0], &faults::markdown(&rows), MARKS[1], after].concat())?;
    }
    Ok(red)
}

fn long(exe: &str, seed: u64, count: u32) -> usize {
    let mut red = 0;
    for (n, trial) in (1..).zip(faults::long(exe, seed, count)) {
        let verdict = if trial.wrong.is_empty() {
            "met".into()
        } else {
            format!("NOT MET: {}", trial.wrong.join("; "))
        };
        println!("{n:4} of {count}: {} → {verdict}", trial.what);
        red += usize::from(!trial.wrong.is_empty());
    }
    println!("{count} trials, {red} not met");
    red
}
