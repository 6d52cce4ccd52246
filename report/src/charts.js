// Charts of the bound: its components over the levels, and its convergence.

import * as Plot from "@observablehq/plot";
import { count, element, logTicks, number, percent, powerOfTen, section, table } from "./dom.js";
import { boundUnit, components, componentsOf, shares } from "./components.js";

/** A chart drawn anew by draw(width) whenever its place changes width. */
export function responsive(label, draw, minimum = 280) {
  const place = element("div", { class: "chart", role: "img", "aria-label": label });
  let width = 0;
  new ResizeObserver(([entry]) => {
    const available = Math.max(minimum, Math.floor(entry.contentRect.width));
    if (available === width || entry.contentRect.width === 0) return;
    width = available;
    place.replaceChildren(draw(width));
  }).observe(place);
  return place;
}

export const chartStyle = { fontSize: "12px", background: "none", overflow: "visible" };

function legend(items, kind = "") {
  return element("ul", { class: `legend ${kind}` }, items.map(({ name, colour, line, title }) =>
    element("li", { title }, element("span", { class: line ? "swatch swatch-line" : "swatch", style: `--colour:${colour}` }), name)));
}

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

/** Least-squares slope of log y over log x. */
export function slope(points) {
  const x = points.map((point) => Math.log(point.x));
  const y = points.map((point) => Math.log(point.y));
  const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
  const [mx, my] = [mean(x), mean(y)];
  const variance = x.reduce((sum, value) => sum + (value - mx) ** 2, 0);
  return variance > 0 ? x.reduce((sum, value, i) => sum + (value - mx) * (y[i] - my), 0) / variance : NaN;
}

/** The curves of the convergence plot: the bound, its components, and true errors where they are known. */
function curves(levels) {
  const curve = (name, colour, value, style) => ({ name, colour, ...style,
    points: levels.map((level) => ({ x: level.dofs, y: value(level) / level.sigma_norm, level: level.level, name }))
      .filter(({ y }) => y > 0 && Number.isFinite(y)) });
  const known = [["stress_error", "true error of the stress"], ["dual_norm", "dual norm of the residual"]]
    .filter(([key]) => levels.some((level) => level[key] > 0));
  return [
    ...components.map(({ name, colour, meaning }) =>
      curve(name, colour, (level) => level.components[name] ?? 0, { strokeWidth: 1.25, meaning })),
    ...known.map(([key, name], i) => curve(name, ["#009e73", "#e69f00"][i], (level) => level[key], { strokeWidth: 2, dash: "6 3" })),
    curve("bound", "currentColor", (level) => level.bound, { strokeWidth: 2.75 }),
  ].filter(({ points }) => points.length > 0);
}

/** A line of the slope -p/d below the last points of the bound. */
function referenceLine(points, rate) {
  const last = points.at(-1);
  const first = points[Math.max(0, Math.floor(points.length / 2) - 1)];
  return [first.x, last.x].map((x) => ({ x, y: 0.55 * last.y * (x / last.x) ** -rate }));
}

function convergenceChart(run, levels) {
  const lines = curves(levels);
  const bound = lines.at(-1).points;
  const top = Math.max(...lines.flatMap(({ points }) => points.map(({ y }) => y)));
  const floor = Math.min(...bound.map(({ y }) => y)) * 1e-3; // components that are round-off are not drawn
  const shown = lines.map((line) => ({ ...line, points: line.points.filter(({ y }) => y >= floor) }))
    .filter(({ points }) => points.length > 0);
  const lowest = Math.min(run.tolerance, ...shown.flatMap(({ points }) => points.map(({ y }) => y)));
  const last = bound.slice(Math.min(Math.floor(bound.length / 2), Math.max(0, bound.length - 3)));
  const measured = slope(last);
  const rate = run.p / run.d;
  const [low, high] = [100 * lowest * 0.6, 100 * Math.max(top, run.tolerance) * 1.4];
  const chart = responsive("Convergence of the bound and its components over the degrees of freedom", (width) => Plot.plot({
    width, height: Math.min(440, 0.66 * width), marginLeft: 58, marginRight: 64, marginTop: 28, marginBottom: 44, style: chartStyle,
    x: { type: "log", label: "degrees of freedom", grid: true, tickFormat: count,
      ticks: logTicks(bound[0].x, bound.at(-1).x, width < 500 ? 4 : 7) },
    y: { type: "log", label: "relative to the norm of the stress [%]", grid: true, tickFormat: powerOfTen, domain: [low, high],
      ticks: logTicks(low, high, 6) },
    marks: [
      Plot.ruleY([100 * run.tolerance], { stroke: "currentColor", strokeOpacity: 0.6, strokeDasharray: "2 3" }),
      Plot.text([100 * run.tolerance], { y: (d) => d, frameAnchor: "right", dx: 6, textAnchor: "start", fillOpacity: 0.75,
        text: () => "tolerance" }),
      Plot.line(referenceLine(bound, rate), { x: "x", y: (d) => 100 * d.y, stroke: "currentColor", strokeOpacity: 0.45, strokeDasharray: "6 4" }),
      Plot.text(referenceLine(bound, rate).slice(0, 1), { x: "x", y: (d) => 100 * d.y, dy: 13, dx: 2, textAnchor: "start", fillOpacity: 0.65,
        stroke: "var(--panel)", strokeWidth: 4, fill: "currentColor", text: () => `slope \u2212${number(rate, 2)}` }),
      ...shown.map((line) => Plot.line(line.points, { x: "x", y: (d) => 100 * d.y, stroke: line.colour,
        strokeWidth: line.strokeWidth, strokeDasharray: line.dash, marker: "circle" })),
      Plot.tip(shown.flatMap(({ points }) => points), Plot.pointer({ x: "x", y: (d) => 100 * d.y,
        title: (d) => `${d.name}, level ${d.level}\n${percent(d.y)}\n${count(d.x)} dofs` }))],
  }));
  const known = lines.filter(({ dash }) => dash);
  return element("div", { class: "chart-and-words" }, chart, element("div", {},
    legend([...shown].reverse().map(({ name, colour, meaning }) =>
      ({ name: meaning ? `${name}: ${meaning}` : name, colour, line: true })), "legend-column"),
    element("p", { class: "note" },
      `Over the last ${last.length} levels the bound falls with the slope ${number(measured, 3)} in the degrees of freedom; `
      + `the best rate of degree ${run.p} in ${run.d}D is \u2212${number(rate, 2)}.`
      + (known.length ? "" : " The true error is not known to a single run; tribound study measures it."))));
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

export function convergenceSection(run) {
  const levels = run.levels.filter((level) => level.bound !== null);
  if (levels.length < 2) return null;
  return section("convergence", "Convergence", "Convergence", null, element("figure", {}, convergenceChart(run, levels)));
}
