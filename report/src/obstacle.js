// The rigid obstacle opposite the contact boundary. Distances are enlarged like the displacements: where the body touches it, it
// touches it in the picture.

import { areaVector } from "./surface.js";

const farAway = 2; // diagonals of the body beyond which the obstacle is not drawn

/** In 2D: the obstacle's point for each point of a profile, undefined where that is far away; relative to the centre of the body. */
export function obstaclePoints({ points, displacement, normal, gap }, box, factor) {
  return Array.from(gap, (distance, i) => {
    const g = distance + displacement[2 * i] * normal[2 * i] + displacement[2 * i + 1] * normal[2 * i + 1];
    if (Math.abs(factor * g) > farAway * box.diagonal) return undefined;
    return [0, 1].map((c) => points[2 * i + c] + factor * g * normal[2 * i + c] - box.centre[c]);
  });
}

/** Unit normals at the vertices of the contact faces in 3D, means of those around them. */
function vertexNormals(surface, nCorners) {
  const normals = new Float64Array(3 * surface.nVertices);
  for (let c = 0; c < nCorners; c += 3) {
    const area = areaVector(surface, c);
    for (let i = 0; i < 3; ++i) for (let k = 0; k < 3; ++k) normals[3 * surface.vertex[c + i] + k] += area[k];
  }
  for (let v = 0; v < normals.length; v += 3) {
    const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[v + k] /= length;
  }
  return normals;
}

/** In 3D: corners of triangles, relative to the centre of the body; `layout`: the displacements of bodies. */
export function obstacleCorners(surface, factor, layout) {
  const { points, displacement, vertex, vertexBody, lattice, contact, box } = surface;
  const nCorners = 3 * surface.nContactFaces * surface.trianglesPerFace;
  const normals = vertexNormals(surface, nCorners);
  const corners = [];
  for (let first = 0; first < nCorners; first += 3) {
    const shift = vertexBody && layout ? layout[vertexBody[vertex[first]]] : [0, 0, 0];
    if (!shift) continue;
    const triangle = [0, 1, 2].map((i) => {
      const place = 3 * vertex[first + i];
      const along = [0, 1, 2].reduce((sum, k) => sum + displacement[place + k] * normals[place + k], 0);
      const g = contact.gap[lattice[first + i]] + along;
      return { g, point: [0, 1, 2].map((k) => points[place + k] + factor * g * normals[place + k] - box.centre[k] + shift[k]) };
    });
    if (triangle.every(({ g }) => Math.abs(factor * g) <= farAway * box.diagonal)) corners.push(...triangle.flatMap(({ point }) => point));
  }
  return Float32Array.from(corners);
}
