// Their solution and ours side by side with one colour scale, and the cells in which they differ.

import { unpackAll } from "./arrays.js";
import { Camera } from "./camera.js";
import { firstDirection, upAxis } from "./directions.js";
import { count, element, number, section } from "./dom.js";
import { exportButtons } from "./export.js";
import { usualFactor, valueText } from "./field_words.js";
import { hasCore } from "./judgement_words.js";
import { overlay } from "./overlay.js";
import { frameAspect, homeScale, Picture, placeText } from "./picture.js";
import { valueAt } from "./pick.js";
import { colours, fieldLegend, isNamed, onScale } from "./scales.js";
import { colourRange, cornerPositions, faceValues, fieldRows, fieldsOf, readSurface, vertexPositions } from "./surface.js";
import { unit } from "./units.js";

const paperWidth = 270; // CSS pixels of each picture on paper
const manySegments = 30000; // beyond this, the mesh is not drawn
const places = ["elsewhere", "core", "core, to be refined"];

/** What the third picture can show, cell by cell; no distances where all are 0. */
function cellFields({ distance, stress_distance: ofStress, place }, core) {
  const field = (id, label, kind, values) => (isNamed(kind) || values?.some((value) => value > 0)) && { id, label, kind, unit: isNamed(kind) ? "" : unit("energy_norm"), corners: (s) => faceValues(s, values) };
  return [field("place", hasCore(core) ? "where the error lies" : "where theirs and ours differ", "judged", place), field("distance", "distance of the displacements", "logarithmic", distance),
    field("stress-distance", "distance of the stresses", "logarithmic", ofStress)].filter(Boolean);
}

/** The range that holds both. */
function common(a, b) {
  return { low: Math.min(a.low, b.low), high: Math.max(a.high, b.high), largest: Math.max(a.largest, b.largest) };
}

/** One of the pictures: a surface with a field. */
class Pane {
  constructor(title, is2d) {
    this.picture = new Picture(is2d, title, paperWidth);
    this.element = element("figure", {}, element("h3", {}, title), this.picture.frame, this.picture.print);
  }

  start(surface, view) {
    this.surface = surface;
    const { camera } = view;
    if (surface.dimension === 2) this.picture.frame.style.aspectRatio = frameAspect(surface.box.size);
    this.picture.start({ ...view, depth: () => 10 * surface.box.diagonal,
      overlay: (place) => overlay(surface, camera, place, { factor: this.factor, obstacle: false }),
      describe: (hit) => [element("strong", {}, valueText(this.field, valueAt(this.values, hit), places)), element("br"), placeText(surface, this.undeformed, hit)] },
    surface.dimension);
    this.undeformed = cornerPositions(surface, vertexPositions(surface, 0));
    this.picture.fit();
  }

  setField(field, values, range) {
    Object.assign(this, { field, values });
    const { scene } = this.picture;
    const scaled = field.kind === "logarithmic" ? values.map((value) => onScale(field.kind, value, range)) : values;
    scene.setTriangles(values.length / 3, values.length / 3);
    scene.setValues(scaled, values.length, { low: onScale(field.kind, range.low, range), high: onScale(field.kind, range.high, range) }, colours(field.kind, range));
  }

  setFactor(factor) {
    this.factor = factor;
    const vertices = vertexPositions(this.surface, factor);
    this.picture.setPositions(cornerPositions(this.surface, vertices), vertices);
  }

  setMesh(isShown) {
    this.picture.scene.setLines(isShown ? this.surface.segments().all : null);
  }
}

class Comparison {
  constructor(data, judgement) {
    Object.assign(this, { data, judgement });
    const is2d = data.theirs.dimension === 2;
    this.panes = ["Theirs", "Ours", "How far apart, cell by cell"].map((title) => new Pane(title, is2d));
    this.legend = element("div", { class: "view-legend" });
    this.cellLegend = element("div", { class: "view-legend" });
    this.field = element("select", { id: "field", onchange: () => this.show() });
    this.cells = element("select", { id: "cell-field", onchange: () => this.show() });
    this.factor = element("input", { id: "factor", type: "range", min: 0, max: 100, step: 1, value: 25, oninput: () => this.show() });
    this.factorText = element("output", { for: "factor" });
    this.mesh = element("input", { id: "mesh", type: "checkbox", onchange: () => this.show() });
    const control = (label, ...inputs) => element("label", { class: "control" }, element("span", {}, label), ...inputs);
    const controls = element("div", { class: "controls screen-only" }, control("Field", this.field), control("Cells", this.cells),
      control("Deformation", this.factor, this.factorText), element("label", { class: "control" }, this.mesh, element("span", {}, "Mesh")),
      element("button", { type: "button", title: "the whole body", onclick: () => { this.home(); this.draw(); } }, "Reset view"),
      exportButtons("judged_fields", () => this.pictures(), () => this.rows()));
    const [theirs, ours, apart] = this.panes;
    this.words = element("div", { class: "beside" });
    this.note = element("p", { class: "note" });
    this.element = element("div", { class: "side-by-side" }, controls, element("div", { class: "view-row" }, theirs.element, ours.element, this.legend),
      element("div", { class: "view-row" }, apart.element, this.words, this.cellLegend), this.note);
  }

