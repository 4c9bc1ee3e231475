// Samples of the last minutes: rings of fixed size, one per plotted field, with one time for all.

const NEVER = NaN;

/** Rings for up to 64 fields; rows come in the order of time. */
export class Rings {
  #size;
  #time;
  #values = new Map();
  #order = [];
  #head = 0;
  #count = 0;

  constructor(size) {
    this.#size = size;
    this.#time = new Float64Array(size);
  }

  /** Fields that are kept from now on; those that stay keep their past. */
  keep(fields) {
    for (const field of [...this.#values.keys()]) if (!fields.includes(field)) this.#values.delete(field);
    for (const field of fields) if (!this.#values.has(field)) this.#values.set(field, new Float32Array(this.#size).fill(NEVER));
  }

  /** Order of the columns that come from now on. */
  expect(fields) {
    this.#order = fields.map((field) => this.#values.get(field) ?? null);
    this.columns = fields.length;
  }

  columns = 0;

  /** Forgets all samples: another run has another time. */
  clear() {
    this.#head = this.#count = 0;
    for (const values of this.#values.values()) values.fill(NEVER);
  }

  /** Takes the rows of one frame; one whose columns are not those expected belongs to an older subscription. */
  take({ view, begin, rows, fields }) {
    if (fields !== this.columns) return;
    const stride = 8 + 4 * fields;
    for (let r = 0; r < rows; r++) {
      const at = begin + r * stride;
      const time = view.getFloat64(at, true);
      // Time that runs back is another run's.
      if (this.#count > 0 && time < this.newest) this.clear();
      const i = this.#head;
      this.#time[i] = time;
      for (const values of this.#values.values()) values[i] = NEVER;
      for (let c = 0; c < fields; c++) if (this.#order[c]) this.#order[c][i] = view.getFloat32(at + 8 + 4 * c, true);
      this.#head = (i + 1) % this.#size;
      if (this.#count < this.#size) this.#count++;
    }
  }

  /** Time of the newest row [s], NaN without one. */
  get newest() {
    return this.#count === 0 ? NaN : this.#time[(this.#head + this.#size - 1) % this.#size];
  }

  /** Time of the oldest row [s]. */
  get oldest() {
    return this.#count === 0 ? NaN : this.#time[(this.#head + this.#size - this.#count) % this.#size];
  }

  /** Number of rows before `time`, by bisection: rows are in the order of time. */
  #before(time) {
    const first = this.#head + this.#size - this.#count;
    let [low, high] = [0, this.#count];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.#time[(first + middle) % this.#size] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /**
   * Picture of [from, to) for `fields` in columns of pixels: least and greatest value of each column, so that no peak is
   * lost. Writes into `data` (uPlot's: times, then values; null where there is nothing) and leaves its arrays at 2 `columns`.
   */
  picture(fields, from, to, columns, data) {
    const width = (to - from) / columns;
    for (const column of data) column.length = 2 * columns;
    for (let c = 0; c < columns; c++) {
      data[0][2 * c] = from + (c + 0.25) * width;
      data[0][2 * c + 1] = from + (c + 0.75) * width;
    }
    for (let f = 0; f < fields.length; f++) data[f + 1].fill(null);
    const first = this.#head + this.#size - this.#count;
    const [begin, end] = [this.#before(from), this.#before(to)];
    for (let f = 0; f < fields.length; f++) {
      const values = this.#values.get(fields[f]);
      if (!values) continue;
      const out = data[f + 1];
      for (let k = begin; k < end; k++) {
        const i = (first + k) % this.#size;
        const v = values[i];
        if (v !== v) continue;
        const c = 2 * Math.min(columns - 1, Math.floor((this.#time[i] - from) / width));
        // First of the column in both places; after that the lesser goes left and the greater right of it.
        if (out[c] === null) out[c] = out[c + 1] = v;
        else if (v < out[c]) out[c] = v;
        else if (v > out[c + 1]) out[c + 1] = v;
      }
    }
  }
}
