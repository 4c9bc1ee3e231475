//! A drive that plays a table of points (PT mode): its memory, its read pointer as in thesis figure 6.2, its motion.
//!
//! Pure, and in the drive's own time: ticks of its position controller, T_s each. The registers hold the next motion while the
//! present one goes on; a begin that was asked for comes with the SYNC that it names. A motion begins where and as fast as
//! the reference is: at rest, or at the point of the running table at which the new one takes over.

use crate::point_table::{Cubic, MOST_POINTS, MOST_SPACING, speed};

/// \[1\] SYNC counters are bytes: of those half a turn ahead of a begin, it has passed.
const HALF_TURN: u8 = 128;
/// \[count/T\] Speed at the end of a table from which it does not end at rest.
const REST: f64 = 1e-9;
/// \[tick\] Rounding of times.
const ROUNDING: f64 = 1e-6;

/// Motion in the registers of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableMotion {
    /// \[1\] First and last point, from 1: `MP[1]`, `MP[2]`.
    pub first: usize,
    /// See `first`.
    pub last: usize,
    /// The last point is followed by the first one: `MP[3]`.
    pub cyclic: bool,
    /// \[tick\] From point to point, m: `MP[4]`.
    pub spacing: u32,
    /// \[1\] Point to begin with, from 1: `PT`; 0: none is chosen.
    pub begin: usize,
}

/// A table that is being played.
#[derive(Clone, Copy, Debug)]
struct Playing {
    motion: TableMotion,
    /// \[1\] Read pointer, from 1: the present cubic leads to the point behind it.
    pointer: usize,
    cubic: Cubic,
    /// \[tick\] Length of the cubic, and how much of it has passed.
    length: f64,
    passed: f64,
}

/// Part of a reference: from `from` \[tick\] of the cycle on, a polynomial of the time since then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Piece {
    /// \[tick\] Since the beginning of the cycle.
    pub from: f64,
    /// Coefficients of the position \[count, count/tick, ...\], constant term first.
    pub c: [f64; 4],
}

/// Result of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Played {
    /// No table is played.
    Nothing,
    /// The reference in this cycle: one piece, or two if a point was passed.
    Pieces(Piece, Option<Piece>),
    /// The table has come to its end, but not to rest; nothing is played any more.
    Exhausted,
}

/// A drive's memory and motion.
#[derive(Clone, Debug)]
pub struct TablePlayer {
    points: Box<[i32; MOST_POINTS]>,
    /// Registers: the next motion.
    pub next: TableMotion,
    /// SYNC with which it begins.
    begin: Option<u8>,
    playing: Option<Playing>,
}

impl Default for TablePlayer {
    fn default() -> Self {
        Self { points: Box::new([0; MOST_POINTS]), next: AT_START, begin: None, playing: None }
    }
}

/// Registers of a drive that has just started.
const AT_START: TableMotion =
    TableMotion { first: 1, last: MOST_POINTS, cyclic: false, spacing: 1, begin: 0 };

impl TablePlayer {
    /// Starts anew, with an empty memory.
    pub fn restart(&mut self) {
        self.points.fill(0);
        (self.next, self.begin, self.playing) = (AT_START, None, None);
    }

    /// Point `i`, from 1; none if there is no such point.
    pub fn point(&self, i: usize) -> Option<i32> {
        self.points.get(i.checked_sub(1)?).copied()
    }

    /// Writes point `i`, from 1; false if there is none, or if it is being played.
    pub fn write(&mut self, i: usize, position: i32) -> bool {
        let played = self.playing.is_some_and(|p| (p.motion.first..=p.motion.last).contains(&i));
        match i.checked_sub(1).and_then(|i| self.points.get_mut(i)).filter(|_| !played) {
            Some(point) => *point = position,
            None => return false,
        }
        true
    }

    /// Chooses the point to begin with, and takes back a begin that has not come; false if the registers hold no motion.
    pub fn choose(&mut self, point: usize) -> bool {
        let TableMotion { first, last, spacing, .. } = self.next;
        let whole =
            1 <= first && first < last && last <= MOST_POINTS && (1..=MOST_SPACING).contains(&spacing);
        let good = whole && (first..=last).contains(&point);
        self.begin = None;
        self.next.begin = if good { point } else { 0 };
        good
    }

    /// Begins the motion in the registers with the SYNC of this counter; false if none is chosen, or a point is passed more
    /// than once in a cycle of `cycle` \[tick\].
    pub fn begin_with(&mut self, counter: u8, cycle: f64) -> bool {
        let good = self.next.begin > 0 && f64::from(self.next.spacing) >= cycle - ROUNDING;
        self.begin = good.then_some(counter);
        good
    }

