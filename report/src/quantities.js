// Quantities of the solution with intervals that are guaranteed to contain the exact values.

import * as Plot from "@observablehq/plot";
import { chartStyle, dofAxis, responsive } from "./charts.js";
import { element, number, powerOfTen, section, table } from "./dom.js";
import { typeset } from "./math.js";
import { headed, measured, quantityUnit } from "./units.js";

const colour = "#0072b2";

/** "between 1.63 and 1.66 N", or as much as is known. */
export function intervalText({ name, lower, upper, exact, reason }) {
  const unit = quantityUnit(name);
  if (reason || exact) return [unit, reason ? "no error bar" : "exact"].filter(Boolean).join(", ");
  return measured(`between ${number(lower, 5)} and ${number(upper, 5)}`, unit);
}

/** A quantity of each level with its bar, over the degrees of freedom. */
function barChart(name, levels) {
  const known = levels.map((level) => ({ dofs: level.dofs, level: level.level, ...level.quantities.find((quantity) => quantity.name === name) }))
    .filter(({ lower }) => typeof lower === "number");
  if (known.length < 2 || known.at(-1).exact) return null;
  const scale = powerOfTen(known.flatMap(({ lower, upper }) => [lower, upper]));
  const points = known.map((point) => ({ ...point, x: point.dofs, y: point.value / scale.factor, low: point.lower / scale.factor, high: point.upper / scale.factor }));
  const tip = (d) => `level ${d.level}: ${measured(number(d.value, 6), quantityUnit(name))}\n${intervalText(d)}\n${d.rests_on}`;
  return element("figure", {}, element("h3", {}, name), responsive(`${name} with its error bars over the degrees of freedom`, (width) => Plot.plot({
    width, height: Math.max(240, 0.55 * width), marginLeft: 62, marginRight: 18, marginTop: 28, marginBottom: 44, style: chartStyle,
    x: dofAxis([{ points }], width), y: { label: headed("value", quantityUnit(name), scale), grid: true, ticks: 6 },
    marks: [Plot.ruleX(points, { x: "x", y1: "low", y2: "high", stroke: colour, strokeWidth: 2 }),
      Plot.dot(points, { x: "x", y: "y", fill: colour, r: 3 }),
      Plot.tip(points, Plot.pointer({ x: "x", y: "y", title: tip }))],
  }), { share: 0.47, name: `quantity_${name.replaceAll(/\W+/g, "_")}`,
    rows: () => known.map(({ level, dofs, value, lower, upper }) => ({ level, dofs, value, lower, upper })) }));
}

export function quantitiesSection(run) {
  const { quantities } = run;
  if (!quantities || quantities.length === 0) return null;
  const levels = run.levels.filter((level) => level.quantities);
  const rows = quantities.map((quantity) => [headed(quantity.name, quantityUnit(quantity.name)), number(quantity.value, 6), quantity.reason ? "\u2013" : number(quantity.lower, 6),
    quantity.reason ? "\u2013" : number(quantity.upper, 6), quantity.reason ? typeset(quantity.reason) : [quantity.exact ? "exact: " : "", quantity.rests_on],
    quantity.note ? typeset(quantity.note) : ""]);
  const charts = quantities.map(({ name }) => barChart(name, levels)).filter(Boolean);
  const isConditional = run.energy_error?.guaranteed_for === "tresca_with_computed_threshold";
  return section("quantities", "Quantities", "Numbers with error bars",
    `The number of the exact solution${isConditional ? ", for the computed friction threshold," : ""} is certain to lie between the ends. The value is that of the computed solution.`,
    table(["quantity", "#value", "#lower end", "#upper end", "rests on", "note"], rows),
    charts.length > 0 ? element("div", { class: "two-columns panels" }, charts) : null);
}
