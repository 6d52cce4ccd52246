// The charts of a study, over the degrees of freedom: bound and error, effectivities, components.

import * as Plot from "@observablehq/plot";
import { chartStyle, curveMarks, curveRows, dofAxis, legend, logLogChart, logRange, responsive } from "./charts.js";
import { boundCurves, curveLegend, valuesOf } from "./convergence.js";
import { element, fixed, number, section } from "./dom.js";
import { curveOf, levelsOf, variantsOf } from "./variants.js";

const share = 0.47; // of the width of paper, for charts side by side
const panelHeight = (width) => Math.max(280, 0.72 * width);

/** Charts side by side with their titles. */
function panels(charts) {
  return element("div", { class: "two-columns panels" }, charts.map(({ title, chart }) =>
    element("figure", {}, element("h3", {}, title), chart)));
}

/** The curves of all variants in the order of drawing. */
const known = (study, key) => variantsOf(study).sort((a, b) => a.order - b.order).map((variant) => curveOf(variant, key))
  .filter(({ points }) => points.length > 0);
const variantLegend = (study) => legend(variantsOf(study).map((variant) => ({ ...variant, line: true })));

/** "adaptive -1.00; uniform -0.38": fitted over the last half of the levels. */
function slopesText(study, kind) {
  const fitted = variantsOf(study).filter(({ rates }) => rates[kind] !== null);
  return fitted.length === 0 ? "Too few levels for a slope."
    : `Fitted slopes: ${fitted.map(({ name, rates }) => `${name} ${fixed(rates[kind])}`).join("; ")}.`;
}

/** The points of the curve that ends lowest. */
const lowestCurve = (lines) => lines.map(({ points }) => points).reduce((a, b) => (b.at(-1).y < a.at(-1).y ? b : a));

export function convergenceSection(study) {
  const quantities = [
    { key: "relative", kind: "bound", title: "Bound", yLabel: "relative to the norm of the stress [%]" },
    { key: "relative_error", kind: "error", title: "Error in the energy norm", yLabel: "relative to the energy norm [%]" },
  ].map((quantity) => ({ ...quantity, lines: known(study, quantity.key) })).filter(({ lines }) => lines.length > 0);
  if (quantities.length === 0) return null;
  const range = logRange(quantities.flatMap(({ lines }) => valuesOf(lines)));
  const rate = study.p / study.d;
  return section("convergence", "Convergence", "Convergence of bound and error",
    `The best rate of degree ${study.p} in ${study.d}D is the slope \u2212${number(rate, 2)}, dashed.`,
    panels(quantities.map(({ kind, title, yLabel, lines }) => ({ title, chart: [
      logLogChart({ label: `${title} of the variants over the degrees of freedom`, yLabel, lines, range, height: panelHeight,
        reference: { points: lowestCurve(lines), rate }, share }),
      element("p", { class: "note" }, slopesText(study, kind))] }))),
    variantLegend(study));
}

/** Quotients that the guarantee requires to be at least 1. */
function quotientChart(label, lines, [low, high]) {
  return responsive(label, (width) => Plot.plot({
    width, height: Math.max(240, 0.55 * width), marginLeft: 58, marginRight: 18, marginTop: 28, marginBottom: 44, style: chartStyle,
    x: dofAxis(lines, width), y: { label: "quotient", grid: true, ticks: 6, domain: [Math.min(low, 0.95), Math.max(high, 1.2)], nice: true },
    marks: [Plot.ruleY([1], { stroke: "currentColor", strokeWidth: 1.25 }), curveMarks(lines, (y) => number(y, 4))],
  }), { share, name: "effectivity", rows: () => curveRows(lines) });
}

export function effectivitySection(study) {
  const quotients = [
    { key: "effectivity", title: "Bound / dual norm of the residual", note: "At least 1, by the theorem." },
    { key: "energy_effectivity", title: "Bound / error, in the energy norm", note: "Both against the reference solution; at least 1 but for what that one lacks." },
    { key: "effectivity_stress", title: "Bound / error of the stress", note: "For comparison with other methods; no theorem says that it is at least 1." },
  ].map((quotient) => ({ ...quotient, lines: known(study, quotient.key) })).filter(({ lines }) => lines.length > 0);
  if (quotients.length === 0) return null;
  const values = quotients.flatMap(({ lines }) => valuesOf(lines));
  const range = [Math.min(...values), Math.max(...values)];
  return section("effectivity", "Effectivity", "How much larger than the error the bound is",
    "The dual norm of the residual is computed from below in a much richer space; where that would be too large it is not known.",
    panels(quotients.map(({ title, note, lines }) => ({ title, chart: [quotientChart(title, lines, range), element("p", { class: "note" }, note)] }))), variantLegend(study));
}

export function componentsSection(study, components) {
  const variants = variantsOf(study).filter(({ key }) => !key.endsWith("_converged"))
    .map((variant) => ({ name: variant.name, lines: boundCurves(levelsOf(variant), components) })).filter(({ lines }) => lines.length > 0);
  if (variants.length === 0) return null;
  const all = variants.flatMap(({ lines }) => lines);
  const range = logRange(valuesOf(all));
  const once = all.filter(({ name }, i) => all.findIndex((line) => line.name === name) === i);
  return section("components", "Components", "The causes of the error",
    "The components of the bound, with Newton\u2019s method stopped by the bound. What is below a thousandth of the smallest bound is not drawn.",
    panels(variants.map(({ name, lines }) => ({ title: `Meshes: ${name}`, chart: logLogChart({
      label: `Components of the bound, ${name}`, yLabel: "relative to the norm of the stress [%]", lines, range, height: panelHeight, share }) }))),
    curveLegend(once));
}
