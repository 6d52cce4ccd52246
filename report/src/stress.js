// Stresses derived from the components of the equilibrated stress, on a meridian of that of u_h.

import { stressNames } from "./axes.js";

/** The six components xx, yy, zz, xy, yz, xz at index i of the arrays; in 2D zz = `ratio(i)` (xx + yy), and what an initial stress adds. */
function tensorAt(stress, ratio) {
  if (stress.length === 6) return (i) => stress.map((component) => component[i]);
  const [xx, yy, xy, rest] = stress;
  return (i) => [xx[i], yy[i], ratio(i) * (xx[i] + yy[i]) + (rest ? rest[i] : 0), xy[i], 0, 0];
}

function vonMises([xx, yy, zz, xy, yz, xz]) {
  return Math.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy * xy + yz * yz + xz * xz));
}

/** The eigenvalues, the largest first: the roots of the characteristic polynomial by the trigonometric formula. */
export function principal([xx, yy, zz, xy, yz, xz]) {
  const mean = (xx + yy + zz) / 3;
  const [a, b, c] = [xx - mean, yy - mean, zz - mean];
  const size = Math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + yz * yz + xz * xz)) / 6);
  if (size === 0) return [mean, mean, mean];
  const det = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / size ** 3;
  const angle = Math.acos(Math.max(-1, Math.min(1, det / 2))) / 3;
  const first = mean + 2 * size * Math.cos(angle);
  const last = mean + 2 * size * Math.cos(angle + (2 * Math.PI) / 3);
  return [first, 3 * mean - first - last, last];
}

/** The stresses that a picture can show: id, label, kind and value(tensor). */
export function stressFields(dimension) {
  return [
    { id: "von_mises", label: "von Mises", kind: "sequential", value: vonMises },
    { id: "s1", label: "largest principal, \u03c3\u2081", kind: "diverging", value: (tensor) => principal(tensor)[0] },
    { id: "s2", label: "middle principal, \u03c3\u2082", kind: "diverging", value: (tensor) => principal(tensor)[1] },
    { id: "s3", label: "smallest principal, \u03c3\u2083", kind: "diverging", value: (tensor) => principal(tensor)[2] },
    ...stressNames(dimension).map((name, i) => ({ id: `s${name}`, label: `\u03c3 ${name}`, kind: "diverging", value: (tensor) => tensor[i] })),
  ];
}

/** A stress at all entries of the arrays. */
export function stressValues(stress, ratio, value) {
  const at = tensorAt(stress, ratio);
  return Float32Array.from({ length: stress[0].length }, (_, i) => value(at(i)));
}
