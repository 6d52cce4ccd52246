// Factors of safety, with what they are.

import { element, number, section, table } from "./dom.js";
import { definitions } from "./facts.js";
import { typeset } from "./math.js";

/** Of a hydraulic structure: key, name, and definition. */
const ofBases = [
  ["sliding_safety", "sliding, friction alone", "mu_F max(\u2212N\u2032, 0) / |V|, with the force N\u2032 across the base without the uplift of the water, negative in compression, and the force V along it"],
  ["sff_intact", "sliding, strength of the intact base", "(C + mu_F max(\u2212N\u2032, 0)) / |V|, with the strength C of the whole base before any damage: the shear friction factor"],
  ["sff_now", "sliding, strength left", "the same with the strength that the damage so far has left"],
  ["overturning", "overturning", "the stabilising over the overturning moments of all loads and of the uplift about the toe"],
];

const ofSliding = [
  ["mobilised friction", "H / N, with the resultants N of the contact pressure and H of the friction; at the coefficient of friction all slips"],
  ["safety against sliding", "mu_F N / H; at 1 the whole boundary slides, parts of it may slip long before"],
];

const atPeak = ["load factor at the peak", "the largest t that the structure bears, in the unit that the loads of the case give to t"];

const definitionList = (pairs) => definitions(pairs.map(([name, text]) => [name, typeset(text)]));

function slidingTable({ contact, bound }) {
  const parts = Object.entries(contact?.boundaries ?? {}).filter(([, { sliding }]) => sliding);
  if (parts.length === 0 || bound === null) return null;
  return [table(["boundary", "#coefficient of friction", "#mobilised friction", "#safety against sliding"], parts.map(([name, { sliding }]) =>
    [name, number(sliding.coefficient), number(sliding.sliding_factor), number(sliding.safety_factor)])), definitionList(ofSliding)];
}

/** The factors of an interface at the last step, and the smallest of all steps with their t. */
function baseRows(steps, name) {
  return ofBases.flatMap(([key, title]) => {
    const known = steps.map(({ t, interfaces }) => ({ t, value: interfaces[name][key] })).filter(({ value }) => typeof value === "number");
    if (known.length === 0) return [];
    const least = known.reduce((best, other) => (other.value < best.value ? other : best));
    return [[name, title, number(steps.at(-1).interfaces[name][key]), number(least.value), number(least.t, 6)]];
  });
}

function baseTable({ steps }) {
  const rows = Object.keys(steps?.at(-1)?.interfaces ?? {}).flatMap((name) => baseRows(steps, name));
  if (rows.length === 0) return null;
  return [table(["boundary", "safety against", "#last step", "#smallest", "#at t"], rows),
    definitionList(ofBases.filter(([, title]) => rows.some((row) => row[1] === title)).map(([, title, text]) => [title, text]))];
}

function peakTable({ path }) {
  if (!path?.peak) return null;
  return [table(["", "#t", "#step"], [[atPeak[0], number(path.peak.t, 6), String(path.peak.step)]]), definitionList([atPeak])];
}

/** `run`: the certificate. */
export function safetySection(run) {
  const parts = [slidingTable(run), baseTable(run), peakTable(run)].filter(Boolean);
  if (parts.length === 0) return null;
  return section("safety", "Safety", "Factors of safety",
    "They follow from the forces in equilibrium, not from stresses at points. The bound of the error does not cover them; a [[quantity]] of the case gives them error bars.",
    parts.map((part) => element("div", { class: "safety" }, part)));
}
