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

/// Another text of the gait's file, as if it had been read: the same text is the same configuration.
#[test]
fn gaits_of_another_text() {
    for name in names("scenes") {
        let setup = Setup::load(&root(), &name).unwrap();
        let text = setup.gait_file().1.to_owned();
        let same = setup.clone().with_gait(&text).unwrap();
        assert_eq!((same.hash, &same.files), (setup.hash, &setup.files), "{name}");
        let other = setup.clone().with_gait(&format!("{text}\n")).unwrap();
        assert!(other.hash != setup.hash && other.gait_file().1.len() == text.len() + 1, "{name}");
        let error = setup.clone().with_gait(&format!("{text}\nwaddle = 1\n")).unwrap_err().to_string();
        let file = format!("gaits/{}.toml: line ", setup.scene.gait);
        assert!(error.starts_with(&file) && error.contains("waddle"), "{name}: {error}");
    }
}
