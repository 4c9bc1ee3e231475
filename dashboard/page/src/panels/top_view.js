// Top view of a scene: the way that its commands ask for, objects, pushes. Forward is to the right, to the left is up.

import { svg } from "../dom.js";
import { fixed } from "../numbers.js";

/** Least extent of what is shown, and length of a push's arrow [m]. */
const EXTENT = 2;
const ARROW = 0.5;
/** Lengths of the scale [m]. */
const SCALES = [0.5, 1, 2, 5, 10, 20, 50, 100];

/** Picture of `{way, objects, pushes}`, as the message "scenes" has them. */
export function topView({ way, objects, pushes }) {
  const arrows = pushes.map(([x, y, fx, fy]) => {
    const force = Math.hypot(fx, fy) || 1;
    return [[x - (ARROW * fx) / force, y - (ARROW * fy) / force], [x, y]];
  });
  const points = [...way, ...objects.flat(), ...arrows.flat()];
  const [left, right] = span(points.map(([x]) => x), EXTENT);
  const [low, high] = span(points.map(([, y]) => y), Math.max(EXTENT, right - left) / 4);
  const margin = (right - left) / 20;
  const scale = SCALES.findLast((length) => length <= (right - left) / 4) ?? SCALES[0];
  const flat = (list) => list.map(([x, y]) => `${x},${-y}`).join(" ");
  const bar = -low + margin;
  return svg("svg", { class: "top-view", role: "img", "aria-label": words(way, objects, pushes),
    viewBox: [left - margin, -high - margin, right - left + 2 * margin, high - low + 4 * margin].join(" ") },
    objects.map(([[x0, y0], [x1, y1]]) => svg("rect", { class: "object", x: x0, y: -y1, width: x1 - x0, height: y1 - y0 })),
    svg("polyline", { class: "way", points: flat(way) }),
    svg("circle", { class: "start", cx: way[0][0], cy: -way[0][1], r: margin / 2 }),
    way.length > 1 && svg("circle", { class: "end", cx: way.at(-1)[0], cy: -way.at(-1)[1], r: margin / 2 }),
    arrows.map((line) => svg("polyline", { class: "push", points: flat(line) })),
    svg("polyline", { class: "scale", points: flat([[left, -bar], [left + scale, -bar]]) }),
    svg("text", { x: left + scale + margin / 2, y: bar, "font-size": 1.2 * margin, "dominant-baseline": "middle" }, `${scale} m`));
}

/** What is to be seen, for who does not. */
function words(way, objects, pushes) {
  const length = way.slice(1).reduce((sum, [x, y], i) => sum + Math.hypot(x - way[i][0], y - way[i][1]), 0);
  const parts = [length > 0 ? `a way of ${fixed(length, 1)} m` : "on the spot"];
  if (objects.length) parts.push(`objects: ${objects.length}`);
  if (pushes.length) parts.push(`pushes: ${pushes.length}`);
  return `Top view: ${parts.join(", ")}`;
}

/** Range of `values`, widened about its middle to `least`. */
function span(values, least) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const more = Math.max(0, least - (high - low)) / 2;
  return [low - more, high + more];
}
