// Judges the solution of a coarse run and uses the page of the judgement as a reader would.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { colours, openPage } from "./browser.mjs";
import { changes, saved, slide } from "./fields.mjs";

const titles = { judged: "Judged", wide: "Judged, within a wide interval" };

/** The directory of the judgement of what the program itself finds with degree 1 on the first mesh; with load steps, of all. */
export function judge(program, directory, text) {
  rmSync(directory, { recursive: true, force: true });
  mkdirSync(directory, { recursive: true });
  writeFileSync(`${directory}/case.toml`, text);
  const tribound = (...list) => spawnSync(program, [...list, "--quiet"], { cwd: directory, encoding: "utf8" });
  const theirs = tribound("run", "case.toml", "--set", "degree=1", "--set", "adapt.max_levels=0", "--set", 'output.directory="theirs"');
  assert([0, 3].includes(theirs.status), theirs.stderr);
  const solution = text.includes("[history]") ? ["theirs/series.pvd", "--steps"] : ["theirs/level_000.vtu"];
  const judged = tribound("judge", "case.toml", "--solution", ...solution);
  assert([0, 3].includes(judged.status), judged.stderr);
  return `${directory}/out/case/judge`;
}

/** A number as text of the page has it. */
const shown = (value, digits) => String(Number(value.toPrecision(digits)));

async function checkWords(page, directory, judgement) {
  assert.doesNotMatch(await page.locator("body").innerText(), /Infinity|NaN|undefined|null/);
  const verdict = await page.locator(".verdict:not(.warnings)").textContent();
  assert(verdict.includes(titles[judgement.status]), verdict);
  for (const end of judgement.displacement.relative) assert(verdict.includes(`${shown(100 * end, 4)}\u00a0%`), verdict);
  assert((await page.locator("#guarantee").textContent()).includes(judgement.guaranteed_for));
  assert((await page.locator("#read").textContent()).includes(judgement.solution.description));
  assert((await page.locator("#fields .beside").textContent()).includes(`${judgement.displacement.halving_cells} cells`));
  assert.equal(await page.locator("#forces tbody tr").count(), judgement.forces.length);
  assert(verdict.includes(`miss the loads by ${shown(100 * judgement.imbalance, 4)}\u00a0%`), verdict);
  const links = await page.locator("section a").evaluateAll((list) => list.map((a) => a.getAttribute("href")));
  for (const link of ["report.html", "judgement.json", "judged_cells.csv", "judged.vtu"]) assert(links.includes(link), `no link to ${link}`);
  for (const link of links) assert(existsSync(`${directory}/${link}`), `${link} does not exist`);
  const bars = (await saved(page, "#errors", "CSV")).toString().trim().split("\n").slice(1).map((line) => line.split(",").map(Number));
  assert.deepEqual(bars[0].slice(1), judgement.displacement.relative.map((end) => 100 * end));
}

/** Three pictures with one camera, two of them with one scale. */
async function usePictures(page, judgement) {
  await page.mouse.move(0, 0);
  await page.locator("#fields").scrollIntoViewIfNeeded();
  for (let i = 0; i < 3; ++i) assert(await colours(page, `#fields canvas >> nth=${i}`) > 60, `picture ${i} is blank`);
  const frames = [0, 1, 2].map((i) => `.view-frame >> nth=${i}`);
  await changes(page, frames[1], "another field", () => page.selectOption("#field", "u"));
  await changes(page, frames[2], "distances", () => page.selectOption("#cell-field", "distance"));
  await changes(page, frames[0], "deformation", () => slide(page, "#factor", 80));
  await changes(page, frames[2], "mesh", () => page.locator("#mesh").click());
  await changes(page, frames[1], "moving the other picture", async () => {
    await page.locator(".view").first().focus();
    await page.keyboard.press("ArrowLeft");
  });
  await changes(page, frames[0], "whole body", () => page.getByRole("button", { name: "Reset view" }).click());
  await page.locator(".view").nth(1).hover();
  await page.locator(".view-frame .tooltip").nth(1).waitFor({ state: "visible" });
  await page.mouse.move(0, 0);
  const rows = (await saved(page, "#fields", "CSV")).toString().split("\n");
  assert.equal(rows[0], `${judgement.d === 2 ? "x,y" : "x,y,z"},"u, theirs","u, ours"`);
  const difference = rows.slice(1).map((row) => row.split(",").slice(-2).map(Number)).map(([a, b]) => Math.abs(a - b));
  assert(Math.max(...difference) > 0);
}

/** The same page with a judgement without a bound. */
async function checkWithoutBound(browser, directory) {
  const html = readFileSync(`${directory}/judgement.html`, "utf8");
  const [, text] = html.match(/id="judgement-data">(.*?)<\/script>/s);
  const data = JSON.parse(text);
  Object.assign(data, { surfaces: null, judgement: { ...data.judgement, status: "no bound", reason: "there is a joint", guaranteed_for: null,
    displacement: null, stress: null, rigid_difference: [], factor: null, doubt: null } });
  writeFileSync(`${directory}/without.html`, html.replace(text, () => JSON.stringify(data).replaceAll("<", "\\u003c")));
  const { page, complaints } = await openPage(browser, pathToFileURL(`${directory}/without.html`).href);
  assert.match(await page.locator(".verdict").textContent(), /Not judged.*there is a joint\./);
  assert.equal(await page.locator("#fields, #errors, #guarantee").count(), 0);
  assert.deepEqual(complaints, []);
  await page.close();
}

/** `picture`: without its ending. */
export async function useJudgement(browser, directory, picture) {
  const judgement = JSON.parse(readFileSync(`${directory}/judgement.json`, "utf8"));
  const { page, complaints, seconds } = await openPage(browser, pathToFileURL(`${directory}/judgement.html`).href);
  await page.screenshot({ path: `${picture}.png`, fullPage: true });
  await checkWords(page, directory, judgement);
  await usePictures(page, judgement);
  await page.pdf({ path: `${picture}.pdf`, format: "A4", printBackground: true });
  assert.equal(await page.locator("svg.print-only image").count(), 3);
  await checkWithoutBound(browser, directory);
  assert.deepEqual(complaints, []);
  await page.close();
  return seconds;
}

/** The page of several load steps: all of them in a table, and the worst as a single one. */
export async function useJudgedSteps(browser, directory, picture) {
  const { steps, worst, status } = JSON.parse(readFileSync(`${directory}/judgement.json`, "utf8"));
  const { page, complaints, seconds } = await openPage(browser, pathToFileURL(`${directory}/judgement.html`).href);
  await page.screenshot({ path: `${picture}.png`, fullPage: true });
  const verdict = await page.locator(".verdict:not(.warnings)").textContent();
  assert(verdict.includes(titles[status]), verdict);
  assert(verdict.includes(`${steps.length} load steps were judged. Step ${worst}, at t = ${steps[worst - 1].t}`), verdict);
  const rows = await page.locator("#steps tbody tr").allTextContents();
  assert.equal(rows.length, steps.length);
  rows.forEach((row, i) => {
    for (const end of steps[i].displacement.relative) assert(row.includes(`${shown(100 * end, 4)}\u00a0%`), row);
  });
  assert((await page.locator("#read").textContent()).includes(steps[worst - 1].solution.description));
  for (let i = 0; i < 3; ++i) assert(await colours(page, `#fields canvas >> nth=${i}`) > 60, `picture ${i} is blank`);
  assert.deepEqual(complaints, []);
  await page.close();
  return seconds;
}
