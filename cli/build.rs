//! The commit that is built, for `gangwerk -V` and logs; and what makes the set of configuration files in the executable anew.

use std::process::Command;

/// Parts of the configuration that are shipped, as in `src/shipped.rs`: a file that is added is no change of any other.
const SHIPPED: [&str; 7] = ["gaits", "gears", "joystick.toml", "objects", "robots", "scenes", "system.toml"];

fn main() {
    for part in SHIPPED {
        println!("cargo::rerun-if-changed=../config/{part}");
    }
    // Without git, or outside of a clone, nobody knows.
    let git = |arguments: &[&str]| {
        let said = Command::new("git").args(arguments).output().ok().filter(|said| said.status.success())?;
        Some(String::from_utf8(said.stdout).ok()?.trim().to_owned())
    };
    for file in ["HEAD", "logs/HEAD"].iter().filter_map(|name| git(&["rev-parse", "--git-path", name])) {
        println!("cargo::rerun-if-changed={file}");
    }
    let commit = git(&["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]).unwrap_or_default();
    let known = if commit.is_empty() { "commit unknown" } else { &commit };
    println!("cargo::rustc-env=GANGWERK_COMMIT={commit}");
    println!("cargo::rustc-env=GANGWERK_VERSION={} ({known})", env!("CARGO_PKG_VERSION"));
}
