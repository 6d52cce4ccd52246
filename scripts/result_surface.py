"""What is seen of the cells of a result: facets cut into flat triangles, the fields on them, and the edges of the cells."""

from dataclasses import dataclass
from math import comb

import numpy as np

# Corners of the facets of a cell, counterclockwise from outside; in 2D the cell itself.
FACETS = {2: np.array([[0, 1, 2]]), 3: np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])}
SHARP = np.cos(np.radians(30))  # facets that meet at a larger angle form an edge of the body
SAME_PLACE = 1e-9  # of the body


@dataclass
class Surface:
    points: np.ndarray  # points x 3
    triangles: np.ndarray  # triangles x 3 points
    fields: dict  # name -> points x components
    edges: np.ndarray  # edges of cells x points along them
    sharp: np.ndarray  # which of them are edges of the body


def corner_numbers(grid):
    """Cells x corners: every cell has its own points; equal numbers are the same place of the same region."""
    grain = SAME_PLACE * np.ptp(grid.points, axis=0).max()
    places = np.round(grid.points[grid.corners()] / grain)
    region = grid.cell_data.get("region", np.zeros(len(places)))
    keys = np.concatenate([np.broadcast_to(region[:, None, None], (*places.shape[:2], 1)), places], axis=2)
    return np.unique(keys.reshape(-1, 4), axis=0, return_inverse=True)[1].reshape(places.shape[:2])


def outer_facets(grid):
    """Cells and the numbers of their facets in FACETS: those that belong to one cell of a region only; in 2D all cells."""
    if grid.dimension == 2:
        return np.arange(len(grid.nodes)), np.zeros(len(grid.nodes), int)
    facets = np.sort(corner_numbers(grid)[:, FACETS[3]].reshape(-1, 3), axis=1)
    _, first, count = np.unique(facets, axis=0, return_index=True, return_counts=True)
    return np.divmod(first[count == 1], len(FACETS[3]))


def lattice(n):
    """Barycentric points of a triangle cut into n^2 triangles, those triangles, and the points along its edges."""
    points = np.array([(n - i - j, i, j) for j in range(n + 1) for i in range(n + 1 - j)])
    number = {tuple(point): k for k, point in enumerate(points)}
    upright = [((a, b, c), (a - 1, b + 1, c), (a - 1, b, c + 1)) for a, b, c in points if a > 0]
    inverted = [((a, b, c), (a - 1, b, c + 1), (a, b - 1, c + 1)) for a, b, c in points if a > 0 and b > 0]
    sides = [[(n - k, k, 0) for k in range(n + 1)], [(0, n - k, k) for k in range(n + 1)], [(k, 0, n - k) for k in range(n + 1)]]
    find = lambda rows: np.array([[number[tuple(point)] for point in row] for row in rows])
    return points / n, find(upright + inverted), find(sides)


def shape_functions(grid, barycentric):
    """Points x nodes: the Lagrange functions of the cells, whose degree and order of nodes the straight first cell shows."""
    d, nodes = grid.dimension, grid.points[grid.nodes[0]]
    degree = next(p for p in range(1, 10) if comb(p + d, d) == grid.nodes.shape[1])
    sides = (nodes[1 : d + 1] - nodes[0]).T
    inner = np.linalg.lstsq(sides, (nodes - nodes[0]).T, rcond=None)[0].T
    powers = np.round(degree * np.column_stack([1 - inner.sum(axis=1), inner]))
    monomials = lambda x: np.prod(x[:, None, :] ** powers, axis=2)
    return monomials(barycentric) @ np.linalg.inv(monomials(powers / degree))


def sharp_edges(grid, cells, facets):
    """Facets x 3 sides: of the body those between two facets at an angle, or of one facet alone."""
    corners = FACETS[grid.dimension][facets]
    a, b, c = (grid.points[grid.nodes[cells, corners[:, i]]] for i in range(3))
    normals = np.cross(b - a, c - a)
    if grid.dimension == 3:
        outwards = a - grid.points[grid.corners()[cells]].mean(axis=1)
        normals *= np.sign(np.sum(normals * outwards, axis=1))[:, None]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    vertices = np.take_along_axis(corner_numbers(grid)[cells], corners, axis=1)
    sides = np.sort(np.stack([vertices, np.roll(vertices, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    _, edge, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    edge = edge.ravel()
    total = np.zeros((len(count), 3))
    np.add.at(total, edge, np.repeat(normals, 3, axis=0))
    # The sum of two unit normals at angle a has length 2 cos(a/2).
    sharp = (count != 2) | (np.linalg.norm(total, axis=1) < 2 * np.sqrt((1 + SHARP) / 2))
    return sharp[edge]


def surface(grid, pieces):
    """The outer facets of a grid of triangles or tetrahedra, their sides cut into pieces."""
    d = grid.dimension
    cells, facets = outer_facets(grid)
    order = np.argsort(facets, kind="stable")
    cells, facets = cells[order], facets[order]
    inside, triangles, sides = lattice(pieces)
    data = {"": grid.points, **grid.point_data}
    parts = {name: [] for name in data}
    for number, corners in enumerate(FACETS[d]):
        barycentric = np.zeros((len(inside), d + 1))
        barycentric[:, corners] = inside
        functions = shape_functions(grid, barycentric)
        nodes = grid.nodes[cells[facets == number]]
        for name, values in data.items():
            parts[name].append(np.einsum("pn,cn...->cp...", functions, values[nodes].astype(float)))
    fields = {name: np.concatenate(part).reshape(-1, *part[0].shape[2:]) for name, part in parts.items()}
    first = len(inside) * np.arange(len(cells))[:, None, None]
    return Surface(fields.pop(""), (first + triangles).reshape(-1, 3), fields, (first + sides).reshape(-1, pieces + 1),
                   sharp_edges(grid, cells, facets))
