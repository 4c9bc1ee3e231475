//! What a foot feels when it lands: does the force rise with the load that the foot takes over, or strike?

/// \[s\] How long a landing lasts.
const LANDING: f64 = 0.1;
/// \[s\] A foot that has been without load this long has swung; less is a bounce and belongs to the landing.
const SWING: f64 = 0.1;
/// \[N\] Less is no load.
const LOAD: f64 = 5.0;

/// One foot.
#[derive(Clone, Debug, Default)]
pub(super) struct Landing {
    /// \[s\] When the foot lost its load, while it has none.
    lifted: Option<f64>,
    /// \[s\] When it landed, while it stands after a swing.
    landed: Option<f64>,
    /// \[N\] Largest force of this landing, and largest desired one of the whole stance.
    peak: f64,
    desired: f64,
    ratio: f64,
    excess: f64,
}

impl Landing {
    /// One cycle: normal force and desired normal force \[N\].
    pub(super) fn add(&mut self, time: f64, force: f64, desired: f64) {
        if force < LOAD {
            self.lifted = self.lifted.or(Some(time));
        } else if let Some(lifted) = self.lifted.take()
            && time - lifted >= SWING
        {
            self.judge();
            (self.landed, self.peak, self.desired) = (Some(time), 0.0, 0.0);
        }
        let Some(landed) = self.landed else { return };
        self.desired = self.desired.max(desired);
        if time - landed <= LANDING {
            self.peak = self.peak.max(force);
            self.excess = self.excess.max(force - desired);
        }
    }

    /// A stance is judged once it is over.
    fn judge(&mut self) {
        if self.desired > 0.0 {
            self.ratio = self.ratio.max(self.peak / self.desired);
        }
    }

    /// \[1\] Largest force of a landing over the largest desired one of its stance; zero without a whole stance.
    pub(super) fn ratio(&self) -> f64 {
        self.ratio
    }

    /// \[N\] Most by which a landing exceeded the desired force.
    pub(super) fn excess(&self) -> f64 {
        self.excess
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Swings of 0.5 s and stances of 0.5 s in which the force rises over 0.1 s to 600 N, with `knock` more in the first
    /// 10 ms.
    fn walk(knock: f64) -> Landing {
        let mut landing = Landing::default();
        for k in 0..4000 {
            let in_cycle = 1e-3 * f64::from(k % 1000) - 0.5;
            let desired = if in_cycle < 0.0 { 0.0 } else { (6000.0 * in_cycle + 10.0).min(600.0) };
            let extra = if (0.0..0.01).contains(&in_cycle) { knock } else { 0.0 };
            landing.add(1e-3 * f64::from(k), desired + extra, desired);
        }
        landing
    }

    #[test]
    fn a_soft_landing_has_no_peak() {
        let soft = walk(0.0);
        assert!(soft.ratio() <= 1.0 && soft.ratio() > 0.95, "{}", soft.ratio());
        assert_eq!(soft.excess(), 0.0);
    }

    #[test]
    fn a_knock_is_seen() {
        let knock = walk(900.0);
        assert!((knock.ratio() - 964.0 / 600.0).abs() < 0.01, "{}", knock.ratio());
        assert!((knock.excess() - 900.0).abs() < 1e-9);
    }

    #[test]
    fn a_foot_that_never_swung_has_not_landed() {
        let mut standing = Landing::default();
        for k in 0..1000 {
            standing.add(1e-3 * f64::from(k), 300.0, 300.0);
        }
        assert_eq!((standing.ratio(), standing.excess()), (0.0, 0.0));
    }
}
