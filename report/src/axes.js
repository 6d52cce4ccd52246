// The names of the axes and of the components of the stress: x, y, z, or on a meridian r, z and θ around the axis. A page shows one case.

let isMeridian = false;

/** `model`: of the certificate. */
export function nameAxes(model) {
  isMeridian = model === "axisymmetric";
}

export const showsMeridian = () => isMeridian;

export function axisNames(d) {
  return isMeridian ? ["r", "z"] : ["x", "y", "z"].slice(0, d);
}

/** Of the stresses xx, yy, zz, xy in 2D, and xx, yy, zz, xy, yz, xz in 3D. */
export function stressNames(d) {
  if (isMeridian) return ["rr", "zz", "\u03b8\u03b8", "rz"];
  return d === 2 ? ["xx", "yy", "zz", "xy"] : ["xx", "yy", "zz", "xy", "yz", "xz"];
}
