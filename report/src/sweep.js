// The page of a sweep, with the data of app/page/report_page.cpp: every number over what was varied, with error bars where there are.

import * as Plot from "@observablehq/plot";
import { chartStyle, legend, responsive } from "./charts.js";
import { count, element, number, percent, plural, powerOfTen, seconds, section, table, withoutNoise } from "./dom.js";
import { definitions, filesSection, hashes, timesAndMachine } from "./facts.js";
import { typeset } from "./math.js";
import { headed, measured, nameUnits, quantityUnit, unit } from "./units.js";
import { figure, pageHeader } from "./verdict.js";

const prefix = "quantity.";
const mostLines = 12;

/** Titles and units of the numbers of a run, by their names in sweep.csv. */
const known = [
  [/^quantity\.(.*)$/, "quantities", (name) => name, (name) => quantityUnit(name)],
  [/^contact_normal$/, "numbers", () => "Contact force, normal", () => unit("force")],
  [/^contact_tangential$/, "numbers", () => "Contact force, tangential", () => unit("force")],
  [/^sliding_factor\.(.*)$/, "numbers", (name) => `Sliding factor of ${name}`, () => ""],
  [/^largest_pressure$/, "numbers", () => "Largest contact pressure", () => unit("stress")],
  [/^opened$/, "numbers", () => "Open part of the contact", () => unit("boundary")],
  [/^reaction_([xyz]\..*)$/, "numbers", (name) => `Reaction of ${name.slice(2)}, ${name[0]}`, () => unit("force")],
  [/^section\.(.*)$/, "numbers", (name) => `Section ${name.replace(/\.([^.]*)$/, ", $1")}`, (name) => unit(/\.M[^.]*$/.test(name) ? "moment" : "force")],
  [/^probe\.(.*)$/, "numbers", (name) => `Probe ${name.replace(/\.u_([xyz])$/, ", u $1")}`, () => unit("length")],
  [/^relative$/, "effort", () => "Bound of the error", () => "%"],
  [/^cells$/, "effort", () => "Cells", () => ""],
  [/^seconds$/, "effort", () => "Time", () => "s"],
];

/** The numbers to draw, each with its value and, where it has an error bar, the ends of a run. */
function figuresOf({ runs }) {
  const names = [...new Set(runs.flatMap(Object.keys))];
  const isEnd = (name) => /\.(lower|upper)$/.test(name) && names.includes(name.replace(/\.(lower|upper)$/, ""));
  return names.filter((name) => !isEnd(name)).flatMap((name) => {
    const [pattern, group, title, label] = known.find(([expression]) => expression.test(name)) ?? [];
    if (!pattern) return [];
    const what = name.match(pattern)[1];
    const scale = name === "relative" ? 100 : 1;
    const at = (key) => (run) => (typeof run[key] === "number" ? scale * run[key] : null);
    return [{ name, group, title: title(what), unit: label(what), value: at(name),
      ends: name.startsWith(prefix) ? [at(`${name}.lower`), at(`${name}.upper`)] : null }];
  });
}

/** The label and unit of a key that is a parameter, else the key. */
const titleOf = ({ keys, titles }, key) => titles[keys.indexOf(key)];

/** The values of the first key along the axis: numbers, where all are. */
function axisOf({ keys, titles, runs }) {
  const texts = runs.map(({ values }) => values[keys[0]]);
  const isNumeric = texts.every((text) => text.trim() !== "" && Number.isFinite(Number(text)));
  return { title: titles[0], isNumeric, of: ({ values }) => (isNumeric ? Number(values[keys[0]]) : values[keys[0]]) };
}

/** A colour of n, from blue to orange. */
const colourOf = (i, n) => (n === 1 ? "#0072b2" : `hsl(${Math.round(210 + (170 * i) / (n - 1)) % 360} 70% 45%)`);

/** The runs of each combination of the other keys. */
function linesOf(sweep, axis) {
  const others = sweep.keys.slice(1);
  const groups = new Map();
  for (const run of sweep.runs) {
    const name = others.map((key) => `${titleOf(sweep, key)} = ${run.values[key]}`).join(", ");
    groups.set(name, [...(groups.get(name) ?? []), run]);
  }
  const ordered = (runs) => (axis.isNumeric ? [...runs].sort((a, b) => axis.of(a) - axis.of(b)) : runs);
  return [...groups].map(([name, runs], i) => ({ name, colour: colourOf(i, Math.min(groups.size, mostLines)), runs: ordered(runs) }));
}

