// Robots and servers of one file of checks, in a folder of their own.

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { binary } from "./harness.mjs";

const root = path.join(import.meta.dirname, "../../..");

export class Processes {
  folder = mkdtempSync("/dev/shm/gangwerk-page-");
  children = [];

  /** Run directory of the robot. */
  get run() {
    return path.join(this.folder, "run");
  }

  /** Starts the command; resolves with the first of its lines that fits. */
  start(fits, ...args) {
    const child = spawn(binary(), args, { cwd: root, stdio: ["ignore", "pipe", "pipe"] });
    this.children.push(child);
    return new Promise((resolve, reject) => {
      let text = "";
      const take = (data) => {
        text += data;
        const line = text.split("\n").find((l) => fits.test(l));
        if (line) resolve({ child, line });
      };
      child.stdout.on("data", take);
      child.stderr.on("data", take);
      child.on("exit", (code) => reject(new Error(`${args.join(" ")} ended with ${code}: ${text}`)));
    });
  }

  /** Path of a scene of ten minutes: a shipped one with other commands. */
  scene(name, shipped, commands = "") {
    const text = readFileSync(path.join(root, `config/scenes/${shipped}.toml`), "utf8");
    const file = path.join(this.folder, `${name}.toml`);
    writeFileSync(file, text.slice(0, text.indexOf("[[command]]")).replace(/duration = .*/, "duration = 600.0") + commands);
    return file;
  }

  /** Asks one of them to end, as Ctrl-C does, and waits for it. */
  async interrupt(child) {
    child.removeAllListeners("exit");
    const ended = new Promise((resolve) => child.once("exit", resolve));
    child.kill("SIGINT");
    const again = setTimeout(() => child.kill("SIGINT"), 4000);
    await ended;
    clearTimeout(again);
  }

  /** Ends all of them, and removes the folder. */
  async end() {
    for (const child of this.children) {
      child.removeAllListeners("exit");
      if (child.exitCode !== null || child.signalCode !== null) continue;
      child.kill("SIGTERM");
      await new Promise((resolve) => {
        const hard = setTimeout(() => child.kill("SIGKILL"), 8000);
        child.once("exit", () => { clearTimeout(hard); resolve(); });
      });
    }
    rmSync(this.folder, { recursive: true, force: true });
  }
}
