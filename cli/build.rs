//! The commit that the command is built from, for logs: `GANGWERK_COMMIT`.

use std::io::Write;
use std::process::Command;

fn main() -> std::io::Result<()> {
    let git = |arguments: &[&str]| {
        let done = Command::new("git").args(arguments).output().ok().filter(|done| done.status.success())?;
        Some(String::from_utf8_lossy(&done.stdout).trim().to_owned())
    };
    // Without git, or outside of a clone, nobody knows.
    let commit = git(&["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]).unwrap_or_default();
    let mut cargo = std::io::stdout();
    writeln!(cargo, "cargo::rustc-env=GANGWERK_COMMIT={commit}")?;
    for file in ["HEAD", "logs/HEAD"].iter().filter_map(|name| git(&["rev-parse", "--git-path", name])) {
        writeln!(cargo, "cargo::rerun-if-changed={file}")?;
    }
    writeln!(cargo, "cargo::rerun-if-changed=build.rs")
}
