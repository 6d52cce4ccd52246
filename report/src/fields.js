// The interactive picture of the mesh and the fields on it.

import { unpackAll } from "./arrays.js";
import { showsMeridian } from "./axes.js";
import { Bodies } from "./bodies.js";
import { Camera } from "./camera.js";
import { statusColours, statusNames } from "./components.js";
import { withSegments } from "./contact_parts.js";
import { Cut } from "./cut.js";
import { contactDirection, firstDirection, upAxis } from "./directions.js";
import { element, number, section } from "./dom.js";
import { noteText, usualFactor, valueText } from "./field_words.js";
import { FieldControls } from "./field_controls.js";
import { obstacleCorners } from "./obstacle.js";
import { overlay } from "./overlay.js";
import { isForPaper } from "./paper.js";
import { frameAspect, homeScale, Picture, placeText } from "./picture.js";
import { valueAt } from "./pick.js";
import { shownAs, ways } from "./revolution.js";
import { colourRange, cornerPositions, fieldRows, fieldsOf, readSurface, vertexPositions } from "./surface.js";
import { colours, fieldLegend, onScale, shownStates } from "./scales.js";
import { hasWebGL } from "./scene.js";
import { stagesOf } from "./stages.js";

const paperWidth = 530; // CSS pixels of the picture on paper, next to its legend
const manySegments = 30000; // beyond this, the mesh is drawn only on request
const onPaper = ["u", "von_mises", "s1", "s3", "eta-tot"]; // a picture each

/** `way`: one of those in revolution.js to show the body; `show(way)`: changes it. */
class FieldView {
  constructor(data, components, way, show) {
    this.data = data;
    this.components = components;
    this.levels = data.fields;
    const is2d = this.levels.at(-1).dimension === 2 && way !== "body";
    this.state = { way, level: this.levels.length - 1, field: "von_mises", range: null, factor: null, mesh: null, obstacle: is2d, axis: null, place: 0.5, side: 1, explosion: 0 };
    this.stages = stagesOf(data.certificate);
    this.bodies = new Bodies(this.stages.all, () => this.set({ bodies: true }));
    this.build(is2d, show);
  }

  build(is2d, show) {
    this.picture = new Picture(is2d, "Mesh and fields", paperWidth);
    this.legend = element("div", { class: "view-legend" });
    this.note = element("p", { class: "note" });
    const last = this.levels.at(-1);
    const { way } = this.state; // bodies are drawn apart on the meridian only, and obstacles not around the body
    const seen = way === "meridian" ? last : { ...last, interfaces: undefined, ...(way === "body" ? { profiles: undefined } : {}) };
    this.controls = new FieldControls(seen, this.levels.length, this.stages, (changes) => this.set(changes), {
      home: () => { this.home(); this.picture.draw(); },
      svgs: () => { this.picture.keep(); return [this.picture.print]; },
      rows: () => (this.current.meridian ? fieldRows(this.current.meridian, this.current.meridian, this.field) : fieldRows(this.current, this.shown, this.field)),
    }, { names: showsMeridian() ? ways : [], show: (way) => show(way, this.state) });
    this.element = element("div", { class: "fields" }, this.controls.element,
      element("div", { class: "view-row" }, this.picture.frame, this.picture.print, this.legend), this.note,
      element("p", { class: "note screen-only" }, `Drag to ${is2d ? "move" : "turn, with Shift to move"}, scroll after a click (or with Ctrl) to `
        + "zoom, double-click for the whole body; keys: arrows, +, \u2212, 0. With fingers: tap first, then drag and pinch; tap elsewhere to scroll on."));
  }

  /** Draws the first picture with what was chosen before; afterwards the page is ready. */
  async start(chosen) {
    this.volume ??= await this.readVolume();
    await this.set(chosen);
  }

  /** Reads the interior of the body on the last level, relative to its centre. */
  async readVolume() {
    if (!this.data.volume) return null;
    const volume = await unpackAll(this.data.volume);
    const { box } = await this.surface(this.levels.length - 1);
    return { ...volume, box, dimension: 3, nVertices: volume.points.length / 3, vertexBody: volume.bodies };
  }

  async surface(index) {
    return shownAs(await readSurface(this.levels[index]), this.state.way);
  }

