// Changed parameters as a piece of a gait file (TOML).

/** Tables of a gait file in which the parameters of a process stand. */
const TABLE = { controller: "control", planner: "step" };
const COMPONENT = /^(.+)\.([xyz])$/;

/**
 * TOML of those of `parameters` ({name, value, default, unit}, in the order of the registry) that differ from what the gait
 * file has. Of a vector all components are written: the file knows no parts of one.
 */
export function gaitFile(parameters, about) {
  const changed = parameters.filter(({ value, default: usual }) => value !== usual);
  const tables = new Map();
  for (const parameter of changed) {
    const { process, key } = place(parameter.name);
    const table = TABLE[process];
    if (!table) continue;
    if (!tables.has(table)) tables.set(table, new Map());
    const all = parameters.filter(({ name }) => place(name).process === process && place(name).key === key);
    tables.get(table).set(key, all);
  }
  let text = `# ${about}\n`;
  for (const [table, keys] of tables) {
    text += `\n[${table}]\n`;
    for (const [key, all] of keys) {
      const vector = COMPONENT.test(all[0].name);
      const value = vector ? `[${all.map(({ value: v }) => number(v)).join(", ")}]` : number(all[0].value);
      const was = all.map(({ default: usual }) => number(usual)).join(", ");
      const unit = all[0].unit && all[0].unit !== "-" ? `[${all[0].unit}] ` : "";
      text += `${key} = ${value} # ${unit}was ${vector ? `[${was}]` : was}\n`;
    }
  }
  return text;
}

/** Process and key of a parameter: controller.force_gain.z stands in force_gain of the controller's table. */
function place(name) {
  const dot = name.indexOf(".");
  const rest = name.slice(dot + 1);
  return { process: name.slice(0, dot), key: rest.match(COMPONENT)?.[1] ?? rest };
}

/** Number as TOML has it: one with a point stays one. */
const number = (x) => (Number.isInteger(x) ? `${x}.0` : String(x));
