// The contact boundary: in 2D curves over its length with open, sticking and slipping zones shaded, in 3D values over a
// coordinate.

import * as Plot from "@observablehq/plot";
import { chartStyle, responsive } from "./charts.js";
import { statusColours, statusNames } from "./components.js";
import { element, number, section, table } from "./dom.js";
import { readSurface } from "./surface.js";
import { unpackAll } from "./arrays.js";

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
  { title: "contact pressure [S]", curves: [{ key: "pressure", colour: "#0072b2" }], zero: true },
  { title: "friction [S], dashed: its limit", limits: true, curves: [{ key: "friction", colour: "#d55e00" }] },
  { title: "gap [L]", curves: [{ key: "gap", colour: "#009e73" }], zero: true },
  { title: "slip [L]", curves: [{ key: "slip", colour: "#8458a3" }], zero: true },
];

function panel(profile, rows, zones, { title, curves, limits, zero }, width, isLast) {
  const hasLimit = limits && rows.some((row) => row.limit > 0);
  return Plot.plot({
    width, height: isLast ? 162 : 132, marginLeft: 58, marginTop: 24, marginBottom: isLast ? 44 : 16, marginRight: 12,
    style: chartStyle,
    x: { domain: [rows[0].arc, rows.at(-1).arc], label: isLast ? "length along the boundary [L]" : null, ticks: isLast ? undefined : [] },
    y: { label: title, labelAnchor: "top", labelArrow: "none", ticks: 4, nice: true, grid: true, zero, tickFormat: (value) => number(value, 3) },
    marks: [
      Plot.rect(zones, { x1: "from", x2: "to", fill: (zone) => statusColours[zone.status], fillOpacity: 0.13 }),
      Plot.ruleY([0], { strokeOpacity: 0.5 }),
      hasLimit ? Plot.line(rows, { x: "arc", y: "limit", strokeDasharray: "4 3", strokeOpacity: 0.8 }) : null,
      hasLimit ? Plot.line(rows, { x: "arc", y: (row) => -row.limit, strokeDasharray: "4 3", strokeOpacity: 0.8 }) : null,
      ...curves.map(({ key, colour }) => Plot.line(rows, { x: "arc", y: key, stroke: colour, strokeWidth: 1.75 })),
      ...curves.map(({ key }) => Plot.ruleX(rows, Plot.pointerX({ x: "arc", py: key, strokeOpacity: 0.35 }))),
      ...curves.map(({ key }) => Plot.tip(rows, Plot.pointerX({ x: "arc", y: key, title: (row) =>
        `${number(row[key])}${limits && row.limit > 0 ? `, limit ${number(row.limit)}` : ""}, ${statusNames[row.status]}\nx = ${number(row.x)}, y = ${number(row.y)}` }))),
    ],
  });
}

function profileCharts(profile) {
  const rows = Array.from(profile.arc, (arc, i) => ({ arc, x: profile.points[2 * i], y: profile.points[2 * i + 1],
    pressure: profile.pressure[i], friction: profile.friction[i], limit: profile.limit[i], gap: profile.gap[i],
    slip: profile.slip[i], status: profile.status[i] }));
  const zones = zonesOf(profile);
  const present = [0, 1, 2].filter((kind) => zones.some(({ status }) => status === kind));
  return element("figure", {}, element("h3", {}, profile.boundary),
    element("ul", { class: "legend" }, present.map((kind) =>
      element("li", {}, element("span", { class: "swatch swatch-zone", style: `--colour:${statusColours[kind]}` }), statusNames[kind]))),
    responsive(`Contact pressure, friction, gap and slip along ${profile.boundary}`, (width) => element("div", {},
      panels.map((what, i) => panel(profile, rows, zones, what, width, i === panels.length - 1)))),
    zoneText(zones));
}

/** Where the zones meet. */
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

/** The coordinate over which the pressure goes up and down least. */
function bestCoordinate(rows, names) {
  const variation = (name) => {
    const sorted = [...rows].sort((a, b) => a[name] - b[name]);
    if (sorted[0][name] === sorted.at(-1)[name]) return Infinity;
    return sorted.reduce((sum, row, i) => (i === 0 ? 0 : sum + Math.abs(row.pressure - sorted[i - 1].pressure)), 0);
  };
  return names.map((name) => [variation(name), name]).reduce((best, other) => (other[0] < best[0] ? other : best))[1];
}

