// The variants of a study: names, colours, levels.

// Pairs with and without the stopping criterion nearly coincide: those without are broad and drawn below the others.
const looks = {
  adaptive_converged: { name: "adaptive, Newton to the end", colour: "#8fcdf2", strokeWidth: 6, order: 0 },
  uniform_converged: { name: "uniform, Newton to the end", colour: "#f3c065", strokeWidth: 6, order: 0 },
  adaptive: { name: "adaptive", colour: "#0072b2", strokeWidth: 1.75, order: 1 },
  uniform: { name: "uniform", colour: "#d55e00", strokeWidth: 1.75, order: 1 },
};

/** The variants of the study, with `relative_error`, relative to the energy norm of the reference, on the levels. */
export function variantsOf(study) {
  const energy = study.reference?.energy;
  const relative = (error) => (error !== null && energy > 0 ? error / Math.sqrt(energy) : null);
  return Object.entries(study.variants).map(([key, variant]) => ({ key, ...looks[key], ...variant,
    levels: variant.levels.map((level) => ({ ...level, relative_error: relative(level.energy_error) })) }));
}

/** A quantity over the degrees of freedom, where it is known, as a curve in the colours of the variant. */
export function curveOf(variant, key) {
  return { ...variant, points: variant.levels.filter((level) => level[key] > 0)
    .map((level) => ({ x: level.dofs, y: level[key], level: level.level })) };
}

/** The levels with a bound, in the form of those of a run. */
export function levelsOf({ levels }) {
  return levels.filter(({ relative }) => relative > 0).map((level) => ({ ...level, components: level, bound: level.total_sharp,
    sigma_norm: level.total_sharp / level.relative }));
}

export function total(levels, key) {
  return levels.reduce((sum, level) => sum + (level[key] ?? 0), 0);
}

/** The smallest and the largest known value, or null. */
export function extent(levels, key) {
  const known = levels.map((level) => level[key]).filter((value) => value !== null && value !== undefined);
  return known.length > 0 ? [Math.min(...known), Math.max(...known)] : null;
}
