//! Catalogue of the scenes that a page can start: those of the configuration directory, by their names.

use std::path::Path;

use config::Scene;
use serde_json::{Value, json};

use crate::top_view::top_view;

/// Scenes in alphabetical order; of one that is wrong what is wrong with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Catalogue {
    entries: Vec<(String, Value)>,
}

impl Catalogue {
    /// Scenes of the configuration directory `config`.
    ///
    /// # Errors
    /// It has no scenes.
    pub fn read(config: &Path) -> Result<Self, String> {
        let list = config::scenes::list(config).map_err(|e| e.to_string())?;
        let entries = list.into_iter().map(|(name, scene)| {
            let told = match scene {
                Ok(scene) => entry(&name, &scene),
                Err(problem) => Err(problem.to_string()),
            };
            let told = told.unwrap_or_else(|problem| json!({"name": name, "problem": problem}));
            (name, told)
        });
        Ok(Self { entries: entries.collect() })
    }

    /// The message `scenes`.
    pub fn message(&self) -> Value {
        let list: Vec<&Value> = self.entries.iter().map(|(_, told)| told).collect();
        json!({"type": "scenes", "list": list})
    }

    /// Looks up a scene.
    ///
    /// # Errors
    /// There is none of that name; which are near.
    pub fn find(&self, name: &str) -> Result<(), String> {
        let names: Vec<&str> = self.entries.iter().map(|(name, _)| name.as_str()).collect();
        match names.contains(&name) {
            true => Ok(()),
            false => Err(messages::unknown("scene", name, &names, "`gangwerk scene list` shows them all")),
        }
    }
}

fn entry(name: &str, scene: &Scene) -> Result<Value, String> {
    let own = scene.auto.is_none().then_some(scene);
    Ok(json!({
        "name": name, "about": scene.about, "robot": scene.robot, "duration": scene.duration,
        "depth": own.map(|scene| scene.depth), "integrator": own.map(|scene| scene.integrator.word()),
        "view": top_view(scene)?,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_found_and_a_path_or_a_flag_is_not() {
        let catalogue = Catalogue::read(&config::root(None)).unwrap();
        let message = catalogue.message();
        let list = message["list"].as_array().unwrap();
        let scene = |name: &str| list.iter().find(|entry| entry["name"] == name).unwrap();
        assert_eq!((&scene("demo")["depth"], &scene("demo")["integrator"]), (&json!(1), &json!("euler")));
        assert_eq!(scene("walk_auto")["depth"], Value::Null);
        assert!(list.iter().all(|entry| entry["about"].as_str().is_some_and(|about| !about.is_empty())));
        assert_eq!(catalogue.find("demo"), Ok(()));
        for name in ["", "dmo", "demo.toml", "./demo", "../scenes/demo", "/etc/passwd", "--bus", "demo --bus"]
        {
            let error = catalogue.find(name).unwrap_err();
            assert!(error.contains("there is no scene") && error.contains("scene list"), "{name}: {error}");
        }
        assert!(Catalogue::read("/nowhere".as_ref()).unwrap_err().contains("--config"));
    }
}
