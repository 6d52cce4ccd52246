// The components of the bound: on the last level, and over the levels.

import * as Plot from "@observablehq/plot";
import { chartStyle, legend, responsive } from "./charts.js";
import { shares } from "./components.js";
import { element, number, percent, section, table } from "./dom.js";
import { boundFormula } from "./math.js";
import { headed, unit } from "./units.js";

/** The components of the last level with bars. */
function componentTable(run, components) {
  const part = shares(components, run.components);
  const all = components.map((component, i) => ({ ...component, share: part[i] }));
  const isRoundOff = ({ name }) => run.components[name] <= roundOff * run.bound;
  const rows = all.filter((component) => !isRoundOff(component)).map(({ name, meaning, colour, share }) => [
    element("span", { class: "component" }, element("span", { class: "swatch", style: `--colour:${colour}` }), name), meaning,
    number(run.components[name]),
    element("span", { class: "share" }, element("span", { class: "share-bar", style: `--share:${share};--colour:${colour}` }),
      `${(100 * share).toFixed(1)}\u00a0%`)]);
  const hidden = all.filter(isRoundOff).map(({ name, meaning }) => `${name} (${meaning})`);
  return [table(["component", "what it measures", headed("#value", unit("stress_norm")), "#share of squares"], rows, { class: "components" }),
    hidden.length > 0 ? element("p", { class: "note" }, `Zero, or round-off: ${hidden.join(", ")}.`) : null];
}

// Below this part of the bound a component is round-off.
const roundOff = 1e-9;

function shareChart(levels, components) {
  const rows = levels.flatMap((level) => shares(components, level.components).map((share, i) =>
    ({ level: level.level, share, name: components[i].name, meaning: components[i].meaning })));
  const present = components.filter(({ name }) => rows.some((row) => row.name === name && row.share > 5e-4));
  return [responsive("Shares of the components of the bound over the levels", (width, onPaper) => Plot.plot({
    width, height: onPaper ? 135 : 270, marginLeft: 46, marginTop: 26, marginBottom: 36, style: chartStyle,
    x: { label: "level", tickFormat: (d) => String(d), ticks: levels.length > 20 ? 10 : undefined },
    y: { label: "share of the sum of squares [%]", percent: true, grid: true, domain: [0, 100], ticks: 5 },
    color: { domain: components.map(({ name }) => name), range: components.map(({ colour }) => colour) },
    marks: [
      Plot.barY(rows, { x: "level", y: "share", fill: "name", insetLeft: 1, insetRight: 1,
        order: components.map(({ name }) => name),
        title: (d) => `level ${d.level}\n${d.name}: ${d.meaning}\n${percent(d.share)}`, tip: true }),
      Plot.ruleY([0])],
  }), { name: "shares", rows: () => rows.map(({ level, name, share }) => ({ level, component: name, share })) }), legend(present.map(({ name, colour, meaning }) => ({ name, colour, title: meaning })))];
}

export function boundSection(run, components) {
  if (run.bound === null || run.bound === undefined) return null;
  const levels = run.levels.filter((level) => level.bound !== null);
  return section("bound", "Bound", "The bound and its causes",
    `The bound is the root of a sum over all cells${run.components.quad > 0 ? " and, as loads jump along curves, quad" : ""}`
      + `${run.components.alg > roundOff * run.bound ? " and, as the linear solver ends early, alg" : ""}; `
      + "each component measures one cause of the error. Shares are those of the squares, which add up.",
    boundFormula(components, run.components),
    element("div", { class: "two-columns" },
      element("div", {}, componentTable(run, components)),
      levels.length > 1 ? element("figure", {}, shareChart(levels, components), element("figcaption", {}, "Shares over the levels of adaptation.")) : null));
}
