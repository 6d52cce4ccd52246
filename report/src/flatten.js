// The contact boundary in 3D mapped to a plane: projected along its mean normal, or unrolled where it is part of a cylinder.

import { partArea } from "./contact_parts.js";

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, factor) => a.map((x) => factor * x);
const unit = (a) => scaled(a, 1 / Math.hypot(...a));
const coordinateAxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/** Eigenvalues of a symmetric 3 x 3 matrix, the smallest first, and its eigenvectors: Jacobi's rotations. */
export function eigen(matrix) {
  const a = matrix.map((row) => [...row]);
  const v = coordinateAxes.map((row) => [...row]); // the rows are the vectors
  for (let sweep = 0; sweep < 12; ++sweep)
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (a[p][q] === 0) continue;
      const angle = 0.5 * Math.atan2(2 * a[p][q], a[q][q] - a[p][p]);
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      for (let k = 0; k < 3; ++k) [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
      for (let k = 0; k < 3; ++k) [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
      for (let k = 0; k < 3; ++k) [v[p][k], v[q][k]] = [c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]];
    }
  return [0, 1, 2].sort((i, j) => a[i][i] - a[j][j]).map((i) => ({ value: a[i][i], vector: v[i] }));
}

/** Middle, unit normal and area of each triangle. */
function trianglesOf(parts) {
  return parts.flatMap((part) => Array.from({ length: part.nCorners / 3 }, (_, t) => {
    const area = partArea(part, 3 * t);
    const size = Math.hypot(...area);
    const middle = [0, 1, 2].map((k) => (part.points[9 * t + k] + part.points[9 * t + 3 + k] + part.points[9 * t + 6 + k]) / 3);
    return { size, normal: scaled(area, 1 / (size || 1)), middle };
  }));
}

/** "x" for a coordinate axis, otherwise its components. */
function nameOf(axis) {
  const place = axis.findIndex((x) => x > 1 - 1e-9);
  return place >= 0 ? "xyz"[place] : `along (${axis.map((x) => x.toFixed(2).replace("-", "\u2212")).join(", ")})`;
}

/** The coordinate plane that is nearly parallel, else the plane across the mean normal with one axis along a coordinate plane. */
function ontoPlane(mean, areas) {
  const length = Math.hypot(...mean);
  const normal = length > 0.05 ? scaled(mean, 1 / length) : coordinateAxes[areas.indexOf(Math.max(...areas))];
  const sizes = normal.map(Math.abs);
  const near = sizes.findIndex((x) => x > 0.9);
  if (near >= 0) {
    const axes = coordinateAxes.filter((_, i) => i !== near);
    return { names: axes.map(nameOf), flat: (point) => axes.map((axis) => dot(axis, point)) };
  }
  const least = coordinateAxes[sizes.indexOf(Math.min(...sizes))];
  const right = unit(least.map((x, i) => x - dot(least, normal) * normal[i]));
  const across = cross(normal, right);
  const up = scaled(across, Math.sign(across.reduce((largest, x) => (Math.abs(x) > Math.abs(largest) ? x : largest))));
  return { names: [right, up].map(nameOf), flat: (point) => [dot(right, point), dot(up, point)] };
}

/** The cylinder about `axis` on which the triangles lie; null where they do not. */
function unrolled(triangles, axis) {
  const along = scaled(axis, Math.sign(axis.reduce((largest, x) => (Math.abs(x) > Math.abs(largest) ? x : largest))));
  const sizes = along.map(Math.abs);
  const least = coordinateAxes[sizes.indexOf(Math.min(...sizes))];
  const e1 = unit(least.map((x, i) => x - dot(least, along) * along[i]));
  const e2 = cross(along, e1);
  const plane = (x) => [dot(x, e1), dot(x, e2)];
  // The normals point to the axis: least squares of the distances from the lines along them.
  let [xx, xy, yy, bx, by, total] = [0, 0, 0, 0, 0, 0];
  for (const { size, normal, middle } of triangles) {
    const [[nx, ny], [px, py]] = [plane(normal), plane(middle)];
    const across = -ny * px + nx * py;
    xx += size * ny * ny; xy -= size * nx * ny; yy += size * nx * nx;
    bx -= size * ny * across; by += size * nx * across;
    total += size;
  }
  const det = xx * yy - xy * xy;
  const centre = [(yy * bx - xy * by) / det, (xx * by - xy * bx) / det];
  const fromAxis = (x) => plane(x).map((value, i) => value - centre[i]);
  const mean = (value) => triangles.reduce((sum, triangle) => sum + triangle.size * value(triangle), 0) / total;
  const radius = mean(({ middle }) => Math.hypot(...fromAxis(middle)));
  if (!(mean(({ middle }) => Math.abs(Math.hypot(...fromAxis(middle)) - radius)) < 0.03 * radius)) return null;
  const middle = [0, 1].map((i) => mean((triangle) => fromAxis(triangle.middle)[i]));
  const first = Math.hypot(...middle) > 0.05 * radius ? Math.atan2(middle[1], middle[0]) : 0; // the cut is opposite
  const flat = (point, near) => {
    const [x, y] = fromAxis(point);
    const turn = Math.PI * 2;
    let angle = Math.atan2(y, x) - first;
    angle -= turn * Math.round(angle / turn);
    if (near) angle -= turn * Math.round((angle - near[0] / radius) / turn);
    return [radius * angle, dot(along, point)];
  };
  return { names: [`around, radius ${Number(radius.toPrecision(3))}`, nameOf(along)], flat };
}

/** The map onto the plane: flat(point, near), close to the point `near` of the plane. */
export function flattening(parts) {
  const triangles = trianglesOf(parts);
  const total = triangles.reduce((sum, { size }) => sum + size, 0) || 1;
  const sum = (value) => triangles.reduce((all, triangle) => all + triangle.size * value(triangle), 0) / total;
  const squares = [0, 1, 2].map((i) => [0, 1, 2].map((j) => sum(({ normal }) => normal[i] * normal[j])));
  const [least, second] = eigen(squares);
  // Normals of facets with corners on a cylinder are not exactly perpendicular to its axis; on part of a sphere two eigenvalues
  // are alike.
  const cylinder = least.value < 0.02 && second.value > Math.max(0.02, 5 * least.value) ? unrolled(triangles, least.vector) : null;
  return cylinder ?? ontoPlane([0, 1, 2].map((i) => sum(({ normal }) => normal[i])), [0, 1, 2].map((i) => sum(({ normal }) => Math.abs(normal[i]))));
}

/** Corners of triangles in the plane, z = 0; `near`: for each triangle a point that everything on its face must be close to. */
export function flatCorners(points, flat, near) {
  const corners = new Float64Array(points.length);
  for (let c = 0; c < points.length; c += 9) {
    const beside = flat(near(c / 9));
    for (let i = c; i < c + 9; i += 3) corners.set(flat(points.slice(i, i + 3), beside), i);
  }
  return corners;
}
