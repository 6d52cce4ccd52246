// node page_test.mjs <tribound> <folder with playwright-core> <directory for results>
//
// Runs cases, a study and a sweep, judges solutions, opens their reports from disk in Chromium and uses them as a reader would. Exit code 77: the browser, its
// driver or the page is missing.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { browserPath, colours, launch, openPage } from "./browser.mjs";
import { saved, useBodies, useFields, usePlans } from "./fields.mjs";
import { judge, useJudgedSteps, useJudgement } from "./judgement.mjs";
import { revolution, useRevolution } from "./revolution.mjs";

const [program, folder, results] = process.argv.slice(2);

function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}
if (!browserPath) skip("there is no chromium (Debian: chromium), or name it in CHROMIUM");
if (!existsSync(`${folder}/node_modules/playwright-core`)) skip("playwright-core is not installed");
if (!/report page +\//.test(spawnSync(program, ["info"], { encoding: "utf8" }).stdout)) skip("the report page is not built");

const title = `</script><img src=x onerror=alert(1)> "Bl\u00f6cke" & <b>\u4e2d\u6587</b>`;

// A block that is held on the left, pressed down and pulled to the right, on a floor with friction.
const pressedBlock = `material = { E = 1.0, nu = 0.3 }
[boundary.left]
displacement = [0, 0]
[boundary.top]
traction = [0, -0.1]
[boundary.right]
traction = [0.04, 0.06]
[boundary.bottom]
contact = { friction = "tresca", threshold = 0.03 }`;

const cases = {
  block: { exit: 0, status: "Certified", text: `
title = '${title}'
degree = 2
mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [8, 4] } }
${pressedBlock}
[[quantity]]
name = "thrust & <lift>"
kind = "contact_force"
boundary = "bottom"
direction = [0, 1]
[certify]
energy = "every"
[adapt]
tolerance = 0.04
` },
  cube: { exit: 3, status: "Budget used up", text: `
title = "Cube on a rough floor"
degree = 1
units = { length = "mm", force = "N" }
mesh = { box = { lower = [0, 0, 0], upper = [1, 1, 1], cells = [3, 3, 3] } }
material = { E = 1000.0, nu = 0.3 }
[boundary.top]
displacement = [0.0, -0.01, 0.004]
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.3, gap = "0.02*(x - 0.5)^2" }
[section.middle]
point = [0.5, 0.5, 0.5]
normal = [0, 1, 0]
[probe.edge]
from = [0, 1, 0]
to = [1, 1, 1]
points = 5
[adapt]
max_levels = 2
` },
  pair: { exit: 0, status: "Certified", bodies: true, text: `
degree = 2
[mesh]
boxes.lower = { lower = [0, -1], upper = [2, 0], cells = [3, 2] }
boxes.upper = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
[material]
E = 1.0
nu = 0.3
[boundary."upper.left"]
displacement = [0, 0]
[boundary."upper.top"]
traction = [0, -0.1]
[boundary."lower.bottom"]
displacement = [0, 0]
[[contact]]
slave = "upper.bottom"
master = "lower.top"
friction = "coulomb"
coefficient = 0.5
[probe."down & <across>"]
from = [1.3, 1]
to = [1.3, -1]
points = 9
[probe.corner]
point = [2, 1]
[section."the upper body"]
point = [1, 0.5]
normal = [1, 0]
within = "y"
[adapt]
tolerance = 0.1
` },
  pair3d: { exit: 3, status: "Budget used up", bodies: true, text: `
degree = 1
[mesh]
boxes.lower = { lower = [-0.3, -0.2, -1], upper = [2.3, 1.2, 0], cells = [5, 3, 2] }
boxes.upper = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [4, 2, 2] }
[material]
E = 1.0
nu = 0.3
[boundary."upper.front"]
displacement = [0.01, 0, "-0.02 - 0.01*x"]
[boundary."lower.back"]
displacement = [0, 0, 0]
[[contact]]
slave = "upper.back"
master = "lower.front"
friction = "coulomb"
coefficient = 0.5
[adapt]
max_levels = 1
` },
  stopped: { exit: 2, status: "Failed", text: `
degree = 1
mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] } }
material = { E = 1.0, nu = 0.3 }
[boundary.left]
displacement = [0, 0]
[boundary.top]
traction = [0, -0.1]
[boundary.bottom]
contact = { friction = "tresca", threshold = 0.03 }
[newton]
max_steps = 1
stopping = "tolerance"
` },
};

// A bond with water in it, peeled off from the right in load steps.
const joint = { exit: 0, text: `
title = "Joint"
degree = 1
units = { length = "m", force = "MN" }
mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [8, 4] } }
material = { E = 1.0, nu = 0.3 }
[boundary.left]
displacement = [0, 0]
[boundary.right]
traction = [0, 0]
[boundary.top]
displacement = ["free", "0.045*t*x"]
[boundary.bottom]
interface = { law = "joint", tensile_strength = 0.05, fracture_energy = 0.003, coefficient = 0.5, water = { pressure = "0.01*t" } }
[history]
steps = [0.5, 1, 1.5]
watch = { top = "top.y" }
[probe.crest]
point = [2, 1]
[section.across]
point = [1, 0.5]
normal = [1, 0]
[adapt]
max_levels = 0
tolerance = 0.9
` };

// The threshold of friction and the pull are varied; the block has a quantity with an error bar.
const sweep = { command: "sweep", arguments: ["s=0.02:0.04:3", "pull=[0.02, 0.04]"], exit: 0, text: `
title = "Block, varied"
degree = 1
units = { length = "m", force = "kN" }
mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] } }
${pressedBlock.replace("0.03", '"s"').replace("[0.04, 0.06]", '["pull", 0.06]')}
[parameters]
s = { value = 0.03, label = "limit of friction", unit = "kN/m" }
pull = 0.04
[[quantity]]
name = "grip"
kind = "contact_force"
boundary = "bottom"
direction = [1, 0]
[probe.corner]
point = [2, 1]
[section.across]
point = [1, 0.5]
normal = [1, 0]
[adapt]
tolerance = 0.3
[output]
vtu = false
` };

const study = { command: "study", exit: 0, text: `
title = "Block, studied"
degree = 1
units = { length = "m", force = "kN" }
mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] } }
${pressedBlock}
[adapt]
tolerance = 0.2
[study]
reference_factor = 0.5
max_reference_dofs = 5_000
dual_norm_dofs = 5_000
figures = false
` };

function solve(name, { command = "run", arguments: more = [], text, exit }) {
  const directory = `${results}/${name}`;
  rmSync(directory, { recursive: true, force: true });
  mkdirSync(directory, { recursive: true });
  writeFileSync(`${directory}/case.toml`, text);
  const { status, stderr } = spawnSync(program, [command, "case.toml", ...(more.length > 0 ? more : ["--quiet"])], { cwd: directory, encoding: "utf8" });
  assert.equal(status, exit, stderr);
  return `${directory}/out/case`;
}

async function checkLinks(page, directory) {
  const links = await page.locator("section a").evaluateAll((list) => list.map((a) => a.getAttribute("href")));
  for (const link of links) assert(existsSync(`${directory}/${link}`), `${link} does not exist`);
  return links;
}

async function checkCertificate(page, directory, status) {
  const certificate = JSON.parse(readFileSync(`${directory}/certificate.json`, "utf8"));
  assert.doesNotMatch(await page.locator("body").innerText(), /Infinity|NaN|undefined/);
  const verdict = await page.locator(".verdict:not(.warnings)").textContent();
  assert(verdict.includes(status), verdict);
  if (certificate.relative) assert(verdict.includes(`${Number((100 * certificate.relative).toPrecision(3))}`), verdict);
  await checkLinks(page, directory);
  await checkUnits(page, certificate.units);
  const rows = readFileSync(`${directory}/newton.csv`, "utf8").trim().split("\n").length - 1;
  assert.equal(await page.locator("#newton tbody tr").count(), rows);
}

/** Numbers carry the units of the case; where it names none there are no signs in their place. */
async function checkUnits(page, units) {
  const text = await page.locator("#page").textContent();
  assert.doesNotMatch(text, /\[[SLF]\b|\bS L\b|\b[SL][\u00b2\u00b3]/);
  assert.equal(text.includes("The case names no units"), !units);
  if (!units) return;
  const words = `Lengths are in ${units.length}, stresses in ${units.stress}, forces in ${units.force}`;
  for (const part of [words, `[${units.force}]`, `[${units.length}]`]) assert(text.includes(part), part);
}

async function checkNarrowAndDark(browser, url) {
  const { page, complaints } = await openPage(browser, url, { width: 390, height: 800, colorScheme: "dark" });
  assert(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than the screen");
  assert.deepEqual(complaints, []);
  await page.close();
}

/** Pairs and bodies as they stand in the certificate. */
async function checkPairs(page, directory) {
  const { bodies, contact } = JSON.parse(readFileSync(`${directory}/certificate.json`, "utf8"));
  const tables = await page.locator("#contact table").evaluateAll((list) => list.map((table) =>
    [...table.querySelectorAll("tbody tr")].map((row) => [...row.cells].map((cell) => cell.textContent))));
  assert.equal(tables.length, 4); // forces, pairs, moments, bodies
  const [[name, pair]] = Object.entries(contact.boundaries);
  assert.equal(await page.locator("#contact h3").first().textContent(), `${name} on ${pair.master[0]}`);
  assert.deepEqual(tables[1][0].slice(0, 4), [name, pair.master[0], pair.law, String(pair.segments)]);
  const [moment, onMaster] = tables[2][0].slice(1).map((text) => Number(text.replace(/[(\u2212]/g, (c) => (c === "(" ? "" : "-")).split(",")[0].replace(")", "").replace(/\u00d710.*/, "")));
  const digits = (value) => Number(value.toExponential().split("e")[0]);
  for (const [shown, [value]] of [[moment, pair.moment], [onMaster, pair.moment_on_master]])
    assert(Math.abs(shown - value) < 1e-5 * Math.abs(value) || Math.abs(shown - digits(value)) < 1e-4, `${shown} instead of ${value}`);
  assert.deepEqual(tables[3].map(([body]) => body), bodies.map((body) => body.name));
}

const cellsOf = (page, place) => page.locator(`${place} tbody tr`).evaluateAll((list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));

/** Sections and probes between two bodies, with the point on the interface on both sides. */
async function checkObservations(page, directory) {
  const { probes, sections } = JSON.parse(readFileSync(`${directory}/certificate.json`, "utf8"));
  const [[name, length]] = await cellsOf(page, "table.sections");
  assert.deepEqual([name, length], ["the upper body", "1"]);
  assert.equal(sections[0].V.length, 1);
  const corner = await cellsOf(page, "table.probes");
  assert.deepEqual(corner.map((row) => row.slice(0, 2)), [["corner", "upper"]]);
  await checkCharts(page, ["#probes .chart >> nth=0", "#probes .chart >> nth=1"]);
  assert.deepEqual(await page.locator("#probes h3").allTextContents(),
    ["Sections", "Probes", "down & <across>: displacement", "down & <across>: stress"]);
  assert.match(await hover(page, "#probes .chart"), /u x, \(1\.3, 1\), upper/);
  const rows = (await saved(page, "#probes", "CSV")).toString().trim().split("\n");
  assert.equal(rows[0], "point,region,curve,x,value");
  const line = probes[0].points;
  assert.equal(line.length, 10);
  assert.equal(rows.length - 1, 2 * line.length);
  assert.deepEqual(rows.slice(1, 11).map((row) => Number(row.split(",").at(-1))).map((x) => x.toPrecision(9)),
    line.map((point) => point.displacement[0].toPrecision(9)));
  assert.equal(readFileSync(`${directory}/probes.csv`, "utf8").split("\n")[0].split(",")[0], "level");
}

async function checkCharts(page, charts) {
  for (const chart of charts) assert(await colours(page, chart) > 15, `${chart} is blank`);
}

async function checkPrint(page, file) {
  await page.pdf({ path: file, format: "A4", printBackground: true });
  assert(readFileSync(file).length > 20000);
}

/** Pictures and tables can be saved from the page alone, the tables as they are in the files. */
async function checkSaved(page, directory) {
  assert.match(await page.locator("#quantities table").textContent(), /thrust & <lift>0\.1.*(energy bound|second order)/);
  assert.match((await saved(page, "#quantities", "CSV")).toString(), /^level,dofs,value,lower,upper\n0,/);
  assert.match(await page.locator(".figures").textContent(), /thrust & <lift>between 0\.\d+ and 0\.1/);
  assert.match((await saved(page, "#convergence", "SVG")).toString(), /^<svg.*<path/s);
  assert.match((await saved(page, "#convergence", "CSV")).toString(), /^curve,level,dofs,value\nstr,0,/);
  for (const place of ["#contact", "#fields"]) assert.equal((await saved(page, place, "PNG")).subarray(1, 4).toString(), "PNG");
  assert.match((await saved(page, "#fields", "CSV")).toString(), /^x,y/);
  for (const name of ["convergence.csv", "newton.csv", "contact.csv"])
    assert.equal((await saved(page, "#files", name)).toString(), readFileSync(`${directory}/${name}`, "utf8"), name);
  assert.deepEqual(JSON.parse(await saved(page, "#files", "certificate.json")), JSON.parse(readFileSync(`${directory}/certificate.json`, "utf8")));
}

/** The same page with other data: what belongs to the certificate is shown as it stands there. */
async function checkGivenCertificate(browser, directory) {
  const page = readFileSync(`${directory}/report.html`, "utf8");
  const [, text] = page.match(/id="run-data">(.*?)<\/script>/s);
  const data = JSON.parse(text);
  Object.assign(data.certificate, {
    warnings: [{ code: "a", where: "boundary \"bottom\"", text: "of ||sigma(u_h)||, raise gamma_0", value: 1 }],
    balance: { about: [0, 0.5], rows: [{ kind: "load", name: "top", source: "traction", force: [1e-15, -0.2], moment: [-0.2] },
      { kind: "reaction", name: "left", source: "displacement", force: [0, 0.2], moment: [0.2] },
      { kind: "sum", name: "", source: "", force: [2e-16, 1e-15], moment: [1e-16] }] } });
  data.certificate.components.quad = 1;
  for (const row of data.newton) row.quad = 1e6; // then the linearisation is nothing beside the rest
  data.certificate.case = { file: "case.toml", sha256: "0123", files: [{ file: "block.msh", sha256: "4567" }], overrides: ["degree=3"] };
  data.certificate.purpose = "Does it slide?";
  data.case = { ...data.certificate.case, text: "[load]\nbody = [0, \"-x\"]" };
  const changed = `${directory}/given.html`;
  writeFileSync(changed, page.replace(text, () => JSON.stringify(data).replaceAll("<", "\\u003c")));
  const given = await openPage(browser, pathToFileURL(changed).href);
  assert.match(await given.page.locator(".warnings").innerText(), /1 warning.*boundary "bottom": of .*raise/s);
  assert.equal(await given.page.locator(".warnings math").count(), 2);
  for (const [place, words] of [["#text", "degree=3"], ["#text", "body = [0, \"-x\"]"], ["#times", "case.toml0123"], ["#times", "block.msh4567"], ["header", "Does it slide?"], ["#case", "body = [0, \"-x\"]"],
    ["#balance", "moments about (0, 0.5)"]]) assert((await given.page.locator(place).textContent()).includes(words), words);
  const rows = await given.page.locator(".balance tbody tr").evaluateAll((list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  assert.deepEqual(rows, [["load", "top", "traction", "0", "\u22120.2", "\u22120.2"], ["reaction", "left", "displacement", "0", "0.2", "0.2"],
    ["sum", "", "", "0", "0", "0"]]);
  assert.match(await given.page.locator("#bound .lead").textContent(), /loads jump along curves, quad/);
  assert.equal(await given.page.locator("#bound math[display=block]").evaluate((formula) => formula.textContent.endsWith("+\u03b7quad")), true);
  const ofTheRest = await given.page.locator("#newton tbody tr td:nth-child(7)").allTextContents();
  assert(ofTheRest.some((text) => text !== "\u2013")); // iterates that sigma_lin rules out have no complete bound
  for (const text of ofTheRest) assert.match(text, /^0\s|\u00d710\u207b|^\u2013$/);
  assert.deepEqual(given.complaints, []);
  await given.page.close();
}

/** Without WebGL the page draws the picture itself. */
async function checkWithoutWebGL(url, use) {
  const plain = await launch(folder, { webgl: false });
  try {
    const { page, complaints } = await openPage(plain, url);
    assert.match(await page.locator(".fields > .note").first().textContent(), /^This browser has no WebGL/);
    await use(page, 3);
    assert.deepEqual(complaints, []);
  } finally {
    await plain.close();
  }
}

/** The first swipe over the picture scrolls the page; a tap gives the picture the fingers. */
async function checkTouch(browser, url) {
  const { page } = await openPage(browser, url, { width: 390, height: 800, hasTouch: true });
  const action = () => page.locator(".view").evaluate((view) => getComputedStyle(view).touchAction);
  assert.equal(await action(), "pan-y");
  await page.locator(".view").tap();
  assert.equal(await action(), "none");
  for (const cell of ["td:nth-child(3)", ".share"]) {
    const box = await page.locator(`.components ${cell}`).first().boundingBox();
    assert(box.x >= 0 && box.x + box.width <= 390, `${cell} is cut off`);
  }
  await page.close();
}

async function checkPrintedFields(page) {
  assert.match(await page.locator("svg.print-only image").getAttribute("href"), /^data:image\/png/);
}

/** What the pointer is told on a point of a chart. */
async function hover(page, chart) {
  await page.locator(`${chart} circle`).first().hover({ force: true });
  const tip = page.locator(`${chart} [aria-label="tip"] text`).first();
  await tip.waitFor();
  return tip.textContent();
}

/** The page of a study, and that of a variant, which shows the true errors. */
async function checkStudy(browser, directory) {
  const url = pathToFileURL(`${directory}/report.html`).href;
  const { page, complaints, seconds } = await openPage(browser, url);
  const found = JSON.parse(readFileSync(`${directory}/study.json`, "utf8"));
  assert.doesNotMatch(await page.locator("body").innerText(), /Infinity|NaN|undefined/);
  assert.match(await page.locator(".verdict:not(.warnings)").textContent(), /The bound holds.*is above the dual norm.*best rate.*Newton steps instead of.*Degree 2/);
  await page.screenshot({ path: `${results}/study.png`, fullPage: true });
  for (const [section, n] of [["convergence", 2], ["effectivity", 3], ["components", 2]]) {
    assert.equal(await page.locator(`#${section} .chart`).count(), n);
    await checkCharts(page, [`#${section} .chart >> nth=0`, `#${section} .chart >> nth=1`]);
  }
  assert.match(await hover(page, "#convergence .chart"), /level \d.*%.*degrees of freedom/);
  const links = await checkLinks(page, directory);
  for (const link of ["study.csv", "study.json", "reference/report.html", ...Object.keys(found.variants).map((name) => `${name}/report.html`)])
    assert(links.includes(link), `no link to ${link}`);
  assert.equal(await page.locator("#newton tbody tr").count(), found.newton_table.length + 1);
  assert.match(await page.locator("#reference").textContent(), / kN m\/m.* kN\/m normal, .* kN\/m tangential.* m$/s);
  await checkPrint(page, `${results}/study.pdf`);
  await checkNarrowAndDark(browser, url);
  assert.deepEqual(complaints, []);
  report("study", directory, seconds);
  await page.close();
  const variant = await openPage(browser, pathToFileURL(`${directory}/uniform/report.html`).href);
  assert.match(await variant.page.locator("#convergence .legend").textContent(), /dual norm of the residual.*true error of the stress/);
  assert((await checkLinks(variant.page, `${directory}/uniform`)).includes("../report.html"));
  assert.deepEqual(variant.complaints, []);
  await variant.page.close();
}

/** The page of a sweep: error bars as in its table, a line for each pull, links to the pages of the runs. */
async function checkSweep(browser) {
  const directory = `${solve("sweep", sweep)}/sweep`;
  const url = pathToFileURL(`${directory}/report.html`).href;
  const { page, complaints, seconds } = await openPage(browser, url);
  assert.doesNotMatch(await page.locator("body").innerText(), /Infinity|NaN|undefined/);
  assert.match(await page.locator(".verdict").textContent(), /All 6 runs are certified.*0\.02, 0\.03, 0\.04/s);
  await page.screenshot({ path: `${results}/sweep.png`, fullPage: true });
  await checkCharts(page, ["#quantities .chart", "#numbers .chart >> nth=0", "#effort .chart >> nth=0"]);
  assert.equal(await page.locator('#quantities [aria-label="rule"] line').count(), 6);
  assert.match(await hover(page, "#quantities .chart"), /limit of friction \[kN\/m\] = 0\.0\d, pull =.*0\.0\d.*between .* and .*kN\/m.*run 000\d: certified/s);
  const bars = JSON.parse(readFileSync(`${directory}/sweep.json`, "utf8")).runs.map((run) => ["", ".lower", ".upper"].map((end) => run[`quantity.grip${end}`]));
  const table = (await saved(page, "#quantities", "CSV")).toString().trim().split("\n").slice(1).map((line) => line.split(",").slice(-3).map(Number));
  assert.deepEqual(table.sort(), bars.sort());
  for (const [value, lower, upper] of bars) assert(lower < upper && lower <= value && value <= upper);
  const titles = await page.locator("#numbers h3").allTextContents();
  for (const shown of ["Section across, N", "Section across, M", "Probe corner, u y"]) assert(titles.includes(shown), titles.join(", "));
  const links = await checkLinks(page, directory);
  for (const link of ["sweep.csv", "sweep.json", "0001/report.html", "0006/report.html"]) assert(links.includes(link), `no link to ${link}`);
  await checkPrint(page, `${results}/sweep.pdf`);
  await checkNarrowAndDark(browser, url);
  assert.deepEqual(complaints, []);
  report("sweep", directory, seconds);
  await page.close();
}

/** What a joint remembers, at each load step. */
async function checkJoint(browser) {
  const directory = solve("joint", joint);
  const { page, complaints, seconds } = await openPage(browser, pathToFileURL(`${directory}/report.html`).href);
  const curves = page.locator("#contact .chart").first();
  await curves.waitFor();
  const last = await curves.innerHTML();
  for (const title of ["effective pressure", "pressure of the water", "damage", "opening of the joint"]) assert(last.includes(title), title);
  assert.match(last, /effective pressure \[[^\]]*MPa\]/);
  assert.match(await page.locator("#history").textContent(), /largest displacement \[m\]/);
  assert.equal(await page.locator("#contact-step option").count(), 3);
  await page.locator("#contact-step").selectOption("0");
  await page.waitForFunction((before) => document.querySelector("#contact .chart").innerHTML !== before, last);
  assert.deepEqual((await page.locator("#history h3").allTextContents()).filter((title) => title === "Watched"), ["Watched"]);
  assert.deepEqual((await page.locator("#probes h3").allTextContents()).slice(2),
    ["across: forces", "across: moments", "crest: displacement", "crest: stress"]);
  assert.match(await hover(page, "#probes .chart"), /N, step 1, t = 0\.5.*MN/s);
  assert.deepEqual(complaints, []);
  report("joint", directory, seconds);
  await page.close();
}

async function checkRevolution(of) {
  const directory = solve("revolution", revolution);
  report("revolution", directory, await useRevolution(of, directory, `${results}/revolution`));
}

/** The page of a judgement in 2D and 3D, in 3D also without WebGL. */
async function checkJudgements(browser) {
  for (const name of ["block", "cube"]) {
    const directory = judge(program, `${results}/judged_${name}`, cases[name].text);
    report(`judged ${name}`, directory, await useJudgement(browser, directory, `${results}/judged_${name}`), "judgement.html");
    await checkNarrowAndDark(browser, pathToFileURL(`${directory}/judgement.html`).href);
    if (name === "block") continue;
    const plain = await launch(folder, { webgl: false });
    try {
      await useJudgement(plain, directory, `${results}/judged_without_webgl`);
    } finally {
      await plain.close();
    }
  }
  const steps = cases.block.text.replace("traction = [0, -0.1]", 'traction = [0, "-0.1*t"]').replace("[certify]", "[history]\nsteps = [0.5, 1]\n[certify]");
  const directory = judge(program, `${results}/judged_steps`, steps);
  report("judged steps", directory, await useJudgedSteps(browser, directory, `${results}/judged_steps`), "judgement.html");
}

function report(name, directory, seconds, file = "report.html") {
  console.log(`${name}: opens in ${seconds.toFixed(2)} s, ${(readFileSync(`${directory}/${file}`).length / 1e6).toFixed(2)} MB`);
}

const browser = await launch(folder);
try {
  for (const [name, what] of Object.entries(cases)) {
    const directory = solve(name, what);
    const url = pathToFileURL(`${directory}/report.html`).href;
    const { page, complaints, seconds } = await openPage(browser, url);
    await checkCertificate(page, directory, what.status);
    if (what.exit !== 2) {
      await page.screenshot({ path: `${results}/${name}.png`, fullPage: true });
      await checkCharts(page, ["#bound .chart", "#convergence .chart", name === "pair3d" ? "#contact .plan" : "#contact .chart"]);
      await checkPrint(page, `${results}/${name}.pdf`);
      await checkPrintedFields(page);
      const dimension = ["cube", "pair3d"].includes(name) ? 3 : 2;
      await (what.bodies ? useBodies : useFields)(page, dimension);
      if (what.bodies) await checkPairs(page, directory);
      if (name === "pair") await checkObservations(page, directory);
      if (name === "cube") assert.match(await page.locator("#probes").textContent(), /not symmetric on average.*edge: stress/s);
      if (dimension === 3) await usePlans(page);
      await checkNarrowAndDark(browser, url);
    }
    if (name === "block") {
      assert.equal(await page.locator("h1").textContent(), title);
      assert.doesNotMatch(await page.locator("#guarantee").innerText(), /\|\||\^|_/);
      await checkSaved(page, directory);
      await checkTouch(browser, url);
      await checkGivenCertificate(browser, directory);
    }
    if (["cube", "pair3d"].includes(name)) await checkWithoutWebGL(url, what.bodies ? useBodies : useFields);
    assert.equal(await page.locator("img").count(), 0);
    assert.deepEqual(complaints, []);
    report(name, directory, seconds);
    await page.close();
  }
  await checkJoint(browser);
  await checkRevolution(browser);
  await checkStudy(browser, solve("study", study));
  await checkSweep(browser);
  await checkJudgements(browser);
} finally {
  await browser.close();
}
