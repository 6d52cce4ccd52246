// The convergence of a run: the bound, its components, and true errors where they are known.

import { legend, logLogChart, logRange, slope } from "./charts.js";
import { element, number, section } from "./dom.js";

// Drawn over the bound, which may nearly coincide with them.
const trueErrors = [
  { key: "dual_norm", name: "dual norm of the residual", colour: "#8a94a0", dash: "2 3" },
  { key: "stress_error", name: "true error of the stress", colour: "#4fc38a", dash: "7 4" },
];

/** The curves of levels, relative to the norm of the stress; components at rounding level are omitted. */
export function boundCurves(levels, components) {
  const curve = (style, value) => ({ ...style, points: levels
    .map((level) => ({ x: level.dofs, y: value(level) / (level.largest_sigma ?? level.sigma_norm), level: level.level }))
    .filter(({ y }) => y > 0 && Number.isFinite(y)) });
  const bound = curve({ name: "bound", colour: "currentColor", strokeWidth: 2.75, isBound: true }, (level) => level.bound);
  const floor = Math.min(...bound.points.map(({ y }) => y)) * 1e-3;
  const parts = components.map(({ name, colour, meaning }) =>
    curve({ name, colour, meaning, strokeWidth: 1.25 }, (level) => level.components[name] ?? 0));
  const energy = { name: "bound of the error in the energy norm, relative to that", colour: "#b07ad9", dash: "5 2", strokeWidth: 2, isEnergy: true,
    points: levels.filter((level) => level.energy_error?.relative > 0).map((level) => ({ x: level.dofs, y: level.energy_error.relative, level: level.level })) };
  const errors = trueErrors.map(({ key, ...style }) => curve({ ...style, strokeWidth: 1.75, isError: true }, (level) => level[key]));
  return [...parts, energy, bound, ...errors].map((line) => ({ ...line, points: line.points.filter(({ y }) => y >= floor) }))
    .filter(({ points }) => points.length > 0);
}

/** The bound, the errors and the components as legend entries. */
export function curveLegend(lines, kind) {
  const rank = ({ isBound, isEnergy, isError }) => (isBound ? 0 : isEnergy || isError ? 1 : 2);
  return legend([...lines].sort((a, b) => rank(a) - rank(b)).map((line) =>
    ({ ...line, name: line.meaning ? `${line.name}: ${line.meaning}` : line.name, line: true })), kind);
}

export const valuesOf = (lines) => lines.flatMap(({ points }) => points.map(({ y }) => y));

function convergenceChart(run, levels, components) {
  const lines = boundCurves(levels, components);
  const { points } = lines.find(({ isBound }) => isBound);
  const last = points.slice(Math.min(Math.floor(points.length / 2), Math.max(0, points.length - 3)));
  const rate = run.p / run.d;
  const isKnown = lines.some(({ isError }) => isError);
  return element("div", { class: "chart-and-words" },
    logLogChart({ label: "Convergence of the bound and its components over the degrees of freedom",
      yLabel: "relative to the norm of the stress [%]", lines, range: logRange([run.tolerance, ...valuesOf(lines)]), name: "convergence",
      reference: { points, rate }, tolerance: run.tolerance }),
    element("div", {}, curveLegend(lines, "legend-column"), element("p", { class: "note" },
      `Over the last ${last.length} levels the bound falls with the slope ${number(slope(last), 3)} in the degrees of freedom; `
      + `the best rate of degree ${run.p} in ${run.d}D is \u2212${number(rate, 2)}.`
      + (isKnown ? "" : " The true error is not known to a single run; tribound study measures it."))));
}

export function convergenceSection(run, components) {
  const levels = run.levels.filter((level) => level.bound > 0 && level.sigma_norm > 0);
  if (levels.length < 2) return null;
  return section("convergence", "Convergence", "Convergence", null, element("figure", {}, convergenceChart(run, levels, components)));
}
