// node screenshot.mjs <folder with playwright-core> <page> <picture.png>: a report page down to the end of its
// first section, for the guide (scripts/pictures).
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch, openPage } from "./browser.mjs";

const [folder, file, picture] = process.argv.slice(2);
const browser = await launch(resolve(folder));
const { page, complaints } = await openPage(browser, pathToFileURL(file).href, { width: 1160, height: 1400 });
if (complaints.length > 0) throw new Error(complaints.join("\n"));
const { y, height } = await page.locator("section").first().boundingBox();
await page.screenshot({ path: picture, fullPage: true, clip: { x: 0, y: 0, width: 1160, height: y + height } });
await browser.close();
