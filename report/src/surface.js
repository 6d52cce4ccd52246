// The surface of app/page/page_surface.h as triangles with separate corners, since stresses are discontinuous, and the fields on
// it.

import { unpackAll } from "./arrays.js";
import { axisNames, showsMeridian } from "./axes.js";
import { contactValues } from "./contact_parts.js";
import { latticeSides, latticeTriangles } from "./lattice.js";
import { stressFields, stressValues } from "./stress.js";
import { unit } from "./units.js";

/** The segments of the sides of all faces, each once, with the number of faces that share it. */
function uniqueSegments(faces, nFacePoints, k, nVertices) {
  const sides = latticeSides(k);
  const keys = new Float64Array((faces.length / nFacePoints) * 3 * k);
  let n = 0;
  for (let first = 0; first < faces.length; first += nFacePoints)
    for (const side of sides)
      for (let i = 0; i < k; ++i) {
        const a = faces[first + side[i]];
        const b = faces[first + side[i + 1]];
        keys[n++] = Math.min(a, b) * nVertices + Math.max(a, b);
      }
  keys.sort();
  const all = [];
  const single = [];
  for (let i = 0; i < n; ++i) {
    if (i > 0 && keys[i] === keys[i - 1]) continue;
    const segment = [Math.floor(keys[i] / nVertices), keys[i] % nVertices];
    all.push(...segment);
    if (keys[i] !== keys[i + 1]) single.push(...segment);
  }
  return { all: Uint32Array.from(all), boundary: Uint32Array.from(single) };
}

const read = new Map();

/** Each level is unpacked once. */
export function readSurface(level) {
  if (!read.has(level)) read.set(level, unpackSurface(level));
  return read.get(level);
}

async function unpackSurface(level) {
  const data = await unpackAll(level);
  const { dimension, subdivision: k, faces } = data;
  const nVertices = data.points.length / dimension;
  const triangles = latticeTriangles(k);
  const nFacePoints = ((k + 1) * (k + 2)) / 2;
  const nFaces = faces.length / nFacePoints;
  const lattice = new Uint32Array(nFaces * triangles.length); // per corner: its index in arrays of lattice points
  for (let face = 0, c = 0; face < nFaces; ++face)
    for (const point of triangles) lattice[c++] = face * nFacePoints + point;
  const vertex = new Uint32Array(lattice.length);
  for (let c = 0; c < vertex.length; ++c) vertex[c] = faces[lattice[c]];
  let segments = null;
  const surface = { ...data, nVertices, nFaces, nFacePoints, lattice, vertex,
    ...bodiesOf(data, nVertices, nFacePoints), trianglesPerFace: k * k, nContactFaces: data.contact ? data.contact.pressure.length / nFacePoints : 0,
    segments: () => (segments ??= uniqueSegments(faces, nFacePoints, k, nVertices)) };
  surface.box = boundingBox(surface);
  surface.largestDisplacement = largestLength(surface.displacement, dimension);
  return surface;
}

/** The number of bodies, and the body of each vertex; null if there is one body. */
function bodiesOf({ body, faces }, nVertices, nFacePoints) {
  if (!body) return { nBodies: 1, vertexBody: null };
  const vertexBody = new Uint32Array(nVertices);
  let last = 0;
  for (let i = 0; i < faces.length; ++i) {
    vertexBody[faces[i]] = body[Math.floor(i / nFacePoints)];
    last = Math.max(last, vertexBody[faces[i]]);
  }
  return { nBodies: last + 1, vertexBody };
}

export function boundingBox({ points, dimension }) {
  const low = [Infinity, Infinity, dimension === 2 ? 0 : Infinity];
  const high = [-Infinity, -Infinity, dimension === 2 ? 0 : -Infinity];
  for (let i = 0; i < points.length; ++i) {
    low[i % dimension] = Math.min(low[i % dimension], points[i]);
    high[i % dimension] = Math.max(high[i % dimension], points[i]);
  }
  const size = high.map((value, i) => value - low[i]);
  return { low, high, size, centre: low.map((value, i) => value + size[i] / 2), diagonal: Math.hypot(...size) };
}

function largestLength(vectors, dimension) {
  let largest = 0;
  for (let i = 0; i < vectors.length; i += dimension) {
    let square = 0;
    for (let c = 0; c < dimension; ++c) square += vectors[i + c] ** 2;
    largest = Math.max(largest, square);
  }
  return Math.sqrt(largest);
}

