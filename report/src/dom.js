// Elements and numbers as text.

/** An element with attributes (on...: listeners) and children; strings become text, never markup. */
export function element(name, attributes = {}, ...children) {
  const result = name.startsWith("svg:")
    ? document.createElementNS("http://www.w3.org/2000/svg", name.slice(4))
    : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) result.addEventListener(key.slice(2), value);
    else result.setAttribute(key, value === true ? "" : value);
  }
  result.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return result;
}

/** A section of the page; `short` is its name in the navigation. */
export function section(id, short, title, lead, ...content) {
  return element("section", { id, "aria-labelledby": `${id}-title`, "data-short": short },
    element("h2", { id: `${id}-title` }, title), lead ? element("p", { class: "lead" }, lead) : null, content);
}

/** `head`: names of the columns, those with a leading "#" hold numbers. */
export function table(head, rows, attributes = {}) {
  const isNumber = head.map((name) => name.startsWith("#"));
  const cell = (tag) => (content, i) =>
    element(tag, { class: isNumber[i] ? "number" : null, scope: tag === "th" ? "col" : null }, content ?? "");
  return element("div", { class: "table-scroll" }, element("table", attributes,
    element("thead", {}, element("tr", {}, head.map((name) => name.replace("#", "")).map(cell("th")))),
    element("tbody", {}, rows.map((row) => element("tr", { class: row.class }, [...row].map(cell("td")))))));
}

const superscripts = { "-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075",
  6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079" };

export function superscript(integer) {
  return [...String(integer)].map((digit) => superscripts[digit]).join("");
}

/** A number with the given significant digits: 0.01234, 1.234×10⁻⁵. */
export function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const plain = size >= 1e-3 && size < 1e5;
  const text = plain ? String(Number(value.toPrecision(digits))) : value.toExponential(digits - 1);
  const [mantissa, exponent] = text.split("e");
  const factor = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  const signed = factor.replace("-", "\u2212");
  if (exponent === undefined) return signed;
  const power = `10${superscript(Number(exponent))}`;
  return signed === "1" ? power : `${signed}\u00d7${power}`;
}

/** A number with the given digits behind the point. */
export function fixed(value, digits = 2) {
  return value === null || value === undefined || Number.isNaN(value) ? "\u2013" : value.toFixed(digits).replace("-", "\u2212");
}

/** Ticks of a logarithmic axis: 1, 2, 5 times powers of ten, or the powers alone where those would be too many. */
export function logTicks(low, high, limit = 7) {
  const decades = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) decades.push(e);
  const inside = (digits) => decades.flatMap((e) => digits.map((digit) => digit * 10 ** e))
    .filter((value) => value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9));
  const ticks = [[1, 2, 3, 4, 5, 6, 8], [1, 2, 5], [1]].map(inside).find(({ length }) => length <= limit) ?? inside([1]);
  const stride = Math.ceil(ticks.length / limit);
  return ticks.filter((_, i) => i % stride === 0);
}

/** 12 345 */
export function count(value) {
  return String(value).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}

export function plural(value, one, many) {
  return `${count(value)} ${value === 1 ? one : many}`;
}

export function percent(value, digits = 3) {
  return value === null || value === undefined ? "\u2013" : `${number(100 * value, digits)}\u00a0%`;
}

export function seconds(value) {
  if (value === null || value === undefined) return "\u2013";
  if (value < 0.1) return `${number(1000 * value, 3)} ms`;
  return value < 100 ? `${number(value, 3)} s` : `${Math.floor(value / 60)} min ${Math.round(value % 60)} s`;
}
