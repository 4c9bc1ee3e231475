//! `gangwerk estop`: the emergency stop, with nothing in its way: no command line parser, no configuration, no shared memory, no
//! broker. It asks the watchdog's own thread, over its own socket, and waits for the answer that the supply is off.

use std::ffi::{OsStr, OsString};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use ipc::StopName;

pub use watchdog::stop_request::{StopOutcome, Stopped, stop};

/// Help, which is printed before the command line is parsed.
pub const HELP: &str = "\
Emergency stop: cuts the motor supply of a robot, and says when it was off.

Usage: gangwerk estop [--all | --dir DIR]

Without options: your robot in the default run directory; if there is none, or it does not say that its supply is off, every
robot on this machine. The same with options that are not understood.
  --all      every robot on this machine, whoever runs it
  --dir DIR  the robot that runs there
Exit codes:
  0  the supply of every robot that was asked is off
  1  somebody did not answer, or there is no robot";

/// `gangwerk estop`, if that is what was called: to be asked before anything else is done.
pub fn main(arguments: impl Iterator<Item = OsString>) -> Option<ExitCode> {
    behind_estop(arguments.skip(1)).map(run)
}

/// Arguments behind `estop`; none: it was not called. The option of all commands, `--config`, may stand before it.
fn behind_estop(mut arguments: impl Iterator<Item = OsString>) -> Option<impl Iterator<Item = OsString>> {
    loop {
        match arguments.next()?.as_bytes() {
            b"estop" => return Some(arguments),
            b"--config" => drop(arguments.next()?),
            other if other.starts_with(b"--config=") => {}
            _ => return None,
        }
    }
}