  /** Applies changes of the state and shows it. Of overlapping changes the last one counts. */
  async set(changes) {
    Object.assign(this.state, changes);
    const ticket = (this.ticket = (this.ticket ?? 0) + 1);
    const surface = await this.surface(this.state.level);
    if (ticket !== this.ticket) return;
    const isNew = surface !== this.current;
    this.current = surface;
    if (isNew) this.takeSurface(surface);
    const field = this.fields.find(({ id }) => id === this.state.field) ?? this.fields[0];
    const isOther = this.field?.id !== field.id;
    if (field.contact && !this.field?.contact && surface.pairs?.length > 0 && this.bodies.current) this.state.explosion ||= 0.5; // else nothing is seen of them
    const shown = field.contact ? withSegments(surface) : surface;
    if ("axis" in changes && changes.axis !== null) this.state.side = this.camera.axes().eye[changes.axis] < 0 ? -1 : 1; // towards the eye
    const isCut = shown !== this.shown || "axis" in changes || "place" in changes;
    this.shown = shown;
    if (isCut) this.takeCut();
    if (isOther && this.field) this.state.range = null;
    if (isCut || isOther || "range" in changes) this.takeField(field);
    if (isCut || ["factor", "obstacle", "explosion", "bodies"].some((key) => key in changes)) this.takePositions();
    if (isCut || "mesh" in changes || "bodies" in changes) this.takeLines();
    if (this.state.explosion !== this.apart && this.isHome()) this.home();
    this.apart = this.state.explosion;
    this.showState();
    this.picture.draw();
  }

  takeSurface(surface) {
    this.bodies.take(surface);
    if (!this.camera) this.prepare(surface);
    this.state.mesh ??= surface.nFaces * 3 * surface.subdivision <= manySegments;
    this.fields = fieldsOf(surface.meridian ?? surface, this.components);
    this.controls.setFields(this.fields);
  }

  /** Creates camera and scene for the first surface. */
  prepare(surface) {
    this.up = surface.dimension === 3 ? upAxis(surface) : 2;
    this.camera = new Camera(surface.dimension, { up: this.up });
    if (surface.dimension === 2) this.picture.frame.style.aspectRatio = frameAspect(surface.box.size);
    this.usual = usualFactor(surface);
    this.state.factor ??= this.usual;
    this.isSlow = !hasWebGL();
    this.picture.start({ camera: this.camera, home: () => this.home(), changed: () => this.picture.draw(),
      depth: () => 10 * this.current.box.diagonal * (1 + this.state.explosion),
      overlay: (place) => overlay(this.current, this.camera, place, { ...this.state, layout: this.layout() }),
      describe: (hit) => this.describe(hit) }, surface.dimension);
    this.home();
    this.picture.fit();
  }

  /** The volume belongs to the last level; on others a cut shows the inside of the surface. */
  takeCut() {
    const { axis, place, side, level } = this.state;
    const { box, vertex } = this.shown;
    this.inside = level === this.levels.length - 1 ? this.volume : null;
    this.cut = axis === null ? null
      : new Cut(this.shown, this.inside, { axis, side, level: box.low[axis] + place * box.size[axis] });
    this.nCorners = this.cut ? this.cut.nCorners : vertex.length;
    this.takeUndeformed();
  }

  /** Converts values at the corners of the surface, and at the vertices of the volume where known, to the drawn corners. */
  drawn(ofCorners, ofVolume, width) {
    return this.cut ? this.cut.spread(ofCorners, this.inside && ofVolume?.(this.inside), width) : ofCorners;
  }

  takeField(field) {
    const { current: surface, picture: { scene } } = this;
    const values = field.corners(surface.meridian ?? surface);
    const usual = colourRange(surface.meridian ?? surface, field, values);
    this.range = this.state.range ? { ...usual, ...this.state.range } : usual;
    if (!this.field) Object.assign(this.camera, firstDirection(surface, values, this.range, this.up));
    else if (field.contact && !this.field.contact) Object.assign(this.camera, contactDirection(surface, this.camera));
    this.field = field;
    this.values = this.drawn(values, field.inside, 1);
    const range = { low: onScale(field.kind, this.range.low, this.range), high: onScale(field.kind, this.range.high, this.range) };
    const scaled = field.kind === "logarithmic" ? this.values.map((value) => onScale(field.kind, value, this.range)) : this.values;
    scene.setTriangles(this.nCorners / 3, this.values.length / 3);
    scene.setValues(scaled, this.nCorners, range, colours(field.kind, this.range));
    this.legend.replaceChildren(fieldLegend(field, this.range, this.categories(field)));
    if (surface.profiles) this.legend.append(element("p", { class: "legend-title" }, "contact boundary"),
      element("ul", { class: "legend legend-column" }, shownStates(surface.profiles.flatMap(({ status }) => [...new Set(status)])).map((name, i) =>
        element("li", {}, element("span", { class: "swatch swatch-line", style: `--colour:${statusColours[i]}` }), name))));
    this.legend.append(this.bodies.element);
  }

