//! Scenes that leave the model open (`depth = "auto"`): chosen before anything else is done with them.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use chain::depth::{self, Choice};
use config::Setup;
use indicatif::ProgressBar;

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
