"""The forms of the proof of Poincare-Korn constants (docs/method.md, section 13.4) on a Hill simplex.

Hill's simplex has the vertices 0, v_1, v_1 + v_2, ..., with |v_i| = 1 and v_i . v_j = a for all i != j. Its cuts parallel to
the facets, m along each edge, and all planes x_i - x_j = integer / m in coordinates along the v_i, leave m^d copies of it,
scaled by 1/m. Vectors are given by their covariant components w . v_i, for which all but lengths of normals is rational.
"""

import itertools
import math
from fractions import Fraction

import numpy as np
import scipy.linalg

from polynomials import averages, derivative, indices, null_space, solve
from verified import Ball, assemble


class Cell:
    """The forms of one cell of size 1, divided by its volume; q in P_{k+1}^d, component by component."""

    def __init__(self, d, a, k):
        identity = np.array([[Fraction(int(i == j)) for j in range(d)] for i in range(d)])
        gram = np.array([[Fraction(1) if i == j else a for j in range(d)] for i in range(d)])
        metric = self.metric = solve(gram, identity)
        n = len(indices(k + 1, d + 1))
        along = [derivative(k + 1, d + 1, i + 1, i) for i in range(d)]
        half = Fraction(1, 2)
        strain = {}
        for i, j in itertools.product(range(d), repeat=2):
            block = np.full((len(along[0]), d * n), Fraction(0))
            block[:, j * n : (j + 1) * n] += half * along[i]
            block[:, i * n : (i + 1) * n] += half * along[j]
            strain[i, j] = block
        raised = {  # eps^i_j
            (i, j): sum(metric[i, r] * strain[r, j] for r in range(d)) for i, j in itertools.product(range(d), repeat=2)
        }
        mass = averages(k, k, d + 1)
        self.energy = sum(raised[i, j].T @ mass @ raised[j, i] for i, j in itertools.product(range(d), repeat=2))
        self.mass = averages(k + 1, k + 1, d + 1)
        self.set_constraints(d, k, strain, raised)

    def set_constraints(self, d, k, strain, raised):
        """Tractions (facet, component -> coefficients) of the p whose div eps(p) is a rigid motion, in rows."""
        along = [derivative(k, d + 1, i + 1, i) for i in range(d)]
        divergence = np.vstack([sum(along[i] @ raised[i, j] for i in range(d)) for j in range(d)])
        fields = null_space(np.hstack([divergence, -rigid_motions(d, k - 1).T]))[:, : divergence.shape[1]]
        place = {alpha: i for i, alpha in enumerate(indices(k, d + 1))}
        self.traces, self.measures, self.tractions = [], [], []
        n_traces = {alpha: i for i, alpha in enumerate(indices(k + 1, d + 1))}
        for facet in range(d + 1):
            gradient = [Fraction(int(facet == i + 1) - int(facet == i)) for i in range(d)]
            normal = [sum(self.metric[i, j] * gradient[j] for j in range(d)) for i in range(d)]
            self.measures.append(Ball.root(d * d * sum(x * y for x, y in zip(normal, gradient))))
            on_facet = lambda alphas: [alpha[:facet] + (0,) + alpha[facet:] for alpha in alphas]
            rows = [place[alpha] for alpha in on_facet(indices(k, d))]
            self.traces.append(np.array([n_traces[alpha] for alpha in on_facet(indices(k + 1, d))]))
            self.tractions.append(
                [-d * (sum(raised[i, j][rows] * normal[j] for j in range(d)) @ fields.T).T for i in range(d)]
            )
        gram = np.array(fields @ self.energy @ fields.T, dtype=float)
        values, vectors = scipy.linalg.eigh(gram)
        kept = values > 1e-10 * values[-1]
        # Rows of about equal size; any combinations are right, so long as they are exact.
        digits = 2**20
        combinations = np.round((vectors[:, kept] / np.sqrt(values[kept])).T * digits).astype(object)
        self.n_rows = len(combinations)
        self.tractions = [[product(combinations, t) * Fraction(1, digits) for t in rows] for rows in self.tractions]


def product(integers, fractions):
    """Exact, and faster than with fractions."""
    common = math.lcm(*(x.denominator for x in fractions.ravel()))
    return integers.astype(int).astype(object) @ (fractions * common).astype(int).astype(object) * Fraction(1, common)


def rigid_motions(d, degree):
    """Coefficients of a basis of rigid motions on the cell of size 1, in rows."""
    alphas = indices(degree, d + 1)
    zero, one = [Fraction(0)] * len(alphas), [Fraction(1)] * len(alphas)
    rows = [[one if c == i else zero for c in range(d)] for i in range(d)]
    x = [[Fraction(sum(alpha[j + 1 :]), degree) for alpha in alphas] for j in range(d)] if degree else []
    for i, j in itertools.combinations(range(d), 2) if degree else ():
        rows.append([x[j] if c == i else [-value for value in x[i]] if c == j else zero for c in range(d)])
    return np.array([sum(row, []) for row in rows])


