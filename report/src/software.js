// The picture of a surface for browsers without WebGL: the same as in scene.js, with its own depth buffer.

import { rgb } from "d3";

const nColours = 256;
const grey = [184, 190, 198];
const ofObstacle = [140, 128, 112];

function palette(colourAt) {
  return Array.from({ length: nColours }, (_, i) => {
    const { r, g, b } = rgb(colourAt(i / (nColours - 1)));
    return [r, g, b];
  });
}

export class SoftwareScene {
  constructor(place, dimension) {
    this.canvas = document.createElement("canvas");
    place.append(this.canvas);
    this.context = this.canvas.getContext("2d");
    this.isLit = dimension === 3;
    Object.assign(this, { nColoured: 0, nTriangles: 0, segments: null, obstacle: null });
  }

  setTriangles(nTriangles, nColoured) {
    Object.assign(this, { nTriangles, nColoured });
  }

  setPositions(corners, vertices) {
    Object.assign(this, { corners, vertices });
  }

  setValues(values, _, { low, high }, colourAt) {
    Object.assign(this, { values, low, perColour: (nColours - 1) / (high - low), palette: palette(colourAt) });
  }

  setLines(segments) {
    this.segments = segments;
  }

  setObstacle(corners) {
    this.obstacle = corners;
  }

  resize(width, height, background, line) {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.canvas.width = Math.max(1, Math.round(width * ratio));
    this.canvas.height = Math.max(1, Math.round(height * ratio));
    const bytes = (colour) => [rgb(colour).r, rgb(colour).g, rgb(colour).b];
    Object.assign(this, { background: bytes(background), line: bytes(line) });
  }

  /** Pixels to the right and downwards, and the height towards the eye, of points. */
  project(positions, camera) {
    const { right, up, eye } = camera.axes();
    const [{ width, height }, { target }] = [this.canvas, camera];
    const pixels = height / (2 * camera.scale);
    const dot = (axis, x, y, z) => axis[0] * x + axis[1] * y + axis[2] * z;
    const result = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
      const [x, y, z] = [positions[i] - target[0], positions[i + 1] - target[1], positions[i + 2] - target[2]];
      result[i] = width / 2 + pixels * dot(right, x, y, z);
      result[i + 1] = height / 2 - pixels * dot(up, x, y, z);
      result[i + 2] = pixels * dot(eye, x, y, z);
    }
    return result;
  }

  put(pixel, [r, g, b], light) {
    this.image.data[4 * pixel] = r * light;
    this.image.data[4 * pixel + 1] = g * light;
    this.image.data[4 * pixel + 2] = b * light;
    this.image.data[4 * pixel + 3] = 255;
  }

  /** The triangle of the corners c, c + 1, c + 2 of projected points; colourOf(weights): of its points. */
  fill(p, c, colourOf) {
    const { width, height } = this.canvas;
    const [ax, ay, az, bx, by, bz, cx, cy, cz] = p.subarray(3 * c, 3 * c + 9);
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) return;
    const light = this.isLit ? 0.5 + 0.5 * Math.abs(area) / Math.hypot(area, (by - ay) * (cz - az) - (bz - az) * (cy - ay),
      (bz - az) * (cx - ax) - (bx - ax) * (cz - az)) : 1;
    const [x0, x1] = [Math.max(0, Math.floor(Math.min(ax, bx, cx))), Math.min(width - 1, Math.ceil(Math.max(ax, bx, cx)))];
    const [y0, y1] = [Math.max(0, Math.floor(Math.min(ay, by, cy))), Math.min(height - 1, Math.ceil(Math.max(ay, by, cy)))];
    for (let y = y0; y <= y1; ++y)
      for (let x = x0; x <= x1; ++x) {
        const [dx, dy] = [x + 0.5 - ax, y + 0.5 - ay];
        const wb = (dx * (cy - ay) - dy * (cx - ax)) / area;
        const wc = ((bx - ax) * dy - (by - ay) * dx) / area;
        if (wb < -1e-6 || wc < -1e-6 || wb + wc > 1 + 1e-6) continue;
        const depth = az + wb * (bz - az) + wc * (cz - az);
        const pixel = y * width + x;
        if (depth < this.depth[pixel]) continue;
        this.depth[pixel] = depth;
        this.put(pixel, colourOf(wb, wc), light);
      }
  }

  /** Draws segments over what lies behind them, a third opaque. */
  drawLines(p) {
    const { width, height } = this.canvas;
    const { data } = this.image;
    for (let s = 0; s < this.segments.length; s += 2) {
      const [a, b] = [3 * this.segments[s], 3 * this.segments[s + 1]];
      const steps = Math.max(1, Math.ceil(Math.max(Math.abs(p[b] - p[a]), Math.abs(p[b + 1] - p[a + 1]))));
      for (let i = 0; i < steps; ++i) {
        const [x, y, z] = [0, 1, 2].map((k) => p[a + k] + ((p[b + k] - p[a + k]) * i) / steps);
        const pixel = Math.floor(y) * width + Math.floor(x);
        if (x < 0 || y < 0 || x >= width || y >= height || z < this.depth[pixel] - 2) continue;
        for (let k = 0; k < 3; ++k) data[4 * pixel + k] += 0.32 * (this.line[k] - data[4 * pixel + k]);
      }
    }
  }

  render(camera) {
    const { width, height } = this.canvas;
    this.image = this.context.createImageData(width, height);
    this.depth = new Float32Array(width * height).fill(-Infinity);
    for (let pixel = 0; pixel < width * height; ++pixel) this.put(pixel, this.background, 1);
    const corners = this.project(this.corners, camera);
    const { values, low, perColour, palette: colours } = this;
    for (let t = 0; t < this.nTriangles; ++t) {
      const [a, b, c] = [values[3 * t], values[3 * t + 1], values[3 * t + 2]];
      this.fill(corners, 3 * t, t >= this.nColoured ? () => grey : (wb, wc) =>
        colours[Math.max(0, Math.min(nColours - 1, Math.round((a + wb * (b - a) + wc * (c - a) - low) * perColour)))]);
    }
    if (this.obstacle) {
      const shown = this.project(this.obstacle, camera);
      for (let c = 0; c < shown.length / 3; c += 3) this.fill(shown, c, () => ofObstacle);
    }
    if (this.segments) this.drawLines(this.project(this.vertices, camera));
    this.context.putImageData(this.image, 0, 0);
  }
}
