"""Errors of fields on nested meshes of simplices, with NumPy alone: this shares nothing with the program.

Plane problems are those of plane strain. Of a body of revolution the mesh is the meridian, and integrals are
those over the full circle.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
BATCH = 2000  # cells at a time
TENSOR = {2: [[0, 3], [3, 1]], 3: [[0, 3, 5], [3, 1, 4], [5, 4, 2]]}  # of xx yy zz xy yz xz


@dataclass
class Fields:
    """Polynomials on simplices by their values at the nodes, whose order is the same in all cells."""

    corners: Floats  # (cells, d + 1, d)
    indices: NDArray[np.int32]  # (nodes, d + 1): barycentric coordinates of the nodes, times the degree
    displacement: Floats  # (cells, nodes, d)
    stress: Floats | None = None  # (cells, nodes, 6): xx yy zz xy yz xz

    @property
    def degree(self) -> int:
        return int(self.indices[0].sum())


@dataclass
class Squares:
    """Squared errors of each of their cells in the energy norm, and of their stress in the dual one."""

    displacement: Floats
    stress: Floats | None


class Polynomials:
    """Lagrange functions on a simplex, from the monomials of all barycentric coordinates but the first."""

    def __init__(self, indices: NDArray[np.int32]) -> None:
        d = indices.shape[1] - 1
        p = int(indices[0].sum())
        powers = np.array(np.meshgrid(*[range(p + 1)] * d)).reshape(d, -1).T
        self.powers = powers[powers.sum(axis=1) <= p]
        self.coefficients = np.linalg.inv(self._monomials(indices[:, 1:] / p))

    def _monomials(self, x: Floats) -> Floats:
        return np.asarray(np.prod(x[..., None, :] ** self.powers, axis=-1))

    def values(self, x: Floats) -> Floats:
        """(..., functions) for points (..., d)."""
        return self._monomials(x) @ self.coefficients

    def gradients(self, x: Floats) -> Floats:
        """(..., functions, d)."""
        parts = []
        for k in range(x.shape[-1]):
            lower = np.maximum(self.powers - (np.arange(x.shape[-1]) == k), 0)
            slopes = self.powers[:, k] * np.prod(x[..., None, :] ** lower, axis=-1)
            parts.append(slopes @ self.coefficients)
        return np.stack(parts, axis=-1)


def rule(d: int, n: int) -> tuple[Floats, Floats]:
    """A Gauss rule on the reference simplex, by collapsing a cube."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    grid = np.stack(np.meshgrid(*[x] * d, indexing="ij"), axis=-1).reshape(-1, d)
    weights = np.prod(np.stack(np.meshgrid(*[w] * d, indexing="ij"), axis=-1).reshape(-1, d), axis=1)
    points = np.empty_like(grid)
    rest = np.ones(len(grid))
    for k in range(d):
        points[:, k] = rest * grid[:, k]
        weights = weights * rest
        rest = rest * (1 - grid[:, k])
    return points, weights


def parents(coarse: Floats, fine: Floats) -> Ints:
    """In which coarse cell each fine one lies, both by their corners; raises where meshes are not nested."""
    centres = fine.mean(axis=1)
    order = np.argsort(centres[:, 0])
    along = centres[order, 0]
    inverse = np.linalg.inv(coarse[:, 1:] - coarse[:, :1])
    parent = np.full(len(fine), -1)
    for cell, corners in enumerate(coarse):
        first, last = np.searchsorted(along, [corners[:, 0].min(), corners[:, 0].max()])
        near = order[first:last]
        local = (centres[near] - corners[0]) @ inverse[cell]
        parent[near[(local > 0).all(axis=1) & (local.sum(axis=1) < 1)]] = cell
    whole, part = (np.abs(np.linalg.det(cells[:, 1:] - cells[:, :1])) for cells in (coarse, fine))
    if parent.min() < 0 or not np.allclose(np.bincount(parent, part, len(coarse)), whole, rtol=1e-9):
        raise ValueError("the fine mesh is no refinement of the coarse one")
    return parent


