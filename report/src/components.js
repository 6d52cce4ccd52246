// The components of the bound: names, meanings, colours (after Okabe and Ito, told apart by colour-blind people too).

export const components = [
  { name: "str", symbol: "\u03b7 str", meaning: "stress, discretisation", colour: "#0072b2" },
  { name: "osc", symbol: "\u03b7 osc", meaning: "body force, oscillation", colour: "#56b4e9" },
  { name: "neu", symbol: "\u03b7 neu", meaning: "tractions, oscillation", colour: "#009e73" },
  { name: "cnt", symbol: "\u03b7 cnt", meaning: "contact condition", colour: "#d55e00" },
  { name: "frc", symbol: "\u03b7 frc", meaning: "friction law", colour: "#e69f00" },
  { name: "lin1", symbol: "\u03b7 lin1", meaning: "linearisation, in the body", colour: "#cc79a7" },
  { name: "lin2n", symbol: "\u03b7 lin2n", meaning: "linearisation, normal", colour: "#a84f8c" },
  { name: "lin2t", symbol: "\u03b7 lin2t", meaning: "linearisation, tangential", colour: "#8458a3" },
  { name: "quad", symbol: "\u03b7 quad", meaning: "quadrature of the loads", colour: "#5b6b7a" },
  { name: "reg1", symbol: "\u03b7 reg1", meaning: "regularisation, in the body", colour: "#7a7a2e" },
  { name: "reg2n", symbol: "\u03b7 reg2n", meaning: "regularisation, normal", colour: "#a5a058" },
  { name: "reg2t", symbol: "\u03b7 reg2t", meaning: "regularisation, tangential", colour: "#c9c48a" },
];

/** Those of a run: the last three are there with a regularisation only. */
export function componentsOf(run) {
  return components.filter(({ name }) => run.components?.[name] !== undefined);
}

export const statusColours = ["#9aa3ad", "#0072b2", "#d55e00"];
export const statusNames = ["open", "stick", "slip"];

/** The unit of the bound. */
export function boundUnit(dimension) {
  return dimension === 2 ? "S L" : "S L^(3/2)";
}

/** The shares of the squares, which add up to 1. */
export function shares(values) {
  const squares = components.map(({ name }) => (values[name] ?? 0) ** 2);
  const sum = squares.reduce((a, b) => a + b, 0);
  return squares.map((square) => (sum > 0 ? square / sum : 0));
}
