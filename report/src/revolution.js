// A body of revolution: its meridian mirrored at the axis, or three quarters of the body, of which the section is seen. Both are
// surfaces for the picture; `meridian` has the fields at their corners.

import { latticeSides } from "./lattice.js";
import { boundingBox } from "./surface.js";

const quarters = 3;
const stepsPerQuarter = 16;

/** The ways to show a body of revolution: id and name. */
export const ways = [["meridian", "meridian"], ["mirrored", "mirrored at the axis"], ["body", "body of revolution"]];

/** Whether a segment of two vertices lies on the axis. */
function isOnAxis({ points, box }, a, b) {
  return Math.max(points[2 * a], points[2 * b]) <= 1e-12 * box.diagonal;
}

/** Copies an array of vectors of 2 components as vectors of `width`. */
function mapped(vectors, map, width) {
  const result = new Float32Array((vectors.length / 2) * width);
  for (let v = 0; 2 * v < vectors.length; ++v) map(vectors[2 * v], vectors[2 * v + 1]).forEach((x, c) => { result[width * v + c] = x; });
  return result;
}

function concatenated(first, ...others) {
  const result = new first.constructor(first.length + others.reduce((sum, { length }) => sum + length, 0));
  let place = 0;
  for (const part of [first, ...others]) {
    result.set(part, place);
    place += part.length;
  }
  return result;
}

const shifted = (numbers, by) => numbers.map((v) => v + by);

/** `surface`: of the meridian, by readSurface(). */
function mirrored(surface) {
  const { points, displacement, vertex, lattice, nVertices } = surface;
  const both = (vectors) => concatenated(vectors, mapped(vectors, (r, z) => [-r, z], 2));
  const twice = (numbers) => concatenated(numbers, numbers);
  const profiles = surface.profiles?.flatMap((profile) => {
    const reflected = Object.fromEntries(["points", "displacement", "normal", "opposite", "opposite_displacement"].filter((name) => profile[name]).map((name) => [name, mapped(profile[name], (r, z) => [-r, z], 2)]));
    return [profile, { ...profile, ...reflected }];
  });
  const segments = (all) => concatenated(all, shifted(all, nVertices));
  const result = { ...surface, points: both(points), displacement: both(displacement), nVertices: 2 * nVertices,
    vertex: concatenated(vertex, shifted(vertex, nVertices)), interfaces: undefined, profiles,
    vertexBody: surface.vertexBody && twice(surface.vertexBody),
    meridian: { ...surface, vertex: twice(vertex), lattice: twice(lattice) },
    segments: () => ({ all: segments(surface.segments().all), boundary: segments(offAxis(surface, surface.segments().boundary)) }) };
  return Object.assign(result, { box: boundingBox(result) });
}

function offAxis(surface, segments) {
  return segments.filter((_, i) => !isOnAxis(surface, segments[i & ~1], segments[i | 1]));
}

/** The places in the arrays of lattice points of the two ends of each segment of the boundary off the axis, the body on the left. */
function rim(surface) {
  const { faces, nFacePoints, subdivision: k, nVertices } = surface;
  const found = new Map();
  for (let first = 0; first < faces.length; first += nFacePoints)
    for (const side of latticeSides(k))
      for (let i = 0; i < k; ++i) {
        const [from, to] = [first + side[i], first + side[i + 1]];
        const [a, b] = [faces[from], faces[to]];
        const key = Math.min(a, b) * nVertices + Math.max(a, b);
        found.set(key, found.has(key) || isOnAxis(surface, a, b) ? null : [from, to]);
      }
  return [...found.values()].filter(Boolean);
}

/** The section at both ends, and between them the boundary, swept around the z axis. */
function revolved(surface) {
  const { points, displacement, faces, vertex, lattice, nVertices } = surface;
  const nSteps = quarters * stepsPerQuarter;
  const at = (step) => {
    const angle = (step / nSteps) * quarters * (Math.PI / 2);
    return (r, z) => [r * Math.cos(angle), r * Math.sin(angle), z];
  };
  const sweep = (vectors) => concatenated(...Array.from({ length: nSteps + 1 }, (_, step) => mapped(vectors, at(step), 3)));
  const corners = [];
  for (const [from, to] of rim(surface))
    for (let step = 0; step < nSteps; ++step)
      for (const [place, angle] of [[from, step], [to, step + 1], [to, step], [from, step], [from, step + 1], [to, step + 1]]) corners.push(place, angle);
  const places = Uint32Array.from({ length: corners.length / 2 }, (_, c) => corners[2 * c]);
  const around = Uint32Array.from(places, (place, c) => faces[place] + corners[2 * c + 1] * nVertices);
  const last = nSteps * nVertices;
  const ends = (all) => concatenated(all, shifted(all, last));
  const result = { ...surface, dimension: 3, points: sweep(points), displacement: sweep(displacement), nVertices: (nSteps + 1) * nVertices,
    vertex: concatenated(vertex, shifted(vertex, last), around), interfaces: undefined, profiles: undefined,
    vertexBody: surface.vertexBody && concatenated(...Array(nSteps + 1).fill(surface.vertexBody)),
    meridian: { ...surface, vertex: concatenated(vertex, vertex, Uint32Array.from(places, (place) => faces[place])), lattice: concatenated(lattice, lattice, places) },
    words: "Shown are three quarters of the body of revolution.", direction: { azimuth: 50, elevation: 25 }, // into the quarter that is left out
    segments: () => ({ all: ends(surface.segments().all) }) };
  return Object.assign(result, { box: boundingBox(result) });
}

const made = { mirrored: new Map(), body: new Map() };
const makers = { mirrored, body: revolved };

/** The surface in one of these ways; each is made once. Other bodies are shown as they are. */
export function shownAs(surface, way) {
  if (way === "meridian") return surface;
  if (!made[way].has(surface)) made[way].set(surface, makers[way](surface));
  return made[way].get(surface);
}
