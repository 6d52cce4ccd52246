// What came out of a run, in one sentence and a few figures.

import { count, element, number, percent, plural, seconds } from "./dom.js";
import { boundUnit } from "./components.js";

const verdicts = {
  certified: { title: "Certified", mark: "\u2713" },
  budget: { title: "Budget used up", mark: "!" },
  "not certified": { title: "Not certified", mark: "\u00d7" },
  failed: { title: "Failed", mark: "\u00d7" },
};

function sentence({ status, relative, tolerance, reason }) {
  const guaranteed = `The error, measured by the dual norm of the residual, is guaranteed to be at most ${percent(relative)} of the norm of the stress`;
  switch (status) {
    case "certified":
      return `${guaranteed}; ${percent(tolerance)} was asked for.`;
    case "budget":
      return `${guaranteed}; ${percent(tolerance)} was asked for. ${reason[0].toUpperCase()}${reason.slice(1)}.`;
    case "not certified":
      return `A solution was computed, but nothing is guaranteed of its error: ${reason}.`;
    default:
      return `There is no solution: ${reason ?? "unknown reason"}.`;
  }
}

export function figure(value, name, note) {
  return element("div", { class: "figure" }, element("div", { class: "figure-value" }, value),
    element("div", { class: "figure-name" }, name), note ? element("div", { class: "figure-note" }, note) : null);
}

function figures(run) {
  if (run.cells === undefined) return null;
  const last = run.levels.at(-1);
  const steps = run.levels.reduce((sum, level) => sum + level.newton.length, 0);
  const time = Object.values(run.times).reduce((a, b) => a + b, 0);
  const isSolved = run.status !== "failed";
  return element("div", { class: "figures" },
    run.bound === null ? null
      : figure(percent(run.relative), "bound of the error", `${number(run.bound)} ${boundUnit(run.d)}`),
    figure(count(run.dofs), "degrees of freedom", `${plural(run.cells, "cell", "cells")}, degree ${run.p}`),
    figure(String(run.levels.length), run.levels.length === 1 ? "level" : "levels",
      plural(steps, "Newton step", "Newton steps")),
    isSolved && figure(number(run.max_displacement), "largest displacement", "L"),
    isSolved && run.contact !== null && figure(number(-run.contact.normal), "contact force, normal", run.d === 2 ? "S L" : "S L\u00b2"),
    figure(seconds(time), "wall time", `last level ${seconds(last.times.level)}`));
}

/** What both kinds of page begin with; `verdict`: its title, mark, tone and body. */
export function pageHeader({ program, machine, title, file, kind, verdict, figures: shown }) {
  return element("header", {},
    element("p", { class: "brand" }, "Tribound", element("span", {}, ` ${program.version} \u00b7 ${machine.written}`)),
    element("h1", {}, title || file),
    element("p", { class: "subtitle" }, `${file} \u00b7 ${kind}`),
    element("div", { class: `verdict verdict-${verdict.tone}`, role: "status" },
      element("span", { class: "verdict-mark", "aria-hidden": "true" }, verdict.mark),
      element("div", {}, element("strong", {}, verdict.title), verdict.body)),
    shown);
}

/** "2D, degree 1, friction: tresca" */
export function kindOf({ d, p, friction }) {
  return `${d}D, degree ${p}${friction ? `, friction: ${friction}` : ", no contact"}`;
}

export function header({ certificate: run, machine }) {
  const { title, mark } = verdicts[run.status] ?? { title: run.status, mark: "?" };
  return pageHeader({ program: run.program, machine, title: run.title, file: run.file, kind: kindOf(run),
    verdict: { title, mark, tone: run.status.replace(" ", "-"), body: element("p", {}, sentence(run)) }, figures: figures(run) });
}
