// The results of a study, in words.

import { count, element, fixed, number, percent, plural, seconds } from "./dom.js";
import { definitions } from "./facts.js";
import { extent, total, variantsOf } from "./variants.js";
import { figure, kindOf, pageHeader } from "./verdict.js";

// The fraction of the best rate that counts as reaching it.
const enough = 0.9;

const allLevels = (study) => variantsOf(study).flatMap(({ key, levels }) => levels.map((level) => ({ ...level, key })));

/** The overall result of the study. */
function outcome(study) {
  const adaptive = variantsOf(study).filter(({ key }) => key.startsWith("adaptive"));
  const good = { tone: "certified", mark: "\u2713" };
  const warning = { tone: "budget", mark: "!" };
  const bad = { tone: "failed", mark: "\u00d7" };
  if (study.guarantee === "violated") return { ...bad, title: "The guarantee is violated" };
  if (variantsOf(study).some(({ status }) => status === "failed" || status === "not certified"))
    return { ...bad, title: "Not every variant has a certified solution" };
  if (study.interrupted) return { ...warning, title: "Interrupted" };
  if (!extent(allLevels(study), "effectivity")) return { ...warning, title: "No dual norm is known: the bound is not compared with it" };
  if (adaptive.some(({ status }) => status !== "certified")) return { ...warning, title: "The bound holds; the tolerance is not reached" };
  return { ...good, title: "The bound holds" };
}

function boundText(study) {
  const levels = allLevels(study);
  const below = levels.find(({ effectivity }) => effectivity !== null && effectivity < 1);
  if (below) return `On level ${below.level} of the variant ${below.key} the bound is below the dual norm of the residual, ${number(below.effectivity, 6)} times as large.`;
  const range = extent(levels, "effectivity");
  if (!range) return "The dual norm of the residual, which the bound bounds, is not known on any level.";
  const known = levels.filter(({ effectivity }) => effectivity !== null).length;
  const which = known === levels.length ? `all ${known} levels` : `all ${known} levels with a known dual norm, of ${levels.length},`;
  return `On ${which} the bound is above the dual norm of the residual: ${fixed(range[0])} to ${fixed(range[1])} times as large.`;
}

function rateText(study, key) {
  const { rates } = study.variants[key] ?? {};
  if (!rates || rates.bound === null) return null;
  const best = study.p / study.d;
  const slopes = [["bound", rates.bound], ["error", rates.error]].filter(([, rate]) => rate !== null);
  const comesOut = slopes.every(([, rate]) => rate <= -enough * best);
  return `${key} meshes: ${slopes.map(([name, rate]) => `${name} ${fixed(rate)}`).join(", ")} `
    + `(${comesOut ? "the best rate" : "below the best rate"})`;
}

function ratesText(study) {
  const rates = ["adaptive", "uniform"].map((key) => rateText(study, key)).filter(Boolean);
  if (rates.length === 0) return "There are too few levels for a rate.";
  const text = `${rates.join("; ")}. `;
  return `${text[0].toUpperCase()}${text.slice(1)}The best slope of degree ${study.p} in ${study.d}D is \u2212${number(study.p / study.d, 2)}.`;
}

/** Newton steps with and without the criterion, on the levels common to both runs. */
function savedSteps(study, key) {
  const rows = study.newton_table.map((row) => [row[key], row[`${key}_converged`]]).filter((pair) => !pair.includes(null));
  const sum = (i) => rows.reduce((steps, pair) => steps + pair[i], 0);
  return rows.length > 0 ? { early: sum(0), converged: sum(1) } : null;
}

function criterionText(study) {
  const parts = ["adaptive", "uniform"].flatMap((key) => {
    const steps = savedSteps(study, key);
    if (!steps) return [];
    const changes = (study.difference[key] ?? []).filter((value) => value !== null).map(Math.abs);
    const change = changes.length > 0 ? `, the energy error changes by at most ${percent(Math.max(...changes), 2)}` : "";
    return [`${key} meshes: ${steps.early} Newton steps instead of ${steps.converged}${change}`];
  });
  if (parts.length === 0) return "Not known: no pair of variants is complete.";
  const text = `${parts.join("; ")}.`;
  return text[0].toUpperCase() + text.slice(1);
}

function referenceText({ reference }) {
  if (!reference) return "There is none: the errors are not known.";
  const text = `Degree ${reference.degree}, ${count(reference.dofs)} degrees of freedom; its own bound is ${percent(reference.relative)} of the norm of the stress`;
  return reference.fine_enough ? `${text}.`
    : `${text}, where at most ${percent(reference.required)} was asked for: errors near it are not reliable.`;
}

function figures(study) {
  const levels = allLevels(study);
  const { adaptive, uniform } = Object.fromEntries(variantsOf(study).map((variant) => [variant.key, variant]));
  const last = adaptive?.levels.at(-1);
  const effectivity = extent(levels, "effectivity");
  const steps = savedSteps(study, "adaptive");
  return element("div", { class: "figures" },
    last ? figure(percent(last.relative), "bound, adaptive", `last level, ${count(last.dofs)} dofs`) : null,
    last?.relative_error ? figure(percent(last.relative_error), "error, adaptive", "same level, energy norm") : null,
    effectivity ? figure(fixed(effectivity[1]), "largest effectivity", `smallest ${fixed(effectivity[0])}`) : null,
    adaptive?.rates.bound ? figure(fixed(adaptive.rates.bound), "slope, adaptive",
      uniform?.rates.bound ? `of the bound; uniform ${fixed(uniform.rates.bound)}` : null) : null,
    steps ? figure(`${steps.early} of ${steps.converged}`, "Newton steps", "adaptive, with the criterion") : null,
    figure(seconds(study.times.total ?? total(levels, "t_level")), "wall time", plural(levels.length, "level", "levels")));
}

export function studyHeader(study, machine) {
  const { tone, mark, title } = outcome(study);
  const body = definitions([["Stopped", study.interrupted], ["Bound", boundText(study)], ["Rates", ratesText(study)],
    ["Stopping criterion", criterionText(study)], ["Reference", referenceText(study)]]);
  return pageHeader({ program: study.program, machine, title: study.title, purpose: study.purpose, file: study.file,
    kind: `study, ${kindOf(study)}, marking: ${study.marking}, theta = ${number(study.theta)}`, verdict: { tone, mark, title, body },
    figures: figures(study) });
}
