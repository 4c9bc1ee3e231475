//! Random numbers of the studies: the same for the same seed, on every machine.

/// So many seeds from the first one on; the largest is followed by 0.
pub(crate) fn seeds(first: u64, count: u64) -> impl Iterator<Item = u64> + Clone {
    (0..count).map(move |k| first.wrapping_add(k))
}

/// Generator SplitMix64 (Steele and others).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number out of \[0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number out of \[-1, 1).
    pub(crate) fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// A number out of a range.
    pub(crate) fn within(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.unit()
    }
}

#[cfg(test)]
mod tests {
    /// Regression: of the largest seeds none was walked, and all of none were walked as told.
    #[test]
    fn there_are_as_many_seeds_as_asked_for() {
        for first in [0, 7, u64::MAX - 1, u64::MAX] {
            let seeds: Vec<u64> = super::seeds(first, 3).collect();
            assert!(seeds.len() == 3 && seeds[0] == first && seeds[1] != first, "{seeds:?}");
        }
    }
}
