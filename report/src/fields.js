// The interactive picture of the mesh and the fields on it.

import { bindCamera, Camera } from "./camera.js";
import { components, statusColours, statusNames } from "./components.js";
import { count, element, number, section } from "./dom.js";
import { overlay } from "./overlay.js";
import { cornerAt, valueAt } from "./pick.js";
import { areaVector, colourRange, cornerPositions, fieldsOf, readSurface, vertexPositions } from "./surface.js";
import { colours, fieldLegend, onScale } from "./scales.js";
import { Scene, transferFunction } from "./scene.js";

const paperWidth = 530; // CSS pixels of the picture on paper, beside its legend
const manySegments = 30000; // beyond, the mesh is not drawn unless asked for

/** 1, 2 or 5 times a power of ten, not above x. */
function roundedDown(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [5, 2, 1].find((digit) => digit * power <= x * (1 + 1e-9)) * power;
}

/** The amplification at which the largest displacement is a tenth of the body, 1 where it is not small. */
function usualFactor({ largestDisplacement, box }) {
  if (largestDisplacement === 0) return 1;
  const factor = (0.1 * box.diagonal) / largestDisplacement;
  return factor < 1.5 ? 1 : roundedDown(factor);
}

/** Where contact values are to be seen from: outside the contact boundary. */
function contactDirection(surface) {
  const corners = 3 * surface.nContactFaces * surface.trianglesPerFace;
  const normal = [0, 0, 0];
  for (let c = 0; c < corners; c += 3) areaVector(surface, c).forEach((x, i) => { normal[i] += x; });
  const length = Math.hypot(...normal) || 1;
  const [x, y, z] = normal.map((component) => component / length);
  return Math.hypot(x, z) > 0.5 ? { azimuth: Math.round((Math.atan2(x, z) * 180) / Math.PI) + 25, elevation: 20 }
    : { azimuth: 35, elevation: y < 0 ? -40 : 40 };
}

/** From above, from the corner from which most of large values is seen: often that is where a model is cut by symmetry. */
function firstDirection(surface, values, range) {
  if (surface.dimension === 2) return {};
  const seen = [35, 125, 215, 305].map((azimuth) => {
    const { eye } = new Camera(3, { azimuth, elevation: 20 }).axes();
    let [sum, area] = [0, 0];
    for (let c = 0; c < values.length; c += 3) {
      const weight = areaVector(surface, c).reduce((total, x, i) => total + x * eye[i], 0);
      if (weight <= 0) continue;
      area += weight;
      sum += weight * Math.min(values[c], range.high);
    }
    return { azimuth, elevation: 20, mean: sum / area };
  });
  return seen.reduce((best, other) => (other.mean > best.mean * 1.001 ? other : best));
}

class FieldView {
  constructor(data) {
    this.data = data;
    this.levels = data.fields;
    this.state = { level: this.levels.length - 1, field: "von_mises", factor: null, mesh: null };
    this.surfaces = new Map();
    this.build();
  }

  build() {
    const last = this.levels.at(-1);
    this.place = element("div", { class: "view", tabindex: "0", role: "img", "aria-label": "Mesh and fields" });
    this.overlay = element("svg:svg", { class: "view-overlay", "aria-hidden": "true" });
    this.frame = element("div", { class: `view-frame view-${last.dimension}d` }, this.place, this.overlay,
      (this.tooltip = element("div", { class: "tooltip", hidden: true })));
    this.legend = element("div", { class: "view-legend" });
    this.print = element("svg:svg", { class: "view-overlay print-only", "aria-hidden": "true" });
    this.note = element("p", { class: "note" });
    this.element = element("div", { class: "fields" }, this.controls(last),
      element("div", { class: "view-row" }, this.frame, this.print, this.legend), this.note,
      element("p", { class: "note screen-only" }, last.dimension === 2
        ? "Drag to move, scroll after a click (or with Ctrl) to zoom, double-click for the whole body; keys: arrows, +, \u2212, 0."
        : "Drag to turn, with Shift to move, scroll after a click (or with Ctrl) to zoom, double-click for the whole body; keys: arrows, +, \u2212, 0."));
  }

  controls() {
    const control = (label, ...inputs) => element("label", { class: "control" }, element("span", {}, label), ...inputs);
    this.fieldInput = element("select", { id: "field", onchange: () => this.set({ field: this.fieldInput.value }) });
    this.levelInput = element("input", { id: "level", type: "range", min: 0, max: this.levels.length - 1, step: 1,
      oninput: () => this.set({ level: Number(this.levelInput.value) }) });
    this.levelText = element("output", { for: "level" });
    this.factorInput = element("input", { id: "factor", type: "range", min: 0, max: 100, step: 1,
      oninput: () => this.set({ factor: (this.factorInput.value / 25) * this.usual }) });
    this.factorText = element("output", { for: "factor" });
    this.meshInput = element("input", { id: "mesh", type: "checkbox", onchange: () => this.set({ mesh: this.meshInput.checked }) });
    return element("div", { class: "controls screen-only" }, control("Field", this.fieldInput),
      this.levels.length > 1 ? control("Level", this.levelInput, this.levelText) : null,
      control("Deformation", this.factorInput, this.factorText),
      element("button", { type: "button", title: "displacements at true scale", onclick: () => this.set({ factor: 1 }) }, "1 : 1"),
      element("label", { class: "control control-check" }, this.meshInput, element("span", {}, "Mesh")),
      element("button", { type: "button", onclick: () => { this.home(); this.draw(); } }, "Reset view"));
  }

