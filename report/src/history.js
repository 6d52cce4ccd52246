// The load steps of a run and their results, step by step.

import * as Plot from "@observablehq/plot";
import { chartStyle, legend, responsive } from "./charts.js";
import { element, number, percent, powerOfTen, section, seconds, table, withoutNoise } from "./dom.js";
import { headed, measured, unit } from "./units.js";

const colours = ["#3d7edb", "#d9822b", "#4fc38a", "#b0569e", "#8a94a0"];

/** Lines { name, values } over the steps, or over `x`, in the order of the steps. */
function pathChart({ title, name, xLabel, xUnit = "", x, yLabel, yUnit = "", lines, run }) {
  const scaleX = powerOfTen(x);
  const scaleY = powerOfTen(lines.flatMap(({ values }) => values));
  const drawn = lines.map(({ name: line, values }, i) => ({ name: line, colour: colours[i], points: values.map((y, k) =>
    ({ x: x[k] / scaleX.factor, y: y / scaleY.factor, step: run.steps[k], name: line })) }));
  const tip = (d) => `${lines.length > 1 ? `${d.name}, ` : ""}step ${d.step.step}, t = ${number(d.step.t, 6)}\n${measured(number(d.y * scaleY.factor, 5), yUnit)}`;
  const chart = responsive(title, (width) => Plot.plot({
    width, height: Math.max(240, 0.6 * width), marginLeft: 62, marginRight: 18, marginTop: 28, marginBottom: 44, style: chartStyle,
    x: { label: headed(xLabel, xUnit, scaleX), grid: true, ticks: 6 }, y: { label: headed(yLabel, yUnit, scaleY), grid: true, ticks: 6, zero: true },
    marks: [Plot.ruleY([0], { strokeOpacity: 0.5 }), ...drawn.flatMap(({ points, colour }) => [
      Plot.line(points, { x: "x", y: "y", stroke: colour, strokeWidth: 2 }), Plot.dot(points, { x: "x", y: "y", fill: colour, r: 2.5 })]),
    Plot.tip(drawn.flatMap(({ points }) => points), Plot.pointer({ x: "x", y: "y", title: tip }))],
  }), { share: 0.47, name, rows: () => drawn.flatMap(({ name: line, points }) => points.map((point) =>
    ({ step: point.step.step, t: point.step.t, curve: line, x: point.x * scaleX.factor, value: point.y * scaleY.factor }))) });
  return element("figure", {}, element("h3", {}, title), chart,
    lines.length > 1 ? legend(drawn.map((line) => ({ ...line, line: true, strokeWidth: 2 }))) : null);
}

/** Sets values that are rounding relative to the largest of all to 0. */
function cleared(lines) {
  const largest = Math.max(0, ...lines.flatMap(({ values }) => values.map(Math.abs)));
  return lines.map(({ name, values }) => ({ name, values: withoutNoise(values, largest) }));
}

/** The magnitude of the force of a kind on a boundary. */
function support({ balance }, { kind, name }) {
  const row = balance?.rows.find((other) => other.kind === kind && other.name === name);
  return row ? Math.hypot(...row.force) : 0;
}

/** The informative charts: those whose lines are not all zero. */
function charts(run) {
  const { steps } = run;
  const t = steps.map((step) => step.t);
  const of = (name, value) => ({ name, values: steps.map(value) });
  const sum = (key) => (step) => Object.values(step.interfaces).reduce((total, part) => total + part[key], 0);
  const hydraulic = (key) => (step) => Object.values(step.interfaces).reduce((total, part) => total + (part[key] ?? 0), 0);
  const length = unit("length");
  const force = unit("force");
  const overT = [
    { title: "Contact forces", name: "forces", yLabel: "force", yUnit: force, lines: steps[0].contact === null ? [] : [
      of("pressure", (step) => -step.contact.normal), of("tangential", (step) => step.contact.tangential)] },
    { title: "Reactions", name: "reactions", yLabel: "length of the force", yUnit: force, lines: (steps[0].balance?.rows ?? [])
      .filter(({ kind }) => kind === "reaction" || kind === "spring").slice(0, colours.length)
      .map((row) => of(row.kind === "spring" ? `${row.name} (spring)` : row.name, (step) => support(step, row))) },
    { title: "Interface", name: "interface", yLabel: run.d === 2 ? "length" : "area", yUnit: unit("boundary"), lines: [
      of("open", sum("opened")), of("slipping", sum("slipping")), of("broken", sum("broken")), of("breaking", sum("process"))] },
    { title: "Base under water", name: "uplift", yLabel: "force", yUnit: force, lines: [
      of("effective pressure", (step) => -hydraulic("effective_normal")(step)), of("uplift", hydraulic("uplift"))] },
    { title: "Crack mouth", name: "crack_mouth", yLabel: "displacement", yUnit: length, lines: [
      of("opening", hydraulic("cmod")), of("sliding", hydraulic("csd"))] },
    { title: "Watched", name: "watched", yLabel: "displacement", yUnit: length, lines: Object.keys(steps[0].watch ?? {}).slice(0, colours.length)
      .map((name) => of(name, (step) => step.watch?.[name] ?? 0)) },
    { title: "Energies", name: "energies", yLabel: "energy", yUnit: unit("energy"), lines: [
      of("work", (step) => step.work), of("in the bodies", (step) => step.energy / 2), of("dissipated", (step) => step.dissipated),
      of("by friction", (step) => step.dissipated_friction), of("in the interface", (step) => step.stored)] },
    { title: "Bound of the error", name: "bounds", yLabel: "of the largest norm of the stress", yUnit: "%",
      lines: [of("bound", (step) => 100 * (step.relative_path ?? 0))] },
  ].map((chart) => ({ xLabel: "t", x: t, ...chart }));
  return [{ title: "Load and displacement", name: "load", xLabel: "largest displacement", xUnit: length, x: steps.map((step) => step.max_displacement),
    yLabel: "t", lines: [{ name: "t", values: t }] }, ...overT]
    .map((chart) => ({ ...chart, lines: cleared(chart.lines) }))
    .map((chart) => ({ ...chart, lines: chart.lines.filter(({ values }) => values.some((value) => value !== 0)) }))
    .filter(({ lines }) => lines.length > 0);
}

function stepTable(run) {
  return table(["#step", "#t", "#Newton steps", "#cuts", headed("#bound", unit("stress_norm")), "#of the path", headed("#largest displacement", unit("length")), headed("#dissipated", unit("energy")),
    "#time"],
  run.steps.map((step) => [String(step.step), number(step.t, 7), String(step.newton.length), String(step.cuts), number(step.bound),
    percent(step.relative_path), number(step.max_displacement, 5), number(step.dissipated), seconds(step.times.level)]), { class: "long" });
}

export function historySection(run) {
  if (!run.steps || run.steps.length === 0) return null;
  return section("history", "Load steps", "Load steps",
    "Every step has its own bound, that of its residual with the history that the step before has left. It is set against the largest norm of the stress up to it.",
    run.steps.length > 1 ? element("div", { class: "two-columns panels" }, charts(run).map((chart) => pathChart({ ...chart, run }))) : null,
    stepTable(run));
}
