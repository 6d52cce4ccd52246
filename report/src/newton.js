// Newton's method, step by step.

import { count, element, number, percent, seconds, section, table, withoutNoise } from "./dom.js";
import { stagesOf } from "./stages.js";

const mostPrinted = 80; // steps on paper

/**
 * The sum of the components in a row, or null if one is unknown: a step in 3D whose linearisation part alone is too large has no
 * other components, as its bound was not completed.
 */
function sumOf(components, row) {
  const values = components.map(({ name }) => row?.[name] ?? null);
  return values.includes(null) ? null : values.reduce((a, b) => a + b, 0);
}

function stepCells(level, step, row, components, isFirst) {
  const isLinearisation = ({ cause }) => cause === "linearisation";
  const sum = sumOf(components.filter(isLinearisation), row);
  const lin = sum !== null && step.total !== null ? withoutNoise([sum], step.total)[0] : sum;
  const rest = sumOf(components.filter((component) => !isLinearisation(component)), row);
  const cells = [isFirst ? String(level.level) : "", String(step.step), number(step.residual, 3), number(step.damping, 3),
    number(step.total), number(lin, 3), lin === null || rest === null ? "\u2013" : percent(lin / rest),
    step.linear_iterations === 0 ? "direct" : String(step.linear_iterations), seconds(step.seconds), step.accepted ? "accepted" : ""];
  cells.class = [step.accepted ? "accepted" : "", isFirst ? "group" : ""].join(" ").trim() || null;
  return cells;
}

/** `rows`: those of newton.csv; an unknown number is null. */
export function newtonSection(run, rows, components) {
  const stages = stagesOf(run);
  const steps = stages.all.flatMap((level) => level.newton.map((step, i) => stepCells(level, step,
    rows.find((row) => (row.load_step ?? row.level) === level.level && row.step === step.step), components, i === 0)));
  if (steps.length === 0) return null;
  const body = table([`#${stages.name === "level" ? "level" : "load step"}`, "#step", "#residual", "#damping", "#bound, plain sums", "#linearisation", "#of the rest",
    "#linear iterations", "#time", ""], steps, { class: "newton long" });
  body.classList.add("table-tall");
  body.tabIndex = 0;
  const isLong = steps.length > mostPrinted;
  if (isLong) body.classList.add("screen-only");
  return section("newton", "Newton", "Newton\u2019s method",
    run.bound === null ? null : "The bound holds for every iterate. Iterating ends where the linearisation part is a small fraction of the rest: further steps would not make the solution better on this mesh.",
    body, isLong ? element("p", { class: "print-only" }, `newton.csv has the ${count(steps.length)} steps.`) : null);
}
