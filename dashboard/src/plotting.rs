//! Samples of plotted fields: only topics that somebody plots are followed, and of them only the records that are asked for.
//!
//! A row is one bus cycle. `sensors` is the clock: a row is sent when every other topic that is written each cycle has come to
//! it, or has been late for too long. What is written less often holds its last value.

use std::collections::{BTreeMap, VecDeque};

use ipc::{IpcError, Reader, Space};
use messages::fields::{numbers, pick};
use messages::topics::{
    CONTROLLER_STATE, ForType, JOINT_TARGETS, POWER, SENSORS, SIM_STATE, STATS_CONTROLLER, STATS_LOWLEVEL,
    STATS_PLANNER, STATS_SIM_BACKEND, STATS_WATCHDOG, Topic, WATCHDOG_RESET, with_type,
};
use messages::{Process, Record};

/// Topics with a place in time, cycle by cycle. A plan is none: it is a future.
const PLOTTED: [&Topic; 11] = [
    &SENSORS,
    &CONTROLLER_STATE,
    &JOINT_TARGETS,
    &SIM_STATE,
    &POWER,
    &WATCHDOG_RESET,
    &STATS_WATCHDOG,
    &STATS_SIM_BACKEND,
    &STATS_LOWLEVEL,
    &STATS_PLANNER,
    &STATS_CONTROLLER,
];
/// Records per second from which a topic has one in each cycle.
const EVERY_CYCLE: u32 = 100;
/// Cycles after which a row waits for nobody any more.
const LATE: u64 = 100;
/// Most rows of one frame; more are of a page that did not look for long.
const MOST_ROWS: usize = 2048;

/// A field that can be plotted.
#[derive(Clone, Debug)]
pub struct PlotField {
    /// `topic.field`.
    pub name: String,
    /// Unit; empty: none.
    pub unit: &'static str,
    pub(crate) topic: &'static Topic,
    /// Place among the numbers of a record.
    place: usize,
}

/// Every field that can be plotted of a robot with these joints; `simulated`: with the truth about it.
pub fn catalogue(joints: &[String], simulated: bool) -> Vec<PlotField> {
    let wanted = |topic: &&&Topic| simulated || topic.writer != Process::SimBackend;
    let fields = |topic: &&Topic| with_type(topic.name, Names { joints }).unwrap_or_default();
    PLOTTED.iter().filter(wanted).flat_map(fields).collect()
}

struct Names<'a> {
    joints: &'a [String],
}

impl ForType<Vec<PlotField>> for Names<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Vec<PlotField> {
        let all = numbers(&T::empty(), self.joints);
        let kept = all.into_iter().filter(|number| !number.name.starts_with("header."));
        kept.map(|n| PlotField {
            name: format!("{}.{}", topic.name, n.name),
            unit: n.unit,
            topic,
            place: n.place,
        })
        .collect()
    }
}

/// Follows the records of one topic, whatever their type.
pub trait Follow {
    /// Adds the numbers at `places` of every new record whose tick is a multiple of `every`.
    fn follow(&mut self, places: &[usize], every: u64, new: &mut Numbers);
}

impl<T: Record> Follow for Reader<T> {
    fn follow(&mut self, places: &[usize], every: u64, new: &mut Numbers) {
        while let Some(record) = Reader::follow(self) {
            new.take(record, places, every);
        }
    }
}

/// A topic opened for plotting, and the tick of its newest record.
pub type Opened = Result<(Box<dyn Follow>, u64), IpcError>;

/// Origin of the records that are plotted: the topics of a running robot, or a log.
pub trait Source {
    /// Opens a topic.
    ///
    /// # Errors
    /// It cannot be read.
    fn open<T: Record>(&self, topic: &'static Topic) -> Opened;
}

struct Open<'a, S> {
    source: &'a S,
}

impl<S: Source> ForType<Opened> for Open<'_, S> {
    fn call<T: Record>(self, topic: &'static Topic) -> Opened {
        self.source.open::<T>(topic)
    }
}

impl Source for Space {
    fn open<T: Record>(&self, topic: &'static Topic) -> Opened {
        let mut reader = self.reader::<T>(topic)?;
        // What was before somebody looked is not plotted.
        let mut newest = 0;
        while let Some(record) = reader.follow() {
            newest = record.header().tick;
        }
        Ok((Box::new(reader), newest))
    }
}

/// Records of one topic since the last look.
#[derive(Default)]
pub struct Numbers {
    ticks: Vec<u64>,
    /// One row of places per tick.
    values: Vec<f64>,
    /// Tick of the newest record, asked for or not.
    newest: u64,
}

