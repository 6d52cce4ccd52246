// How the mouse, fingers and keys move a parallel projection: dragging turns (3D) or moves (2D), with Shift or two fingers
// it moves, the wheel and pinching zoom about the pointer.

const degrees = Math.PI / 180;

/** Unit vectors to the right, upwards and towards the eye, for both angles 0. */
function frameOf(up) {
  const axis = Math.abs(up) - 1;
  const upwards = [0, 1, 2].map((i) => (i === axis ? Math.sign(up) : 0));
  const right = [0, 1, 2].map((i) => (i === (axis === 0 ? 1 : 0) ? 1 : 0));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  return [right, upwards, cross(right, upwards)];
}

export class Camera {
  /** Angles in degrees about the axis `up` of the body, 1, 2 or 3 for x, y, z, negative for the opposite direction. */
  constructor(dimension, { azimuth = 0, elevation = 0, up = 2 } = {}) {
    this.dimension = dimension;
    Object.assign(this, { azimuth, elevation, frame: frameOf(up) });
    this.reset(1);
  }

  /** Puts the origin in the middle, with `scale` above and below it. */
  reset(scale) {
    Object.assign(this, { target: [0, 0, 0], scale });
  }

  /** Unit vectors to the right, upwards and towards the eye. */
  axes() {
    if (this.dimension === 2) return { right: [1, 0, 0], up: [0, 1, 0], eye: [0, 0, 1] };
    const [sa, ca] = [Math.sin(this.azimuth * degrees), Math.cos(this.azimuth * degrees)];
    const [se, ce] = [Math.sin(this.elevation * degrees), Math.cos(this.elevation * degrees)];
    const inBody = (vector) => [0, 1, 2].map((c) => vector.reduce((sum, x, i) => sum + x * this.frame[i][c], 0));
    return { right: inBody([ca, 0, -sa]), up: inBody([-se * sa, ce, -se * ca]), eye: inBody([ce * sa, se, ce * ca]) };
  }

  /** Moves by lengths of the body to the right and upwards. */
  move(right, up) {
    const axes = this.axes();
    this.target = this.target.map((x, i) => x - right * axes.right[i] - up * axes.up[i]);
  }

  turn(right, up) {
    this.azimuth -= right;
    this.elevation = Math.max(-90, Math.min(90, this.elevation + up));
  }

  /** Zooms about the point that lies (right, up) from the middle of the picture. */
  zoom(factor, right = 0, up = 0) {
    this.move(right * (1 / factor - 1), up * (1 / factor - 1));
    this.scale /= factor;
  }
}

/** Lets the events of `place` control the camera; `changed` is called after each. */
export function bindCamera(place, camera, home, changed) {
  const pointers = new Map();
  const lengthPerPixel = () => (2 * camera.scale) / place.clientHeight;
  /** The position relative to the middle of the picture, to the right and upwards, in lengths of the body. */
  const fromMiddle = (event) => {
    const box = place.getBoundingClientRect();
    return [(event.clientX - box.left - box.width / 2) * lengthPerPixel(), (box.top + box.height / 2 - event.clientY) * lengthPerPixel()];
  };

  place.addEventListener("pointerdown", (event) => {
    place.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
  });
  for (const end of ["pointerup", "pointercancel"]) place.addEventListener(end, (event) => pointers.delete(event.pointerId));
  place.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
    const other = [...pointers.values()].find(({ pointerId }) => pointerId !== event.pointerId);
    pointers.set(event.pointerId, event);
    if (other) {
      const distance = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
      camera.zoom(distance(event) / Math.max(1, distance(before)));
      camera.move((dx / 2) * lengthPerPixel(), (-dy / 2) * lengthPerPixel());
    } else if (camera.dimension === 2 || event.shiftKey || event.buttons & 6) camera.move(dx * lengthPerPixel(), -dy * lengthPerPixel());
    else camera.turn(dx * 0.4, dy * 0.4);
    changed();
  });
  place.addEventListener("contextmenu", (event) => event.preventDefault());
  // The wheel scrolls the page until the picture has been clicked, or Ctrl is held down.
  place.addEventListener("wheel", (event) => {
    if (document.activeElement !== place && !event.ctrlKey) return;
    event.preventDefault();
    camera.zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), ...fromMiddle(event));
    changed();
  }, { passive: false });
  place.addEventListener("dblclick", () => { home(); changed(); });
  place.addEventListener("keydown", (event) => {
    const step = 0.1 * camera.scale;
    const flat = camera.dimension === 2 || event.shiftKey;
    const actions = {
      ArrowLeft: () => (flat ? camera.move(step, 0) : camera.turn(-10, 0)), ArrowRight: () => (flat ? camera.move(-step, 0) : camera.turn(10, 0)),
      ArrowUp: () => (flat ? camera.move(0, -step) : camera.turn(0, -10)), ArrowDown: () => (flat ? camera.move(0, step) : camera.turn(0, 10)),
      "+": () => camera.zoom(1.25), "=": () => camera.zoom(1.25), "-": () => camera.zoom(0.8), 0: home,
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
    changed();
  });
}
