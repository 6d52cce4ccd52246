// node flatten_test.mjs
//
// Plan views of contact in 3D: planes as they are, cylinders unrolled, everything else along the mean normal.
import assert from "node:assert/strict";
import { eigen, flatCorners, flattening } from "../src/flatten.js";

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
const near = (found, expected, tolerance, text) => assert(Math.abs(found - expected) <= tolerance, `${text}: ${found} instead of ${expected}`);

/** Orthonormal, turned about no coordinate axis. */
const turned = [[0.8, 0, 0.6], [0.36, 0.8, -0.48], [-0.48, 0.6, 0.64]];
const straight = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
/** sum_i x_i axes_i + origin. */
const placed = (axes, origin = [0, 0, 0]) => (x) => [0, 1, 2].map((k) => origin[k] + x.reduce((sum, xi, i) => sum + xi * axes[i][k], 0));

/** n x m squares over the unit square, cut into triangles, at the places that `map` gives; `isInward` turns their normals. */
function part(n, m, map, isInward = false) {
  const points = [];
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < m; ++j) {
      const [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([k, l]) => map(k / n, l / m));
      for (const triangle of [[a, b, c], [a, c, d]]) points.push(...(isInward ? triangle.reverse() : triangle).flat());
    }
  return { nCorners: points.length / 3, points: Float64Array.from(points) };
}

const plane = (place) => part(4, 3, (s, t) => place([2 * s, t, 0]));
const cylinder = (place, radius, angle, isInward) =>
  part(24, 3, (s, t) => place([radius * Math.cos(angle * (s - 0.5)), radius * Math.sin(angle * (s - 0.5)), 2 * t]), isInward);

/** The triangles of a part in the plane, each beside its middle. */
function flatTriangles({ points }, flat) {
  const middle = (t) => [0, 1, 2].map((k) => (points[9 * t + k] + points[9 * t + 3 + k] + points[9 * t + 6 + k]) / 3);
  const corners = flatCorners(points, flat, middle);
  return Array.from({ length: points.length / 9 }, (_, t) => [0, 1, 2].map((c) => [...corners.subarray(9 * t + 3 * c, 9 * t + 3 * c + 2)]));
}

/** Edges keep their lengths, up to what chords of arcs lack. */
function checkLengths(surface, flat, tolerance) {
  flatTriangles(surface, flat).forEach((triangle, t) => [[0, 1], [1, 2], [2, 0]].forEach(([i, j]) => {
    const [a, b] = [i, j].map((c) => [...surface.points.subarray(9 * t + 3 * c, 9 * t + 3 * c + 3)]);
    near(distance(triangle[i], triangle[j]), distance(a, b), tolerance * distance(a, b), `edge of triangle ${t}`);
  }));
}

function checkEigen() {
  const values = [-1, 2, 5];
  const matrix = [0, 1, 2].map((i) => [0, 1, 2].map((j) => values.reduce((sum, value, k) => sum + value * turned[k][i] * turned[k][j], 0)));
  eigen(matrix).forEach(({ value, vector }, k) => {
    near(value, values[k], 1e-12, "eigenvalue");
    near(Math.abs(dot(vector, turned[k])), 1, 1e-12, "eigenvector");
  });
}

