// Bodies in contact: how they are drawn apart, and which are shown.

import { element } from "./dom.js";

const turning = 0.05; // mean normals shorter than this belong to surfaces that close around a body
const distance = 0.3; // of the diagonal, between two bodies that are fully drawn apart

/** Low and high corner of each body. */
function bodyBoxes({ points, dimension, vertexBody, nBodies }) {
  const boxes = Array.from({ length: nBodies }, () => ({ low: Array(dimension).fill(Infinity), high: Array(dimension).fill(-Infinity) }));
  vertexBody.forEach((body, v) => {
    const { low, high } = boxes[body];
    for (let c = 0; c < dimension; ++c) {
      const x = points[dimension * v + c];
      if (x < low[c]) low[c] = x;
      if (x > high[c]) high[c] = x;
    }
  });
  return boxes;
}

/** From slave to master: along the normal, or along the axis where one body surrounds the other. */
function separation({ bodies: [slave, master], normal, axis }, boxes, length, diagonal) {
  const size = Math.hypot(...normal);
  if (size > turning) return normal.map((x) => (x / size) * length);
  const along = (box, side) => axis.reduce((sum, a, c) => sum + a * (a > 0 === side > 0 ? box.high[c] : box.low[c]), 0);
  const free = along(boxes[slave], 1) - along(boxes[master], -1) + 0.1 * diagonal;
  return axis.map((x) => x * free);
}

/** Solves (L + small) x = b for the graph of the interfaces, by elimination: one unknown per body. */
function balance(nBodies, pairs, right) {
  const rows = Array.from({ length: nBodies }, (_, i) => Array.from({ length: nBodies }, (__, j) => (i === j ? 1e-9 : 0)));
  for (const [a, b] of pairs) {
    rows[a][a] += 1; rows[b][b] += 1;
    rows[a][b] -= 1; rows[b][a] -= 1;
  }
  const x = right.map((row) => [...row]);
  for (let k = 0; k < nBodies; ++k)
    for (let i = 0; i < nBodies; ++i) {
      const factor = i === k ? 0 : rows[i][k] / rows[k][k];
      if (factor === 0) continue;
      for (let j = k; j < nBodies; ++j) rows[i][j] -= factor * rows[k][j];
      x[k].forEach((value, c) => { x[i][c] -= factor * value; });
    }
  return x.map((row, i) => row.map((value) => value / rows[i][i]));
}

/** How far each body moves when fully drawn apart: the displacement jump at each interface is as close as possible to its separation. */
export function explosion(surface) {
  const { interfaces, nBodies, dimension, box } = surface;
  const boxes = bodyBoxes(surface);
  const length = (distance * box.diagonal) / Math.sqrt(Math.max(1, nBodies - 1));
  const right = Array.from({ length: nBodies }, () => Array(dimension).fill(0));
  for (const part of interfaces)
    separation(part, boxes, length, box.diagonal).forEach((x, c) => {
      right[part.bodies[0]][c] -= x;
      right[part.bodies[1]][c] += x;
    });
  const offsets = balance(nBodies, interfaces.map(({ bodies }) => bodies), right);
  return { boxes, offsets: offsets.map((offset) => [...offset, 0].slice(0, 3)) };
}

/** Which bodies are shown, and where. */
export class Bodies {
  /** `levels`: of the certificate; `changed()` is called when another body is shown or hidden. */
  constructor(levels, changed) {
    Object.assign(this, { levels, changed, hidden: new Set(), names: [], apart: new Map() });
    this.list = element("ul", { class: "legend legend-column" });
    this.element = element("fieldset", { class: "bodies", hidden: true }, element("legend", { class: "legend-title" }, "bodies"), this.list);
  }

  /** Bodies keep their names from level to level, not their numbers. */
  take(surface) {
    const known = this.levels.find(({ level }) => level === surface.level)?.bodies ?? [];
    const names = Array.from({ length: surface.nBodies }, (_, i) => known[i]?.name ?? `body ${i + 1}`);
    if (!this.apart.has(surface)) this.apart.set(surface, surface.interfaces?.length > 0 ? explosion(surface) : null);
    this.current = this.apart.get(surface);
    if (names.join("\n") === this.names.join("\n")) return;
    this.names = names;
    this.element.hidden = names.length < 2;
    this.list.replaceChildren(...names.map((name, i) => element("li", {}, element("label", {},
      element("input", { type: "checkbox", id: `body-${i}`, checked: !this.hidden.has(name), onchange: ({ target }) => {
        this.hidden[target.checked ? "delete" : "add"](name);
        this.changed();
      } }), name))));
  }

  get anyHidden() {
    return this.names.some((name) => this.hidden.has(name));
  }

  /** Per body the vector by which it is moved, null where it is hidden; `amount` from 0 to 1. */
  layout(amount) {
    return this.names.map((name, i) => (this.hidden.has(name) ? null
      : (this.current?.offsets[i] ?? [0, 0, 0]).map((x) => amount * x)));
  }

  /** Middle, about the centre of the assembly, and size of the visible bodies. */
  extent({ box }, amount) {
    const layout = this.current ? this.layout(amount) : [];
    if (!layout.some((shift) => shift)) return { middle: [0, 0, 0], size: box.size };
    const low = box.low.map((_, c) => Math.min(...layout.map((shift, b) => (shift ? (this.current.boxes[b].low[c] ?? 0) + shift[c] : Infinity))));
    const high = box.low.map((_, c) => Math.max(...layout.map((shift, b) => (shift ? (this.current.boxes[b].high[c] ?? 0) + shift[c] : -Infinity))));
    return { middle: low.map((x, c) => (x + high[c]) / 2 - box.centre[c]), size: high.map((x, c) => x - low[c]) };
  }
}
