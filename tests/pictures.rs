//! The pictures of the documentation are those of today's robot, but for a few pixels.

use harness::{Site, root};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const EXE: &str = harness::executable!();

/// Share of the pixels that may differ: edges of curves on another machine. A curve that moved by two pixels is ten times
/// as much.
const SAME: f64 = 2e-4;

/// Pictures that `docs/pictures/make` does not make: with processor times, minutes of work, or of a browser.
const BY_HAND: [&str; 11] = [
    "archie_margins.png",
    "chapter8_sideways.png",
    "dashboard_plot.png",
    "dashboard_steer.png",
    "exploration.png",
    "joint_control.png",
    "push_bound.png",
    "rerun.png",
    "sweep_push.png",
    "tables.png",
    "tune_gait.png",
];

#[test]
fn pictures_of_the_documentation_are_those_of_todays_robot() {
    let site = Site::new(EXE);
    let (made, shipped) = (site.path("pictures"), root().join("docs/pictures"));
    std::fs::create_dir(&made).unwrap();
    let said = Command::new(shipped.join("make")).arg(&made).env("GANGWERK", EXE).output().unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stdout));
    let mut wrong = Vec::new();
    let mut unseen: BTreeSet<_> = names(&shipped).filter(|name| !BY_HAND.contains(&name.as_str())).collect();
    for name in names(&made) {
        unseen.remove(&name);
        match drawing::difference(&made.join(&name), &shipped.join(&name)) {
            Ok(share) if share <= SAME => {}
            Ok(share) => wrong.push(format!("{name}: {:.3} % of the pixels", 100.0 * share)),
            Err(text) => wrong.push(text),
        }
    }
    assert!(wrong.is_empty(), "look at them, then docs/pictures/make: {wrong:#?}");
    assert!(unseen.is_empty(), "nobody makes {unseen:?}: docs/pictures/make, or the list here");
}

fn names(folder: &Path) -> impl Iterator<Item = String> {
    let names =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".png"))
}
