//! `gangwerk console`: an interactive Python shell with a client of the running robot.

use std::error::Error;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Command, Stdio};

#[derive(clap::Args)]
pub(crate) struct ConsoleArguments {
    /// Run directory of the robot.
    #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
    dir: PathBuf,
    /// Run this Python code instead of a shell, and end.
    #[arg(short, value_name = "CODE")]
    code: Option<String>,
    /// Python interpreter in which the package gangwerk is installed.
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    python: PathBuf,
}

/// Becomes `python3 -m gangwerk.console`.
///
/// # Errors
/// Python or the package is not there; what to install.
pub(crate) fn run(arguments: &ConsoleArguments) -> Result<(), Box<dyn Error>> {
    let ConsoleArguments { dir, code, python } = arguments;
    let name = python.display();
    // Looked for by Python itself: it may be installed in many places.
    let look = "import importlib.util as u, sys; sys.exit(u.find_spec('gangwerk') is None)";
    let found = Command::new(python).args(["-c", look]).stdin(Stdio::null()).status();
    let found = found.map_err(|e| {
        format!("{name} cannot be started: {e}; install Python 3.9 or newer, or name one with --python")
    })?;
    if !found.success() {
        return Err(format!(
            "{name} has no package gangwerk: `{name} -m pip install ./python` in the source tree builds and installs it"
        )
        .into());
    }
    let mut shell = Command::new(python);
    shell.args(["-m", "gangwerk.console", "--dir"]).arg(dir);
    if let Some(code) = code {
        shell.arg("-c").arg(code);
    }
    Err(format!("{name} cannot be started: {}", shell.exec()).into())
}
