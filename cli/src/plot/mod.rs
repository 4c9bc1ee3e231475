//! `gangwerk plot LOG`: what a walk looked like, as pictures.
//!
//! Everything is read from the log alone: robot, soles, joint names and link poses are in it.

mod forces;
mod inclination;
mod margin;
mod paths;
mod redundant;
mod strip;
#[cfg(test)]
mod synthetic;
mod tracking;
mod walk;
mod zmp;

use drawing::Figure;
use std::path::{Path, PathBuf};
use walk::WalkData;

/// Pictures drawn.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// PNG files.
    pub written: Vec<PathBuf>,
    /// Pictures the log holds no data for, each with the reason.
    pub skipped: Vec<String>,
}

type Draw = fn(&WalkData) -> Result<Figure, String>;

/// File names, and who draws them.
const PICTURES: [(&str, Draw); 8] = [
    ("inclination.png", inclination::draw),
    ("zmp.png", zmp::draw),
    ("margin.png", margin::draw),
    ("foot_forces.png", forces::draw),
    ("joint_tracking.png", tracking::draw),
    ("redundant_joints.png", redundant::draw),
    ("paths.png", paths::draw),
    ("stick_figures.png", strip::draw),
];

/// Draws all pictures of a log into a directory, which is made if it does not exist.
pub fn run(log: &Path, out: &Path) -> Result<Pictures, String> {
    let walk = WalkData::load(log)?;
    std::fs::create_dir_all(out).map_err(|e| {
        format!("{}: cannot make the directory: {e}; choose another with --out", out.display())
    })?;
    let mut pictures = Pictures::default();
    for (name, draw) in PICTURES {
        // A chart of something that the log does not hold would show nothing but its axes.
        let drawn = draw(&walk).and_then(|figure| match figure.empty_chart() {
            Some(title) => Err(format!("the log holds nothing for \"{title}\"")),
            None => Ok(figure),
        });
        match drawn {
            Ok(figure) => {
                let path = out.join(name);
                figure.save(&path)?;
                pictures.written.push(path);
            }
            Err(why) => pictures.skipped.push(format!("{name}: {why}")),
        }
    }
    Ok(pictures)
}

#[cfg(test)]
mod tests {
    use super::*;
    use synthetic::LogPart;

    fn directory(name: &str) -> PathBuf {
        let directory = std::env::temp_dir().join(format!("gangwerk-plot-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&directory).expect("temporary directory");
        directory
    }

    #[test]
    fn a_walk_gives_all_pictures() {
        let out = directory("walk");
        let log = out.join("walk.mcap");
        synthetic::write(&log, &[]);
        let pictures = run(&log, &out).expect("pictures");
        assert_eq!(pictures.skipped, Vec::<String>::new());
        assert_eq!(pictures.written.len(), PICTURES.len());
        for path in pictures.written {
            let bytes = std::fs::read(&path).expect("picture");
            assert!(
                bytes.starts_with(b"\x89PNG") && bytes.len() > 20_000,
                "{}: {}",
                path.display(),
                bytes.len()
            );
        }
        std::fs::remove_dir_all(out).expect("temporary directory");
    }

    #[test]
    fn a_log_without_links_has_no_stick_figures() {
        let out = directory("no-links");
        let log = out.join("walk.mcap");
        synthetic::write(&log, &[LogPart::Links]);
        let pictures = run(&log, &out).expect("pictures");
        assert_eq!(pictures.skipped.len(), 1);
        assert!(pictures.skipped[0].starts_with("stick_figures.png: "), "{:?}", pictures.skipped);
        std::fs::remove_dir_all(out).expect("temporary directory");
    }

    /// A real robot's log knows no truth, and has all pictures; a scene of type 1 has no tracking errors: a sentence instead of
    /// an empty chart.
    #[test]
    fn what_a_log_does_not_hold_is_said_and_not_drawn() {
        let out = directory("parts");
        let log = out.join("walk.mcap");
        for (part, names) in [
            (LogPart::Truth, &[][..]),
            (LogPart::Tracking, &["joint_tracking.png: every joint is where its target is"]),
            (LogPart::Sensors, &["foot_forces.png: ", "redundant_joints.png: ", "stick_figures.png: "]),
            (LogPart::Margin, &["margin.png: no foot ever carries load"]),
            (LogPart::Inclination, &["inclination.png: the log holds nothing for \"φ_x"]),
        ] {
            synthetic::write(&log, &[part]);
            let pictures = run(&log, &out).expect("pictures");
            assert_eq!(pictures.skipped.len(), names.len(), "{part:?}: {:?}", pictures.skipped);
            for (said, wanted) in pictures.skipped.iter().zip(names) {
                assert!(said.starts_with(wanted), "{part:?}: {said}");
            }
        }
        std::fs::remove_dir_all(out).expect("temporary directory");
    }

    #[test]
    fn what_is_not_a_log_is_named() {
        let out = directory("not-a-log");
        let log = out.join("walk.csv");
        std::fs::write(&log, "t,x\n0,1\n").expect("file");
        let error = run(&log, &out).unwrap_err();
        assert!(error.contains("walk.csv") && error.contains("not an MCAP file"), "{error}");
        std::fs::remove_dir_all(out).expect("temporary directory");
    }
}
