// The result of a run, in one sentence and a few figures.

import { showsMeridian } from "./axes.js";
import { count, element, number, percent, plural } from "./dom.js";
import { typeset } from "./math.js";
import { intervalText } from "./quantities.js";
import { measured, unit } from "./units.js";

const verdicts = {
  certified: { title: "Certified", mark: "\u2713" },
  budget: { title: "Budget used up", mark: "!" },
  "not certified": { title: "Not certified", mark: "\u00d7" },
  failed: { title: "Failed", mark: "\u00d7" },
};

const isSolved = ({ status }) => status === "certified" || status === "budget";

/** The largest bound of all load steps, relative to the stress of the path up to it. */
const worstStep = (steps) => Math.max(...steps.map((step) => step.relative_path ?? 0));

function pathSentence({ status, steps, tolerance, reason }) {
  const guaranteed = `In every load step the error, measured by the dual norm of the residual, is guaranteed to be at most ${percent(worstStep(steps))} `
    + "of the largest norm of the stress up to it";
  return `${guaranteed}; ${percent(tolerance)} was asked for.${status === "certified" ? "" : ` ${reason[0].toUpperCase()}${reason.slice(1)}.`}`;
}

function sentence(run) {
  const { status, relative, bound, tolerance, reason } = run;
  if (run.steps && isSolved(run)) return pathSentence(run);
  const share = relative === null ? `${measured(number(bound), unit("stress_norm"))} of a stress that is zero` : `${percent(relative)} of the norm of the stress`;
  const guaranteed = `The error, measured by the dual norm of the residual, is guaranteed to be at most ${share}`;
  switch (status) {
    case "certified":
      return relative === null ? "The stress is zero up to rounding, and so is the bound of its error." : `${guaranteed}; ${percent(tolerance)} was asked for.`;
    case "budget":
      return `${guaranteed}; ${percent(tolerance)} was asked for. ${reason[0].toUpperCase()}${reason.slice(1)}.`;
    case "not certified":
      return `A solution was computed, but nothing is guaranteed of its error: ${reason}.`;
    default:
      return `No solution was found: ${reason ?? "unknown reason"}.`;
  }
}

/** A warning of the program, with its place. */
function warningItem({ where, text }) {
  return element("li", {}, where ? element("strong", {}, `${where}: `) : null, typeset(text));
}

/** What to check before using the result; next to the verdict, on paper too. */
export function warningBox({ warnings }) {
  if (!warnings || warnings.length === 0) return null;
  return element("div", { class: "verdict verdict-budget warnings", role: "status" },
    element("span", { class: "verdict-mark", "aria-hidden": "true" }, "!"),
    element("div", {}, element("strong", {}, plural(warnings.length, "warning", "warnings")),
      element("ul", {}, warnings.map(warningItem))));
}

export function figure(value, name, note) {
  return element("div", { class: "figure" }, element("div", { class: "figure-value" }, value),
    element("div", { class: "figure-name" }, name), note ? element("div", { class: "figure-note" }, typeset(note)) : null);
}

/** The quantities of the case, with their error bars. */
function quantityFigures({ quantities }) {
  return (quantities ?? []).slice(0, 4).map((quantity) => figure(number(quantity.value, 5), quantity.name, intervalText(quantity)));
}

/** The smallest factor of safety against sliding in the certificate. */
function safetyFigure(run) {
  const parts = Object.entries(run.contact?.boundaries ?? {}).filter(([, { sliding }]) => sliding?.safety_factor > 0);
  if (parts.length === 0) return null;
  const [name, { sliding }] = parts.reduce((least, part) => (part[1].sliding.safety_factor < least[1].sliding.safety_factor ? part : least));
  return figure(number(sliding.safety_factor, 4), "safety against sliding", name);
}

function placeText(place) {
  return `at (${place.map((x) => number(x, 4)).join(", ")})`;
}

/** What the error in the energy norm is measured from. */
const targets = { solution: "from the exact solution", tresca_with_computed_threshold: "for the computed friction threshold" };

/** `contact`: the summary of contact.js, null where the page has no picture of the contact boundary. */
function figures(run, contact) {
  if (run.cells === undefined) return null;
  return [
    run.steps ? figure(percent(worstStep(run.steps)), "bound of the error", `largest of ${plural(run.steps.length, "load step", "load steps")}`)
      : run.relative === null ? null : figure(percent(run.relative), "bound of the error", measured(number(run.bound), unit("stress_norm"))),
    run.energy_error?.relative > 0 ? figure(percent(run.energy_error.relative), "error in the energy norm, at most", targets[run.energy_error.guaranteed_for]) : null,
    ...(isSolved(run) ? [
      ...quantityFigures(run),
      safetyFigure(run),
      contact?.largest > 0 ? figure(number(contact.largest), "largest contact pressure", [unit("stress"), placeText(contact.place)].filter(Boolean).join(", ")) : null,
      contact ? figure(percent(contact.open / contact.size), run.d === 2 && !showsMeridian() ? "length that is open" : "area that is open",
        measured(`${number(contact.open, 3)} of ${number(contact.size, 3)}`, unit("boundary"))) : null,
      run.contact ? figure(number(-run.contact.normal), "contact force, normal", unit("force")) : null,
      figure(number(run.max_displacement), "largest displacement", unit("length"))] : []),
    figure(count(run.cells), run.cells === 1 ? "cell" : "cells", `${plural(run.levels.length, "mesh", "meshes")}, degree ${run.p}`),
  ].filter(Boolean);
}

/** The common header of both kinds of page; `verdict`: its title, mark, tone and body. */
export function pageHeader({ program, machine, title, purpose, file, kind, verdict, warnings, figures: shown }) {
  return element("header", {},
    element("p", { class: "brand" }, "Tribound", element("span", {}, ` ${program.version} \u00b7 ${machine.written}`)),
    element("h1", {}, title || file),
    element("p", { class: "subtitle" }, `${file} \u00b7 ${kind}`),
    purpose ? element("p", { class: "purpose" }, purpose) : null,
    element("div", { class: `verdict verdict-${verdict.tone}`, role: "status" },
      element("span", { class: "verdict-mark", "aria-hidden": "true" }, verdict.mark),
      element("div", {}, element("strong", {}, verdict.title), verdict.body)),
    warnings, shown);
}

/** "2D, degree 1, friction: tresca" */
export function kindOf({ d, p, friction, model }) {
  return `${model ?? `${d}D`}, degree ${p}${friction ? `, friction: ${friction}` : ", no contact"}`;
}

/** `showContact(summary)` adds what is known once the data are unpacked. */
export function header({ certificate: run, machine }) {
  const { title, mark } = verdicts[run.status] ?? { title: run.status, mark: "?" };
  const shown = figures(run, null);
  const place = shown && element("div", { class: "figures" }, shown);
  return {
    element: pageHeader({ program: run.program, machine, title: run.title, purpose: run.purpose, file: run.file, kind: kindOf(run),
      verdict: { title, mark, tone: run.status.replace(" ", "-"), body: element("p", {}, typeset(sentence(run))) },
      warnings: warningBox(run), figures: place }),
    showContact: (summary) => place?.replaceChildren(...figures(run, summary)),
  };
}
