"""Matrices with bounds of their errors, and a proof by floating-point numbers that one is positive semidefinite.

Each operation bounds its own rounding: the error of an inner product of n terms, summed in any order, is at most
gamma_n = n u / (1 - n u) times that of the absolute values.
"""

import math
from fractions import Fraction

import numpy as np
import scipy.linalg
import scipy.sparse

UNIT = 2.0**-53


def gamma(n):
    """Twice gamma_n, so that it also covers the rounding of the bounds themselves."""
    return 2 * n * UNIT / (1 - n * UNIT)


class Ball:
    """All matrices whose entries differ from those of `mid` by at most `rad`."""

    def __init__(self, mid, rad):
        self.mid, self.rad = mid, rad

    @staticmethod
    def of(exact):
        """The nearest doubles to an array of fractions."""
        mid = np.array(exact, dtype=float)
        return Ball(mid, gamma(1) * abs(mid))

    @staticmethod
    def root(square: Fraction):
        mid = np.array(math.sqrt(square))
        return Ball(mid, gamma(3) * mid)

    @staticmethod
    def float(mid):
        """A matrix that is what it is."""
        return Ball(mid, 0 * abs(mid))

    @property
    def T(self):
        return Ball(self.mid.T, self.rad.T)

    def __add__(self, other):
        mid = self.mid + other.mid
        return Ball(mid, self.rad + other.rad + gamma(2) * abs(mid))

    def __mul__(self, number):
        """Times a number: a Ball of one, a fraction, or a float that is what it is."""
        if not isinstance(number, Ball):
            number = Ball.of(number) if isinstance(number, Fraction) else Ball.float(np.array(float(number)))
        mid, size = self.mid * float(number.mid), abs(float(number.mid))
        return Ball(mid, self.rad * (size + float(number.rad)) + abs(self.mid) * float(number.rad) + gamma(2) * abs(mid))

    def __matmul__(self, other):
        a, b = abs(self.mid), abs(other.mid)
        sparse = scipy.sparse.issparse(self.mid)
        rounding = gamma(1 + (self.mid.getnnz(axis=1).max() if sparse else self.mid.shape[1]))
        return Ball(self.mid @ other.mid, a @ (other.rad + rounding * b) + self.rad @ (b + other.rad))


def assemble(parts, shape):
    """The sparse sum of (rows, columns, Ball) as dense blocks."""
    if not parts:
        return Ball.float(scipy.sparse.csr_matrix(shape))
    rows = np.concatenate([np.repeat(r, len(c)) for r, c, _ in parts])
    columns = np.concatenate([np.tile(c, len(r)) for r, c, _ in parts])

    def total(values):
        return scipy.sparse.csr_matrix((np.concatenate([v.ravel() for v in values]), (rows, columns)), shape)

    most = total([np.ones(part.mid.shape) for _, _, part in parts]).max()
    rounding = gamma(most) * total([abs(part.mid) for _, _, part in parts])
    return Ball(total([part.mid for _, _, part in parts]), total([part.rad for _, _, part in parts]) + rounding)


def is_positive_semidefinite(matrix, columns, similar, blocks):
    """True proves matrix + columns columns^T positive semidefinite for all symmetric members; False proves nothing.

    Cholesky's method for A - c I does not fail only if A is, where c bounds its rounding errors: gamma_{n+1} times the trace
    [Rum06]. First a congruence, which changes no sign, makes the diagonal blocks of `similar` between the indices
    `blocks` similar to the identity.
    """
    inverses = []
    for begin, end in zip(blocks, blocks[1:]):
        block = similar.mid[begin:end, begin:end].toarray()
        values, vectors = np.linalg.eigh((block + block.T) / 2)
        values = np.maximum(values, 1e-10 * values[-1])
        inverses.append(vectors / np.sqrt(values))
    scale = Ball.float(scipy.sparse.block_diag(inverses, format="csr"))
    scaled = scale.T @ matrix @ scale
    error = max(scaled.rad.sum(axis=0).max(), scaled.rad.sum(axis=1).max())
    dense = scaled.mid.toarray()
    dense = (dense + dense.T) / 2
    n = len(dense)
    columns = scale.T @ columns
    size, distance = np.linalg.norm(columns.mid), np.linalg.norm(columns.rad)
    dense += columns.mid @ columns.mid.T
    error += distance * (2 * size + distance) + gamma(n + 2) * size**2
    trace = abs(dense.diagonal()).sum()
    dense[np.diag_indices(n)] -= 2 * (error + gamma(n + 3) * trace) + 1e-200
    try:
        scipy.linalg.cholesky(dense, lower=True, overwrite_a=True, check_finite=True)
    except scipy.linalg.LinAlgError:
        return False
    return True
