//! `gangwerk scorecard`: walks everything, with progress on standard error, and draws what the thesis draws.

use std::error::Error;
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use studies::Sheet;
pub use studies::scorecard::ScorecardOptions;
use studies::scorecard::{pictured, run};

/// Walks what is ordered and prints the table, or one JSON object; with `out` both go there as files as well, and logs and
/// pictures of the walks of which the thesis has pictures.
///
/// # Errors
/// A configuration is wrong, no entry has the name asked for, or a file cannot be written.
pub fn main(order: &ScorecardOptions<'_>, json: bool, out: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let bar = ProgressBar::new(0).with_style(ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}")?);
    let found = run(order, &|done, of, name| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
        bar.set_message(name.to_string());
    })?;
    bar.finish_and_clear();
    let sheet = found.sheet();
    if let Some(out) = out {
        let problem = |e| format!("{}: {e}; choose another place with --out", out.display());
        write(&sheet, out).map_err(problem)?;
        for setup in pictured(order)? {
            let log = out.join(format!("{}.mcap", setup.scene.name));
            crate::sim::run(&setup, None, Some(&log), None, |_| ())?;
            crate::plot::run(&log, &out.join(&setup.scene.name))?;
        }
    }
    println!("{}", if json { sheet.json().to_string() } else { sheet.text() });
    Ok(())
}

fn write(sheet: &Sheet, out: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(out)?;
    std::fs::write(out.join("scorecard.txt"), sheet.text() + "\n")?;
    std::fs::write(out.join("scorecard.json"), format!("{:#}\n", sheet.json()))
}
