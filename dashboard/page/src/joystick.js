// Gamepad by the layout of joystick.toml: what its sticks and buttons mean. Pure functions; the same rules as joystick/src/pad.rs.

const STEP = 0.01; // [m/s, rad/s] least step between two velocities

/** Places of the kernel's names among the buttons of the standard gamepad; letters are those on an Xbox gamepad. */
const BUTTONS = {
  BTN_SOUTH: 0, BTN_A: 0, BTN_GAMEPAD: 0, BTN_EAST: 1, BTN_B: 1, BTN_WEST: 2, BTN_X: 2, BTN_NORTH: 3, BTN_Y: 3, BTN_TL: 4, BTN_TR: 5, BTN_TL2: 6, BTN_TR2: 7,
  BTN_SELECT: 8, BTN_START: 9, BTN_THUMBL: 10, BTN_THUMBR: 11, BTN_DPAD_UP: 12, BTN_DPAD_DOWN: 13, BTN_DPAD_LEFT: 14, BTN_DPAD_RIGHT: 15, BTN_MODE: 16,
};

/** What is written on these buttons. */
const LABELS = ["A or cross", "B or circle", "X or square", "Y or triangle", "left shoulder", "right shoulder", "left trigger", "right trigger", "View or Create",
  "Menu or Options", "left stick pressed", "right stick pressed", "pad up", "pad down", "pad left", "pad right", "Guide or PS"];

const AXES = { ABS_X: 0, ABS_Y: 1, ABS_RX: 2, ABS_RY: 3 };
const TRIGGERS = { ABS_Z: 6, ABS_RZ: 7 };
const HATS = { ABS_HAT0X: [14, 15], ABS_HAT0Y: [12, 13] };

/** Position of an axis, -1 to 1 as the kernel has it; undefined: the standard gamepad has none of this name. */
function way(name, { axes, buttons }) {
  if (name in AXES) return axes[AXES[name]];
  if (name in TRIGGERS) return 2 * (buttons[TRIGGERS[name]]?.value ?? 0) - 1;
  if (name in HATS) return HATS[name].reduce((sum, i, k) => sum + (buttons[i]?.pressed ? 2 * k - 1 : 0), 0);
  return undefined;
}

const held = (name, pad) => (name in BUTTONS ? Boolean(pad.buttons[BUTTONS[name]]?.pressed) : way(name, pad) > 0);

/** Share of the gait's range that a stick commands: zero within the dead zone, from there on even to its end. */
function share({ axis, reverse, share: most }, deadZone, pad) {
  const at = Math.min(1, Math.max(-1, way(axis, pad)));
  // What is no number is no command.
  if (!(Math.abs(at) > deadZone)) return 0;
  const x = (most * (Math.abs(at) - deadZone)) / (1 - deadZone) * Math.sign(at);
  return reverse ? -x : x;
}

/** What hands do: {sticks: {forward, left, turn} as shares of the gait's ranges, held: {dead_man, stop, ...}}. */
export function hands(pad, layout) {
  const sticks = {};
  for (const [name, stick] of Object.entries(layout.sticks)) sticks[name] = share(stick, layout.dead_zone, pad);
  const buttons = {};
  for (const [name, controls] of Object.entries(layout.buttons)) buttons[name] = controls.some((control) => held(control, pad));
  return { sticks, held: buttons };
}

/** Velocity for shares of `ranges` [m/s, rad/s], in whole steps towards zero. */
export function velocity(shares, ranges) {
  const values = {};
  for (const [name, [low, high]] of Object.entries(ranges)) {
    const x = shares[name] > 0 ? shares[name] * high : -shares[name] * low;
    const steps = Math.trunc(x / STEP + 1e-6 * Math.sign(x));
    // Adding zero: no minus in front of it.
    values[name] = Number.isFinite(steps) ? Math.min(high, Math.max(low, Math.round(steps) / 100)) + 0 : 0;
  }
  return values;
}

/** What a control is called by who holds the gamepad. */
export const label = (name) => LABELS[BUTTONS[name] ?? TRIGGERS[name]] ?? name;
