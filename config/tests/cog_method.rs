//! The method for the centre of gravity that a gait names.

use std::fs;

use config::gait::CogMethod;
use config::{ConfigError, Gait};

/// The shipped gait of Lola with lines of its own in `[model]`, with obstacles or without.
fn gait(test: &str, lines: &str, obstacles: bool) -> Result<Gait, ConfigError> {
    let text = fs::read_to_string(config::root(None).join("gaits/lola.toml")).unwrap();
    let mut keep = true;
    let mut changed = String::new();
    for line in text.lines() {
        keep = if line.starts_with('[') { obstacles || !line.starts_with("[obstacles]") } else { keep };
        if keep && !(line.starts_with("leg_mass") && lines.contains("leg_mass")) {
            changed += &format!("{line}\n");
        }
        if line.starts_with("[model]") {
            changed += &format!("{lines}\n");
        }
    }
    let file = std::env::temp_dir().join(format!("gangwerk-{test}-{}.toml", std::process::id()));
    fs::write(&file, changed).unwrap();
    let gait = Gait::load(&file);
    fs::remove_file(&file).unwrap();
    gait
}

#[test]
fn a_gait_that_names_none_is_planned_by_collocation() {
    assert_eq!(gait("none", "", true).unwrap().model.cog_method, CogMethod::Collocation);
    let one = "cog_method = \"closed_form\"\nleg_mass = 0.0";
    assert_eq!(gait("closed", one, false).unwrap().model.cog_method, CogMethod::ClosedForm);
}

/// The closed form knows one mass on level ground: whoever wants more of it reads so when the gait is loaded.
#[test]
fn the_closed_form_of_three_masses_or_of_climbing_is_refused() {
    let refused = |test: &str, lines: &str, obstacles| gait(test, lines, obstacles).unwrap_err().to_string();
    let why =
        "cog_method `closed_form` is for one mass at constant height: it wants leg_mass 0 and no [obstacles]";
    let form = "cog_method = \"closed_form\"";
    for (test, lines, obstacles) in
        [("masses", form.to_owned(), false), ("climbing", format!("{form}\nleg_mass = 0.0"), true)]
    {
        let error = refused(test, &lines, obstacles);
        assert!(error.contains(why) && error.matches("cog_method").count() == 1, "{error}");
    }
    let error = refused("word", "cog_method = \"spline\"", true);
    assert!(error.contains("`spline` is not known; it takes one of `collocation`, `closed_form`"), "{error}");
}
