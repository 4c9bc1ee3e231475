// Gamepad: what is plugged in, its sticks, and whether its dead-man button is held; while it is, the sticks move the sliders.

import { h, mark, say } from "../dom.js";
import { hands, label, velocity } from "../joystick.js";

const EVERY_MS = 40; // looks at the gamepad
const STILL_MS = 500; // a page that stood still for so long may have lost the lease

/** Rules of the gamepad, and its part of the walk panel. */
export class Joystick {
  #walk;
  #actions;
  #layout = null;
  #ranges = null;
  /** The hands steer: the button is held, and was pressed since anything went wrong. */
  #steers = false;
  /** The button must be released before it counts. */
  #spent = true;
  /** The sticks must come to their centre before they count. */
  #parked = false;
  #sent = null;
  #before = {};
  #looked = 0;
  #status = h("p", { class: "hint", role: "status" });
  #dots = [h("i"), h("i")];

  /** `actions`: emergency stop and next step of the start-up. */
  constructor(hub, walk, actions) {
    this.#walk = walk;
    this.#actions = actions;
    this.element = h("div", { class: "pad", role: "group", "aria-label": "Gamepad" },
      this.#dots.map((dot) => h("span", { class: "pad-stick", "aria-hidden": "true" }, dot)), this.#status);
    hub.on("hello", ({ joystick, gait }) => {
      this.#lapse();
      this.#layout = joystick ?? null;
      this.#ranges = gait.velocity;
    });
    let mine = false;
    hub.on("lease", (lease) => {
      if (mine && !lease.mine) this.#lapse();
      mine = lease.mine;
    });
    hub.on("connection", ({ state }) => state !== "open" && this.#lapse());
    hub.on("event", ({ name }) => name === "LeaseLost" && this.#lapse());
    hub.on("halt", () => this.#lapse());
    hub.on("pulse", () => this.#look());
    document.addEventListener("visibilitychange", () => document.visibilityState !== "visible" && this.#leave());
    window.addEventListener("pagehide", () => this.#leave());
    setInterval(() => this.#look(), EVERY_MS);
    this.#look();
  }

  /** Nothing moves by what is held now, and what it moved comes to a stand: the lease may be held still, or again. */
  #lapse() {
    if (this.#unhand()) this.#walk.giveUp();
  }

  /** The hands steer no more until the button was released; whether they did. */
  #unhand() {
    const steered = this.#steers;
    [this.#spent, this.#steers] = [true, false];
    return steered;
  }

  /** As a release: nobody sees the robot any more, or the gamepad is gone. */
  #leave() {
    if (this.#unhand()) this.#walk.stop();
    this.#before = {};
  }

  #look() {
    const now = performance.now();
    if (now - this.#looked > STILL_MS) this.#lapse();
    this.#looked = now;
    const pads = [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad?.connected);
    const pad = pads.find(({ mapping }) => mapping === "standard");
    const usable = pad && this.#layout && !this.#layout.problem && document.visibilityState === "visible";
    if (!usable) {
      this.#leave();
      return this.#show(pads[0], null);
    }
    const hand = hands(pad, this.#layout);
    this.#press(hand.held);
    this.#steer(hand);
    this.#show(pad, hand);
  }

  /** Buttons that were not held at the last look. */
  #press(held) {
    const pressed = (name) => held[name] && this.#before[name] === false;
    if (pressed("emergency_stop")) this.#actions.emergencyStop();
    if (pressed("stop")) {
      [this.#parked, this.#sent] = [true, null];
      this.#walk.stop();
    }
    if (this.#steers) {
      if (pressed("walk")) this.#walk.onTheSpot();
      if (pressed("stand")) this.#walk.stand();
      if (pressed("next")) this.#actions.next();
    } else if (["walk", "stand", "next"].some(pressed)) {
      this.#walk.tell("hold the dead-man button of the gamepad first");
    }
    this.#before = held;
  }

  #steer({ sticks, held }) {
    if (!held.dead_man) {
      if (this.#steers) this.#walk.stop();
      [this.#steers, this.#spent] = [false, false];
      return;
    }
    if (this.#spent) return;
    const wanted = velocity(sticks, this.#ranges);
    const rests = Object.values(wanted).every((x) => x === 0);
    if (!this.#steers) {
      [this.#steers, this.#parked, this.#sent] = [true, false, null];
      this.#take();
    }
    this.#parked &&= !rests;
    const key = JSON.stringify(wanted);
    // Sticks that rest since the press move no slider: who moves last steers.
    if (this.#parked || key === this.#sent || (this.#sent === null && rests)) return;
    this.#sent = key;
    this.#walk.steer(wanted);
  }

  async #take() {
    const { accepted } = await this.#walk.lease();
    if (!accepted) this.#lapse();
  }

  #show(pad, now) {
    const standard = pad?.mapping === "standard";
    const state = !pad ? "none" : !standard || !now ? "unusable" : this.#steers ? "held" : now.held.dead_man ? "spent" : "ready";
    mark(this.element, "data-state", state);
    const name = pad?.id.replace(/\s*\((STANDARD|Vendor).*$/i, "");
    const button = this.#layout?.buttons?.dead_man.map(label).join(" or ");
    const texts = {
      none: "No gamepad: plug one in and press one of its buttons.",
      unusable: this.#layout?.problem ? `Gamepad: ${this.#layout.problem}` : standard ? `${name}: no robot runs yet.` : `${name}: this browser does not know where its buttons are; gangwerk joystick does.`,
      ready: `${name}: hold ${button} to steer.`,
      held: `${name}: dead-man button held, you steer.`,
      spent: `${name}: release ${button}, then hold it again.`,
    };
    say(this.#status, texts[state]);
    for (const [i, dot] of this.#dots.entries()) {
      const [x, y] = [0, 1].map((k) => Math.round(50 * ((standard && pad.axes[2 * i + k]) || 0)));
      dot.style.transform = `translate(${x}%, ${y}%)`;
    }
  }
}
