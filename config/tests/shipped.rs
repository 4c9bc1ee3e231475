//! Every file that is shipped can be read.

use config::{Gait, Robot, Setup, System};

fn root() -> std::path::PathBuf {
    config::root(None)
}

/// Names of all entries of a directory, without extensions.
fn names(directory: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join(directory)).unwrap();
    entries.map(|e| e.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned()).collect()
}

#[test]
fn scenes() {
    let all = names("scenes");
    for name in &all {
        Setup::load(&root(), name).unwrap_or_else(|e| panic!("{e}"));
    }
    for name in
        ["demo", "stand", "walk_1kmh", "walk_2kmh", "walk_sideways", "walk_curve", "push", "johnnie_2kmh"]
    {
        assert!(all.iter().any(|n| n == name), "{name} is missing");
    }
}

#[test]
fn robots_gaits_and_system() {
    for name in names("robots") {
        Robot::load(&root().join("robots").join(name)).unwrap_or_else(|e| panic!("{e}"));
    }
    for name in names("gaits") {
        Gait::load(&root().join("gaits").join(name).with_extension("toml")).unwrap_or_else(|e| panic!("{e}"));
    }
    let system = System::load(&root().join("system.toml")).unwrap_or_else(|e| panic!("{e}"));
    assert!(system.processes.iter().map(|row| row.process).eq(messages::Process::ALL));
}
