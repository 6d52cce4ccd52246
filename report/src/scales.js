// Colour scales, perceptually uniform and safe for colour-blind people, and their legends.

import { interpolateRgb, interpolateViridis, piecewise, scaleLinear, scaleLog } from "d3";
import { element, number } from "./dom.js";
import { statusColours, statusNames } from "./components.js";

// Blue to orange through a light grey: distinguishable for everybody.
const diverging = piecewise(interpolateRgb, ["#1f4e8c", "#5b8fc7", "#b3cde3", "#f2f2ef", "#f6c48f", "#d9822b", "#8f4a0b"]);
const judged = ["#9aa3ad", "#e69f00", "#d55e00"];
const categories = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#6b7580"];

/** Whether the values are numbers of names. */
export const isNamed = (kind) => kind === "category" || kind === "judged";

/** The colour at s in [0, 1] for a kind of field. */
export function colours(kind, range) {
  if (kind === "diverging") return diverging;
  if (kind === "status") return (s) => statusColours[Math.round(3 * s)];
  if (isNamed(kind)) {
    const n = Math.max(1, Math.round(range.high - range.low));
    const list = kind === "judged" ? judged : categories;
    return (s) => list[Math.round(s * n) % list.length];
  }
  return interpolateViridis;
}

/** The value on the colour scale of a field: log10 for logarithmic ones. */
export function onScale(kind, value, range) {
  return kind === "logarithmic" ? Math.log10(Math.max(value, range.low)) : value;
}

function listLegend(names, colourOf) {
  return element("ul", { class: "legend legend-column" }, names.map((name, i) =>
    element("li", {}, element("span", { class: "swatch", style: `--colour:${colourOf(i)}` }), name)));
}

/** The names of the states in the legend of contact; tied only where present. */
export function shownStates(present) {
  return statusNames.filter((_, i) => i < 3 || present.includes(i));
}

function ticksOf(kind, range) {
  if (kind !== "logarithmic") {
    const ticks = scaleLinear([range.low, range.high], [1, 0]).ticks(6);
    const step = ticks.length > 1 ? ticks[1] - ticks[0] : Math.abs(ticks[0]) || 1;
    const digits = Math.max(1, Math.min(6, Math.ceil(Math.log10(Math.max(...ticks.map(Math.abs), step) / step)) + 1));
    return ticks.map((value) => ({ value, label: number(Math.abs(value) < 1e-9 * step ? 0 : value, digits), place: (range.high - value) / (range.high - range.low) }));
  }
  const scale = scaleLog([range.low, range.high], [1, 0]);
  const powers = scale.ticks().filter((value) => Number.isInteger(Number(Math.log10(value).toFixed(9))));
  const values = powers.length > 1 ? powers : [range.low, range.high];
  return values.map((value) => ({ value, label: number(value, 2), place: scale(value) }));
}

/** `names`: of the categories. */
export function fieldLegend(field, range, names) {
  const title = element("p", { class: "legend-title" }, field.label, field.unit ? element("span", {}, ` [${field.unit}]`) : null);
  const colour = colours(field.kind, range);
  if (field.kind === "status") return element("div", {}, title, listLegend(shownStates(range.present), (i) => colour(i / 3)));
  if (isNamed(field.kind))
    return element("div", {}, title, listLegend(names.slice(range.low, Math.floor(range.high) + 1), (i) => colour(i / Math.max(1, range.high - range.low))));
  const stops = Array.from({ length: 33 }, (_, i) => colour(1 - i / 32)).join(",");
  return element("div", { class: "colourbar-box" }, title,
    element("div", { class: "colourbar" }, element("div", { class: "colourbar-colours", style: `background:linear-gradient(${stops})` }),
      element("div", { class: "colourbar-ticks" }, ticksOf(field.kind, range).map(({ label, place }) =>
        element("span", { style: `top:${(100 * place).toFixed(2)}%` }, label)))),
    range.largest > range.high * (1 + 1e-9) ? element("p", { class: "note" }, `largest value ${number(range.largest, 3)}`) : null);
}
