// The contact boundary in 3D in plan, boundary by boundary: values or states in colours, with what the pointer or keys are told.

import { statusNames } from "./components.js";
import { contactColumns, contactSides } from "./contact_parts.js";
import { element, number } from "./dom.js";
import { exportButtons } from "./export.js";
import { flatCorners, flattening } from "./flatten.js";
import { latticeTriangles } from "./lattice.js";
import { axes } from "./overlay.js";
import { cornerAt, valueAt } from "./pick.js";
import { colours, fieldLegend } from "./scales.js";
import { SoftwareScene } from "./software.js";
import { colourRange } from "./surface.js";
import { measured, unit } from "./units.js";

const size = { left: 64, top: 22, bottom: 38, right: 8, width: 520 };
const nKeySteps = 40; // of an arrow key, to cross the picture

export const quantities = {
  pressure: { label: "contact pressure", measures: "stress", kind: "sequential" },
  friction: { label: "friction, length", measures: "stress", kind: "sequential" },
  limit: { label: "limit of friction", measures: "stress", kind: "sequential" },
  gap: { label: "gap", measures: "length", kind: "sequential" },
  slip: { label: "slip, length", measures: "length", kind: "sequential" },
};
const status = { label: "contact status", kind: "status" };

/** All faces of a slave; those with nothing opposite stay grey. */
function pointsAround(surface, faces) {
  const triangles = latticeTriangles(surface.subdivision);
  const points = new Float64Array(3 * faces.length * triangles.length);
  let place = 0;
  for (const face of faces)
    for (const corner of triangles) {
      const vertex = surface.faces[face * surface.nFacePoints + corner];
      for (let k = 0; k < 3; ++k) points[place++] = surface.points[3 * vertex + k];
    }
  return points;
}

/** The middle of a face, for each triangle on it. */
function middleOf({ faces, points, nFacePoints, subdivision }, face) {
  const corners = [0, subdivision, nFacePoints - 1].map((place) => 3 * faces[face * nFacePoints + place]);
  return [0, 1, 2].map((k) => corners.reduce((sum, corner) => sum + points[corner + k] / 3, 0));
}

function boxOf(corners) {
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (let c = 0; c < corners.length; c += 3)
    for (let i = 0; i < 2; ++i) {
      low[i] = Math.min(low[i], corners[c + i]);
      high[i] = Math.max(high[i], corners[c + i]);
    }
  return { centre: low.map((x, i) => (x + high[i]) / 2), size: high.map((x, i) => x - low[i]) };
}

/** A parallel projection onto the plane, in the form expected by software.js, overlay.js and pick.js. */
const viewOf = (scale) => ({ target: [0, 0, 0], scale, axes: () => ({ right: [1, 0, 0], up: [0, 1, 0], eye: [0, 0, 1] }) });

/** The triangles of one boundary in the plane, about the middle of their box; those without values lie below. */
function flatBoundary(surface, parts) {
  const { names, flat } = flattening(parts);
  const { around } = parts[0];
  const below = around ? [{ points: pointsAround(surface, around), faceOf: (triangle) => around[Math.floor(triangle / surface.trianglesPerFace)] }] : [];
  const nColoured = parts.reduce((sum, { nCorners }) => sum + nCorners, 0);
  const all = [...parts.map(({ points, face }) => ({ points, faceOf: (triangle) => face[triangle] })), ...below]
    .map(({ points, faceOf }) => flatCorners(points, flat, (triangle) => middleOf(surface, faceOf(triangle))));
  const exact = Float64Array.from(all.flatMap((part) => [...part]));
  const box = boxOf(exact);
  const corners = new Float32Array(exact.length);
  for (let c = 0; c < exact.length; c += 3) corners.set([exact[c] - box.centre[0], exact[c + 1] - box.centre[1], c < 3 * nColoured ? 0 : -box.size[0]], c);
  return { names, corners, box, nColoured };
}

class BoundaryPlan {
  /** `parts`: of contactSides(), all of one boundary. */
  constructor(surface, name, parts) {
    Object.assign(this, { surface, parts, ...flatBoundary(surface, parts) });
    this.values = Object.fromEntries(contactColumns.map((id) => [id, Float32Array.from(parts.flatMap((part) => [...part.values(id)]))]));
    this.status = parts.flatMap((part) => [...part.status]);
    this.values.status = Float32Array.from({ length: this.nColoured }, (_, c) => this.status[Math.floor(c / 3)]);
    this.width = size.width;
    this.height = Math.min(460, Math.max(120, (size.width * this.box.size[1]) / this.box.size[0]));
    this.scale = 0.53 * Math.max(this.box.size[1], (this.box.size[0] * this.height) / this.width);
    this.view = viewOf(this.scale);
    this.probe = element("svg:g", { class: "probe", visibility: "hidden" }, element("svg:circle", { r: 5 }));
    this.svg = element("svg:svg", { class: "plan view-overlay", role: "img", tabindex: 0, "aria-label": `Plan view of ${name}; arrow keys move a point and read its values`,
      viewBox: `0 0 ${size.left + this.width + size.right} ${size.top + this.height + size.bottom}`,
      onpointermove: (event) => this.point(...this.inPicture(event)), onpointerleave: () => this.point(),
      onkeydown: (event) => this.press(event), onblur: () => this.point() });
    this.tooltip = element("div", { class: "tooltip", role: "status", hidden: true });
    this.legend = element("div", { class: "view-legend" });
    this.element = element("div", {}, element("div", { class: "view-row" }, element("div", { class: "plan-frame" }, this.svg, this.tooltip), this.legend),
      exportButtons(`contact_plan_${name}`, () => [this.svg], () => this.rows()));
  }

