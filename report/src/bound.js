// The components of the bound: on the last level, and over the levels.

import * as Plot from "@observablehq/plot";
import { chartStyle, legend, responsive } from "./charts.js";
import { boundUnit, components, componentsOf, shares } from "./components.js";
import { element, number, percent, section, table } from "./dom.js";

/** The components of the last level with bars. */
function componentTable(run) {
  const part = shares(run.components);
  const rows = componentsOf(run).map(({ name, meaning, colour }, i) => [
    element("span", { class: "component" }, element("span", { class: "swatch", style: `--colour:${colour}` }), name), meaning,
    number(run.components[name]),
    element("span", { class: "share" }, element("span", { class: "share-bar", style: `--share:${part[i]};--colour:${colour}` }),
      `${(100 * part[i]).toFixed(1)}\u00a0%`)]);
  return table(["component", "what it measures", `#value [${boundUnit(run.d)}]`, "#share of squares"], rows, { class: "components" });
}

function shareChart(levels) {
  const rows = levels.flatMap((level) => shares(level.components).map((share, i) =>
    ({ level: level.level, share, name: components[i].name, meaning: components[i].meaning })));
  const present = components.filter(({ name }) => rows.some((row) => row.name === name && row.share > 5e-4));
  return [responsive("Shares of the components of the bound over the levels", (width) => Plot.plot({
    width, height: 270, marginLeft: 46, marginTop: 26, marginBottom: 36, style: chartStyle,
    x: { label: "level", tickFormat: (d) => String(d), ticks: levels.length > 20 ? 10 : undefined },
    y: { label: "share of the sum of squares [%]", percent: true, grid: true, domain: [0, 100], ticks: 5 },
    color: { domain: components.map(({ name }) => name), range: components.map(({ colour }) => colour) },
    marks: [
      Plot.barY(rows, { x: "level", y: "share", fill: "name", insetLeft: 1, insetRight: 1,
        order: components.map(({ name }) => name),
        title: (d) => `level ${d.level}\n${d.name}: ${d.meaning}\n${percent(d.share)}`, tip: true }),
      Plot.ruleY([0])],
  })), legend(present.map(({ name, colour, meaning }) => ({ name, colour, title: meaning })))];
}

export function boundSection(run) {
  if (run.bound === null || run.bound === undefined) return null;
  const levels = run.levels.filter((level) => level.bound !== null);
  return section("bound", "Bound", "The bound and its causes",
    "The bound is the root of a sum over all cells; each component measures one cause of the error. Shares are those of the squares, which add up.",
    element("div", { class: "two-columns" },
      element("div", {}, componentTable(run)),
      levels.length > 1 ? element("figure", {}, shareChart(levels), element("figcaption", {}, "Shares over the levels of adaptation.")) : null));
}