  /** The first picture; afterwards the page may be looked at. */
  async start() {
    await this.set({});
    new ResizeObserver(() => this.fit()).observe(this.place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.fit());
    addEventListener("beforeprint", () => this.keepPicture());
    this.place.addEventListener("pointermove", (event) => this.point(event));
    this.place.addEventListener("pointerleave", () => { this.tooltip.hidden = true; });
  }

  /** Gives the picture the size and the background of its place; drawn only where they change, for that may take long. */
  fit() {
    const { clientWidth: width, clientHeight: height } = this.place;
    const background = getComputedStyle(this.frame).getPropertyValue("--panel").trim() || "#ffffff";
    const look = `${width} ${height} ${background}`;
    if (look === this.look) return;
    this.look = look;
    this.scene?.resize(width, height, background);
    this.draw();
  }

  async surface(index) {
    if (!this.surfaces.has(index)) this.surfaces.set(index, readSurface(this.levels[index]));
    return this.surfaces.get(index);
  }

  /** Takes over what is given of the state and shows it. Of changes that overtake each other the last one counts. */
  async set(changes) {
    Object.assign(this.state, changes);
    const ticket = (this.ticket = (this.ticket ?? 0) + 1);
    const surface = await this.surface(this.state.level);
    if (ticket !== this.ticket) return;
    const isNew = surface !== this.current;
    this.current = surface;
    if (isNew) this.takeSurface(surface);
    const field = this.fields.find(({ id }) => id === this.state.field) ?? this.fields[0];
    if (isNew || this.field?.id !== field.id) this.takeField(field);
    if (isNew || "factor" in changes) this.takePositions();
    if (isNew || "mesh" in changes) this.scene?.setLines(this.state.mesh ? surface.segments().all : null);
    this.showState();
    this.draw();
  }

  takeSurface(surface) {
    if (!this.camera) {
      this.camera = new Camera(surface.dimension);
      const { size } = surface.box;
      if (surface.dimension === 2) this.frame.style.aspectRatio = Math.min(2.4, Math.max(1, size[0] / size[1])) * 0.97;
      this.usual = usualFactor(surface);
      this.state.factor ??= this.usual;
      try {
        this.scene = new Scene(this.place, surface.dimension);
      } catch {
        this.place.append(element("p", { class: "note" }, "This browser has no WebGL: there is no picture of the fields."));
      }
      bindCamera(this.place, this.camera, () => this.home(), () => this.draw());
      this.home();
      this.fit();
    }
    this.state.mesh ??= surface.nFaces * 3 * surface.subdivision <= manySegments;
    this.fields = fieldsOf(surface, components);
    const groups = [...new Set(this.fields.map(({ group }) => group))];
    this.fieldInput.replaceChildren(...groups.map((group) => element("optgroup", { label: group },
      this.fields.filter((field) => field.group === group).map(({ id, label }) => element("option", { value: id }, label)))));
  }

  takeField(field) {
    const { current: surface, scene } = this;
    this.values = field.corners(surface);
    this.range = colourRange(surface, field, this.values);
    if (!this.field) Object.assign(this.camera, firstDirection(surface, this.values, this.range));
    else if (field.contact && !this.field.contact) Object.assign(this.camera, contactDirection(surface));
    this.field = field;
    const range = { low: onScale(field.kind, this.range.low, this.range), high: onScale(field.kind, this.range.high, this.range) };
    const scaled = field.kind === "logarithmic" ? this.values.map((value) => onScale(field.kind, value, this.range)) : this.values;
    scene?.setTriangles(surface.vertex.length / 3, this.values.length / 3);
    scene?.setValues(scaled, surface.vertex.length, transferFunction(range, colours(field.kind, this.range)));
    const names = this.data.certificate.mesh.regions.map(({ name }) => name);
    this.legend.replaceChildren(fieldLegend(field, this.range, names));
    if (surface.profiles) this.legend.append(element("p", { class: "legend-title" }, "contact boundary"),
      element("ul", { class: "legend legend-column" }, statusNames.map((name, i) =>
        element("li", {}, element("span", { class: "swatch swatch-line", style: `--colour:${statusColours[i]}` }), name))));
  }

