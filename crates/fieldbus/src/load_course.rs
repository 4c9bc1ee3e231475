//! Load of lines over time: how much of each piece of time their frames took.

use std::collections::BTreeMap;

/// \[ns\] Shortest piece.
pub const PIECE: u64 = 10_000_000;

/// Load of each line over time.
#[derive(Clone, Debug, Default)]
pub struct LoadCourse {
    /// \[s\] By line and number of the piece; pieces without a frame are not kept.
    occupied: BTreeMap<u32, BTreeMap<u64, f64>>,
    /// \[ns\] Time of the newest frame.
    end_ns: u64,
}

/// Load of one line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineCourse {
    /// Its index.
    pub line: u32,
    /// Middle of each piece \[s\], and the share of it that was occupied.
    pub points: Vec<[f64; 2]>,
    /// Largest share of a [`PIECE`].
    pub most: f64,
    /// Share of all of the time.
    pub mean: f64,
}

impl LoadCourse {
    /// Adds a frame that occupied `line` for `seconds`, `elapsed_ns` after the first frame of the recording.
    pub fn add(&mut self, line: u32, elapsed_ns: u64, seconds: f64) {
        *self.occupied.entry(line).or_default().entry(elapsed_ns / PIECE).or_default() += seconds;
        self.end_ns = self.end_ns.max(elapsed_ns);
    }

    /// The load of all lines, each in at most `most` pieces of one length, which is also returned \[s\].
    pub fn lines(&self, most: usize) -> (f64, Vec<LineCourse>) {
        let pieces = self.end_ns.div_ceil(PIECE).max(1);
        let merged = pieces.div_ceil(most.max(1) as u64).max(1);
        let columns = pieces.div_ceil(merged);
        let length = |first: u64, count: u64| {
            let end = (first + count).saturating_mul(PIECE).min(self.end_ns.max(1));
            end.saturating_sub(first * PIECE).max(1) as f64 * 1e-9
        };
        let course = |(line, occupied): (&u32, &BTreeMap<u64, f64>)| {
            let point = |column: u64| {
                let (first, seconds) = (column * merged, length(column * merged, merged));
                // A frame at the very end belongs to the last piece.
                let end = if column + 1 == columns { u64::MAX } else { first + merged };
                let sum: f64 = occupied.range(first..end).map(|(_, s)| s).sum();
                [first as f64 * PIECE as f64 * 1e-9 + seconds / 2.0, sum / seconds]
            };
            let whole =
                occupied.iter().filter(|(piece, _)| (**piece + 1).saturating_mul(PIECE) <= self.end_ns);
            LineCourse {
                line: *line,
                points: (0..columns).map(point).collect(),
                most: whole.map(|(_, s)| s / (PIECE as f64 * 1e-9)).fold(0.0, f64::max),
                mean: occupied.values().sum::<f64>() / length(0, pieces),
            }
        };
        (length(0, merged), self.occupied.iter().map(course).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_each_piece_and_their_mean_that_of_all() {
        let mut course = LoadCourse::default();
        // 100 ms: 2 ms of every 10, but 8 ms of the fifth 10; on another line nothing but one frame.
        for k in 0..10 {
            course.add(0, k * PIECE, if k == 4 { 8e-3 } else { 2e-3 });
        }
        course.add(3, 10 * PIECE, 0.0);
        let (piece, lines) = course.lines(5);
        assert!((piece - 0.02).abs() < 1e-12 && lines.len() == 2 && lines[1].line == 3);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
        near(lines[0].most, 0.8);
        near(lines[0].mean, 0.26);
        near(lines[0].points[2][0], 0.05);
        near(lines[0].points[2][1], 0.5);
        near(lines[0].points[0][1], 0.2);
    }

    /// Only pieces with frames are kept: times that lie far apart cost nothing, and there are no more points than asked for.
    #[test]
    fn times_far_apart_give_few_points() {
        let mut course = LoadCourse::default();
        course.add(0, 0, 1e-4);
        course.add(0, u64::MAX, 1e-4);
        assert!(course.lines(300).1[0].points.len() <= 300);
    }
}
