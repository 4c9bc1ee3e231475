// The page: joins link, view and panels.

import "./style.css";
import { Desk } from "./desk.js";
import { h, say } from "./dom.js";
import { state } from "./frames.js";
import { watchHalts } from "./halt.js";
import { Hub } from "./hub.js";
import { Layout } from "./layout.js";
import { Link } from "./link.js";
import { Commands } from "./panels/commands.js";
import { Events } from "./panels/events.js";
import { Header } from "./panels/header.js";
import { Joystick } from "./panels/joystick.js";
import { leaseControl } from "./panels/lease.js";
import { Machine } from "./panels/machine.js";
import { Push } from "./panels/push.js";
import { Scenes } from "./panels/scenes.js";
import { StartUp } from "./panels/startup.js";
import { emergencyStop } from "./panels/stop.js";
import { Tune } from "./panels/tune.js";
import { Walk } from "./panels/walk.js";
import { Plots } from "./plot/plots.js";
import { readAddress } from "./replay/address.js";
import { Replay } from "./replay/replay.js";
import { Tabs } from "./tabs.js";
import { Hud } from "./view/hud.js";
import { View } from "./view/view.js";

const REFRESH_MS = 120; // of texts; pictures go with the screen

const hub = new Hub();
// Description of the robot asked for before it is needed: it comes while the page is built.
let description = fetch("/robot.urdf");
description.catch(() => {});
const link = new Link(hub, `ws://${location.host}/socket?token=${encodeURIComponent(readAddress(location.hash).token)}`);
const desk = new Desk(link, hub);
const stop = emergencyStop(desk);
const header = new Header(hub, stop.button, leaseControl(desk, hub));
// First of all: whatever else of the page cannot begin, she can be stopped.
document.body.append(header.element);
link.start();
watchHalts(desk, hub);

const push = new Push(desk, hub);
const walk = new Walk(desk, hub);
const startUp = new StartUp(desk, hub, walk);
walk.element.append(new Joystick(hub, walk, { emergencyStop: stop.stop, next: () => startUp.next() }).element);
const tune = new Tune(desk, hub);
const plots = new Plots(link, hub);
const machine = new Machine(hub);
const events = new Events(hub, () => tabs?.news("events"));

const canvas = h("canvas", { tabindex: 0, role: "application", "aria-label": "Robot in three dimensions: arrow keys turn the camera, plus and minus zoom" });
const stage = h("section", { class: "stage", "aria-label": "Robot" }, canvas);
const replay = new Replay(link, hub, canvas);
const view = new View(canvas, {
  canPush: () => !replay.on && push.possible,
  built: (...made) => replay.built(...made),
  posed: () => replay.posed(),
  drawn: (force, event, leftwards) => hud.draw(push.words(force), event, leftwards),
  ended: () => hud.drawn(),
  pushed: (force) => push.send(force),
  failed: (why) => stage.append(h("p", { class: "no-view" }, why)),
});
const hud = new Hud(view, hub);
const trouble = h("div", { class: "trouble", role: "alert", hidden: true });

stage.append(hud.element, h("div", { class: "notes" }, stop.answer, trouble));

let tabs = null;
tabs = new Tabs([
  ["scenes", new Scenes(desk, hub).element, "Scenes", true],
  ["steer", h("div", { class: "stack" }, startUp.element, walk.element, push.element, new Commands(desk, hub).element), "Steer"],
  ["tune", tune.element, "Tune"],
  ["plot", plots.element, "Plot"],
  ["machine", h("div", { class: "stack" }, machine.element, h("p", { class: "hint" }, h("a", { href: "/licenses.txt" }, "Licences of this page"))), "Machine"],
  ["events", events.element, "Events"],
]);
// A server that starts runs says so. Where none is there yet, they come first.
hub.on("scenes", () => tabs.reveal("scenes") && !hub.last("link")?.robot && tabs.open("scenes"));
document.body.append(h("main", {}, stage, tabs.element));

/** URDF of the robot that runs, or null; the answer that was asked for first serves once. */
async function describe() {
  const first = description;
  description = null;
  let answer = await first?.catch(() => null);
  if (!answer?.ok) answer = await fetch("/robot.urdf");
  return answer.ok ? answer.text() : null;
}

let run;
// The same run after a loss of connection keeps its scene; another one gets its own.
hub.on("hello", async (hello) => {
  const layout = new Layout(hello.state);
  hub.say("layout", layout);
  replay.begin(hello, { view, plots, header, stop });
  if (run === hello.run && view.bodies) return;
  const urdf = await describe();
  if (urdf === null || hub.last("hello") !== hello) return;
  view.build(hello, urdf, layout);
  run = hello.run;
});

let texts = 0;
function refresh(now) {
  requestAnimationFrame(refresh);
  link.pulse();
  replay.refresh(now);
  plots.refresh(now);
  if (now - texts < REFRESH_MS) return;
  texts = now;
  header.refresh();
  say(trouble, header.trouble);
  trouble.hidden = header.trouble === "";
  hud.refresh(state.values);
  if (tabs.current === "steer") startUp.refresh();
  if (tabs.current === "machine") machine.refresh();
}
requestAnimationFrame(refresh);

// For checks and for who measures: the view, the state that it draws, and what came in.
window.gangwerk = { view, state, hub, replay };
