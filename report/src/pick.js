// The triangle under the pointer.

/** The frontmost triangle at (right, up) from the middle of the picture: its first corner and barycentric coordinates. */
export function cornerAt(corners, camera, right, up) {
  const axes = camera.axes();
  const along = (axis, place) => axis[0] * corners[place] + axis[1] * corners[place + 1] + axis[2] * corners[place + 2];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const px = right + dot(axes.right, camera.target);
  const py = up + dot(axes.up, camera.target);
  let best = null;
  for (let place = 0; place < corners.length; place += 9) {
    const [ax, bx, cx] = [along(axes.right, place) - px, along(axes.right, place + 3) - px, along(axes.right, place + 6) - px];
    if ((ax > 0 && bx > 0 && cx > 0) || (ax < 0 && bx < 0 && cx < 0)) continue;
    const [ay, by, cy] = [along(axes.up, place) - py, along(axes.up, place + 3) - py, along(axes.up, place + 6) - py];
    const [wa, wb, wc] = [bx * cy - cx * by, cx * ay - ax * cy, ax * by - bx * ay];
    const sum = wa + wb + wc;
    if (sum === 0 || Math.min(wa / sum, wb / sum, wc / sum) < 0) continue;
    const weights = [wa / sum, wb / sum, wc / sum];
    const depth = weights.reduce((total, w, i) => total + w * along(axes.eye, place + 3 * i), 0);
    if (best === null || depth > best.depth) best = { corner: place / 3, weights, depth };
  }
  return best;
}

export function valueAt(values, { corner, weights }) {
  return weights.reduce((sum, w, i) => sum + w * values[corner + i], 0);
}