/// The stop, with the arguments that follow `estop`.
pub fn run(arguments: impl Iterator<Item = OsString>) -> ExitCode {
    let wish = StopWish::of(arguments);
    if wish.help {
        println!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let listed = StopName::all();
    let unlisted = listed.as_ref().err().map(io::Error::to_string);
    let stopped = wish.press(listed.ok(), stop);
    // Said only now: a terminal that takes nothing keeps no stop from being sent.
    report(&stopped).iter().for_each(|line| println!("{line}"));
    for argument in &wish.strange {
        eprintln!("estop: {} is not understood: every robot was meant", argument.display());
    }
    if let Some(error) = unlisted {
        eprintln!("estop: /proc/net/unix: {error}: only robots whose name is known without it were asked");
    }
    if stopped.is_empty() {
        eprintln!(
            "error: no robot runs on this machine; one in a container or on another machine is stopped there"
        );
    }
    if !stopped.is_empty() && stopped.iter().all(is_off) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn is_off(stopped: &Stopped) -> bool {
    matches!(stopped.outcome, StopOutcome::Off { .. })
}

/// Wish of the command line.
#[derive(Debug, Default, PartialEq, Eq)]
struct StopWish {
    help: bool,
    all: bool,
    dir: Option<PathBuf>,
    /// Arguments that are not understood: then every robot is meant, rather than a wrong one.
    strange: Vec<OsString>,
}

impl StopWish {
    fn of(mut arguments: impl Iterator<Item = OsString>) -> Self {
        let mut wish = Self::default();
        while let Some(argument) = arguments.next() {
            let dir = match argument.as_bytes() {
                b"--all" => {
                    wish.all = true;
                    continue;
                }
                b"--help" | b"-h" => {
                    wish.help = true;
                    continue;
                }
                b"--config" => {
                    arguments.next();
                    continue;
                }
                other if other.starts_with(b"--config=") => continue,
                b"--dir" => arguments.next(),
                other => other.strip_prefix(b"--dir=").map(|dir| OsStr::from_bytes(dir).to_owned()),
            };
            match dir.filter(|dir| !dir.is_empty() && !dir.as_bytes().starts_with(b"-")) {
                Some(dir) if wish.dir.is_none() => wish.dir = Some(dir.into()),
                _ => wish.strange.push(argument),
            }
        }
        wish
    }

    /// Stops who is meant, of the robots that run; none: nobody knows which do.
    fn press(
        &self,
        running: Option<Vec<StopName>>,
        stop: impl Fn(&[StopName]) -> Vec<Stopped>,
    ) -> Vec<Stopped> {
        let here = self.dir.clone().unwrap_or_else(ipc::default_dir);
        // Without a list there are still the names that can be computed.
        let running = running.unwrap_or_else(|| named(&here));
        if self.all || !self.strange.is_empty() {
            return stop(&running);
        }
        let is_meant = |name: &StopName| match &self.dir {
            Some(dir) => name.is_in(dir),
            None => *name == StopName::own(&here),
        };
        let (meant, others): (Vec<StopName>, Vec<StopName>) = running.into_iter().partition(is_meant);
        if self.dir.is_some() {
            return stop(&if meant.is_empty() { named(&here) } else { meant });
        }
        // Anybody can take a name, and hide with it that this user's robot runs elsewhere.
        let mut stopped = stop(&meant);
        if stopped.is_empty() || !stopped.iter().all(is_off) {
            stopped.extend(stop(&others));
        }
        stopped
    }
}

/// Names that the robot in `dir` may have: it is run by this user, or by the owner of the directory.
fn named(dir: &Path) -> Vec<StopName> {
    let mut names = vec![StopName::own(dir)];
    let owners = std::fs::metadata(dir).map(|found| StopName::of(found.uid(), dir));
    if let Ok(owners) = owners
        && owners != names[0]
    {
        names.push(owners);
    }
    names
}

/// Stops the robot that this user runs in `dir`.
pub(crate) fn stop_own(dir: &Path) -> Vec<Stopped> {
    stop(&[StopName::own(dir)])
}

/// One line for each robot.
pub fn report(stopped: &[Stopped]) -> Vec<String> {
    let line = |s: &Stopped| format!("{} (user {}): {}", s.name.dir(), s.name.uid, s.outcome);
    stopped.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(text: &str) -> Option<StopWish> {
        behind_estop(text.split(' ').map(OsString::from)).map(StopWish::of)
    }

    /// Who is asked, round by round, where the robots of `running` say that they are off and all others say nothing.
    fn pressed(text: &str, running: Option<&[StopName]>, off: &[StopName]) -> Vec<StopName> {
        let answer = |name: &StopName| match off.contains(name) {
            true => StopOutcome::Off { tick: 1, after_ns: None },
            false => StopOutcome::Failed(String::new()),
        };
        let stop = |names: &[StopName]| -> Vec<Stopped> {
            names.iter().map(|name| Stopped { name: name.clone(), outcome: answer(name) }).collect()
        };
        let stopped = wish(text).unwrap().press(running.map(<[_]>::to_vec), stop);
        stopped.into_iter().map(|s| s.name).collect()
    }

    /// `--dir=X` stopped the robot in the default directory, and `--config DIR estop` none, without a word.
    #[test]
    fn every_spelling_of_the_command_line_means_the_same_robot() {
        let dir = |text: &str| Some(StopWish { dir: Some(text.into()), ..StopWish::default() });
        for text in [
            "estop --dir x",
            "estop --dir=x",
            "--config c estop --dir x",
            "--config=c estop --dir x --config d",
        ] {
            assert_eq!(wish(text), dir("x"), "{text}");
        }
        assert_eq!(wish("--config c estop"), Some(StopWish::default()));
        assert!(
            ["run estop", "log show estop", "--config estop", "--config"]
                .iter()
                .all(|text| wish(text).is_none())
        );
    }

    #[test]
    fn what_is_not_understood_means_every_robot() {
        let running = [StopName::of(1, Path::new("/a")), StopName::of(2, Path::new("/b"))];
        for text in ["--al", "--dir", "--dir=", "--dir --all", "--dir /a --dir /b", "--dir /a now", "--all"] {
            assert_eq!(pressed(&format!("estop {text}"), Some(&running), &running), running, "{text}");
        }
        assert_eq!(pressed("estop --dir /b", Some(&running), &running), running[1..]);
    }

    /// A socket of that name, of any user, hid the robot that this user runs in another directory.
    #[test]
    fn a_default_name_that_does_not_say_off_means_every_robot() {
        let (here, there) = (StopName::own(&ipc::default_dir()), StopName::own(Path::new("/there")));
        let running = [there.clone(), here.clone()];
        assert_eq!(pressed("estop", Some(&running), &running), running[1..]);
        assert_eq!(pressed("estop", Some(&running), &running[..1]), [here.clone(), there.clone()]);
        assert_eq!(pressed("estop", Some(&running[..1]), &running), [there]);
    }

    #[test]
    fn without_a_list_the_owner_of_the_directory_is_asked_too() {
        let asked = pressed("estop --dir /proc/1", None, &[]);
        assert!(asked.contains(&StopName::own(Path::new("/proc/1"))), "{asked:?}");
        assert!(
            asked.contains(&StopName::of(std::fs::metadata("/proc/1").unwrap().uid(), Path::new("/proc/1")))
        );
    }
}
