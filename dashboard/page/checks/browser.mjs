// Browser of the checks: Debian's chromium, which draws by software.

import { chromium } from "playwright-core";

const PATHS = (process.env.CHROMIUM ?? "/usr/bin/chromium").split(":");

/** Chromium without a window. */
export const browser = () => chromium.launch({
  executablePath: PATHS[0],
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