  async start() {
    const [theirs, ours, cells] = await Promise.all([readSurface(this.data.theirs), readSurface(this.data.ours), this.readCells()]);
    this.surfaces = [theirs, ours];
    this.fields = fieldsOf(theirs, []).filter(({ group }) => group !== "Mesh");
    this.cellFields = cellFields(cells, this.judgement.displacement.core);
    for (const [select, fields] of [[this.field, this.fields], [this.cells, this.cellFields]])
      select.replaceChildren(...fields.map(({ id, label }) => element("option", { value: id }, label)));
    this.field.value = "von_mises";
    this.usual = usualFactor(ours);
    this.mesh.checked = theirs.nFaces * 3 * theirs.subdivision <= manySegments;
    const up = theirs.dimension === 3 ? upAxis({ ...theirs, nContactFaces: this.data.contact_faces }) : 2;
    this.camera = new Camera(theirs.dimension, { up });
    const view = { camera: this.camera, home: () => this.home(), changed: () => this.draw() };
    [theirs, ours, theirs].forEach((surface, i) => this.panes[i].start(surface, view));
    this.home();
    this.show();
    const { values, range } = this.panes[1];
    Object.assign(this.camera, firstDirection(theirs, values, range, up));
  }

  readCells() {
    const { distance, stress_distance, place } = this.data;
    return unpackAll({ distance, stress_distance: stress_distance ?? null, place });
  }

  /** Shows what is chosen in the controls. */
  show() {
    const field = this.fields.find(({ id }) => id === this.field.value);
    const cells = this.cellFields.find(({ id }) => id === this.cells.value);
    const factor = (Number(this.factor.value) / 25) * this.usual;
    const values = this.surfaces.map((surface) => field.corners(surface));
    const range = common(...this.surfaces.map((surface, i) => colourRange(surface, field, values[i])));
    const ofCells = cells.corners(this.surfaces[0]);
    const cellRange = isNamed(cells.kind) ? { low: 0, high: places.length - 1 } : colourRange(this.surfaces[0], cells, ofCells);
    values.forEach((ofPane, i) => this.panes[i].setField(field, ofPane, range));
    this.panes[1].range = range;
    this.panes[2].setField(cells, ofCells, cellRange);
    for (const pane of this.panes) {
      pane.setFactor(factor);
      pane.setMesh(this.mesh.checked);
    }
    this.legend.replaceChildren(fieldLegend(field, range, []));
    this.cellLegend.replaceChildren(fieldLegend(cells, cellRange, places));
    this.factorText.textContent = `\u00d7 ${number(factor, 3)}`;
    this.note.textContent = `${this.surfaces[0].dimension === 3 ? "Shown is the surface. " : ""}Both are drawn on their mesh of ${count(this.data.theirs.cells)} cells, `
      + `ours was computed on ${count(this.judgement.cells)}; displacements are drawn ${factor === 1 ? "at true scale" : `${number(factor, 3)} times as large`}.`;
    this.draw();
  }

  home() {
    const [{ dimension, box }] = this.surfaces;
    this.camera.reset(homeScale(box.size, dimension, this.panes[0].picture.place));
  }

  draw() {
    for (const { picture } of this.panes) picture.draw();
  }

  pictures() {
    return this.panes.map(({ picture }) => {
      picture.keep();
      return picture.print;
    });
  }

  /** The field at the points of the faces, theirs and ours. */
  rows() {
    const field = this.fields.find(({ id }) => id === this.field.value);
    const [theirs, ours] = this.surfaces.map((surface) => fieldRows(surface, surface, field));
    return theirs.map(({ [field.id]: value, ...row }, i) => ({ ...row, [`${field.id}, theirs`]: value, [`${field.id}, ours`]: ours[i][field.id] }));
  }
}

/** `words`: what stands beside the cells. `data`: null without a bound and of several processes. */
export function comparisonSection(data, judgement, words) {
  const none = async () => {};
  if (!judgement.displacement) return { element: null, start: none };
  if (!data) return { element: section("fields", "Fields", "Where theirs and ours differ", "Several processes have judged: the pictures are in judged.vtu.", words), start: none };
  const view = new Comparison(data, judgement);
  view.words.append(...words);
  return { element: section("fields", "Fields", "Theirs and ours", "With one colour scale, on their mesh.", view.element), start: () => view.start() };
}