  /** Draws `quantity`, or "status". */
  draw(quantity) {
    this.quantity = quantity;
    const field = quantity === "status" ? status : { ...quantities[quantity], unit: unit(quantities[quantity].measures) };
    const values = this.values[quantity];
    const range = colourRange(this.surface, field, values);
    const style = getComputedStyle(document.documentElement);
    const scene = new SoftwareScene(element("div", {}), 2);
    scene.resize(this.width, this.height, style.getPropertyValue("--panel").trim(), "#000000");
    scene.setTriangles(this.corners.length / 9, this.nColoured / 3);
    scene.setPositions(this.corners, this.corners);
    scene.setValues(values, this.nColoured, range, colours(field.kind, range));
    scene.render(this.view);
    const frame = { left: size.left, top: size.top, width: this.width, height: this.height };
    this.svg.replaceChildren(element("svg:image", { x: size.left, y: size.top, width: this.width, height: this.height, href: scene.canvas.toDataURL("image/png") }),
      ...axes(this, this.view, frame, this.names), this.probe);
    this.legend.replaceChildren(fieldLegend(field, range, []));
  }

  /** Pixels from the middle of the picture, to the right and upwards. */
  inPicture({ clientX, clientY }) {
    const box = this.svg.getBoundingClientRect();
    const { width } = this.svg.viewBox.baseVal;
    const perPixel = width / box.width;
    return [(clientX - box.left) * perPixel - size.left - this.width / 2, size.top + this.height / 2 - (clientY - box.top) * perPixel];
  }

  press(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.key === "Escape") this.point();
    if (!step) return;
    event.preventDefault();
    const [x, y] = this.at ?? [0, 0];
    const length = this.width / nKeySteps;
    const inside = (value, half) => Math.max(-half, Math.min(half, value));
    this.point(inside(x + length * step[0], this.width / 2), inside(y + length * step[1], this.height / 2), true);
  }

  /** Describes a place of the picture; nothing without one. */
  point(x, y, isMarked = false) {
    this.at = x === undefined ? null : [x, y];
    const length = (2 * this.scale) / this.height;
    const hit = this.at && cornerAt(this.corners.subarray(0, 3 * this.nColoured), this.view, x * length, y * length);
    this.tooltip.hidden = !hit;
    this.probe.setAttribute("visibility", this.at && isMarked ? "visible" : "hidden");
    if (!this.at) return;
    const [left, top] = [size.left + this.width / 2 + x, size.top + this.height / 2 - y];
    this.probe.setAttribute("transform", `translate(${left.toFixed(1)} ${top.toFixed(1)})`);
    if (hit) this.tell(hit, left, top);
  }

  tell(hit, left, top) {
    const { measures, label } = quantities[this.quantity === "status" ? "pressure" : this.quantity];
    const value = valueAt(this.values[this.quantity === "status" ? "pressure" : this.quantity], hit);
    const place = this.placeOf(hit);
    this.tooltip.replaceChildren(element("strong", {}, `${label} ${measured(number(value), unit(measures))}, ${statusNames[this.status[Math.floor(hit.corner / 3)]]}`), element("br"),
      ["x", "y", "z"].map((axis, k) => `${axis} = ${number(place[k])}`).join(", "));
    const perPixel = this.svg.viewBox.baseVal.width / this.svg.getBoundingClientRect().width;
    this.tooltip.style.left = `${Math.min(left / perPixel + 14, this.svg.clientWidth - 230)}px`;
    this.tooltip.style.top = `${top / perPixel + 14}px`;
  }

  /** The point in space. */
  placeOf({ corner, weights }) {
    let first = corner;
    const part = this.parts.find(({ nCorners }) => first < nCorners || ((first -= nCorners), false));
    const place = [0, 1, 2].map((k) => weights.reduce((sum, w, i) => sum + w * part.points[3 * (first + i) + k], 0));
    return place.map((x) => (Math.abs(x) < 1e-7 * this.surface.box.diagonal ? 0 : x));
  }

  rows() {
    return this.parts.flatMap((part) => Array.from({ length: part.nCorners }, (_, c) => ({ triangle: Math.floor(c / 3), x: part.points[3 * c], y: part.points[3 * c + 1],
      z: part.points[3 * c + 2] }))).map((row, c) => ({ ...row, ...Object.fromEntries(contactColumns.map((id) => [id, this.values[id][c]])), status: statusNames[this.status[Math.floor(c / 3)]] }));
  }
}

/**
 * A figure for each boundary; `quantity` and `isStatus`: elements that choose the values, or the states, to show; `titles`: of
 * the boundaries by their names, omitting those that need none.
 */
export function contactPlans(surface, quantity, isStatus, titles) {
  const sides = contactSides(surface);
  const plans = [...new Set(sides.map(({ boundary }) => boundary))].map((name) =>
    ({ name, plan: new BoundaryPlan(surface, name, sides.filter(({ boundary }) => boundary === name)) }));
  const draw = () => plans.forEach(({ plan }) => plan.draw(isStatus.checked ? "status" : quantity.value));
  draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  for (const input of [quantity, isStatus]) input.addEventListener("change", draw);
  return plans.map(({ name, plan }) => element("figure", {}, titles[name] ? element("h3", {}, titles[name]) : null, plan.element));
}
