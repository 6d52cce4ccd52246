// The load steps of a run and their results, step by step.

import { lineChart, lineColours } from "./charts.js";
import { element, number, percent, section, seconds, table, withoutNoise } from "./dom.js";
import { headed, unit } from "./units.js";

/** Lines { name, values } over the steps, or over `x`, in the order of the steps. */
export function pathChart({ run, ...chart }) {
  const { steps } = run;
  return lineChart({ ...chart, place: (k) => `step ${steps[k].step}, t = ${number(steps[k].t, 6)}`, row: (k) => ({ step: steps[k].step, t: steps[k].t }) });
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
      .filter(({ kind }) => kind === "reaction" || kind === "spring").slice(0, lineColours.length)
      .map((row) => of(row.kind === "spring" ? `${row.name} (spring)` : row.name, (step) => support(step, row))) },
    { title: "Interface", name: "interface", yLabel: run.d === 2 ? "length" : "area", yUnit: unit("boundary"), lines: [
      of("open", sum("opened")), of("slipping", sum("slipping")), of("broken", sum("broken")), of("breaking", sum("process"))] },
    { title: "Base under water", name: "uplift", yLabel: "force", yUnit: force, lines: [
      of("effective pressure", (step) => -hydraulic("effective_normal")(step)), of("uplift", hydraulic("uplift"))] },
    { title: "Crack mouth", name: "crack_mouth", yLabel: "displacement", yUnit: length, lines: [
      of("opening", hydraulic("cmod")), of("sliding", hydraulic("csd"))] },
    { title: "Watched", name: "watched", yLabel: "displacement", yUnit: length, lines: Object.keys(steps[0].watch ?? {}).slice(0, lineColours.length)
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
