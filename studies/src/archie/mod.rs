//! `gangwerk study archie`: what makes Archie fall in his own walk, and what cures it (Daniali 2013, chapter 7).
//!
//! The thesis names zero positions, uneven ground and early contact. Each is made larger until the walk is no longer
//! made, in the simulated robot with motors and elastic gears: as he walks there, open loop, and under the stabilizer with
//! force sensors and an inertial sensor. Beside it stands what statics of the plan predict.
//!
//! | file | what |
//! |---|---|
//! | `cause` | what can be wrong |
//! | `trial`, `bench` | the walks that are disturbed |
//! | `statics` | the prediction |
//! | `currents`, `speeds` | what his motors bear; how fast he is under the stabilizer |

mod bench;
mod cause;
mod currents;
mod picture;
mod speeds;
mod statics;
#[cfg(test)]
mod tests;
mod trial;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use chain::parallel;
use config::Setup;
use serde::Serialize;

use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};
use bench::Bench;
use cause::{Acts, Cause, Place, causes};
use trial::{BEGIN, LateDrives, STEPS, open_loop, stabilized, walk_with};

pub use currents::JointLoad;
pub use speeds::CuredSpeed;

/// \[rad\] A walk is made with a tilt of the torso below this.
const TILT: f64 = 0.1;
/// Landings whose footprints are uneven: of the first whole step; in the middle of the walk under the stabilizer.
const LANDINGS: [usize; 2] = [1, 6];
/// Halvings of the predicted border.
const HALVINGS: usize = 10;
/// Parts of the study.
const PARTS: [&str; 6] = ["zero", "ground", "pattern", "clocks", "currents", "speeds"];
/// \[ppm\] By how much the clocks of drives are apart; with the last one he walks until he falls.
const PPM: [f64; 3] = [10.0, 50.0, 100.0];

const COLUMNS: &[Column] = &[
    plain("/name", "cause"),
    plain("/unit", "unit"),
    plain("/predicted", "predicted"),
    plain("/open_loop", "open loop"),
    plain("/over_predicted", "over predicted"),
    plain("/ended", "then"),
    plain("/stabilized", "with stabilizer"),
    plain("/gained", "factor gained"),
];

const STRIDES: &[Column] = &[
    plain("/name", "clocks apart, tables played freely"),
    fixed("/ppm", "ppm", 0),
    fixed("/predicted", "strides by statics", 0),
    fixed("/by_lag", "by the constant lag that is borne", 0),
    fixed("/walked", "walked until he fell", 1),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Archie {
    /// Only this part.
    #[arg(long, value_name = "PART", value_parser = PARTS)]
    pub only: Option<String>,
    /// Directory of the picture.
    #[arg(long, value_name = "DIR", default_value = "runs/study/archie")]
    pub out: PathBuf,
}

/// What of a cause is borne.
#[derive(Clone, Debug, Serialize)]
pub struct Borne {
    /// What is wrong.
    pub name: String,
    /// Unit of the numbers.
    pub unit: &'static str,
    /// What is borne, side by side, for people: by statics, open loop, and how the walk ends beyond; the same over the
    /// predicted; under the stabilizer, and over that open loop.
    pub predicted: String,
    /// Open loop.
    pub open_loop: String,
    /// Ends of these walks.
    pub ended: String,
    /// Open loop over predicted.
    pub over_predicted: String,
    /// Under the stabilizer.
    pub stabilized: String,
    /// Stabilizer over open loop.
    pub gained: String,
    /// The numbers.
    pub sides: Vec<BorneSide>,
}

/// One side of a cause.
#[derive(Clone, Debug, Serialize)]
pub struct BorneSide {
    /// Tried at most.
    pub tried: f64,
    /// By statics of the plan; none: more than tried.
    pub predicted: Option<f64>,
    /// By the simulated robot; none: more than tried.
    pub open_loop: Option<f64>,
    /// How its walk ends beyond.
    pub ended: String,
    /// True of causes that the walk under the stabilizer has, too.
    pub cured: bool,
    /// Under the stabilizer; none: more than tried.
    pub stabilized: Option<f64>,
    /// How that walk ends beyond.
    pub stabilized_ended: String,
}

/// Strides until he falls.
#[derive(Clone, Debug, Serialize)]
struct Strides {
    name: String,
    ppm: f64,
    /// By statics, and by the constant lag that is borne.
    predicted: Option<f64>,
    by_lag: Option<f64>,
    /// Walked until he fell.
    walked: Option<f64>,
}

impl Study for Archie {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let wanted = |part: &str| self.only.as_deref().is_none_or(|only| only == part);
        let mut sheet = Sheet::default();
        let benches = benches(given.config)?;
        let all = borne(&benches, &wanted, given);
        if !all.is_empty() {
            sheet.rows("causes", COLUMNS, &all);
        }
        // Drives whose tables run by their own clocks: how long a lag takes to grow.
        if wanted("clocks") {
            sheet.line("");
            sheet.rows("strides", STRIDES, &strides(&benches[0].setup, &all, given)?);
        }
        if wanted("currents") {
            (given.progress)(0, 0, "currents");
            sheet.line("");
            sheet.rows("currents", currents::COLUMNS, &currents::loads(given.config)?);
        }
        if wanted("speeds") {
            (given.progress)(0, 0, "speeds under the stabilizer");
            sheet.line("");
            sheet.rows("speeds", speeds::COLUMNS, &speeds::speeds(given.config)?);
        }
        if !all.is_empty() {
            sheet.draw(&self.out, "archie_margins.png", &picture::map(&all))?;
        }
        Ok(sheet)
    }
}

