// Common parts of the charts: drawing at the available width, on paper too; legends; curves on logarithmic axes.

import * as Plot from "@observablehq/plot";
import { count, element, logTicks, number, percent, powerOfTen } from "./dom.js";
import { exportButtons } from "./export.js";
import { headed, measured } from "./units.js";

export const chartStyle = { fontSize: "12px", background: "none", overflow: "visible" };

const paperWidth = 680; // CSS pixels between the margins of A4 and of US letter
const charts = new Set();

function drawAll(onPaper) {
  for (const chart of charts) {
    const { place, width, share, draw } = chart;
    if (!place.isConnected) charts.delete(chart);
    else if (width > 0) place.replaceChildren(draw(onPaper ? Math.floor(share * paperWidth) : width, onPaper));
  }
}
addEventListener("beforeprint", () => drawAll(true));
addEventListener("afterprint", () => drawAll(false));

/**
 * A chart redrawn by draw(width, onPaper) whenever the width of its place changes. `share`: fraction of the width of paper;
 * `name`: of the files that a reader saves, with the table rows().
 */
export function responsive(label, draw, { minimum = 280, share = 1, name, rows } = {}) {
  const place = element("div", { class: "chart", role: "img", "aria-label": label });
  const chart = { place, draw, share, width: 0 };
  charts.add(chart);
  new ResizeObserver(([entry]) => {
    const available = Math.max(minimum, Math.floor(entry.contentRect.width));
    if (available === chart.width || entry.contentRect.width === 0) return;
    chart.width = available;
    place.replaceChildren(draw(available, false));
  }).observe(place);
  const curves = () => [...place.querySelectorAll(":scope > svg, :scope > div > svg")];
  return element("div", { class: "chart-box" }, place, exportButtons(name, curves, rows));
}

/** The line of a curve in a legend, dashed like the curve. */
function swatchLine({ colour, dash, strokeWidth }) {
  return element("svg:svg", { class: "swatch-curve", width: 24, height: 8, "aria-hidden": "true" },
    element("svg:line", { x1: 0, x2: 24, y1: 4, y2: 4, stroke: colour, "stroke-dasharray": dash, "stroke-width": strokeWidth }));
}

/** `items`: name, colour and, for a curve, `line`. */
export function legend(items, kind = "") {
  return element("ul", { class: `legend ${kind}` }, items.map((item) => element("li", { title: item.title },
    item.line ? swatchLine(item) : element("span", { class: "swatch", style: `--colour:${item.colour}` }), item.name)));
}

export const lineColours = ["#3d7edb", "#d9822b", "#4fc38a", "#b0569e", "#8a94a0", "#c2453d", "#2b9aa6"];

/**
 * A figure of lines { name, values } over `x`. place(k): in words where point k is; row(k): its columns in the table that a reader saves;
 * `groups`: of each point, lines are broken between them.
 */
