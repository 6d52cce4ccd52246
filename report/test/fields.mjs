// Uses the picture of the fields as a reader would.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { colours } from "./browser.mjs";

/** Does something and expects the picture of `selector` to change. */
export async function changes(page, selector, what, action) {
  const picture = () => page.locator(selector).screenshot();
  const before = await picture();
  await action();
  for (let trial = 0; trial < 40; ++trial) {
    await page.waitForTimeout(50);
    if (!before.equals(await picture())) return;
  }
  assert.fail(`${what}: nothing changes`);
}

export async function slide(page, id, value) {
  await page.locator(id).evaluate((input, x) => { input.value = x; input.dispatchEvent(new Event("input")); }, value);
}

export async function useFields(page, dimension) {
  const view = ".view-frame";
  await page.mouse.move(0, 0);
  await page.locator("#fields").scrollIntoViewIfNeeded();
  assert(await colours(page, ".view canvas") > 60, "the picture is blank");
  const options = await page.locator("#field option").evaluateAll((list) => list.map(({ value }) => value));
  for (const wanted of ["u", "ux", "von_mises", "s1", "s3", "sxx", "sxy", "eta-tot", "eta-str", ...(dimension === 3 ? ["contact-pressure", "contact-status"] : [])])
    assert(options.includes(wanted), `no field ${wanted}`);
  for (const field of ["ux", "s1", "eta-tot", ...(dimension === 3 ? ["contact-pressure", "contact-status"] : []), "u"])
    await changes(page, "#fields .view-row", `field ${field}`, () => page.selectOption("#field", field));
  await changes(page, view, "displacement", () => slide(page, "#factor", 90));
  await changes(page, view, "mesh", () => page.locator("#mesh").click());
  await changes(page, view, "level", () => slide(page, "#level", 0));
  await slide(page, "#level", 99);
  await changes(page, view, "wheel with Ctrl", async () => {
    await page.locator(".view").hover();
    await page.keyboard.down("Control");
    await page.mouse.wheel(0, -300);
    await page.keyboard.up("Control");
  });
  await changes(page, view, "dragging", async () => {
    const box = await page.locator(".view").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 30, { steps: 3 });
    await page.mouse.up();
  });
  await changes(page, view, "a key", async () => { await page.locator(".view").focus(); await page.keyboard.press("ArrowLeft"); });
  await changes(page, view, "whole body", () => page.getByRole("button", { name: "Reset view" }).click());
  await useTooltip(page);
  await useRange(page);
  if (dimension === 3) await useCut(page);
}

/** It tells what is under the pointer also when the picture moves below it. */
async function useTooltip(page) {
  const tooltip = page.locator(".view-frame .tooltip");
  await page.locator(".view").hover();
  await tooltip.waitFor({ state: "visible" });
  const before = await tooltip.textContent();
  assert.match(before, /x = .*, y = /);
  await page.locator(".view").focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(300);
  assert(await tooltip.isHidden() || await tooltip.textContent() !== before, "the tooltip tells of what was there before");
  await page.getByRole("button", { name: "Reset view" }).click();
}

async function useRange(page) {
  const [low, high] = [page.locator("#range-low"), page.locator("#range-high")];
  const usual = await high.inputValue();
  await changes(page, "#fields .view-row", "colours to a tenth", async () => { await high.fill(String(Number(usual) / 10)); await high.press("Enter"); });
  assert((await page.locator("#fields .view-legend .note").first().textContent()).includes("largest value"));
  await changes(page, "#fields .view-row", "usual colours", () => page.getByRole("button", { name: "Auto" }).click());
  assert.equal(await high.inputValue(), usual);
  await high.fill(String(Number(await low.inputValue()) - 1)); // no range: the usual one stays
  await high.press("Enter");
  assert.equal(await high.inputValue(), usual);
}

async function useCut(page) {
  await page.selectOption("#field", "sxx");
  await changes(page, ".view-frame", "cut plane", () => page.selectOption("#cut-axis", "0"));
  assert.match(await page.locator(".fields > .note").first().textContent(), /On the section/);
  await changes(page, ".view-frame", "moving the plane", () => slide(page, "#cut-place", 80));
  await changes(page, ".view-frame", "no plane", () => page.selectOption("#cut-axis", ""));
  if (await page.locator("#obstacle").count() > 0) await changes(page, ".view-frame", "obstacle", async () => { await page.selectOption("#field", "contact-gap"); await page.locator("#obstacle").click(); });
}

/** Bodies are moved apart and hidden; contact values are on both sides of what they touch with. */
export async function useBodies(page, dimension) {
  const view = ".view-frame";
  await page.locator("#fields").scrollIntoViewIfNeeded();
  await page.selectOption("#field", "body");
  assert.match(await page.locator("#fields .view-legend").innerText(), /bodies\s+(upper\s+lower|lower\s+upper)/);
  await changes(page, view, "drawing apart", () => slide(page, "#explosion", 80));
  assert.match(await page.locator(".fields > .note").first().textContent(), /Bodies are drawn apart/);
  await changes(page, view, "hiding a body", () => page.locator("#body-0").click());
  await changes(page, view, "showing it", async () => { await page.locator("#body-0").focus(); await page.keyboard.press("Space"); });
  await slide(page, "#explosion", 0);
  if (dimension === 2) return;
  await changes(page, view, "contact values", () => page.selectOption("#field", "contact-pressure"));
  assert.equal(await page.locator("#explosion").inputValue(), "50"); // otherwise nothing is seen of them
  assert.match((await saved(page, "#fields", "CSV")).toString(), /^x,y,z,contact-pressure\n/);
}

/** Plan views of what touches: other values, states, and what the pointer and keys are told. */
export async function usePlans(page) {
  const plan = "#contact .plan";
  assert(await colours(page, plan) > 60, "the plan is blank");
  await changes(page, "#contact", "another quantity", () => page.selectOption("#contact-quantity", "gap"));
  await page.selectOption("#contact-quantity", "pressure");
  await changes(page, "#contact", "states", () => page.locator("#contact-status").click());
  await page.locator("#contact-status").click();
  const tooltip = page.locator("#contact .tooltip").first();
  await page.locator(plan).first().hover();
  assert.match(await tooltip.textContent(), /^contact pressure \S+( MPa)?, (stick|slip|open|tied)x = .*, y = .*, z = /);
  await page.mouse.move(0, 0);
  await page.locator(plan).first().focus();
  await page.keyboard.press("ArrowLeft");
  assert(await tooltip.isVisible(), "keys do not read values");
  const before = await tooltip.textContent();
  await page.keyboard.press("ArrowLeft");
  assert.notEqual(await tooltip.textContent(), before);
  await page.keyboard.press("Escape");
  assert(await tooltip.isHidden());
  assert.match((await saved(page, "#contact", "CSV")).toString(), /^triangle,x,y,z,pressure,friction,limit,gap,slip,status\n/);
}

/** What the button `kind` below `place` saves. */
export async function saved(page, place, kind) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator(place).getByRole("button", { name: kind, exact: true }).first().click()]);
  return readFileSync(await download.path());
}

