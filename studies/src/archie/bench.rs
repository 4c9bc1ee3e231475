//! A walk that is disturbed, and what of a cause it bears.

use config::Setup;
use messages::MAX_JOINTS;

use super::cause::Cause;
use super::trial::{Foothold, LateDrives, Walked, walk, walk_with};
use crate::Error;
use crate::search::{Width, border};

/// Share to which a border is found.
const NARROW: f64 = 0.04;
/// Share of what is tried with which the search begins.
const FIRST: f64 = 1.0 / 64.0;

/// A walk that can be disturbed.
pub(super) struct Bench {
    pub(super) setup: Setup,
    told: Walked,
    /// The footprint under which the ground is uneven.
    at: Foothold,
}

impl Bench {
    /// The scene, undisturbed, and its landing number `k`.
    ///
    /// # Errors
    /// The robot does not walk it.
    pub(super) fn new(setup: Setup, k: usize) -> Result<Self, Error> {
        let told = walk(&setup);
        if !told.walked(&told) {
            let (scene, ended) = (&setup.scene.name, &told.ended);
            return Err(format!(
                "scene {scene}: {ended}, tilt {:.3} rad, though nothing is wrong",
                told.tilt
            )
            .into());
        }
        let at = *told
            .landings
            .get(k)
            .ok_or_else(|| format!("scene {}: fewer than {k} steps", setup.scene.name))?;
        Ok(Self { setup, told, at })
    }

    /// The walk with a cause of this size.
    pub(super) fn with(&self, cause: &Cause, x: f64) -> Walked {
        let mut setup = self.setup.clone();
        cause.apply(&mut setup, x, &self.at);
        let lag = cause.lag(&setup, x);
        if lag == [0.0; MAX_JOINTS] {
            return walk(&setup);
        }
        let mut late = LateDrives::new(setup.scene.cycle, lag.iter().copied().fold(0.0, f64::max));
        walk_with(&setup, &mut |targets| late.delay(targets, &lag), &mut |_| ())
    }

    /// True if the walk is made with a cause of this size.
    #[cfg(test)]
    pub(super) fn bears(&self, cause: &Cause, x: f64) -> bool {
        self.with(cause, x).walked(&self.told)
    }

    /// Most of a cause, up to `most`, that is borne, and how the walk ends just beyond; all of `most`: none.
    pub(super) fn borne(&self, cause: &Cause, most: f64) -> Option<(f64, String)> {
        let mut beyond = String::new();
        let mut holds = |x: f64| {
            let walked = self.with(cause, x);
            let holds = walked.walked(&self.told);
            if !holds {
                beyond = if walked.ended == "done" { "steps missing".into() } else { walked.ended };
            }
            holds
        };
        // From little on, twice as much each time: falls end early, and few are far beyond.
        let (mut good, mut bad) = (0.0, FIRST * most);
        while holds(bad) {
            if bad == most {
                return None;
            }
            (good, bad) = (bad, if 2.0 * bad.abs() > 0.99 * most.abs() { most } else { 2.0 * bad });
        }
        let known = [good, bad];
        let width =
            if good == 0.0 { Width::Absolute(0.1 * bad.abs()) } else { Width::Absolute(NARROW * bad.abs()) };
        let found = border(known, width, |x| {
            Ok::<_, String>(if x == known[0] || x == known[1] { x == known[0] } else { holds(x) })
        });
        found.ok().map(|[good, _]| (good, beyond))
    }
}
