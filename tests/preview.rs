//! `gangwerk preview`: pictures of a pattern, and what it breaks.

use cli::preview::{of_files, preview};
use config::{Gait, Robot};
use std::path::{Path, PathBuf};

fn out(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("preview-{name}"))
}

#[test]
fn a_pattern_is_drawn() {
    let preview =
        of_files(&config::root(None), Path::new("archie_static"), "archie", &out("static")).unwrap();
    assert_eq!((preview.fault, preview.files.len()), (None, 5));
    for file in preview.files {
        assert!(std::fs::metadata(&file).unwrap().len() > 10_000, "{}", file.display());
    }
}

/// Pictures are drawn of a pattern that cannot be walked too, with gaps, and the rule it breaks is named.
#[test]
fn what_cannot_be_walked_is_drawn_and_named() {
    let root = config::root(None);
    let mut pattern = Gait::load(&root.join("gaits/archie_static.toml")).unwrap().pattern.unwrap();
    (pattern.length, pattern.over_length) = (0.30, 0.30);
    let robot = Robot::load(&root.join("robots/archie")).unwrap();
    let drawn = preview(&Gait::from(pattern), &robot, "too long", &out("long")).unwrap();
    let fault = drawn.fault.unwrap().to_string();
    assert!(fault.contains("leg") && fault.contains("s after the begin"), "{fault}");
    assert_eq!(drawn.files.len(), 5);
}

#[test]
fn a_gait_without_a_pattern_is_refused() {
    let refused = of_files(&config::root(None), Path::new("lola"), "lola", &out("lola")).map(|_| ());
    assert_eq!(refused.unwrap_err(), "the gait has no [pattern]; its walks depend on the robot's masses");
}
