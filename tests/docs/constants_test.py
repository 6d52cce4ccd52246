#!/usr/bin/python3
"""Tests the proof of the Poincare-Korn constants (scripts/constants): of triangles it is repeated.

    constants_test.py ROOT
"""

import importlib.machinery
import importlib.util
import sys
import unittest
from fractions import Fraction
from pathlib import Path

import numpy as np

SCRIPTS = Path(sys.argv.pop(1)) / "scripts"
sys.path.insert(0, str(SCRIPTS))

from hill_simplex import HillSimplex  # noqa: E402
from polynomials import averages, indices, null_space  # noqa: E402
from verified import Ball, assemble, is_positive_semidefinite  # noqa: E402

loader = importlib.machinery.SourceFileLoader("constants", str(SCRIPTS / "constants"))
constants = importlib.util.module_from_spec(importlib.util.spec_from_loader("constants", loader))
sys.modules["constants"] = constants
loader.exec_module(constants)


class Proof(unittest.TestCase):
    def test_constants_of_triangles_are_proven(self):
        for shape in constants.SHAPES:
            if shape.d == 2:
                self.assertEqual(constants.prove(shape, constants.in_header()[shape.name]), [])

    def test_smaller_constants_are_not(self):
        """Those of polynomials of degree 8 on half a square are 0.610 and 3.17: no smaller ones can be proven."""
        prover = constants.Prover(constants.Shape("", 2, Fraction(0), 3, 4, 0.3))
        self.assertTrue(prover.cell_holds(0.8, 5.0))
        self.assertFalse(prover.cell_holds(0.61, 5.0))
        self.assertFalse(prover.boundary_holds(3.17))

    def test_all_shapes_are_in_the_header(self):
        self.assertEqual({shape.name for shape in constants.SHAPES}, set(constants.in_header()))


class Forms(unittest.TestCase):
    def moments(self, d, a, k):
        """A random w of degree k + 2 on one cell, R w and the moments of w on the facets."""
        rich, plain = HillSimplex(d, a, k + 1, 1), HillSimplex(d, a, k, 1)
        n = d * rich.n_cell
        energy, mass = (form.mid[:n, :n].toarray() for form in (rich.energy, rich.volume))
        raise_degree = np.linalg.solve(
            np.array(averages(k + 2, k + 2, d + 1), dtype=float), np.array(averages(k + 2, k + 1, d + 1), dtype=float)
        )
        raised = np.kron(np.eye(d), raise_degree)
        w = np.random.default_rng(d).standard_normal(n)
        rigid = rich.rigid.mid[:n]
        of_rigid = raised.T @ mass @ rigid
        n_rigid = rigid.shape[1]
        system = np.block([[raised.T @ energy @ raised, of_rigid], [of_rigid.T, np.zeros((n_rigid, n_rigid))]])
        right = np.concatenate([raised.T @ energy @ w, rigid.T @ mass @ w])
        x = np.zeros(plain.n)
        x[: d * plain.n_cell] = np.linalg.solve(system, right)[: d * plain.n_cell]
        low = np.array(averages(k, k, d), dtype=float)
        project = np.linalg.solve(low, np.array(averages(k, k + 2, d), dtype=float))
        places = {alpha: i for i, alpha in enumerate(indices(k + 2, d + 1))}
        (_, points) = plain.cells[0]
        for facet in range(d + 1):
            trace = [places[alpha[:facet] + (0,) + alpha[facet:]] for alpha in indices(k + 2, d)]
            for i in range(d):
                unknowns = plain.of_facet(points[:facet] + points[facet + 1 :], i)
                x[unknowns] = project @ w[i * rich.n_cell + np.array(trace)]
        return plain, x, w @ energy @ w

    def test_constraints_hold_for_moments_of_other_functions(self):
        for d, a in ((2, Fraction(0)), (2, Fraction(-1, 2)), (3, Fraction(0)), (3, Fraction(-1, 3))):
            forms, x, energy = self.moments(d, a, 2)
            self.assertGreater(x @ forms.jumps.mid @ x, 1e-3 * energy)
            self.assertLess(x @ forms.energy.mid @ x, 0.99 * energy)
            rounding = 1e-14 * (abs(x) @ abs(forms.penalty.mid) @ abs(x))
            self.assertLess(x @ forms.penalty.mid @ x, rounding)

    def test_cells_fill_the_simplex(self):
        for d, a, m in ((2, Fraction(-1, 2), 4), (3, Fraction(0), 2)):
            forms = HillSimplex(d, a, 2, m)
            one = forms.rigid.mid[:, 0]  # the translation with w . v_1 = 1, others 0
            metric = float(forms.cell.metric[0][0])
            self.assertAlmostEqual(one @ forms.volume.mid @ one, metric)
            for facet, measure in zip(forms.facets, forms.cell.measures):
                self.assertAlmostEqual(one @ facet.mid @ one, metric * float(measure.mid))
            rigid = forms.rigid.mid
            self.assertLess(abs(forms.energy.mid @ rigid).max(), 1e-14)


class Balls(unittest.TestCase):
    def test_they_contain_the_exact_result(self):
        random = np.random.default_rng(1)
        exact = [[[Fraction(int(x), 97) for x in row] for row in random.integers(-99, 99, (9, 9))] for _ in range(3)]
        a, b, c = (np.array(matrix) for matrix in exact)
        third = Fraction(1, 3)
        found = (Ball.of(a) @ Ball.of(b) + Ball.of(c)) * third
        error = (a @ b + c) * third - np.array([[Fraction(x) for x in row] for row in found.mid])
        self.assertTrue((abs(error) <= found.rad).all())
        self.assertLess(found.rad.max(), 1e-9)

    def test_sums_of_parts(self):
        part = Ball.of(np.array([[Fraction(1, 3)]]))
        index = np.array([0])
        found = assemble([(index, index, part)] * 3, (1, 1))
        self.assertLessEqual(abs(Fraction(found.mid[0, 0]) - 1), Fraction(found.rad[0, 0]))

    def test_definiteness(self):
        random = np.random.default_rng(2)
        root = random.standard_normal((8, 8))
        for least, expected in ((1e-6, True), (-1e-6, False)):
            vectors, _ = np.linalg.qr(root)
            matrix = vectors @ np.diag([least, 1, 2, 3, 4, 5, 6, 7]) @ vectors.T
            index = np.arange(8)
            ball, identity = (assemble([(index, index, Ball.float(x))], (8, 8)) for x in (matrix, np.eye(8)))
            nothing = Ball.float(np.zeros((8, 1)))
            self.assertEqual(is_positive_semidefinite(ball, nothing, identity, [0, 4, 8]), expected)


class Polynomials(unittest.TestCase):
    def test_null_space(self):
        matrix = np.array([[Fraction(1), Fraction(2), Fraction(3)], [Fraction(2), Fraction(4), Fraction(7)]])
        basis = null_space(matrix)
        self.assertEqual(basis.shape, (1, 3))
        self.assertTrue((matrix @ basis.T == 0).all())


if __name__ == "__main__":
    unittest.main()
