//! A sweep: scenes walked again and again, with other numbers in their files and with other seeds.
//!
//! ```toml
//! about = "Pushes to the left over a stride."
//! scenes = ["push"]
//! seeds = 20 # of every combination
//!
//! [[number]]
//! key = "scene.push.0.force.1" # a number that stands in the scene's file, or gait.KEY
//! values = [20.0, 40.0, 60.0] # or range and count, evenly spaced with both ends
//!
//! [[number]]
//! key = "scene.push.0.time"
//! range = [9.0, 11.4] # without a count: each seed draws one, the same in all combinations
//!
//! [survived] # optional, beside to the end, nothing refused and no doubt about the simulation: figures within these bounds
//! distance_m = [-0.2, 0.2]
//!
//! [map] # optional
//! across = "scene.push.0.time"
//! up = "scene.push.0.force.1"
//! cost = "inclination_error_max_rad.1"
//! ```

use std::path::{Path, PathBuf};

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::section::{self, Section};
use crate::setup::SetupNumbers;

/// Walks of a sweep at most.
const MOST_WALKS: u64 = 10_000_000;

/// A sweep's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// File that it was read from.
    pub file: PathBuf,
    /// FNV-1a, 64 bits, over its bytes.
    pub hash: u64,
    /// Purpose of the sweep in one sentence.
    pub about: String,
    /// Names or paths of the scenes.
    pub scenes: Vec<String>,
    /// Walks of every combination.
    pub seeds: u64,
    /// First of their seeds; the others count on.
    pub first_seed: u64,
    /// Numbers that are varied.
    pub numbers: Vec<SweptNumber>,
    /// Figures and the bounds within which they count as survived.
    pub survived: Vec<(String, [f64; 2])>,
    /// Axes of the maps.
    pub map: Option<SweepMap>,
}

/// A number that is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptNumber {
    /// Key: `scene.` or `gait.`, and the path in that file.
    pub key: String,
    /// Values that it takes.
    pub values: SweptValues,
}

/// Values of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum SweptValues {
    /// Each of these, with those of every other number.
    Each(Vec<f64>),
    /// One in this range for each seed.
    Drawn([f64; 2]),
}

/// Axes of the maps of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepMap {
    /// Number along the x axis.
    pub across: String,
    /// Number along the y axis.
    pub up: String,
    /// Figure whose mean over the walks that were survived is drawn; none: survival only.
    pub cost: Option<String>,
}

impl Sweep {
    /// Reads a sweep's file.
    ///
    /// # Errors
    /// It cannot be read, or says something wrong.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        let mut reader = ConfigReader::default();
        let text = file::text(path, &mut reader)?;
        let sweep = section::read(path, &text, |top| Self::build(top, path, reader.hash))?;
        match sweep.combinations().and_then(|n| n.checked_mul(sweep.seeds)) {
            Some(walks) if walks <= MOST_WALKS => Ok(sweep),
            _ => Err(ConfigError::of_file(path, format!("asks for more than {MOST_WALKS} walks"))),
        }
    }

    fn build(top: &Section<'_, '_>, path: &Path, hash: u64) -> Self {
        let sweep = Self {
            file: path.into(),
            hash,
            about: top.text("about"),
            scenes: top.texts("scenes"),
            seeds: if top.has("seeds") { top.integer("seeds", 1..=MOST_WALKS) } else { 1 },
            first_seed: if top.has("first_seed") { top.integer("first_seed", 0..=1 << 53) } else { 1 },
            numbers: top.tables("number", SweptNumber::build),
            survived: bounds(top),
            map: top.has("map").then(|| top.table("map", SweepMap::build)).flatten(),
        };
        let twice =
            |(i, n): (usize, &SweptNumber)| sweep.numbers[..i].iter().any(|before| before.key == n.key);
        if let Some((i, n)) = sweep.numbers.iter().enumerate().find(|n| twice(*n)) {
            top.problem("number", format!("[{i}].key = `{}` is varied twice", n.key));
        }
        let scenes = &sweep.scenes;
        if let Some((_, name)) = scenes.iter().enumerate().find(|(i, name)| scenes[..*i].contains(name)) {
            top.problem("scenes", format!("`{name}` is there twice"));
        }
        sweep
    }

    /// Number of combinations of scenes and values; none: more than can be counted.
    pub fn combinations(&self) -> Option<u64> {
        let counts = self.numbers.iter().map(|n| n.count() as u64);
        counts.chain([self.scenes.len() as u64]).try_fold(1, u64::checked_mul)
    }

    /// Numbers for [`SetupFiles::setup`](crate::SetupFiles::setup) from one value for each of [`numbers`](Self::numbers).
    pub fn setup_numbers(&self, values: &[f64]) -> SetupNumbers {
        let mut numbers = SetupNumbers::default();
        for (number, value) in self.numbers.iter().zip(values) {
            let (of, key) = number.place();
            let to = if of == "gait" { &mut numbers.gait } else { &mut numbers.scene };
            to.push((key.to_owned(), *value));
        }
        numbers
    }
}

