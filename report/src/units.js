// The units named by a case, as labels; without them numbers have none. A page shows one case.

import { superscript } from "./dom.js";

let labels = null;

/** `units` of the certificate or the study: the label of each kind of number, null where the case names none. */
export function nameUnits(units) {
  labels = units ?? null;
}

/** mm^2 as mm², MPa mm^(3/2) as MPa mm¹·⁵ */
function typesetUnit(label) {
  return label.replace(/\^\((\d)\/2\)/g, (_, halves) => superscript(halves / 2)).replace(/\^(\d)/g, (_, exponent) => superscript(exponent));
}

/** The unit of a kind of number: "MPa" of "stress"; empty: none is named. */
export function unit(what) {
  return labels?.[what] ? typesetUnit(labels[what]) : "";
}

/** The unit of a [[quantity]], by its name. */
export function quantityUnit(name) {
  return labels?.quantities[name] ? typesetUnit(labels.quantities[name]) : "";
}

/** A number as text followed by its unit, if there is one. */
export function measured(text, label) {
  return label ? `${text} ${label}` : text;
}

/** "gap [mm]", or "gap" without a unit. `scale`: the factor extracted from the numbers by powerOfTen(): "gap [10⁻³ mm]". */
export function headed(name, label, scale) {
  const shown = scale ? scale.unit(label).trim() : label;
  return shown ? `${name} [${shown}]` : name;
}
