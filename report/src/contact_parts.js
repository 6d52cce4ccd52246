// Contact in 3D: triangles with values, boundary by boundary, from faces against obstacles and from segments between bodies.

import { latticePoints, latticeTriangles, latticeWeights } from "./lattice.js";

export const contactColumns = ["pressure", "friction", "limit", "gap", "slip"];

/**
 * Triangles on faces, each cut into those of a lattice, with corners anticlockwise as seen from outside; `corners`: of the
 * triangles on their faces, null for whole faces; `values`: per lattice point of each, `status` per triangle.
 */
function partOnFaces(surface, boundary, side, { faces, corners }, { subdivision, values }) {
  const [triangles, lattice] = [latticeTriangles(subdivision), latticePoints(subdivision)];
  const nCorners = faces.length * triangles.length;
  const part = { boundary, side, nCorners, points: new Float64Array(3 * nCorners), displacement: new Float64Array(3 * nCorners),
    body: new Uint32Array(nCorners), place: new Uint32Array(nCorners),
    face: Uint32Array.from({ length: nCorners / 3 }, (_, t) => faces[Math.floor((3 * t) / triangles.length)]), status: values.status };
  const { subdivision: k, nFacePoints, vertexBody } = surface;
  let corner = 0;
  for (let n = 0; n < faces.length; ++n) {
    const [sa, ta, sb, tb, sc, tc] = corners ? corners.subarray(6 * n, 6 * n + 6) : [0, 0, 1, 0, 0, 1];
    const isTurned = (sb - sa) * (tc - ta) < (sc - sa) * (tb - ta);
    const vertices = surface.faces.subarray(faces[n] * nFacePoints, (faces[n] + 1) * nFacePoints);
    for (let c = 0; c < triangles.length; ++c, ++corner) {
      const place = triangles[isTurned && c % 3 > 0 ? c + 3 - 2 * (c % 3) : c];
      const [i, j] = lattice[place];
      const on = latticeWeights(k, sa + i * (sb - sa) + j * (sc - sa), ta + i * (tb - ta) + j * (tc - ta));
      for (const name of ["points", "displacement"])
        for (let x = 0; x < 3; ++x)
          part[name][3 * corner + x] = on.weights.reduce((sum, w, m) => sum + w * surface[name][3 * vertices[on.places[m]] + x], 0);
      part.place[corner] = n * lattice.length + place;
      part.body[corner] = vertexBody ? vertexBody[vertices[0]] : 0;
    }
  }
  part.values = (id) => Float32Array.from(part.place, (place) => values[id][place]);
  return part;
}

/** Contact with obstacles: the first faces of the surface, boundary by boundary. */
function obstacleParts(surface) {
  const { contact, nFacePoints, subdivision, nContactFaces } = surface;
  if (nContactFaces === 0) return [];
  const { names, of_faces: tags } = contact.boundary;
  return [...new Set(tags)].map((tag) => {
    const faces = Array.from({ length: nContactFaces }, (_, face) => face).filter((face) => tags[face] === tag);
    const taken = (values, width) => Float64Array.from({ length: faces.length * width }, (_, i) => values[faces[Math.floor(i / width)] * width + (i % width)]);
    const values = Object.fromEntries(contactColumns.map((id) => [id, taken(contact[id], nFacePoints)]));
    return partOnFaces(surface, names[tag], "obstacle", { faces, corners: null },
      { subdivision, values: { ...values, status: taken(contact.status, subdivision ** 2) } });
  });
}

/** Contact between bodies: segments on both sides, or means over the facets of one. */
function pairParts(surface) {
  return (surface.pairs ?? []).flatMap((pair) => ["slave", "master"].filter((side) => pair[side]).map((side) =>
    Object.assign(partOnFaces(surface, pair.boundary, side, pair[side], pair), { around: pair.boundary_faces })));
}

/** All parts of a surface; `side`: "obstacle", "slave" or "master"; `around`: the faces of the slave, covered or not. */
export function contactParts(surface) {
  surface.parts ??= [...obstacleParts(surface), ...pairParts(surface)];
  return surface.parts;
}

/** The parts with the values of a boundary, each place once. */
export function contactSides(surface) {
  return contactParts(surface).filter(({ side }) => side !== "master");
}

/** Twice the area of the triangle with the first corner c times its normal, which points outwards. */
export function partArea({ points }, c) {
  const side = (i, k) => points[3 * (c + i) + k] - points[3 * c + k];
  const [u, v] = [1, 2].map((i) => [side(i, 0), side(i, 1), side(i, 2)]);
  return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
}

function joined(Kind, arrays) {
  const result = new Kind(arrays.reduce((sum, array) => sum + array.length, 0));
  let place = 0;
  for (const array of arrays) {
    result.set(array, place);
    place += array.length;
  }
  return result;
}

/**
 * The surface with the segments between bodies, whose corners precede all others, since coloured ones come first; `lift`: keeps
 * them in front of the faces they lie on. Returns the same surface where there are none.
 */
export function withSegments(surface) {
  surface.layered ??= layered(surface);
  return surface.layered;
}

function layered(surface) {
  const parts = contactParts(surface).filter(({ side }) => side !== "obstacle");
  if (parts.length === 0) return surface;
  const height = 1.5e-3 * surface.box.diagonal;
  const nLayer = parts.reduce((sum, { nCorners }) => sum + nCorners, 0);
  const nVertices = surface.nVertices + nLayer;
  const lift = new Float32Array(3 * nVertices);
  let place = 3 * surface.nVertices;
  for (const part of parts)
    for (let c = 0; c < part.nCorners; c += 3) {
      const area = partArea(part, c);
      const length = Math.hypot(...area) || 1;
      for (let i = 0; i < 9; ++i) lift[place++] = (height * area[i % 3]) / length;
    }
  const layer = Uint32Array.from({ length: nLayer }, (_, c) => surface.nVertices + c);
  return { ...surface, nVertices, lift, points: joined(Float64Array, [surface.points, ...parts.map(({ points }) => points)]),
    displacement: joined(Float64Array, [surface.displacement, ...parts.map(({ displacement }) => displacement)]),
    vertexBody: surface.vertexBody && joined(Uint32Array, [surface.vertexBody, ...parts.map(({ body }) => body)]),
    vertex: joined(Uint32Array, [layer, surface.vertex]) };
}

/** Values at the first corners of withSegments(): on both sides between bodies, then against obstacles. */
export function contactValues(surface, id) {
  const { lattice, nContactFaces, trianglesPerFace, contact } = surface;
  const segments = contactParts(surface).filter(({ side }) => side !== "obstacle");
  const nObstacle = 3 * nContactFaces * trianglesPerFace;
  const isStatus = id === "status";
  const ofSegments = segments.map((part) => (isStatus ? Float32Array.from({ length: part.nCorners }, (_, c) => part.status[Math.floor(c / 3)]) : part.values(id)));
  const ofObstacles = Float32Array.from({ length: nObstacle }, (_, c) => (isStatus ? contact.status[Math.floor(c / 3)] : contact[id][lattice[c]]));
  return joined(Float32Array, [...ofSegments, ofObstacles]);
}
