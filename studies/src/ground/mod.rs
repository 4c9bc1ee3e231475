//! Unknown ground: over how many random places of a kind does the robot walk, of which nobody has told it? And how often does a
//! robot walk that does not weigh what its software believes?
//!
//! A place is drawn from its seed where the undisturbed walk steps (`place`), and becomes objects of the scene that the
//! planner does not know (`terrain`). Walked: over it and 6 s further, on its feet, the supply on, and over the next
//! stride as far in each direction as without it.

mod footprint;
mod kind;
mod picture;
mod place;
mod terrain;
#[cfg(test)]
mod tests;
mod trial;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use chain::parallel;
use config::Setup;
use serde::Serialize;

pub use kind::GroundKind;

use crate::sheet::{Column, fixed, plain};
use crate::undisturbed::{STEP, Stride, on_type, stride, walk_at, walk_on};
use crate::{Error, Given, Sheet, Study};
use footprint::{Footprint, footprints};
use place::{ALONG, Place};
use terrain::Terrain;
use trial::Outcome;

/// \[s\] When the stride that others are held against begins at the earliest.
const SETTLED: f64 = 8.0;

const COLUMNS: &[Column] = &[
    plain("/name", "unknown ground"),
    plain("/size", "size"),
    plain("/unit", ""),
    plain("/depth", "type"),
    plain("/speed_kmh", "speed [km/h]"),
    plain("/walked", "walked"),
    plain("/tried", "of"),
    fixed("/rate", "rate", 2),
    plain("/how", "others"),
    plain("/seeds", "their seeds"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct GroundStudy {
    /// Scene whose robot, gait and sensors they are; it walks straight on from a velocity command.
    #[arg(long, default_value = "walk_2kmh")]
    pub scene: String,
    /// Kinds of ground; default: all.
    #[arg(long, value_delimiter = ',', value_enum)]
    pub kind: Vec<GroundKind>,
    /// Heights (m), slopes (deg), shares of a sole or coefficients of friction (1), instead of those of each kind.
    #[arg(long, value_delimiter = ',', value_parser = size)]
    pub size: Vec<f64>,
    /// How many places of each kind and size.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub places: u64,
    /// Seed of the first place; the others count on.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Speeds [km/h].
    #[arg(long, value_delimiter = ',', default_values_t = [1.0, 2.0], value_parser = size)]
    pub speeds: Vec<f64>,
    /// Simulation types.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 3], value_parser = clap::value_parser!(u8).range(1..=5))]
    pub types: Vec<u8>,
    /// Directory of the picture; none is drawn without it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// A number above zero.
pub(crate) fn size(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("it takes a number above 0".into()),
    }
}

/// Places of a kind, size, type and speed.
#[derive(Serialize)]
struct Row {
    kind: GroundKind,
    name: &'static str,
    size: f64,
    unit: &'static str,
    depth: u8,
    speed_kmh: f64,
    walked: usize,
    tried: usize,
    /// \[1\]
    rate: f64,
    /// How many of the others ended in each way.
    how: BTreeMap<String, usize>,
    seeds: Vec<u64>,
    failed: Vec<Failed>,
}

/// A place that was not walked over.
#[derive(Clone, Serialize)]
pub(crate) struct Failed {
    seed: u64,
    how: String,
    time_s: f64,
    /// \[m\] Of the torso, along the way.
    x_m: f64,
}

/// The undisturbed walk of a type at a speed, on level ground.
pub(crate) struct LevelWalk {
    setup: Setup,
    /// \[m/s\]
    speed: f64,
    stride: Stride,
    steps: Vec<Footprint>,
}

impl Study for GroundStudy {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let kinds = if self.kind.is_empty() { GroundKind::all().collect() } else { self.kind.clone() };
        let sizes =
            |kind: &GroundKind| if self.size.is_empty() { kind.sizes().to_vec() } else { self.size.clone() };
        let ground: Vec<(GroundKind, f64)> =
            kinds.iter().flat_map(|kind| sizes(kind).into_iter().map(|size| (*kind, size))).collect();
        ground.iter().try_for_each(|&(kind, size)| kind.check(size))?;
        let walks: Vec<(u8, f64)> =
            self.types.iter().flat_map(|depth| self.speeds.iter().map(|speed| (*depth, *speed))).collect();
        // Each type and speed walks on level ground once; every place is held against that.
        let scene = Setup::load(given.config, &self.scene)?;
        let references =
            parallel::map(walks.len(), |k| LevelWalk::of(scene.clone(), walks[k]).map_err(|e| e.to_string()));
        let references = references.into_iter().collect::<Result<Vec<_>, _>>()?;
        let (each, done) = (self.places as usize, AtomicUsize::new(0));
        let rows = ground.iter().flat_map(|of| walks.iter().zip(&references).map(move |walk| (of, walk)));
        let rows: Vec<_> = rows.collect();
        let failed = parallel::map(each * rows.len(), |k| {
            let (&(kind, size), (_, reference)) = rows[k / each];
            (given.progress)(done.fetch_add(1, Ordering::Relaxed), each * rows.len(), kind.name());
            reference.over(kind, size, self.seed.wrapping_add((k % each) as u64))
        });
        let failed = failed.into_iter().collect::<Result<Vec<_>, _>>()?;
        let rows = rows.iter().zip(failed.chunks(each));
        let rows: Vec<Row> =
            rows.map(|((ground, (walk, _)), failed)| row(**ground, **walk, failed)).collect();
        let mut sheet = Sheet::titled(format!(
            "Unknown ground at {each} random places, scene {}, seeds from {}",
            self.scene, self.seed
        ));
        sheet.rows("rows", COLUMNS, &rows);
        if let Some(out) = &self.out {
            let about = format!("{each} random places each, scene {}, seeds from {}", self.scene, self.seed);
            sheet.draw(out, "ground.png", &picture::rates(&rows, &about))?;
        }
        Ok(sheet)
    }
}

fn row((kind, size): (GroundKind, f64), (depth, speed_kmh): (u8, f64), places: &[Option<Failed>]) -> Row {
    let failed: Vec<Failed> = places.iter().flatten().cloned().collect();
    let mut how = BTreeMap::new();
    failed.iter().for_each(|f| *how.entry(f.how.clone()).or_default() += 1);
    let (walked, tried) = (places.len() - failed.len(), places.len());
    Row {
        kind,
        name: kind.name(),
        size,
        unit: kind.unit(),
        depth,
        speed_kmh,
        walked,
        tried,
        rate: walked as f64 / tried as f64,
        how,
        seeds: failed.iter().map(|f| f.seed).collect(),
        failed,
    }
}

/// Random places of a kind and size that a robot does not walk over at a speed \[km/h\]: their seeds, and how it ends there.
///
/// # Errors
/// The robot cannot be built, or does not walk on level ground.
pub(crate) fn not_walked(
    setup: &Setup,
    (kind, size): (GroundKind, f64),
    kmh: f64,
    seeds: &[u64],
) -> Result<Vec<String>, String> {
    let walk = (setup.scene.depth, kmh);
    let reference = LevelWalk::of(setup.clone(), walk).map_err(|e| e.to_string())?;
    let mut failed = Vec::new();
    for &seed in seeds {
        let of = reference.over(kind, size, seed)?;
        failed.extend(of.map(|f| format!("{}, {kmh} km/h, seed {seed}: {}", kind.of(size), f.how)));
    }
    Ok(failed)
}

impl LevelWalk {
    /// That of a robot and gait, of a simulation type at a speed \[km/h\].
    ///
    /// # Errors
    /// The robot cannot be built, or does not walk.
    pub(crate) fn of(mut setup: Setup, (depth, kmh): (u8, f64)) -> Result<Self, Error> {
        on_type(&mut setup, depth, STEP);
        walk_at(&mut setup, kmh)?;
        let speed = kmh / 3.6;
        walk_on(&mut setup, f64::max(SETTLED, 2.0 * ALONG[1] / speed));
        Ok(Self { speed, stride: stride(&setup, SETTLED)?, steps: footprints(&setup)?, setup })
    }

    /// Over the place of a seed; none if it was walked.
    ///
    /// # Errors
    /// The robot cannot be built.
    pub(crate) fn over(&self, kind: GroundKind, size: f64, seed: u64) -> Result<Option<Failed>, String> {
        let place = Place::draw(kind, kind.in_si(size), &self.steps, seed);
        let (terrain, mut setup) = (Terrain::of(&place), self.setup.clone());
        terrain.put(&place, &mut setup);
        let (outcome, [time_s, x_m]) = trial::walk(&setup, terrain.end, &self.stride, self.speed)?;
        let failed = Failed { seed, how: outcome.to_string(), time_s, x_m };
        Ok((outcome != Outcome::Walked).then_some(failed))
    }
}
