//! Instants at which the trajectories of a plan have kinks: collocation points lie on them (errata 2 to (4.50)).

/// Instants at which a trajectory has a kink, ascending.
#[derive(Clone)]
pub(crate) struct Marks {
    len: usize,
    times: [f64; 64],
}

impl Marks {
    /// Marks from `begin` \[s\] on.
    pub(crate) fn from(begin: f64) -> Self {
        let mut times = [0.0; 64];
        times[0] = begin;
        Self { len: 1, times }
    }

    /// Inserts instants that are not there yet and not before the first one.
    pub(crate) fn add(&mut self, times: &[f64]) {
        for &t in times {
            let i = self.times[..self.len].partition_point(|&x| x < t - 1e-9);
            if i > 0
                && self.len < self.times.len()
                && !self.times[..self.len].get(i).is_some_and(|x| x - t < 1e-9)
            {
                self.times.copy_within(i..self.len, i + 1);
                self.times[i] = t;
                self.len += 1;
            }
        }
    }

    pub(crate) fn as_slice(&self) -> &[f64] {
        &self.times[..self.len]
    }

    pub(crate) fn windows(&self) -> std::slice::Windows<'_, f64> {
        self.as_slice().windows(2)
    }
}
