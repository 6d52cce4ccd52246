// The page of a study, with the data of app/page/study_page.cpp: what adaptation and the stopping criterion bring.

import { coloured } from "./components.js";
import { count, element, fixed, number, percent, section, seconds, table } from "./dom.js";
import { definitions, filesSection, hashes, timesAndMachine } from "./facts.js";
import { typeset } from "./math.js";
import { componentsSection, convergenceSection, effectivitySection } from "./study_charts.js";
import { studyHeader } from "./study_verdict.js";
import { measured, nameUnits, unit } from "./units.js";
import { extent, total, variantsOf } from "./variants.js";

/** "1.21 to 1.32" */
function rangeText(range) {
  return range && `${fixed(range[0])} to ${fixed(range[1])}`;
}

function variantsSection(study, files) {
  const rows = variantsOf(study).map(({ key, name, colour, rates, status, levels }) => {
    const last = levels.at(-1);
    const page = `${key}/report.html`;
    const swatch = element("span", { class: "swatch", style: `--colour:${colour}` });
    return [element("span", { class: "component" }, swatch, files.includes(page) ? element("a", { href: page }, name) : name), status,
      String(levels.length), count(last?.dofs ?? 0), percent(last?.relative), fixed(rates.bound),
      percent(last?.relative_error), fixed(rates.error), rangeText(extent(levels, "effectivity")) ?? "\u2013", String(total(levels, "newton_steps")),
      seconds(total(levels, "t_level"))];
  });
  const reasons = variantsOf(study).filter(({ reason }) => reason).map(({ name, reason }) => [name, typeset(reason)]);
  return section("variants", "Variants", "The four variants",
    "Bound and error are those of the last level, the bound relative to the norm of the stress, the error to the energy norm. Slopes are exponents of the degrees of freedom, fitted over the last half of the levels.",
    table(["variant", "ended as", "#levels", "#dofs", "#bound", "#slope", "#error", "#slope", "#bound / dual norm", "#Newton steps", "#time"], rows, { class: "variants" }),
    reasons.length > 0 ? [element("h3", {}, "Why they ended"), definitions(reasons)] : null,
    variantsOf(study).map(levelTable));
}

/** All levels of a variant, in an expandable element. */
function levelTable({ name, levels }) {
  const rows = levels.map((level) => [String(level.level), count(level.cells), count(level.dofs), String(level.newton_steps),
    percent(level.relative, 4), fixed(level.rate_bound), percent(level.relative_error, 4), fixed(level.rate_error),
    fixed(level.effectivity, 3), fixed(level.effectivity_stress, 3), seconds(level.t_solve), seconds(level.t_certify), seconds(level.t_level)]);
  return element("details", {}, element("summary", {}, `Levels of the variant \u201c${name}\u201d`),
    table(["#level", "#cells", "#dofs", "#Newton steps", "#bound", "#slope", "#error", "#slope", "#bound / dual norm",
      "#bound / stress error", "#solve", "#certify", "#whole level"], rows, { class: "long" }));
}

function newtonSection(study) {
  const variants = variantsOf(study);
  const cells = (values) => values.map((steps) => (steps === null ? "\u2013" : String(steps)));
  const rows = study.newton_table.map((row) => [String(row.level), ...cells(variants.map(({ key }) => row[key]))]);
  const sums = ["all", ...cells(variants.map(({ levels }) => total(levels, "newton_steps")))];
  sums.class = "accepted group";
  const body = table(["#level", ...variants.map(({ name }) => `#${name}`)], [...rows, sums], { class: "steps long" });
  return section("newton", "Newton", "Newton steps per level",
    `The criterion stops Newton\u2019s method where the linearisation part of the bound is ${number(study.gamma_lin)} of the rest; without it the method runs to its tolerance.`,
    body);
}

function referenceSection(study) {
  const { reference } = study;
  const lead = "The solution that stands for the exact one: of higher degree, on a mesh adapted to it by its own bound.";
  if (!reference) return section("reference", "Reference", "The reference", lead, element("p", {}, "There is none: the errors are not known."));
  return section("reference", "Reference", "The reference", lead, element("div", { class: "two-columns" },
    definitions([["degree", String(reference.degree)], ["cells", count(reference.cells)], ["degrees of freedom", count(reference.dofs)],
      ["its own bound", `${percent(reference.relative)} of the norm of the stress`], ["asked for", `at most ${percent(reference.required)}`],
      ["verdict", reference.fine_enough ? "fine enough" : `too coarse, errors near its bound are not reliable: ${reference.reason}`]]),
    definitions([["energy", measured(number(reference.energy, 6), unit("energy"))],
      ["contact force", `${measured(number(reference.contact_normal, 6), unit("force"))} normal, ${measured(number(reference.contact_tangential, 6), unit("force"))} tangential`],
      ["largest displacement", measured(number(reference.max_displacement, 6), unit("length"))]])));
}

export function studyPage({ study, components, machine, files }) {
  nameUnits(study.units);
  const sections = [convergenceSection(study), effectivitySection(study), componentsSection(study, coloured(components.filter(({ part }) => part !== "combined"))), variantsSection(study, files),
    newtonSection(study), referenceSection(study),
    section("times", "Times", "Times and machine", null, timesAndMachine(study.times, machine, study.program), hashes("study.json", study.case)), filesSection(files)].filter(Boolean);
  return { title: `${study.title || study.file}, study`, purpose: "This report documents a study: what the adaptation of the mesh and the stopping of Newton\u2019s method bring.",
    header: studyHeader(study, machine), sections, start: async () => {}, machine,
    program: study.program };
}
