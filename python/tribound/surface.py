"""What is seen of a level: in 2D its cells, in 3D the facets of the surface, cut into flat triangles."""


import numpy as np
from numpy.typing import NDArray

from tribound.level import Level
from tribound.mesh import Floats
from tribound.simplices import Integers, cut, functions

# Corners of what is seen of a cell: in 2D the cell itself, in 3D facet i, opposite vertex i.
SEEN = {2: np.array([[0, 1, 2]]), 3: np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])}
SHARP = np.cos(np.radians(30))  # facets that meet at a larger angle form an edge of the body


class Surface:
    """Facets f = 0, 1, ..., each with points of its own and n^2 triangles."""

    def __init__(self, level: Level, n: int) -> None:
        self.level = level
        cells, sides = outer_facets(level)
        order = np.argsort(sides, kind="stable")
        self.cells, self.sides = cells[order], sides[order]
        inside, triangles = cut(2, n)
        self._functions = []
        for corners in SEEN[level.dimension]:
            barycentric = np.zeros((len(inside), level.dimension + 1))
            barycentric[:, corners] = inside / n
            self._functions.append(functions(level.cell_node_indices, barycentric))
        first = len(inside) * np.arange(len(self.cells))[:, None, None]
        self.triangles: Integers = (first + triangles).reshape(-1, 3)
        self.facet: Integers = np.repeat(np.arange(len(self.cells)), n * n)  # of each triangle
        along = [
            [int(k) for k in np.argsort(inside[:, i]) if inside[k, 3 - i - j] == 0]
            for i, j in ((0, 1), (1, 2), (2, 0))
        ]
        self.lines: Integers = (first + np.array(along)).reshape(
            -1, n + 1
        )  # the sides of facet f: 3 f, 3 f + 1, 3 f + 2
        self.points = self.at_points(level.nodes[level.cell_nodes])

    def at_points(self, values: Floats) -> Floats:
        """The values at the points of a field given at the nodes of each cell (m, nodes, ...)."""
        parts = [
            np.einsum("pn,cn...->cp...", table, values[self.cells[self.sides == side]])
            for side, table in enumerate(self._functions)
        ]
        together = np.concatenate(parts)
        values_at: Floats = together.reshape(-1, *together.shape[2:])
        return values_at

    def corners(self) -> Integers:
        """The vertices of the facets (facets, 3)."""
        cells = self.level.mesh.cells
        vertices: Integers = np.take_along_axis(
            cells[self.cells], SEEN[self.level.dimension][self.sides], axis=1
        )
        return vertices

    def normals(self) -> Floats:
        """3D: the outer unit normals of the undeformed facets."""
        a, b, c = np.moveaxis(self.level.mesh.points[self.corners()], 1, 0)
        normals: Floats = np.cross(b - a, c - a)
        opposite = self.level.mesh.points[self.level.mesh.cells[self.cells, self.sides]]
        normals *= np.sign(np.sum(normals * (a - opposite), axis=1))[:, None]
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        return normals

    def sharp(self) -> NDArray[np.bool_]:
        """Which lines are edges of the body."""
        vertices = self.corners()
        sides = np.sort(np.stack([vertices, np.roll(vertices, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
        _, edge, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
        is_sharp: NDArray[np.bool_] = count != 2
        if self.level.dimension == 3:
            total = np.zeros((len(count), 3))
            np.add.at(total, edge, np.repeat(self.normals(), 3, axis=0))
            # The sum of two unit normals at angle a has length 2 cos(a/2).
            is_sharp |= np.linalg.norm(total, axis=1) < 2 * np.sqrt((1 + SHARP) / 2)
        return is_sharp[edge]


def outer_facets(level: Level) -> tuple[Integers, Integers]:
    """Cells and the numbers of their facets in SEEN: those of one cell alone; in 2D all cells."""
    cells = level.mesh.cells
    if level.dimension == 2:
        return np.arange(len(cells)), np.zeros(len(cells), int)
    facets = np.sort(cells[:, SEEN[3]].reshape(-1, 3), axis=1)
    _, first, count = np.unique(facets, axis=0, return_index=True, return_counts=True)
    outer = first[count == 1]
    return outer // 4, outer % 4


def von_mises(stress: Floats) -> Floats:
    """(3/2 dev s : dev s)^(1/2) of (..., 6) tensors xx yy zz xy yz xz."""
    xx, yy, zz, xy, yz, xz = np.moveaxis(stress, -1, 0)
    stresses: Floats = np.sqrt(
        0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + xz**2)
    )
    return stresses
