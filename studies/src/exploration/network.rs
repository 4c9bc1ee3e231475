//! A network between robot and vision system that loses, delays, doubles, spoils and replays datagrams.

use crate::random::Random;

/// What happens to datagrams, \[1\] shares of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faults {
    lost: f64,
    /// Of them, up to [`LATE`].
    late: f64,
    doubled: f64,
    /// A number of it is NaN.
    spoiled: f64,
    /// An old one comes again.
    replayed: f64,
}

/// \[s\] Longest delay.
const LATE: f64 = 0.3;
/// Old datagrams that may come again.
const OLD: usize = 50;

impl Faults {
    pub(super) const NONE: Self = Self { lost: 0.0, late: 0.0, doubled: 0.0, spoiled: 0.0, replayed: 0.0 };
    pub(super) const BAD: Self = Self { lost: 0.3, late: 0.3, doubled: 0.1, spoiled: 0.05, replayed: 0.05 };
}

/// One way of the network.
pub(super) struct Network {
    faults: Faults,
    random: Random,
    /// When they arrive \[s\], and their bytes.
    under_way: Vec<(f64, Vec<u8>)>,
    old: Vec<Vec<u8>>,
}

impl Network {
    pub(super) fn new(faults: Faults, seed: u64) -> Self {
        Self { faults, random: Random(seed), under_way: Vec::new(), old: Vec::new() }
    }

    /// Sends a datagram at `time` \[s\].
    pub(super) fn send(&mut self, time: f64, datagram: &[u8]) {
        let faults = self.faults;
        let mut happens = |share: f64| self.random.unit() < share;
        let [lost, late, doubled, spoiled, replayed] =
            [faults.lost, faults.late, faults.doubled, faults.spoiled, faults.replayed].map(&mut happens);
        let delay = if late { self.random.within([0.0, LATE]) } else { 0.0 };
        if replayed && !self.old.is_empty() {
            let which = (self.random.unit() * self.old.len() as f64) as usize;
            self.under_way.push((time, self.old[which].clone()));
        }
        if self.old.len() == OLD {
            self.old.remove(0);
        }
        self.old.push(datagram.to_vec());
        if lost {
            return;
        }
        let mut bytes = datagram.to_vec();
        if spoiled && let Some(number) = bytes.last_chunk_mut::<8>() {
            *number = f64::NAN.to_le_bytes();
        }
        if doubled {
            self.under_way.push((time, bytes.clone()));
        }
        self.under_way.push((time + delay, bytes));
    }

    /// Datagrams that have arrived by `time` \[s\], in the order in which they do.
    pub(super) fn arrived(&mut self, time: f64) -> Vec<Vec<u8>> {
        let mut here: Vec<(f64, Vec<u8>)> = self.under_way.extract_if(.., |(at, _)| *at <= time).collect();
        here.sort_by(|a, b| a.0.total_cmp(&b.0));
        here.into_iter().map(|(_, bytes)| bytes).collect()
    }
}