    /// True if a table is played.
    pub fn plays(&self) -> bool {
        self.playing.is_some()
    }

    /// \[1\] The read pointer, from 1; 0 while nothing is played.
    pub fn pointer(&self) -> usize {
        self.playing.map_or(0, |p| p.pointer)
    }

    /// Stops: whatever is played or to begin is forgotten.
    pub fn stop(&mut self) {
        (self.playing, self.begin) = (None, None);
    }

    /// SYNC with this counter, before a cycle of `cycle` \[tick\]; the reference is at `now`: \[count\], \[count/tick\].
    ///
    /// A drive that did not hear the SYNC it was to begin with begins late, and is in time from the next point on.
    pub fn sync(&mut self, counter: u8, cycle: f64, now: [f64; 2]) {
        let Some(late) = self.begin.map(|begin| counter.wrapping_sub(begin)).filter(|d| *d < HALF_TURN)
        else {
            return;
        };
        // Taken over at the nearest point of the running table, whose own time goes on.
        let mut phase = f64::from(late) * cycle;
        if let Some(running) = &self.playing {
            let spacing = f64::from(running.motion.spacing);
            let behind = (running.passed - running.length - phase).rem_euclid(spacing);
            phase += if behind > 0.5 * spacing { behind - spacing } else { behind };
        }
        if phase < -ROUNDING {
            return; // its point comes soon: the next SYNC asks again
        }
        self.begin = None;
        let motion = self.next;
        self.next.begin = 0;
        let spacing = f64::from(motion.spacing);
        let mut pointer = motion.begin;
        let mut ahead = phase;
        while ahead >= spacing - ROUNDING {
            ahead -= spacing;
            pointer = after(&motion, pointer).unwrap_or(motion.last);
        }
        let length = spacing - ahead.max(0.0);
        let scaled = [now[0], now[1] * length];
        let cubic = self.towards(&motion, pointer, scaled, length / spacing);
        self.playing = Some(Playing { motion, pointer, cubic, length, passed: 0.0 });
    }

    /// Cubic from a position and speed to the point behind the pointer, over this share of the time from point to point.
    fn towards(&self, motion: &TableMotion, pointer: usize, from: [f64; 2], share: f64) -> Cubic {
        let points = &self.points[motion.first - 1..motion.last];
        let Some(next) = after(motion, pointer) else {
            return Cubic::between(from, [f64::from(points[points.len() - 1]), 0.0]);
        };
        let i = next - motion.first;
        Cubic::between(from, [f64::from(points[i]), share * speed(points, i, motion.cyclic)])
    }

    /// A cycle of `cycle` \[tick\] of the drive's own clock.
    pub fn advance(&mut self, cycle: f64) -> Played {
        let Some(mut playing) = self.playing else { return Played::Nothing };
        // The pointer moves on as the cycle begins, and once more within it at most.
        if playing.length - playing.passed <= ROUNDING {
            match self.turn(&playing) {
                Some(next) => playing = next,
                None => return self.end(&playing),
            }
        }
        let first = piece(&playing, 0.0);
        let left = playing.length - playing.passed;
        if cycle <= left + ROUNDING {
            playing.passed += cycle;
            self.playing = Some(playing);
            return Played::Pieces(first, None);
        }
        let Some(mut next) = self.turn(&playing) else {
            playing.passed = playing.length; // it waits at its end, and says so in the next cycle
            self.playing = Some(playing);
            let [p, v, _] = playing.cubic.at(1.0);
            let rest = Piece { from: left, c: [p, v / playing.length, 0.0, 0.0] };
            return Played::Pieces(first, Some(rest));
        };
        let second = piece(&next, left);
        next.passed = cycle - left;
        self.playing = Some(next);
        Played::Pieces(first, Some(second))
    }

    /// Read pointer to the next point, and the cubic from there; none at the end of the table.
    fn turn(&self, playing: &Playing) -> Option<Playing> {
        let motion = playing.motion;
        let pointer = after(&motion, playing.pointer)?;
        after(&motion, pointer)?;
        let spacing = f64::from(motion.spacing);
        let [p, v, _] = playing.cubic.at(1.0);
        let cubic = self.towards(&motion, pointer, [p, v * spacing / playing.length], 1.0);
        Some(Playing { motion, pointer, cubic, length: spacing, passed: 0.0 })
    }