/**
 * Positions x + factor u about the centre of the box, 3 numbers per vertex. `layout`: the displacements of bodies; bodies that
 * are not shown collapse to a point.
 */
export function vertexPositions({ points, displacement, dimension, nVertices, box, vertexBody, lift }, factor, layout) {
  const positions = new Float32Array(3 * nVertices);
  for (let v = 0; v < nVertices; ++v) {
    const shift = vertexBody && layout ? layout[vertexBody[v]] : undefined;
    if (shift === null) continue;
    for (let c = 0; c < dimension; ++c)
      positions[3 * v + c] = points[dimension * v + c] + factor * displacement[dimension * v + c] - box.centre[c]
        + (shift ? shift[c] : 0) + (layout && lift ? lift[3 * v + c] : 0);
  }
  return positions;
}

/** The same for the corners of all triangles. */
export function cornerPositions({ vertex }, positions) {
  const result = new Float32Array(3 * vertex.length);
  for (let c = 0; c < vertex.length; ++c)
    for (let i = 0; i < 3; ++i) result[3 * c + i] = positions[3 * vertex[c] + i];
  return result;
}

/** A value for each of n corners. */
function perCorner(n, value) {
  const result = new Float32Array(n);
  for (let c = 0; c < n; ++c) result[c] = value(c);
  return result;
}

/** Values per face, vertex, lattice point or triangle as values per corner. */
const spread = {
  face: ({ lattice, nFacePoints }, values) => perCorner(lattice.length, (c) => values[Math.floor(lattice[c] / nFacePoints)]),
  lattice: ({ lattice }, values) => perCorner(lattice.length, (c) => values[lattice[c]]),
  vertex: ({ vertex }, value) => perCorner(vertex.length, (c) => value(vertex[c])),
};

/** Values per face, at the corners. */
export const faceValues = spread.face;

/** Stress at lattice points or, where a mesh is large, one value per face. */
function spreadStress(surface, value) {
  const { stress, out_of_plane: ratios, region, nFaces, nFacePoints } = surface;
  const perFace = stress[0].length === nFaces;
  const ratio = ratios && ((i) => ratios[region ? region[perFace ? i : Math.floor(i / nFacePoints)] : 0]);
  const values = stressValues(stress, ratio, value);
  return perFace ? spread.face(surface, values) : spread.lattice(surface, values);
}

/** A value for each vertex of a volume. */
function perPoint({ points }, value) {
  return Float32Array.from({ length: points.length / 3 }, (_, v) => value(v));
}

/** The fields of a surface: id, label, unit, group, kind of scale, corners(surface), and inside(volume) where known there. */
export function fieldsOf(surface, components) {
  const d = surface.dimension;
  const axes = axisNames(d);
  const hasContact = surface.nContactFaces > 0 || surface.pairs?.length > 0;
  const contactField = (id, label, measures) => ({ id: `contact-${id}`, label, unit: unit(measures), group: "Contact", kind: "sequential", contact: true,
    corners: (s) => contactValues(s, id) });
  const etaUnit = unit("stress_norm");
  const stressGroup = showsMeridian() ? "Stress (of u_h)" : "Stress (equilibrated)"; // on a meridian that is r times a stress
  return [
    { id: "u", label: "displacement, length", unit: unit("length"), group: "Solution", kind: "sequential",
      corners: (s) => spread.vertex(s, (v) => Math.hypot(...axes.map((_, c) => s.displacement[d * v + c]))),
      inside: (volume) => perPoint(volume, (v) => Math.hypot(...axes.map((_, c) => volume.displacement[d * v + c]))) },
    ...axes.map((axis, c) => ({ id: `u${axis}`, label: `displacement, ${axis}`, unit: unit("length"), group: "Solution", kind: "diverging",
      corners: (s) => spread.vertex(s, (v) => s.displacement[d * v + c]),
      inside: (volume) => perPoint(volume, (v) => volume.displacement[d * v + c]) })),
    ...stressFields(d).map(({ value, ...field }) => ({ ...field, unit: unit("stress"), group: stressGroup, trimmed: true,
      corners: (s) => spreadStress(s, value), inside: (volume) => stressValues(volume.stress, null, value) })),
    ...(surface.eta?.tot ? [{ id: "eta-tot", label: "\u03b7 of the cell, total", unit: etaUnit, group: "Error", kind: "logarithmic",
      corners: (s) => spread.face(s, s.eta.tot) }] : []),
    ...components.filter(({ name }) => surface.eta[name]).map(({ name, meaning }) => ({ id: `eta-${name}`,
      label: `\u03b7 ${name}: ${meaning}`, unit: etaUnit, group: "Error", kind: "logarithmic", corners: (s) => spread.face(s, s.eta[name]) })),
    ...(hasContact ? [contactField("pressure", "contact pressure", "stress"), contactField("friction", "friction, length", "stress"),
      contactField("limit", "limit of friction", "stress"), contactField("gap", "gap", "length"), contactField("slip", "slip, length", "length"),
      { id: "contact-status", label: "contact status", unit: "", group: "Contact", kind: "status", contact: true,
        corners: (s) => contactValues(s, "status") }] : []),
    ...(surface.region ? [{ id: "region", label: "region", unit: "", group: "Mesh", kind: "category",
      corners: (s) => spread.face(s, s.region) }] : []),
    ...(surface.body ? [{ id: "body", label: "body", unit: "", group: "Mesh", kind: "category",
      corners: (s) => spread.face(s, s.body) }] : []),
  ];
}

