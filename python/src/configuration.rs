//! Scenes and robots: those of a configuration directory, found as the command finds it, or the set inside the package.

use std::path::{Path, PathBuf};

use config::method::{Integrator, Method};
use config::{Robot, Setup};
use pyo3::prelude::*;

use crate::arguments::{unknown_name, whole, wrong};

/// Configuration directory: `asked`, else as `gangwerk config where` says.
pub(crate) fn directory(asked: Option<PathBuf>) -> PyResult<PathBuf> {
    config::find(asked.as_deref()).map(|found| found.dir).map_err(wrong)
}

/// Changes to a scene.
#[derive(Default)]
pub(crate) struct SceneChanges<'a, 'py> {
    /// Type of the model.
    pub(crate) depth: Option<&'a Bound<'py, PyAny>>,
    /// Seed of everything random.
    pub(crate) seed: Option<&'a Bound<'py, PyAny>>,
    /// Integrator by its name in scene files.
    pub(crate) integrator: Option<&'a str>,
    /// Steps per cycle.
    pub(crate) substeps: Option<&'a Bound<'py, PyAny>>,
}

impl SceneChanges<'_, '_> {
    /// True if the scene stays as its file has it.
    pub(crate) fn are_none(&self) -> bool {
        self.depth.is_none() && self.seed.is_none() && self.integrator.is_none() && self.substeps.is_none()
    }
}

/// A scene by name or path with all it names, and these changes; of a scene that leaves its depth open the one that
/// `gangwerk sim` chooses.
pub(crate) fn setup(
    py: Python<'_>,
    scene: &str,
    changes: &SceneChanges<'_, '_>,
    directory: &Path,
) -> PyResult<Setup> {
    let asked = [changes.depth, changes.substeps].iter().any(Option::is_some) || changes.integrator.is_some();
    let mut setup = if asked {
        Setup::load(directory, scene).map_err(wrong)?
    } else {
        // An open depth is chosen by trying.
        let chosen =
            py.detach(|| cli::choose::load(directory, scene, false).map_err(|error| error.to_string()));
        chosen.map_err(wrong)?.0
    };
    let mut method = setup.scene.method();
    if let Some(depth) = changes.depth {
        method.depth = whole("depth", depth, [1, 5])? as u8;
    }
    if let Some(word) = changes.integrator {
        let known = Integrator::WORDS.iter().position(|known| *known == word);
        let hint = format!("there are {}", Integrator::WORDS.join(", "));
        let known = known.ok_or_else(|| unknown_name("integrator", word, &Integrator::WORDS, &hint))?;
        method.integrator = Integrator::ALL[known];
    }
    if let Some(substeps) = changes.substeps {
        method.substeps = whole("substeps", substeps, [1, 1000])? as u32;
    }
    if let Some(seed) = changes.seed {
        setup.scene.seed = whole("seed", seed, [0, u64::MAX])?;
    }
    let all = changes.depth.is_some() && changes.integrator.is_some() && changes.substeps.is_some();
    if setup.scene.auto.is_some() && !all {
        let text = "its depth is \"auto\": say depth, integrator and substeps, or none of them";
        return Err(wrong(format!("scene {scene}: {text}")));
    }
    setup.scene.choose(method);
    checked(setup, scene, method)
}

/// The scene with its method, if both fit.
fn checked(setup: Setup, name: &str, method: Method) -> PyResult<Setup> {
    if let Some((key, text)) = setup.scene.components.problem(method.depth, &setup.robot) {
        return Err(wrong(format!("scene {name} with depth = {}: components.{key}: {text}", method.depth)));
    }
    if method.integrator == Integrator::Bdf && setup.scene.tolerance.is_none() {
        let text =
            "needs a tolerance: copy the scene, and say integrator = \"bdf\" and tolerance = 1e-6 there";
        return Err(wrong(format!("integrator = 'bdf': scene {name} {text}")));
    }
    Ok(setup)
}

/// Names of all scenes of a configuration, with what they show; of one that is wrong what is wrong.
pub(crate) fn scenes(directory: &Path) -> PyResult<Vec<(String, String)>> {
    let all = config::scenes::list(directory).map_err(wrong)?;
    let about = |scene: Result<config::Scene, config::ConfigError>| match scene {
        Ok(scene) => scene.about,
        Err(error) => error.to_string(),
    };
    Ok(all.into_iter().map(|(name, scene)| (name, about(scene))).collect())
}

/// A robot of a configuration.
pub(crate) fn robot(name: &str, directory: &Path) -> PyResult<Robot> {
    if name.is_empty() || name.contains(['/', '.']) {
        return Err(wrong(format!(
            "robot = '{name}': must be the name of a folder in config/robots, for example lola"
        )));
    }
    Robot::load(&directory.join("robots").join(name)).map_err(wrong)
}
