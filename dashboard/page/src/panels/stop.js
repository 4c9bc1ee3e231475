// Emergency stop: always in view, by press, by the space bar and by Escape twice.

import { h } from "../dom.js";
import { Answer } from "../desk.js";

const TWICE_MS = 600;
const SHOWN_MS = 15000;

/** Fields in which a blank is text. Numbers have none: the space bar stops there, too. */
const TEXT = new Set(["text", "search", "url", "email", "password"]);

/** Button and keys of the emergency stop: {button, answer, stop}; the answer has a place of its own, where it covers no control. */
export function emergencyStop(desk) {
  const answer = new Answer("Answer to the emergency stop");
  answer.element.classList.add("stop-answer");
  let shown = 0;
  const stop = async () => {
    clearTimeout(shown);
    answer.element.hidden = false;
    await desk.emergencyStop(answer);
    // What was answered long ago is in the events.
    clearTimeout(shown);
    shown = setTimeout(() => { answer.element.hidden = true; }, SHOWN_MS);
  };
  const button = h("button", { type: "button", class: "stop", "aria-keyshortcuts": "Space Escape" },
    h("strong", {}, "EMERGENCY STOP"), h("span", {}, "Space bar · Esc twice"));
  // With the press, not with letting go: that is 100 ms earlier.
  button.addEventListener("pointerdown", stop);
  button.addEventListener("click", (event) => event.detail === 0 && stop());

  let escaped = -Infinity;
  // Before all others: no field, slider or button keeps these keys.
  window.addEventListener("keydown", (event) => {
    if (event.code === "Space" && !writesText(event.target)) {
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat) stop();
    } else if (event.key === "Escape" && !event.repeat) {
      if (event.timeStamp - escaped < TWICE_MS) stop();
      escaped = event.timeStamp;
    }
  }, true);
  // In Firefox a button that has the focus is pressed by the release of the space bar; not here.
  window.addEventListener("keyup", (event) => event.code === "Space" && !writesText(event.target) && event.preventDefault(), true);
  return { button, answer: answer.element, stop };
}

const writesText = (element) => element instanceof HTMLTextAreaElement || (element instanceof HTMLInputElement && TEXT.has(element.type));
