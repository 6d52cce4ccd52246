// The surface of src/io/page_surface.h as triangles with corners of their own, since stresses jump, and the fields on it.

import { unpackAll } from "./arrays.js";

/** The triangles of a face in the numbers of its lattice, in the order of triangle_middles(). */
function latticeTriangles(k) {
  const place = (i, j) => j * (k + 1) - (j * (j - 1)) / 2 + i;
  const triangles = [];
  for (let j = 0; j < k; ++j)
    for (let i = 0; i + j < k; ++i) {
      triangles.push(place(i, j), place(i + 1, j), place(i, j + 1));
      if (i + j + 1 < k) triangles.push(place(i + 1, j), place(i + 1, j + 1), place(i, j + 1));
    }
  return triangles;
}

/** The lattice points along the three sides of a face, k + 1 each. */
function latticeSides(k) {
  const place = (i, j) => j * (k + 1) - (j * (j - 1)) / 2 + i;
  const along = Array.from({ length: k + 1 }, (_, i) => i);
  return [along.map((i) => place(i, 0)), along.map((i) => place(k - i, i)), along.map((i) => place(0, k - i))];
}

/** Segments of the sides of all faces, each once, and how many faces have it. */
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

export async function readSurface(level) {
  const data = await unpackAll(level);
  const { dimension, subdivision: k, faces } = data;
  const nVertices = data.points.length / dimension;
  const triangles = latticeTriangles(k);
  const nFacePoints = ((k + 1) * (k + 2)) / 2;
  const nFaces = faces.length / nFacePoints;
  const lattice = new Uint32Array(nFaces * triangles.length); // per corner: its place in arrays of lattice points
  for (let face = 0, c = 0; face < nFaces; ++face)
    for (const point of triangles) lattice[c++] = face * nFacePoints + point;
  const vertex = lattice.map((place) => faces[place]);
  let segments = null;
  const surface = { ...data, nVertices, nFaces, nFacePoints, lattice, vertex,
    trianglesPerFace: k * k, nContactFaces: data.contact ? data.contact.pressure.length / nFacePoints : 0,
    segments: () => (segments ??= uniqueSegments(faces, nFacePoints, k, nVertices)) };
  surface.box = boundingBox(surface);
  surface.largestDisplacement = largestLength(surface.displacement, dimension);
  return surface;
}

