"""A level of a run, from its VTU file: mesh, displacement, and the group of the case that each boundary facet belongs to."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from simplices import bernstein, bernstein_gradients, lattice, rule

SAME_POINT = 1e-10  # relative to the size of the body
RATIONAL = 24  # by which degrees of rules are raised for quotients by r


class Inconsistent(Exception):
    """A file that contradicts itself or the case."""


@dataclass
class Facets:
    """Facets of one boundary group; `opposite` is the cell's vertex opposite the facet."""

    cells: np.ndarray
    opposite: np.ndarray
    normals: np.ndarray
    sizes: np.ndarray  # h_F
    measures: np.ndarray

    def __len__(self):
        return len(self.cells)

    def in_cell(self, numbers, points):
        """Barycentric points of cells from barycentric points of facets."""
        result = np.zeros((len(points), points.shape[1] + 1))
        for local in range(points.shape[1] + 1):
            here = self.opposite[numbers] == local
            result[np.ix_(here, [k for k in range(result.shape[1]) if k != local])] = points[here]
        return result


class Level:
    """The vertices of each cell are in ascending order, so neighbours see shared entities alike."""

    def __init__(self, grid, case):
        self.dimension = d = grid.dimension
        self.degree = p = case.degree
        self.is_axisymmetric = case.is_axisymmetric
        if d != case.dimension or grid.points.shape[1] != len(lattice(d + 1, p)):
            raise Inconsistent(f"cells of {grid.points.shape[1]} nodes in {d}D for degree {p}")
        points, displacement = grid.points[:, :, :d], grid.arrays["displacement"][:, :, :d]
        self.size = np.ptp(points.reshape(-1, d), axis=0).max()
        corners = merged(points[:, : d + 1].reshape(-1, d), SAME_POINT * self.size).reshape(-1, d + 1)
        order = np.argsort(corners, axis=1)
        self.cells = np.take_along_axis(corners, order, axis=1)
        self.vertices = np.empty((corners.max() + 1, d))
        self.vertices[corners.ravel()] = points[:, : d + 1].reshape(-1, d)
        self.regions = grid.arrays["region"]
        self.arrays = grid.arrays

        x = self.vertices[self.cells]
        edges = x[:, 1:] - x[:, :1]
        self.volumes = np.abs(np.linalg.det(edges)) / (2 if d == 2 else 6)
        inverse = np.linalg.inv(edges)  # columns: gradients of lambda_1 ... lambda_d
        self.gradients = np.concatenate([-inverse.sum(axis=2, keepdims=True), inverse], axis=2).transpose(0, 2, 1)
        self.coefficients = self.bernstein_coefficients(points, displacement)
        self.nodal = displacement

    def bernstein_coefficients(self, points, displacement):
        """The coefficients of u in the order of lattice(), whatever the order of the nodes in the file."""
        d, p = self.dimension, self.degree
        from_first = points - self.vertices[self.cells[:, :1]]
        barycentric = np.einsum("cnj,cvj->cnv", from_first, self.gradients)
        barycentric[:, :, 0] += 1
        alpha = np.rint(p * barycentric).astype(int)
        if np.abs(p * barycentric - alpha).max() > 1e-6:
            raise Inconsistent("nodes are not those of Lagrange cells")
        code = (p + 1) ** np.arange(d + 1)
        expected = lattice(d + 1, p) @ code
        found = np.argsort(alpha @ code, axis=1)
        if (np.take_along_axis(alpha @ code, found, axis=1) != np.sort(expected)).any():
            raise Inconsistent("a node of a cell is missing")
        nodal = np.take_along_axis(displacement, found[:, np.argsort(np.argsort(expected)), None], axis=1)
        return np.einsum("ab,cbi->cai", np.linalg.inv(bernstein(lattice(d + 1, p) / p, p)), nodal)

    def places(self, cells, points):
        """Cartesian coordinates of barycentric points, one per cell number. A coordinate that all vertices of a facet share is
        reproduced at its points to the last bit."""
        vertices = self.vertices[self.cells[cells]]
        nearest = vertices[np.arange(len(points)), points.argmax(axis=1)]
        return nearest + np.einsum("pv,pvi->pi", points, vertices - nearest[:, None, :])

    def displacement(self, cells, points):
        return np.einsum("pa,pai->pi", bernstein(points, self.degree), self.coefficients[cells])

    def gradient(self, cells, points):
        """du_i / dx_j."""
        by_lambda = np.einsum("pav,pai->piv", bernstein_gradients(points, self.degree), self.coefficients[cells])
        return np.einsum("piv,pvj->pij", by_lambda, self.gradients[cells])

    def weight(self, cells, points):
        """r on a meridian."""
        return self.places(cells, points)[:, 0] if self.is_axisymmetric else np.ones(len(cells))

    def radial_rule(self, degree):
        """Cells, points and weights times r of a rule on a meridian, also for quotients by r: it is collapsed at the vertex
        of each cell that is next to the axis."""
        points, weights = rule(2, degree + RATIONAL)
        n, m = len(self.cells), len(weights)
        cells, everywhere = np.repeat(np.arange(n), m), np.tile(points, (n, 1)).reshape(n, m, 3)
        nearest = self.vertices[self.cells][:, :, 0].argmin(axis=1)
        for vertex in (0, 2):  # rule() is collapsed at vertex 1
            here = nearest == vertex
            order = [0, 1, 2]
            order[1], order[vertex] = vertex, 1
            everywhere[here] = everywhere[here][:, :, order]
        everywhere = everywhere.reshape(-1, 3)
        return cells, everywhere, np.tile(weights, n) * self.volumes[cells] * self.weight(cells, everywhere)

    def hoop(self, cells, points, gradient):
        """u_r / r on a meridian, else 0."""
        if not self.is_axisymmetric:
            return np.zeros(len(cells))
        r = self.places(cells, points)[:, 0]
        far = r > 1e-12 * self.size
        return np.where(far, self.displacement(cells, points)[:, 0] / np.where(far, r, 1.0), gradient[:, 0, 0])

    def hoop_stress(self, cells, points, materials):
        gradient = self.gradient(cells, points)
        lam, mu = materials[cells].T
        hoop = self.hoop(cells, points, gradient)
        return lam * (np.trace(gradient, axis1=1, axis2=2) + hoop) + 2 * mu * hoop

    def stress(self, cells, points, materials):
        gradient = self.gradient(cells, points)
        lam, mu = materials[cells].T
        trace = np.trace(gradient, axis1=1, axis2=2) + self.hoop(cells, points, gradient)
        return (lam * trace)[:, None, None] * np.eye(self.dimension) + mu[:, None, None] * (
            gradient + gradient.transpose(0, 2, 1)
        )

    def node_keys(self, degree):
        """Node numbers of continuous P^degree: cells x functions."""
        # A node is the sum of its vertices weighted by alpha; random 64-bit weights tell the sums apart.
        weights = np.random.default_rng(1).integers(1, 2**63, len(self.vertices), dtype=np.uint64)
        alpha = lattice(self.dimension + 1, degree).astype(np.uint64)
        with np.errstate(over="ignore"):
            keys = (weights[self.cells][:, None, :] * alpha[None]).sum(axis=2, dtype=np.uint64)
        _, numbers = np.unique(keys, return_inverse=True)
        return numbers.reshape(keys.shape)

    def boundary(self, case):
        """Boundary facets by the groups of the case; "" for those in none."""
        d = self.dimension
        n = len(self.cells)
        facets = np.concatenate([np.delete(self.cells, i, axis=1) for i in range(d + 1)])
        _, index, counts = np.unique(facets, axis=0, return_index=True, return_counts=True)
        if counts.max() > 2:
            raise Inconsistent("a facet belongs to three cells")
        chosen = index[counts == 1]
        cells, opposite = chosen % n, chosen // n
        corners = self.vertices[facets[chosen]]
        centres = corners.mean(axis=1)
        groups = {}
        free = np.ones(len(chosen), bool)
        for name, simplices in case.sides.items():
            inside = contained(centres, simplices, 1e-7 * self.size)
            if (inside & ~free).any():
                raise Inconsistent(f"a facet belongs to {name} and to another group")
            free &= ~inside
            groups[name] = np.flatnonzero(inside)
        groups[""] = np.flatnonzero(free)
        return {name: self.facets(cells[k], opposite[k], corners[k]) for name, k in groups.items()}

    def facets(self, cells, opposite, corners):
        inward = self.gradients[cells, opposite]
        length = np.linalg.norm(inward, axis=1)
        measures = self.dimension * self.volumes[cells] * length
        sizes = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=3).max(axis=(1, 2), initial=0)
        return Facets(cells, opposite, -inward / length[:, None], sizes, measures)


def merged(points, tolerance):
    """Numbers points so that coinciding ones share a number."""
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), pairs.T), (len(points), len(points)))
    return connected_components(graph, directed=False)[1]


def contained(points, simplices, tolerance):
    """Whether points lie in one of the simplices, whose dimension is one less than that of space."""
    origin = simplices[:, 0]
    edges = simplices[:, 1:] - origin[:, None]  # simplex x edge x d
    inverse = np.linalg.pinv(edges)  # simplex x d x edge
    away = points[:, None] - origin[None]
    local = np.einsum("psi,sie->pse", away, inverse)
    distance = np.linalg.norm(away - np.einsum("pse,sei->psi", local, edges), axis=2)
    inside = (local.min(axis=2) > -1e-7) & (local.sum(axis=2) < 1 + 1e-7) & (distance < tolerance)
    return inside.any(axis=1)
