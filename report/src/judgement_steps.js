// The load steps that were judged, one row each.

import { number, section, table } from "./dom.js";
import { relativeText, absoluteText, wrongText } from "./judgement_words.js";
import { typeset } from "./math.js";
import { unit } from "./units.js";

function errorCell(field) {
  if (!field) return "\u2013";
  return field.relative ? relativeText(field.relative) : absoluteText(field.error, unit("energy_norm"));
}

const wrongCell = (quantity) => (quantity.wrong_by ? wrongText(quantity) : "\u2013");

/** `ofSteps`: of judgement.json; absent where one step was judged. */
export function stepsSection(ofSteps) {
  if (!ofSteps) return null;
  const { steps, worst } = ofSteps;
  const names = steps[0].quantities.map(({ name }) => name);
  const hasStress = steps.some(({ stress }) => stress);
  const rows = steps.map((step, i) => [String(i + 1), number(step.t), step.displacement ? errorCell(step.displacement) : typeset(`no bound: ${step.reason}`),
    ...(hasStress ? [errorCell(step.stress)] : []), ...step.quantities.map(wrongCell), step.status]);
  return section("steps", "Load steps", "All load steps", `What follows is of step ${worst}, whose error may be the largest.`,
    table(["#step", "#t", "error of the displacement", ...(hasStress ? ["error of the stress"] : []), ...names.map((name) => `${name}: wrong by`), "status"], rows, { class: "long" }));
}
