//! Token bucket: so many messages per second in the long run, some of them at once.
//!
//! Each message costs time, and only so much of it is saved: whole nanoseconds, so that nothing is rounded. Time is an argument.

use crate::clock::SECOND;

/// Ration of messages.
#[derive(Clone, Copy, Debug)]
pub struct Bucket {
    /// Time that one message costs \[ns\].
    cost: u64,
    /// Longest time that is saved \[ns\].
    most: u64,
    /// Time at which nothing more can be saved \[ns\].
    full_at: u64,
}

impl Bucket {
    /// Full bucket: `rate` messages per second, `burst` of them at once.
    pub const fn full(rate: u64, burst: u64) -> Self {
        let cost = SECOND / rate;
        Self { cost, most: burst * cost, full_at: 0 }
    }

    /// Takes one message at `now` \[ns\]; false: there is none left.
    pub fn take(&mut self, now: u64) -> bool {
        let full_at = self.full_at.max(now) + self.cost;
        let free = full_at <= now + self.most;
        if free {
            self.full_at = full_at;
        }
        free
    }

    /// Takes one that may not be there yet; how long it is until it will be \[ns\].
    pub fn owe(&mut self, now: u64) -> u64 {
        self.full_at = self.full_at.max(now) + self.cost;
        self.full_at.saturating_sub(now + self.most)
    }

    /// Another rate from `now` \[ns\] on; as long a time as before is saved at most, and messages that are left stay.
    pub fn change_rate(&mut self, rate: u64, now: u64) {
        let cost = SECOND / rate;
        let saved = self.most - self.full_at.saturating_sub(now).min(self.most);
        self.full_at = now + self.most - (saved * cost / self.cost).min(self.most);
        self.cost = cost;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = SECOND / 1000;

    #[test]
    fn messages_are_rationed() {
        let mut bucket = Bucket::full(500, 500);
        assert_eq!((0..10_000).filter(|_| bucket.take(0)).count(), 500);
        assert_eq!((0..10_000).filter(|_| bucket.take(SECOND / 10)).count(), 50);
        assert_eq!((0..10_000).filter(|_| bucket.take(100 * SECOND)).count(), 500, "no more is saved");
    }

    /// 40 of 40 stops of a client with too many velocities were refused. Each of them is taken now, a flood of them at the rate
    /// of everything else.
    #[test]
    fn a_stop_beyond_the_ration_waits_for_it() {
        let mut bucket = Bucket::full(100, 100);
        assert_eq!((0..100).filter(|_| bucket.take(0)).count(), 100);
        // One and a half are there again.
        let begin = 15 * MS;
        assert_eq!((bucket.take(begin), bucket.take(begin)), (true, false));
        assert_eq!(bucket.owe(begin), 5 * MS, "half of it is there");
        assert_eq!(bucket.owe(begin), 15 * MS);
        assert!(!bucket.take(begin + 20 * MS), "what was owed is paid first");
        assert_eq!(bucket.owe(begin + SECOND), 0);
        // A flood of stops, each sent when the one before was taken.
        let (mut now, mut taken) = (begin + SECOND, 0);
        while now < begin + 11 * SECOND {
            now += bucket.owe(now);
            taken += 1;
        }
        assert!((1000..=1110).contains(&taken), "{taken} stops in 10 s at 100 per second");
    }

    #[test]
    fn messages_that_are_left_stay_at_another_rate() {
        for (rate, taken, left) in [(2000, 60, 40), (2000, 100, 0), (50, 60, 40), (50, 0, 50)] {
            let mut bucket = Bucket::full(100, 100);
            assert_eq!((0..taken).filter(|_| bucket.take(SECOND)).count(), taken);
            bucket.change_rate(rate, SECOND);
            assert_eq!((0..10_000).filter(|_| bucket.take(SECOND)).count(), left, "{rate}");
            assert_eq!((0..10_000).filter(|_| bucket.take(9 * SECOND)).count(), rate as usize);
        }
    }
}
