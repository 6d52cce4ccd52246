// Uses the page of a body of revolution as a reader would.
import assert from "node:assert/strict";
import { pathToFileURL } from "node:url";
import { colours, openPage } from "./browser.mjs";
import { changes, saved } from "./fields.mjs";

// A cylinder whose rounded face is pressed on a floor.
export const revolution = { exit: 0, text: `
title = "Cylinder on a floor"
model = "axisymmetric"
degree = 2
units = { length = "mm", force = "N" }
mesh = { box = { lower = [0, 0], upper = [1, 1], cells = [3, 3] } }
material = { E = 1000.0, nu = 0.3 }
[boundary.left]
displacement = [0, "free"]
[boundary.right]
traction = [0, 0]
[boundary.top]
pressure = 10
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.3, gap = "0.005*x^2" }
[probe.edge]
point = [1, 1]
[adapt]
tolerance = 0.05
` };

export async function useRevolution(browser, directory, picture) {
  const { page, complaints, seconds } = await openPage(browser, pathToFileURL(`${directory}/report.html`).href);
  assert.doesNotMatch(await page.locator("body").innerText(), /Infinity|NaN|undefined/);
  assert.match(await page.locator(".subtitle").textContent(), /axisymmetric, degree 2/);
  assert.match(await page.locator("#case").textContent(), /forces in N, of the full circle.*volume \[mm\u00b3\]/s);
  assert.match(await page.locator("#balance").textContent(), /force z \[N\]/);
  assert.doesNotMatch(await page.locator("#page").textContent(), /plane strain|moment \[/);
  assert.match(await page.locator("#contact").textContent(), /force z on the body \[N\]bottom\u221231\.4159.*31\.4159/);
  assert.match(await page.locator("#guarantee math[display=block]").textContent(), /vr\/r/);
  const fields = await page.locator("#field option").allTextContents();
  for (const name of ["displacement, r", "displacement, z", "\u03c3 rr", "\u03c3 zz", "\u03c3 \u03b8\u03b8", "\u03c3 rz"]) assert(fields.includes(name), name);
  assert.match(await page.locator("table.probes").textContent(), /u r.*u z.*stress rr.*stress zz.*stress \u03b8\u03b8.*stress rz/);
  const values = (await saved(page, "#fields", "CSV")).toString();
  assert.match(values, /^r,z,von_mises\n/);
  await page.selectOption("#field", "uz");
  for (const way of ["mirrored", "body"]) {
    await changes(page, "#fields", way, () => page.selectOption("#way", way));
    assert.equal(await page.locator("#field").inputValue(), "uz");
    await page.locator("#fields").scrollIntoViewIfNeeded();
    await page.mouse.move(0, 0);
    await page.locator(".view").hover();
    await page.locator(".view-frame .tooltip").waitFor({ state: "visible" });
    assert.match(await page.locator(".view-frame .tooltip").textContent(), /r = \d[^,]*, z = \d/); // r is never negative
    assert(await colours(page, ".view canvas") > 60, `the picture is blank: ${way}`);
    await page.screenshot({ path: `${picture}_${way}.png` });
  }
  assert.match(await page.locator(".fields > .note").first().textContent(), /three quarters/);
  await page.selectOption("#field", "von_mises");
  assert.equal((await saved(page, "#fields", "CSV")).toString(), values, "the same values in each way");
  await changes(page, "#fields", "meridian", () => page.selectOption("#way", "meridian"));
  assert.deepEqual(complaints, []);
  await page.close();
  return seconds;
}