impl Numbers {
    /// Adds a record: its numbers at `places`, if its tick is a multiple of `every`.
    pub fn take(&mut self, record: &impl Record, places: &[usize], every: u64) {
        let tick = record.header().tick;
        self.newest = tick;
        if tick.is_multiple_of(every) {
            self.ticks.push(tick);
            pick(record, places, &mut self.values);
        }
    }
}

/// A topic that somebody plots.
struct Tap {
    topic: &'static Topic,
    follower: Box<dyn Follow>,
    /// Places that anybody plots, ascending.
    places: Vec<usize>,
    new: Numbers,
    /// The last value at each place, of topics that are not written each cycle.
    held: BTreeMap<usize, f64>,
}

impl Tap {
    fn has_every_cycle(&self) -> bool {
        self.topic.rate_hz >= EVERY_CYCLE
    }
}

/// Plot of one page: its fields, and the rows that wait for it.
#[derive(Debug, Default)]
pub struct Plot {
    /// Names in the order of the page, for its answer.
    pub fields: Vec<String>,
    /// Bus cycles from one row to the next.
    every: u64,
    columns: Vec<(&'static str, usize)>,
    rows: VecDeque<(u64, Vec<f32>)>,
    /// Tick of the last row that was sent.
    sent: u64,
    /// Tick behind which no row is wanted; none: all are.
    end: Option<u64>,
}

impl Plot {
    /// Of these fields at `rate` \[1/s\] of a robot with this bus cycle \[s\].
    ///
    /// # Errors
    /// There is no such field: which are near.
    pub fn new(fields: Vec<String>, rate: f64, cycle: f64, all: &[PlotField]) -> Result<Self, String> {
        let mut columns = Vec::new();
        for name in &fields {
            let Some(field) = all.iter().find(|field| field.name == *name) else {
                let names: Vec<&str> = all.iter().map(|field| field.name.as_str()).collect();
                return Err(messages::unknown("field", name, &names, "`fields` of hello has them all"));
            };
            columns.push((field.topic.name, field.place));
        }
        let every = (1.0 / (cycle * rate)).round().max(1.0) as u64;
        Ok(Self { fields, every, columns, rows: VecDeque::new(), sent: 0, end: None })
    }

    /// Rows per second, which is what the bus cycle allows.
    pub fn rate(&self, cycle: f64) -> f64 {
        1.0 / (cycle * self.every.max(1) as f64)
    }

    /// Rows of these ticks only, out of records that may be some around them; no more than `most`.
    #[must_use]
    pub fn within(mut self, first: u64, last: u64, most: u64) -> Self {
        let cycles = last.saturating_sub(first) + 1;
        self.every = self.every.max(cycles.div_ceil(most.max(1)));
        (self.sent, self.end) = (first.saturating_sub(1), Some(last));
        self
    }

    /// The row of a cycle; none: it has been sent.
    fn row(&mut self, tick: u64) -> Option<&mut Vec<f32>> {
        if tick <= self.sent || self.end.is_some_and(|end| tick > end) {
            return None;
        }
        let at = self.rows.partition_point(|(other, _)| *other < tick);
        if self.rows.get(at).is_none_or(|(other, _)| *other != tick) {
            self.rows.insert(at, (tick, vec![f32::NAN; self.columns.len()]));
        }
        self.rows.get_mut(at).map(|(_, row)| row)
    }

    /// Puts what came of a topic into its rows.
    fn absorb(&mut self, tap: &Tap, is_clock: bool) {
        let name = tap.topic.name;
        if !tap.has_every_cycle() || !is_clock && !self.columns.iter().any(|(topic, _)| *topic == name) {
            return;
        }
        // Column of the page, and where its value is in a row of the topic.
        let columns = self.columns.iter().enumerate().filter(|(_, (topic, _))| *topic == name);
        let cells: Vec<(usize, usize)> = columns
            .filter_map(|(column, (_, place))| Some((column, tap.places.binary_search(place).ok()?)))
            .collect();
        let (width, every) = (tap.places.len(), self.every.max(1));
        for (k, &tick) in tap.new.ticks.iter().enumerate().filter(|(_, tick)| tick.is_multiple_of(every)) {
            let values = &tap.new.values[k * width..(k + 1) * width];
            if let Some(row) = self.row(tick) {
                cells.iter().for_each(|&(column, at)| row[column] = values[at] as f32);
            }
        }
    }

