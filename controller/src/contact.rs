//! Contact state of a foot, from its planned load and its force sensor: swing, early contact, stance, late contact.
//!
//! Contact that comes before its time stops the foot where it is: it presses lightly and is not pushed on, and is followed
//! if the foot bounces off. Contact that does not come at its time is searched for downwards, slowly and not far. What either has changed in height is
//! kept while the foot carries and given up in the next swing (5.32).

use config::gait::StabilizerGains;

/// Contact phase of a foot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ContactPhase {
    /// In the air as planned: position controlled.
    #[default]
    Swing,
    /// Came down on something before its time: force controlled, its descent stopped.
    Early,
    /// Carries as planned: force controlled as far as it is felt to.
    Stance,
    /// Should carry and is felt not to: lowered.
    Late,
}

/// Observations of one foot in a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Signs {
    /// \[1\] Planned load factor now and at the end of the cycle.
    pub load: [f64; 2],
    /// \[m/s\] Planned vertical velocity of the sole.
    pub rise: f64,
    /// \[N\] Measured, filtered normal force.
    pub force: f64,
}

/// Contact of one foot.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FootContact {
    /// Its phase.
    pub phase: ContactPhase,
    /// \[1\] 0 without felt force, 1 from the upper force of `force_blend` on.
    pub felt: f64,
    /// The foot has come and its load has not: until then it keeps the ground with the upper force of `force_blend`.
    pub waits: bool,
    /// It has touched the ground since it swung.
    pub touched: bool,
}

impl FootContact {
    /// One cycle.
    pub(crate) fn update(&mut self, control: &StabilizerGains, signs: &Signs) {
        let [low, high] = control.force_blend;
        self.felt = ((signs.force - low) / (high - low)).clamp(0.0, 1.0);
        let [now, end] = signs.load;
        // What a swinging foot's inertia and the sensor's noise read is no contact.
        let (felt, falling) = (self.felt > 0.0, signs.rise < 0.0);
        let loading = end > now || now >= HALF;
        self.phase = match self.phase {
            ContactPhase::Swing | ContactPhase::Early if end <= 0.0 => {
                let early = falling && (signs.force > high || self.phase == ContactPhase::Early);
                if early { ContactPhase::Early } else { ContactPhase::Swing }
            }
            _ if now <= 0.0 && end <= 0.0 => ContactPhase::Swing,
            _ if felt || !loading => ContactPhase::Stance,
            _ => ContactPhase::Late,
        };
        self.touched = self.phase != ContactPhase::Swing && (self.touched || felt);
        self.waits = self.phase == ContactPhase::Early
            || (self.phase == ContactPhase::Stance && loading && now < HALF);
    }

    /// \[1\] alpha_lambda: 1 force controlled, 0 position controlled.
    pub(crate) fn force_share(&self) -> f64 {
        match self.phase {
            ContactPhase::Swing | ContactPhase::Late => 0.0,
            ContactPhase::Early => 1.0,
            ContactPhase::Stance => self.felt,
        }
    }
}

/// A foot that shall carry this share of the load is expected on the ground, whether its load rises or falls.
const HALF: f64 = 0.5;

