// Events: what the processes report and what was answered, newest first.

import { h, newId, say } from "../dom.js";
import { because } from "../desk.js";
import { fixed } from "../numbers.js";

const MOST = 500;

/** List of events with a filter. */
export class Events {
  #list = h("ol", { class: "events", tabindex: 0, "aria-label": "Events, newest first" });
  #filter = h("input", { id: newId("filter"), type: "search", placeholder: "part of a process, name or text", autocomplete: "off", spellcheck: "false" });
  #count = h("span", { class: "hint", role: "status" });
  #rows = [];
  #unseen;

  constructor(hub, unseen) {
    this.#unseen = unseen;
    this.#filter.addEventListener("input", () => this.#apply());
    this.element = h("div", { class: "panel-fill" },
      h("div", { class: "filter" }, h("label", { for: this.#filter.id }, "Filter"), this.#filter, this.#count,
        h("button", { type: "button", class: "quiet", onclick: () => this.#clear() }, "Clear")),
      this.#list);
    hub.on("event", (event) => this.#add(event));
    hub.on("answered", ({ what, accepted, text, time }) => {
      this.#add({ time, process: "you", name: what, text: `${accepted ? "accepted" : "refused"}${because(accepted, text)}`, kind: accepted ? "good" : "bad" });
    });
    hub.on("hello", ({ run }) => {
      if (run === this.#run) return;
      this.#run = run;
      this.#clear();
    });
    this.#apply();
  }

  #run;

  #add({ time, process, name, text, kind = "" }) {
    // A server that sends its latest events again to a page that comes back tells nothing new.
    if (process !== "you" && this.#rows.some((r) => r.time === time && r.process === process && r.name === name && r.said === text)) return;
    const element = h("li", { "data-kind": kind },
      h("time", {}, `${fixed(time, 3)} s`), h("span", { class: "event-process" }, process), h("span", { class: "event-name" }, name), h("span", { class: "event-text" }, text));
    const row = { element, time, process, name, said: text, words: `${process} ${name} ${text}`.toLowerCase() };
    this.#rows.unshift(row);
    this.#list.prepend(element);
    if (this.#rows.length > MOST) this.#rows.pop().element.remove();
    element.hidden = !row.words.includes(this.#filter.value.trim().toLowerCase());
    this.#tell();
    this.#unseen();
  }

  #apply() {
    const wanted = this.#filter.value.trim().toLowerCase();
    for (const { element, words } of this.#rows) element.hidden = !words.includes(wanted);
    this.#tell();
  }

  #clear() {
    this.#rows.length = 0;
    this.#list.replaceChildren();
    this.#tell();
  }

  #tell() {
    const shown = this.#rows.filter(({ element }) => !element.hidden).length;
    say(this.#count, shown === this.#rows.length ? `${shown}` : `${shown} of ${this.#rows.length}`);
  }
}