function boundingBox({ points, dimension }) {
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

/** Positions x + factor u about the centre of the box, 3 numbers per vertex. */
export function vertexPositions({ points, displacement, dimension, nVertices, box }, factor) {
  const positions = new Float32Array(3 * nVertices);
  for (let v = 0; v < nVertices; ++v)
    for (let c = 0; c < dimension; ++c)
      positions[3 * v + c] = points[dimension * v + c] + factor * displacement[dimension * v + c] - box.centre[c];
  return positions;
}

/** The same for the corners of all triangles. */
export function cornerPositions({ vertex }, positions) {
  const result = new Float32Array(3 * vertex.length);
  for (let c = 0; c < vertex.length; ++c)
    for (let i = 0; i < 3; ++i) result[3 * c + i] = positions[3 * vertex[c] + i];
  return result;
}

/** Values per face, vertex, lattice point or triangle as values per corner. */
const spread = {
  face: ({ lattice, nFacePoints }, values) => Float32Array.from(lattice, (place) => values[Math.floor(place / nFacePoints)]),
  lattice: ({ lattice }, values) => Float32Array.from(lattice, (place) => values[place]),
  vertex: ({ vertex }, value) => Float32Array.from(vertex, value),
  triangle: (surface, values) => {
    const result = new Float32Array(3 * values.length);
    for (let i = 0; i < result.length; ++i) result[i] = values[Math.floor(i / 3)];
    return result;
  },
};

/** Contact values are those of the first faces only. */
const ofContact = (read) => (surface) => {
  const { lattice, nContactFaces, trianglesPerFace } = surface;
  return read({ ...surface, lattice: lattice.subarray(0, 3 * nContactFaces * trianglesPerFace) });
};

/** The fields of a surface: id, label, unit, group, kind of scale and corners(surface). */
export function fieldsOf(surface, components) {
  const d = surface.dimension;
  const axes = ["x", "y", "z"].slice(0, d);
  const contactField = (id, label, unit) => ({ id: `contact-${id}`, label, unit, group: "Contact", kind: "sequential", contact: true,
    corners: ofContact((s) => spread.lattice(s, s.contact[id])) });
  const etaUnit = d === 2 ? "S L" : "S L^(3/2)";
  return [
    { id: "u", label: "displacement, length", unit: "L", group: "Solution", kind: "sequential",
      corners: (s) => spread.vertex(s, (v) => Math.hypot(...axes.map((_, c) => s.displacement[d * v + c]))) },
    ...axes.map((axis, c) => ({ id: `u${axis}`, label: `displacement, ${axis}`, unit: "L", group: "Solution", kind: "diverging",
      corners: (s) => spread.vertex(s, (v) => s.displacement[d * v + c]) })),
    { id: "von_mises", label: "von Mises (equilibrated)", unit: "S", group: "Solution", kind: "sequential", trimmed: true,
      corners: (s) => spread.lattice(s, s.von_mises) },
    ...(surface.eta.tot ? [{ id: "eta-tot", label: "\u03b7 of the cell, total", unit: etaUnit, group: "Error", kind: "logarithmic",
      corners: (s) => spread.face(s, s.eta.tot) }] : []),
    ...components.filter(({ name }) => surface.eta[name]).map(({ name, symbol, meaning }) => ({ id: `eta-${name}`,
      label: `${symbol}: ${meaning}`, unit: etaUnit, group: "Error", kind: "logarithmic", corners: (s) => spread.face(s, s.eta[name]) })),
    ...(surface.nContactFaces > 0 ? [contactField("pressure", "contact pressure", "S"), contactField("friction", "friction, length", "S"),
      contactField("limit", "limit of friction", "S"), contactField("gap", "gap", "L"), contactField("slip", "slip, length", "L"),
      { id: "contact-status", label: "contact status", unit: "", group: "Contact", kind: "status", contact: true,
        corners: (s) => spread.triangle(s, s.contact.status) }] : []),
    ...(surface.region ? [{ id: "region", label: "region", unit: "", group: "Mesh", kind: "category",
      corners: (s) => spread.face(s, s.region) }] : []),
  ];
}

/** Twice the area of the triangle with the first corner c, undeformed, times its normal, which points outwards. */
export function areaVector({ points, dimension, vertex }, c) {
  const side = (i, axis) => (axis < dimension ? points[dimension * vertex[c + i] + axis] - points[dimension * vertex[c] + axis] : 0);
  const [ux, uy, uz] = [side(1, 0), side(1, 1), side(1, 2)];
  const [vx, vy, vz] = [side(2, 0), side(2, 1), side(2, 2)];
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

/** The value below which the fraction `part` of the area lies. */
function areaQuantile(surface, values, part) {
  const n = values.length / 3;
  const weight = Float64Array.from({ length: n }, (_, t) => Math.hypot(...areaVector(surface, 3 * t)));
  const largest = Float64Array.from({ length: n }, (_, t) => Math.max(values[3 * t], values[3 * t + 1], values[3 * t + 2]));
  const order = Uint32Array.from({ length: n }, (_, t) => t).sort((a, b) => largest[a] - largest[b]);
  let rest = part * weight.reduce((a, b) => a + b, 0);
  for (const t of order) {
    rest -= weight[t];
    if (rest <= 0) return largest[t];
  }
  return largest[order.at(-1)];
}

/** The range of colours of a field; stresses are cut off where a singular corner would take all colours. */
export function colourRange(surface, field, values) {
  let [low, high] = [Infinity, -Infinity];
  let positive = Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
    if (value > 0 && value < positive) positive = value;
  }
  const range = { low, high, largest: high };
  if (field.trimmed) range.high = Math.min(high, areaQuantile(surface, values, 0.995));
  if (field.kind === "sequential" && low >= 0 && low < 0.5 * high) range.low = 0;
  if (field.kind === "diverging") {
    range.high = Math.max(Math.abs(low), Math.abs(high));
    range.low = -range.high;
  }
  if (field.kind === "logarithmic") range.low = Math.max(positive, high * 1e-4);
  if (field.kind === "status") Object.assign(range, { low: 0, high: 2 });
  if (!(range.high > range.low)) range.high = range.low + (Math.abs(range.low) || 1) * 1e-6;
  return range;
}