function pointsOf(drawn, lines, axis) {
  const points = lines.map(({ name, colour, runs }) => ({ name, colour, points: runs.map((run) => ({ run, line: name, x: axis.of(run), y: drawn.value(run),
    low: drawn.ends?.[0](run) ?? null, high: drawn.ends?.[1](run) ?? null })) }));
  const scale = powerOfTen(points.flatMap((line) => line.points.flatMap(({ y, low, high }) => [y, low, high].filter((value) => value !== null))));
  const scaled = (value) => (value === null ? NaN : value / scale.factor); // NaN: a gap in the line
  return { scale, lines: points.map((line) => ({ ...line, points: line.points.map((point) => ({ ...point, value: point.y, lower: point.low, upper: point.high,
    y: scaled(point.y), low: scaled(point.low), high: scaled(point.high) })) })) };
}

function tipText(drawn, axis, { run, line, value, lower, upper }) {
  const bar = lower === null ? [] : [`between ${measured(`${number(lower, 6)} and ${number(upper, 6)}`, drawn.unit)}`];
  return [`${axis.title} = ${axis.of(run)}${line ? `, ${line}` : ""}`, measured(number(value, 6), drawn.unit), ...bar, `run ${run.run}: ${run.status}`].join("\n");
}

/** A number over the first key, a line for each combination of the others; null where there is nothing to see. */
function sweepChart(drawn, allLines, axis) {
  const { scale, lines } = pointsOf(drawn, allLines.slice(0, mostLines), axis);
  const points = lines.flatMap((line) => line.points).filter(({ value }) => value !== null);
  const values = points.map(({ value }) => value);
  if (new Set(points.map(({ x }) => x)).size < 2 || withoutNoise(values).every((value) => value === 0)) return null;
  const bars = points.filter(({ lower }) => lower !== null);
  const x = axis.isNumeric ? { label: axis.title, grid: true, ticks: 6, inset: 12 } : { type: "point", label: axis.title, domain: [...new Set(points.map((point) => point.x))] };
  const chart = responsive(`${drawn.title} over ${axis.title}`, (width) => Plot.plot({
    width, height: Math.max(240, 0.55 * width), marginLeft: 62, marginRight: 18, marginTop: 28, marginBottom: 44, style: chartStyle,
    x, y: { label: headed("value", drawn.unit, scale), grid: true, ticks: 6, nice: true },
    marks: [...lines.flatMap(({ points: all, colour }, i) => {
      const dx = bars.length > 0 ? 5 * (i - (lines.length - 1) / 2) : 0; // bars side by side
      return [Plot.line(all, { x: "x", y: "y", dx, stroke: colour, strokeWidth: 1.75 }),
        Plot.ruleX(all.filter(({ lower }) => lower !== null), { x: "x", y1: "low", y2: "high", dx, stroke: colour, strokeWidth: 2 }),
        Plot.dot(all.filter(({ value }) => value !== null), { x: "x", y: "y", dx, fill: colour, r: 3 })];
    }),
    Plot.tip(points, Plot.pointer({ x: "x", y: "y", title: (d) => tipText(drawn, axis, d) }))],
  }), { share: 0.47, name: `sweep_${drawn.name.replaceAll(/\W+/g, "_")}`, rows: () => points.map(({ run, value, lower, upper }) =>
    ({ run: run.run, ...run.values, value, ...(bars.length > 0 ? { lower, upper } : {}) })) });
  return element("figure", {}, element("h3", {}, drawn.title), chart);
}

function chartSection(id, short, title, lead, drawn, lines, axis) {
  const charts = drawn.map((one) => sweepChart(one, lines, axis)).filter(Boolean);
  if (charts.length === 0) return null;
  const left = lines.length - mostLines;
  return section(id, short, title, lead, element("div", { class: "two-columns panels" }, charts),
    lines.length > 1 ? legend(lines.slice(0, mostLines).map((line) => ({ ...line, line: true, strokeWidth: 2 }))) : null,
    left > 0 ? element("p", { class: "note" }, `${plural(left, "further line is", "further lines are")} not drawn; sweep.csv has all runs.`) : null);
}

function valueCell({ value, ends }, run) {
  const [low, high] = ends ? ends.map((end) => end(run)) : [null, null];
  const text = number(value(run), 5);
  return low === null || high === null || low === high ? text : `${text} (${number(low, 5)} to ${number(high, 5)})`;
}

