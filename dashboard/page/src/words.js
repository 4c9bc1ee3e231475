// Words for the numbers of a state frame: start-up, gait, and the operator's next action.

/** Start-up states in the order of their numbers. */
export const START_UP = ["Off", "Not homed", "Homing", "Switching drives on", "Hanging", "Zeroed", "Standing", "Stopped"];

/** Walking states in the order of their numbers. */
export const GAIT = ["Idle", "Standing", "Starting", "Walking", "Stopping", "Fallen", "Halted"];

const OFF = 0, NOT_HOMED = 1, HOMING = 2, ENABLING = 3, HANGING = 4, ZEROED = 5, STANDING = 6, STOPPED = 7;
const IDLE = 0;
export const STARTING = 2, WALKING = 3, FALLEN = 5, HALTED = 6;

/** Steps of the start-up in their order. */
export const STEPS = ["power", "home", "zero", "lower", "stand", "walk"];

/**
 * Where the operator is: `step` of STEPS that comes next (or null: wait, or something is wrong), and a sentence that says
 * what to do.
 */
export function nextAction(supply, startUp, gait) {
  if (gait === FALLEN) return { step: null, bad: true, text: "She has fallen. Set her upright, then switch the supply off and on again." };
  if (startUp === STOPPED || gait === HALTED) {
    return { step: null, bad: true, text: "Stopped. Secure the robot, then emergency stop, then power on." };
  }
  if (supply !== 1 || startUp === OFF) return { step: "power", text: "Motor supply is off. Power on resets the reason and switches it on." };
  switch (startUp) {
    case NOT_HOMED: return { step: "home", text: "Some joints do not know their angles. Home finds them out." };
    case HOMING: return { step: null, text: "Homing: wait." };
    case ENABLING: return { step: null, text: "Drives are being switched on: wait." };
    case HANGING: return { step: "zero", text: "She hangs. Zero makes the force sensors read zero." };
    case ZEROED: return { step: "lower", text: "Force sensors are zeroed. Lower her to the ground." };
    case STANDING: break;
    default: return { step: null, text: "Start-up state is not known." };
  }
  if (gait === IDLE) return { step: "stand", text: "On her feet. Stand takes her into the walking pose." };
  if (gait === 1) return { step: "walk", text: "Ready to walk. Move a slider, or press Walk." };
  return { step: "walk", text: gait === 4 ? "Coming to a stand." : "Walking." };
}
