// Header: who this is, and the state that everybody must see at a glance.

import { h, mark, say } from "../dom.js";
import { state } from "../frames.js";
import { fixed } from "../numbers.js";
import { GAIT, START_UP } from "../words.js";

const STALE_MS = 500; // without a state frame

/** Bar at the top; call `refresh` a few times per second. */
export class Header {
  #hub;
  #connection = chip("Connection");
  #time = chip("Time of the robot");
  #supply = chip("Motor supply");
  #gait = chip("State");
  #pace = chip("Speed of the simulation");
  #name = h("span", { class: "scene-name" });
  #layout = null;
  #link = { robot: false, broker: false, why: "" };
  #open = "opening";
  /** Name of the recording that is shown; empty: a robot runs. */
  recording = "";

  constructor(hub, stop, lease) {
    this.#hub = hub;
    this.element = h("header", { class: "bar" },
      h("div", { class: "brand" }, h("h1", {}, "Gangwerk"), this.#name),
      h("div", { class: "chips", role: "group", "aria-label": "State" }, this.#connection, this.#time, this.#supply, this.#gait, this.#pace),
      h("a", { class: "book-link", href: "/book/", target: "_blank", rel: "noopener" }, "Book"),
      lease, stop);
    hub.on("connection", ({ state: open, tries, code }) => {
      this.#open = open === "opening" && tries > 0 ? "lost" : open;
      this.#why = code === 1008 || code === 1009 ? "the server closed the connection: a message was refused" : "";
      this.refresh();
    });
    hub.on("link", (link) => { this.#link = link; this.refresh(); });
    hub.on("hello", (hello) => {
      this.#link = { robot: true, broker: this.#link.broker, why: this.#link.why };
      say(this.#name, `${hello.robot.name} · ${hello.scene.name}`);
      this.#name.title = hello.scene.about;
      document.title = `${hello.robot.name} · Gangwerk`;
    });
    hub.on("layout", (layout) => { this.#layout = layout; });
    hub.on("processes", ({ real_time_factor: factor }) => {
      set(this.#pace, Number.isFinite(factor) && factor !== null ? `× ${fixed(factor, 2)}` : "", factor !== null && factor < 0.9 ? "warn" : "");
    });
  }

  #why = "";

  /** Sentence about the connection that the banner shows while something is missing; empty when all is well. */
  get trouble() {
    if (this.#open !== "open") {
      return this.#why || "No connection to the dashboard's server. It is tried again and again; if it was started anew, open the address that it printed. The emergency stop does not reach her from here: use `gangwerk estop`.";
    }
    if (this.recording) return this.#link.why;
    if (!this.#link.robot && this.#hub.last("run")?.state === "none") return "No robot runs. Start one in the panel Scenes.";
    if (!this.#link.robot) return this.#link.why || "No robot runs. The page goes on by itself when one does: gangwerk run SCENE.";
    if (!this.#link.broker) return this.#link.why || "The broker does not answer: commands do not reach the robot.";
    return "";
  }

  /** Brings the chips up to date. */
  refresh() {
    const fresh = this.recording !== "" || performance.now() - state.arrived < STALE_MS;
    const alive = this.#open === "open" && this.#link.robot;
    if (this.#open !== "open") set(this.#connection, this.#open === "lost" ? "connection lost" : "connecting", "bad");
    else if (this.recording) set(this.#connection, this.recording, "");
    else if (!this.#link.robot) set(this.#connection, "no robot", "warn");
    else if (!this.#link.broker) set(this.#connection, "no broker", "warn");
    else set(this.#connection, fresh ? "connected" : "no news", fresh ? "good" : "warn");
    const value = (name) => (this.#layout && state.values.length ? state.values[this.#layout.at(name)] : NaN);
    const [time, supply, startUp, gait] = [value("time"), value("supply"), value("start_up"), value("gait")];
    set(this.#time, Number.isFinite(time) ? `${fixed(time, this.recording ? 3 : 1)} s` : "", "");
    set(this.#supply, supply === 1 ? "power on" : supply === 0 ? "power off" : "", alive ? (supply === 1 ? "good" : "bad") : "");
    const started = startUp === 6;
    set(this.#gait, (started && gait > 0 ? GAIT[gait] : gait >= 5 ? GAIT[gait] : START_UP[startUp]) ?? "", gait >= 5 || startUp === 7 ? "bad" : "");
    mark(document.body, "data-alive", String(alive && fresh));
  }
}

/** Chip with a label for who does not see its colour. */
function chip(label) {
  return h("span", { class: "chip", title: label, hidden: true });
}

function set(element, text, kind) {
  say(element, text);
  mark(element, "data-kind", kind);
  element.hidden = text === "";
}
