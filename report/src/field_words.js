// Texts of the picture of the fields, and the scale factor of displacements.

import { statusNames } from "./components.js";
import { count, number } from "./dom.js";
import { isNamed } from "./scales.js";
import { measured, unit } from "./units.js";

/** 1, 2 or 5 times a power of ten, not above x. */
function roundedDown(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [5, 2, 1].find((digit) => digit * power <= x * (1 + 1e-9)) * power;
}

/** The amplification that makes the largest displacement a tenth of the body, 1 where it is not small. */
export function usualFactor({ largestDisplacement, box }) {
  if (largestDisplacement === 0) return 1;
  const factor = (0.1 * box.diagonal) / largestDisplacement;
  return factor < 1.5 ? 1 : roundedDown(factor);
}

/** Text below the picture: which part of the mesh is shown, and how. */
export function noteText(surface, { factor, explosion }, { isCut, isInside, isSlow, stage, nLeftOut }) {
  return [
    isSlow ? "This browser has no WebGL: the page draws the picture itself, more slowly." : "",
    surface.words ?? "",
    surface.dimension === 3 && !isCut && !surface.words ? `Shown is the surface of the ${surface.nBodies > 1 ? "bodies" : "body"}.` : "",
    !isCut ? "" : isInside ? "On the section values are averages at the vertices of the mesh." : "The page does not have the inside of this mesh.",
    surface.merged_below > 0 ? `The mesh is too large for this page: details below ${measured(number(surface.merged_below, 2), unit("length"))} are merged, ${count(surface.nFaces)} triangles are shown.` : "",
    nLeftOut > 0 ? `${nLeftOut === 1 ? `One of the ${stage}s in between is` : `${nLeftOut} of the ${stage}s in between are`} left out to keep the page small.` : "",
    surface.nBodies > 1 && explosion > 0 ? "Bodies are drawn apart." : "",
    `Displacements are drawn ${factor === 1 ? "at true scale" : `${number(factor, 3)} times as large`}.`].filter(Boolean).join(" ");
}

/** The value of a field under the pointer; null where it has none there. `names`: of the categories. */
export function valueText(field, value, names) {
  if (value === null) return field.contact ? "not on the contact boundary" : "known on the surface only";
  if (field.kind === "status") return statusNames[Math.round(value)];
  return isNamed(field.kind) ? names[Math.round(value)] : measured(number(value, 4), field.unit);
}
