//! What can be demanded of a walk, and what the figures say to it.

use super::Goal;
use chain::figures::Figures;

/// Which figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    /// \[km/h\] Mean over the periodic steps.
    Speed,
    /// \[m\] Of the periodic steps.
    StepLength,
    /// \[s\] Of the periodic steps.
    StepDuration,
    /// \[rad\] Of the periodic steps, without its sign.
    StepTurn,
    /// \[rad\] Largest error, about either axis.
    Inclination,
    /// \[rad\] Hip flexion and knees.
    HipKneeTracking,
    /// \[rad\] The same on the motors' side of elastic gears.
    MotorSide,
    /// \[1\] Force of the landing over the largest desired one of the stance.
    LandingPeak,
    /// \[1\] Weights by which the force of the landing exceeds the desired one of the same instant.
    LandingExcess,
    /// \[m\] Where the walk ends, forward from where it began.
    Forward,
    /// \[1\] Steps from standing to the longest step.
    StepsToSpeed,
    /// \[1\] Steps from the longest step to standing.
    StepsToRest,
}

/// How a figure is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rule {
    /// Within [`NEAR`] of it.
    Near,
    AtMost,
    AtLeast,
    /// To be compared only.
    None,
}

/// Share by which a figure may differ from what it is to be.
const NEAR: f64 = 0.03;

/// One demand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demand {
    pub(super) what: What,
    rule: Rule,
    value: f64,
    /// The thesis's figure or the best published one, and where it stands.
    pub(super) published: &'static str,
}

impl Demand {
    /// Within 3 % of `value`.
    pub(super) const fn near(what: What, value: f64, published: &'static str) -> Self {
        Self { what, rule: Rule::Near, value, published }
    }

    /// At most `value`.
    pub(super) const fn most(what: What, value: f64, published: &'static str) -> Self {
        Self { what, rule: Rule::AtMost, value, published }
    }

    /// At least `value`.
    pub(super) const fn least(what: What, value: f64, published: &'static str) -> Self {
        Self { what, rule: Rule::AtLeast, value, published }
    }

    /// Nothing, but the figure is shown.
    pub(super) const fn shown(what: What, published: &'static str) -> Self {
        Self { what, rule: Rule::None, value: 0.0, published }
    }

    /// What the figure of a walk that got to its end, or none, makes of the goal.
    pub(super) fn goal(&self, figure: Option<f64>) -> Goal {
        match (self.rule, figure) {
            (Rule::None, _) => Goal::Measured,
            (_, Some(figure)) if self.met(figure) => Goal::Met,
            _ => Goal::Missed,
        }
    }

    /// Whether a figure meets it; one that is not a number meets nothing.
    fn met(&self, figure: f64) -> bool {
        match self.rule {
            Rule::Near => (figure - self.value).abs() <= NEAR * self.value,
            Rule::AtMost => figure <= self.value,
            Rule::AtLeast => figure >= self.value,
            Rule::None => true,
        }
    }

    /// In words, with its unit.
    pub(super) fn text(&self) -> String {
        let value = format!("{} {}", self.value, self.what.unit());
        match self.rule {
            Rule::Near => format!("{value} ± {} %", 100.0 * NEAR),
            Rule::AtMost => format!("at most {value}"),
            Rule::AtLeast => format!("at least {value}"),
            Rule::None => String::new(),
        }
    }
}

impl What {
    /// Name in the table.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::StepLength => "step length",
            Self::StepDuration => "step duration",
            Self::StepTurn => "turn per step",
            Self::Inclination => "inclination error",
            Self::HipKneeTracking => "hip, knee tracking error",
            Self::MotorSide => "hip, knee, motor side",
            Self::LandingPeak => "landing force peak",
            Self::LandingExcess => "landing over desired",
            Self::Forward => "gets to",
            Self::StepsToSpeed => "steps to top speed",
            Self::StepsToRest => "steps to rest",
        }
    }

    /// Unit, as people write it.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Speed => "km/h",
            Self::StepLength | Self::Forward => "m",
            Self::StepDuration => "s",
            Self::StepTurn | Self::Inclination | Self::HipKneeTracking | Self::MotorSide => "rad",
            Self::LandingPeak => "of the stance's",
            Self::LandingExcess => "weights",
            Self::StepsToSpeed | Self::StepsToRest => "steps",
        }
    }

    /// What the figures of a walk say.
    pub(super) fn of(self, f: &Figures) -> f64 {
        match self {
            Self::Speed => 3.6 * f.mean_speed_m_s,
            Self::StepLength => f.step_length_m,
            Self::StepDuration => f.step_duration_s,
            Self::StepTurn => f.step_turn_rad.abs(),
            Self::Inclination => f.inclination_error_max_rad[0].max(f.inclination_error_max_rad[1]),
            Self::HipKneeTracking => f.hip_knee_tracking_error_max_rad,
            Self::MotorSide => f.hip_knee_motor_side_error_max_rad,
            Self::LandingPeak => f.landing_peak_ratio,
            Self::LandingExcess => f.landing_excess_weights,
            Self::Forward => f.end_pose[0],
            Self::StepsToSpeed => f.steps_to_speed_and_rest[0] as f64,
            Self::StepsToRest => f.steps_to_speed_and_rest[1] as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_has_two_sides() {
        let near = Demand::near(What::Speed, 2.0, "");
        assert!(near.met(1.95) && near.met(2.05) && !near.met(1.93) && !near.met(2.07));
        let most = Demand::most(What::Inclination, 0.03, "");
        assert!(most.met(0.03) && !most.met(0.031));
        let least = Demand::least(What::Speed, 4.0, "");
        assert!(least.met(4.0) && !least.met(3.99));
        assert!([near, most, least].iter().all(|demand| !demand.met(f64::NAN)));
        assert!([near, most, least].iter().all(|demand| demand.goal(None) == Goal::Missed));
        assert_eq!(Demand::shown(What::Speed, "").goal(None), Goal::Measured);
    }
}
