// Connection to the server: opens the socket, opens it again after a loss, tells who listens, and keeps the pulse.

import { decodeFrame } from "./frames.js";

const PULSE_MS = 100;
const RETRY_MS = [200, 400, 800, 1500];
// An answer takes 300 ms at most by the broker's own limit; after this time it will not come any more.
const ANSWER_MS = 2000;

/** Link to the server: `send` for messages, `ask` for those that are answered. State goes to the hub as "connection". */
export class Link {
  #hub;
  #address;
  #socket = null;
  #tries = 0;
  #nextId = 1;
  #waiting = new Map();
  #retry = 0;
  #pulsed = 0; // [ms] time of the last heartbeat

  constructor(hub, address) {
    this.#hub = hub;
    this.#address = address;
  }

  /** Opens the connection and keeps it open from now on. */
  start() {
    this.#open();
    setInterval(() => this.pulse(), PULSE_MS);
    // A page that comes back into view or onto the network does not wait for its turn.
    document.addEventListener("visibilitychange", () => this.#soon());
    window.addEventListener("online", () => this.#soon());
  }

  /** Whether the server can be reached now. */
  get open() {
    return this.#socket !== null && this.#socket.readyState === WebSocket.OPEN;
  }

  /** Sends one message; false if there is no connection. */
  send(message) {
    if (!this.open) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  /** Sends one message that is answered; resolves to {accepted, text}, also when no answer comes. */
  ask(message) {
    const id = this.#nextId++;
    if (!this.send({ ...message, id })) {
      return Promise.resolve({ accepted: false, text: "not sent: no connection to the dashboard's server" });
    }
    return new Promise((resolve) => {
      const timer = setTimeout(() => this.#answer({ id, accepted: false, text: `no answer within ${ANSWER_MS / 1000} s` }), ANSWER_MS);
      this.#waiting.set(id, { resolve, timer });
    });
  }

  #open() {
    clearTimeout(this.#retry);
    this.#hub.say("connection", { state: "opening", tries: this.#tries });
    const socket = new WebSocket(this.#address);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    socket.onopen = () => {
      this.#tries = 0;
      this.#hub.say("connection", { state: "open", tries: 0 });
    };
    socket.onmessage = ({ data }) => this.#take(data);
    socket.onclose = ({ code, reason }) => this.#lost(socket, code, reason);
  }

  #take(data) {
    this.pulse();
    if (typeof data !== "string") {
      decodeFrame(data, this.#hub);
      return;
    }
    const message = JSON.parse(data);
    if (message.type === "answer") this.#answer(message);
    this.#hub.say(message.type, message);
  }

  #answer(message) {
    const waiting = this.#waiting.get(message.id);
    if (!waiting) return;
    clearTimeout(waiting.timer);
    this.#waiting.delete(message.id);
    waiting.resolve(message);
  }

  /** End of a connection: what waits for an answer hears that none will come, and the next try is set. */
  #lost(socket, code, reason) {
    if (socket !== this.#socket) return;
    this.#socket = null;
    for (const id of [...this.#waiting.keys()]) {
      this.#answer({ id, accepted: false, text: "connection lost before the answer came" });
    }
    this.#hub.say("connection", { state: "lost", tries: this.#tries, code, reason });
    const wait = RETRY_MS[Math.min(this.#tries, RETRY_MS.length - 1)];
    this.#tries++;
    this.#retry = setTimeout(() => this.#open(), wait);
  }

  /** Next try now instead of at the end of its wait. */
  #soon() {
    if (this.#socket === null && document.visibilityState === "visible") this.#open();
  }

  /**
   * Heartbeat of an operator who sees the robot, if one is due; a hidden page gives none, and the robot stops. Called by frames and
   * messages, too: a browser whose pictures take long lets timers wait behind them and behind keys, for a second and more.
   */
  pulse() {
    const now = performance.now();
    if (now - this.#pulsed < PULSE_MS / 2 || document.visibilityState !== "visible") return;
    this.#pulsed = now;
    // No heartbeat without a look at the hands: what keeps the lease sees a release.
    this.#hub.say("pulse", {});
    this.send({ type: "pulse" });
  }
}
