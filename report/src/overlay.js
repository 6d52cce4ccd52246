// The SVG overlay of the picture of a surface: axes and the contact boundary in 2D, directions in 3D.

import { scaleLinear } from "d3";
import { axisNames, showsMeridian } from "./axes.js";
import { statusColours } from "./components.js";
import { element, number } from "./dom.js";
import { obstaclePoints } from "./obstacle.js";
import { headed, measured, unit } from "./units.js";

const hatchDistance = 9; // pixels
const sideRatio = 5; // of lengths on the master to those on the slave; beyond, the master is omitted between two points
const manySegments = 120000; // beyond this, the undeformed outline is not computed

/** The function that maps points relative to the centre of the body to pixels in `place`. */
function toPixels({ clientWidth: width, clientHeight: height }, camera) {
  const { right, up } = camera.axes();
  const { target, scale } = camera;
  const pixels = height / (2 * scale);
  const along = (axis, x, y, z) => axis[0] * (x - target[0]) + axis[1] * (y - target[1]) + axis[2] * (z - target[2]);
  return (x, y, z = 0) => [width / 2 + pixels * along(right, x, y, z), height / 2 - pixels * along(up, x, y, z)];
}

const point = ([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`;
const stretch = (from, to) => `M${point(from)}L${point(to)}`;

/** Whether the points i and i + 1 of a profile are joined; otherwise another part of the boundary begins. */
function isStretch({ arc, points }, i, box) {
  const length = Math.hypot(points[2 * i + 2] - points[2 * i], points[2 * i + 3] - points[2 * i + 1]);
  return length <= arc[i + 1] - arc[i] + 1e-5 * box.diagonal;
}

const unmoved = [0, 0];

/** The displacement of a point's body, null where it is not shown. */
function shiftOf(layout, bodies, i) {
  return layout ? layout[bodies[i]] ?? null : unmoved;
}

/** The boundary of the undeformed body. */
function outline(surface, pixel, layout) {
  if (surface.nFaces * 3 * surface.subdivision > manySegments) return null;
  const { points, box, vertexBody } = surface;
  const segments = surface.segments().boundary;
  const at = (v, shift) => pixel(points[2 * v] - box.centre[0] + shift[0], points[2 * v + 1] - box.centre[1] + shift[1]);
  let path = "";
  for (let s = 0; s < segments.length; s += 2) {
    const shift = shiftOf(vertexBody && layout, vertexBody, segments[s]);
    if (shift) path += stretch(at(segments[s], shift), at(segments[s + 1], shift));
  }
  return element("svg:path", { class: "outline", d: path });
}

/** The obstacle, hatched on its side. */
function obstacleLine(profile, box, factor, pixel, layout) {
  const points = obstaclePoints(profile, box, factor).map((at, i) => {
    const shift = shiftOf(layout, profile.bodies, i);
    return at && shift ? at.map((x, c) => x + shift[c]) : undefined;
  });
  const { arc, normal } = profile;
  const [line, hatching] = [[], []];
  let last = -Infinity;
  for (let i = 0; i + 1 < points.length; ++i) {
    if (!points[i] || !points[i + 1] || !isStretch(profile, i, box)) continue;
    const [a, b] = [pixel(...points[i]), pixel(...points[i + 1])];
    line.push(stretch(a, b));
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const perPixel = (arc[i + 1] - arc[i]) / length;
    for (let s = Math.max(0, last + hatchDistance * perPixel - arc[i]) / perPixel; s < length; s += hatchDistance) {
      const foot = [0, 1].map((c) => a[c] + (s / length) * (b[c] - a[c]));
      const along = [0, 1].map((c) => (b[c] - a[c]) / length);
      const outwards = [normal[2 * i], -normal[2 * i + 1]];
      hatching.push(stretch(foot, foot.map((x, c) => x + 6 * outwards[c] - 6 * along[c])));
      last = arc[i] + s * perPixel;
    }
  }
  return [element("svg:path", { class: "obstacle", d: line.join("") }), element("svg:path", { class: "obstacle hatching", d: hatching.join("") })];
}

/** A side of the deformed contact boundary in the colours of its status, which changes halfway between two points. */
function statusLines({ arc, points, displacement, bodies, status }, box, factor, pixel, layout) {
  const at = (i, shift) => pixel(...[0, 1].map((c) => points[2 * i + c] + factor * displacement[2 * i + c] - box.centre[c] + shift[c]));
  const paths = statusColours.map(() => "");
  for (let i = 0; i + 1 < status.length; ++i) {
    const shift = shiftOf(layout, bodies, i);
    if (!shift || bodies[i] !== bodies[i + 1] || !isStretch({ arc, points }, i, box)) continue;
    const [a, b] = [at(i, shift), at(i + 1, shift)];
    const middle = [0, 1].map((c) => (a[c] + b[c]) / 2);
    paths[status[i]] += stretch(a, middle);
    paths[status[i + 1]] += stretch(middle, b);
  }
  return paths.map((d, i) => element("svg:path", { class: "status-line", d, stroke: statusColours[i] }));
}

/** Axes around a picture; `names`: of the horizontal and the vertical axis. */
export function axes({ box }, { target, scale }, { left, top, width, height }, names = axisNames(2)) {
  const [cx, cy] = [box.centre[0] + target[0], box.centre[1] + target[1]];
  const reach = (scale * width) / height;
  const x = scaleLinear([cx - reach, cx + reach], [left, left + width]);
  const y = scaleLinear([cy - scale, cy + scale], [top + height, top]);
  const label = (value) => number(Math.abs(value) < 1e-9 * scale ? 0 : value, 6);
  return [
    ...x.ticks(Math.max(2, width / 90)).flatMap((tick) => [
      element("svg:line", { x1: x(tick), x2: x(tick), y1: top + height, y2: top + height + 4 }),
      element("svg:text", { x: x(tick), y: top + height + 16, "text-anchor": "middle" }, label(showsMeridian() ? Math.abs(tick) : tick))]),
    ...y.ticks(Math.max(3, height / 60)).flatMap((tick) => [
      element("svg:line", { x1: left - 4, x2: left, y1: y(tick), y2: y(tick) }),
      element("svg:text", { x: left - 7, y: y(tick) + 4, "text-anchor": "end" }, label(tick))]),
    element("svg:text", { x: left + width, y: top + height + 30, "text-anchor": "end", class: "axis-name" }, `${headed(names[0], unit("length"))} \u2192`),
    element("svg:text", { x: left - 42, y: top - 6, class: "axis-name" }, `\u2191 ${headed(names[1], unit("length"))}`)];
}

/** Both sides of an interface: the second with points, displacements and bodies of the master in place of the slave's. */
function sidesOf(profile) {
  const { opposite: points, opposite_displacement: displacement, opposite_bodies: bodies } = profile;
  return points ? [profile, { ...profile, points, displacement, bodies, arc: lengthsAlong(profile, points) }] : [profile];
}

/** Arc lengths along the points of the master where those of the slave are joined; they do not grow elsewhere. */
function lengthsAlong({ arc }, points) {
  const lengths = [0];
  for (let i = 1; i < arc.length; ++i) {
    const length = Math.hypot(points[2 * i] - points[2 * i - 2], points[2 * i + 1] - points[2 * i - 1]);
    lengths.push(lengths[i - 1] + (length <= sideRatio * (arc[i] - arc[i - 1]) ? length : 0));
  }
  return lengths;
}

function overlay2d(surface, camera, place, { factor, obstacle, layout }) {
  const pixel = toPixels(place, camera);
  const frame = { left: place.offsetLeft + place.clientLeft, top: place.offsetTop + place.clientTop, width: place.clientWidth,
    height: place.clientHeight };
  const inside = element("svg:svg", { x: frame.left, y: frame.top, width: frame.width, height: frame.height },
    factor > 0 ? outline(surface, pixel, layout) : null,
    obstacle ? (surface.profiles ?? []).filter(({ paired }) => !paired).map((profile) => obstacleLine(profile, surface.box, factor, pixel, layout)) : null,
    (surface.profiles ?? []).flatMap(sidesOf).map((side) => statusLines(side, surface.box, factor, pixel, layout)));
  return [inside, ...axes(surface, camera, frame)];
}

/** The directions of the axes, the nearest last, and the size of the body. */
function triad({ box }, camera, place) {
  const { right, up, eye } = camera.axes();
  const [x0, y0] = [44, place.clientHeight - 44];
  const arrows = [0, 1, 2].sort((a, b) => eye[a] - eye[b]).flatMap((i) => [
    element("svg:line", { class: `triad triad-${"xyz"[i]}`, x1: x0, y1: y0, x2: x0 + 28 * right[i], y2: y0 - 28 * up[i] }),
    element("svg:text", { x: x0 + 38 * right[i], y: y0 - 38 * up[i] + 4, "text-anchor": "middle" }, "xyz"[i])]);
  return [...arrows, element("svg:text", { x: 12, y: 20 }, measured(box.size.map((length) => number(length, 3)).join(" \u00d7 "), unit("length")))];
}

/** `state`: the factor of the displacements, whether the obstacle is drawn, and the layout of the bodies, undefined for one. */
export function overlay(surface, camera, place, state) {
  return surface.dimension === 2 ? overlay2d(surface, camera, place, state) : triad(surface, camera, place);
}
