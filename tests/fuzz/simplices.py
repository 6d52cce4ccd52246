"""Bernstein polynomials, quadrature and subdivision on simplices, in barycentric coordinates.

A part of a simplex with k + 1 vertices is the matrix of its vertices' barycentric coordinates; rules on parts are flat lists.
"""

from functools import cache
from itertools import product
from math import factorial

import numpy as np


@cache
def lattice(n_vertices, degree):
    """The exponents alpha with |alpha| = degree: nodes of P^degree, times degree."""
    rows = [a for a in product(range(degree + 1), repeat=n_vertices) if sum(a) == degree]
    return np.array(rows, dtype=np.int64)


def bernstein(points, degree):
    """B_alpha = degree!/alpha! lambda^alpha at barycentric points: points x functions."""
    exponents = lattice(points.shape[1], degree)
    powers = np.stack([points**k for k in range(degree + 1)])  # exponent x point x vertex
    values = np.ones((len(points), len(exponents)))
    for i in range(points.shape[1]):
        values *= powers[exponents[:, i], :, i].T
    return values * multinomials(points.shape[1], degree)


@cache
def multinomials(n_vertices, degree):
    return np.array([factorial(degree) / np.prod([factorial(k) for k in a]) for a in lattice(n_vertices, degree).tolist()])


def bernstein_gradients(points, degree):
    """Derivatives in the barycentric coordinates: points x functions x vertices; d_i B_alpha = degree B_(alpha - e_i)."""
    n_vertices = points.shape[1]
    lower = bernstein(points, degree - 1)
    number = {tuple(a): k for k, a in enumerate(lattice(n_vertices, degree - 1).tolist())}
    gradients = np.zeros((len(points), len(lattice(n_vertices, degree)), n_vertices))
    for k, alpha in enumerate(lattice(n_vertices, degree).tolist()):
        for i in range(n_vertices):
            if alpha[i]:
                alpha[i] -= 1
                gradients[:, k, i] = degree * lower[:, number[tuple(alpha)]]
                alpha[i] += 1
    return gradients


@cache
def rule(k, degree):
    """Barycentric points and weights (of sum 1) on the k-simplex, Gauss points under Duffy's map; exact up to `degree`."""
    n = (degree + k) // 2 + 1
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    points, weights = [], []
    for index in product(range(n), repeat=k):
        rest, weight, point = 1.0, float(factorial(k)), []
        for axis, i in enumerate(index):
            point.append(rest * x[i])
            weight *= w[i] * (1 - x[i]) ** (k - 1 - axis)
            rest *= 1 - x[i]
        points.append([rest, *point])
        weights.append(weight)
    return np.array(points), np.array(weights)


@cache
def bisected(k, levels):
    """The simplex divided into 2^(k levels) parts of equal volume: parts x vertices x barycentric."""
    parts = np.eye(k + 1)[None]
    for _ in range(k * levels):
        parts = halved(parts)
    return parts


def halved(parts):
    """Every part cut at the midpoint of its longest edge; lengths are in barycentric coordinates."""
    n = parts.shape[1]
    pairs = np.array([(i, j) for i in range(n) for j in range(i)])
    lengths = np.linalg.norm(parts[:, pairs[:, 0]] - parts[:, pairs[:, 1]], axis=2)
    i, j = pairs[np.argmax(lengths, axis=1)].T
    return np.concatenate(split(parts, i, j, np.full(len(parts), 0.5)))


def split(parts, i, j, t):
    """The two parts left and right of the point v_i + t (v_j - v_i) of edge ij."""
    rows = np.arange(len(parts))
    cut = parts[rows, i] + t[:, None] * (parts[rows, j] - parts[rows, i])
    first, second = parts.copy(), parts.copy()
    first[rows, j] = cut
    second[rows, i] = cut
    return first, second


def cut(owners, parts, level_function):
    """Parts cut where the function, taken as linear on each part, changes sign. level_function(owners, points) -> values."""
    n_parts, n = parts.shape[:2]
    values = level_function(np.repeat(owners, n), parts.reshape(n_parts * n, -1)).reshape(n_parts, n)
    values = np.where(np.isfinite(values), values, 0.0)
    values[np.abs(values) < 1e-13 * np.abs(values).max(initial=0.0)] = 0.0
    while True:
        low, high = values.argmin(axis=1), values.argmax(axis=1)
        rows = np.arange(len(parts))
        crossing = (values[rows, low] < 0) & (values[rows, high] > 0)
        if not crossing.any():
            return owners, parts
        rows, low, high = np.arange(crossing.sum()), low[crossing], high[crossing]
        inside = values[crossing]
        t = inside[rows, low] / (inside[rows, low] - inside[rows, high])
        first, second = split(parts[crossing], low, high, t)
        first_values, second_values = inside.copy(), inside
        first_values[rows, high] = 0.0
        second_values[rows, low] = 0.0
        parts = np.concatenate([parts[~crossing], first, second])
        values = np.concatenate([values[~crossing], first_values, second_values])
        owners = np.concatenate([owners[~crossing], owners[crossing], owners[crossing]])


def composite(owners, parts, degree):
    """The rule on all parts: owner of each point, barycentric point, weight (as a share of the owner)."""
    k = parts.shape[1] - 1
    points, weights = rule(k, degree)
    # A part's share of its simplex is the determinant of its barycentric coordinates, since their rows add up to 1.
    shares = np.abs(np.linalg.det(parts))
    all_points = np.einsum("qv,pvc->pqc", points, parts).reshape(-1, parts.shape[2])
    return np.repeat(owners, len(weights)), all_points, np.outer(shares, weights).ravel()
