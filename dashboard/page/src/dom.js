// Elements of the page: one call makes one, with attributes, listeners and children.

/**
 * Element `tag`. A key of `attributes` that begins with "on" is a listener, "class" and the rest are attributes;
 * false and undefined leave an attribute out, true sets an empty one.
 */
export const h = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);

/** The same for elements of a drawing. */
export const svg = (tag, attributes, ...children) => fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

function fill(element, attributes = {}, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value === false || value === undefined || value === null) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((c) => c !== null && c !== undefined && c !== false));
  return element;
}

/** Text of `element`, written only when it differs: a text node that stays costs no layout. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Attribute of `element`, written only when it differs. */
export function mark(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

let ids = 0;

/** Id that no other element has: labels and descriptions refer to it. */
export const newId = (stem) => `${stem}-${++ids}`;

/** Switch: a button that says whether it is on; the Enter key turns it, the space bar belongs to the emergency stop. */
export function toggle(text, on, changed, attributes = {}) {
  const button = h("button", { type: "button", class: "toggle", "aria-pressed": String(on), ...attributes }, text);
  button.addEventListener("click", () => {
    const now = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(now));
    changed(now);
  });
  return button;
}
