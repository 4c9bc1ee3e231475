//! Walking commands to step parameters, refused with the limit when out of `gait.limits` (thesis 4.6.1), shortened where
//! their numbers together are more than can be walked.
//!
//! Every comparison is written so that NaN fails it.

use crate::steps::{ROUNDING, StepParameters};
use config::Gait;
use messages::command::{StepCommand, VelocityCommand};
use messages::{Command, GaitState, Reason};

/// Intent of the operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Intent {
    /// Stay as it is, or stop.
    Rest,
    /// Take the standing pose.
    Stand,
    /// Take the standing pose, then walk.
    StandThenWalk,
    /// Walk.
    Walk,
}

impl Intent {
    /// Of who wants to walk: at once or, as long as the robot has yet to take the standing pose, after that.
    ///
    /// # Errors
    /// It does not stand, and is not about to.
    pub(crate) fn walking(self, gait: GaitState) -> Result<Self, Reason> {
        match (gait, self) {
            (GaitState::Idle, Self::Stand | Self::StandThenWalk) => Ok(Self::StandThenWalk),
            (GaitState::Idle, Self::Rest | Self::Walk) => Err(Reason::NotNow),
            _ => Ok(Self::Walk),
        }
    }

    /// What a stop leaves of it: it ends the walk, not the way to standing.
    pub(crate) fn stopped(self) -> Self {
        match self {
            Self::Stand | Self::StandThenWalk => Self::Stand,
            Self::Rest | Self::Walk => Self::Rest,
        }
    }

    /// What is left of it once the robot takes the standing pose.
    pub(crate) fn after_standing(self) -> Self {
        match self {
            Self::Stand | Self::Rest => Self::Rest,
            Self::StandThenWalk | Self::Walk => Self::Walk,
        }
    }
}

/// What an accepted command leaves: what is wanted from now on, and other steps.
pub(crate) type Taken = (Intent, Option<StepParameters>);

/// Does a command move the robot?
pub(crate) fn walks(command: &Command) -> bool {
    use Command::{Distance, Platform, Stand, Start, Velocity};
    matches!(command, Stand | Start | Velocity(_) | Distance(_) | Platform(_))
}

/// `x` within its limits, or the refusal of the command's field.
fn within(x: f64, field: u8, [low, high]: [f64; 2]) -> Result<f64, Reason> {
    if x >= low && x <= high { Ok(x) } else { Err(Reason::Limit { field, low, high }) }
}

/// The numbers of a command within their ranges of any use.
///
/// # Errors
/// The first one that is not.
pub(crate) fn in_range(command: &Command) -> Result<(), Reason> {
    let mut fields = command.info().fields.iter().enumerate();
    fields.try_for_each(|(i, field)| within(command.value(i), i as u8, field.range).map(drop))
}

/// Step parameters as commanded.
///
/// # Errors
/// The first one that the gait does not allow.
pub(crate) fn from_step(c: &StepCommand, gait: &Gait) -> Result<StepParameters, Reason> {
    let l = &gait.limits;
    Ok(StepParameters {
        length: within(c.length, 0, l.length)?,
        side: within(c.side, 1, l.side)?,
        turn: within(c.turn, 2, l.turn)?,
        duration: within(c.duration, 3, l.duration)?,
    })
}

/// Steps in the direction of `p` that can be walked: `p` itself, or shorter ones.
pub(crate) fn shortened(p: &StepParameters, gait: &Gait) -> StepParameters {
    let used = gait.limits.used(p.way(), p.duration);
    if used > 1.0 + ROUNDING { p.shortened(1.0 / used) } else { *p }
}

/// Step parameters for a velocity; `None` for a stop.
///
/// The duration comes from the table of forward speeds. Each step shifts the feet by L_y = v_y T and turns them by
/// w T; if one of them, or all together, would be too much for a step, steps become shorter in time.
///
/// # Errors
/// The component that the gait does not allow, with the velocities that it does.
pub(crate) fn from_velocity(c: &VelocityCommand, gait: &Gait) -> Result<Option<StepParameters>, Reason> {
    let rates = [c.forward, c.left, c.turn];
    if rates == [0.0; 3] {
        return Ok(None);
    }
    let l = &gait.limits;
    // No component is ever faster.
    let fastest = gait.fastest();
    for (field, (rate, limit)) in rates.into_iter().zip(fastest).enumerate() {
        within(rate, field as u8, limit)?;
    }
    // The duration of forward walking, shortened where length, side and turn would be too much for one step.
    let [_, duration] = by_speed(c.forward.abs(), &gait.step.by_speed).ok_or(Reason::Limit {
        field: 0,
        low: fastest[0][0],
        high: fastest[0][1],
    })?;
    let shortest = if c.left == 0.0 { l.duration[0] } else { l.side_duration };
    let used = l.used(rates.map(|rate| rate * duration), duration);
    let duration = if used > 1.0 { (duration / used).max(shortest.min(duration)) } else { duration };
    within(duration, 0, l.duration).map_err(|_| Reason::NotNow)?;
    let [length, side, turn] = rates.map(|rate| rate * duration);
    Ok(Some(StepParameters { length, side, turn, duration }))
}

/// Length and duration of steps at `speed`, linear between the rows of the table; `None` beyond its end.
fn by_speed(speed: f64, table: &[[f64; 3]]) -> Option<[f64; 2]> {
    let i = table.iter().position(|row| speed <= row[0])?;
    if i == 0 {
        return Some([table[0][1], table[0][2]]);
    }
    let (a, b) = (&table[i - 1], &table[i]);
    let s = (speed - a[0]) / (b[0] - a[0]);
    Some([1, 2].map(|k| a[k] + s * (b[k] - a[k])))
}
