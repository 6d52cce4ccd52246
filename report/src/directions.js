// The initial viewing directions for a body in 3D.

import { Camera } from "./camera.js";
import { areaVector } from "./surface.js";

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

/** The mean of the normals on the contact boundary, at most 1 long: far shorter where it goes around the body. */
function meanContactNormal(surface) {
  const normal = [0, 0, 0];
  let area = 0;
  for (let c = 0; c < 3 * surface.nContactFaces * surface.trianglesPerFace; c += 3) {
    const vector = areaVector(surface, c);
    vector.forEach((x, i) => { normal[i] += x; });
    area += Math.hypot(...vector);
  }
  return normal.map((x) => x / (area || 1));
}

/** The axis across the interfaces between bodies; z where their directions vary. */
function axisAcross(interfaces) {
  const [sum, area] = interfaces.reduce(([vector, total], { normal, measure }) =>
    [vector.map((x, i) => x + measure * Math.abs(normal[i])), total + measure], [[0, 0, 0], 0]);
  const axis = sum.indexOf(Math.max(...sum));
  return sum[axis] > 0.8 * area ? axis + 1 : 3;
}

/** The axis that points away from the support of the body; z where there is none. Numbered as in camera.js. */
export function upAxis(surface) {
  const normal = meanContactNormal(surface);
  if (Math.hypot(...normal) < 0.5) return axisAcross(surface.interfaces ?? []);
  const axis = normal.reduce((best, x, i) => (Math.abs(x) > Math.abs(normal[best]) ? i : best), 0);
  return -Math.sign(normal[axis]) * (axis + 1);
}

/** The direction from which contact values are visible: outside the contact boundary. */
export function contactDirection(surface, camera) {
  const mean = meanContactNormal(surface);
  const [x, y, z] = camera.frame.map((axis) => dot(axis, mean) / (Math.hypot(...mean) || 1));
  return Math.hypot(x, z) > 0.5 ? { azimuth: Math.round((Math.atan2(x, z) * 180) / Math.PI) + 25, elevation: 20 }
    : { azimuth: 35, elevation: y < 0 ? -40 : 40 };
}

/** From above, at the corner that shows most of the large values: often that is where a model is cut by symmetry. */
export function firstDirection(surface, values, range, up) {
  if (surface.dimension === 2) return {};
  if (surface.direction) return surface.direction;
  const seen = [35, 125, 215, 305].map((azimuth) => {
    const { eye } = new Camera(3, { azimuth, elevation: 20, up }).axes();
    let [sum, area] = [0, 0];
    for (let c = 0; c < values.length; c += 3) {
      const weight = dot(areaVector(surface, c), eye);
      if (weight <= 0) continue;
      area += weight;
      sum += weight * Math.min(values[c], range.high);
    }
    return { azimuth, elevation: 20, mean: sum / area };
  });
  const { azimuth, elevation } = seen.reduce((best, other) => (other.mean > best.mean * 1.001 ? other : best));
  return { azimuth, elevation };
}