impl SweptNumber {
    fn build(table: &Section<'_, '_>) -> Self {
        let key = table.text("key");
        if !key.is_empty() && !key.starts_with("scene.") && !key.starts_with("gait.") {
            table.problem("key", format!("`{key}` begins neither with `scene.` nor with `gait.`"));
        }
        if key == "scene.seed" {
            table.problem("key", "`scene.seed` is varied by `seeds` and `first_seed`");
        }
        let any = -1e12..=1e12;
        let listed = table.has("values");
        let values = if listed && table.has("range") {
            table.problem("values", "takes `values`, or `range`, but not both");
            SweptValues::Each(Vec::new())
        } else if listed {
            SweptValues::Each(table.list("values", "", any))
        } else {
            let range = table.interval("range", "", any);
            match table.has("count").then(|| table.integer("count", 2..=MOST_WALKS)) {
                Some(count) => SweptValues::Each(spaced(range, count)),
                None => SweptValues::Drawn(range),
            }
        };
        // The same walks twice would count as independent ones.
        if let SweptValues::Each(all) = &values
            && table.is_sound()
        {
            let mut sorted = all.clone();
            sorted.sort_by(f64::total_cmp);
            if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
                let key = if listed { "values" } else { "count" };
                table.problem(key, format!("{} is there twice", twice[0]));
            }
        }
        Self { key, values }
    }

    /// Number of values that combinations take in turn.
    pub fn count(&self) -> usize {
        match &self.values {
            SweptValues::Each(values) => values.len(),
            SweptValues::Drawn(_) => 1,
        }
    }

    /// The file, `scene` or `gait`, and the key in it.
    pub fn place(&self) -> (&str, &str) {
        self.key.split_once('.').unwrap_or_default()
    }
}

/// So many numbers of a range, evenly spaced, with both ends.
fn spaced([from, to]: [f64; 2], count: u64) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count).map(|k| from + (to - from) * (k as f64 / last)).collect()
}

fn bounds(top: &Section<'_, '_>) -> Vec<(String, [f64; 2])> {
    let read = |table: &Section<'_, '_>| {
        let one = |figure: String| {
            let bounds = table.interval(&figure, "", -1e12..=1e12);
            (figure, bounds)
        };
        table.keys().into_iter().map(one).collect()
    };
    if top.has("survived") { top.table("survived", read).unwrap_or_default() } else { Vec::new() }
}

