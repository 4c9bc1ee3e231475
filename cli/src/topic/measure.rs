//! `gangwerk topic hz|bw|delay`: how often a topic is written, how many bytes that is, and how old a record is when it comes.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use ipc::Mode;
use messages::Record;
use messages::topics::{ForType, Topic, with_type};
use realtime::clock;

use super::{ObservedRobot, find};

/// Between two looks: what an age is measured to.
const LOOK: Duration = Duration::from_micros(100);

/// Measured quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Records per second, and the periods between their stamps.
    Rate,
    /// Bytes per second.
    Bandwidth,
    /// From a record's stamp, the beginning of its bus cycle, to its arrival here.
    Delay,
}

/// Measures a topic of the robot in `dir` for so many `seconds`, and prints what is found.
///
/// # Errors
/// No such topic, no robot runs in `dir`, or nothing came.
pub fn measure(dir: &Path, name: &str, what: Measure, seconds: f64) -> Result<(), Box<dyn Error>> {
    let topic = find(name)?;
    if !(seconds.is_finite() && seconds > 0.0) {
        return Err("--seconds: a number above 0 is needed".into());
    }
    let robot = ObservedRobot::open(dir)?;
    if what == Measure::Delay && robot.mode == Mode::Lockstep {
        return Err(
            "this robot runs in simulated time (--lockstep): its stamps say nothing about ages".into()
        );
    }
    with_type(topic.name, Listener { robot: &robot, what, seconds }).unwrap_or(Ok(()))
}

/// Least, mean, greatest and standard deviation of a quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Spread {
    count: f64,
    mean: f64,
    /// Sum of squared deviations from the mean.
    squares: f64,
    least: f64,
    most: f64,
}

impl Spread {
    /// Another value, by Welford's recurrence.
    fn add(&mut self, x: f64) {
        if self.count == 0.0 {
            (self.least, self.most) = (x, x);
        }
        (self.least, self.most) = (self.least.min(x), self.most.max(x));
        self.count += 1.0;
        let before = x - self.mean;
        self.mean += before / self.count;
        self.squares += before * (x - self.mean);
    }

    /// In milliseconds, of seconds.
    fn text(&self) -> String {
        let deviation = if self.count > 1.0 { (self.squares / (self.count - 1.0)).sqrt() } else { 0.0 };
        let [mean, least, most, std] = [self.mean, self.least, self.most, deviation].map(|x| x * 1e3);
        format!("mean {mean:.3} ms, min {least:.3}, max {most:.3}, std {std:.3}")
    }
}

struct Listener<'a> {
    robot: &'a ObservedRobot,
    what: Measure,
    seconds: f64,
}

impl ForType<Result<(), Box<dyn Error>>> for Listener<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), Box<dyn Error>> {
        let mut reader = self.robot.space.reader::<T>(topic)?;
        // What is kept from before says nothing about now.
        let mut last = None;
        while let Some(record) = reader.follow() {
            last = Some(record.header().stamp_ns);
        }
        let (lost, begun) = (reader.lost(), clock::now());
        let (mut count, mut periods, mut ages) = (0u64, Spread::default(), Spread::default());
        while clock::now() - begun < (self.seconds * 1e9) as u64 {
            while let Some(record) = reader.follow() {
                let stamp = record.header().stamp_ns;
                count += 1;
                ages.add(clock::now().saturating_sub(stamp) as f64 * 1e-9);
                if let Some(last) = last.replace(stamp) {
                    periods.add(stamp.saturating_sub(last) as f64 * 1e-9);
                }
            }
            std::thread::park_timeout(LOOK);
        }
        let seconds = (clock::now() - begun) as f64 * 1e-9;
        let lost = reader.lost() - lost;
        let (all, name) = (count + lost, topic.name);
        let rate = all as f64 / seconds;
        if all == 0 {
            return Err(format!("{name}: no record came within {seconds:.1} s").into());
        }
        match self.what {
            Measure::Rate => {
                println!("{name}: {rate:.1} Hz over {seconds:.1} s ({all} records)");
                println!("period by the stamps: {}", periods.text());
            }
            Measure::Bandwidth => {
                let bytes = size_of::<T>();
                println!("{name}: {:.3} MB/s ({bytes} bytes, {rate:.1} Hz)", rate * bytes as f64 * 1e-6);
            }
            Measure::Delay => println!("{name}: age when it comes: {}", ages.text()),
        }
        if lost > 0 {
            println!("{lost} of them came faster than they could be looked at");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn spread_of_known_numbers() {
        let mut spread = Spread::default();
        [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].iter().for_each(|x| spread.add(x * 1e-3));
        // Sum of squares 32 over 7: 2.138.
        assert_eq!(spread.text(), "mean 5.000 ms, min 2.000, max 9.000, std 2.138");
    }
}
