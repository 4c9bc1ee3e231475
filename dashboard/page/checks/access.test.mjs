// Everybody can use it: axe, keyboard alone, small screens.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, afterEach, before, test } from "node:test";
import { Bench } from "./harness.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const TABS = ["Scenes", "Steer", "Tune", "Plot", "Machine", "Events"];
const bench = new Bench();
before(async () => {
  await bench.open("walk_2kmh");
  bench.mock.setRun("elsewhere", "", "demo ended (exit status: 1)\nerror: a sentence that is longer than the panel is wide and says what was wrong and what to do");
});
after(() => bench.close());
afterEach(() => bench.clean());

/** Opens a tab and all that can be opened in it. */
async function open(page, tab) {
  await page.getByRole("tab", { name: tab }).click();
  await page.locator("[role=tabpanel]:not([hidden])").evaluate((panel) => panel.querySelectorAll("details").forEach((d) => { d.open = true; }));
  await page.waitForTimeout(300);
}

for (const scheme of ["dark", "light"]) {
  test(`axe finds nothing serious, ${scheme}`, async () => {
    const page = await bench.page({ scheme });
    for (const tab of TABS) {
      await open(page, tab);
      // By the debugger: the page's own policy runs no foreign script.
      await page.evaluate(axe);
      const { violations, passes } = await page.evaluate(() => window.axe.run(document));
      const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
      assert.deepEqual(serious.map(({ id, nodes }) => `${tab}: ${id}: ${nodes.map((n) => `${n.html.slice(0, 160)} ${n.any[0]?.message ?? ""}`).join(" | ")}`), []);
      assert.ok(passes.length > 15, `${passes.length} rules had something to look at`);
    }
    await page.done();
  });
}

test("the tabulator key reaches everything that a mouse can press", async () => {
  const page = await bench.page();
  for (const tab of TABS) {
    await open(page, tab);
    const all = await page.evaluate(() => {
      const shown = (e) => e.checkVisibility() && !e.disabled;
      const able = [...document.querySelectorAll("button, input, select, summary, a[href], [tabindex='0']")].filter(shown);
      // Of the tabs only the open one is a stop; the arrow keys lead to the others.
      const stops = able.filter((e) => e.tabIndex >= 0);
      stops.forEach((e, i) => { e.dataset.stop = String(i); });
      document.activeElement.blur();
      return { count: stops.length, out: able.filter((e) => e.tabIndex < 0 && e.getAttribute("role") !== "tab").length };
    });
    assert.equal(all.out, 0, `${tab}: elements out of the order`);
    const reached = new Set();
    let unseen = 0;
    for (let i = 0; i < all.count + 3; i++) {
      await page.keyboard.press("Tab");
      const { stop, ring } = await page.evaluate(() => {
        const e = document.activeElement;
        const style = getComputedStyle(e);
        return { stop: e.dataset.stop, ring: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1 };
      });
      if (stop !== undefined) {
        reached.add(stop);
        if (!ring) unseen++;
      }
    }
    assert.equal(reached.size, all.count, `${tab}: stops reached`);
    assert.equal(unseen, 0, `${tab}: focus that is not seen`);
  }
  await page.done();
});

test("arrow keys go from tab to tab, and turn the camera", async () => {
  const page = await bench.page();
  await page.getByRole("tab", { name: "Steer" }).focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Tune");
  await page.keyboard.press("End");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Events");
  await page.getByRole("button", { name: "Follow" }).click();
  const where = () => page.evaluate(() => window.gangwerk.view.eye());
  const before = await where();
  await page.getByRole("application").focus();
  for (let i = 0; i < 5; i++) await page.keyboard.press("ArrowLeft");
  const turned = await where();
  assert.ok(Math.hypot(...turned.map((v, i) => v - before[i])) > 0.5, `${before} ${turned}`);
  await page.keyboard.press("+");
  const near = await where();
  assert.ok(Math.hypot(...near) !== Math.hypot(...turned));
  await page.done();
});

for (const [width, height, touch] of [[1280, 720, false], [1024, 768, true]]) {
  test(`nothing runs over at ${width} x ${height}${touch ? ", touch" : ""}`, async () => {
    const page = await bench.page({ width, height, touch });
    bench.mock.stranger("a robot operator with a rather long name (pid 123456)");
    for (const tab of TABS) {
      await open(page, tab);
      const over = await page.evaluate(() => {
        const found = [];
        const root = document.documentElement;
        if (root.scrollWidth > innerWidth || root.scrollHeight > innerHeight) found.push(`page ${root.scrollWidth} x ${root.scrollHeight}`);
        for (const e of document.querySelectorAll("header *, .hud button, [role=tab], [role=tabpanel]:not([hidden]) *")) {
          if (!e.checkVisibility()) continue;
          const box = e.getBoundingClientRect();
          if (box.width && (box.left < -0.5 || box.right > innerWidth + 0.5) && !e.closest(".found, .u-wrap, .strip, .scroll")) found.push(`${e.tagName} ${e.className} ${e.textContent.slice(0, 30)} to ${box.right}`);
        }
        const panel = document.querySelector("[role=tabpanel]:not([hidden])");
        if (panel.scrollWidth > panel.clientWidth) found.push(`panel ${panel.scrollWidth} > ${panel.clientWidth}`);
        const stop = document.querySelector(".stop").getBoundingClientRect();
        const covered = document.elementFromPoint(stop.left + stop.width / 2, stop.top + stop.height / 2).closest(".stop");
        if (!covered) found.push("the emergency stop is covered");
        return found;
      });
      assert.deepEqual(over, [], tab);
    }
    if (touch) {
      // Fingers need 36 pixels at least.
      const small = await page.evaluate(() => [...document.querySelectorAll("header button, .steps button, .hud button")].filter((e) => e.checkVisibility() && e.getBoundingClientRect().height < 36).map((e) => e.textContent));
      if (await page.evaluate(() => matchMedia("(pointer: coarse)").matches)) assert.deepEqual(small, []);
    }
    await page.done();
  });
}