/// Open loop, and under the stabilizer.
fn benches(config: &Path) -> Result<[Bench; 2], Error> {
    Ok([
        Bench::new(open_loop(config, STEPS, |_| ())?, LANDINGS[0])?,
        Bench::new(stabilized(config)?, LANDINGS[1])?,
    ])
}

/// All causes of the wanted parts.
fn borne(benches: &[Bench; 2], wanted: &dyn Fn(&str) -> bool, given: &Given<'_>) -> Vec<Borne> {
    let mut all = causes(&benches[0].setup);
    all.retain(|cause| wanted(cause.part));
    // Sides are searched independently of each other.
    let of = |(k, cause): (usize, &Cause)| cause.tried.map(|most| (k, most));
    let sides: Vec<_> = all.iter().enumerate().flat_map(of).filter(|(_, most)| *most != 0.0).collect();
    let done = AtomicUsize::new(0);
    let found = parallel::map(sides.len(), |i| {
        let (k, most) = sides[i];
        let side = side(&all[k], most, benches);
        (given.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, sides.len(), &all[k].name);
        side
    });
    let of = |k: usize| sides.iter().zip(&found).filter(move |(side, _)| side.0 == k).map(|(_, s)| s.clone());
    all.iter().enumerate().map(|(k, cause)| row(cause, of(k).collect())).collect()
}

fn side(cause: &Cause, most: f64, [open, stabilized]: &[Bench; 2]) -> BorneSide {
    let measured = open.borne(cause, most);
    // Its plan is not the pattern, its feet do not swing over their own length, and its drives have a point in every cycle.
    let cured = !matches!(cause.acts, Acts::Pattern(_) | Acts::Bump(Place::MidSwing) | Acts::Late(..));
    let with = if cured { stabilized.borne(cause, most) } else { None };
    let (stabilized, stabilized_ended) = with.unzip();
    let (open_loop, ended) = measured.unzip();
    BorneSide {
        tried: most,
        predicted: predicted(cause, most, open),
        open_loop,
        ended: ended.unwrap_or_default(),
        cured,
        stabilized,
        stabilized_ended: stabilized_ended.unwrap_or_default(),
    }
}

/// Most of a cause that is borne by statics; none: all that is tried.
fn predicted(cause: &Cause, most: f64, open: &Bench) -> Option<f64> {
    let walks = |x: f64| cause.predicted(&open.setup, x);
    let (mut low, mut high) = (0.0, most);
    if walks(most) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if walks(middle) { &mut low } else { &mut high }) = middle;
    }
    Some(low)
}

