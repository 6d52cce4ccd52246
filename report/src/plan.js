// The contact boundary in 3D seen from the body, along its mean normal.

import { element } from "./dom.js";
import { exportButtons } from "./export.js";
import { axes } from "./overlay.js";
import { colours, fieldLegend } from "./scales.js";
import { SoftwareScene } from "./software.js";
import { areaVector, colourRange, fieldsOf } from "./surface.js";

const size = { left: 64, top: 18, bottom: 38, width: 520 };

/** The two coordinates that change along the boundary: all but that of the largest component of its areas. */
function planeAxes(surface, nCorners) {
  const area = [0, 0, 0];
  for (let c = 0; c < nCorners; c += 3) areaVector(surface, c).forEach((x, i) => { area[i] += Math.abs(x); });
  const normal = area.indexOf(Math.max(...area));
  return [0, 1, 2].filter((i) => i !== normal);
}

/** Corners in the plane, about the middle of their box. */
function flatCorners({ points, vertex }, nCorners, [a, b]) {
  const corners = new Float32Array(3 * nCorners);
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (let c = 0; c < nCorners; ++c)
    [a, b].forEach((axis, i) => {
      corners[3 * c + i] = points[3 * vertex[c] + axis];
      low[i] = Math.min(low[i], corners[3 * c + i]);
      high[i] = Math.max(high[i], corners[3 * c + i]);
    });
  const centre = low.map((x, i) => (x + high[i]) / 2);
  for (let c = 0; c < 3 * nCorners; c += 3) [0, 1].forEach((i) => { corners[c + i] -= centre[i]; });
  return { corners, box: { centre, size: high.map((x, i) => x - low[i]) } };
}

/** A parallel projection onto the plane, in the shape that software.js and overlay.js take. */
const viewOf = (scale) => ({ target: [0, 0, 0], scale, axes: () => ({ right: [1, 0, 0], up: [0, 1, 0], eye: [0, 0, 1] }) });

/** `quantities`: the select element that says which values are shown. */
export function contactPlan(surface, quantity) {
  const nCorners = 3 * surface.nContactFaces * surface.trianglesPerFace;
  const plane = planeAxes(surface, nCorners);
  const { corners, box } = flatCorners(surface, nCorners, plane);
  const [width, height] = [size.width, Math.min(460, Math.max(160, (size.width * box.size[1]) / box.size[0]))];
  const scale = 0.53 * Math.max(box.size[1], (box.size[0] * height) / width);
  const svg = element("svg:svg", { class: "plan view-overlay", role: "img", "aria-label": "Plan view of the contact boundary",
    viewBox: `0 0 ${size.left + width + 8} ${size.top + height + size.bottom}` });
  const legend = element("div", { class: "view-legend" });
  const draw = () => {
    const field = fieldsOf(surface, []).find(({ id }) => id === `contact-${quantity.value}`);
    const values = field.corners(surface);
    const range = colourRange(surface, field, values);
    const style = getComputedStyle(document.documentElement);
    const scene = new SoftwareScene(element("div", {}), 2);
    scene.resize(width, height, style.getPropertyValue("--panel").trim(), "#000000");
    scene.setTriangles(nCorners / 3, nCorners / 3);
    scene.setPositions(corners, corners);
    scene.setValues(values, nCorners, range, colours(field.kind, range));
    scene.render(viewOf(scale));
    svg.replaceChildren(element("svg:image", { x: size.left, y: size.top, width, height, href: scene.canvas.toDataURL("image/png") }),
      ...axes({ box }, viewOf(scale), { left: size.left, top: size.top, width, height }, plane.map((axis) => "xyz"[axis])));
    legend.replaceChildren(fieldLegend(field, range, []));
  };
  draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  quantity.addEventListener("change", draw);
  return element("div", {}, element("div", { class: "view-row" }, svg, legend), exportButtons("contact_plan", () => [svg]));
}
