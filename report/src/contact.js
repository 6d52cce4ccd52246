// The contact boundary: in 2D curves over its length with open, sticking and slipping zones shaded, in 3D plan views, and against
// obstacles values over a coordinate.

import * as Plot from "@observablehq/plot";
import { axisNames, showsMeridian } from "./axes.js";
import { chartStyle, responsive } from "./charts.js";
import { statusColours, statusNames } from "./components.js";
import { contactSides, partArea } from "./contact_parts.js";
import { element, number, powerOfTen, section } from "./dom.js";
import { contactPlans, quantities } from "./plan.js";
import { boundaryTitle, resultants } from "./resultants.js";
import { shownStates } from "./scales.js";
import { stagesOf } from "./stages.js";
import { readSurface } from "./surface.js";
import { headed, unit } from "./units.js";

/** Stretches of equal status along a profile. */
function zonesOf({ arc, status }) {
  const zones = [];
  for (let i = 0; i + 1 < arc.length; ++i) {
    const middle = (arc[i] + arc[i + 1]) / 2;
    for (const [from, to, kind] of [[arc[i], middle, status[i]], [middle, arc[i + 1], status[i + 1]]]) {
      const last = zones.at(-1);
      if (last && last.status === kind) last.to = to;
      else if (to > from) zones.push({ from, to, status: kind });
    }
  }
  return zones;
}

const panels = [
  { key: "pressure", title: (scale) => headed("contact pressure", unit("stress"), scale), colour: "#0072b2", zero: true },
  { key: "friction", title: (scale) => `${headed("friction", unit("stress"), scale)}, dashed: its limit`, colour: "#d55e00", limits: true },
  { key: "gap", title: (scale) => headed("gap", unit("length"), scale), colour: "#009e73", zero: true },
  { key: "slip", title: (scale) => headed("slip", unit("length"), scale), colour: "#8458a3", zero: true },
];

/** The panels of a joint: of water, and of a bond. */
const panelsOfWater = [
  { key: "effective", title: (scale) => headed("effective pressure", unit("stress"), scale), colour: "#0072b2", zero: true },
  { key: "water", title: (scale) => headed("pressure of the water", unit("stress"), scale), colour: "#56b4e9", zero: true },
];
const panelsOfBond = [
  { key: "damage", title: (scale) => headed("damage", "", scale), colour: "#a6611a", zero: true },
  { key: "opening", title: (scale) => headed("opening of the joint", unit("length"), scale), colour: "#009e73", zero: true },
];

function panel(rows, zones, { key, title, colour, limits, zero }, width, isLast) {
  const hasLimit = limits && rows.some((row) => row.limit > 0);
  const scale = powerOfTen(rows.map((row) => Math.max(Math.abs(row[key]), hasLimit ? row.limit : 0)));
  const along = powerOfTen(rows.map((row) => row.arc));
  const y = (row) => row[key] / scale.factor;
  const limit = (sign) => (hasLimit ? Plot.line(rows, { x: "arc", y: (row) => (sign * row.limit) / scale.factor, strokeDasharray: "4 3", strokeOpacity: 0.8 }) : null);
  return Plot.plot({
    width, height: isLast ? 162 : 132, marginLeft: 58, marginTop: 24, marginBottom: isLast ? 44 : 16, marginRight: 12,
    style: chartStyle,
    x: { domain: [rows[0].arc, rows.at(-1).arc], label: isLast ? headed("length along the boundary", unit("length"), along) : null,
      ticks: isLast ? undefined : [], tickFormat: (value) => number(value / along.factor, 4) },
    y: { label: title(scale), labelAnchor: "top", labelArrow: "none", ticks: 4, nice: true, grid: true, zero, tickFormat: (value) => number(value, 3) },
    marks: [
      Plot.rect(zones, { x1: "from", x2: "to", fill: (zone) => statusColours[zone.status], fillOpacity: 0.13 }),
      Plot.ruleY([0], { strokeOpacity: 0.5 }),
      limit(1), limit(-1),
      Plot.line(rows, { x: "arc", y, stroke: colour, strokeWidth: 1.75 }),
      Plot.ruleX(rows, Plot.pointerX({ x: "arc", py: y, strokeOpacity: 0.35 })),
      Plot.tip(rows, Plot.pointerX({ x: "arc", y, title: (row) =>
        `${number(row[key])}${limits && row.limit > 0 ? `, limit ${number(row.limit)}` : ""}, ${statusNames[row.status]}\n${axisNames(2).map((axis) => `${axis} = ${number(row[axis])}`).join(", ")}` })),
    ],
  });
}

