//! What is wrong with a `[pattern]` is said once: file, key, value and what the key takes.

use std::path::PathBuf;

use config::{Gait, Setup};

/// The shipped pattern.
fn shipped() -> String {
    std::fs::read_to_string(config::root(None).join("gaits/archie_static.toml")).unwrap()
}

/// With another value of a key, or none; a key that is not there is added.
fn with(text: &str, key: &str, value: Option<&str>) -> String {
    let is = |line: &&str| line.starts_with(&format!("{key} = "));
    let line = value.map(|value| format!("{key} = {value}"));
    let others = text.lines().filter(|line| !is(line)).map(str::to_owned);
    others.chain(line).collect::<Vec<_>>().join("\n")
}

/// What is said of a gait file.
fn said(text: &str, name: &str) -> Result<(), Vec<String>> {
    let file: PathBuf =
        std::env::temp_dir().join(format!("gangwerk-pattern-{name}-{}.toml", std::process::id()));
    std::fs::write(&file, text).unwrap();
    let gait = Gait::load(&file);
    std::fs::remove_file(&file).unwrap();
    gait.map(drop).map_err(|error| {
        assert_eq!(error.file, file);
        error.problems.iter().map(|p| format!("{}: {}", p.key, p.text)).collect()
    })
}

/// No rule between keys fires on top of a key that is wrong by itself.
#[test]
fn each_key_that_is_wrong_is_named_once() {
    let flat = shipped();
    // A foot that rolls has all its times, and a spline its height.
    let rolls = [("q_b", "0.2"), ("T_1", "0.48"), ("T_2", "11.4"), ("T_3", "13.68"), ("T_4", "1.2")];
    let rolls = rolls.iter().fold(flat.clone(), |text, (key, value)| with(&text, key, Some(value)));
    let rolls = with(&with(&rolls, "z_h", Some("\"spline\"")), "H_0", Some("0.542"));
    assert_eq!((said(&flat, "flat"), said(&rolls, "rolls")), (Ok(()), Ok(())));
    let keys = |text: &str| -> Vec<String> {
        let key = |line: &str| Some(line.split_once(" = ")?.0.to_owned()).filter(|key| !key.contains('#'));
        text.lines().filter_map(key).collect()
    };
    assert_eq!((keys(&flat).len(), keys(&rolls).len()), (20, 25));
    for (name, text) in [("flat", &flat), ("rolls", &rolls)] {
        for key in keys(text) {
            // T_4 follows from the others, and need not be there.
            let missing = (key != "T_4").then_some((None, "missing; it takes"));
            let wrong =
                ["nan", "inf", "-inf", "-1e9", "1e12", "true", "[1.0]"].map(|v| (Some(v), "it takes"));
            for (value, words) in wrong.into_iter().chain(missing) {
                let problems = said(&with(text, &key, value), name).expect_err(&key);
                assert_eq!(problems.len(), 1, "{key} = {value:?}: {problems:?}");
                let problem = &problems[0];
                assert!(
                    problem.starts_with(&format!("pattern.{key}: ")) && problem.contains(words),
                    "{value:?}: {problem}"
                );
            }
        }
    }
}

/// A word that is empty is not the first of those that are known.
#[test]
fn an_empty_word_is_none_of_the_known_ones() {
    for (key, words) in [("x_h", "`linear`, `spline`"), ("z_h", "`quintic`, `spline`")] {
        let problems = said(&with(&shipped(), key, Some("\"\"")), key).unwrap_err();
        assert_eq!(problems, [format!("pattern.{key}: `` is not known; it takes one of {words}")]);
    }
}

/// A scene whose walk would turn, or go aside or back, is refused when it is loaded: a pattern goes straight on.
#[test]
fn a_velocity_that_a_pattern_cannot_do_is_named_when_the_scene_is_loaded() {
    let (root, name) = (config::root(None), "archie_static");
    let scene = std::fs::read_to_string(root.join("scenes/archie_static.toml")).unwrap();
    for (velocity, words) in [
        ("forward = 0.02\nturn = 0.005", "turn = 0.005 lies outside of [0, 0] rad/s"),
        ("forward = 0.02\nleft = -0.01", "left = -0.01 lies outside of [0, 0] m/s"),
        ("forward = -0.01", "forward = -0.01 lies outside of [0, "),
        ("forward = 0.03", "forward = 0.03 is beyond by_speed's 0.0208"),
    ] {
        let file = std::env::temp_dir().join(format!("gangwerk-velocity-{}.toml", std::process::id()));
        std::fs::write(&file, scene.replace("forward = 0.0208", velocity)).unwrap();
        let refused = Setup::load(&root, file.to_str().unwrap()).map(drop).unwrap_err().to_string();
        std::fs::remove_file(&file).unwrap();
        let said = format!("command[1]: at 3 s: {words}");
        assert!(refused.contains(&said) && refused.ends_with(&format!("of gait {name}")), "{refused}");
    }
}
