//! The pictures of the documentation are those of today's robot, but for a few pixels.

use harness::{Site, root};
use std::process::Command;

const EXE: &str = harness::executable!();

/// Share of the pixels that may differ: edges of curves on another machine. A curve that moved by two pixels is ten times
/// as much.
const SAME: f64 = 2e-4;

#[test]
fn pictures_of_the_documentation_are_those_of_todays_robot() {
    let site = Site::new(EXE);
    let (made, shipped) = (site.path("pictures"), root().join("docs/pictures"));
    std::fs::create_dir(&made).unwrap();
    let said = Command::new(shipped.join("make")).arg(&made).env("GANGWERK", EXE).output().unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stdout));
    let mut wrong = Vec::new();
    let mut count = 0;
    for entry in std::fs::read_dir(&made).unwrap() {
        let name = entry.unwrap().file_name();
        count += 1;
        match drawing::difference(&made.join(&name), &shipped.join(&name)) {
            Ok(share) if share <= SAME => {}
            Ok(share) => wrong.push(format!("{}: {:.3} % of the pixels", name.display(), 100.0 * share)),
            Err(text) => wrong.push(text),
        }
    }
    assert!(count > 0 && wrong.is_empty(), "look at them, then docs/pictures/make: {wrong:#?}");
}