function scatterCharts(surface) {
  const { rows, centre } = contactPoints(surface, 3000);
  const coordinates = { x: "x [L]", y: "y [L]", z: "z [L]", r: `distance from the largest pressure, at (${["x", "y", "z"].map((axis) => number(centre[axis], 3)).join(", ")}) [L]` };
  const quantities = { pressure: "contact pressure [S]", friction: "friction, length [S]", gap: "gap [L]", slip: "slip, length [L]" };
  const options = (names) => Object.entries(names).map(([value, name]) => element("option", { value }, name));
  const coordinate = element("select", { id: "contact-coordinate" }, options(coordinates));
  const quantity = element("select", { id: "contact-quantity" }, options(quantities));
  const place = element("div", {});
  const draw = () => place.replaceChildren(responsive("Contact values over a coordinate", (width) => Plot.plot({
    width, height: 330, marginLeft: 58, marginTop: 26, marginBottom: 46, style: chartStyle, grid: true,
    x: { label: coordinates[coordinate.value] }, y: { label: quantities[quantity.value], nice: true, tickFormat: (value) => number(value, 3) },
    marks: [Plot.ruleY([0], { strokeOpacity: 0.5 }),
      Plot.dot(rows, { x: coordinate.value, y: quantity.value, r: 2, fill: (row) => statusColours[row.status], fillOpacity: 0.75 }),
      Plot.tip(rows, Plot.pointer({ x: coordinate.value, y: quantity.value, title: (row) =>
        `${number(row[quantity.value])}, ${statusNames[row.status]}\n(${["x", "y", "z"].map((axis) => number(row[axis])).join(", ")})` }))],
  })));
  for (const input of [coordinate, quantity]) input.addEventListener("change", draw);
  coordinate.value = bestCoordinate(rows, Object.keys(coordinates));
  draw();
  return element("figure", {}, element("div", { class: "controls screen-only" },
    element("label", { class: "control" }, element("span", {}, "Show"), quantity),
    element("label", { class: "control" }, element("span", {}, "over"), coordinate)),
    element("ul", { class: "legend" }, statusNames.map((name, i) => element("li", {}, element("span", { class: "swatch", style: `--colour:${statusColours[i]}` }), name))),
    place, element("figcaption", {}, "Points of the contact boundary. The picture above shows the same values in place."));
}

function resultants(run) {
  const parts = Object.entries(run.contact.boundaries);
  const unit = run.d === 2 ? "S L" : "S L\u00b2";
  const isSliding = parts.some(([, part]) => part.sliding);
  const row = (name, part) => [name, number(part.normal, 6), number(part.tangential, 6), number(part.abs_tangential, 6),
    `(${part.force.map((f) => number(f, 6)).join(", ")})`,
    ...(isSliding ? [number(part.sliding?.sliding_factor), number(part.sliding?.safety_factor)] : [])];
  const rows = parts.map(([name, part]) => row(name, part));
  if (parts.length > 1) rows.push(row("in all", run.contact));
  return [element("h3", {}, "Resultants"), table(["boundary", `#normal [${unit}]`, `#tangential [${unit}]`, `#|tangential| [${unit}]`,
    `#force on the body [${unit}]`, ...(isSliding ? ["#mobilised friction", "#safety against sliding"] : [])], rows)];
}

/** `show(place)` fills the section once the data are unpacked. */
export function contactSection(data) {
  const run = data.certificate;
  if (!run.contact || run.status === "failed") return { element: null, start: async () => {} };
  const place = element("div", { class: "contact" });
  const last = data.fields.at(-1);
  return {
    element: section("contact", "Contact", "The contact boundary", last?.profiles || last?.contact
      ? "Pressure is positive in compression; friction and slip are those of the body along the boundary; the gap is the distance left to the obstacle."
      : null, place, resultants(run)),
    start: async () => {
      if (last?.profiles) place.append(...(await unpackAll(last.profiles)).filter(({ arc }) => arc.length > 1).map(profileCharts));
      if (last?.contact) place.append(scatterCharts(await readSurface(last)));
    },
  };
}
