// Colours of the 3-D view: those of the style sheet, read again when the system turns from light to dark.

import { Color } from "three";

const NAMES = ["sky", "ground", "grid", "grid-strong", "hull", "frame", "ghost", "other", "object", "object-edge",
  "load-none", "load-some", "load-full", "load-over", "force", "zmp", "zmp-planned", "capture", "cog", "path",
  "step-right", "step-left", "push"];

/** Table of colours by name; `changed` is called after each change of the system's scheme. */
export class Theme {
  #listeners = [];

  constructor() {
    for (const name of NAMES) this[name] = new Color();
    this.#read();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.#read();
      for (const listener of this.#listeners) listener();
    });
  }

  /** Calls `listener` now and whenever the colours have changed. */
  onChange(listener) {
    this.#listeners.push(listener);
    listener();
  }

  /** Forgets all listeners: what they coloured is gone. */
  forget() {
    this.#listeners.length = 0;
  }

  #read() {
    const style = getComputedStyle(document.documentElement);
    for (const name of NAMES) this[name].set(style.getPropertyValue(`--view-${name}`).trim());
    this.dark = style.getPropertyValue("--view-dark").trim() === "1";
  }
}
