//! Far end of a bus: where the simulated robot receives its commands and answers.

use std::error::Error;
use std::time::Duration;

use daemon::Daemon;
use messages::BusFrames;

/// Far end of a bus. But for the two that wait, nothing blocks or allocates.
pub(crate) trait FarEnd {
    /// Looks for a whole cycle that was not taken yet; true if there is one.
    fn refresh(&mut self) -> bool;

    /// The frames of the last one; their header says of which tick they are.
    fn held(&self) -> Option<&BusFrames>;

    /// True if these are of a cycle that was missed, and more of them wait.
    fn is_late(&self) -> bool {
        false
    }

    /// Sends the sensors' frames.
    fn answer(&mut self, d: &Daemon, frames: &BusFrames);

    /// Waits until something may have come, at most that long.
    fn wait(&mut self, at_most: Duration);

    /// In lockstep: waits for the next cycle. `Ok(false)`: asked to end.
    ///
    /// # Errors
    /// Lowlevel fell silent.
    fn next(&mut self, d: &Daemon) -> Result<bool, Box<dyn Error>>;
}
