"""Judges the fields of a level: shares of the bound, displacement, residual, mesh."""

import numpy as np

from residual import Residual
from simplices import bernstein, lattice, rule
from verdict import near

REGULARISED = ["reg1", "reg2n", "reg2t"]
ROUNDING = 1e-9  # relative to the stress: a residual below this is rounding, as identities up to 1e-8 are
WHOLE = ("quad", "alg")  # of the body, not of its cells
CLOSE = 0.95  # dual norms above this share of the bound are computed again with finer rules
FINER = (2, 3)


def judge_cells(verdict, level, entry, number):
    """eta of the cells, compared with the components of the level."""
    eta = {name[4:]: values for name, values in level.arrays.items() if name.startswith("eta_")}
    verdict.check(entry["cells"] == len(level.cells), f"level {number}: {len(level.cells)} cells in the VTU file")
    for name, x in entry["components"].items():
        if name in WHOLE:
            continue
        found = np.sqrt(np.sum(eta[name] ** 2))
        verdict.check(near(found, x, 1e-9, 1e-300), f"level {number}: eta_{name} gives {found}, not {x}")
    zero = np.zeros(len(level.cells))
    reg = [eta.get(name, zero) for name in REGULARISED]
    body = eta["osc"] + eta["str"] + eta["neu"] + eta["lin1"] + reg[0]
    normal, tangential = eta["cnt"] + eta["lin2n"] + reg[1], eta["frc"] + eta["lin2t"] + reg[2]
    total = np.sqrt(body**2 + normal**2 + tangential**2)
    verdict.check(np.allclose(total, eta["tot"], 1e-9, 1e-300), f"level {number}: eta_tot of a cell")
    whole = sum(entry["components"].get(name, 0.0) for name in WHOLE)
    found = np.sqrt(np.sum(total**2)) + whole
    verdict.check(near(found, entry["bound"]), f"level {number}: the cells do not add up to the bound")
    plain = np.sqrt(np.sum(body**2 + (normal + tangential) ** 2)) + whole
    verdict.check(near(plain, entry["bound_plain"]), f"level {number}: the cells do not add up to bound_plain")


def judge_displacement(verdict, residual, entry, number):
    """Continuity, prescribed values, unknowns, norm, energy and largest displacement."""
    level = residual.level
    p, d = level.degree, level.dimension
    numbers = level.node_keys(p)
    nodal = np.einsum("ab,cbi->cai", bernstein(lattice(d + 1, p) / p, p), level.coefficients)
    n = numbers.max() + 1
    values = np.zeros((n, d))
    values[numbers] = nodal
    scale = np.abs(nodal).max(initial=0.0)
    verdict.check(np.abs(values[numbers] - nodal).max() <= 1e-12 * scale, f"level {number}: u is not continuous")
    places = np.zeros((n, d))
    places[numbers] = np.einsum("av,cvi->cai", lattice(d + 1, p) / p, level.vertices[level.cells])
    free = 0
    for component in range(d):
        fixed = residual.fixed(component, p, numbers, n)
        free += n - fixed.sum()
        right = np.zeros(n, bool)
        for name, facets in residual.boundary.items():
            datum = residual.conditions[name].displacement[component]
            if datum is None:
                continue
            nodes = np.unique([numbers[c][lattice(d + 1, p)[:, o] == 0] for c, o in zip(facets.cells, facets.opposite)])
            nodes = nodes.astype(int)
            prescribed = datum(places[nodes])
            right[nodes] |= np.abs(values[nodes, component] - prescribed) <= 1e-8 * (scale + np.abs(prescribed))
        verdict.check(right[fixed].all(), f"level {number}: u is not what is prescribed")
    verdict.check(free == entry["dofs"], f"level {number}: {free} free nodal values, dofs {entry['dofs']}")
    length = np.linalg.norm(level.nodal, axis=2).max()
    verdict.check(near(length, entry["max_displacement"], 1e-10), f"level {number}: max_displacement, found {length}")
    if level.is_axisymmetric:
        cells, all_points, weights = level.radial_rule(2 * p)
    else:
        points, weights = rule(d, 2 * p)
        cells = np.repeat(np.arange(len(level.cells)), len(weights))
        all_points = np.tile(points, (len(level.cells), 1))
        weights = np.tile(weights, len(level.cells)) * level.volumes[cells]
    stress = level.stress(cells, all_points, residual.materials)
    gradient = level.gradient(cells, all_points)
    energy = np.einsum("p,pij,pij->", weights, stress, gradient)
    square = np.einsum("p,pij,pij->", weights, stress, stress)
    if level.is_axisymmetric:
        hoop = level.hoop_stress(cells, all_points, residual.materials)
        energy = 2 * np.pi * (energy + weights @ (hoop * level.hoop(cells, all_points, gradient)))
        square += weights @ hoop**2
    norm = stress_norm(residual) if residual.has_initial_stress else np.sqrt(square)
    rounding = 1e-10 * np.sqrt(weights.sum()) * residual.materials.max() * scale / level.size
    # The program integrates an initial stress that varies by one rule for each cell, which may miss a part of it.
    if all(f.is_constant for sigma_0 in residual.initial for f in sigma_0.formulas()):
        verdict.check(near(norm, entry["sigma_norm"], 1e-8, rounding), f"level {number}: sigma_norm, found {norm}")
    verdict.check(near(energy, entry["energy"], 1e-7, rounding * scale), f"level {number}: energy, found {energy}")


