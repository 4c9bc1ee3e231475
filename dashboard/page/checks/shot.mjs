// Picture of the page: node shot.mjs URL FILE [WIDTHxHEIGHT] [dark|light] [SECONDS] [TAB]
import { browser } from "./browser.mjs";
const [url, file, size = "1280x720", scheme = "dark", seconds = "4", tab] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const chromium = await browser();
const page = await (await chromium.newContext({ viewport: { width, height }, colorScheme: scheme })).newPage();
page.on("console", (m) => console.log(m.type(), m.text()));
page.on("pageerror", (e) => console.log("error", e.message));
await page.goto(url);
if (tab) await page.getByRole("tab", { name: tab }).click();
await page.waitForTimeout(1000 * Number(seconds));
await page.screenshot({ path: file });
console.log(await page.evaluate(() => JSON.stringify(window.gangwerk?.view.measure)));
await chromium.close();
