//! Method of simulation, chosen before anything else is done with a scene: where it leaves the model open (`depth = "auto"`), or
//! because somebody asks for another one than the scene's.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use chain::depth::{self, Choice, Tried};
use config::Setup;
use config::method::{Integrator, Method};
use indicatif::ProgressBar;
use sim_backend::step_limit::step_limit_of_scene;

/// Steps per cycle of a scene that says none.
const SUBSTEPS: u32 = 4;
/// Most steps per cycle that a scene may have.
const MOST_SUBSTEPS: f64 = 1000.0;

/// Depth and integrator that somebody asks for instead of the scene's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MethodWish {
    /// Modelling depth, 1 to 5.
    pub depth: Option<u8>,
    /// Integrator; none: the scene's, or with another depth the one that is made for it.
    pub integrator: Option<Integrator>,
}

impl MethodWish {
    /// The method for a scene: its own steps per cycle, or a multiple of them with which the integrator is stable.
    ///
    /// # Errors
    /// The scene's depth is "auto" and no depth is asked for; or the robot's data do not allow the depth.
    fn method(self, setup: &Setup) -> Result<Method, Box<dyn Error>> {
        let (scene, robot) = (&setup.scene, &setup.robot);
        let own = scene.auto.is_none().then(|| scene.method());
        let depth = self.depth.or(own.map(|own| own.depth)).ok_or_else(|| {
            format!(
                "scene {}: its depth is \"auto\", which chooses the integrator, too; give --depth as well",
                scene.name
            )
        })?;
        let integrator = self.integrator.unwrap_or(match own {
            Some(own) if own.depth == depth => own.integrator,
            _ if depth == 1 => Integrator::Euler,
            _ => Integrator::SemiImplicit,
        });
        let substeps = own.map_or(SUBSTEPS, |own| own.substeps);
        // Whole multiples stay on the grid of drives with a clock of their own.
        let mut asked = scene.clone();
        asked.choose(Method { depth, integrator, substeps });
        let limit = if scene.force_step { None } else { step_limit_of_scene(robot, &asked)? };
        let times =
            limit.map_or(1.0, |limit| (scene.cycle / (limit.step * f64::from(substeps))).ceil().max(1.0));
        let enough = f64::from(substeps) * times;
        // With more than there may be the scene is refused, by who says what is stable.
        let substeps = if enough <= MOST_SUBSTEPS { enough as u32 } else { substeps };
        Ok(Method { depth, integrator, substeps })
    }
}

/// Method of simulation that is not the scene's own.
#[derive(Clone, Copy, Debug)]
pub struct OtherMethod {
    /// Type, integrator and step.
    pub method: Method,
    /// Largest estimated error as a multiple of what the scene allows, if it was chosen by its error.
    pub error: Option<f64>,
}

impl From<Choice> for OtherMethod {
    fn from(choice: Choice) -> Self {
        Self { method: choice.method, error: choice.tried.last().map(Tried::excess) }
    }
}

/// Loads a scene with all it names, and the method that it is simulated with if that is not the scene's own; the terminal is told.
///
/// # Errors
/// The configuration is wrong, no method is as accurate as the scene asks, or the one asked for does not fit scene and robot.
pub fn load_with(
    config: &Path,
    scene: &str,
    wish: MethodWish,
) -> Result<(Setup, Option<OtherMethod>), Box<dyn Error>> {
    if wish == MethodWish::default() {
        let (setup, choice) = load(config, scene, true)?;
        return Ok((setup, choice.map(OtherMethod::from)));
    }
    let setup = Setup::load(config, scene)?;
    let method = wish.method(&setup)?;
    eprintln!("asked for instead of the scene's method: {method}");
    Ok((setup.with_method(Some(method))?, Some(OtherMethod { method, error: None })))
}

/// Loads a scene with all it names; a scene with `depth = "auto"` comes back with a method, and why it is that one. If
/// `show`, the terminal sees what is being tried and one line of result.
///
/// # Errors
/// The configuration is wrong, or no method is as accurate as the scene asks.
pub fn load(config: &Path, scene: &str, show: bool) -> Result<(Setup, Option<Choice>), Box<dyn Error>> {
    let mut setup = Setup::load(config, scene)?;
    if setup.scene.auto.is_none() {
        return Ok((setup, None));
    }
    let bar = if show { ProgressBar::new_spinner() } else { ProgressBar::hidden() };
    bar.enable_steady_tick(Duration::from_millis(100));
    let choice = depth::choose(&setup, |trying| bar.set_message(format!("depth auto: trying {trying}")));
    bar.finish_and_clear();
    let choice = choice?;
    if show {
        eprintln!("depth auto: {}", choice.reason());
    }
    setup.scene.choose(choice.method);
    Ok((setup, Some(choice)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim_backend::SimBackend;

    /// The method as text, after the simulated robot was built with it; or the error.
    fn with(scene: &str, depth: Option<u8>, integrator: Option<Integrator>) -> Result<String, String> {
        let loaded = load_with(&config::root(None), scene, MethodWish { depth, integrator });
        let (setup, method) = loaded.map_err(|e| e.to_string())?;
        SimBackend::new(&setup.robot, &setup.scene).map_err(|e| e.to_string())?;
        Ok(method.map_or("the scene's".into(), |other| other.method.to_string()))
    }

    #[test]
    fn a_wish_changes_what_it_names_and_what_that_needs() {
        let told = |scene, depth, integrator| with(scene, depth, integrator).unwrap_or_else(|e| e);
        assert_eq!(told("demo", None, None), "the scene's");
        assert_eq!(told("demo", Some(1), None), "type 1, euler x 4");
        assert_eq!(told("demo", Some(3), None), "type 3, semi_implicit x 4");
        assert_eq!(told("demo", None, Some(Integrator::RungeKutta4)), "type 1, rk4 x 4");
        assert_eq!(told("walk_type5", Some(1), None), "type 1, euler x 10");
        assert_eq!(told("walk_auto", Some(2), None), "type 2, semi_implicit x 4");
        assert_eq!(told("walk_without_currents", Some(3), None), "type 3, semi_implicit x 3");
        // Steps become as many as an explicit integrator needs; Archie's drives are sampled on a grid of 22 steps.
        for (scene, depth, own, least) in [("walk_without_currents", 3, 1, 2), ("archie_walk", 2, 22, 22)] {
            let told = told(scene, Some(depth), Some(Integrator::Euler));
            let steps = told.strip_prefix(&format!("type {depth}, euler x ")).and_then(|n| n.parse().ok());
            let steps: u32 = steps.unwrap_or(0);
            assert!(steps >= least && steps.is_multiple_of(own), "{scene}: {told}");
        }
    }

    #[test]
    fn a_wish_that_cannot_be_is_refused_with_its_reason() {
        for (scene, depth, integrator, part) in [
            ("walk_auto", None, Some(Integrator::Euler), "give --depth as well"),
            ("walk_without_currents", Some(1), None, "components.currents with depth 1"),
            ("demo", Some(4), Some(Integrator::Bdf), "semi_implicit"),
            ("demo", Some(3), Some(Integrator::Euler), "the largest stable one"),
            ("walk_60", Some(2), None, "walk_60s"),
        ] {
            let error = with(scene, depth, integrator).unwrap_err();
            assert!(error.contains(part), "{scene}: {error}");
        }
    }
}
