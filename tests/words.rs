//! What the command says: sentences with what to do, each once, and an end that is quiet when nobody reads any more.

use harness::{Site, doze, shared_turn, turn};
use messages::topics::SIM_STATE;
use messages::{EventCode, Process, SimState};
use realtime::clock;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};

const EXE: &str = harness::executable!();

/// No name of a code of the program is told to an operator.
#[track_caller]
fn no_codes(text: &str) {
    for code in EventCode::ALL {
        let (name, bare) = (format!("{code:?} ("), format!(": {code:?}"));
        assert!(!text.contains(&name) && !text.lines().any(|l| l.ends_with(&bare)), "{code:?} in: {text}");
    }
}

/// `PowerOff (ResetMissed)` and "reset, enable" stood at the end of every run that was as it should be.
#[test]
fn a_run_that_ends_well_tells_no_fault_and_gives_no_advice() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    site.scene("short", 1.5, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
    let said = site.run("short", &["--lockstep"]).end().well();
    no_codes(&said.err);
    assert!(said.err.contains("watchdog: motor supply on"), "{}", said.err);
    assert!(!said.err.contains("motor supply off"), "{}", said.err);
    // The same sentences in the log.
    let said = site.gangwerk(&["log", "show", &site.path("short.mcap").display().to_string()]).well();
    no_codes(&said.out);
    assert!(
        said.out.contains("watchdog: motor supply on") && said.out.contains("controller: a plan begins"),
        "{}",
        said.out
    );
}

/// A robot fell, and nothing told that the machine was the reason.
#[test]
fn a_machine_that_is_too_slow_is_named_with_how_late_it_was_and_what_to_do() {
    let _turn = turn();
    // The watchdog of the shipped configuration: its limit is what is tried.
    let site = Site::new(EXE);
    site.scene("walk", 8.0, harness::WALK);
    let mut run = site.run("walk", &["--no-log"]);
    let space = run.space();
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    let begun = clock::now();
    while !sim.latest().is_some_and(|s| s.time > 1.0) {
        assert!(run.is_alive() && clock::now() - begun < 30 * clock::SECOND, "{}", run.err());
        doze(0.01);
    }
    run.pause(Process::Lowlevel, 0.2);
    doze(1.0);
    run.interrupt();
    let said = run.end();
    no_codes(&said.err);
    assert!(
        said.err.contains("watchdog: motor supply off: the joint loop was too late for the watchdog;"),
        "{}",
        said.err
    );
    let line = said.err.lines().find(|l| l.starts_with("this machine was too slow for real time"));
    let line = line.unwrap_or_else(|| panic!("{}", said.err));
    let ms: f64 = line.split("up to ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).unwrap();
    assert!((150.0..2000.0).contains(&ms), "{line}");
    assert!(line.contains("--lockstep") && line.contains("gangwerk doctor"), "{line}");
}

/// `gangwerk sim demo | head` ended with a panic and SIGABRT.
#[test]
fn a_command_whose_reader_is_gone_ends_quietly() {
    for arguments in
        [&["sim", "stand", "--json"][..], &["scene", "list"], &["topic", "list"], &["completions", "bash"]]
    {
        // Gone before the command begins: who is quick would have said everything.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = Command::new(EXE);
        command.args(arguments).stdout(writer).stderr(Stdio::piped()).current_dir(harness::root());
        let said = command.spawn().unwrap().wait_with_output().unwrap();
        assert_eq!(said.status.signal(), Some(13), "{arguments:?}: {said:?}");
        assert!(!String::from_utf8_lossy(&said.stderr).contains("panicked"), "{arguments:?}: {said:?}");
    }
}

#[test]
fn shells_and_man_know_the_command() {
    let site = Site::new(EXE);
    for (shell, word) in
        [("bash", "complete -F"), ("zsh", "#compdef gangwerk"), ("fish", "complete -c gangwerk")]
    {
        let said = site.gangwerk(&["completions", shell]).well();
        assert!(
            said.out.contains(word) && said.out.contains("fit-friction"),
            "{shell}: {} bytes",
            said.out.len()
        );
    }
    let pages = site.path("man1");
    site.gangwerk(&["man", &pages.display().to_string()]).well();
    for page in ["gangwerk.1", "gangwerk-run.1", "gangwerk-topic-echo.1"] {
        let text = std::fs::read_to_string(pages.join(page)).unwrap_or_else(|e| panic!("{page}: {e}"));
        assert!(text.starts_with(".ie") && text.contains(".TH "), "{page}: {text}");
    }
    assert!(!pages.join("gangwerk-lowlevel.1").exists(), "processes of a run are no commands");
    let said = Command::new(EXE).arg("-V").output().unwrap();
    let text = String::from_utf8(said.stdout).unwrap();
    assert!(
        text.starts_with("gangwerk 0.1.0 (") && text.trim_end().ends_with(')') && text.len() > 20,
        "{text}"
    );
}
