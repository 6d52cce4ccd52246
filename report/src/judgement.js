// The page of a judgement, with the data of app/page/judgement_page.cpp: how wrong the solution of another program is.

import { axisNames, nameAxes, showsMeridian } from "./axes.js";
import { count, element, number, section, table, withoutNoise } from "./dom.js";
import { definitions, filesSection, hashes, timesAndMachine } from "./facts.js";
import { errorsSection, judgedNumbersSection } from "./judgement_charts.js";
import { comparisonSection } from "./judgement_fields.js";
import { coreText, halvingText, judgementHeader, placeText } from "./judgement_words.js";
import { stepsSection } from "./judgement_steps.js";
import { judgementFormula } from "./math.js";
import { headed, measured, nameUnits, unit } from "./units.js";

/** Where the error lies, what to refine, and what the picture says of a single cell. */
function wordsOfCells({ displacement }) {
  if (!displacement) return [];
  return [element("h3", {}, "Where most of the error lies"), element("p", {}, coreText(displacement.core) ?? "No small part of the body is certain to hold most of it."),
    element("h3", {}, "What to refine"), element("p", {}, halvingText(displacement)),
    element("p", { class: "note" }, `The distance in a cell, or in any union of cells, is its error to within ${measured(number(displacement.bound, 3), unit("energy_norm"))}, the bound of ours.`)];
}

function guaranteeSection({ displacement, stress, quantities, guaranteed_for: target, read_as: readAs }) {
  if (!displacement) return null;
  const list = (items) => element("ul", {}, items.filter(Boolean).map((item) => element("li", {}, item)));
  return section("guarantee", "Guarantee", "What is guaranteed, and what not", null, element("div", { class: "two-columns" },
    element("div", {}, element("h3", {}, "Guaranteed"), judgementFormula(), element("p", {}, `The error is measured against ${target}. Their solution is that which was read, as: ${readAs}.`), list([
      "the error of their displacement, as a whole and in every union of cells", stress ? "the error of their stress, likewise" : null,
      "the part of the squared error in its core", quantities.some(({ lower }) => lower !== null) ? "the interval of each exact number" : null])),
    element("div", {}, element("h3", {}, "Not guaranteed"), list([
      "rigid motions, which the energy does not see: below they are those between theirs and ours",
      "what their program finds on a mesh refined in the marked cells",
      "the colours of ours, which are those of the computed solution"]))));
}

/** The forces of their stress on the body, where it was read, beside those in equilibrium. */
function forcesSection({ forces, d }) {
  const known = forces.filter(({ ours }) => ours.length > 0);
  if (known.length === 0) return null;
  const first = showsMeridian() ? 1 : 0; // around the axis only the axial forces do not cancel
  const axes = axisNames(d).slice(first);
  const size = known.flatMap(({ theirs, ours }) => [...theirs, ...ours]).reduce((largest, value) => Math.max(largest, Math.abs(value)), 0);
  const cells = (force) => withoutNoise(force.slice(first), size).map((value) => number(value, 5));
  const heads = (whose) => axes.map((axis) => headed(`#${whose}, ${axis}`, unit("force")));
  return section("forces", "Forces", "Forces of their stress", "On the body at each boundary; those of ours are in equilibrium with all loads.",
    table(["boundary", ...heads("theirs"), ...heads("in equilibrium")], known.map(({ boundary, theirs, ours }) => [boundary, ...cells(theirs), ...cells(ours)])));
}

function rigidTable({ rigid_difference: rigid }) {
  if (rigid.length === 0) return null;
  return [element("h3", {}, "Rigid motions between theirs and ours"),
    table(["body", "translation", "rotation [rad]"], rigid.map(({ body, translation, rotation }) => [String(body + 1), measured(placeText(translation), unit("length")), placeText(rotation)]))];
}

function readSection(judgement) {
  const { solution, curved_distance: curved, load_step: step, factor } = judgement;
  const length = (value) => measured(number(value, 2), unit("length"));
  return section("read", "Read", "How it was read", null, definitions([["File", solution.file], ["It is", solution.description], ["Read as", judgement.read_as],
    ["Mesh", `${count(solution.cells)} cells of the mesh of the case, nodes ${judgement.node_distance > 0 ? `up to ${length(judgement.node_distance)} from` : "at"} their places`],
    ["Curved edges", curved > 0 ? `up to ${length(curved)} from the straight ones` : null],
    ["Load step", step === null ? null : String(step)],
    ["Factor", factor ? `times ${number(factor, 5)} their displacement is the nearest to ours in the energy norm` : null]]), rigidTable(judgement));
}

/** The files of theirs, each once. */
const readFiles = (steps) => [...new Map(steps.map(({ solution }) => [solution.file, solution])).values()];

/** `of_steps`: of all load steps, where these were judged; `judgement` is then that of the worst. */
export function judgementPage({ judgement, of_steps: ofSteps, program, machine, files, surfaces }) {
  nameUnits(judgement.units);
  nameAxes(judgement.model);
  const fields = comparisonSection(surfaces, judgement, wordsOfCells(judgement));
  const sections = [stepsSection(ofSteps), fields.element, errorsSection(judgement), judgedNumbersSection(judgement), forcesSection(judgement), guaranteeSection(judgement), readSection(judgement),
    section("times", "Machine", "The machine", null, timesAndMachine({}, machine, program), hashes("judgement.json", null, readFiles(ofSteps?.steps ?? [judgement]))), filesSection(files)].filter(Boolean);
  return { title: `${judgement.title || judgement.file}, judged`, purpose: "This report documents how wrong the solution of another program is, with a guarantee.",
    header: judgementHeader({ judgement, ofSteps, program, machine }), sections, start: fields.start, machine, program };
}
