// The components of the bound, as the program describes them, with colours (after Okabe and Ito, told apart by colour-blind people
// too), and their shares; what else the pictures have in common.

const palettes = {
  discretisation: ["#56b4e9", "#0072b2", "#009e73", "#d55e00", "#e69f00", "#5b6b7a", "#b0413e"],
  linearisation: ["#cc79a7", "#a84f8c", "#8458a3"],
  regularisation: ["#7a7a2e", "#a5a058", "#c9c48a"],
  algebra: ["#9aa3ad"],
};

/** `components`: name, meaning, part and cause of each; those of one cause get successive colours of its palette. */
export function coloured(components) {
  const place = ({ cause }, i) => components.slice(0, i).filter((other) => other.cause === cause).length;
  return components.map((component, i) => ({ ...component, colour: palettes[component.cause][place(component, i)] }));
}

export const statusColours = ["#9aa3ad", "#0072b2", "#d55e00", "#009e73"];
export const statusNames = ["open", "stick", "slip", "tied"];

/** The shares of the squares, which add up to 1. */
export function shares(components, values) {
  const squares = components.map(({ name }) => (values[name] ?? 0) ** 2);
  const sum = squares.reduce((a, b) => a + b, 0);
  return squares.map((square) => (sum > 0 ? square / sum : 0));
}