impl SweepMap {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            across: table.text("across"),
            up: table.text("up"),
            cost: table.has("cost").then(|| table.text("cost")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "about = \"a\"\nscenes = [\"push\"]\n";

    fn sweep(text: &str) -> Result<Sweep, String> {
        let dir = std::env::temp_dir().join(format!("gangwerk-sweep-{}", std::process::id()));
        std::fs::create_dir_all(&dir).unwrap();
        let path = dir.join(format!("{:x}.toml", file::hash_of([text.as_bytes()].into_iter())));
        std::fs::write(&path, text).unwrap();
        Sweep::load(&path).map_err(|e| e.to_string())
    }

    #[test]
    fn values_are_listed_spaced_or_drawn() {
        let text = format!(
            "{HEAD}seeds = 5\n[[number]]\nkey = \"scene.a.0\"\nvalues = [1, 2.5]\n\
             [[number]]\nkey = \"gait.b\"\nrange = [0.0, 1.0]\ncount = 5\n\
             [[number]]\nkey = \"scene.c\"\nrange = [0.0, 1.0]\n[survived]\ndistance_m = [1.0, 2.0]\n"
        );
        let sweep = sweep(&text).unwrap();
        let values: Vec<_> = sweep.numbers.iter().map(|n| n.values.clone()).collect();
        let spaced = vec![0.0, 0.25, 0.5, 0.75, 1.0];
        let expected =
            [SweptValues::Each(vec![1.0, 2.5]), SweptValues::Each(spaced), SweptValues::Drawn([0.0, 1.0])];
        assert_eq!(values, expected);
        assert_eq!((sweep.combinations(), sweep.seeds, sweep.first_seed), (Some(10), 5, 1));
        assert_eq!(sweep.survived, [("distance_m".to_owned(), [1.0, 2.0])]);
        let numbers = sweep.setup_numbers(&[1.0, 0.25, 0.75]);
        assert_eq!(numbers.scene, [("a.0".to_owned(), 1.0), ("c".to_owned(), 0.75)]);
        assert_eq!(numbers.gait, [("b".to_owned(), 0.25)]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let number = |text: &str| format!("{HEAD}[[number]]\n{text}\n");
        for (text, why) in [
            (format!("{HEAD}seed = 3\n"), "line 3: seed: unknown key; the nearest known one is `seeds`"),
            (format!("{HEAD}seeds = 0\n"), "line 3: seeds: 0 is not allowed"),
            (number("key = \"robot.x\"\nvalues = [1]"), "line 4: number[0].key: `robot.x` begins neither"),
            (number("key = \"gait.x\"\nvalues = []"), "line 5: number[0].values: is empty"),
            (number("key = \"gait.x\"\nvalues = [nan]"), "line 5: number[0].values[0]: NaN is not allowed"),
            (
                number("key = \"gait.x\"\nvalues = [8000, 1, 8000.0]"),
                "line 5: number[0].values: 8000 is there twice",
            ),
            (number("key = \"gait.x\"\nvalues = [0.0, -0.0]"), "line 5: number[0].values: -0 is there twice"),
            (number("key = \"gait.x\"\nrange = [2, 1]"), "line 5: number[0].range: its lower end 2"),
            (number("key = \"gait.x\"\nrange = [1, 2]\ncount = 1"), "line 6: number[0].count: 1 is not"),
            (
                number("key = \"gait.x\"\nrange = [1, 2]\nvalues = [1]"),
                "number[0].values: takes `values`, or",
            ),
            (
                number("key = \"gait.x\"\nvalues = [1]\n[[number]]\nkey = \"gait.x\"\nvalues = [2]"),
                "number: [1].key = `gait.x` is varied twice",
            ),
            (
                number("key = \"scene.seed\"\nvalues = [1, 2]"),
                "number[0].key: `scene.seed` is varied by `seeds`",
            ),
            ("about = \"a\"\nscenes = [\"a\", \"b\", \"a\"]\n".into(), "line 2: scenes: `a` is there twice"),
            (
                number(
                    "key = \"gait.x\"\nrange = [1, 2]\ncount = 9000000\n[[number]]\nkey = \"gait.y\"\nvalues = [1, 2]",
                ),
                "asks for more than 10000000 walks",
            ),
        ] {
            let error = sweep(&text).unwrap_err();
            assert!(error.contains(why), "{error}, not {why}");
        }
    }
}
