//! Measurements as a table, as JSON, and as a picture.

use std::fmt::Write;
use std::path::Path;

use drawing::{Chart, Color, Figure, color};
use latency::SIZE;
use serde::Serialize;

use super::WakeUp;

/// One way between two processes.
#[derive(Clone, Debug, Serialize)]
pub struct LatencyRow {
    /// Its name.
    pub way: &'static str,
    /// Wake-up of the other end.
    pub kind: WakeUp,
    /// \[us\] Half of a round trip: p50, p99, p99.9, max.
    pub us: Option<[f64; 4]>,
    /// Messages sent to and fro.
    pub messages: usize,
    /// Reason why it was not measured, or not in every round.
    pub problem: Option<String>,
    #[serde(skip)]
    ns: Vec<u64>,
}

/// All ways, and what the machine gives to anybody.
#[derive(Clone, Debug, Serialize)]
pub struct LatencyReport {
    /// Bytes of a message.
    pub bytes: usize,
    /// \[us\] Lateness of `cyclictest` between the rounds, medians over them: p50, p99, p99.9; and the max.
    pub cyclictest_us: Option<[u64; 4]>,
    /// The ways.
    pub ways: Vec<LatencyRow>,
    #[serde(skip)]
    lateness: Vec<[u64; 4]>,
}

impl LatencyRow {
    pub(super) fn new(way: &'static str, kind: WakeUp) -> Self {
        Self { way, kind, us: None, messages: 0, problem: None, ns: Vec::new() }
    }

    /// Time \[us\] that this share of the messages does not exceed.
    fn quantile(&self, share: f64) -> f64 {
        self.ns[((self.ns.len() - 1) as f64 * share).round() as usize] as f64 * 1e-3
    }
}

impl LatencyReport {
    pub(super) fn new(ways: Vec<LatencyRow>) -> Self {
        Self { bytes: SIZE, cyclictest_us: None, ways, lateness: Vec::new() }
    }

    /// One more run of cyclictest.
    pub(super) fn hear(&mut self, found: Result<[u64; 4], String>) {
        self.lateness.extend(found.ok());
        let mut sorted: [Vec<u64>; 4] = std::array::from_fn(|k| self.lateness.iter().map(|l| l[k]).collect());
        sorted.iter_mut().for_each(|v| v.sort_unstable());
        let [p50, p99, p999, max] = &sorted;
        let middle = |v: &[u64]| v.get(v.len() / 2).copied();
        self.cyclictest_us = (|| Some([middle(p50)?, middle(p99)?, middle(p999)?, *max.last()?]))();
    }

    /// One more round of a way.
    pub(super) fn add(&mut self, row: usize, found: Result<Vec<u64>, String>) {
        let row = &mut self.ways[row];
        match found {
            Ok(times) => row.ns.extend(times),
            Err(problem) => row.problem = Some(problem),
        }
        if !row.ns.is_empty() {
            row.ns.sort_unstable();
            row.messages = row.ns.len();
            row.us = Some([0.5, 0.99, 0.999, 1.0].map(|share| row.quantile(share)));
        }
    }

    /// Lines for people.
    pub fn table(&self) -> String {
        let mut text = format!(
            "Half of a round trip of {} bytes [us]\n{:40}{:>9}{:>9}{:>9}{:>10}{:>10}\n",
            self.bytes, "", "p50", "p99", "p99.9", "max", "messages"
        );
        for row in &self.ways {
            let kind = format!("{:?}", row.kind).to_lowercase();
            let _ = write!(text, "{:9}{:31}", kind, row.way);
            if let Some([p50, p99, p999, max]) = row.us {
                let _ = write!(text, "{p50:9.2}{p99:9.2}{p999:9.2}{max:10.2}{:10}", row.messages);
            }
            let _ = writeln!(text, "{}", row.problem.as_ref().map_or(String::new(), |p| format!("  {p}")));
        }
        if let Some([p50, p99, p999, max]) = self.cyclictest_us {
            let _ = write!(text, "{:40}{p50:9}{p99:9}{p999:9}{max:10}", "cyclictest, lateness of a wake-up");
        } else {
            text += "cyclictest did not run (Debian and Ubuntu: apt install rt-tests; it needs the right to SCHED_FIFO)";
        }
        text
    }

    /// The picture: how many messages took longer than a time.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn draw(&self, file: &Path) -> Result<(), String> {
        let about = "Share of the messages that took longer. Polled: the other process looks all the time; woken: it sleeps until then.";
        let mut figure = Figure::new("Telling another process something", about);
        const COLORS: [Color; 5] =
            [color::BLUE, color::VERMILION, color::GREEN, color::PURPLE, color::ORANGE];
        for (kind, title) in [
            (WakeUp::Polled, "Polled, two cores"),
            (WakeUp::Woken, "Woken, one core"),
            (WakeUp::Brokered, "Through the broker"),
        ] {
            let mut chart = Chart::new(title, "time, one way [us]", "share of messages [1]").logarithmic();
            let rows = self.ways.iter().filter(|row| row.kind == kind && !row.ns.is_empty());
            for (row, color) in rows.zip(COLORS) {
                // Tenths of a decade of the share, down to the slowest message.
                let shares = (0..60).map(|k| 10f64.powf(-f64::from(k) / 10.0));
                let shares = shares.take_while(|share| share * row.ns.len() as f64 >= 1.0);
                let points = shares.map(|share| [row.quantile(1.0 - share), share]).collect();
                chart.line(row.way, points, color);
            }
            figure = figure.with(chart);
        }
        figure.save(file)
    }
}
