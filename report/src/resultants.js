// Contact resultants: forces on each boundary, further data of pairs, and the bodies with their parts of the bound.

import { axisNames, showsMeridian } from "./axes.js";
import { count, element, number, percent, table, withoutNoise } from "./dom.js";
import { headed, unit } from "./units.js";

const vector = (values) => (values?.length > 0 ? `(${withoutNoise(values).map((value) => number(value, 6)).join(", ")})` : "\u2013");
const moment = (values) => (values?.length === 1 ? number(values[0], 6) : vector(values));

/** "upper.bottom on lower.top" for a slave, the name alone for an obstacle. */
export function boundaryTitle(run, name) {
  const master = run.contact?.boundaries[name]?.master;
  return master ? `${name} on ${master.join(", ")}` : name;
}

function forceTable(run, parts) {
  const force = unit("force");
  const isSliding = run.bound !== null && parts.some(([, part]) => part.sliding);
  const row = (name, part) => {
    const [normal, tangential, length, ...force] = withoutNoise([part.normal, part.tangential, part.abs_tangential, ...part.force])
      .map((value) => number(value, 6));
    return [name, normal, tangential, length, showsMeridian() ? force[1] : `(${force.join(", ")})`, // around the axis the radial forces cancel
      ...(isSliding ? [number(part.sliding?.sliding_factor), number(part.sliding?.safety_factor)] : [])];
  };
  const rows = parts.map(([name, part]) => row(name, part));
  if (parts.length > 1) rows.push(row("in all", run.contact));
  return table(["boundary", headed("#normal", force), headed("#tangential", force), headed("#|tangential|", force),
    headed(`#force ${showsMeridian() ? `${axisNames(2)[1]} ` : ""}on the ${parts.some(([, { master }]) => master) ? "slave" : "body"}`, force), ...(isSliding ? ["#mobilised friction", "#safety against sliding"] : [])], rows);
}

function pairTables(run, pairs) {
  const isMeridian = showsMeridian();
  const [size, about] = run.d === 2 && !isMeridian ? ["length", "the origin"] : ["area", "the axes through the origin"];
  const [covered, moments] = [unit("boundary"), unit("moment")];
  const isTied = pairs.some(([, { largest_tension: tension }]) => tension > 0);
  return [element("h3", {}, "Pairs"),
    table(["slave", "master", "law", "#segments", headed(`#${size} covered`, covered), "#share of the slave", headed("#of the master", covered), headed("#gap", unit("length")),
      ...(isTied ? [headed("#largest tension", unit("stress"))] : [])],
      pairs.map(([name, pair]) => [name, pair.master.join(", "), pair.law, count(pair.segments), number(pair.covered), percent(pair.covered_share),
        number(pair.covered_master), withoutNoise([pair.gap.smallest, pair.gap.largest], run.max_displacement).map((gap) => number(gap, 3)).join(" to "),
        ...(isTied ? [number(pair.largest_tension)] : [])])),
    ...(isMeridian ? [] : [table(["slave", headed("#moment on it", moments), headed("#moment on the master", moments)],
      pairs.map(([name, pair]) => [name, moment(pair.moment), moment(pair.moment_on_master)])),
    element("p", { class: "note" }, `Moments of the contact traction about ${about}. They cancel where the two sides coincide.`)])];
}

function bodyTable(run) {
  const squares = run.bodies.map(({ bound }) => bound ** 2);
  const sum = squares.reduce((a, b) => a + b, 0);
  return [element("h3", {}, "Bodies"), table(["body", "#cells", headed("#energy", unit("energy")), headed("#bound", unit("stress_norm")), "#share of its square"],
    run.bodies.map(({ name, cells, energy, bound }, i) => [name, count(cells), number(energy), number(bound), bound === null ? "\u2013" : percent(sum > 0 ? squares[i] / sum : 0)]))];
}

/** `run`: the certificate. */
export function resultants(run) {
  const parts = Object.entries(run.contact.boundaries);
  const pairs = parts.filter(([, { master }]) => master);
  return [element("h3", {}, "Resultants"), forceTable(run, parts), pairs.length > 0 ? pairTables(run, pairs) : null,
    run.bodies?.length > 1 ? bodyTable(run) : null];
}
