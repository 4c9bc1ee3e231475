// Scenes: what can be started here, and the run that was started.

import { Answer } from "../desk.js";
import { h, mark, newId, say } from "../dom.js";
import { fixed } from "../numbers.js";
import { topView } from "./top_view.js";

const FIRST = "demo";
const DEPTHS = [["1", "1 · joints follow their targets"], ["2", "2 · motors"], ["3", "3 · elastic gears"], ["4", "4 · pads of finite elements"], ["5", "5 · elastic gears and pads"]];
const INTEGRATORS = ["euler", "rk4", "semi_implicit", "bdf"].map((word) => [word, word]);

/** State of the run in words. */
const STATES = {
  none: () => "No robot runs here.",
  starting: (scene) => `${scene} is starting.`,
  running: (scene) => `${scene} runs.`,
  stopping: (scene) => `${scene} is ending: the robot comes to a stand first.`,
  elsewhere: () => "A robot runs here that was started elsewhere. End it where it was started.",
};

/** Panel of scenes; it stays empty at a server that starts none. */
export class Scenes {
  #scenes = new Map();
  #state = h("p", { class: "run-state", role: "status" });
  #why = h("pre", { class: "run-why", tabindex: 0, role: "region", "aria-label": "Last words of the run before", hidden: true });
  #list = h("select", { id: newId("scene"), class: "scene-list", size: 12 });
  #about = h("p");
  #facts = h("p", { class: "hint" });
  #view = h("div");
  #depth = choice("Depth", DEPTHS);
  #integrator = choice("Integrator", INTEGRATORS);
  #start = h("button", { type: "submit" }, "Start");

  constructor(desk, hub) {
    const [started, ended] = [new Answer("Answer to the start"), new Answer("Answer to the end")];
    const form = h("form", { class: "card", "aria-label": "Start a scene" },
      h("h2", {}, h("label", { for: this.#list.id }, "Scenes")), this.#list, this.#about, this.#view, this.#facts,
      h("div", { class: "fields halves" }, this.#depth.element, this.#integrator.element),
      h("div", { class: "row" }, this.#start, started.element));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const depth = this.#depth.select.value;
      desk.start({ scene: this.#list.value, depth: depth ? Number(depth) : null, integrator: this.#integrator.select.value || null }, started);
    });
    this.element = h("div", { class: "stack" },
      h("section", { class: "card", "aria-label": "Run" },
        h("div", { class: "card-head" }, this.#state, h("button", { type: "button", class: "halt", onclick: () => desk.end(ended) }, "Stop")),
        this.#why, ended.element),
      form);
    this.#list.addEventListener("change", () => this.#show());
    hub.on("scenes", ({ list }) => this.#take(list));
    hub.on("run", ({ state, scene, why }) => {
      say(this.#state, STATES[state](scene));
      mark(this.#state, "data-state", state);
      say(this.#why, why);
      this.#why.hidden = why === "";
    });
  }

  /** Scenes of the configuration; the one that was chosen stays so. */
  #take(list) {
    const chosen = this.#list.value;
    this.#scenes = new Map(list.map((scene) => [scene.name, scene]));
    this.#list.replaceChildren(...list.map(({ name, about, problem }) => h("option", { value: name }, `${name} · ${about ?? problem}`)));
    this.#list.value = [chosen, FIRST, list[0]?.name].find((name) => this.#scenes.has(name)) ?? "";
    this.#show();
  }

  /** What the chosen scene is about; one with a problem cannot be started. */
  #show() {
    const scene = this.#scenes.get(this.#list.value);
    const fine = scene !== undefined && scene.problem === undefined;
    const model = fine && scene.depth === null ? "depth chosen by its tolerance" : fine ? `type ${scene.depth}, ${scene.integrator}` : "";
    say(this.#about, scene?.about ?? scene?.problem ?? "The configuration has no scenes.");
    say(this.#facts, fine ? `${scene.robot} · ${fixed(scene.duration, 0)} s, then until Stop · ${model}` : "");
    this.#view.replaceChildren(...(fine ? [topView(scene.view)] : []));
    this.#start.disabled = !fine;
  }
}

/** Choice in place of what the scene says, all of it in view: a list that opens would keep the space bar. {element, select}. */
function choice(label, options) {
  const id = newId("choice");
  const select = h("select", { id, size: options.length + 1 }, h("option", { value: "", selected: true }, "the scene's"), options.map(([value, text]) => h("option", { value }, text)));
  return { element: h("div", { class: "field" }, h("label", { for: id }, label), select), select };
}