function profileCharts(run, profile) {
  const rows = Array.from(profile.arc, (arc, i) => ({ arc, ...Object.fromEntries(axisNames(2).map((axis, c) => [axis, profile.points[2 * i + c]])),
    pressure: profile.pressure[i], friction: profile.friction[i], limit: profile.limit[i], gap: profile.gap[i],
    slip: profile.slip[i], status: profile.status[i],
    ...(profile.water ? { effective: profile.pressure[i] - profile.water[i], water: profile.water[i] } : {}),
    ...(profile.damage ? { damage: profile.damage[i], opening: profile.opening[i] } : {}) }));
  const shown = [...panels, ...(profile.water ? panelsOfWater : []), ...(profile.damage ? panelsOfBond : [])];
  const zones = zonesOf(profile);
  const present = [0, 1, 2, 3].filter((kind) => zones.some(({ status }) => status === kind));
  return element("figure", {}, element("h3", {}, boundaryTitle(run, profile.boundary)),
    element("ul", { class: "legend" }, present.map((kind) =>
      element("li", {}, element("span", { class: "swatch swatch-zone", style: `--colour:${statusColours[kind]}` }), statusNames[kind]))),
    responsive(`Contact pressure, friction, gap and slip along ${profile.boundary}`, (width) => element("div", {},
      shown.map((what, i) => panel(rows, zones, what, width, i === shown.length - 1))),
      { name: `contact_${profile.boundary}`, rows: () => rows.map((row) => ({ ...row, status: statusNames[row.status] })) }),
    zoneText(zones));
}

/** The positions of zone boundaries. */
function zoneText(zones) {
  if (zones.length < 2 || zones.length > 9) return null;
  return element("p", { class: "note" }, "Zones: ", zones.map(({ from, to, status }) =>
    `${statusNames[status]} from ${number(from, 5)} to ${number(to, 5)}`).join("; "), ".");
}

/** The lattice points of the contact faces in 3D, at most `limit` of them, evenly chosen. */
function contactPoints(surface, limit) {
  const { contact, faces, points, nContactFaces, nFacePoints } = surface;
  const n = nContactFaces * nFacePoints;
  const stride = Math.max(1, Math.ceil(n / limit));
  const rows = [];
  for (let place = 0; place < n; place += stride) {
    const [x, y, z] = points.subarray(3 * faces[place], 3 * faces[place] + 3);
    rows.push({ x, y, z, pressure: contact.pressure[place], friction: contact.friction[place], limit: contact.limit[place],
      gap: contact.gap[place], slip: contact.slip[place], status: contact.point_status[place] });
  }
  const centre = rows.reduce((best, row) => (row.pressure > best.pressure ? row : best));
  for (const row of rows) row.r = Math.hypot(row.x - centre.x, row.y - centre.y, row.z - centre.z);
  return { rows, centre };
}

/** The coordinate over which the pressure oscillates least. */
function bestCoordinate(rows, names) {
  const variation = (name) => {
    const sorted = [...rows].sort((a, b) => a[name] - b[name]);
    if (sorted[0][name] === sorted.at(-1)[name]) return Infinity;
    return sorted.reduce((sum, row, i) => (i === 0 ? 0 : sum + Math.abs(row.pressure - sorted[i - 1].pressure)), 0);
  };
  return names.map((name) => [variation(name), name]).reduce((best, other) => (other[0] < best[0] ? other : best))[1];
}

/** `names`: boundaries of the points. */
function scatterChart(surface, names, quantity) {
  const { rows, centre } = contactPoints(surface, 3000);
  const coordinates = Object.fromEntries([["x", "x"], ["y", "y"], ["z", "z"],
    ["r", `distance from the largest pressure, at (${["x", "y", "z"].map((axis) => number(centre[axis], 3)).join(", ")})`]]
    .map(([key, name]) => [key, headed(name, unit("length"))]));
  const coordinate = element("select", { id: "contact-coordinate" }, Object.entries(coordinates).map(([value, name]) => element("option", { value }, name)));
  const place = element("div", {});
  const plot = (width) => {
    const { label, measures } = quantities[quantity.value];
    const scale = powerOfTen(rows.map((row) => row[quantity.value]));
    const y = (row) => row[quantity.value] / scale.factor;
    return Plot.plot({ width, height: 330, marginLeft: 58, marginTop: 26, marginBottom: 46, style: chartStyle, grid: true,
      x: { label: coordinates[coordinate.value], tickFormat: (value) => number(value, 3) },
      y: { label: headed(label, unit(measures), scale), nice: true, tickFormat: (value) => number(value, 3) },
      marks: [Plot.ruleY([0], { strokeOpacity: 0.5 }),
        Plot.dot(rows, { x: coordinate.value, y, r: 2, fill: (row) => statusColours[row.status], fillOpacity: 0.75 }),
        Plot.tip(rows, Plot.pointer({ x: coordinate.value, y, title: (row) =>
          `${number(row[quantity.value])}, ${statusNames[row.status]}\n(${["x", "y", "z"].map((axis) => number(row[axis])).join(", ")})` }))] });
  };
  const draw = () => place.replaceChildren(responsive("Contact values over a coordinate", plot,
    { name: "contact", rows: () => rows.map((row) => ({ ...row, status: statusNames[row.status] })) }));
  for (const input of [coordinate, quantity]) input.addEventListener("change", draw);
  coordinate.value = bestCoordinate(rows, Object.keys(coordinates));
  draw();
  return element("figure", {}, element("div", { class: "controls screen-only" },
    element("label", { class: "control" }, element("span", {}, "Over"), coordinate)),
    element("ul", { class: "legend" }, shownStates([]).map((name, i) => element("li", {}, element("span", { class: "swatch", style: `--colour:${statusColours[i]}` }), name))),
    place, element("figcaption", {}, `The points of ${names.join(", ")} over a coordinate.`));
}

