// Search of a field: type a part of its name, choose with arrows and Enter.

import { h, mark, newId } from "../dom.js";
import { unitOf } from "../numbers.js";

const MOST = 60;

/** Search box over `fields()`; calls `chosen(name)`. */
export function fieldSearch(label, fields, chosen) {
  const list = newId("found");
  const input = h("input", { type: "search", role: "combobox", "aria-label": label, "aria-expanded": "false", "aria-controls": list, "aria-autocomplete": "list", placeholder: "add a field …", autocomplete: "off", spellcheck: "false" });
  const found = h("ul", { id: list, role: "listbox", "aria-label": label, class: "found", hidden: true });
  let at = -1;

  const close = () => {
    found.hidden = true;
    mark(input, "aria-expanded", "false");
    input.removeAttribute("aria-activedescendant");
    at = -1;
  };
  const take = (name) => {
    input.value = "";
    close();
    chosen(name);
  };
  const point = (to) => {
    const items = found.children;
    if (items.length === 0) return;
    if (at >= 0) mark(items[at], "aria-selected", "false");
    at = (to + items.length) % items.length;
    mark(items[at], "aria-selected", "true");
    mark(input, "aria-activedescendant", items[at].id);
    items[at].scrollIntoView({ block: "nearest" });
  };
  /** All words must occur, in any order: "knee left angle" finds sensors.joint_angle.left_knee_flexion. */
  const search = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fit = fields().filter(({ name }) => words.every((word) => name.toLowerCase().includes(word))).slice(0, MOST);
    found.replaceChildren(...fit.map(({ name, unit }) => {
      const item = h("li", { id: newId("option"), role: "option", "aria-selected": "false" }, name, h("span", { class: "unit" }, ` ${unitOf(unit)}`));
      item.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        take(name);
      });
      return item;
    }));
    at = -1;
    found.hidden = fit.length === 0;
    mark(input, "aria-expanded", String(fit.length > 0));
    if (words.length) point(0);
  };
  input.addEventListener("input", search);
  input.addEventListener("focus", search);
  input.addEventListener("blur", close);
  input.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown") point(at + 1);
    else if (event.key === "ArrowUp") point(at < 0 ? -1 : at - 1);
    else if (event.key === "Enter" && at >= 0) take(found.children[at].firstChild.textContent);
    else if (event.key === "Escape") close();
    else return;
    event.preventDefault();
  });
  return h("div", { class: "search" }, input, found);
}
