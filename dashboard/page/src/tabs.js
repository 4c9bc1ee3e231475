// Tabs of the side panel: one panel is seen, the arrow keys go from tab to tab.

import { h, mark, newId } from "./dom.js";
import { recall, remember } from "./store.js";

const KEPT = "gangwerk.tab";

/** Tabs over `panels` ([name, element, title, hidden at first]); `changed(name)` after each change. */
export class Tabs {
  #tabs = new Map();
  current = "";
  #changed;
  #kept = recall("sessionStorage", KEPT);

  constructor(panels, changed) {
    this.#changed = changed;
    const list = h("div", { class: "tabs", role: "tablist", "aria-label": "Panels" });
    this.element = h("aside", { class: "side", "aria-label": "Desk" }, list);
    for (const [name, content, title, hidden] of panels) {
      const id = newId("tab");
      const panel = h("div", { id: newId("panel"), class: `panel panel-${name}`, role: "tabpanel", "aria-labelledby": id, hidden: true, tabindex: -1 }, content);
      const tab = h("button", { id, type: "button", role: "tab", "aria-controls": panel.id, "aria-selected": "false", tabindex: -1, hidden, onclick: () => this.open(name) }, title);
      list.append(tab);
      this.element.append(panel);
      this.#tabs.set(name, { tab, panel });
    }
    list.addEventListener("keydown", (event) => this.#key(event));
    const names = this.#names();
    this.open(names.includes(this.#kept) ? this.#kept : names[0]);
  }

  /** Shows a tab that was hidden, and its panel if it was the open one before a reload; false: it is there already. */
  reveal(name) {
    const { tab } = this.#tabs.get(name);
    if (!tab.hidden) return false;
    tab.hidden = false;
    if (this.#kept === name) this.open(name);
    return true;
  }

  /** Names of the tabs that are there. */
  #names() {
    return [...this.#tabs].filter(([, { tab }]) => !tab.hidden).map(([name]) => name);
  }

  /** Shows a panel. */
  open(name) {
    this.current = name;
    for (const [other, { tab, panel }] of this.#tabs) {
      const on = other === name;
      mark(tab, "aria-selected", String(on));
      tab.tabIndex = on ? 0 : -1;
      panel.hidden = !on;
    }
    this.#tabs.get(name).tab.removeAttribute("data-news");
    remember("sessionStorage", KEPT, name);
    mark(document.body, "data-tab", name);
    this.#changed?.(name);
  }

  /** Dot on a tab whose panel has something new and is not seen. */
  news(name) {
    if (name !== this.current) mark(this.#tabs.get(name).tab, "data-news", "true");
  }

  #key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    const names = this.#names();
    const to = step ? (names.indexOf(this.current) + step + names.length) % names.length : event.key === "Home" ? 0 : event.key === "End" ? names.length - 1 : -1;
    if (to < 0) return;
    event.preventDefault();
    this.open(names[to]);
    this.#tabs.get(names[to]).tab.focus();
  }
}