/** A field as a table of the points of the faces; faces that share a point may have different values there. `shown`: has its corners. */
export function fieldRows(surface, shown, { id, corners }) {
  const { points, dimension: d, vertex } = shown;
  const rows = new Map();
  corners(surface).forEach((value, c) => {
    const place = shown === surface ? surface.lattice[c] : c;
    if (!rows.has(place)) rows.set(place, { ...Object.fromEntries(axisNames(d).map((axis, i) => [axis, points[d * vertex[c] + i]])), [id]: value });
  });
  return [...rows.values()];
}

/** Twice the area of the triangle with the first corner c, undeformed, times its normal, which points outwards. */
export function areaVector({ points, dimension, vertex }, c) {
  const side = (i, axis) => (axis < dimension ? points[dimension * vertex[c + i] + axis] - points[dimension * vertex[c] + axis] : 0);
  const [ux, uy, uz] = [side(1, 0), side(1, 1), side(1, 2)];
  const [vx, vy, vz] = [side(2, 0), side(2, 1), side(2, 2)];
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

/** The size below which the fraction `part` of the area lies, rounded up to a bin of a logarithmic histogram. */
function areaQuantile(surface, values, part, high) {
  const nBins = 4096;
  if (high === 0) return 0;
  const bottom = Math.log(1e-6 * high);
  const perBin = (Math.log(high) - bottom) / nBins || 1;
  const area = new Float64Array(nBins);
  for (let c = 0; c < values.length; c += 3) {
    const [x, y, z] = areaVector(surface, c);
    const largest = Math.max(Math.abs(values[c]), Math.abs(values[c + 1]), Math.abs(values[c + 2]));
    const bin = Math.floor((Math.log(largest) - bottom) / perBin);
    area[Math.max(0, Math.min(nBins - 1, bin))] += Math.sqrt(x * x + y * y + z * z);
  }
  let rest = part * area.reduce((a, b) => a + b, 0);
  const last = area.findIndex((weight) => (rest -= weight) <= 0);
  return last < 0 ? high : Math.exp(bottom + (last + 1) * perBin);
}

/** The colour range of a field; stresses are cut off where a singular corner would use up all colours. */
export function colourRange(surface, field, values) {
  let [low, high] = [Infinity, -Infinity];
  let positive = Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
    if (value > 0 && value < positive) positive = value;
  }
  const range = { low, high, largest: high };
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (field.trimmed) range.high = Math.min(size, areaQuantile(surface, values, 0.995, size));
  if (field.kind === "sequential" && low >= 0 && low < 0.5 * high) range.low = 0;
  if (field.kind === "diverging") {
    if (!field.trimmed) range.high = size;
    Object.assign(range, { low: -range.high, largest: size });
  }
  if (field.kind === "logarithmic") range.low = Math.max(positive, high * 1e-4);
  if (field.kind === "status") Object.assign(range, { low: 0, high: 3, present: [...new Set(values)] });
  if (!(range.high > range.low)) range.high = range.low + (Math.abs(range.low) || 1) * 1e-6;
  return range;
}
