// Bench of the checks: the server (mock or real), a browser, pages that notice what goes wrong in them.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import path from "node:path";
import { browser } from "./browser.mjs";
import { Mock } from "./mock.mjs";

const root = path.join(import.meta.dirname, "../../..");

/** The command gangwerk: of GANGWERK, else the newest build of the tree. */
export function binary() {
  const found = [process.env.GANGWERK, ...["release", "debug"].map((p) => path.join(root, "target", p, "gangwerk"))].find((p) => p && existsSync(p));
  assert.ok(found, "no gangwerk to record a walk with: cargo build --release, or GANGWERK=PATH");
  return found;
}

/** One mock and one browser for all checks of a file. */
export class Bench {
  async open(scene) {
    this.mock = await new Mock(binary(), scene).listen();
    this.chromium = await browser();
    return this;
  }

  async close() {
    await this.chromium.close();
    await this.mock.close();
  }

  /** Page at the mock that walks; `options`: width, height, scheme, touch; `init` runs in it first. What it reports as an error fails the check at `done`. */
  async page({ width = 1280, height = 720, scheme = "dark", touch = false, url = this.mock.url, init } = {}) {
    const context = await this.context({ viewport: { width, height }, colorScheme: scheme, hasTouch: touch });
    const page = await context.newPage();
    if (init) await page.addInitScript(init);
    page.errors = [];
    page.foreign = [];
    page.on("pageerror", (error) => page.errors.push(error.message));
    page.on("console", (message) => message.type() === "error" && page.errors.push(message.text()));
    page.on("request", (request) => new URL(request.url()).host !== new URL(url).host && !/^(data|blob):/.test(request.url()) && page.foreign.push(request.url()));
    await page.goto(url);
    await this.drawn(page);
    page.done = async () => {
      await context.close();
      // A connection that was cut on purpose is reported by the browser and is no error of the page.
      const real = page.errors.filter((e) => !/WebSocket connection|ERR_CONNECTION|ERR_EMPTY_RESPONSE|404/.test(e));
      assert.deepEqual(real, [], "errors in the page");
      assert.deepEqual(page.foreign, [], "requests to other hosts");
    };
    return page;
  }

  /** Context of the browser that `clean` closes. */
  async context(options) {
    const context = await this.chromium.newContext(options);
    this.#contexts.push(context);
    return context;
  }

  #contexts = [];

  /** Leaves nothing of a check that failed: its pages would go on drawing, its lease would hold. Call it after each check. */
  async clean() {
    for (const context of this.#contexts.splice(0)) await context.close();
    this.mock.calm();
  }

  /** Waits for a picture of the robot. */
  drawn(page) {
    return page.waitForFunction(() => window.gangwerk?.view.bodies?.solid.root.visible && window.gangwerk.view.measure.frames > 2, null, { timeout: 20000 });
  }

  /** Messages of a kind that came since `from`. */
  sent(type, from = 0) {
    return this.mock.received.slice(from).filter((m) => m.type === type);
  }

  /** Waits until a message fits; the message. */
  async arrives(fits, from = 0, ms = 5000) {
    const end = performance.now() + ms;
    while (performance.now() < end) {
      const found = this.mock.received.slice(from).find(fits);
      if (found) return found;
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
    assert.fail(`no such message within ${ms} ms; there were: ${JSON.stringify(this.mock.received.slice(from).filter((m) => m.type !== "pulse"))}`);
  }
}

/** Share of the pixels of `clip` that differ between two pictures of a page by more than a little. */
export async function difference(page, first, second) {
  return page.evaluate(async ([a, b]) => {
    const pixels = async (png) => {
      const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    };
    const [x, y] = [await pixels(a), await pixels(b)];
    let differ = 0;
    for (let i = 0; i < x.length; i += 4) if (Math.abs(x[i] - y[i]) + Math.abs(x[i + 1] - y[i + 1]) + Math.abs(x[i + 2] - y[i + 2]) > 60) differ++;
    return differ / (x.length / 4);
  }, [first.toString("base64"), second.toString("base64")]);
}
