// Cursor of a recording: which instant is shown, whether it moves, and the requests for its state.

const PATIENCE_MS = 500; // for an answer, before it is asked for again

/** Cursor over [first, last] in whole cycles. `show(time, other)` asks for a state; `changed()` after each change that is no motion. */
export class Cursor {
  playing = false;
  speed = 1;
  /** Time of the other log minus that of the first one [s]. */
  offset = 0;
  first = 0;
  last = 0;
  cycle = 0.001;
  #time = 0;
  #show;
  #changed;
  #asked = "";
  #askedAt = -Infinity;
  #waiting = false;
  #before = 0;

  constructor(show, changed) {
    this.#show = show;
    this.#changed = changed;
  }

  /** Extent of the log [s]; the cursor stays where it is. */
  extent({ first, last, cycle }) {
    Object.assign(this, { first, last, cycle });
    this.#time = this.#within(this.#time);
  }

  /** The instant [s], that of a cycle. */
  get time() {
    return Math.round(this.#time / this.cycle) * this.cycle;
  }

  /** Goes to an instant [s]. */
  go(time) {
    if (!Number.isFinite(time)) return;
    this.#time = this.#within(time);
    this.#changed();
  }

  /** Goes so many cycles on, and stops there. */
  step(cycles) {
    this.playing = false;
    this.go(this.time + cycles * this.cycle);
  }

  /** Plays or pauses; at the end it begins again. */
  play(on = !this.playing) {
    if (on && this.time >= this.last) this.#time = this.first;
    this.playing = on;
    this.#changed();
  }

  /** Forgets what was asked for: another connection knows nothing of it. */
  forget() {
    this.#asked = "";
    this.#waiting = false;
  }

  /** A state has come. */
  answered() {
    this.#waiting = false;
  }

  /** Moves with the screen; asks for the state if it is another one, and one request at a time. */
  tick(now) {
    const seconds = Math.min(0.25, Math.max(0, (now - this.#before) / 1000));
    this.#before = now;
    if (this.playing) {
      this.#time = this.#within(this.#time + seconds * this.speed);
      if (this.#time >= this.last) {
        this.playing = false;
        this.#changed();
      }
    }
    const wanted = `${this.time} ${this.offset}`;
    if (wanted === this.#asked && !(this.#waiting && now - this.#askedAt > PATIENCE_MS)) return;
    if (this.#waiting && now - this.#askedAt < PATIENCE_MS) return;
    if (!this.#show(this.time, this.time + this.offset)) return;
    this.#asked = wanted;
    this.#askedAt = now;
    this.#waiting = true;
  }

  #within(time) {
    return Math.min(this.last, Math.max(this.first, time));
  }
}
