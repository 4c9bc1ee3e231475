//! Rates over places and commands that nobody chose: how often does the robot walk as it is told?

use config::Setup;
use realtime::clock::thread_time;

use super::entries::{COMMANDED, GROUND, OVER_GROUND};
use super::{Goal, Result, ScorecardOptions, ScorecardRow};
use crate::random::seeds;
use crate::undisturbed::{STEP, on_type};
use crate::{commands, ground};

/// Type of the model, and \[km/h\] speeds at which unknown ground is walked over.
const DEPTH: u8 = 3;
const SPEEDS: [f64; 2] = [1.0, 2.0];
/// Places of each kind of ground and speed, and timelines of commands; all of them, or with `--quick`.
const DRAWN: [u64; 2] = [20, 2];

/// Walks of which a share is to be as told.
struct Rate {
    entry: String,
    scene: &'static str,
    what: String,
    /// \[1\] Share of all that is tried.
    share: f64,
}

/// Row of one kind of ground.
pub(super) fn over_ground(order: &ScorecardOptions<'_>, k: usize) -> Result<Vec<ScorecardRow>> {
    let (kind, size, share) = GROUND[k];
    let [slow, fast] = SPEEDS;
    let rate = Rate {
        entry: format!("over unknown ground at random places, at {slow} and {fast} km/h"),
        scene: OVER_GROUND,
        what: kind.of(size),
        share,
    };
    rate.row(order, SPEEDS.len(), |setup, seeds| {
        let failed = SPEEDS.map(|kmh| ground::not_walked(setup, (kind, size), kmh, seeds));
        Ok(failed.into_iter().collect::<Result<Vec<_>>>()?.concat())
    })
}

/// Row of commands that come at random.
pub(super) fn as_told(order: &ScorecardOptions<'_>) -> Result<Vec<ScorecardRow>> {
    let rate = Rate {
        entry: "random commands for 20 to 40 s, with sensors that err".into(),
        scene: COMMANDED,
        what: "walked as told".into(),
        share: 1.0,
    };
    rate.row(order, 1, commands::not_as_told)
}

impl Rate {
    /// Its row; `failed` tells of the scene and some seeds what is not walked, of `walks` walks for each seed.
    fn row(
        self,
        order: &ScorecardOptions<'_>,
        walks: usize,
        failed: impl Fn(&Setup, &[u64]) -> Result<Vec<String>>,
    ) -> Result<Vec<ScorecardRow>> {
        let begun = thread_time();
        let mut setup = Setup::load(order.config, self.scene).map_err(|e| e.to_string())?;
        on_type(&mut setup, DEPTH, STEP);
        // Seeds count on from the scorecard's own; what failed is named with its seed.
        let seeds: Vec<u64> = seeds(order.seed, DRAWN[usize::from(order.quick)]).collect();
        let failed = failed(&setup, &seeds)?;
        let tried = walks * seeds.len();
        // Whole walks: the share is rounded up, and not by what 0.95 lacks in binary.
        let (walked, least) = ((tried - failed.len()) as f64, (self.share * tried as f64 - 1e-9).ceil());
        Ok(vec![ScorecardRow {
            entry: self.entry,
            scene: self.scene.into(),
            what: self.what,
            demanded: format!("at least {least} of {tried}"),
            ours: Some(walked),
            unit: format!("of {tried}"),
            goal: if walked >= least { Goal::Met } else { Goal::Missed },
            note: failed.join("; "),
            depth: super::depth_of(&setup.scene),
            cycle_s: setup.scene.cycle,
            cpu_s: (thread_time() - begun) as f64 * 1e-9,
            published: "none".into(),
        }])
    }
}