class HillSimplex:
    """The global forms; unknowns are q on the cells, then the moments v_F on the facets, as polynomials of degree k.

    energy: ||eps(q)||^2, volume: ||q||^2, facets: ||q||_F^2 of the facets of the simplex, jumps: the sum over the cells of
    ||v_F - Pi_F q||^2 on their facets, constraints: rows that vanish. All are divided by the volume of the simplex.
    """

    def __init__(self, d, a, k, m):
        self.d, self.k, self.m = d, k, m
        self.cell = Cell(d, a, k)
        self.n_cell, self.n_facet = len(indices(k + 1, d + 1)), len(indices(k, d))
        self.cells = list(self.make_cells())
        self.number, self.count = {}, {}
        for _, points in self.cells:
            for facet in range(d + 1):
                key = tuple(sorted(points[:facet] + points[facet + 1 :]))
                self.number.setdefault(key, len(self.number))
                self.count[key] = self.count.get(key, 0) + 1
        first = d * self.n_cell * len(self.cells)
        self.n = first + d * self.n_facet * len(self.number)
        self.blocks = [*range(0, first, d * self.n_cell), *range(first, self.n + 1, d * self.n_facet)]
        self.set_forms()

    def make_cells(self):
        """(order of the v_i along the path of vertices, vertices in units of 1/m) of the cells."""
        d, m = self.d, self.m
        for corner in itertools.product(range(m), repeat=d):
            for order in itertools.permutations(range(d)):
                points = [corner]
                for i in order:
                    points.append(tuple(x + (j == i) for j, x in enumerate(points[-1])))
                if all(m >= p[0] and all(x >= y for x, y in zip(p, p[1:])) for p in points):
                    yield order, points

    def of_cell(self, cell, component, local=slice(None)):
        return (cell * self.d + component) * self.n_cell + np.arange(self.n_cell)[local]

    def of_facet(self, points, component):
        """Unknowns of v_F in the order of the exponents for these vertices."""
        key = tuple(sorted(points))
        place = {alpha: i for i, alpha in enumerate(indices(self.k, self.d))}
        sorted_places = [key.index(p) for p in points]
        local = []
        for alpha in indices(self.k, self.d):
            moved = [0] * self.d
            for exponent, i in zip(alpha, sorted_places):
                moved[i] = exponent
            local.append(place[tuple(moved)])
        first = self.d * self.n_cell * len(self.cells)
        return first + (self.number[key] * self.d + component) * self.n_facet + np.array(local)

    def set_forms(self):
        d, m, k, cell = self.d, self.m, self.k, self.cell
        metric = [[Ball.of(x) for x in row] for row in cell.metric]
        energy, mass = Ball.of(cell.energy) * (1 / Fraction(m) ** (d - 2)), Ball.of(cell.mass) * Fraction(1, m**d)
        low, mixed = averages(k, k, d), averages(k, k + 1, d)
        high, projected = Ball.of(averages(k + 1, k + 1, d)), Ball.of(mixed.T @ solve(low, mixed))
        rows = [
            [Ball.of(t @ x) for t in cell.tractions[facet] for x in (low, -mixed)]
            for facet in range(d + 1)
        ]
        low, mixed = Ball.of(low), Ball.of(mixed)
        n_rows = cell.n_rows
        parts = {"energy": [], "volume": [], "jumps": [], "constraints": []} | {f: [] for f in range(d + 1)}
        for c, (order, points) in enumerate(self.cells):
            unknowns = np.concatenate([self.of_cell(c, i) for i in order])
            parts["energy"].append((unknowns, unknowns, energy))
            for i, j in itertools.product(range(d), repeat=2):
                parts["volume"].append((self.of_cell(c, i), self.of_cell(c, j), mass * metric[i][j]))
            of_rows = c * n_rows + np.arange(n_rows)
            for facet in range(d + 1):
                vertices = points[:facet] + points[facet + 1 :]
                side = self.side(vertices)
                for i, j in itertools.product(range(d), repeat=2):
                    weight = cell.measures[facet] * Fraction(1, m ** (d - 1)) * metric[i][j]
                    q_i, q_j = (self.of_cell(c, r, cell.traces[facet]) for r in (i, j))
                    v_i, v_j = (self.of_facet(vertices, r) for r in (i, j))
                    parts["jumps"] += [
                        (v_i, v_j, low * weight),
                        (v_i, q_j, mixed * weight * -1),
                        (q_i, v_j, mixed.T * weight * -1),
                        (q_i, q_j, projected * weight),
                    ]
                    if side is not None:
                        parts[side].append((q_i, q_j, high * weight))
                for i, component in enumerate(order):
                    v, q = self.of_facet(vertices, component), self.of_cell(c, component, cell.traces[facet])
                    parts["constraints"] += [(of_rows, v, rows[facet][2 * i]), (of_rows, q, rows[facet][2 * i + 1])]
        square = {name: assemble(part, (self.n, self.n)) for name, part in parts.items() if name != "constraints"}
        self.energy, self.volume, self.jumps = square["energy"], square["volume"], square["jumps"]
        self.facets = [square[facet] for facet in range(d + 1)]
        constraints = assemble(parts["constraints"], (n_rows * len(self.cells), self.n))
        self.penalty = constraints.T @ constraints
        self.rigid = self.rigid_fields()

    def side(self, points):
        """The facet of the simplex on which these points lie, if there is one: that opposite to its vertex of this number."""
        d, m = self.d, self.m
        coordinates = [[m, *p, 0] for p in points]
        if self.count[tuple(sorted(points))] > 1:
            return None
        return next(f for f in range(d + 1) if all(x[f] == x[f + 1] for x in coordinates))

    def rigid_fields(self):
        """Rigid motions of the whole simplex, in columns."""
        d, m, n = self.d, self.m, self.k + 1
        fields = np.full((self.n, d + math.comb(d, 2)), Fraction(0))
        for c, (_, points) in enumerate(self.cells):
            x = [[sum(e * p[i] for e, p in zip(alpha, points)) / Fraction(n * m) for alpha in indices(n, d + 1)] for i in range(d)]
            for i in range(d):
                fields[self.of_cell(c, i), i] = Fraction(1)
            for r, (i, j) in enumerate(itertools.combinations(range(d), 2)):
                fields[self.of_cell(c, i), d + r] = x[j]
                fields[self.of_cell(c, j), d + r] = [-value for value in x[i]]
        return Ball.of(fields)
