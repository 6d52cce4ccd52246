// Chromium as the tests use it.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";

const places = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/** The browser's program, or undefined. */
export const browserPath = places.find((path) => path && existsSync(path));

/**
 * The browser without a sandbox, which root cannot have, and with WebGL by software, as there need not be a graphics card; all but
 * WebGL is drawn without it, which makes a screenshot take a fifth of the time. `folder` is that in which playwright-core is
 * installed. `webgl: false`: without any, as on remote desktops.
 */
export async function launch(folder, { webgl = true } = {}) {
  const { chromium } = createRequire(`${folder}/package.json`)("playwright-core");
  const graphics = webgl ? ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing",
    "--disable-gpu-rasterization", "--disable-gpu-watchdog"] : ["--disable-gpu", "--disable-3d-apis"];
  return chromium.launch({ executablePath: browserPath, headless: true, args: ["--no-sandbox", "--disable-dev-shm-usage", ...graphics] });
}

// What the software renderer says of its own speed is no fault of the page.
const isOfTheRenderer = (text) => /GPU stall|SwiftShader|software WebGL/i.test(text);

/** A page on which whatever is wrong is collected in `complaints`: exceptions, messages on the console, requests. */
export async function openPage(browser, url, { width = 1240, height = 900, colorScheme = "light", hasTouch = false } = {}) {
  const page = await browser.newPage({ viewport: { width, height }, colorScheme, hasTouch });
  page.setDefaultTimeout(120000); // WebGL by software takes its time on a busy machine
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !isOfTheRenderer(message.text()))
      complaints.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => complaints.push(`exception: ${error.message}`));
  page.on("dialog", (dialog) => { complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url()) && request.url() !== url) complaints.push(`request: ${request.url()}`);
  });
  const begin = performance.now();
  await page.goto(url);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "true", null, { timeout: 120000 });
  return { page, complaints, seconds: (performance.now() - begin) / 1000 };
}

/** How many different colours an element shows. */
export async function colours(page, selector) {
  const image = (await page.locator(selector).first().screenshot()).toString("base64");
  return page.evaluate(async (data) => {
    const picture = new Image();
    picture.src = `data:image/png;base64,${data}`;
    await picture.decode();
    const canvas = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
    canvas.drawImage(picture, 0, 0);
    const pixels = new Uint32Array(canvas.getImageData(0, 0, picture.width, picture.height).data.buffer);
    return new Set(pixels).size;
  }, image);
}
