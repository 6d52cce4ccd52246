// The result of a judgement in words and figures, as judgement.json has it.

import { element, number, percent, plural } from "./dom.js";
import { definitions } from "./facts.js";
import { measured, quantityUnit, unit } from "./units.js";
import { figure, kindOf, pageHeader, warningBox } from "./verdict.js";

const verdicts = {
  judged: { title: "Judged", mark: "\u2713", tone: "certified" },
  wide: { title: "Judged, within a wide interval", mark: "!", tone: "budget" },
  "no bound": { title: "Not judged", mark: "!", tone: "budget" },
  accepted: { title: "Accepted", mark: "\u2713", tone: "certified" },
  undecided: { title: "Undecided", mark: "!", tone: "budget" },
  rejected: { title: "Rejected", mark: "\u00d7", tone: "failed" },
};

/** "between 7.31 % and 7.9 %" */
function between([lower, upper], text) {
  return upper === null ? `at least ${text(lower)}` : `between ${text(lower)} and ${text(upper)}`;
}

export const relativeText = (interval) => between(interval, (value) => percent(value, 4));
export const absoluteText = (interval, label) => measured(between(interval, (value) => number(value, 6)), label);

export const placeText = (place) => `(${place.map((x) => number(x, 4)).join(", ")})`;

/** The error of a displacement or a stress: relative, where the size of the exact one is known, and absolute. */
export function errorText({ relative, error }) {
  const size = absoluteText(error, unit("energy_norm"));
  return relative ? `${relativeText(relative)}, ${size}` : size;
}

/** Whether a small part of the body is certain to hold much of the error. */
export const hasCore = ({ share }) => share >= 0.05;

/** Where most of the error lies; nothing where that is not certain. */
export function coreText({ share, volume, cells, centre }) {
  if (!hasCore({ share })) return null;
  return `At least ${Math.floor(100 * share)}\u00a0% of the squared error lies in ${percent(volume, 2)} of the body, ${plural(cells, "cell", "cells")}, around ${placeText(centre)}.`;
}

/** How wrong a number of theirs is; `size`: of the exact one. */
export function wrongText({ name, wrong_by: wrong, lower, upper }) {
  const size = Math.max(Math.abs(lower), Math.abs(upper));
  const text = measured(`${number(wrong[0], 3)} to ${number(wrong[1], 3)}`, quantityUnit(name));
  return size > 0 ? `${text}, ${percent(wrong[0] / size, 3)} to ${percent(wrong[1] / size, 3)}` : text;
}

function sentence(judgement) {
  const { status, displacement, accept, reason, guaranteed_for: target } = judgement;
  if (status === "no bound") return `The error of their solution is not bounded: ${reason}.`;
  const error = displacement.relative ? relativeText(displacement.relative) : absoluteText(displacement.error, unit("energy_norm"));
  const guaranteed = `The error of their displacement in the energy norm, against ${target}, is guaranteed to be ${error}.`;
  if (accept !== null) return `${guaranteed} At most ${percent(accept)} was to be accepted.`;
  if (status !== "wide") return guaranteed;
  const { bound, distance } = displacement;
  const size = bound > distance ? "larger than" : `${number(bound / distance, 3)} of`;
  return `${guaranteed} The bound of ours is ${size} the distance between both, `
    + `${number(judgement.sharpness)} was asked for: ${judgement.load_step === null ? "give [adapt] more levels, unknowns or time" : "a smaller adapt.tolerance makes it smaller"}.`;
}

function penetrationText({ penetration, penetrated }) {
  if (penetration === null) return null;
  if (penetration === 0) return "None at the points of contact.";
  return `Up to ${measured(number(penetration), unit("length"))}${penetrated ? ` on \u201c${penetrated}\u201d` : ""}.`;
}

/** What to refine, in words. */
export function halvingText({ halving_cells: cells }) {
  return `Refine the ${plural(cells, "cell", "cells")} that judged_cells.csv marks: without them at most half of the distance is left.`;
}

/** Whether the forces of their stress add up. */
function balanceText({ imbalance }) {
  return imbalance === null ? null : `The forces of their stress miss the loads by ${percent(imbalance, 4)}.`;
}

function stepText({ steps, worst }) {
  return `${plural(steps.length, "load step was", "load steps were")} judged. Step ${worst}, at t = ${number(steps[worst - 1].t)}, may have the largest error:`;
}

function verdictBody(judgement, ofSteps) {
  const { displacement, stress } = judgement;
  return [ofSteps && element("p", {}, stepText(ofSteps)), element("p", {}, sentence(judgement)), definitions([
    ["Displacement", displacement && errorText(displacement)],
    ["Stress", stress && errorText(stress)],
    ["Where", displacement && coreText(displacement.core)],
    ["To halve it", displacement && halvingText(displacement)],
    ["Balance", balanceText(judgement)],
    ["Penetration", penetrationText(judgement)]])];
}

function doubtBox({ doubt }) {
  return doubt ? warningBox({ warnings: [{ where: "", text: `Their displacement ${doubt}` }] }) : null;
}

const intervalFigure = ({ relative }, name) => (relative?.[1] == null ? null
  : figure(percent(relative[1]), `error of the ${name}, at most`, `at least ${percent(relative[0])}`));

function figures(judgement) {
  const { displacement, stress, quantities, penetration } = judgement;
  return element("div", { class: "figures" }, [
    displacement && intervalFigure(displacement, "displacement"),
    stress && intervalFigure(stress, "stress"),
    ...quantities.filter(({ wrong_by: wrong }) => wrong).slice(0, 3).map((quantity) =>
      figure(number(quantity.theirs, 5), quantity.name, `wrong by ${wrongText(quantity)}`)),
    penetration > 0 ? figure(number(penetration, 3), "largest penetration", unit("length")) : null].filter(Boolean));
}

export function judgementHeader({ judgement, ofSteps, program, machine }) {
  const verdict = verdicts[(ofSteps ?? judgement).status];
  const { file, description } = judgement.solution;
  return pageHeader({ program, machine, title: judgement.title, purpose: judgement.purpose, file: judgement.file,
    kind: `judgement of ${file} (${description}), ${kindOf(judgement)}`, verdict: { ...verdict, body: verdictBody(judgement, ofSteps) },
    warnings: doubtBox(judgement), figures: figures(judgement) });
}
