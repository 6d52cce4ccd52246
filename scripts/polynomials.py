"""Polynomials on simplices in Bernstein's basis, and linear algebra, in fractions."""

import math
from fractions import Fraction

import numpy as np


def indices(degree, n):
    """The exponents of the Bernstein polynomials of a degree in n barycentric coordinates."""
    if n == 1:
        return [(degree,)]
    return [(i, *rest) for i in range(degree, -1, -1) for rest in indices(degree - i, n - 1)]


def averages(a, b, n):
    """The averages of B^a_alpha B^b_beta over a simplex with n vertices."""
    size = math.comb(a + b, a) * math.comb(a + b + n - 1, n - 1)
    choose = lambda alpha, beta: math.prod(math.comb(x + y, x) for x, y in zip(alpha, beta))
    return np.array([[Fraction(choose(alpha, beta), size) for beta in indices(b, n)] for alpha in indices(a, n)])


def derivative(degree, n, up, down):
    """Coefficients of degree - 1 of the derivative in the direction in which lambda_up grows as lambda_down falls."""
    row = {alpha: i for i, alpha in enumerate(indices(degree - 1, n))}
    result = np.full((len(row), len(indices(degree, n))), Fraction(0))
    for column, alpha in enumerate(indices(degree, n)):
        for k, sign in ((up, 1), (down, -1)):
            if alpha[k] > 0:
                result[row[alpha[:k] + (alpha[k] - 1,) + alpha[k + 1 :]], column] += sign * degree
    return result


def reduced(matrix, n_pivots):
    """The reduced row echelon form, with pivots in the first columns only, and the columns of the pivots."""
    rows = [[Fraction(x) for x in row] for row in matrix]
    pivots = []
    for column in range(n_pivots):
        first = len(pivots)
        pivot = next((i for i in range(first, len(rows)) if rows[i][column] != 0), None)
        if pivot is None:
            continue
        rows[first], rows[pivot] = rows[pivot], rows[first]
        factor = rows[first][column]
        rows[first] = [x / factor for x in rows[first]]
        for i, row in enumerate(rows):
            if i != first and row[column] != 0:
                rows[i] = [x - row[column] * y if y else x for x, y in zip(row, rows[first])]
        pivots.append(column)
    return rows, pivots


def solve(a, b):
    """a^{-1} b."""
    rows, _ = reduced(np.hstack([a, b]), len(a))
    return np.array([row[len(a) :] for row in rows])


def null_space(matrix):
    """A basis, in rows."""
    n = matrix.shape[1]
    rows, pivots = reduced(matrix, n)
    basis = np.full((n - len(pivots), n), Fraction(0))
    for vector, free in zip(basis, sorted(set(range(n)) - set(pivots))):
        vector[free] = Fraction(1)
        for row, pivot in zip(rows, pivots):
            vector[pivot] = -row[free]
    return basis