def stress_norm(residual):
    """||C eps(u) + sigma_0||."""
    square = 0.0
    for number, sigma_0 in enumerate(residual.initial):
        cells = np.flatnonzero(residual.level.regions == number)
        owners, points, weights = residual.cell_rule(cells, sigma_0.formulas())
        stress = residual.stress(owners, points)
        square += np.einsum("p,pij,pij->", weights, stress, stress)
    return np.sqrt(square)


def judge_probes(verdict, residual, entry):
    """The displacement at every probe."""
    level = residual.level
    scale = np.abs(level.nodal).max(initial=0.0)
    for probe in entry.get("probes") or []:
        for point in probe["points"]:
            from_first = np.array(point["x"])[None, :] - level.vertices[level.cells[:, 0]]
            places = np.einsum("cj,cvj->cv", from_first, level.gradients)
            places[:, 0] += 1
            cell = places.min(axis=1).argmax()
            found = level.displacement(np.array([cell]), places[[cell]])[0]
            close = np.abs(found - point["displacement"]).max() <= 1e-7 * scale
            verdict.check(close, f"probe {probe['name']}: displacement {point['displacement']}, found {found}")


def judge_residual(verdict, case, residual, entry, number):
    """The theorem: a lower bound of the dual norm is at most the bound."""
    level = residual.level
    q = level.degree + (2 if level.dimension == 2 else 1)
    dual, bound = residual.dual_norm(q), entry["bound"]
    verdict.n_bounds += 1
    stress_rounding = 1e-13 * residual.materials.max() * np.abs(level.nodal).max() / level.size
    allowed = ROUNDING * entry["sigma_norm"] + stress_rounding * np.sqrt(level.volumes.sum()) * len(level.cells)
    for fineness in FINER:
        if dual > CLOSE * bound + allowed:
            dual = Residual(level, case, residual.region_names, fineness).dual_norm(q)
    if dual > allowed:
        verdict.effectivities.append(bound / dual)
    if case.get("certify.contact_rule", "resolved") == "reference":
        return  # this rule does not resolve kinks; the certificate says that it does not cover them
    if dual > bound * (1 + 1e-6) + allowed:
        text = f"level {number}: dual norm {dual:.6g} above the bound {bound:.6g}, effectivity {bound / dual:.4g}"
        verdict.findings.append(f"VIOLATION: {text}")


def judge_mesh(verdict, case, residual):
    """Boundaries and regions have the measures that the geometry gives."""
    level = residual.level
    for name, simplices in case.sides.items():
        edges = simplices[:, 1:] - simplices[:, :1]
        gram = np.linalg.det(edges @ edges.transpose(0, 2, 1))
        expected = np.sqrt(np.maximum(gram, 0)).sum() / (1 if level.dimension == 2 else 2)
        found = residual.boundary[name].measures.sum()
        verdict.check(near(found, expected, 1e-6), f"boundary {name} measures {found}, not {expected}")
    for number, name in enumerate(residual.region_names):
        found = level.volumes[level.regions == number].sum()
        verdict.check(near(found, case.areas.get(name), 1e-6), f"region {name} measures {found}")
