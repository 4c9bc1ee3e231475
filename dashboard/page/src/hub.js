// Messages inside the page: who receives one from the server says it here, who shows it listens here.

/** Table of listeners by kind of message; a listener that comes late gets what is known already. */
export class Hub {
  #listeners = new Map();
  #last = new Map();

  /** Calls `listener` with each message of `kind`, and with the last one that came, if there was one. */
  on(kind, listener) {
    if (!this.#listeners.has(kind)) this.#listeners.set(kind, []);
    this.#listeners.get(kind).push(listener);
    if (this.#last.has(kind)) listener(this.#last.get(kind));
  }

  /** Hands `message` to all who listen for `kind`. */
  say(kind, message) {
    this.#last.set(kind, message);
    const listeners = this.#listeners.get(kind);
    if (listeners) for (let i = 0; i < listeners.length; i++) listeners[i](message);
  }

  /** Last message of `kind`, or undefined. */
  last(kind) {
    return this.#last.get(kind);
  }
}
