//! Scenes by name or by path, and all that a configuration has.

use std::path::{Path, PathBuf};

use crate::Scene;
use crate::error::ConfigError;
use crate::file;

/// Name of a scene, and the scene or what is wrong with its file.
pub(crate) type Listed = (String, Result<Scene, ConfigError>);

/// Name of the scene that somebody asks for by name or by path: that of the file, without its ending.
pub fn name(asked: &str) -> String {
    match path(asked) {
        Some(path) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        None => asked.trim_end_matches(".toml").to_owned(),
    }
}

/// The file of a scene that is asked for by its path: with a slash, or with an ending in the working directory.
fn path(asked: &str) -> Option<&Path> {
    let path = Path::new(asked);
    (asked.contains('/') || asked.ends_with(".toml") && path.is_file()).then_some(path)
}

/// The file of a scene: the one asked for by its path, or the one of that name in `root`.
///
/// # Errors
/// There is no scene of that name; which are near.
pub(crate) fn locate(root: &Path, asked: &str) -> Result<PathBuf, ConfigError> {
    if let Some(path) = path(asked) {
        return Ok(path.into());
    }
    let (directory, name) = (root.join("scenes"), name(asked));
    let file = directory.join(format!("{name}.toml"));
    match file::names(&directory, "toml") {
        Some(known) if !known.contains(&name) => {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let text = messages::unknown("scene", &name, &known, "`gangwerk scene list` shows them all");
            Err(ConfigError::of_file(file, text))
        }
        // That there is no such directory is told by who reads the file.
        _ => Ok(file),
    }
}

/// All scenes of the configuration directory `root`, in alphabetical order; one that is wrong with what is wrong.
///
/// # Errors
/// There is no directory of scenes.
pub fn list(root: &Path) -> Result<Vec<Listed>, ConfigError> {
    let directory = root.join("scenes");
    let names = file::names(&directory, "toml").ok_or_else(|| {
        ConfigError::of_file(
            &directory,
            "there is no such directory; check --config, or `gangwerk config where`",
        )
    })?;
    let load = |name: String| {
        let scene = Scene::load(&directory.join(format!("{name}.toml")));
        (name, scene)
    };
    Ok(names.into_iter().map(load).collect())
}

/// Puts a scene that was asked for by its path into `copy`, a copy of a configuration, under its name.
///
/// # Errors
/// It cannot be read or written.
pub fn add(asked: &str, copy: &Path) -> Result<(), ConfigError> {
    let Some(from) = path(asked) else { return Ok(()) };
    let to = copy.join("scenes").join(format!("{}.toml", name(asked)));
    let copied = std::fs::copy(from, &to).map(|_| ());
    copied.map_err(|e| ConfigError::of_file(from, format!("cannot be copied for the run: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Setup;

    /// A path was taken for a name: `.../scenes/config/scenes/demo.toml`.
    #[test]
    fn a_scene_goes_by_its_name_or_by_its_path() {
        let place = std::env::temp_dir().join(format!("gangwerk-scenes-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&place);
        std::fs::create_dir(&place).unwrap();
        let root = crate::root(None);
        let file = place.join("mine.toml");
        // One with a mesh, which lies in the configuration and not beside the scene.
        std::fs::copy(root.join("scenes/stairs.toml"), &file).unwrap();
        let asked = file.display().to_string();
        assert_eq!(
            (name(&asked), name("demo"), name("demo.toml")),
            ("mine".into(), "demo".into(), "demo".into())
        );
        let (by_path, by_name) = (Setup::load(&root, &asked).unwrap(), Setup::load(&root, "stairs").unwrap());
        assert_eq!((by_path.hash, by_path.scene.name.as_str()), (by_name.hash, "mine"));
        // A run reads its copy: the same configuration under the scene's name.
        let copy = place.join("copy");
        crate::snapshot(&root, &copy).unwrap();
        add(&asked, &copy).unwrap();
        let copied = Setup::load(&copy, "mine").unwrap();
        assert_eq!(copied.hash, by_path.hash);
        assert_eq!(copied.files, by_path.files, "a log holds it under names of the configuration");
        std::fs::remove_dir_all(place).unwrap();
    }

    #[test]
    fn a_wrong_name_is_answered_with_the_nearest() {
        let text = Setup::load(&crate::root(None), "walk_60").unwrap_err().to_string();
        assert!(
            text.ends_with(
                "there is no scene `walk_60`; did you mean walk_60s? `gangwerk scene list` shows them all"
            ),
            "{text}"
        );
    }

    #[test]
    fn all_scenes_are_listed_with_what_they_show() {
        let all = list(&crate::root(None)).unwrap();
        assert!(all.len() > 30 && all.is_sorted_by(|a, b| a.0 < b.0));
        assert!(all.iter().all(|(_, scene)| scene.as_ref().is_ok_and(|s| !s.about.is_empty())));
    }
}