    /// The table is over.
    fn end(&mut self, playing: &Playing) -> Played {
        self.playing = None;
        if playing.cubic.at(1.0)[1].abs() > REST { Played::Exhausted } else { Played::Nothing }
    }
}

/// Point after a point of a motion; none after the last one.
fn after(motion: &TableMotion, point: usize) -> Option<usize> {
    match (point < motion.last, motion.cyclic) {
        (true, _) => Some(point + 1),
        (false, true) => Some(motion.first),
        (false, false) => None,
    }
}

/// What is left of a cubic, from `from` \[tick\] of the cycle on.
fn piece(playing: &Playing, from: f64) -> Piece {
    let (u, d) = (playing.passed / playing.length, 1.0 / playing.length);
    let ([p, v, a], c3) = (playing.cubic.at(u), playing.cubic.c[3]);
    Piece { from, c: [p, v * d, 0.5 * a * d * d, c3 * d * d * d] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point_table;

    /// A cycle of 8 ms at 320 us.
    const CYCLE: f64 = 25.0;

    fn loaded(points: &[i32], at: usize, cyclic: bool, spacing: u32) -> TablePlayer {
        let mut player = TablePlayer::default();
        load(&mut player, points, at, cyclic, spacing);
        player
    }

    fn load(player: &mut TablePlayer, points: &[i32], at: usize, cyclic: bool, spacing: u32) {
        for (i, p) in points.iter().enumerate() {
            assert!(player.write(at + i, *p));
        }
        player.next = TableMotion { first: at, last: at + points.len() - 1, cyclic, spacing, begin: 0 };
        assert!(player.choose(at));
    }

    fn sine(n: usize) -> Vec<i32> {
        (0..n).map(|i| (5000.0 * (std::f64::consts::TAU * i as f64 / n as f64).cos()) as i32).collect()
    }

    fn at(piece: &Piece, x: f64) -> [f64; 2] {
        let (c, x) = (&piece.c, x - piece.from);
        [c[0] + x * (c[1] + x * (c[2] + x * c[3])), c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])]
    }

    /// Position and speed at the end of a cycle, if a table is played.
    fn end_of(played: Played, cycle: f64) -> Option<[f64; 2]> {
        match played {
            Played::Pieces(_, Some(second)) => Some(at(&second, cycle)),
            Played::Pieces(first, None) => Some(at(&first, cycle)),
            _ => None,
        }
    }

    /// In the cycle k of a table with m = 250: point k / 10, then a tenth of the cubic further each cycle.
    #[test]
    fn the_read_pointer_moves_on_after_m_samples_and_the_cubics_are_the_tables() {
        let points = sine(300);
        let mut player = loaded(&points, 1, true, 250);
        assert!(player.begin_with(7, CYCLE));
        player.sync(6, CYCLE, [5000.0, 0.0]);
        assert_eq!(player.advance(CYCLE), Played::Nothing, "not yet");
        player.sync(7, CYCLE, [5000.0, 0.0]);
        for k in 0..3200 {
            let now = end_of(player.advance(CYCLE), CYCLE).unwrap();
            let (i, u) = (k / 10 % 300, (k % 10 + 1) as f64 / 10.0);
            assert_eq!(player.pointer(), i + 1, "cycle {k}");
            if k >= 10 {
                let [p, v, _] = point_table::cubic(&points, i, true).at(u);
                assert!(
                    (now[0] - p).abs() < 1e-8 && (now[1] - v / 250.0).abs() < 1e-9,
                    "cycle {k}: {now:?} {p}"
                );
            }
        }
    }

    /// m = 42 with cycles of 25 samples: most points are passed within a cycle. Position and speed are continuous.
    #[test]
    fn a_point_within_a_cycle_is_passed_there() {
        let points = sine(100);
        let mut player = loaded(&points, 1, true, 42);
        assert!(player.begin_with(0, CYCLE));
        player.sync(0, CYCLE, [5000.0, 0.0]);
        let (mut last, mut passed) = ([5000.0, 0.0], 0);
        for k in 0..2000u32 {
            let Played::Pieces(first, second) = player.advance(CYCLE) else { panic!("cycle {k}") };
            let begin = at(&first, 0.0);
            assert!((begin[0] - last[0]).abs() < 1e-7 && (begin[1] - last[1]).abs() < 1e-9, "cycle {k}");
            last = at(&first, CYCLE);
            if let Some(second) = second {
                passed += 1;
                let ([a, va], [b, vb]) = (at(&first, second.from), at(&second, second.from));
                assert!((a - b).abs() < 1e-8 && (va - vb).abs() < 1e-10, "cycle {k}");
                last = at(&second, CYCLE);
            }
            let t = f64::from(k + 1) * CYCLE / 42.0;
            if t > 1.0 {
                let [p, ..] = point_table::cubic(&points, t as usize % 100, true).at(t.fract());
                assert!((last[0] - p).abs() < 1e-6, "cycle {k}: {last:?} {p}");
            }
        }
        assert!(passed > 1000, "{passed}");
    }

    #[test]
    fn a_table_that_ends_at_rest_is_over_and_one_that_does_not_says_so() {
        let mut player = loaded(&[0, 0, 500, 1000, 1000], 1, false, 25);
        assert!(player.begin_with(0, CYCLE));
        player.sync(0, CYCLE, [0.0, 0.0]);
        let mut last = [0.0; 2];
        for _ in 0..4 {
            last = end_of(player.advance(CYCLE), CYCLE).unwrap();
        }
        assert!(last[0] == 1000.0 && last[1].abs() < 1e-12 && player.advance(CYCLE) == Played::Nothing);
        let mut player = loaded(&[0, 0, 500, 1000], 1, false, 25);
        assert!(player.begin_with(0, CYCLE));
        player.sync(0, CYCLE, [0.0, 0.0]);
        (0..3).for_each(|_| _ = player.advance(CYCLE));
        assert_eq!(player.advance(CYCLE), Played::Exhausted);
        assert!(!player.plays());
    }

    /// The second table begins at the point of the first one at which it takes over: nothing jumps.
    #[test]
    fn a_table_beside_the_running_one_takes_over_at_a_point() {
        let mut player = loaded(&sine(300), 1, true, 250);
        assert!(player.begin_with(0, CYCLE));
        player.sync(0, CYCLE, [5000.0, 0.0]);
        let mut last = [5000.0, 0.0];
        for _ in 0..1000 {
            last = end_of(player.advance(CYCLE), CYCLE).unwrap();
        }
        assert!(!player.write(300, 0), "the table that is played cannot be written");
        // At point 100 it goes on into a table that slows down.
        let p = f64::from(player.point(101).unwrap());
        assert_eq!(last[0], p);
        let rest: Vec<i32> =
            (0..20).map(|i| (p + 1000.0 * (1.0 - (-0.2 * f64::from(i)).exp())) as i32).collect();
        load(&mut player, &rest, 301, true, 250);
        assert!(player.begin_with(232, CYCLE) && player.pointer() == 100);
        player.sync(232, CYCLE, last);
        let Played::Pieces(first, None) = player.advance(CYCLE) else { panic!() };
        assert_eq!((player.pointer(), at(&first, 0.0)), (301, last));
    }

    #[test]
    fn a_drive_that_missed_its_sync_is_in_time_from_the_next_point_on() {
        let points = sine(300);
        let [mut on_time, mut late] = [loaded(&points, 1, true, 250), loaded(&points, 1, true, 250)];
        assert!(on_time.begin_with(250, CYCLE) && late.begin_with(250, CYCLE));
        for k in 0..60u8 {
            let counter = 250u8.wrapping_add(k);
            on_time.sync(counter, CYCLE, [5000.0, 0.0]);
            if k != 0 {
                late.sync(counter, CYCLE, [5000.0, 0.0]);
            }
            let (a, b) = (on_time.advance(CYCLE), late.advance(CYCLE));
            if k >= 10 {
                let ([a, va], [b, vb]) = (end_of(a, CYCLE).unwrap(), end_of(b, CYCLE).unwrap());
                assert!((a - b).abs() < 1e-7 && (va - vb).abs() < 1e-9, "cycle {k}");
            }
        }
    }

    #[test]
    fn what_the_registers_do_not_hold_is_refused() {
        let mut player = TablePlayer::default();
        assert!(!player.write(0, 1) && !player.write(1025, 1) && player.write(1024, 1));
        assert_eq!([0, 1025].map(|i| player.point(i)), [None; 2]);
        player.next.last = 0;
        assert!(!player.choose(1) && !player.begin_with(0, CYCLE), "no motion");
        load(&mut player, &sine(50), 1, false, 24);
        assert!(!player.begin_with(0, CYCLE), "more than one point in a cycle");
        load(&mut player, &sine(50), 1, false, 25);
        assert!(!player.choose(51) && player.choose(50) && player.begin_with(0, CYCLE));
        assert!(player.choose(1));
        player.sync(0, CYCLE, [0.0; 2]);
        assert!(!player.plays(), "another choice takes a begin back");
    }
}