    /// The rows up to `horizon`, as the content of a frame, and the tick of the last one; none: there are none.
    fn take(&mut self, horizon: u64, taps: &[Tap], cycle: f64) -> Option<(u64, Vec<u8>)> {
        let count = self.rows.partition_point(|(tick, _)| *tick <= horizon).min(MOST_ROWS);
        let last = self.rows.get(count.checked_sub(1)?)?.0;
        let held: Vec<Option<f32>> = (self.columns.iter())
            .map(|(topic, place)| {
                let tap = taps.iter().find(|tap| tap.topic.name == *topic && !tap.has_every_cycle())?;
                Some(tap.held.get(place).copied().unwrap_or(f64::NAN) as f32)
            })
            .collect();
        let mut bytes = Vec::with_capacity(4 + count * (8 + 4 * held.len()));
        bytes.extend((held.len() as u16).to_le_bytes());
        bytes.extend((count as u16).to_le_bytes());
        for (tick, row) in self.rows.drain(..count) {
            bytes.extend((tick as f64 * cycle).to_le_bytes());
            let cells = row.iter().zip(&held).map(|(cell, held)| held.unwrap_or(*cell));
            cells.for_each(|cell| bytes.extend(cell.to_le_bytes()));
        }
        self.sent = last;
        Some((last, bytes))
    }
}

/// Topics that are plotted, for all pages.
#[derive(Default)]
pub struct Taps {
    taps: Vec<Tap>,
    /// Ticks of which no page wants those between.
    every: u64,
}

impl Taps {
    /// Follows what these plots need, and nothing else.
    ///
    /// # Errors
    /// A topic cannot be read.
    pub fn follow<'p>(
        &mut self,
        source: &impl Source,
        plots: impl Iterator<Item = &'p Plot>,
    ) -> Result<(), IpcError> {
        let mut wanted: BTreeMap<&'static str, Vec<usize>> = BTreeMap::new();
        self.every = 0;
        for plot in plots.filter(|plot| !plot.columns.is_empty()) {
            wanted.entry(SENSORS.name).or_default();
            plot.columns.iter().for_each(|(topic, place)| wanted.entry(topic).or_default().push(*place));
            self.every = greatest_divisor(self.every, plot.every);
        }
        self.taps.retain(|tap| wanted.contains_key(tap.topic.name));
        for (name, mut places) in wanted {
            places.sort_unstable();
            places.dedup();
            match self.taps.iter_mut().find(|tap| tap.topic.name == name) {
                Some(tap) => tap.places = places,
                None => {
                    let Some(topic) = Topic::find(name) else { continue };
                    let Some(follower) = with_type(name, Open { source }) else { continue };
                    let (follower, newest) = follower?;
                    let (new, held) = (Numbers { newest, ..Numbers::default() }, BTreeMap::new());
                    self.taps.push(Tap { topic, follower, places, new, held });
                }
            }
        }
        // The clock first.
        self.taps.sort_by_key(|tap| tap.topic.name != SENSORS.name);
        Ok(())
    }

    /// Begins a plot behind what has been read of its topics: no row is there in part.
    pub fn begin(&self, plot: &mut Plot) {
        plot.sent = self.taps.iter().map(|tap| tap.new.newest).max().unwrap_or(0);
    }

    /// Reads what came since the last look.
    pub fn look(&mut self) {
        for tap in &mut self.taps {
            tap.new.ticks.clear();
            tap.new.values.clear();
            // Few records of a slow topic lie on the ticks of a plot: each of them counts.
            let every = if tap.has_every_cycle() { self.every.max(1) } else { 1 };
            tap.follower.follow(&tap.places, every, &mut tap.new);
            if !tap.has_every_cycle() {
                let last = tap.new.values.len().saturating_sub(tap.places.len());
                for (place, value) in tap.places.iter().zip(&tap.new.values[last..]) {
                    tap.held.insert(*place, *value);
                }
            }
        }
    }

    /// Rows that wait for topics which come no more.
    pub fn rest(&self, plot: &mut Plot, cycle: f64) -> Option<(u64, Vec<u8>)> {
        let clock = self.taps.first().map_or(0, |tap| tap.new.newest);
        plot.take(clock, &self.taps, cycle)
    }

    /// Rows that are ready for a page: content of a frame, and tick of its last row.
    pub fn samples(&self, plot: &mut Plot, cycle: f64) -> Option<(u64, Vec<u8>)> {
        if plot.columns.is_empty() {
            return None;
        }
        let clock = self.taps.first().map_or(0, |tap| tap.new.newest);
        let mut horizon = clock;
        for (k, tap) in self.taps.iter().enumerate() {
            plot.absorb(tap, k == 0);
            let used = plot.columns.iter().any(|(topic, _)| *topic == tap.topic.name);
            if used && tap.has_every_cycle() {
                horizon = horizon.min(tap.new.newest);
            }
        }
        plot.take(horizon.max(clock.saturating_sub(LATE)), &self.taps, cycle)
    }
}

/// Greatest common divisor; of 0 and a number, the number.
fn greatest_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}
