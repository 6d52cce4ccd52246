"""The residual of a computed displacement and its dual norm from below, assembled anew from the data of the case.

    <R(u), v> = L(v) - a(u, v) - (K (u - u_0), v)_S + (T(u), v)_C,  ||v||^2 = ||grad v||^2 + sum_F ||v||_F^2 / h_F,

v = 0 where u is prescribed, F in C and S. On the meridian of a body of revolution all integrals have the weight r,
sigma_tt v_r / r is part of a(u, v), and ||v_r / r||^2 of the norm.

The supremum is taken over continuous P^q on the mesh. Data are integrated over parts of cells and facets, which are cut
where formulas and the contact law have kinks.
"""

from functools import cache

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from simplices import bernstein, bernstein_gradients, bisected, composite, cut, lattice, rule

FACET_DEGREE, CELL_DEGREE = 11, 9  # degrees of exactness of the rules on the parts


class Residual:
    """`fineness`: how often cells (and, three times as often, facets) are halved in every direction for formulas."""

    def __init__(self, level, case, names, fineness=1):
        self.level, self.case, self.fineness = level, case, fineness
        self.region_names = names
        self.boundary = level.boundary(case)
        materials = [case.material(name) for name in names]
        self.materials = np.array([[m.lam, m.mu] for m in materials])[level.regions]
        self.initial = [case.initial_stress(name) for name in names]
        self.has_initial_stress = any(s.entries or s.beta for s in self.initial)
        self.conditions = {name: case.condition(name) for name in self.boundary}
        self.contact = [name for name, c in self.conditions.items() if c.contact and len(self.boundary[name])]
        self.springs = [name for name, c in self.conditions.items() if c.spring and len(self.boundary[name])]

    # stress

    def initial_stress(self, cells, points):
        """sigma_0 at barycentric points, one per cell number."""
        places = self.level.places(cells, points)
        result = np.zeros((len(cells), self.level.dimension, self.level.dimension))
        for number, sigma_0 in enumerate(self.initial):
            here = self.level.regions[cells] == number
            result[here] = sigma_0(places[here])
        return result

    def stress(self, cells, points):
        """C eps(u) + sigma_0."""
        return self.level.stress(cells, points, self.materials) + self.initial_stress(cells, points)

    # data on parts of facets and cells

    def facet_rule(self, facets, formulas, more_cuts=()):
        """Owner, barycentric point in the cell and weight of each point of a rule on all facets."""
        d = self.level.dimension
        smooth = all(f.is_constant for f in formulas) and not more_cuts
        parts = bisected(d - 1, 0 if smooth else (3 if d == 2 else 1) * self.fineness)
        owners, parts = spread(len(facets), parts)
        places = lambda o, b: self.level.places(facets.cells[o], facets.in_cell(o, b))
        for f in formulas:
            for kink in f.kinks:
                owners, parts = cut(owners, parts, lambda o, b: value(kink, places(o, b)))
        for function in more_cuts:
            owners, parts = cut(owners, parts, lambda o, b: function(o, facets.in_cell(o, b)))
        owners, points, weights = composite(owners, parts, FACET_DEGREE)
        points = facets.in_cell(owners, points)
        return owners, points, weights * facets.measures[owners] * self.level.weight(facets.cells[owners], points)

    def load(self, q):
        """<R, B> for the functions of each cell: cells x functions x components."""
        result = self.body_load(q) - self.internal_forces(q)
        for name, facets in self.boundary.items():
            if len(facets):
                self.add(result, q, facets, *self.boundary_load(name))
        for name in self.springs:
            self.add(result, q, self.boundary[name], *self.spring_load(name))
        return result

    def boundary_load(self, name):
        """Points and tractions of a boundary: g_N, or T(u)."""
        if name in self.contact:
            owners, points, weights = self.contact_rule(name)
            return owners, points, weights, self.contact_state(name, owners, points)["traction"]
        facets, condition = self.boundary[name], self.conditions[name]
        owners, points, weights = self.facet_rule(facets, [*condition.traction, condition.pressure])
        places = self.level.places(facets.cells[owners], points)
        traction = np.stack([f(places) for f in condition.traction], axis=1)
        return owners, points, weights, traction - condition.pressure(places)[:, None] * facets.normals[owners]

    def spring_load(self, name):
        """Points of a boundary and -K (u - u_0), K without the components that are fixed."""
        facets, condition = self.boundary[name], self.conditions[name]
        spring = condition.spring
        owners, points, weights = self.facet_rule(facets, [spring["normal"], spring["tangential"], *spring["rest"]])
        places = self.level.places(facets.cells[owners], points)
        free = np.array([datum is None for datum in condition.displacement])
        moved = self.level.displacement(facets.cells[owners], points) - np.stack([f(places) for f in spring["rest"]], axis=1)
        moved *= free
        n = facets.normals[owners]
        along = dot(moved, n)[:, None] * n
        force = spring["normal"](places)[:, None] * along + spring["tangential"](places)[:, None] * (moved - along)
        return owners, points, weights, -force * free

    def add(self, result, q, facets, owners, points, weights, traction):
        values = bernstein(points, q) * weights[:, None]
        np.add.at(result, facets.cells[owners], values[:, :, None] * traction[:, None, :])

    def body_load(self, q):
        level = self.level
        n_functions = len(lattice(level.dimension + 1, q))
        result = np.zeros((len(level.cells), n_functions, level.dimension))
        for number, name in enumerate(self.region_names):
            cells = np.flatnonzero(level.regions == number)
            force = self.case.body_force(name)
            if all(f.is_constant for f in force) and not level.is_axisymmetric:
                constant = np.array([f(np.zeros((1, level.dimension)))[0] for f in force])
                result[cells] = (level.volumes[cells] / n_functions)[:, None, None] * constant
                continue
            owners, points, weights = self.cell_rule(cells, force)
            places = level.places(owners, points)
            densities = np.stack([f(places) for f in force], axis=1) * weights[:, None]
            np.add.at(result, owners, bernstein(points, q)[:, :, None] * densities[:, None, :])
        return result

    def cell_rule(self, cells, formulas):
        """Cell, barycentric point and weight of each point of a rule on these cells."""
        smooth = all(f.is_constant for f in formulas)
        owners, parts = spread(len(cells), bisected(self.level.dimension, 0 if smooth else self.fineness))
        for f in formulas:
            for kink in f.kinks:
                owners, parts = cut(owners, parts, lambda o, b: value(kink, self.level.places(cells[o], b)))
        owners, points, weights = composite(owners, parts, CELL_DEGREE)
        return cells[owners], points, weights * self.level.volumes[cells[owners]] * self.level.weight(cells[owners], points)

    def initial_forces(self, q):
        """(sigma_0, grad B)."""
        level = self.level
        result = np.zeros((len(level.cells), len(lattice(level.dimension + 1, q)), level.dimension))
        for number, sigma_0 in enumerate(self.initial):
            cells, points, weights = self.cell_rule(np.flatnonzero(level.regions == number), sigma_0.formulas())
            by_lambda = np.einsum("pij,pvj->pvi", sigma_0(level.places(cells, points)), level.gradients[cells])
            table = bernstein_gradients(points, q) * weights[:, None, None]
            np.add.at(result, cells, np.einsum("pav,pvi->pai", table, by_lambda))
        return result

    def internal_forces(self, q):
        """(sigma(u), grad B)."""
        level = self.level
        if level.is_axisymmetric:
            return self.radial_forces(q)
        points, weights = rule(level.dimension, level.degree + q)
        n, m = len(level.cells), len(weights)
        stress = level.stress(np.repeat(np.arange(n), m), np.tile(points, (n, 1)), self.materials)
        stress = stress.reshape(n, m, level.dimension, level.dimension)
        by_lambda = np.einsum("cqij,cvj->cqvi", stress, level.gradients) * level.volumes[:, None, None, None]
        table = bernstein_gradients(points, q) * weights[:, None, None]
        result = np.einsum("qav,cqvi->cai", table, by_lambda, optimize=True)
        return result + self.initial_forces(q) if self.has_initial_stress else result

    def radial_forces(self, q):
        """(r sigma(u), grad B) + (sigma_tt(u), B_r) on a meridian."""
        level = self.level
        cells, points, weights = level.radial_rule(level.degree + q)
        n = len(level.cells)
        stress = level.stress(cells, points, self.materials) * weights[:, None, None]
        by_lambda = np.einsum("pij,pvj->pvi", stress, level.gradients[cells])
        terms = np.einsum("pav,pvi->pai", bernstein_gradients(points, q), by_lambda, optimize=True)
        hoop = level.hoop_stress(cells, points, self.materials) * weights / level.weight(cells, points)
        terms[:, :, 0] += hoop[:, None] * bernstein(points, q)
        return terms.reshape(n, -1, *terms.shape[1:]).sum(axis=1)

    # the contact law

    def contact_rule(self, name):
        """Parts cut where T(u) has kinks: P^n = 0 and |P^t| = S."""
        contact = self.conditions[name].contact
        cuts = []
        if contact["friction"] != "slider":
            cuts.append(lambda o, b: self.contact_state(name, o, b)["normal"])
        if contact["friction"] not in ("none", "slider"):
            cuts.append(lambda o, b: self.contact_state(name, o, b)["excess"])
        of_stress = [f for sigma_0 in self.initial for f in sigma_0.formulas()]
        return self.facet_rule(self.boundary[name], [contact["gap"], contact["threshold"], *of_stress], cuts)

    def penalties(self, name):
        """gamma of each facet: gamma_0 min(lambda + 2 mu, 34 mu) / h_F."""
        facets = self.boundary[name]
        lam, mu = self.materials[facets.cells].T
        return self.case.gamma0 * np.minimum(lam + 2 * mu, 34 * mu) / facets.sizes

    def contact_state(self, name, owners, points):
        """P, T and the columns of contact.csv, at barycentric points of the cells of the facets."""
        facets, contact = self.boundary[name], self.conditions[name].contact
        cells, n = facets.cells[owners], facets.normals[owners]
        places = self.level.places(cells, points)
        u = self.level.displacement(cells, points)
        gap = contact["gap"](places) - dot(u, n)
        gamma = self.penalties(name)[owners]
        on_facet = np.einsum("pij,pj->pi", self.stress(cells, points), n)
        normal = dot(on_facet, n) + gamma * gap
        slip = u - dot(u, n)[:, None] * n
        tangential = on_facet - dot(on_facet, n)[:, None] * n - gamma[:, None] * slip
        slides = contact["friction"] == "slider"
        pressure = -normal if slides else np.maximum(-normal, 0)
        limit = {
            "none": np.zeros(len(n)),
            "slider": np.zeros(len(n)),
            "tresca": contact["threshold"](places),
            "coulomb": contact["coefficient"] * pressure,
        }[contact["friction"]]
        length = np.linalg.norm(tangential, axis=1)
        shrunk = np.minimum(1, limit / np.maximum(length, 1e-300))
        traction = shrunk[:, None] * tangential - pressure[:, None] * n
        return {
            "normal": normal,
            "excess": length - limit,
            "pressure": pressure,
            "limit": limit,
            "traction": traction,
            "gap": gap,
            "slip": slip,
        }

    # the dual norm

    def dual_norm(self, q):
        level = self.level
        numbers = level.node_keys(q)
        n = numbers.max() + 1
        load = np.zeros((n, level.dimension))
        np.add.at(load, numbers, self.load(q))
        squared = 0.0
        solvers = {}
        for component in range(level.dimension):
            free = np.flatnonzero(~self.fixed(component, q, numbers, n))
            if len(free) == 0:
                continue
            has_hoop = level.is_axisymmetric and component == 0
            if (key := (free.tobytes(), has_hoop)) not in solvers:
                matrix = self.matrix(q, numbers, n, has_hoop)
                solvers[key] = splu(matrix[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A")
            z = solvers[key].solve(load[free, component])
            squared += load[free, component] @ z
        return np.sqrt(max(squared, 0.0))

    def radial_blocks(self, q, has_hoop):
        """int r grad B_a . grad B_b on the cells of a meridian, with int B_a B_b / r."""
        level = self.level
        cells, points, weights = level.radial_rule(2 * q)
        n = len(level.cells)
        weights = weights.reshape(n, -1)
        gradients = np.einsum("pav,pvi->pai", bernstein_gradients(points, q), level.gradients[cells])
        gradients = gradients.reshape(n, weights.shape[1], -1, 2)
        blocks = np.einsum("cq,cqai,cqbi->cab", weights, gradients, gradients, optimize=True)
        if has_hoop:
            r = level.weight(cells, points).reshape(weights.shape)
            values = bernstein(points, q).reshape(n, weights.shape[1], -1)
            blocks += np.einsum("cq,cqa,cqb->cab", weights / r**2, values, values, optimize=True)
        return blocks.reshape(n, -1)

    def matrix(self, q, numbers, n, has_hoop):
        level = self.level
        metric = np.einsum("cvi,cwi->cvw", level.gradients, level.gradients) * level.volumes[:, None, None]
        size = numbers.shape[1]
        if level.is_axisymmetric:
            blocks = self.radial_blocks(q, has_hoop)
        else:
            blocks = metric.reshape(len(metric), -1) @ stiffness_table(level.dimension, q).reshape(-1, size * size)
        rows = [np.repeat(numbers, size, axis=1).ravel()]
        columns = [np.tile(numbers, (1, size)).ravel()]
        entries = [blocks.ravel()]
        points, weights = rule(level.dimension - 1, 2 * q + 1)
        for name in self.contact + self.springs:
            facets = self.boundary[name]
            owners = np.repeat(np.arange(len(facets)), len(weights))
            in_cell = facets.in_cell(owners, np.tile(points, (len(facets), 1)))
            values = bernstein(in_cell, q).reshape(len(facets), len(weights), size)
            scale = (facets.measures / facets.sizes)[:, None] * weights
            scale = scale * level.weight(facets.cells[owners], in_cell).reshape(scale.shape)
            entries.append(np.einsum("fq,fqa,fqb->fab", scale, values, values, optimize=True).ravel())
            rows.append(np.repeat(numbers[facets.cells], size, axis=1).ravel())
            columns.append(np.tile(numbers[facets.cells], (1, size)).ravel())
        triplets = np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))
        return coo_matrix(triplets, (n, n)).tocsr()

    def fixed(self, component, q, numbers, n):
        """Nodes of P^q where Gamma_D fixes the component."""
        exponents = lattice(self.level.dimension + 1, q)
        result = np.zeros(n, bool)
        for name, facets in self.boundary.items():
            if self.conditions[name].displacement[component] is None:
                continue
            for cell, opposite in zip(facets.cells, facets.opposite):
                result[numbers[cell, exponents[:, opposite] == 0]] = True
        return result


@cache
def stiffness_table(dimension, q):
    """Means of d_v B_a d_w B_b over the cell; indices v, w, a, b."""
    points, weights = rule(dimension, 2 * q - 2)
    table = bernstein_gradients(points, q)
    return np.einsum("q,qav,qbw->vwab", weights, table, table, optimize=True)


def spread(n, parts):
    """The same parts for n owners."""
    return np.repeat(np.arange(n), len(parts)), np.tile(parts, (n, 1, 1))


def value(function, places):
    """Values of a function of the columns of the places."""
    with np.errstate(all="ignore"):
        return np.broadcast_to(np.asarray(function(places.T), dtype=float), (len(places),))


def dot(a, b):
    return np.einsum("pi,pi->p", a, b)
