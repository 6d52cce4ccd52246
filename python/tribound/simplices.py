"""Lagrange simplices: functions, pieces, and the order of nodes of VTK.

A node is its barycentric multi-index: d + 1 whole numbers >= 0 whose sum is the degree.
"""

from itertools import permutations, product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribound.mesh import Floats

Integers = NDArray[np.integer[Any]]

# The sub-simplices in the order and orientation in which VTK visits them.
TRIANGLE_EDGES = [(0, 1), (1, 2), (2, 0)]
TETRAHEDRON_EDGES = [*TRIANGLE_EDGES, (0, 3), (1, 3), (2, 3)]
TETRAHEDRON_FACES = [(0, 1, 3), (2, 3, 1), (0, 3, 2), (0, 2, 1)]


def functions(nodes: Integers, barycentric: ArrayLike) -> Floats:
    """The Lagrange functions of the nodes at barycentric points (k, d + 1), as (k, nodes)."""
    degree = int(nodes[0].sum())
    at = degree * np.asarray(barycentric, float)
    values = np.ones((len(at), len(nodes)))
    for j in range(degree):  # phi_a(l) = product over i and j < a_i of (p l_i - j)/(j + 1)
        factors = (at[:, None, :] - j) / (j + 1)
        values *= np.where(nodes > j, factors, 1).prod(axis=2)
    return values


def cut(d: int, n: int) -> tuple[Integers, Integers]:
    """A d-simplex with its sides cut into n: multi-indices of the points, and n^d simplices of their numbers.

    In the coordinates y_i = a_i + ... + a_d it is n >= y_1 >= ... >= y_d >= 0, a union of some of the
    simplices into which every cube of whole numbers is cut by the paths along its edges (Kuhn).
    """
    points = np.array([a for a in product(range(n, -1, -1), repeat=d + 1) if sum(a) == n])
    number = {tuple(np.cumsum(a[:0:-1])[::-1]): k for k, a in enumerate(points)}
    simplices = []
    for corner in product(range(n), repeat=d):
        for order in permutations(range(d)):
            path = np.array(corner) + np.vstack(
                [np.zeros(d, int), np.cumsum(np.eye(d, dtype=int)[list(order)], axis=0)]
            )
            if all(tuple(y) in number for y in path):
                corners = [number[tuple(y)] for y in path]
                if np.linalg.det(np.eye(d)[list(order)]) < 0:
                    corners[-2:] = corners[:-3:-1]
                simplices.append(corners)
    return points, np.array(simplices)


def vtk_order(nodes: Integers) -> Integers:
    """For every node of VTK's Lagrange simplex, its position in `nodes`."""
    d, degree = nodes.shape[1] - 1, int(nodes[0].sum())
    base = (0,) * (d + 1)
    listed = _triangle(base, (0, 1, 2), degree) if d == 2 else _tetrahedron(base, degree)
    position = {tuple(node): i for i, node in enumerate(nodes.tolist())}
    return np.array([position[node] for node in listed])


Node = tuple[int, ...]


def _moved(base: Node, *steps: tuple[int, int]) -> Node:
    node = list(base)
    for vertex, weight in steps:
        node[vertex] += weight
    return tuple(node)


def _edge(base: Node, a: int, b: int, degree: int) -> list[Node]:
    return [_moved(base, (a, degree - j), (b, j)) for j in range(1, degree)]


def _triangle(base: Node, vertices: tuple[int, int, int], degree: int) -> list[Node]:
    """All nodes; the inner ones are a triangle of degree - 3."""
    if degree <= 0:
        return [base] if degree == 0 else []
    nodes = [_moved(base, (v, degree)) for v in vertices]
    for a, b in TRIANGLE_EDGES:
        nodes += _edge(base, vertices[a], vertices[b], degree)
    return nodes + _triangle(_moved(base, *((v, 1) for v in vertices)), vertices, degree - 3)


def _tetrahedron(base: Node, degree: int) -> list[Node]:
    """All nodes; the inner ones are a tetrahedron of degree - 4."""
    if degree <= 0:
        return [base] if degree == 0 else []
    nodes = [_moved(base, (v, degree)) for v in range(4)]
    for a, b in TETRAHEDRON_EDGES:
        nodes += _edge(base, a, b, degree)
    for face in TETRAHEDRON_FACES:
        nodes += _triangle(_moved(base, *((v, 1) for v in face)), face, degree - 3)
    return nodes + _tetrahedron(_moved(base, *((v, 1) for v in range(4))), degree - 4)
