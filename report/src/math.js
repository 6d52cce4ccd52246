// Formulas: those in the texts of the program, which are plain ASCII, and those of the bound, as MathML.

import { element } from "./dom.js";

const row = (...children) => element("math:mrow", {}, ...children);
const i = (name, upright = false) => element("math:mi", upright ? { mathvariant: "normal" } : {}, name);
const o = (sign, attributes = {}) => element("math:mo", attributes, sign);
const n = (value) => element("math:mn", {}, String(value));
const sub = (base, index) => element("math:msub", {}, base, index);
const sup = (base, exponent) => element("math:msup", {}, base, exponent);
const bracket = (open, inner, close) => row(o(open, { fence: "true", stretchy: "false" }), ...inner, o(close, { fence: "true", stretchy: "false" }));
const norm = (...inner) => bracket("\u2016", inner, "\u2016");
const sigma = () => i("\u03c3");
const residual = () => bracket("\u27e8", [i("R"), bracket("(", [sub(i("u"), i("h"))], ")"), o(","), i("v")], "\u27e9");
const gradientNorm = () => sup(norm(i("\u2207", true), i("v")), n(2));
const hoopNorm = () => sup(norm(sub(i("v"), i("r")), o("/"), i("r")), n(2));
const facetNorm = () => element("math:msubsup", {}, norm(i("v")), i("F"), n(2));
const sumOver = (index) => sub(o("\u2211", { movablelimits: "false" }), i(index));

/** The fragments of the texts, the longest first, and their markup. */
const fragments = [
  ["||grad v||^2", () => [gradientNorm()]],
  ["||v_r / r||^2", () => [hoopNorm()]],
  ["||v||_F^2 / h_F", () => [facetNorm(), o("/"), sub(i("h"), i("F"))]],
  ["||sigma(u_h)||", () => [norm(sigma(), bracket("(", [sub(i("u"), i("h"))], ")"))]],
  ["||sigma_h||", () => [norm(sub(sigma(), i("h")))]],
  ["||sigma||", () => [norm(sigma())]],
  ["<R(u_h), v>", () => [residual()]],
  ["sigma(u_h)", () => [sigma(), bracket("(", [sub(i("u"), i("h"))], ")")]],
  ["sum_F", () => [sumOver("F")]],
  ["sigma_h", () => [sub(sigma(), i("h"))]],
  ["gamma_0", () => [sub(i("\u03b3"), n(0))]],
  ["mu_F", () => [sub(i("\u03bc"), i("F"))]],
  ["u_h", () => [sub(i("u"), i("h"))]],
  ["h_F", () => [sub(i("h"), i("F"))]],
  ["H^1", () => [sup(i("H"), n(1))]],
];
const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
const pattern = new RegExp(`(${fragments.map(([text]) => escaped(text)).join("|")})(?![\\w])`);

/** A text of the program as children of an element, with its formulas typeset; in alternative text they stay plain. */
export function typeset(text) {
  const setting = Object.fromEntries(fragments);
  return text.split(pattern).filter(Boolean).map((part) => (setting[part] ? element("math:math", { alttext: part }, ...setting[part]()) : part));
}

const eta = (name) => sub(i("\u03b7"), element("math:mtext", {}, name));
const total = () => sub(i("\u03b7"), element("math:mtext", {}, "tot"));
const squared = (names) => sup(bracket("(", names.flatMap((name, k) => (k === 0 ? [eta(name)] : [o("+"), eta(name)])), ")"), n(2));
const display = (...children) => element("math:math", { display: "block" }, ...children);

/** The bound from its components: sums over the cells T, except for those of the whole body, which are shown unless they are round-off. */
export function boundFormula(components, values) {
  // For stress and transfer the norm of the sum counts.
  const isPaired = components.some(({ name }) => name === "mor");
  const namesOf = (part) => components.filter((component) => component.part === part && component.name !== "mor")
    .map(({ name }) => (isPaired && name === "str" ? "str+mor" : name));
  const sum = ["body", "normal", "tangential"].flatMap((part, k) => (k === 0 ? [squared(namesOf(part))] : [o("+"), squared(namesOf(part))]));
  const cells = [sumOver("T"), bracket("[", sum, "]")];
  const visible = 1e-9 * Math.max(...Object.values(values));
  const whole = namesOf("whole").filter((name) => values[name] > visible);
  if (whole.length === 0) return display(sup(total(), n(2)), o("="), ...cells);
  return display(total(), o("="), element("math:msqrt", {}, ...cells), ...whole.flatMap((name) => [o("+"), eta(name)]));
}

/** The interval of the error of v from its distance d to u_h, whose bound is B. */
export function judgementFormula() {
  const error = norm(i("u"), o("\u2212"), i("v"));
  return display(i("d"), o("\u2212"), i("B"), o("\u2264"), error, o("\u2264"), i("d"), o("+"), i("B"), o(",", { separator: "true" }), element("math:mspace", { width: "1em" }),
    i("d"), o("="), norm(i("v"), o("\u2212"), sub(i("u"), i("h"))));
}

/** The formula of the guarantee; `isMeridian`: with the hoop strain of a body of revolution. */
export function guaranteeFormula(isMeridian) {
  const v = row(i("v"), o("\u2208"), sup(i("H"), n(1)));
  const root = element("math:msqrt", {}, gradientNorm(), ...(isMeridian ? [o("+"), hoopNorm()] : []), o("+"), sumOver("F"), facetNorm(), o("/"), sub(i("h"), i("F")));
  return display(element("math:munder", {}, o("max", { movablelimits: "false" }), v),
    element("math:mfrac", {}, residual(), root), o("\u2264"), total());
}