/// Load factors of the feet that are felt: the other foot carries for one that finds no ground.
pub(crate) fn felt_load(planned: [f64; 2], contacts: &[FootContact; 2]) -> [f64; 2] {
    let felt = [planned[0] * contacts[0].felt, planned[1] * contacts[1].felt];
    let sum = felt[0] + felt[1];
    if sum > 0.0 { felt.map(|f| f / sum) } else { planned }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(contact: &mut FootContact, load: [f64; 2], rise: f64, force: f64) -> ContactPhase {
        contact.update(&crate::test_gains(), &Signs { load, rise, force });
        contact.phase
    }

    #[test]
    fn a_step_as_planned() {
        let mut c = FootContact::default();
        assert_eq!(after(&mut c, [1.0; 2], 0.0, 600.0), ContactPhase::Stance);
        assert_eq!(
            after(&mut c, [0.01, 0.005], 0.0, 3.0),
            ContactPhase::Stance,
            "leaves: nothing to search for"
        );
        assert_eq!(after(&mut c, [0.0; 2], 0.1, 30.0), ContactPhase::Swing, "still touches, but rises");
        assert_eq!(c.force_share(), 0.0);
        assert_eq!(after(&mut c, [0.0; 2], -0.1, 0.0), ContactPhase::Swing);
        assert_eq!(after(&mut c, [0.0, 0.01], 0.0, 30.0), ContactPhase::Stance);
        assert!(c.force_share() > 0.0 && c.force_share() < 1.0);
    }

    #[test]
    fn early_contact_lasts_until_the_foot_shall_carry() {
        let mut c = FootContact::default();
        assert_eq!(after(&mut c, [0.0; 2], -0.1, 30.0), ContactPhase::Swing, "inertia or noise");
        assert_eq!(after(&mut c, [0.0; 2], -0.1, 60.0), ContactPhase::Early);
        assert_eq!(after(&mut c, [0.0; 2], -0.1, 0.0), ContactPhase::Early, "a bounce");
        assert_eq!(c.force_share(), 1.0);
        assert_eq!(after(&mut c, [0.0, 0.01], 0.0, 0.0), ContactPhase::Late, "and gone when it should carry");
        assert_eq!(after(&mut c, [0.01, 0.02], 0.0, 30.0), ContactPhase::Stance);
    }

    #[test]
    fn a_foot_that_came_waits_until_it_carries() {
        let mut c = FootContact::default();
        let mut waits = |load, rise, force| {
            after(&mut c, load, rise, force);
            c.waits
        };
        assert!(!waits([0.0; 2], -0.1, 0.0), "in the air");
        assert!(waits([0.0; 2], -0.1, 60.0), "came early");
        assert!(waits([0.1, 0.2], 0.0, 60.0), "its load comes");
        assert!(!waits([0.1, 0.2], 0.0, 0.0), "lost the ground: searches for it");
        assert!(!waits([0.7, 0.8], 0.0, 400.0), "carries");
        assert!(!waits([0.2, 0.1], 0.0, 100.0), "its load goes");
    }

    #[test]
    fn a_foot_has_touched_the_ground_until_it_swings() {
        let mut c = FootContact::default();
        let mut touched = |load, rise, force| {
            after(&mut c, load, rise, force);
            c.touched
        };
        assert!(!touched([0.0, 0.01], 0.0, 0.0), "late");
        assert!(touched([0.1, 0.2], 0.0, 100.0));
        assert!(touched([0.2, 0.3], 0.0, 0.0), "bounced off");
        assert!(!touched([0.0; 2], 0.1, 0.0), "swings");
        assert!(touched([0.0; 2], -0.1, 60.0), "early");
        assert!(touched([0.0; 2], -0.1, 0.0), "bounced off");
    }

    #[test]
    fn ground_is_searched_for_while_load_shall_come_or_is_there() {
        let mut c = FootContact::default();
        assert_eq!(after(&mut c, [0.1, 0.2], 0.0, 0.0), ContactPhase::Late);
        assert_eq!(after(&mut c, [1.0; 2], 0.0, 0.0), ContactPhase::Late);
        assert_eq!(after(&mut c, [1.0; 2], 0.0, 100.0), ContactPhase::Stance);
        assert_eq!(
            after(&mut c, [0.4, 0.3], 0.0, 0.0),
            ContactPhase::Stance,
            "load goes: the foot is about to lift"
        );
    }

    #[test]
    fn who_finds_no_ground_is_carried_for() {
        let felt = |felt| FootContact { phase: ContactPhase::Stance, felt, ..FootContact::default() };
        assert_eq!(felt_load([0.4, 0.6], &[felt(1.0), felt(0.0)]), [1.0, 0.0]);
        assert_eq!(felt_load([0.4, 0.6], &[felt(1.0); 2]), [0.4, 0.6]);
        assert_eq!(felt_load([0.4, 0.6], &[felt(0.0); 2]), [0.4, 0.6], "in the air the plan is all there is");
    }
}
