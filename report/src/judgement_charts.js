// The guaranteed intervals of a judgement as bars.

import * as Plot from "@observablehq/plot";
import { chartStyle, legend, responsive } from "./charts.js";
import { element, number, powerOfTen, section, table } from "./dom.js";
import { wrongText } from "./judgement_words.js";
import { typeset } from "./math.js";
import { headed, quantityUnit, unit } from "./units.js";

const ofInterval = "#0072b2";
const ofTheirs = "#d55e00";
const row = 40; // pixels

/** Bars { name, low, high }, one below another; where `high` is null, to the end of the axis. `text(value)`: beside them. */
function intervalChart({ title, name, label, bars, text }) {
  const ends = bars.flatMap(({ low, high }) => [low, high ?? 1.5 * low]);
  const end = 1.02 * Math.max(...ends, Number.MIN_VALUE);
  const drawn = bars.map((bar) => ({ ...bar, end: bar.high ?? end, words: bar.high === null ? `at least ${text(bar.low)}` : `${text(bar.low)} to ${text(bar.high)}` }));
  const chart = responsive(title, (width) => Plot.plot({
    width, height: 60 + row * bars.length, marginLeft: 16, marginRight: 18, marginTop: 10, marginBottom: 42, style: chartStyle,
    x: { label, grid: true, domain: [0, end], ticks: Math.max(3, width / 110) }, y: { type: "band", axis: null, domain: bars.map((bar) => bar.name) },
    marks: [Plot.ruleX([0]),
      Plot.barX(drawn, { x1: "low", x2: "end", y: "name", insetTop: 20, insetBottom: 7, fill: ofInterval, stroke: ofInterval, strokeWidth: 2 }),
      Plot.text(drawn, { x: 0, y: "name", dx: 5, dy: -9, textAnchor: "start", fill: "currentColor", stroke: "var(--panel)", strokeWidth: 3,
        text: (d) => `${d.name}: ${d.words}`, lineWidth: (width - 30) / 12, textOverflow: "ellipsis-middle" })],
  }), { share: 0.47, name, rows: () => bars.map((bar) => ({ of: bar.name, lower: bar.low, upper: bar.high })) });
  return element("figure", {}, element("h3", {}, title), chart);
}

function relativeChart({ displacement, stress }) {
  const bars = [["displacement", displacement], ["stress", stress]].filter(([, field]) => field?.relative)
    .map(([name, { relative: [low, high] }]) => ({ name, low: 100 * low, high: high === null ? null : 100 * high }));
  return bars.length > 0 ? intervalChart({ title: "Relative error", name: "relative_error", label: "error [%]", bars, text: (value) => `${number(value, 4)}\u00a0%` }) : null;
}

/** Of the whole body, and of its regions where there are several. */
function absoluteChart({ displacement, stress }) {
  const parts = [["displacement", displacement], ["stress", stress]].filter(([, field]) => field).flatMap(([name, field]) => [
    { name, error: field.error }, ...(field.regions.length > 1 ? field.regions.map((region) => ({ name: `${name} in \u201c${region.name}\u201d`, error: region.error })) : [])]);
  const scale = powerOfTen(parts.flatMap(({ error }) => error.filter((value) => value !== null)));
  const scaled = (value) => (value === null ? null : value / scale.factor);
  return intervalChart({ title: "Error in the energy norm", name: "absolute_error", label: headed("error", unit("energy_norm"), scale), text: (value) => number(value, 4),
    bars: parts.map(({ name, error: [low, high] }) => ({ name, low: scaled(low), high: scaled(high) })) });
}

export function errorsSection({ displacement, stress, guaranteed_for: target }) {
  if (!displacement) return null;
  return section("errors", "Errors", "How wrong their solution is",
    `Each error is certain to lie within its bar: of the displacement in the energy norm, of the stress in the norm of the energy of stresses, against ${target}.`,
    element("div", { class: "two-columns panels" }, relativeChart({ displacement, stress }), absoluteChart({ displacement, stress })));
}

/** The interval of a quantity, with theirs as a tick. */
function quantityChart({ name, theirs, lower, upper, exact }) {
  const values = [lower, upper, theirs].filter((value) => value !== null);
  const scale = powerOfTen(values);
  const [low, high, tick] = [lower, upper, theirs].map((value) => (value === null ? null : value / scale.factor));
  const size = Math.max(...values) / scale.factor - Math.min(...values) / scale.factor || Math.abs(low) || 1;
  const domain = [Math.min(...values) / scale.factor - 0.15 * size, Math.max(...values) / scale.factor + 0.15 * size];
  const chart = responsive(`${name}: theirs beside the interval of the exact one`, (width) => Plot.plot({
    width, height: 88, marginLeft: 18, marginRight: 18, marginTop: 8, marginBottom: 40, style: chartStyle,
    x: { label: headed("value", quantityUnit(name), scale), domain, grid: true, ticks: Math.max(3, width / 110) }, y: { axis: null, domain: [0, 1] },
    marks: [Plot.rect([0], { x1: low, x2: high, y1: 0.2, y2: 0.8, fill: ofInterval, stroke: ofInterval, strokeWidth: 2 }),
      tick === null ? null : Plot.ruleX([tick], { stroke: ofTheirs, strokeWidth: 3 })],
  }), { share: 0.47, name: `judged_${name.replaceAll(/\W+/g, "_")}`, rows: () => [{ name, theirs, lower, upper }] });
  return element("figure", {}, element("h3", {}, name), chart, exact ? element("p", { class: "note" }, "Exact from statics.") : null);
}

export function judgedNumbersSection({ quantities }) {
  if (quantities.length === 0) return null;
  const rows = quantities.map((quantity) => [headed(quantity.name, quantityUnit(quantity.name)), number(quantity.theirs, 6), number(quantity.lower, 6), number(quantity.upper, 6),
    quantity.wrong_by ? wrongText(quantity) : quantity.reason ? typeset(`not judged: ${quantity.reason}`) : `theirs is not known: --number ${quantity.name}=VALUE`, quantity.rests_on ?? ""]);
  const charts = quantities.filter(({ lower }) => lower !== null).map(quantityChart);
  return section("numbers", "Numbers", "Their numbers beside the exact ones", "The exact number is certain to lie between the ends.",
    table(["quantity", "#theirs", "#exact, from", "#to", "wrong by", "rests on"], rows, { class: "long" }),
    charts.length > 0 ? [element("div", { class: "two-columns panels" }, charts),
      legend([{ name: "interval of the exact number", colour: ofInterval }, { name: "theirs", colour: ofTheirs }])] : null);
}
