// The guarantee, the case, the machine, and the other files.

import { unpackText } from "./arrays.js";
import { axisNames, showsMeridian } from "./axes.js";
import { count, element, number, percent, plural, seconds, section, table, withoutNoise } from "./dom.js";
import { download } from "./export.js";
import { guaranteeFormula, typeset } from "./math.js";
import { hashOfRecord } from "./paper.js";
import { headed, measured, unit } from "./units.js";

const list = (items) => element("ul", {}, items.map((item) => element("li", {}, typeset(item))));

const topics = { quadrature: "Quadrature", displacement: "Prescribed displacements", geometry: "Geometry", rounding: "Rounding",
  linear_solver: "Linear solver" };

export function definitions(pairs) {
  return element("dl", {}, pairs.filter(([, value]) => value).map(([name, value]) =>
    element("div", {}, element("dt", {}, name), element("dd", {}, value))));
}

/** What the numbers on the page are worth, without formulas. */
function plainWords(run) {
  const { relative, energy_error: energy, quantities = [], steps } = run;
  const bars = quantities.filter(({ reason }) => !reason);
  const condition = energy?.guaranteed_for === "tresca_with_computed_threshold" ? ", for the computed friction threshold" : "";
  const step = steps ? " of the last load step, after the computed slip of those before it" : "";
  const exactly = step + condition;
  const guaranteed = run.bound === null || run.bound === undefined ? [] : [
    relative > 0 && !steps ? `The computed displacement leaves forces that do not balance, in the body, at its boundary and in contact. They are at most ${percent(relative)} of the stress, measured as below.` : null,
    steps ? "In each load step the computed displacement leaves forces that do not balance. Their largest size, measured as below, stands in the table of steps." : null,
    energy?.relative > 0 ? `The computed displacement is at most ${percent(energy.relative)} away from the exact one${steps ? exactly : ` of this model${condition}`}, in the energy norm.` : null,
    bars.length > 0 ? `${bars.length === 1 ? "One number has" : `${bars.length} numbers have`} an interval in which the exact value${exactly && `${exactly},`} is certain to lie: ${bars.map(({ name }) => name).join(", ")}.` : null].filter(Boolean);
  const open = ["Single values: the largest stress, the largest pressure, values at points and along lines, and all pictures are those of the computed solution.",
    run.balance ? "Forces, moments and factors of safety are in equilibrium with the loads, but the bound does not cover them." : null,
    "Whether model, loads, supports and materials describe the structure is for the engineer to judge."].filter(Boolean);
  return [element("h3", {}, "In plain words"),
    guaranteed.length > 0 ? [element("p", {}, "Guaranteed, without unknown constants and on every mesh:"), list(guaranteed)] : element("p", {}, "Nothing is guaranteed of this result."),
    element("p", {}, "Not guaranteed:"), list(open)];
}

export function guaranteeSection(run) {
  const identities = run.identities && Object.entries(run.identities)
    .filter(([, value]) => value !== null) // no symmetry row by row, nor for degree 1
    .map(([name, value]) => [name, number(value, 2)]);
  return section("guarantee", "Guarantee", "What is guaranteed, and what is not", null,
    plainWords(run), element("div", { class: "two-columns" },
      element("div", {}, element("h3", {}, run.bound ? "The bound covers" : "A bound would cover"), guaranteeFormula(showsMeridian()), list(run.covered),
        element("h3", {}, "It does not cover"), list(run.not_covered),
        element("h3", {}, "The law"), element("p", {}, typeset(run.law))),
      element("div", {}, element("h3", {}, "It rests on"),
        definitions(Object.entries(run.assumptions).map(([topic, text]) => [topics[topic] ?? topic, typeset(text)])),
        identities ? element("h3", {}, "Identities of the equilibrated stress") : null,
        identities ? table(["identity", "#largest defect, relative"], identities) : null,
        identities ? element("p", { class: "note" }, `Above ${number(run.constants.identity_limit)} an identity would count as violated.`) : null)));
}

/** The case as it was solved, with what was overridden. */
export function caseTextSection({ case: effective }) {
  if (!effective?.text) return null;
  const { text, overrides } = effective;
  return section("text", "Case file", "The case file", "As it was solved, with every --set; run again, it gives the same numbers.",
    overrides?.length > 0 ? element("p", { class: "note" }, "Set on the command line: ", overrides.map((item, i) => [i > 0 ? ", " : "", element("code", {}, item)]), ".") : null,
    element("details", {}, element("summary", {}, "The effective case, with its formulas and body forces"), element("pre", { tabindex: 0 }, text)));
}

