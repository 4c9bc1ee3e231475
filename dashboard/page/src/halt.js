// Halts that end what the hands command: emergency stop, supply off, a fall, joints stopped, a walk that others ended.

import { FALLEN, HALTED, STARTING, WALKING } from "./words.js";

// [s] Time of the robot within which a stop shows in the gait: it begins with the next step, of 1.5 s at most.
const OWN = 3;

/** Says "halt" when a state shows one; the desk says its own emergency stop. */
export function watchHalts(desk, hub) {
  let [layout, supply, gait] = [null, NaN, NaN];
  hub.on("layout", (now) => { [layout, supply, gait] = [now, NaN, NaN]; });
  hub.on("state", ({ values }) => {
    if (!layout) return;
    const [powered, before] = [supply === 1, gait];
    [supply, gait] = [values[layout.at("supply")], values[layout.at("gait")]];
    const down = gait !== before && (gait === FALLEN || gait === HALTED);
    // After a stop of this page sliders may have been moved again, and stand for what comes next.
    const ended = walks(before) && !walks(gait) && desk.time - desk.stopped > OWN;
    if ((powered && supply !== 1) || down || ended) hub.say("halt", {});
  });
}

const walks = (gait) => gait === STARTING || gait === WALKING;
