// The controls of the picture of the fields.

import { count, element, number } from "./dom.js";
import { exportButtons } from "./export.js";

const control = (label, ...inputs) => element("label", { class: "control" }, element("span", {}, label), ...inputs);

/** `stages`: stagesOf(); `set(changes)` of the state; `view`: the actions home, svgs, rows; `ways`: of showing the body, see FieldView. */
export class FieldControls {
  constructor(last, nLevels, stages, set, view, ways) {
    this.stages = stages;
    const button = (title, name, onclick) => element("button", { type: "button", title, onclick }, name);
    const check = (id) => element("input", { id, type: "checkbox", onchange: (event) => set({ [id]: event.target.checked }) });
    const slider = (id, max, value) => element("input", { id, type: "range", min: 0, max, step: 1, oninput: (event) => set(value(Number(event.target.value))) });
    this.field = element("select", { id: "field", onchange: () => set({ field: this.field.value }) });
    this.low = element("input", { id: "range-low", type: "number", step: "any", "aria-label": "lower end of the colours", onchange: () => set({ range: this.typedRange() }) });
    this.high = element("input", { id: "range-high", type: "number", step: "any", "aria-label": "upper end of the colours", onchange: () => set({ range: this.typedRange() }) });
    this.level = slider("level", nLevels - 1, (level) => ({ level }));
    this.levelText = element("output", { for: "level" });
    this.factor = slider("factor", 100, (value) => ({ factor: (value / 25) * this.usual }));
    this.factorText = element("output", { for: "factor" });
    this.explosion = slider("explosion", 100, (value) => ({ explosion: value / 100 }));
    this.mesh = check("mesh");
    this.obstacle = check("obstacle");
    this.axis = element("select", { id: "cut-axis", onchange: () => set({ axis: this.axis.value === "" ? null : Number(this.axis.value) }) },
      ["no plane", "x", "y", "z"].map((name, i) => element("option", { value: i === 0 ? "" : i - 1 }, name)));
    this.place = slider("cut-place", 100, (value) => ({ place: value / 100 }));
    const hasContact = last.profiles?.some(({ paired }) => !paired) || last.contact;
    this.range = element("span", { class: "control" }, element("span", {}, "Colours from"), this.low, element("span", {}, "to"), this.high,
      button(`colours from the values of this ${stages.name}`, "Auto", () => set({ range: null })));
    this.way = element("select", { id: "way", onchange: () => ways.show(this.way.value) }, ways.names.map(([id, name]) => element("option", { value: id }, name)));
    this.element = element("div", { class: "controls screen-only" }, control("Field", this.field), this.range,
      ways.names.length > 1 ? control("Show", this.way) : null,
      nLevels > 1 ? control(stages.name === "level" ? "Level" : "Step", this.level, this.levelText) : null, control("Deformation", this.factor, this.factorText),
      button("displacements at true scale", "1 : 1", () => set({ factor: 1 })),
      last.interfaces?.length > 0 ? control("Apart", this.explosion) : null,
      element("label", { class: "control" }, this.mesh, element("span", {}, "Mesh")),
      hasContact ? element("label", { class: "control" }, this.obstacle, element("span", {}, "Obstacle")) : null,
      last.dimension === 3 ? [control("Cut", this.axis), this.place] : null,
      button("the whole body", "Reset view", view.home), exportButtons("fields", view.svgs, view.rows));
  }

  /** Both ends; null unless they are numbers in ascending order. */
  typedRange() {
    const [low, high] = [this.low, this.high].map(({ value }) => (value === "" ? NaN : Number(value)));
    return low < high ? { low, high } : null;
  }

  setFields(fields) {
    const groups = [...new Set(fields.map(({ group }) => group))];
    this.field.replaceChildren(...groups.map((group) => element("optgroup", { label: group },
      fields.filter((field) => field.group === group).map(({ id, label }) => element("option", { value: id }, label)))));
  }

  show(state, { surface, lastLevel, field, range, usual }) {
    this.usual = usual;
    this.way.value = state.way;
    this.field.value = field.id;
    this.level.value = state.level;
    this.levelText.textContent = `${this.stages.text(surface.level)} of ${lastLevel}, ${count(surface.cells)} cells`;
    this.factor.value = (25 * state.factor) / usual;
    this.factorText.textContent = `\u00d7 ${number(state.factor, 3)}`;
    this.explosion.value = 100 * state.explosion;
    this.mesh.checked = state.mesh;
    this.obstacle.checked = state.obstacle;
    this.axis.value = state.axis ?? "";
    this.place.value = 100 * state.place;
    this.place.hidden = state.axis === null;
    this.range.hidden = field.kind === "status" || field.kind === "category";
    [this.low.value, this.high.value] = [range.low, range.high].map((value) => Number(value.toPrecision(4)));
  }
}