def squared_errors(
    theirs: Fields, reference: Fields, E: float | Floats, nu: float | Floats, of_revolution: bool = False,
    initial: Callable[[Floats, Ints], Floats] | None = None,
) -> Squares:
    """||v - u||^2 and ||s - sigma(u)||^2 per cell; E and nu may be those of each of their cells.

    initial: the initial stress at points (cells, points, d), of which cells of theirs.
    """
    constants = (E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu))
    lame, mu = (np.broadcast_to(constant, len(theirs.corners)) for constant in constants)
    parent = parents(theirs.corners, reference.corners)
    squares = np.zeros((2, len(theirs.corners)))
    for first in range(0, len(parent), BATCH):
        cells = slice(first, first + BATCH)
        own = parent[cells]
        batch = _batch(theirs, reference, cells, own, lame[own], mu[own], of_revolution, initial)
        for total, square in zip(squares, batch):
            np.add.at(total, own, square)
    return Squares(squares[0], None if theirs.stress is None else squares[1])


def _batch(
    theirs: Fields, reference: Fields, cells: slice, own: Ints, lame: Floats, mu: Floats, of_revolution: bool,
    initial: Callable[[Floats, Ints], Floats] | None,
) -> list[Floats]:
    """The squares over each of these cells of the reference, which lie in `own` of theirs."""
    corners, outer = reference.corners[cells], theirs.corners[own]
    d = corners.shape[2]
    edges, inverse = corners[:, 1:] - corners[:, :1], np.linalg.inv(outer[:, 1:] - outer[:, :1])
    x, weights = rule(d, max(theirs.degree, reference.degree) + d - 1 + 10 * of_revolution)
    points = corners[:, :1] + x @ edges
    local = (points - outer[:, :1]) @ inverse
    here, there = Polynomials(reference.indices), Polynomials(theirs.indices)
    strain = _strain(here.gradients(x)[None], reference.displacement[cells], np.linalg.inv(edges))
    their_strain = _strain(there.gradients(local), theirs.displacement[own], inverse)
    measure = np.abs(np.linalg.det(edges))[:, None] * weights
    if of_revolution:
        d, r = 3, points[..., 0]
        strain = _with_hoop(strain, (reference.displacement[cells][..., 0] @ here.values(x).T) / r)
        u_r = np.einsum("cqn,cn->cq", there.values(local), theirs.displacement[own][..., 0])
        their_strain = _with_hoop(their_strain, u_r / r)
        measure = 2 * np.pi * r * measure
    difference = their_strain - strain
    lame, mu = lame[:, None, None, None], mu[:, None, None, None]
    densities = [difference * (lame * _trace(difference) + 2 * mu * difference)]
    if theirs.stress is not None:
        stress = np.einsum("cqn,cnij->cqij", there.values(local), theirs.stress[own][..., TENSOR[d]])
        stress = stress - lame * _trace(strain) - 2 * mu * strain
        if initial is not None:
            stress = stress - initial(points, own)
        densities.append(stress * (stress - lame / (d * lame + 2 * mu) * _trace(stress)) / (2 * mu))
    return [(measure * density.sum(axis=(2, 3))).sum(axis=1) for density in densities]


def _with_hoop(strain: Floats, hoop: Floats) -> Floats:
    whole = np.zeros((*hoop.shape, 3, 3))
    whole[..., :2, :2], whole[..., 2, 2] = strain, hoop
    return whole


def _strain(gradients: Floats, displacement: Floats, inverse: Floats) -> Floats:
    slopes = np.einsum("cnd,cqnj->cqdj", displacement, gradients @ np.swapaxes(inverse, 1, 2)[:, None])
    return np.asarray((slopes + np.swapaxes(slopes, 2, 3)) / 2)


def _trace(tensor: Floats) -> Floats:
    """The trace times the identity."""
    d = tensor.shape[-1]
    return np.asarray(np.trace(tensor, axis1=2, axis2=3)[..., None, None] * np.eye(d))
