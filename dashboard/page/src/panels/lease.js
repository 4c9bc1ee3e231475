// Command lease: who holds it, and buttons to take and to give it.

import { h, mark, say } from "../dom.js";
import { Answer } from "../desk.js";

/** Lease in the header. */
export function leaseControl(desk, hub) {
  const answer = new Answer("Answer about the lease");
  const who = h("span", { class: "lease-who" }, "nobody steers");
  const button = h("button", { type: "button", class: "quiet" }, "Take lease");
  let lease = { holder: "", mine: false };
  button.addEventListener("click", () => {
    desk.lease(lease.mine ? { give: true } : { take: true, over: lease.holder !== "" }, answer);
  });
  const show = () => {
    say(who, lease.mine ? "you steer" : lease.holder ? `${lease.holder} steers` : "nobody steers");
    who.title = "The command lease: one at a time moves the robot. Whoever lets it go while walking makes her stand.";
    mark(who, "data-mine", String(lease.mine));
    say(button, lease.mine ? "Give lease" : lease.holder ? "Take over" : "Take lease");
  };
  hub.on("lease", (message) => { lease = message; show(); });
  hub.on("connection", ({ state }) => {
    if (state === "open") return;
    lease = { holder: "", mine: false };
    show();
  });
  return h("div", { class: "lease", role: "group", "aria-label": "Command lease" }, who, button, answer.element);
}