  /** The names of the values of a field that are category numbers. */
  categories({ id }) {
    return id === "body" ? this.bodies.names : this.data.certificate.mesh.regions.map(({ name }) => name);
  }

  /** The displaced positions of bodies; undefined for a single one. */
  layout() {
    return this.current.vertexBody ? this.bodies.layout(this.state.explosion) : undefined;
  }

  positions(factor, layout) {
    const of = (surface) => vertexPositions(surface, factor, layout);
    return this.drawn(cornerPositions(this.shown, of(this.shown)), of, 3);
  }

  /** On a meridian the places that the pointer is told are those there. */
  takeUndeformed() {
    const { meridian } = this.shown;
    this.undeformed = meridian ? cornerPositions(meridian, vertexPositions(meridian, 0)) : this.positions(0);
  }

  takePositions() {
    const { factor, obstacle } = this.state;
    const layout = this.layout();
    this.picture.setPositions(this.positions(factor, layout), vertexPositions(this.current, factor, layout));
    if (this.current.dimension === 3)
      this.picture.scene.setObstacle(obstacle && this.current.nContactFaces > 0 ? obstacleCorners(this.current, factor, layout) : null);
  }

  takeLines() {
    const { vertexBody } = this.current;
    let all = this.state.mesh ? this.current.segments().all : null;
    const layout = this.layout();
    if (all && layout && this.bodies.anyHidden) all = all.filter((v, i) => layout[vertexBody[all[i & ~1]]]); // pairs of vertices of one body
    this.picture.scene.setLines(all && this.cut ? this.cut.segments(all) : all);
  }

  showState() {
    const { state, current: surface } = this;
    this.controls.show(state, { surface, lastLevel: this.levels.at(-1).level, field: this.field, range: this.range, usual: this.usual });
    this.note.textContent = noteText(surface, state, { isCut: this.cut !== null, isInside: this.inside !== null, isSlow: this.isSlow,
      stage: this.stages.name,
      nLeftOut: this.levels.at(-1).level + (this.stages.name === "level" ? 1 : 0) - this.levels.length });
    this.picture.place.setAttribute("aria-label", `${this.field.label} on ${this.stages.name} ${surface.level}, displacements times ${number(state.factor, 3)}`);
  }

  /** Shows the whole body, with room for its displacements. */
  home() {
    const { middle, size } = this.bodies.extent(this.current, this.state.explosion);
    const scale = homeScale(size, this.current.dimension, this.picture.place);
    this.camera.reset(scale);
    this.camera.target = middle;
    this.homeView = { scale, target: middle };
  }

  /** Whether the picture is as home() leaves it, except for rotation. */
  isHome() {
    return this.camera.scale === this.homeView.scale && this.camera.target === this.homeView.target;
  }

  /** A figure for each of the fields of paper; afterwards the picture is as before. */
  async printed() {
    const { field } = this.state;
    const figures = [];
    for (const { id, group, label } of onPaper.flatMap((name) => this.fields.find((other) => other.id === name) ?? [])) {
      await this.set({ field: id });
      this.picture.keep();
      figures.push(element("figure", { class: "print-only" }, element("div", { class: "view-row" }, this.picture.print.cloneNode(true), this.legend.cloneNode(true)),
        element("figcaption", {}, `${group}: ${label}, ${this.stages.name} ${this.stages.text(this.current.level)}. ${this.note.textContent}`)));
    }
    await this.set({ field });
    return figures;
  }

  /** What the pointer is told of a point. */
  describe(hit) {
    const { current: surface, field } = this;
    const value = hit.corner < this.values.length ? valueAt(this.values, hit) : null;
    const text = valueText(field, value, field.kind === "category" ? this.categories(field) : []);
    return [element("strong", {}, text), element("br"), placeText(surface.meridian ?? surface, this.undeformed, hit)];
  }
}

export function fieldsSection(data, components) {
  if (data.fields.length === 0) return { element: null, start: async () => {} };
  const views = new Map();
  const place = element("div");
  const show = async (way, { level, field, range, factor, mesh } = {}) => {
    if (!views.has(way)) views.set(way, new FieldView(data, components, way, show));
    place.replaceChildren(views.get(way).element);
    await views.get(way).start(level === undefined ? {} : { level, field, range, factor, mesh });
  };
  const start = async () => {
    await show("meridian");
    if (!isForPaper) return;
    place.after(...await views.get("meridian").printed());
    place.classList.add("screen-only");
  };
  return { element: section("fields", "Fields", "Mesh and fields", null, place), start };
}