function runsSection(sweep, drawn, files) {
  const quantities = drawn.filter(({ group }) => group === "quantities");
  const rows = sweep.runs.map((run) => {
    const page = `${run.run}/report.html`;
    return [files.includes(page) ? element("a", { href: page }, run.run) : run.run, ...sweep.keys.map((key) => run.values[key]), run.status,
      percent(run.relative), ...quantities.map((quantity) => valueCell(quantity, run)), typeof run.dofs === "number" ? count(run.dofs) : "\u2013", seconds(run.seconds)];
  });
  const reasons = sweep.runs.filter(({ reason }) => reason).map(({ run, reason }) => [run, typeset(reason)]);
  return section("runs", "Runs", "The runs", "Each has a page of its own. Where a quantity has an error bar, its ends stand in parentheses.",
    table(["run", ...sweep.titles, "ended as", "#bound", ...quantities.map(({ title, unit: label }) => headed(`#${title}`, label)), "#dofs", "#time"], rows, { class: "long" }),
    reasons.length > 0 ? [element("h3", {}, "Why they ended"), definitions(reasons)] : null);
}

/** The overall result. */
function outcome({ runs }) {
  const runsWith = (...kinds) => runs.filter(({ status }) => kinds.includes(status)).length;
  const certified = runsWith("certified");
  const waiting = runsWith("not run");
  if (certified === runs.length) return { tone: "certified", mark: "\u2713", title: runs.length === 1 ? "The run is certified" : `All ${runs.length} runs are certified` };
  const parts = [`${certified} of ${plural(runs.length, "run is", "runs are")} certified`];
  if (waiting > 0) parts.push(`${waiting} not run`);
  const lost = runs.length - certified - waiting - runsWith("budget");
  if (lost > 0) return { tone: "failed", mark: "\u00d7", title: [...parts, `${lost} without a certificate`].join(", ") };
  return { tone: "budget", mark: "!", title: parts.join(", ") };
}

function sweepHeader(sweep, machine) {
  const bounds = sweep.runs.map(({ relative }) => relative).filter((bound) => typeof bound === "number");
  const times = sweep.runs.map((run) => run.seconds).filter((time) => typeof time === "number");
  const varied = sweep.keys.map((key) => [titleOf(sweep, key), [...new Set(sweep.runs.map(({ values }) => values[key]))].slice(0, 20).join(", ")]);
  const body = [element("p", {}, "Guaranteed are, run by run, the bound of the error and the ends of the error bars. Numbers without a bar are those of the computed solutions."),
    definitions(varied)];
  const shown = [figure(count(sweep.runs.length), sweep.runs.length === 1 ? "run" : "runs", sweep.titles.join(", ")),
    bounds.length > 0 ? figure(percent(Math.max(...bounds)), "largest bound of the error", `smallest ${percent(Math.min(...bounds))}`) : null,
    times.length > 0 ? figure(seconds(times.reduce((a, b) => a + b, 0)), "time of all runs", `mean ${seconds(times.reduce((a, b) => a + b, 0) / times.length)}`) : null];
  return pageHeader({ program: sweep.program, machine, title: sweep.title, purpose: sweep.purpose, file: sweep.file, kind: `sweep over ${sweep.titles.join(", ")}`,
    verdict: { ...outcome(sweep), body }, figures: element("div", { class: "figures" }, shown.filter(Boolean)) });
}

export function sweepPage({ sweep, machine, files }) {
  nameUnits(sweep.units);
  const drawn = figuresOf(sweep);
  const axis = axisOf(sweep);
  const lines = linesOf(sweep, axis);
  const of = (group) => drawn.filter((one) => one.group === group);
  const sections = [
    chartSection("quantities", "Quantities", "Numbers with error bars",
      "The number of the exact solution is certain to lie within the bar, in conditional runs for the computed friction threshold. The dot is the number of the computed solution; lines only lead the eye.",
      of("quantities"), lines, axis),
    chartSection("numbers", "Numbers", "Other numbers", "Of the computed solutions, without error bars.", of("numbers"), lines, axis),
    chartSection("effort", "Bounds", "Bounds and effort", null, of("effort"), lines, axis),
    runsSection(sweep, drawn, files),
    section("times", "Machine", "The machine", null, timesAndMachine({}, machine, sweep.program), hashes("sweep.json")), filesSection(files.filter((name) => !name.includes("/")))].filter(Boolean);
  return { title: `${sweep.title || sweep.file}, sweep`, purpose: `This report documents ${plural(sweep.runs.length, "run", "runs")} of a case with other values of ${sweep.titles.join(", ")}.`,
    header: sweepHeader(sweep, machine), sections, start: async () => {}, machine, program: sweep.program };
}
