// Bundle of the page: src/ to dist/, the same bytes for the same sources and package-lock.json.
import { build } from "esbuild";
import { copyFile, mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import path from "node:path";

const here = import.meta.dirname;
const out = process.argv[2] ? path.resolve(process.argv[2]) : path.join(here, "dist");

/** Collada reader left out: it is a third of three's loaders, and robots here have primitives or STL. */
const withoutCollada = {
  name: "without-collada",
  setup(b) {
    b.onResolve({ filter: /ColladaLoader/ }, () => ({ path: "collada", namespace: "absent" }));
    b.onLoad({ filter: /.*/, namespace: "absent" }, () => ({
      contents: "export class ColladaLoader { load(_url, _done, _progress, failed) { failed(new Error('no Collada meshes: use STL')); } }",
    }));
  },
};

/** Copyright notices of packages under Apache-2.0 that come without a licence file. */
const NOTICES = { "urdf-loader": "Copyright 2019 California Institute of Technology" };

/** Licence texts of what is bundled: the page's own and those of its dependencies, by the names of their folders. */
async function licences(inputs) {
  const packages = new Set();
  for (const file of inputs) {
    const found = file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/);
    if (found) packages.add(found[1]);
  }
  let text = "The page of Gangwerk's dashboard is licensed under MIT OR Apache-2.0, as all of Gangwerk. It contains:\n";
  for (const name of [...packages].sort()) {
    const folder = path.join(here, "node_modules", name);
    const about = JSON.parse(await readFile(path.join(folder, "package.json"), "utf8"));
    const file = (await readdir(folder)).find((f) => /^licen[cs]e/i.test(f));
    // urdf-loader's package has no licence file: its notice with the licence that it names, which is one of ours.
    if (!file && !NOTICES[name]) throw new Error(`${name}: no licence file in ${folder}; add its notice to NOTICES in build.mjs`);
    const licence = file
      ? await readFile(path.join(folder, file), "utf8")
      : `${NOTICES[name]}\n\n${await readFile(path.join(here, "../../LICENSE-APACHE"), "utf8")}`;
    text += `\n${"=".repeat(78)}\n${name} ${about.version} (${about.license})\n${"=".repeat(78)}\n\n${licence.trim()}\n`;
  }
  return text;
}

await rm(out, { recursive: true, force: true });
await mkdir(out, { recursive: true });
const result = await build({
  absWorkingDir: here,
  entryPoints: { app: "src/main.js" },
  outdir: out,
  bundle: true,
  minify: true,
  format: "esm",
  target: ["chrome109", "firefox115", "safari16"],
  legalComments: "none",
  charset: "utf8",
  metafile: true,
  logLevel: "warning",
  plugins: [withoutCollada],
});
await copyFile(path.join(here, "src/index.html"), path.join(out, "index.html"));
await writeFile(path.join(out, "LICENSES.txt"), await licences(Object.keys(result.metafile.inputs)));
if (process.env.META) await writeFile(process.env.META, JSON.stringify(result.metafile));