function checkPlanes() {
  for (const [axes, names] of [[[[1, 0, 0], [0, 1, 0], [0, 0, 1]], ["x", "y"]], [[[0, 1, 0], [1, 0, 0], [0, 0, -1]], ["x", "y"]],
    [[[0, 1, 0], [0, 0, 1], [1, 0, 0]], ["y", "z"]], [[[0, 0, 1], [1, 0, 0], [0, 1, 0]], ["x", "z"]]]) {
    const found = flattening([plane(placed(axes, [7, 8, 9]))]);
    assert.deepEqual(found.names, names);
    assert.deepEqual(found.flat([3, 4, 5]), names.map((name) => 3 + "xyz".indexOf(name)), "coordinates are kept");
  }
  const oblique = plane(placed(turned));
  const { names, flat } = flattening([oblique]);
  for (const name of names) assert.match(name, /^[xyz]$|^along \(/);
  checkLengths(oblique, flat, 1e-12);
}

/** A box has no mean normal: it is seen along the axis that most of its faces have. */
function checkBox() {
  const sides = [0, 1, 2].flatMap((axis) => [0, 1].map((side) =>
    part(1, 1, (s, t) => { const x = [s, t]; x.splice(axis, 0, side); return [3 * x[0], 2 * x[1], x[2]]; }, side === 0)));
  assert.deepEqual(flattening(sides).names, ["x", "y"]);
}

function checkCylinders() {
  const radius = 5;
  for (const [axes, origin] of [[straight, [0, 0, 0]], [straight, [100, -30, 4]], [turned, [1, 2, 3]]])
    for (const angle of [Math.PI / 3, Math.PI, 2 * Math.PI])
      for (const isInward of [false, true]) {
        const surface = cylinder(placed(axes, origin), radius, angle, isInward);
        const { names, flat } = flattening([surface]);
        assert.match(names[0], /^around, radius (4\.9|5)/);
        assert.match(names[1], axes === straight ? /^z$/ : /^along \(/);
        checkLengths(surface, flat, 0.01); // across the cut, too
        const xs = flatTriangles(surface, flat).flat().map(([x]) => x);
        near(Math.max(...xs) - Math.min(...xs), radius * angle, 0.06 * radius * angle, "length around");
      }
}

/** Of a part of the circle, the cut lies opposite: its middle is the middle of the plan, wherever it is. */
function checkCut() {
  for (const first of [0.3, 2, 3.1, 4.5]) {
    const surface = part(24, 1, (s, t) => [Math.cos(first + 4 * (s - 0.5)), Math.sin(first + 4 * (s - 0.5)), t]);
    const { flat } = flattening([surface]);
    near(flat([Math.cos(first), Math.sin(first), 0])[0], 0, 1e-6, "middle");
    const ends = [-2, 2].map((s) => flat([Math.cos(first + s), Math.sin(first + s), 0])[0]);
    near(Math.abs(ends[1] - ends[0]), 4, 0.03, "ends");
  }
}

/** The other side of a point near the cut goes beside it. */
function checkBeside() {
  const { flat } = flattening([cylinder(placed(straight), 1, 2 * Math.PI)]);
  const at = (angle) => [Math.cos(angle), Math.sin(angle), 0];
  let cut = null;
  for (let k = 0; k < 1000 && cut === null; ++k) {
    const [a, b] = [k, k + 1].map((i) => (i * 2 * Math.PI) / 1000);
    if (Math.abs(flat(at(a))[0] - flat(at(b))[0]) > 3) cut = (a + b) / 2;
  }
  assert(cut !== null, "a whole circle is cut somewhere");
  const beside = flat(at(cut - 0.1));
  near(Math.abs(flat(at(cut + 0.1), beside)[0] - beside[0]), 0.2, 0.01, "across the cut");
}

/** Two boundaries' worth of parts on one cylinder are unrolled together. */
function checkParts() {
  const place = placed(straight);
  const quarters = [0, 1].map((k) => part(8, 2, (s, t) => place([Math.cos((k + s) * 0.7), Math.sin((k + s) * 0.7), t])));
  const { flat } = flattening(quarters);
  near(distance(flat([1, 0, 0]), flat([Math.cos(1.4), Math.sin(1.4), 0])), 1.4, 0.02, "around both");
}

function checkOthers() {
  const sphere = part(12, 12, (s, t) => { const [a, b] = [s - 0.5, t - 0.5]; return [Math.sin(a), Math.sin(b) * Math.cos(a), -Math.cos(a) * Math.cos(b)]; });
  assert.deepEqual(flattening([sphere]).names, ["x", "y"], "a part of a sphere");
  const cone = part(24, 3, (s, t) => [(1 + t) * Math.cos(2 * Math.PI * s), (1 + t) * Math.sin(2 * Math.PI * s), t]);
  assert.deepEqual(flattening([cone]).names, ["x", "y"], "a cone");
  const corner = [part(2, 2, (s, t) => [s, 0, t]), part(2, 2, (s, t) => [0, s, t])]; // no cylinder, though all normals are across z
  assert(!flattening(corner).names[0].startsWith("around"), "two planes");
}

for (const check of [checkEigen, checkPlanes, checkBox, checkCylinders, checkCut, checkBeside, checkParts, checkOthers]) check();
console.log("planes, boxes, cylinders and others as expected");
