//! Dead time of a signal (thesis 2.5), in the time of the integration's steps: what lies between two of them is interpolated.

/// A signal of the past.
#[derive(Clone, Debug)]
pub struct DelayLine<T> {
    /// Newest values, one per step; empty until the first.
    values: Vec<T>,
    newest: usize,
    /// \[steps\] Dead time, of which `share` \[1\] is the last, begun one.
    whole: usize,
    share: f64,
}

/// \[steps\] The longest dead time.
const LONGEST: f64 = 100_000.0;
/// \[steps\] Rounding of a dead time that is meant to be whole steps.
const WHOLE: f64 = 1e-9;

impl<T: Copy> DelayLine<T> {
    /// `delay` and `step` in s.
    pub fn new(delay: f64, step: f64) -> Self {
        let steps = (delay / step).clamp(0.0, LONGEST);
        let near = (steps - steps.round()).abs() < WHOLE;
        let (whole, share) = if near { (steps.round(), 0.0) } else { (steps.floor(), steps.fract()) };
        let whole = whole as usize;
        Self { values: Vec::with_capacity(whole + 2), newest: 0, whole, share }
    }

    /// The value of one more step. The first one has always been there.
    pub fn push(&mut self, value: T) {
        if self.values.is_empty() {
            self.values.resize(self.whole + 2, value); // within its capacity
        }
        self.newest = (self.newest + 1) % self.values.len();
        self.values[self.newest] = value;
    }

    /// The values between which the dead time ends, the older one first, and the share \[1\] of the older.
    ///
    /// # Panics
    /// Nothing was pushed.
    pub fn read(&self) -> (&T, &T, f64) {
        let back = |steps: usize| &self.values[(self.newest + self.values.len() - steps) % self.values.len()];
        (back(self.whole + 1), back(self.whole), self.share)
    }

    /// The newest value that is at least as old as the dead time.
    ///
    /// # Panics
    /// Nothing was pushed.
    pub fn arrived(&self) -> T {
        let (older, newer, share) = self.read();
        if share > 0.0 { *older } else { *newer }
    }

    /// A component of the value at the dead time, on the chord between two steps.
    pub fn chord(&self, component: impl Fn(&T) -> f64) -> f64 {
        let (older, newer, share) = self.read();
        let newer = component(newer);
        if share > 0.0 { newer + share * (component(older) - newer) } else { newer }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed(delay: f64) -> Vec<f64> {
        let mut line = DelayLine::new(delay, 1e-3);
        let pass = |i: i32| {
            line.push(f64::from(i));
            line.chord(|x| *x)
        };
        (10..20).map(pass).collect()
    }

    #[test]
    fn delays() {
        assert_eq!(passed(0.0), [10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0, 18.0, 19.0]);
        assert_eq!(passed(0.003), [10.0, 10.0, 10.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0]);
        assert_eq!(passed(0.0015), [10.0, 10.0, 10.5, 11.5, 12.5, 13.5, 14.5, 15.5, 16.5, 17.5]);
    }

    #[test]
    fn what_arrives_is_never_younger_than_the_dead_time() {
        for (delay, age) in [(0.0, 0), (0.002, 2), (0.0021, 3), (0.0029, 3)] {
            let mut line = DelayLine::new(delay, 1e-3);
            for i in 0..20 {
                line.push(i);
                assert_eq!(line.arrived(), (i - age).max(0), "{delay} s, step {i}");
            }
        }
    }

    #[test]
    fn takes_no_room_beyond_the_longest_dead_time() {
        for delay in [1e9, f64::INFINITY, f64::NAN] {
            let mut line = DelayLine::new(delay, 1e-3);
            line.push(1u8);
            assert!(line.values.capacity() <= LONGEST as usize + 2, "{delay}");
        }
    }
}
