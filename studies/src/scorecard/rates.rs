//! Rates over places and commands that nobody chose: how often does the robot walk as it is told?

use std::ops::Range;

use config::Setup;
use realtime::clock::thread_time;

use super::entries::{COMMANDED, GROUND, OVER_GROUND};
use super::{Goal, Result, ScorecardOptions, ScorecardRow};
use crate::undisturbed::{STEP, on_type};
use crate::{commands, ground};

/// Type of the model, and \[km/h\] speeds at which unknown ground is walked over.
const DEPTH: u8 = 3;
const SPEEDS: [f64; 2] = [1.0, 2.0];
/// Places of each kind of ground and speed, and timelines of commands; all of them, or with `--quick`.
const DRAWN: [u64; 2] = [20, 2];

/// Row of one kind of ground.
pub(super) fn over_ground(order: &ScorecardOptions<'_>, k: usize) -> Result<Vec<ScorecardRow>> {
    let (kind, size, share) = GROUND[k];
    let (setup, seeds, begun) = (of_scene(order, OVER_GROUND)?, seeds(order), thread_time());
    let failed = SPEEDS.map(|kmh| ground::not_walked(&setup, (kind, size), kmh, seeds.clone()));
    let failed = failed.into_iter().collect::<Result<Vec<_>>>()?.concat();
    let row = ScorecardRow {
        entry: format!("over unknown ground at random places, at {} and {} km/h", SPEEDS[0], SPEEDS[1]),
        scene: OVER_GROUND.into(),
        what: format!("{} of {size} {}", kind.name(), kind.unit()).trim_end_matches(" 1").into(),
        ..rate(&setup, share, (&failed, SPEEDS.len() * DRAWN[usize::from(order.quick)] as usize))
    };
    Ok(vec![ScorecardRow { cpu_s: (thread_time() - begun) as f64 * 1e-9, ..row }])
}

/// Row of commands that come at random, with sensors that err.
pub(super) fn as_told(order: &ScorecardOptions<'_>) -> Result<Vec<ScorecardRow>> {
    let (setup, begun) = (of_scene(order, COMMANDED)?, thread_time());
    let failed = commands::not_as_told(&setup, seeds(order))?;
    let row = ScorecardRow {
        entry: "random commands for 20 to 40 s, with sensors that err".into(),
        scene: COMMANDED.into(),
        what: "walked as told".into(),
        ..rate(&setup, 1.0, (&failed, DRAWN[usize::from(order.quick)] as usize))
    };
    Ok(vec![ScorecardRow { cpu_s: (thread_time() - begun) as f64 * 1e-9, ..row }])
}

fn of_scene(order: &ScorecardOptions<'_>, scene: &str) -> Result<Setup> {
    let mut setup = Setup::load(order.config, scene).map_err(|e| e.to_string())?;
    on_type(&mut setup, DEPTH, STEP);
    Ok(setup)
}

fn seeds(order: &ScorecardOptions<'_>) -> Range<u64> {
    order.seed..order.seed + DRAWN[usize::from(order.quick)]
}

/// Row of what is to be walked in this share of all that is tried; `failed` are those that were not.
fn rate(setup: &Setup, share: f64, (failed, tried): (&[String], usize)) -> ScorecardRow {
    let (walked, least) = ((tried - failed.len()) as f64, (share * tried as f64 - 1e-9).ceil());
    ScorecardRow {
        entry: String::new(),
        scene: String::new(),
        what: String::new(),
        demanded: format!("at least {least} of {tried}"),
        ours: Some(walked),
        unit: format!("of {tried}"),
        goal: if walked >= least { Goal::Met } else { Goal::Missed },
        note: failed.join("; "),
        depth: super::depth_of(&setup.scene),
        cycle_s: setup.scene.cycle,
        cpu_s: 0.0,
        published: "none".into(),
    }
}
