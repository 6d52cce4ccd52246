// Elements and numbers as text.

const namespaces = { svg: "http://www.w3.org/2000/svg", math: "http://www.w3.org/1998/Math/MathML" };

/** An element with attributes (on...: listeners) and children; strings become text, never markup. */
export function element(name, attributes = {}, ...children) {
  const [space, local] = name.includes(":") ? name.split(":") : ["", name];
  const result = space ? document.createElementNS(namespaces[space], local) : document.createElement(local);
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

/** `head`: column names, as text or children; those with a leading "#" contain numbers. */
export function table(head, rows, attributes = {}) {
  const heads = head.map((name) => [name].flat(Infinity));
  const isNumber = heads.map(([first]) => typeof first === "string" && first.startsWith("#"));
  const cell = (tag) => (content, i) =>
    element(tag, { class: isNumber[i] ? "number" : null, scope: tag === "th" ? "col" : null }, content ?? "");
  return element("div", { class: "table-scroll" }, element("table", attributes,
    element("thead", {}, element("tr", {}, heads.map(([first, ...rest]) => [first.replace("#", ""), ...rest]).map(cell("th")))),
    element("tbody", {}, rows.map((row) => element("tr", { class: row.class }, [...row].map(cell("td")))))));
}

const superscripts = { "-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075",
  6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079", ".": "\u00b7" };

export function superscript(number) {
  return [...String(number)].map((digit) => superscripts[digit]).join("");
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

/** The values with 0 in place of those that are round-off relative to the largest, or to `scale`. */
export function withoutNoise(values, scale = 0) {
  const limit = 1e-9 * values.reduce((largest, value) => Math.max(largest, Math.abs(value)), scale);
  return values.map((value) => (Math.abs(value) <= limit ? 0 : value));
}

/** The power of ten that axis values are divided by, and its text for the title: values from 0.001 to 100 000 stay unchanged. */
export function powerOfTen(values) {
  const largest = values.reduce((size, value) => Math.max(size, Math.abs(value)), 0);
  const exponent = largest === 0 || (largest >= 5e-3 && largest < 1e5) ? 0 : Math.floor(Math.log10(largest));
  return { factor: 10 ** exponent, unit: (name) => (exponent === 0 ? name : `10${superscript(exponent)} ${name}`) };
}

/** A number with the given number of decimals. */
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
  if (value < 5e-5) return "< 0.1 ms";
  if (value < 0.1) return `${number(1000 * value, 3)} ms`;
  return value < 100 ? `${number(value, 3)} s` : `${Math.floor(value / 60)} min ${Math.round(value % 60)} s`;
}