/// Strides until a lag has grown to what is borne of it, and those that are walked.
fn strides(setup: &Setup, all: &[Borne], given: &Given<'_>) -> Result<Vec<Strides>, Error> {
    let step = setup.gait.pattern.map_or(0.0, |p| p.step_time);
    let strides = |lag_ms: f64, ppm: f64| 1e-3 * lag_ms / (1e-6 * ppm * 2.0 * step);
    let late = causes(setup).into_iter().filter(|cause| matches!(cause.acts, Acts::Late(..)));
    let late: Vec<_> = late.zip(all.iter().filter(|b| b.unit == "ms")).collect();
    let of = |borne: &Borne, ppm: f64| {
        [borne.sides[0].predicted, borne.sides[0].open_loop].map(|x| x.map(|x| strides(x, ppm)))
    };
    // With the largest, an hour and more of his time.
    let most = PPM[2];
    (given.progress)(0, 0, &format!("walks with clocks {most} ppm apart until he falls"));
    let walked = parallel::map(late.len(), |i| {
        let (cause, borne) = &late[i];
        let expected = of(borne, most).into_iter().flatten().fold(10.0, f64::max);
        drift(given.config, cause, most, (1.5 * expected) as u32).map_err(|e| e.to_string())
    });
    let mut rows = Vec::new();
    for ((cause, borne), walked) in late.iter().zip(walked) {
        let walked = walked?;
        for ppm in PPM {
            let [predicted, by_lag] = of(borne, ppm);
            let walked = walked.filter(|_| ppm == most);
            rows.push(Strides { name: cause.name.clone(), ppm, predicted, by_lag, walked });
        }
    }
    Ok(rows)
}

/// Strides that are walked, of at most `most`, while the drives of a cause fall behind by `ppm`; none: all of them.
fn drift(config: &Path, cause: &Cause, ppm: f64, most: u32) -> Result<Option<f64>, Error> {
    let setup = open_loop(config, 2 * most, |_| ())?;
    let step = setup.gait.pattern.map_or(0.0, |p| p.step_time);
    let duration = f64::from(2 * most) * step;
    let (cycle, mut now) = (setup.scene.cycle, 0.0);
    let mut late = LateDrives::new(cycle, 1e-6 * ppm * duration);
    let walked = walk_with(
        &setup,
        &mut |targets| {
            now += cycle;
            let lag_ms = 1e-3 * ppm * (now - BEGIN).clamp(0.0, duration);
            late.delay(targets, &cause.lag(&setup, lag_ms));
        },
        &mut |_| (),
    );
    Ok((walked.ended != "done").then_some((walked.time - BEGIN) / (2.0 * step)))
}

/// For people and for other programs.
fn row(cause: &Cause, sides: Vec<BorneSide>) -> Borne {
    let each = |of: &dyn Fn(&BorneSide) -> String| sides.iter().map(of).collect::<Vec<String>>().join(", ");
    let mut ends: Vec<&str> = sides.iter().map(|s| s.ended.as_str()).filter(|end| !end.is_empty()).collect();
    ends.dedup();
    let number = |x: Option<f64>, tried: f64| match x {
        Some(x) => figures((cause.shown)(x)),
        None => format!("over {}", figures((cause.shown)(tried))),
    };
    let ratio = |x: Option<f64>, by: Option<f64>, tried: f64| match (x, by) {
        (Some(x), Some(by)) if by != 0.0 => figures((cause.shown)(x) / (cause.shown)(by)),
        (None, Some(by)) if by != 0.0 => {
            format!("over {}", figures((cause.shown)(tried) / (cause.shown)(by)))
        }
        _ => "-".into(),
    };
    let cured = |s: &BorneSide, text: String| if s.cured { text } else { "-".into() };
    Borne {
        name: cause.name.clone(),
        unit: cause.unit,
        predicted: each(&|s| number(s.predicted, s.tried)),
        open_loop: each(&|s| number(s.open_loop, s.tried)),
        over_predicted: each(&|s| ratio(s.open_loop, s.predicted, s.tried)),
        ended: ends.join(", "),
        stabilized: each(&|s| cured(s, number(s.stabilized, s.tried))),
        gained: each(&|s| cured(s, ratio(s.stabilized, s.open_loop, s.tried))),
        sides,
    }
}

/// Two or three figures.
fn figures(x: f64) -> String {
    match x.abs() {
        large if large >= 100.0 => format!("{x:.0}"),
        middle if middle >= 10.0 => format!("{x:.1}"),
        small if small >= 0.1 || small == 0.0 => format!("{x:.2}"),
        _ => format!("{x:.3}"),
    }
}
