// The lattice of a face, numbered as in app/page/page_surface.h.

const placeIn = (k) => (i, j) => j * (k + 1) - (j * (j - 1)) / 2 + i;

/** Coordinates (i, j) / k of the points. */
export function latticePoints(k) {
  const points = [];
  for (let j = 0; j <= k; ++j) for (let i = 0; i + j <= k; ++i) points.push([i / k, j / k]);
  return points;
}

/** The triangles of a face by numbers of its points, in the order of triangle_middles(). */
export function latticeTriangles(k) {
  const place = placeIn(k);
  const triangles = [];
  for (let j = 0; j < k; ++j)
    for (let i = 0; i + j < k; ++i) {
      triangles.push(place(i, j), place(i + 1, j), place(i, j + 1));
      if (i + j + 1 < k) triangles.push(place(i + 1, j), place(i + 1, j + 1), place(i, j + 1));
    }
  return triangles;
}

/** The points along the three sides of a face, k + 1 each. */
export function latticeSides(k) {
  const place = placeIn(k);
  const along = Array.from({ length: k + 1 }, (_, i) => i);
  return [along.map((i) => place(i, 0)), along.map((i) => place(k - i, i)), along.map((i) => place(0, k - i))];
}

/** The triangle of the lattice that contains the point (s, t): three indices and their weights. */
export function latticeWeights(k, s, t) {
  const place = placeIn(k);
  const [x, y] = [s, t].map((value) => Math.max(0, Math.min(k, value * k)));
  const i = Math.min(Math.floor(x), k - 1);
  const j = Math.min(Math.floor(y), k - 1 - i);
  const [a, b] = [x - i, y - j];
  return a + b > 1 && i + j + 2 <= k
    ? { places: [place(i + 1, j + 1), place(i, j + 1), place(i + 1, j)], weights: [a + b - 1, 1 - a, 1 - b] }
    : { places: [place(i, j), place(i + 1, j), place(i, j + 1)], weights: [1 - a - b, a, b] };
}
