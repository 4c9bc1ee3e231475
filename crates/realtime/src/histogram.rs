//! Durations in buckets of equal relative width, in fixed memory.
//!
//! 64 buckets per octave: a percentile is too large by at most 1/64. Recording is a shift and an addition; all
//! percentiles come from one pass.

use messages::{FIRST_OCTAVE, OCTAVES};

const SUB_BITS: u32 = 6;
const SUB: usize = 1 << SUB_BITS;
/// 2^38 ns is more than four minutes; longer ones count as that.
const BUCKETS: usize = SUB * (38 - SUB_BITS as usize + 1);

/// A histogram of durations \[ns\].
#[derive(Clone, Debug)]
pub struct Histogram {
    counts: Box<[u32; BUCKETS]>,
    total: u64,
    max: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self::new()
    }
}

impl Histogram {
    /// An empty histogram; its only allocation.
    pub fn new() -> Self {
        Self { counts: Box::new([0; BUCKETS]), total: 0, max: 0 }
    }

    /// Counts one duration \[ns\].
    pub fn record(&mut self, ns: u64) {
        let count = &mut self.counts[bucket(ns)];
        *count = count.saturating_add(1);
        self.total += 1;
        self.max = self.max.max(ns);
    }

    /// Number of records.
    pub fn len(&self) -> u64 {
        self.total
    }

    /// Whether nothing was recorded yet.
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }

    /// p50, p99, p99.9 and the maximum \[ns\]; zeros while empty.
    pub fn percentiles(&self) -> [u64; 4] {
        let ranks = [500, 990, 999].map(|permille| (self.total * permille).div_ceil(1000).max(1));
        let mut found = [0; 4];
        found[3] = self.max;
        let mut next = 0;
        let mut seen = 0;
        for (k, count) in self.counts.iter().enumerate() {
            seen += u64::from(*count);
            while next < 3 && seen >= ranks[next] {
                found[next] = upper_edge(k).min(self.max);
                next += 1;
            }
            if next == 3 {
                break;
            }
        }
        found
    }

    /// Records by octaves: below 2^10 ns, from there below 2^11 ns, and so on; all that are longer in the last one.
    pub fn octaves(&self) -> [u64; OCTAVES] {
        let mut found = [0; OCTAVES];
        // The first buckets hold what is below 2^6 ns, each later run of as many the next octave.
        for (run, counts) in self.counts.chunks_exact(SUB).enumerate() {
            let octave = (run + SUB_BITS as usize).saturating_sub(FIRST_OCTAVE).min(OCTAVES - 1);
            found[octave] += counts.iter().map(|count| u64::from(*count)).sum::<u64>();
        }
        found
    }
}

fn bucket(ns: u64) -> usize {
    if ns < SUB as u64 {
        return ns as usize;
    }
    let shift = ns.ilog2() - SUB_BITS;
    (SUB * shift as usize + (ns >> shift) as usize).min(BUCKETS - 1)
}

/// The largest duration that falls into a bucket.
fn upper_edge(bucket: usize) -> u64 {
    if bucket < 2 * SUB {
        return bucket as u64;
    }
    let shift = bucket / SUB - 1;
    ((((bucket % SUB + SUB) as u64) + 1) << shift) - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_are_contiguous_and_narrow() {
        let mut last = 0;
        for k in 0..BUCKETS - 1 {
            let edge = upper_edge(k);
            assert_eq!(bucket(edge), k);
            assert_eq!(bucket(edge + 1), k + 1);
            assert!(k == 0 || (edge - last) as f64 <= 1.0 + last as f64 / SUB as f64);
            last = edge;
        }
        assert_eq!(bucket(u64::MAX), BUCKETS - 1);
    }

    /// Durations over so many octaves, below 2^`bits` ns: in a histogram, and as a sorted list.
    fn samples(bits: u32, spread: u64) -> (Histogram, Vec<u64>) {
        let mut state = 0x1234_5678_9abc_def0u64;
        let draw = || {
            // xorshift64
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> (64 - bits)) >> (state % spread)
        };
        let mut list: Vec<u64> = std::iter::repeat_with(draw).take(100_000).collect();
        let mut histogram = Histogram::new();
        list.iter().for_each(|ns| histogram.record(*ns));
        list.sort_unstable();
        (histogram, list)
    }

    #[test]
    fn octaves_agree_with_a_sorted_list() {
        let (mut histogram, mut list) = samples(34, 34);
        for k in 0..40 {
            // Ends of octaves, on both sides.
            let ends = [(1u64 << k) - 1, 1 << k];
            ends.iter().for_each(|ns| histogram.record(*ns));
            list.extend(ends);
        }
        list.sort_unstable();
        let below = |end: u64| list.partition_point(|ns| *ns < end) as u64;
        let found = histogram.octaves();
        assert_eq!(found[0], below(1024));
        for (k, count) in found.iter().enumerate().take(OCTAVES - 1).skip(1) {
            assert_eq!(*count, below(1 << (10 + k)) - below(1 << (9 + k)), "octave {k}");
            assert!(*count > 100, "octave {k}: {count}");
        }
        assert_eq!(found[OCTAVES - 1], list.len() as u64 - below(1 << 28));
        assert_eq!(found.iter().sum::<u64>(), histogram.len());
    }

    #[test]
    fn percentiles_agree_with_a_sorted_list() {
        let (histogram, list) = samples(20, 20);
        for (got, rank) in histogram.percentiles().into_iter().zip([50_000, 99_000, 99_900, 100_000]) {
            let exact = list[rank - 1];
            assert!(got >= exact && got - exact <= exact / SUB as u64, "{got} for {exact}");
        }
    }

    #[test]
    fn empty_and_single() {
        let mut histogram = Histogram::new();
        assert_eq!(histogram.percentiles(), [0; 4]);
        histogram.record(300_000);
        assert_eq!(histogram.percentiles(), [300_000; 4]);
        assert_eq!(histogram.len(), 1);
    }
}
