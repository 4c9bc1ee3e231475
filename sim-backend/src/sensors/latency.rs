//! Readings that are older than their cycle: a sensor that is slower than the bus, and dead time (thesis 2.5).

/// Takes a new value once per period and hands it on some cycles later.
#[derive(Clone, Debug)]
pub struct Latency<T> {
    /// \[cycles\] Between two new values.
    period: u32,
    /// \[cycles\] Since the last new value.
    age: u32,
    held: Option<T>,
    /// Values on their way, oldest at `oldest`.
    waiting: Vec<T>,
    oldest: usize,
    /// \[cycles\] Dead time.
    delay: usize,
}

/// \[cycles\] The longest dead time.
const LONGEST: f64 = 1000.0;

impl<T: Copy> Latency<T> {
    /// All times in s; they are rounded to whole cycles. Zeros pass every value at once.
    pub fn new(delay: f64, period: f64, cycle: f64) -> Self {
        let cycles = |time: f64| (time / cycle).round().clamp(0.0, LONGEST);
        let delay = cycles(delay) as usize;
        let period = cycles(period).max(1.0) as u32;
        Self { period, age: 0, held: None, waiting: Vec::with_capacity(delay), oldest: 0, delay }
    }

    /// One cycle: value in, value out. Until the dead time has passed, the first value comes out.
    pub fn pass(&mut self, value: T) -> T {
        let held = if self.age == 0 { value } else { self.held.unwrap_or(value) };
        self.held = Some(held);
        self.age = (self.age + 1) % self.period;
        if self.waiting.len() < self.delay {
            self.waiting.push(held); // within its capacity
            return self.waiting[0];
        }
        match self.waiting.get_mut(self.oldest) {
            Some(oldest) => {
                self.oldest = (self.oldest + 1) % self.delay;
                std::mem::replace(oldest, held)
            }
            None => held,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed(delay: f64, period: f64) -> Vec<i32> {
        let mut latency = Latency::new(delay, period, 1e-3);
        (10..20).map(|i| latency.pass(i)).collect()
    }

    #[test]
    fn delays_and_holds() {
        assert_eq!(passed(0.0, 0.0), [10, 11, 12, 13, 14, 15, 16, 17, 18, 19]);
        assert_eq!(passed(0.003, 0.0), [10, 10, 10, 10, 11, 12, 13, 14, 15, 16]);
        assert_eq!(passed(0.0, 0.004), [10, 10, 10, 10, 14, 14, 14, 14, 18, 18]);
        assert_eq!(passed(0.002, 0.004), [10, 10, 10, 10, 10, 10, 14, 14, 14, 14]);
    }

    #[test]
    fn takes_no_room_beyond_the_longest_dead_time() {
        for delay in [1e9, f64::INFINITY, f64::NAN] {
            let mut latency = Latency::new(delay, delay, 1e-3);
            // In the 3000th cycle: the value held 1000 cycles before, itself taken in cycle 1000.
            let last = (0..3000).map(|i| latency.pass(i)).last();
            assert_eq!(last, Some(if delay > 0.0 { 1000 } else { 2999 }));
            assert!(latency.waiting.capacity() <= 1000);
        }
    }
}
