// A body in 3D cut by a plane: the rest of its surface, and the section through its cells.

/** Points between two others, three for each triangle: from + t (to - from). */
class Mix {
  constructor() {
    Object.assign(this, { from: [], to: [], t: [] });
  }

  get length() {
    return this.t.length;
  }

  add([from, to, t]) {
    this.from.push(from);
    this.to.push(to);
    this.t.push(t);
  }

  /** Adds a convex polygon as triangles. */
  addPolygon(points) {
    for (let i = 2; i < points.length; ++i) for (const k of [0, i - 1, i]) this.add(points[k]);
  }

  /** Sets result[first ...] to the values of the points, `width` numbers each. */
  apply(values, width, result, first, n = this.length) {
    const { from, to, t } = this;
    for (let i = 0, place = first; i < n; ++i)
      for (let c = 0; c < width; ++c) {
        const a = values[width * from[i] + c];
        result[place++] = a + t[i] * (values[width * to[i] + c] - a);
      }
  }
}

const crossing = (a, b, distance) => [a, b, distance(a) / (distance(a) - distance(b))];

/** The part of the triangles with corners 0, 1, 2; 3, 4, 5; ... where the distance is not positive. */
function cutTriangles(nCorners, distance) {
  const mix = new Mix();
  for (let first = 0; first < nCorners; first += 3) {
    const polygon = [];
    for (let i = 0; i < 3; ++i) {
      const [a, b] = [first + i, first + ((i + 1) % 3)];
      if (distance(a) <= 0) polygon.push([a, a, 0]);
      if (distance(a) <= 0 !== distance(b) <= 0) polygon.push(crossing(a, b, distance));
    }
    mix.addPolygon(polygon);
  }
  return mix;
}

/** The polygons in which the plane intersects the tetrahedra. */
function section(cells, distance) {
  const mix = new Mix();
  for (let first = 0; first < cells.length; first += 4) {
    const corners = [...cells.subarray(first, first + 4)];
    const kept = corners.filter((v) => distance(v) <= 0);
    const gone = corners.filter((v) => distance(v) > 0);
    if (kept.length === 0 || gone.length === 0) continue;
    const edges = kept.length === 2 ? [[0, 0], [0, 1], [1, 1], [1, 0]] : kept.length === 1 ? [[0, 0], [0, 1], [0, 2]] : [[0, 0], [1, 0], [2, 0]];
    mix.addPolygon(edges.map(([k, g]) => crossing(kept[k], gone[g], distance)));
  }
  return mix;
}

/** The plane through the undeformed body where the coordinate `axis` equals `level`; the part on its `side`, 1 or -1, is cut off. */
export class Cut {
  constructor(surface, volume, { axis, level, side }) {
    const { points, vertex } = surface;
    this.surface = cutTriangles(vertex.length, (c) => side * (points[3 * vertex[c] + axis] - level));
    this.section = volume ? section(volume.cells, (v) => side * (volume.points[3 * v + axis] - level)) : new Mix();
    this.isKept = (v) => side * (points[3 * v + axis] - level) <= 0;
  }

  get nCorners() {
    return this.surface.length + this.section.length;
  }

  /** Converts values at the corners of the surface and at the vertices of the volume to values at the drawn corners. */
  spread(ofCorners, ofVolume, width) {
    const onSurface = this.countOf(ofCorners.length / width);
    const result = new Float32Array(width * (ofVolume ? this.nCorners : onSurface));
    this.surface.apply(ofCorners, width, result, 0, onSurface);
    if (ofVolume) this.section.apply(ofVolume, width, result, width * onSurface);
    return result;
  }

  /** The number of drawn corners that come from the first n of the surface. */
  countOf(n) {
    const beyond = this.surface.from.findIndex((corner) => corner >= n);
    return beyond < 0 ? this.surface.length : beyond;
  }

  /** The pairs of vertices of which both remain. */
  segments(all) {
    const kept = [];
    for (let s = 0; s < all.length; s += 2) if (this.isKept(all[s]) && this.isKept(all[s + 1])) kept.push(all[s], all[s + 1]);
    return Uint32Array.from(kept);
  }
}
