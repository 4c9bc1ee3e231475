//! Next step of the start-up out of the state of a robot, as the dashboard's page has it.

use messages::command::LowerCommand;
use messages::{Command, GaitState, StartUp};

/// \[m\] Rope by which a simulated robot is lowered: its soles hang 0.1 m over the ground in the scenes that have a crane.
const LOWER: f64 = 0.3;

/// State of the robot as the broker tells it; what is not known yet is off and idle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotState {
    /// Motor supply.
    pub supply: bool,
    /// State of the start-up.
    pub start_up: StartUp,
    /// State of the walk.
    pub gait: GaitState,
}

/// Commands of the next step, one after the other with a pause between two.
///
/// # Errors
/// There is none now, and why.
pub fn next_step(state: RobotState, simulated: bool) -> Result<&'static [Command], &'static str> {
    match (state.gait, state.start_up) {
        (GaitState::Fallen, _) => {
            Err("she has fallen: set her upright, then switch the supply off and on again")
        }
        (GaitState::Halted, _) | (_, StartUp::Stopped) if state.supply => {
            Err("stopped: secure the robot, then emergency stop, then this button")
        }
        _ if !state.supply => Ok(&[Command::Reset, Command::Enable]),
        (_, StartUp::Off) => Ok(&[Command::Reset, Command::Enable]),
        (_, StartUp::NotHomed) => Ok(&[Command::Home]),
        (_, StartUp::Homing | StartUp::Enabling) => Err("homing, or drives being switched on: wait"),
        (_, StartUp::Hanging) => Ok(&[Command::ZeroForce]),
        (_, StartUp::Zeroed) if simulated => Ok(&[Command::Lower(LowerCommand { distance: LOWER })]),
        (_, StartUp::Zeroed) => Err("hanging, force sensors zeroed: lower the robot"),
        (GaitState::Idle, _) => Ok(&[Command::Stand]),
        _ => Err("ready to walk: the sticks steer"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the crane to standing each step leads to a state whose step is the next one.
    #[test]
    fn steps_lead_from_no_power_to_walking() {
        use StartUp::{Enabling, Hanging, Homing, NotHomed, Off, Standing, Stopped, Zeroed};
        let names = |supply, start_up, gait, simulated| {
            let step = next_step(RobotState { supply, start_up, gait }, simulated);
            step.map(|all| all.iter().map(Command::name).collect::<Vec<_>>().join(" "))
        };
        let idle = GaitState::Idle;
        let steps = [Off, NotHomed, Hanging, Zeroed, Standing]
            .map(|state| names(state != Off, state, idle, true).unwrap());
        assert_eq!(
            steps,
            ["system/reset system/enable", "joint/home", "joint/zero_force", "sim/lower", "walk/stand"]
        );
        for state in [Homing, Enabling] {
            assert!(names(true, state, idle, true).unwrap_err().contains("wait"));
        }
        assert!(names(true, Zeroed, idle, false).unwrap_err().contains("lower the robot"));
        assert!(names(true, Stopped, idle, true).unwrap_err().contains("secure"));
        assert!(names(false, Stopped, GaitState::Fallen, true).unwrap_err().contains("fallen"));
        assert!(names(true, Standing, GaitState::Standing, true).unwrap_err().contains("sticks"));
    }
}