  takePositions() {
    this.vertices = vertexPositions(this.current, this.state.factor);
    this.corners = cornerPositions(this.current, this.vertices);
    this.scene?.setPositions(this.corners, this.vertices);
  }

  showState() {
    const { state, current: surface } = this;
    this.fieldInput.value = this.field.id;
    this.levelInput.value = state.level;
    this.levelText.textContent = `${surface.level} of ${this.levels.at(-1).level}, ${count(surface.cells)} cells`;
    this.factorInput.value = (25 * state.factor) / this.usual;
    this.factorText.textContent = `\u00d7 ${number(state.factor, 3)}`;
    this.meshInput.checked = state.mesh;
    const shown = surface.merged_below > 0
      ? `The mesh is too large for this page: details below ${number(surface.merged_below, 2)} L are merged, ${count(surface.nFaces)} triangles are shown. ` : "";
    const levels = this.levels.at(-1).level + 1 - this.levels.length;
    const left = levels > 0 ? `${levels} of the levels in between are left out to keep the page small. ` : "";
    const body = surface.dimension === 3 ? "Shown is the surface of the body. " : "";
    const scale = state.factor === 1 ? "at true scale" : `${number(state.factor, 3)} times as large`;
    this.note.textContent = `${body}${shown}${left}Displacements are drawn ${scale}.`;
    this.place.setAttribute("aria-label", `${this.field.label} on level ${surface.level}, displacements times ${number(state.factor, 3)}`);
  }

  /** The whole body, with room for its displacements. */
  home() {
    const { box } = this.current;
    const aspect = this.place.clientWidth / Math.max(1, this.place.clientHeight) || 1.5;
    const scale = this.current.dimension === 2 ? Math.max(box.size[1], box.size[0] / aspect) * 0.66
      : box.diagonal * 0.56 * Math.max(1, 1 / aspect);
    this.camera.reset(scale);
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = null;
      this.render();
    });
  }

  render() {
    if (!this.current || this.place.clientWidth === 0) return;
    this.scene?.render(this.camera, 10 * this.current.box.diagonal);
    this.overlay.replaceChildren(...overlay(this.current, this.camera, this.place, this.state.factor));
  }

  /** What is under the pointer. */
  point(event) {
    if (!this.corners || event.buttons || this.pointing) return;
    this.pointing = requestAnimationFrame(() => {
      this.pointing = null;
      const box = this.place.getBoundingClientRect();
      const [px, py] = [event.clientX - box.left, event.clientY - box.top];
      const length = (2 * this.camera.scale) / box.height;
      const hit = cornerAt(this.corners, this.camera, (px - box.width / 2) * length, (box.height / 2 - py) * length);
      this.tooltip.hidden = hit === null;
      if (hit === null) return;
      const { current: surface, field } = this;
      const { dimension: d, points, vertex } = surface;
      const place = ["x", "y", "z"].slice(0, d).map((axis, c) =>
        `${axis} = ${number(hit.weights.reduce((sum, w, i) => sum + w * points[d * vertex[hit.corner + i] + c], 0), 4)}`);
      const value = hit.corner < this.values.length ? valueAt(this.values, hit) : null;
      const regions = this.data.certificate.mesh.regions;
      const text = value === null ? "not on the contact boundary" : field.kind === "status" ? statusNames[Math.round(value)]
        : field.kind === "category" ? regions[Math.round(value)].name : `${number(value, 4)} ${field.unit}`;
      this.tooltip.replaceChildren(element("strong", {}, text), element("br"), place.join(", "));
      this.tooltip.style.left = `${Math.min(px + this.place.offsetLeft + 14, this.frame.clientWidth - 170)}px`;
      this.tooltip.style.top = `${py + this.place.offsetTop + 14}px`;
    });
  }

  /** On paper the canvas would be empty: there its picture stands with all that lies on it. */
  keepPicture() {
    if (!this.scene) return;
    this.render();
    const { offsetLeft: x, offsetTop: y, clientLeft, clientTop } = this.place;
    const [right, bottom] = [this.frame.clientWidth - x - this.place.offsetWidth, this.frame.clientHeight - y - this.place.offsetHeight];
    const width = paperWidth - x - right;
    const height = (width * this.place.clientHeight) / this.place.clientWidth;
    const place = { offsetLeft: x, offsetTop: y, clientLeft, clientTop, clientWidth: width, clientHeight: height };
    this.print.setAttribute("viewBox", `0 0 ${paperWidth} ${y + height + bottom}`);
    this.print.replaceChildren(element("svg:image", { x, y, width, height, href: this.scene.canvas.toDataURL("image/png") }),
      ...overlay(this.current, this.camera, place, this.state.factor));
  }
}

export function fieldsSection(data) {
  if (data.fields.length === 0) return { element: null, start: async () => {} };
  const view = new FieldView(data);
  return { element: section("fields", "Fields", "Mesh and fields", null, view.element), start: () => view.start(), view };
}
