// Binary frames of the server: state for the pictures, samples for the plots.

const HEADER = 16;
const STATE = 1;
const SAMPLES = 2;
// The same of the other log of a replay.
const OTHER_STATE = 3;
const OTHER_SAMPLES = 4;

/** State as it was last: the numbers of the newest frame, in the layout of `hello.state`. */
export const state = {
  values: new Float32Array(0),
  tick: 0,
  lost: 0,
  /** Count of frames since the page was loaded: who draws compares it with the one drawn last. */
  count: 0,
  /** Instant of arrival, performance.now(). */
  arrived: 0,
};

/** State of the other log of a replay. */
export const other = { ...state };

// One object for all frames of samples: who listens copies what it needs.
const samples = { tick: 0, fields: 0, rows: 0, view: null, begin: 0 };

/** Reads one frame: a state into `state`, samples to the listeners of "samples". A frame of another kind is left alone. */
export function decodeFrame(buffer, hub) {
  if (buffer.byteLength < HEADER) return;
  const view = new DataView(buffer);
  const kind = view.getUint8(0);
  const tick = view.getUint32(8, true) + view.getUint32(12, true) * 2 ** 32;
  if (kind === STATE || kind === OTHER_STATE) {
    takeState(kind === STATE ? state : other, buffer, view.getUint32(4, true), tick);
    if (kind === STATE) hub.say("state", state);
  } else if (kind === SAMPLES || kind === OTHER_SAMPLES) {
    samples.tick = tick;
    samples.fields = view.getUint16(HEADER, true);
    samples.rows = view.getUint16(HEADER + 2, true);
    samples.view = view;
    samples.begin = HEADER + 4;
    // Fewer bytes than the counts say: a frame that cannot be trusted.
    if (buffer.byteLength < samples.begin + samples.rows * (8 + 4 * samples.fields)) return;
    hub.say(kind === SAMPLES ? "samples" : "other-samples", samples);
  }
}

function takeState(state, buffer, lost, tick) {
  const count = (buffer.byteLength - HEADER) >> 2;
  if (state.values.length !== count) state.values = new Float32Array(count);
  state.values.set(new Float32Array(buffer, HEADER, count));
  state.tick = tick;
  state.lost = lost;
  state.arrived = performance.now();
  state.count++;
}
