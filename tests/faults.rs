//! `gangwerk faults` in small: a few faults. That a robot which does not react is a red line: `cli/src/faults/mod.rs`.

use harness::turn;
use std::process::Command;

const EXE: &str = harness::executable!();

fn faults(arguments: &[&str]) -> (Option<i32>, String) {
    let done = Command::new(EXE).arg("faults").args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr);
    println!("{said}");
    (done.status.code(), said)
}

#[test]
fn a_few_faults_are_met() {
    let _turn = turn();
    let (code, said) = faults(&["--seed", "7", "--only", "F2,F4,F9,F15,F16,F17,F22,F34,F39"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("8 met, 0 not met, 1 not tried at a robot"), "{said}");
}

#[test]
fn a_fault_that_there_is_not_is_an_error() {
    let (code, said) = faults(&["--only", "F41"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("there is no fault F41"), "{said}");
}

/// The table of docs/safety.md has every fault.
#[test]
fn the_page_has_every_fault() {
    let page = std::fs::read_to_string(harness::root().join("docs/safety.md")).unwrap();
    for n in 1..=40 {
        assert!(page.contains(&format!("| F{n} |")), "F{n}: gangwerk faults --markdown docs/safety.md");
    }
}
