// The desk: commands with their answers beside their buttons.

import { h, mark, say } from "./dom.js";
import { state } from "./frames.js";
import { fixed } from "./numbers.js";

/** Who sends commands and shows what came of them. */
export class Desk {
  #link;
  #hub;
  cycle = 0.001;
  /** Time of the robot at which this page last stopped the walk [s]. */
  stopped = -Infinity;

  constructor(link, hub) {
    this.#link = link;
    this.#hub = hub;
    hub.on("hello", (hello) => { [this.cycle, this.stopped] = [hello.cycle, -Infinity]; });
  }

  /** Time of the robot [s]. */
  get time() {
    return state.tick * this.cycle;
  }

  /** Sends a command of the broker; `at` is the answer beside its button. Resolves to {accepted, text}. */
  command(name, values, at) {
    // A velocity of zero is a stop, too.
    if (name === "walk/stop" || (name === "walk/velocity" && Object.values(values).every((x) => x === 0))) this.stopped = this.time;
    return this.#ask({ type: "command", name, values }, name, at);
  }

  /** Gives a parameter another value. */
  set(name, value, at) {
    return this.#ask({ type: "set", name, value }, name, at);
  }

  /** Takes the lease (`over`: also from who holds it), or gives it. */
  lease(message, at) {
    return this.#ask({ type: "lease", ...message }, "lease", at);
  }

  /** Emergency stop: always possible, whoever holds the lease. */
  emergencyStop(at) {
    const answer = this.#ask({ type: "emergency_stop" }, "emergency stop", at);
    this.#hub.say("halt", {});
    return answer;
  }

  /** Starts a run of a scene: {scene, depth, integrator}; null: as the scene says. */
  start(order, at) {
    return this.#ask({ type: "start", ...order }, `start ${order.scene}`, at);
  }

  /** Ends the run that was started here. */
  end(at) {
    return this.#ask({ type: "end" }, "stop", at);
  }

  async #ask(message, what, at) {
    at?.wait(what);
    const answer = await this.#link.ask(message);
    const time = this.time;
    at?.show(answer, what, time);
    this.#hub.say("answered", { ...answer, what, time });
    return answer;
  }
}

/** Who accepted, one word; or a sentence: what came of it, or why not. */
export const because = (accepted, text) => (!text ? "" : accepted && !text.includes(" ") ? ` by ${text}` : `: ${text}`);

/** Place where an answer is shown: read aloud when it comes, with the robot's time. */
export class Answer {
  #latest = "";

  constructor(label) {
    this.element = h("output", { class: "answer", "aria-label": label });
  }

  /** A question is on its way. */
  wait(what) {
    this.#latest = what;
    mark(this.element, "data-state", "waiting");
    say(this.element, "…");
  }

  /** Something that nobody asked for. */
  tell(answer, what, time) {
    this.wait(what);
    this.show(answer, what, time);
  }

  /** Its answer; that of an older question is not shown over a newer one's. */
  show({ accepted, text }, what, time) {
    if (what !== this.#latest) return;
    mark(this.element, "data-state", accepted ? "accepted" : "refused");
    say(this.element, `${accepted ? "✓ accepted" : "✗ refused"} ${fixed(time, 1)} s · ${what}${because(accepted, text)}`);
    this.element.title = this.element.textContent;
  }
}
