// A picture of triangles in colours: the canvas, what lies over it, what the pointer is told, and its copy for paper.

import { axisNames } from "./axes.js";
import { bindCamera } from "./camera.js";
import { element, number, withoutNoise } from "./dom.js";
import { cornerAt } from "./pick.js";
import { hasWebGL, Scene } from "./scene.js";
import { SoftwareScene } from "./software.js";

export class Picture {
  /** `paperWidth`: in CSS pixels, on paper. */
  constructor(is2d, label, paperWidth) {
    this.paperWidth = paperWidth;
    this.place = element("div", { class: "view", tabindex: "0", role: "img", "aria-label": label });
    this.overlay = element("svg:svg", { class: "view-overlay", "aria-hidden": "true" });
    this.frame = element("div", { class: `view-frame view-${is2d ? 2 : 3}d` }, this.place, this.overlay,
      (this.tooltip = element("div", { class: "tooltip", hidden: true })));
    this.print = element("svg:svg", { class: "view-overlay print-only", "aria-hidden": "true" });
  }

  /**
   * Begins to draw. `view`: camera, home(), changed() after the camera has moved, depth(), larger than the body seen from anywhere,
   * overlay(place): the elements over the picture, describe(hit): the tooltip of a point.
   */
  start(view, dimension) {
    this.view = view;
    this.scene = new (hasWebGL() ? Scene : SoftwareScene)(this.place, dimension);
    bindCamera(this.place, view.camera, view.home, view.changed);
    new ResizeObserver(() => this.fit()).observe(this.place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.fit());
    addEventListener("beforeprint", () => this.keep());
    this.place.addEventListener("pointermove", (event) => { this.pointer = event; this.point(); });
    this.place.addEventListener("pointerleave", () => { this.pointer = null; this.point(); });
  }

  /** Adapts to the size and background of its place; redraws only if they change, since that may take long. */
  fit() {
    const { clientWidth: width, clientHeight: height } = this.place;
    const style = getComputedStyle(this.frame);
    const [background, line] = ["--panel", "--mesh-line"].map((name) => style.getPropertyValue(name).trim());
    const look = `${width} ${height} ${background}`;
    if (look === this.look) return;
    this.look = look;
    this.scene.resize(width, height, background || "#ffffff", line || "#10161d");
    this.draw();
  }

  /** Positions of the corners of all triangles, and of the vertices of lines. */
  setPositions(corners, vertices) {
    this.corners = corners;
    this.scene.setPositions(corners, vertices);
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = null;
      this.render();
      this.point();
    });
  }

  render() {
    if (!this.corners || this.place.clientWidth === 0) return;
    this.scene.render(this.view.camera, this.view.depth());
    this.overlay.replaceChildren(...this.view.overlay(this.place));
  }

  /** Describes the point under the pointer, again whenever either moves. */
  point() {
    if (this.pointing) return;
    this.pointing = requestAnimationFrame(() => {
      this.pointing = null;
      const hit = this.pointer && !this.pointer.buttons && this.corners ? this.hit(this.pointer) : null;
      this.tooltip.hidden = hit === null;
      if (hit !== null) this.tell(hit);
    });
  }

  hit(event) {
    const box = this.place.getBoundingClientRect();
    const { camera } = this.view;
    const length = (2 * camera.scale) / box.height;
    const [px, py] = [event.clientX - box.left, event.clientY - box.top];
    const found = cornerAt(this.corners, camera, (px - box.width / 2) * length, (box.height / 2 - py) * length);
    return found && { ...found, px, py };
  }

  tell({ px, py, ...hit }) {
    this.tooltip.replaceChildren(...this.view.describe(hit));
    this.tooltip.style.left = `${Math.min(px + this.place.offsetLeft + 14, this.frame.clientWidth - 170)}px`;
    this.tooltip.style.top = `${py + this.place.offsetTop + 14}px`;
  }

  /** On paper the canvas would be empty; its image replaces it, with everything drawn over it. */
  keep() {
    this.render();
    const { offsetLeft: x, offsetTop: y, clientLeft, clientTop } = this.place;
    const [right, bottom] = [this.frame.clientWidth - x - this.place.offsetWidth, this.frame.clientHeight - y - this.place.offsetHeight];
    const width = this.paperWidth - x - right;
    const height = (width * this.place.clientHeight) / this.place.clientWidth;
    const place = { offsetLeft: x, offsetTop: y, clientLeft, clientTop, clientWidth: width, clientHeight: height };
    this.print.setAttribute("viewBox", `0 0 ${this.paperWidth} ${y + height + bottom}`);
    this.print.replaceChildren(element("svg:image", { x, y, width, height, href: this.scene.canvas.toDataURL("image/png") }),
      ...this.view.overlay(place));
  }
}

/** The place of a hit in the undeformed body, as text; `undeformed`: positions of the corners about the centre of the surface. */
export function placeText({ dimension, box }, undeformed, { corner, weights }) {
  const axes = axisNames(dimension);
  const place = withoutNoise(axes.map((_, c) => box.centre[c] + weights.reduce((sum, w, i) => sum + w * undeformed[3 * (corner + i) + c], 0)),
    100 * box.diagonal);
  return axes.map((axis, c) => `${axis} = ${number(place[c], 4)}`).join(", ");
}

/** Half the height of a picture of these proportions that shows a body of this size, with room for its displacements. */
export function homeScale(size, dimension, { clientWidth, clientHeight }) {
  const aspect = clientWidth / Math.max(1, clientHeight) || 1.5;
  return dimension === 2 ? Math.max(size[1], size[0] / aspect) * 0.66 : Math.hypot(...size) * 0.56 * Math.max(1, 1 / aspect);
}

/** The proportions of the frame around a body in 2D. */
export const frameAspect = (size) => Math.min(2.4, Math.max(1, size[0] / size[1])) * 0.97;
