// What the page keeps between visits. A browser that keeps nothing, as with cookies blocked, loses only that.

/** Text that is kept in `place` ("localStorage" or "sessionStorage") under `key`, or null. */
export function recall(place, key) {
  try {
    return window[place].getItem(key);
  } catch {
    return null;
  }
}

/** Keeps a text there, if the browser lets it. */
export function remember(place, key, text) {
  try {
    window[place].setItem(key, text);
  } catch {
    // Then it is not kept.
  }
}
