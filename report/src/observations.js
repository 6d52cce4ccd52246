// Sections and probes: tables, charts along lines, and over load steps.

import { axisNames, stressNames } from "./axes.js";
import { lineChart } from "./charts.js";
import { element, number, section, table, withoutNoise } from "./dom.js";
import { pathChart } from "./history.js";
import { headed, unit } from "./units.js";

const fewRows = 4; // of a probe; longer ones are charts
const fileName = (what, name) => `${what}_${name.replaceAll(/\W+/g, "_")}`;
const stressOf = (point) => point.equilibrated_stress ?? point.stress;

/** The numbers of a section { name, values }, forces and moments apart. */
function forcesOf(d) {
  const of = (name, value) => ({ name, value });
  return { forces: [of("N", (cut) => cut.N), ...(d === 2 ? [of("V", (cut) => cut.V[0])] : [0, 1].map((i) => of(`V${i + 1}`, (cut) => cut.V[i])))],
    moments: d === 2 ? [of("M", (cut) => cut.M[0])] : ["Mn", "M1", "M2"].map((name, i) => of(name, (cut) => cut.M[i])) };
}

function sectionTable({ sections, d }) {
  const { forces, moments } = forcesOf(d);
  const largest = (numbers) => Math.max(...sections.flatMap((cut) => numbers.map(({ value }) => Math.abs(value(cut)))));
  const rows = sections.map((cut) => [cut.name, number(cut.measure, 6), ...[forces, moments].flatMap((numbers) =>
    withoutNoise(numbers.map(({ value }) => value(cut)), largest(numbers)).map((value) => number(value, 6)))]);
  const note = sections.find((cut) => cut.note)?.note;
  return [element("h3", {}, "Sections"), element("p", { class: "note" }, "On the part behind the plane, moments about the point of the section. "
    + `Forces ${note ? "are" : "and moments are"} in equilibrium with the loads; they have no error bars.${note ? ` ${note[0].toUpperCase()}${note.slice(1)}.` : ""}`),
  table(["section", headed(d === 2 ? "#length" : "#area", unit("boundary")), ...forces.map(({ name }) => headed(`#${name}`, unit("force"))),
    ...moments.map(({ name }) => headed(`#${name}`, unit("moment")))], rows, { class: "sections" })];
}

function probeTable(probes, d) {
  const rows = probes.flatMap(({ name, points }) => points.map((point) => [name, point.region, ...withoutNoise(point.displacement).map((value) => number(value, 6)),
    ...withoutNoise(stressOf(point)).map((value) => number(value, 5)), number(point.difference, 2)]));
  return table(["probe", "region", ...axisNames(d).map((axis) => headed(`#u ${axis}`, unit("length"))),
    ...stressNames(d).map((entry) => headed(`#stress ${entry}`, unit("stress"))), headed("#difference", unit("stress"))], rows, { class: "probes" });
}

/** Displacement and stress along a line. */
function lineCharts({ name, points }, d) {
  const [first] = points;
  const common = { x: points.map((point) => Math.hypot(...point.x.map((x, i) => x - first.x[i]))), xLabel: "distance along the line", xUnit: unit("length"),
    groups: points.map(({ body, region }) => `${body}, ${region}`), place: (k) => `(${points[k].x.map((x) => number(x, 4)).join(", ")}), ${points[k].region}`,
    row: (k) => ({ point: points[k].point, region: points[k].region }) };
  const stress = stressNames(d).map((entry, i) => ({ name: entry, values: points.map((point) => stressOf(point)[i]) }));
  const difference = first.difference === null ? [] : [{ name: "difference", values: points.map((point) => point.difference) }];
  return [
    lineChart({ ...common, title: `${name}: displacement`, name: fileName("displacement", name), yLabel: "displacement", yUnit: unit("length"),
      lines: axisNames(d).map((axis, i) => ({ name: `u ${axis}`, values: points.map((point) => point.displacement[i]) })) }),
    lineChart({ ...common, title: `${name}: stress`, name: fileName("stress", name), yLabel: "stress", yUnit: unit("stress"), lines: [...stress, ...difference] })];
}

/** Sections and single points over the load steps. */
function stepCharts(run) {
  const { steps, d } = run;
  const common = { run, x: steps.map((step) => step.t), xLabel: "t" };
  const parts = (kind) => (steps[0][kind] ?? []).map((part, i) => [part.name, (step) => step[kind][i]]);
  const { forces, moments } = forcesOf(d);
  const chart = (title, file, yLabel, yUnit, numbers, at) => pathChart({ ...common, title, name: file, yLabel, yUnit,
    lines: numbers.map(({ name, value }) => ({ name, values: steps.map((step) => value(at(step))) })) });
  const ofSections = steps.every((step) => step.sections) ? parts("sections").flatMap(([name, at]) => [
    chart(`${name}: forces`, fileName("section_forces", name), "force", unit("force"), forces, at),
    chart(`${name}: moments`, fileName("section_moments", name), "moment", unit("moment"), moments, at)]) : [];
  const ofPoints = parts("probes").filter(([, at]) => steps.every((step) => at(step)?.points.length === 1)).flatMap(([name, at]) => {
    const point = (step) => at(step).points[0];
    return [
      chart(`${name}: displacement`, fileName("steps_displacement", name), "displacement", unit("length"),
        axisNames(d).map((axis, i) => ({ name: `u ${axis}`, value: ({ displacement }) => displacement[i] })), point),
      chart(`${name}: stress`, fileName("steps_stress", name), "stress", unit("stress"),
        stressNames(d).map((entry, i) => ({ name: entry, value: (of) => stressOf(of)[i] })), point)];
  });
  return [...ofSections, ...ofPoints];
}

export function observationsSection(run) {
  const probes = run.probes ?? [];
  if (probes.length === 0 && !run.sections) return null;
  const few = probes.filter(({ points }) => points.length <= fewRows);
  const charts = [...probes.filter((probe) => !few.includes(probe)).flatMap((probe) => lineCharts(probe, run.d)),
    ...(run.steps?.length > 1 ? stepCharts(run) : [])];
  return section("probes", "Probes", "Sections and probes", null, run.sections ? sectionTable(run) : null,
    probes.length > 0 ? element("h3", {}, "Probes") : null,
    probes.length > 0 ? element("p", { class: "note" }, probes[0].points[0]?.difference == null ? "Stresses are those of the computed displacement."
      : "Stresses are those of the equilibrated stress; the difference from the stress of the computed displacement indicates their error, without guarantee.") : null,
    few.length > 0 ? probeTable(few, run.d) : null, charts.length > 0 ? element("div", { class: "two-columns panels" }, charts) : null);
}