export function lineChart({ title, name, xLabel, xUnit = "", x, yLabel, yUnit = "", lines, place, row, groups = [] }) {
  const scaleX = powerOfTen(x);
  const scaleY = powerOfTen(lines.flatMap(({ values }) => values));
  const drawn = lines.map(({ name: line, values }, i) => ({ name: line, colour: lineColours[i], points: values.map((y, k) =>
    ({ x: x[k] / scaleX.factor, y: y / scaleY.factor, k, name: line, group: groups[k] ?? "" })) }));
  const tip = (d) => `${lines.length > 1 ? `${d.name}, ` : ""}${place(d.k)}\n${measured(number(d.y * scaleY.factor, 5), yUnit)}`;
  const chart = responsive(title, (width) => Plot.plot({
    width, height: Math.max(240, 0.6 * width), marginLeft: 62, marginRight: 18, marginTop: 28, marginBottom: 44, style: chartStyle,
    x: { label: headed(xLabel, xUnit, scaleX), grid: true, ticks: 6 }, y: { label: headed(yLabel, yUnit, scaleY), grid: true, ticks: 6, zero: true },
    marks: [Plot.ruleY([0], { strokeOpacity: 0.5 }), ...drawn.flatMap(({ points, colour }) => [
      Plot.line(points, { x: "x", y: "y", z: "group", stroke: colour, strokeWidth: 2 }), Plot.dot(points, { x: "x", y: "y", fill: colour, r: 2.5 })]),
    Plot.tip(drawn.flatMap(({ points }) => points), Plot.pointer({ x: "x", y: "y", title: tip }))],
  }), { share: 0.47, name, rows: () => drawn.flatMap(({ name: line, points }) => points.map((point) =>
    ({ ...row(point.k), curve: line, x: point.x * scaleX.factor, value: point.y * scaleY.factor }))) });
  return element("figure", {}, element("h3", {}, title), chart,
    lines.length > 1 ? legend(drawn.map((line) => ({ ...line, line: true, strokeWidth: 2 }))) : null);
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

/** A line of the slope -rate below the last points of a curve. */
function referenceLine(points, rate) {
  const last = points.at(-1);
  const first = points[Math.max(0, Math.floor(points.length / 2) - 1)];
  return [first.x, last.x].map((x) => ({ x, y: 0.55 * last.y * (x / last.x) ** -rate }));
}

function referenceMarks(points, rate) {
  const line = referenceLine(points, rate);
  return [
    Plot.line(line, { x: "x", y: "y", stroke: "currentColor", strokeOpacity: 0.45, strokeDasharray: "6 4" }),
    Plot.text([line], { x: ([a, b]) => Math.sqrt(a.x * b.x), y: ([a, b]) => Math.sqrt(a.y * b.y), dx: -4, dy: 10, textAnchor: "end",
      stroke: "var(--panel)", strokeWidth: 4, fill: "currentColor", fillOpacity: 0.65, text: () => `slope \u2212${number(rate, 2)}` })];
}

/** The axis of the degrees of freedom, for a chart of this width. */
export function dofAxis(lines, width) {
  const x = lines.flatMap(({ points }) => points.map((point) => point.x));
  return { type: "log", label: "degrees of freedom", grid: true, tickFormat: count,
    ticks: logTicks(Math.min(...x), Math.max(...x), width < 520 ? 4 : 7) };
}

/** Curves { name, colour, points: { x, y, level } } with a tooltip for the nearest one. */
export function curveMarks(lines, valueText) {
  const points = lines.flatMap(({ name, points: all }) => all.map((point) => ({ ...point, name })));
  return [
    ...lines.flatMap(({ points: all, colour, strokeWidth, dash }) => [
      Plot.line(all, { x: "x", y: "y", stroke: colour, strokeWidth, strokeDasharray: dash }),
      Plot.dot(all, { x: "x", y: "y", fill: colour, r: 1.25 + strokeWidth / 2 })]),
    Plot.tip(points, Plot.pointer({ x: "x", y: "y",
      title: (d) => `${d.name}, level ${d.level}\n${valueText(d.y)}\n${count(d.x)} degrees of freedom` }))];
}

/** Curves as rows of a table. */
export function curveRows(lines) {
  return lines.flatMap(({ name, points }) => points.map(({ level, x, y }) => ({ curve: name, level, dofs: x, value: y })));
}

/** The interval that contains all values, with a margin on a logarithmic axis. */
export function logRange(values) {
  return [Math.min(...values) * 0.5, Math.max(...values) * 1.4];
}

/**
 * Curves of relative quantities, in percent, over the degrees of freedom, both logarithmic; `reference`: { points, rate }, below
 * which a line of the slope -rate is drawn.
 */
export function logLogChart({ label, yLabel, lines, range, reference, tolerance, height = (width) => 0.66 * width, ...options }) {
  const inPercent = ({ y, ...point }) => ({ ...point, y: 100 * y });
  const drawn = lines.map((line) => ({ ...line, points: line.points.map(inPercent) }));
  const [low, high] = range.map((y) => 100 * y);
  return responsive(label, (width, onPaper) => Plot.plot({
    width, height: Math.min(onPaper ? 220 : 440, height(width)), marginLeft: 58, marginRight: tolerance ? 64 : 18, marginTop: 28, marginBottom: 44,
    style: chartStyle, x: dofAxis(lines, width),
    y: { type: "log", label: yLabel, grid: true, tickFormat: (y) => number(y, 1), domain: [low, high], ticks: logTicks(low, high, 6) },
    marks: [
      tolerance ? [Plot.ruleY([100 * tolerance], { stroke: "currentColor", strokeOpacity: 0.6, strokeDasharray: "2 3" }),
        Plot.text([100 * tolerance], { y: (d) => d, frameAnchor: "right", dx: 6, textAnchor: "start", fillOpacity: 0.75,
          text: () => "tolerance" })] : null,
      reference ? referenceMarks(reference.points.map(inPercent), reference.rate) : null,
      curveMarks(drawn, (y) => percent(y / 100))],
  }), { name: "curves", rows: () => curveRows(lines), ...options });
}
