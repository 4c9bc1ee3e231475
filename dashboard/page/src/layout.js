// Layout of a state frame: where each of its numbers is.

/** Places of the parts that `hello.state` names; a part that the server does not send is absent. */
export class Layout {
  #parts = new Map();

  constructor(parts) {
    let at = 0;
    for (const { name, count, unit } of parts) {
      this.#parts.set(name, { at, count, unit });
      at += count;
    }
    this.length = at;
  }

  /** First index of a part, or -1. */
  at(name) {
    return this.#parts.get(name)?.at ?? -1;
  }

  /** Count of numbers of a part, 0 if it is absent. */
  count(name) {
    return this.#parts.get(name)?.count ?? 0;
  }
}
