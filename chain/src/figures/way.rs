//! The steps of a walk, counted, and the longest run of them that is periodic.

use messages::{ControllerState, GaitState, LEFT, RIGHT, SimState};

/// Steps of this share of a length have the length.
const AS_LONG: f64 = 0.97;

/// Steps so far.
#[derive(Clone, Debug, Default)]
pub(super) struct StepRecord {
    /// Stance foot of the last cycle.
    stance: Option<usize>,
    /// \[m, m, rad\] Where the stance foot of each step stood, and where it pointed.
    footholds: Vec<[f64; 3]>,
    /// When and where the torso was, and where it faced, each time the right foot took over while walking.
    strides: Vec<(f64, [f64; 2], f64)>,
}

/// From the first to the last periodic step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Periodic {
    /// Strides of two steps each.
    pub(super) strides: f64,
    /// \[s\]
    pub(super) span: f64,
    /// \[m\]
    pub(super) distance: f64,
    /// \[rad\] Less than half a turn per stride.
    pub(super) turn: f64,
}

impl StepRecord {
    /// A step begins when the planned load has moved to one foot alone. `heading` is the torso's.
    pub(super) fn add(&mut self, sim: &SimState, state: &ControllerState, heading: f64) {
        let stance = match state.load_left {
            l if l >= 1.0 => LEFT,
            l if l <= 0.0 => RIGHT,
            _ => return,
        };
        let gait = GaitState::from(state.gait);
        if self.stance == Some(stance)
            || !matches!(gait, GaitState::Starting | GaitState::Walking | GaitState::Stopping)
        {
            return;
        }
        self.stance = Some(stance);
        let [x, y, _, heading_of_foot] = sim.feet[stance];
        self.footholds.push([x, y, heading_of_foot]);
        // Every second step: the torso sways from side to side, and the sway is no way made.
        if gait == GaitState::Walking && stance == RIGHT {
            self.strides.push((sim.time, [sim.position[0], sim.position[1]], heading));
        }
    }

    /// Steps taken.
    pub(super) fn steps(&self) -> u64 {
        self.footholds.len() as u64
    }

    /// The longest run of strides that are alike, each within 1 % of the duration and 3 % of the length of the one before.
    pub(super) fn periodic(&self) -> Periodic {
        let alike = |a: &Periodic, b: &Periodic| {
            (a.span - b.span).abs() <= 0.01 * a.span
                && (a.distance - b.distance).abs() <= 0.03 * a.distance.max(0.1)
        };
        let (mut best, mut run, mut last) = (Periodic::default(), Periodic::default(), None);
        for now in self.strides.windows(2).map(stride) {
            run = match last {
                Some(before) if alike(&before, &now) => run.and(&now),
                _ => now,
            };
            if run.span > best.span {
                best = run;
            }
            last = Some(now);
        }
        best
    }

    /// Steps until the first one of `full` length forward has been made, and after the last such one until both feet stand side by
    /// side; the closing step, which nobody follows, counts. Zeros without such a step.
    pub(super) fn to_speed_and_rest(&self, full: f64) -> [u64; 2] {
        // From one stance foot to the next is one step.
        let forward = |a: [f64; 3], b: [f64; 3]| (b[0] - a[0]) * a[2].cos() + (b[1] - a[1]) * a[2].sin();
        let lengths: Vec<f64> = self.footholds.windows(2).map(|w| forward(w[0], w[1])).collect();
        let long = |l: &f64| full > 0.0 && *l >= AS_LONG * full;
        match (lengths.iter().position(long), lengths.iter().rposition(long)) {
            (Some(first), Some(last)) => [first as u64 + 1, (lengths.len() - last) as u64],
            _ => [0; 2],
        }
    }
}

impl Periodic {
    fn and(self, other: &Self) -> Self {
        Self {
            strides: self.strides + other.strides,
            span: self.span + other.span,
            distance: self.distance + other.distance,
            turn: self.turn + other.turn,
        }
    }
}

fn stride(pair: &[(f64, [f64; 2], f64)]) -> Periodic {
    let ((t0, a, h0), (t1, b, h1)) = (pair[0], pair[1]);
    let turn = (h1 - h0).sin().atan2((h1 - h0).cos());
    Periodic { strides: 1.0, span: t1 - t0, distance: (b[0] - a[0]).hypot(b[1] - a[1]), turn }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A walk whose stance feet stand at these places.
    fn walk(footholds: &[f64]) -> StepRecord {
        let mut way = StepRecord::default();
        let mut time = 0.0;
        for (k, x) in footholds.iter().enumerate() {
            let mut sim = SimState { time, position: [*x, 0.0, 0.0], ..SimState::default() };
            sim.feet[k % 2] = [*x, 0.0, 0.0, 0.0];
            let load_left = (k % 2) as f64;
            let state =
                ControllerState { load_left, gait: GaitState::Walking as u64, ..ControllerState::default() };
            way.add(&sim, &state, 0.1 * k as f64);
            time += 0.8;
        }
        way
    }

    #[test]
    fn steps_to_full_length_and_to_rest_are_counted() {
        // Steps of .3, .5, .6, .6, .6, .4, .2 m, and one that closes the feet, after which no foot carries alone.
        let way = walk(&[0.0, 0.3, 0.8, 1.4, 2.0, 2.6, 3.0, 3.2]);
        assert_eq!(way.to_speed_and_rest(0.6), [3, 3]);
        assert_eq!(way.to_speed_and_rest(0.7), [0, 0]);
        assert_eq!(way.steps(), 8);
        assert_eq!(walk(&[]).to_speed_and_rest(0.0), [0, 0]);
    }

    #[test]
    fn periodic_steps_have_length_duration_and_turn() {
        let p = walk(&[0.0, 0.3, 0.8, 1.4, 2.0, 2.6, 3.2, 3.8]).periodic();
        // Strides 0.8, 1.2, 1.2 m: the last two are alike.
        assert_eq!(p.strides, 2.0);
        assert!((p.span - 3.2).abs() < 1e-12 && (p.distance - 2.4).abs() < 1e-12, "{p:?}");
        assert!((p.turn - 0.4).abs() < 1e-12, "{p:?}");
        assert_eq!(walk(&[0.0, 0.3]).periodic(), Periodic::default());
    }
}
