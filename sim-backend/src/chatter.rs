//! Watch over the time steps: a speed that turns round in every one of them is no motion, but a step that is too long.

/// Steps that are looked back upon.
const STEPS: u32 = u32::BITS;
/// Of these, steps in which a change of speed is the opposite of the one before, from which on it is chatter.
const TURNS: u32 = 28;
/// \[m/s, rad/s\] Smallest change of a speed in a step that counts. Below, it is the order of the method and no loss of it: the
/// pitch of a robot that walks fast on semi-implicit steps of 0.25 ms turns round by 4 mrad/s, and its figures are those of steps
/// of 0.05 ms.
const LEAST: f64 = 0.02;
/// \[1\] Smallest ratio of a change to the one before that counts: a disturbance that dies out is none.
const LASTING: f64 = 0.9;

/// Watch over the speeds of a state.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChatterWatch {
    before: Vec<f64>,
    changes: Vec<f64>,
    /// Steps in which each speed turned round, the newest one in the lowest bit.
    turns: Vec<u32>,
    /// Steps without chatter.
    quiet: u32,
}

impl ChatterWatch {
    pub(crate) fn new(speeds: &[f64]) -> Self {
        let n = speeds.len();
        Self { before: speeds.to_vec(), changes: vec![0.0; n], turns: vec![0; n], quiet: STEPS }
    }

    /// Begins anew with these speeds.
    pub(crate) fn restart(&mut self, speeds: &[f64]) {
        self.before.copy_from_slice(speeds);
        self.changes.fill(0.0);
        self.turns.fill(0);
    }

    /// Looks at the speeds at the end of a step; the index of one that chatters, where that begins.
    pub(crate) fn look(&mut self, speeds: &[f64]) -> Option<usize> {
        // Without a branch for each speed: this is done in every step of the simulation.
        let mut any = false;
        let memory = self.before.iter_mut().zip(&mut self.changes).zip(&mut self.turns);
        for (((before, last), turns), &speed) in memory.zip(speeds) {
            let change = speed - *before;
            let size = change.abs();
            let turned = (change * *last < 0.0) & (size > LEAST) & (size > LASTING * last.abs());
            (*before, *last) = (speed, change);
            *turns = *turns << 1 | u32::from(turned);
            any |= turned;
        }
        let chatters = |turns: &u32| turns.count_ones() >= TURNS;
        let worst = if any { self.turns.iter().position(chatters) } else { None };
        let begins = self.quiet >= STEPS;
        self.quiet = if worst.is_some() { 0 } else { self.quiet.saturating_add(1) };
        worst.filter(|_| begins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(mut speed: impl FnMut(u32) -> f64, steps: u32) -> (Option<u32>, usize) {
        let mut watch = ChatterWatch::new(&[0.0, 0.0]);
        let seen: Vec<u32> =
            (1..=steps).filter(|k| watch.look(&[0.3, speed(*k)]).is_some_and(|i| i == 1)).collect();
        (seen.first().copied(), seen.len())
    }

    #[test]
    fn explicit_euler_beyond_its_limit_is_reported_once() {
        // x' = -s x with h s = 2.02.
        let mut x = 0.01;
        let (at, times) = first(
            |_| {
                x *= 1.0 - 2.02;
                x
            },
            300,
        );
        assert!(at.is_some_and(|k| k < 40), "{at:?}");
        assert_eq!(times, 1);
    }

    #[test]
    fn neither_motion_nor_a_disturbance_that_dies_out_nor_noise_is_chatter() {
        assert_eq!(first(|k| (0.05 * f64::from(k)).sin(), 2000).0, None);
        assert_eq!(first(|k| 10.0 * (-0.8f64).powi(k as i32), 2000).0, None, "calm within its steps");
        assert_eq!(first(|k| if k % 2 == 0 { 4e-4 } else { 0.0 }, 2000).0, None, "rounding");
        let mut state = 1_u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        assert_eq!(first(|_| noise(), 20_000).0, None, "white noise turns round in two of three steps");
    }
}