/** In 3D: the boundaries in plan, and those against obstacles over a coordinate. */
function contactIn3d(run, surface) {
  const quantity = element("select", { id: "contact-quantity" }, Object.entries(quantities).map(([value, { label }]) => element("option", { value }, label)));
  const isStatus = element("input", { id: "contact-status", type: "checkbox" });
  const names = [...new Set(contactSides(surface).map(({ boundary }) => boundary))];
  const titles = names.length > 1 || surface.pairs?.length > 0 ? Object.fromEntries(names.map((name) => [name, boundaryTitle(run, name)])) : {};
  return [element("div", { class: "controls screen-only" }, element("label", { class: "control" }, element("span", {}, "Show"), quantity),
    element("label", { class: "control" }, isStatus, element("span", {}, "Status in plan"))),
  ...contactPlans(surface, quantity, isStatus, titles),
  surface.nContactFaces > 0 ? scatterChart(surface, names.filter((name) => !surface.pairs?.some(({ boundary }) => boundary === name)), quantity) : ""];
}

/** In 2D: curves along each boundary; for load steps those of the chosen step, initially the last one. */
async function contactIn2d(run, levels) {
  const place = element("div", {});
  const draw = async (level) => place.replaceChildren(...(await readSurface(level)).profiles.filter(({ arc }) => arc.length > 1)
    .map((profile) => profileCharts(run, profile)));
  await draw(levels.at(-1));
  if (!run.steps || levels.length < 2) return [place];
  const { text } = stagesOf(run);
  const step = element("select", { id: "contact-step", onchange: () => draw(levels[Number(step.value)]) },
    levels.map((level, i) => element("option", { value: i }, text(level.level))));
  step.value = levels.length - 1;
  return [element("div", { class: "controls screen-only" }, element("label", { class: "control" }, element("span", {}, "Step"), step)), place];
}

/** The total length or area, and the open part of it. */
function summaryOfProfiles(profiles) {
  const summary = { size: 0, open: 0, largest: 0, place: null };
  for (const { arc, status, pressure, points } of profiles)
    for (let i = 0; i < arc.length; ++i) {
      const around = showsMeridian() ? 2 * Math.PI * points[2 * i] : 1;
      const half = around * [i - 1, i].reduce((sum, k) => sum + (k >= 0 && k + 1 < arc.length ? (arc[k + 1] - arc[k]) / 2 : 0), 0);
      summary.size += half;
      if (status[i] === 0) summary.open += half;
      if (pressure[i] > summary.largest) Object.assign(summary, { largest: pressure[i], place: [points[2 * i], points[2 * i + 1]] });
    }
  return summary;
}

function summaryOfSurface(surface) {
  const summary = { size: 0, open: 0, largest: 0, place: null };
  for (const part of contactSides(surface)) {
    part.status.forEach((status, triangle) => {
      const area = Math.hypot(...partArea(part, 3 * triangle)) / 2;
      summary.size += area;
      if (status === 0) summary.open += area;
    });
    part.values("pressure").forEach((pressure, c) => {
      if (pressure > summary.largest) Object.assign(summary, { largest: pressure, place: [...part.points.subarray(3 * c, 3 * c + 3)] });
    });
  }
  return summary;
}

/** `start()` fills the section, `summary()` describes the contact boundary, once the data are unpacked. */
export function contactSection(data) {
  const run = data.certificate;
  if (!run.contact || run.status === "failed") return { element: null, start: async () => {}, summary: async () => null };
  const place = element("div", { class: "contact" });
  const last = data.fields.at(-1);
  const is3d = last?.contact || last?.pairs?.length > 0;
  const opposite = Object.values(run.contact.boundaries).some(({ master }) => master) ? "what lies opposite" : "the obstacle";
  return {
    element: section("contact", "Contact", "The contact boundary", last?.profiles || is3d
      ? `Pressure is positive in compression; friction and slip are those of the body along the boundary; the gap is the distance left to ${opposite}.`
      : null, place, resultants(run)),
    summary: async () => (last?.profiles ? summaryOfProfiles((await readSurface(last)).profiles) : is3d ? summaryOfSurface(await readSurface(last)) : null),
    start: async () => {
      if (last?.profiles) place.append(...await contactIn2d(run, data.fields));
      if (is3d) place.append(...contactIn3d(run, await readSurface(last)));
    },
  };
}
