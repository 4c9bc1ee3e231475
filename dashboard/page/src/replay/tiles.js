// Samples of a recording around the cursor: tiles of a second, asked for when they are looked at and forgotten when far away.

const AT_ONCE = 8; // tiles of one request
const PATIENCE_MS = 5000;

/** Tiles of one log (0, or 1: the other one); the same face as Rings to the plots. `span()`: first and last instant of the log [s]. */
export class Tiles {
  columns = -1;
  #log;
  #link;
  #span;
  #cycle;
  #fields = [];
  #tiles = new Map();
  #asked = null;

  constructor(link, log, span, cycle) {
    this.#link = link;
    this.#log = log;
    this.#span = span;
    this.#cycle = cycle;
  }

  /** Other fields are wanted: what was loaded has other columns. */
  keep() {
    this.columns = -1;
    this.clear();
  }

  /** Order of the columns that come from now on. */
  expect(fields) {
    if (this.columns >= 0 && fields.join() !== this.#fields.join()) this.clear();
    this.#fields = fields;
    this.columns = fields.length;
  }

  /** Forgets all samples. */
  clear() {
    this.#tiles.clear();
    this.#asked = null;
  }

  /** The log has grown: its last tile was not whole. */
  grown(last) {
    this.#tiles.delete(Math.floor(last));
  }

  /** Takes the rows of one frame. */
  take({ view, begin, rows, fields }) {
    if (fields !== this.columns) return;
    const stride = 8 + 4 * fields;
    for (let r = 0; r < rows; r++) {
      const at = begin + r * stride;
      const time = view.getFloat64(at, true);
      const tile = this.#tiles.get(Math.floor(time + this.#cycle / 2));
      if (!tile || tile.whole) continue;
      tile.time.push(time);
      for (let c = 0; c < fields; c++) tile.values[c].push(view.getFloat32(at + 8 + 4 * c, true));
    }
  }

  /** The server has sent all of a stretch. */
  done({ from, to }) {
    for (let k = Math.floor(from); k < to; k++) {
      const tile = this.#tiles.get(k);
      if (tile) tile.whole = true;
    }
    if (this.#asked?.from === from && this.#asked.to === to) this.#asked = null;
  }

  /** Asks for what is missing of [from, to), one stretch at a time, and forgets what is far from it. */
  want(from, to, now) {
    if (this.columns <= 0 || (this.#asked && now - this.#asked.at < PATIENCE_MS)) return;
    const { first, last } = this.#span();
    const air = to - from;
    for (const k of this.#tiles.keys()) if (k + 1 < from - air || k > to + air) this.#tiles.delete(k);
    const [low, high] = [Math.floor(Math.max(from, first)), Math.floor(Math.min(to, last))];
    // From the middle on, where the cursor is, then what is before it.
    const middle = Math.floor(Math.min(high, Math.max(low, (from + to) / 2)));
    const missing = (k) => !this.#tiles.get(k)?.whole;
    let begin = middle;
    while (begin <= high && !missing(begin)) begin++;
    if (begin > high) {
      begin = middle - 1;
      while (begin >= low && !missing(begin)) begin--;
      if (begin < low) return;
      for (let n = 1; n < AT_ONCE && begin > low && missing(begin - 1); n++) begin--;
    }
    let end = begin;
    while (end < begin + AT_ONCE && end <= high && missing(end)) {
      this.#tiles.set(end++, { time: [], values: this.#fields.map(() => []), whole: false });
    }
    const asked = { from: begin, to: end, at: now };
    if (this.#link.send({ type: "window", log: this.#log, from: begin, to: end })) this.#asked = asked;
  }

  /** Samples [time, value] of a field in [from, to), for checks. */
  samples(field, from, to) {
    const c = this.#fields.indexOf(field);
    const found = [];
    for (const tile of this.#between(from, to)) {
      tile.time.forEach((t, i) => t >= from && t < to && c >= 0 && found.push([t, tile.values[c][i]]));
    }
    return found;
  }

  #between(from, to) {
    return [...this.#tiles.keys()].filter((k) => k + 1 >= from && k < to).sort((a, b) => a - b).map((k) => this.#tiles.get(k));
  }

  /** As `Rings.picture`, into the columns of `data` from `at` on; `shift` [s] is added to the times. */
  picture(fields, from, to, columns, data, at = 1, shift = 0) {
    const width = (to - from) / columns;
    const tiles = this.#between(from - shift, to - shift);
    fields.forEach((field, f) => {
      const out = data[at + f];
      out.fill(null);
      const column = this.#fields.indexOf(field);
      if (column < 0) return;
      for (const { time, values } of tiles) {
        for (let i = 0; i < time.length; i++) {
          const [t, v] = [time[i] + shift, values[column][i]];
          if (v !== v || t < from || t >= to) continue;
          const c = 2 * Math.min(columns - 1, Math.floor((t - from) / width));
          if (out[c] === null) out[c] = out[c + 1] = v;
          else if (v < out[c]) out[c] = v;
          else if (v > out[c + 1]) out[c + 1] = v;
        }
      }
    });
  }
}

/** Samples of the log, and of the other one if there is one, for the plots: the other one's columns come behind. */
export class Store {
  #tiles;
  #cursor;

  constructor(tiles, cursor) {
    this.#tiles = tiles;
    this.#cursor = cursor;
  }

  /** True if there are two logs: each field has a second, dashed line. */
  get doubled() {
    return this.#tiles.length > 1;
  }

  /** Stretch around the cursor [s]. */
  span(length) {
    return [this.#cursor.time - length / 2, this.#cursor.time + length / 2];
  }

  /** The instant that is shown [s]. */
  get cursor() {
    return this.#cursor.time;
  }

  keep(fields) {
    for (const tiles of this.#tiles) tiles.keep(fields);
  }

  expect(fields, other = []) {
    this.#tiles[0].expect(fields);
    this.#tiles[1]?.expect(other);
  }

  clear() {
    for (const tiles of this.#tiles) tiles.clear();
  }

  /** Asks for what is missing. */
  want(from, to, now) {
    this.#tiles[0].want(from, to, now);
    this.#tiles[1]?.want(from + this.#cursor.offset, to + this.#cursor.offset, now);
  }

  picture(fields, from, to, columns, data) {
    const width = (to - from) / columns;
    for (const column of data) column.length = 2 * columns;
    for (let c = 0; c < columns; c++) {
      data[0][2 * c] = from + (c + 0.25) * width;
      data[0][2 * c + 1] = from + (c + 0.75) * width;
    }
    this.#tiles[0].picture(fields, from, to, columns, data);
    this.#tiles[1]?.picture(fields, from, to, columns, data, 1 + fields.length, -this.#cursor.offset);
  }
}