/** The tables of the case with these names, as it has them. */
function tablesOf(effective, names) {
  const tables = (effective?.text ?? "").split(/^(?=\[)/m);
  return tables.filter((text) => names.some((name) => new RegExp(`^\\[+${name}[.\\]]`).test(text))).join("").trim();
}

const kinds = { 2: "plane bodies, forces per unit of depth", 3: "bodies in space" };

/** The equations, and how they were solved. */
function modelDefinitions(run) {
  const { d, p, gamma0, friction, levels, steps } = run;
  return definitions([
    ["Bodies", showsMeridian() ? "bodies of revolution, computed in their meridian" : kinds[d]],
    ["Model", "equilibrium of linearly elastic bodies, small strains"],
    ["Contact", friction ? `law of friction or of the interface: ${friction}` : "none"],
    ["Load steps", steps && `${plural(steps.length, "step", "steps")}, from t = ${number(steps[0]?.t, 6)} to ${number(steps.at(-1)?.t, 6)}`],
    ["Method", `Nitsche\u2019s finite element method of degree ${p}, \u03b3\u2080 = ${number(gamma0)}, ${plural(levels.length, "mesh", "meshes")}`],
    ["Units", unitsText(run)]]);
}

/** Loads, reactions, springs and contact forces with their sum, which is zero in equilibrium. */
export function balanceSection({ balance, d }) {
  if (!balance?.rows?.length) return null;
  const [forces, moments] = [unit("force"), unit("moment")];
  const scale = (key) => balance.rows.flatMap((row) => row[key]).reduce((size, value) => Math.max(size, Math.abs(value)), 0);
  const [largestForce, largestMoment] = [scale("force"), scale("moment")];
  const cells = (values, largest) => withoutNoise([values].flat(), largest).map((value) => number(value, 6));
  const isMeridian = showsMeridian(); // around the axis only the axial forces do not cancel
  const axes = axisNames(d);
  const rows = balance.rows.map(({ kind, name, source, force, moment }) => {
    const cellsOfRow = [kind, name ?? "", source ?? "", ...(isMeridian ? cells(force, largestForce).slice(1)
      : [...cells(force, largestForce), ...cells(moment, largestMoment)])];
    cellsOfRow.class = kind === "sum" ? "accepted group" : null;
    return cellsOfRow;
  });
  if (isMeridian)
    return section("balance", "Balance", "Balance of forces", "Axial forces of the full circle on the body; in equilibrium the sum is zero.",
      table(["", "where", "by", headed(`#force ${axes[1]}`, forces)], rows, { class: "balance" }));
  const about = balance.about ? `, moments about (${balance.about.map((x) => number(x, 4)).join(", ")})` : "";
  return section("balance", "Balance", "Balance of forces", `Loads, reactions of supports and contact forces on the body${about}; in equilibrium the sum is zero.`,
    table(["", "where", "by", ...axes.map((axis) => headed(`#force ${axis}`, forces)),
      ...(d === 2 ? [headed("#moment", moments)] : axes.map((axis) => headed(`#moment ${axis}`, moments)))], rows, { class: "balance" }));
}

/** The units of the numbers. */
function unitsText({ d, units }) {
  const per = (depth) => (showsMeridian() ? ", of the full circle; norms of stresses are those of a radian" : d === 2 ? depth : "");
  if (!units) return `The case names no units: lengths, stresses and forces are in those of its numbers${per(", forces per unit of depth")}.`;
  return `Lengths are in ${unit("length")}, stresses in ${unit("stress")}, forces in ${unit("force")}${per(`, per ${unit("length")} of depth`)}.`;
}

export function caseSection(data) {
  const run = data.certificate;
  const [body, boundary] = run.d === 2 && !showsMeridian() ? ["area", "length"] : ["volume", "area"];
  const loads = tablesOf(data.case, ["load", "parameters", "history"]);
  return section("case", "Case", "The case", null, modelDefinitions(run), element("h3", {}, "Regions and materials"),
    table(["region", "#cells", headed(`#${body}`, unit("body")), "material"],
      run.mesh.regions.map((region) => [region.name, count(region.cells), number(region.measure), region.material])),
    element("h3", {}, "Supports, loads and contact"),
    table(["boundary", "#facets", headed(`#${boundary}`, unit("boundary")), "what holds there"],
      run.mesh.boundaries.map((part) => [part.name, count(part.facets), number(part.measure), part.condition])),
    element("p", { class: "note" }, "Where something varies, the case file has its formula."),
    loads ? [element("p", { class: "note" }, "Body forces, temperatures, parameters and load steps, as the case has them:"), element("pre", {}, loads)] : null,
    element("h3", {}, "Mesh"), element("p", {}, `The first mesh has ${plural(run.mesh.cells, "cell", "cells")} and ${count(run.mesh.vertices)} vertices, its cells are from `
      + `${measured(`${number(run.mesh.smallest_cell)} to ${number(run.mesh.largest_cell)}`, unit("length"))} long; cells and facets above are counted there.`
      + `${run.cells === undefined ? "" : ` The last mesh has ${plural(run.cells, "cell", "cells")} and ${count(run.dofs)} unknowns.`}`));
}

function levelTable(run) {
  return table(["#level", "#cells", "#dofs", "#Newton steps", "#bound [%]", "#energy error [%]", headed("#energy", unit("energy")), "#solve", "#certify", "#whole level"],
    run.levels.map((level) => [String(level.level), count(level.cells), count(level.dofs), String(level.newton.length),
      level.relative === null ? "\u2013" : number(100 * level.relative),
      level.energy_error?.relative > 0 ? number(100 * level.energy_error.relative) : "\u2013", number(level.energy, 6), seconds(level.times.solve),
      seconds(level.times.certify), seconds(level.times.level)]), { class: "long" });
}

/** Wall seconds by stage, and the machine. */
export function timesAndMachine(times, machine, program) {
  const memory = machine.memory > 0 ? `, ${Math.round(machine.memory / 2 ** 30)} GiB of memory` : "";
  const stages = Object.entries(times).map(([stage, value]) => [stage, stage === "factorisations" ? count(value) : seconds(value)]);
  return element("div", { class: "two-columns" },
    stages.length > 0 ? element("div", {}, element("h3", {}, "Times"), definitions(stages)) : null,
    element("div", {}, element("h3", {}, "Machine and program"), definitions([
      ["processor", machine.processor && `${machine.processor}, ${machine.processors} logical processors${memory}`],
      ["system", machine.system], ["tribound", `${program.version}, ${program.compiler}`], ["PETSc", program.petsc],
      ["MUMPS", program.mumps], ["BLAS", program.blas && `${program.blas}${program.blas_threads ? `, threads: ${program.blas_threads}` : ""}`],
      ["MPI", program.mpi], ["Gmsh", program.gmsh], ["Eigen", program.eigen]])));
}

/** The files of a result by their contents: `record`, which the page shows, the effective case with the files that it names, and others. */
export function hashes(record, effective, others = []) {
  const files = [{ file: record, sha256: hashOfRecord }, effective, ...(effective?.files ?? []), ...others].filter((known) => known?.sha256);
  if (files.length === 0) return null;
  return [element("h3", {}, "Files by their contents"), table(["file", "SHA-256"], files.map(({ file, sha256 }) => [file, element("code", {}, sha256)]))];
}

export function levelsSection({ certificate: run, machine }) {
  return section("times", "Times", "Levels, times, machine", null, levelTable(run), timesAndMachine(run.times, machine, run.program),
    hashes("certificate.json", run.case));
}

const contents = { "certificate.json": "the whole result, for programs", "convergence.csv": "a row per level", "history.csv": "a row per load step",
  "quantities.csv": "what the case wants to know, with error bars, level by level",
  "probes.csv": "displacement and stress at points", "sections.csv": "forces and moments through planes",
  "newton.csv": "a row per Newton step", "contact.csv": "the contact boundary, point by point",
  "series.pvd": "all levels or load steps, for ParaView", "adapted.msh": "the last mesh, for Gmsh",
  "case.toml": "the case as it was solved", "case_effective.toml": "the case as it was solved",
  "sweep.csv": "a row per run", "sweep.json": "the whole sweep, for programs",
  "study.csv": "a row per variant and level", "study.json": "the whole study, for programs",
  "judgement.json": "the whole judgement, for programs", "judged_cells.csv": "a row per cell of theirs: its distance, and whether to refine it",
  "judged.vtu": "their displacement with the distances, for ParaView", "report.html": "the run that judged it",
  "../report.html": "the study that this run belongs to" };

/** Tables stored in the page, which may be read without the files. */
function heldTables({ tables, certificate }) {
  const texts = { ...tables, "certificate.json": { plain: JSON.stringify(certificate, null, 2) } };
  const held = Object.entries(texts).filter(([, packed]) => packed);
  const save = async (name, packed) =>
    download(name, name.endsWith(".json") ? "application/json" : "text/csv", packed.plain ?? await unpackText(packed));
  const missing = Object.keys(texts).filter((name) => !texts[name]);
  return element("div", { class: "screen-only" }, element("p", {}, "This page holds copies: ", held.map(([name, packed]) =>
    [element("button", { type: "button", class: "save", onclick: () => save(name, packed) }, name), " "])),
    missing.length > 0 ? element("p", { class: "note" }, `Too large for this page, or not written: ${missing.join(", ")}.`) : null);
}

/** `data`: of the page of a run. */
export function filesSection(files, data) {
  if (files.length === 0 && !data) return null;
  const contentsOf = (name) => contents[name.replace(/^judged_steps\/\d+\//, "")];
  const item = (name) => element("li", {}, element("a", { href: encodeURI(name) }, name), contentsOf(name) ? ` \u2013 ${contentsOf(name)}` : "");
  const vtu = files.filter((name) => name.endsWith(".vtu") && !contentsOf(name));
  return section("files", "Files", "The other files", null, data ? heldTables(data) : null,
    files.length === 0 ? null : element("p", { class: "lead" }, "They lie beside this page:"),
    element("ul", { class: "files" }, files.filter((name) => !vtu.includes(name)).map(item)),
    vtu.length === 0 ? null : element("details", {}, element("summary", {}, `Fields of each level or load step (${vtu.length} files)`),
      element("ul", { class: "files files-many" }, vtu.map(item))));
}
