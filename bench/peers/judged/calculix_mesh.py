"""Triangles or tetrahedra as a deck of CalculiX: second-order elements with straight edges."""

from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

import meshio
import numpy as np
import numpy.typing as npt

RING = ((0, 1), (1, 2), (2, 0))
# Per dimension: cells, facets, element, edges in the order of its middle nodes, faces S1, S2, ... by corners.
SHAPES = {
    2: ("triangle", "line", "CPE6", RING, RING),
    3: ("tetra", "triangle", "C3D10", (*RING, (0, 3), (1, 3), (2, 3)), ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))),
}


def _lines(numbers: Sequence[int] | npt.NDArray[np.int64]) -> list[str]:
    """Numbers in lines of at most 16, as CalculiX wants them."""
    return [", ".join(map(str, numbers[k : k + 16])) for k in range(0, len(numbers), 16)]


class Deck:
    """Nodes and elements of mesh.msh, numbered from 1, and its boundaries by name."""

    def __init__(self, file: Path) -> None:
        mesh = meshio.read(file)
        self.dim = 3 if "tetra" in mesh.cells_dict else 2
        cell, facet, self.element, edges, self.faces = SHAPES[self.dim]
        self.cells = mesh.cells_dict[cell].copy()
        sides = mesh.points[self.cells[:, 1:]] - mesh.points[self.cells[:, :1]]
        turned = np.linalg.det(sides[:, : self.dim, : self.dim]) < 0
        self.cells[turned, :2] = self.cells[turned, 1::-1]
        pairs = np.sort(np.concatenate([self.cells[:, edge] for edge in edges]), axis=1)
        unique, middle = np.unique(pairs, axis=0, return_inverse=True)
        self.middles = {tuple(pair): len(mesh.points) + k for k, pair in enumerate(unique.tolist())}
        self.nodes = np.concatenate([mesh.points, mesh.points[unique].mean(axis=1)])
        self.elements = np.column_stack([self.cells, len(mesh.points) + middle.reshape(len(edges), -1).T])
        groups = mesh.cell_data_dict["gmsh:physical"]
        named = {name: number for name, (number, dimension) in mesh.field_data.items() if dimension < self.dim}
        self.facets = {name: mesh.cells_dict[facet][groups[facet] == number] for name, number in named.items()}

    def lines(self) -> list[str]:
        """The mesh; a node set and a surface for every boundary."""
        text = ["*NODE, NSET=BODY"]
        text += [f"{k}, " + ", ".join(f"{x:.12g}" for x in node) for k, node in enumerate(self.nodes, 1)]
        text += [f"*ELEMENT, TYPE={self.element}, ELSET=BODY"]
        text += [f"{k}, " + ", ".join(map(str, element + 1)) for k, element in enumerate(self.elements, 1)]
        sides = {frozenset(cell[list(face)].tolist()): f"{k}, S{side}"
                 for k, cell in enumerate(self.cells, 1) for side, face in enumerate(self.faces, 1)}
        for name, facets in self.facets.items():
            word = name.replace(".", "_").upper()
            nodes = sorted({node + 1 for facet in facets.tolist() for node in [*facet, *self._edge_middles(facet)]})
            text += [f"*NSET, NSET={word}", *_lines(nodes), f"*SURFACE, NAME=S_{word}"]
            text += [sides[frozenset(facet)] for facet in facets.tolist()]
        return text

    def _edge_middles(self, facet: Sequence[int]) -> list[int]:
        return [self.middles[pair] for pair in combinations(sorted(facet), 2)]

    def traction(self, boundary: str, direction: int, value: float) -> list[str]:
        """A uniform traction as forces, plane problems of thickness 1: surface loads act along the normal only."""
        weights = self._weights(boundary)
        lines = (f"{node + 1}, {direction}, {weight * value:.12g}" for node, weight in sorted(weights.items()))
        return ["*CLOAD", *lines]

    def mean(self, boundary: str, values: npt.NDArray[np.float64]) -> float:
        """Of a field at the nodes, over a boundary of a plane problem."""
        weights = self._weights(boundary)
        return float(sum(weight * values[node] for node, weight in weights.items())) / sum(weights.values())

    def _weights(self, boundary: str) -> dict[int, float]:
        """Integrals of the functions of the nodes over a boundary of a plane problem."""
        weights: dict[int, float] = {}
        for a, b in self.facets[boundary].tolist():
            length = float(np.linalg.norm(self.nodes[a] - self.nodes[b]))
            for node, share in ((a, 1 / 6), (b, 1 / 6), (self._edge_middles([a, b])[0], 4 / 6)):
                weights[node] = weights.get(node, 0) + share * length
        return weights


def rigid_ring(name: str, inner: float, outer: float, edges: int) -> list[str]:
    """A quarter of a ring about the origin, one layer of elements, its outside as a surface: to be fixed."""
    first = 900001
    angles = np.linspace(0, np.pi / 2, edges + 1)
    text = [f"*NODE, NSET={name}"]
    for k, angle in enumerate(angles):
        for side, radius in enumerate((inner, outer)):
            text.append(f"{first + 2 * k + side}, {radius * np.cos(angle):.12g}, {radius * np.sin(angle):.12g}")
    text.append(f"*ELEMENT, TYPE=CPE4, ELSET={name}")
    for k in range(edges):
        start = first + 2 * k
        text.append(f"{first + k}, {start}, {start + 1}, {start + 3}, {start + 2}")
    return [*text, f"*SURFACE, NAME=S_{name}", f"{name}, S2"]
