"""Runs, levels and results."""

import json
import tempfile
import unittest
from pathlib import Path

import numpy as np
import tribound as tb

from small_cases import block, solved, two_boxes


class Run(unittest.TestCase):
    def test_results_are_those_of_the_files(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            result = tb.run(block(2, 2), directory=directory)
            self.assertEqual(result.directory, Path(directory))
            written = json.loads((Path(directory) / "certificate.json").read_text())
            self.assertEqual(result.certificate, written)
            for name in ("case.toml", "convergence.csv", "contact.csv", "adapted.msh", "series.pvd"):
                self.assertTrue((Path(directory) / name).exists(), name)
        self.assertEqual(result.bound, result.level.bound)
        self.assertEqual(result.relative, result.level.relative)
        self.assertEqual(result.to_dict(), result.certificate)
        self.assertAlmostEqual(result.certificate["sigma_norm"] * result.relative, result.bound)

    def test_temporary_files_go_with_the_result(self) -> None:
        result = tb.run(block(2, 2))
        directory = result.directory
        self.assertTrue((directory / "certificate.json").exists())
        del result
        self.assertFalse(directory.exists())

    def test_not_certified_is_no_exception(self) -> None:
        result = tb.run(block(2, 2), set={"adapt.max_levels": 2})
        self.assertEqual(result.status, "budget")
        self.assertFalse(result.is_certified)
        self.assertIn("adapt.max_levels", result.reason)

    def test_nor_is_a_failure_of_newtons_method(self) -> None:
        result = tb.run(block(2, 2), set={"newton.max_steps": 1})
        self.assertEqual(result.status, "failed")
        self.assertIn("newton.max_steps", result.reason)
        with self.assertRaisesRegex(ValueError, "newton.max_steps"):
            result.level

    def test_keep_levels(self) -> None:
        result = tb.run(block(2, 2), keep_levels=True)
        self.assertEqual([level.number for level in result.levels], list(range(len(result.levels))))
        self.assertEqual([level.record["cells"] for level in result.levels], [len(level.eta) for level in result.levels])
        self.assertEqual([e["level"] for e in result.certificate["levels"]], [level.number for level in result.levels])
        self.assertEqual(len(tb.run(block(2, 2)).levels), 1)

    def test_levels_as_they_come(self) -> None:
        seen = list(tb.levels(block(2, 2)))
        expected = tb.run(block(2, 2), keep_levels=True).levels
        self.assertEqual({level.number for level in seen}, {level.number for level in expected})
        np.testing.assert_allclose(seen[-1].displacement, expected[-1].displacement, atol=1e-9)

    def test_leaving_the_loop_ends_the_run(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            for level in tb.levels(block(2, 2), directory=directory):
                if level.number == 1:
                    break
            certificate = json.loads((Path(directory) / "certificate.json").read_text())
        self.assertEqual(certificate["status"], "budget")
        self.assertIn("interrupted", certificate["reason"])
        self.assertEqual(certificate["levels"][-1]["level"], 1)
        self.assertTrue(tb.run(block(2, 2)).is_certified)  # the next is not disturbed

    def test_history_steps_as_they_come(self) -> None:
        case = block(2, 1, history={"steps": [0.25, 0.5, 1.0]}, adapt={"tolerance": 0.5})
        case["boundary"]["top"] = {"traction": [0, "-0.1*t"]}
        steps = list(tb.levels(case))
        self.assertEqual([step.t for step in steps[-3:]], [0.25, 0.5, 1.0])
        for step in steps:
            assert step.t is not None
            self.assertAlmostEqual(step.resultant("top").force[1], -0.2 * step.t, places=12)

    def test_restart(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            first = tb.run(block(2, 2, output={"checkpoint": True}), directory=directory, set={"adapt.max_levels": 3})
            self.assertEqual(first.status, "budget")
            second = tb.run(None, restart=directory, set={"adapt.max_levels": 12})
            self.assertTrue(second.is_certified)
            self.assertEqual(second.certificate["levels"][0]["level"], 0)

    def test_wrong_arguments(self) -> None:
        for arguments in ((None,), (block(2, 2), tb.Mesh.box([0, 0], [1, 1], [1, 1]))):
            with self.assertRaises(TypeError):
                tb.run(*arguments, restart=None if arguments[0] is None else "somewhere")

    def test_verbose(self) -> None:
        import contextlib
        import io

        for verbose in (False, True):
            with contextlib.redirect_stdout(io.StringIO()) as text:
                tb.run(block(2, 2), verbose=verbose)
            self.assertEqual("certified" in text.getvalue(), verbose)


class OwnParts(unittest.TestCase):
    def test_observers(self) -> None:
        levels: list[int] = []
        steps: list[tb.Step] = []
        tb.run(block(2, 2), on_level=lambda level: levels.append(level.number), on_step=steps.append)
        self.assertEqual(levels, sorted(levels))
        self.assertEqual(steps[0].number, 1)
        self.assertTrue(all(step.residual >= 0 and step.seconds >= 0 for step in steps))

    def test_marking(self) -> None:
        everything = tb.run(block(2, 1), mark=lambda level: np.ones(len(level.eta), bool), set={"adapt.max_levels": 2})
        uniform = tb.run(block(2, 1), set={"adapt.marking": "uniform", "adapt.max_levels": 2})
        self.assertEqual(len(everything.level.eta), len(uniform.level.eta))
        numbers = tb.run(block(2, 1), mark=lambda level: [0, 5, 5], set={"adapt.max_levels": 2})
        self.assertLess(len(numbers.level.eta), len(uniform.level.eta))

    def test_wrong_markings(self) -> None:
        for cells, error in (([10**6], IndexError), ([-1], IndexError), (["a"], TypeError), ([0.5], TypeError)):
            with self.assertRaises(error):
                tb.run(block(2, 2), mark=lambda level: cells)
        for too_many in (-1, 1):
            with self.assertRaisesRegex(IndexError, "truth values for 64 cells"):
                tb.run(block(2, 2), mark=lambda level: np.zeros(len(level.eta) + too_many, bool))

    def test_stopping_rule(self) -> None:
        result = tb.run(block(2, 2), stop=lambda level: level.number == 1 and "enough is seen")
        self.assertEqual(result.status, "budget")
        self.assertIn("enough is seen", result.reason)
        self.assertEqual(result.level.number, 1)

    def test_exceptions_of_observers_arrive(self) -> None:
        for name in ("on_level", "on_step", "mark", "stop"):
            with self.assertRaises(ZeroDivisionError):
                tb.run(block(2, 2), **{name: lambda _: 1 / 0})


class Levels(unittest.TestCase):
    def test_arrays_show_and_keep_the_solution(self) -> None:
        for dimension, degree in ((2, 1), (2, 3), (3, 1), (3, 2)):
            with self.subTest(dimension=dimension, degree=degree):
                result = tb.run(block(dimension, degree))
                level = result.level
                displacement = level.displacement
                corners = level.cell_nodes[:, [int(np.argmax(level.cell_node_indices[:, v])) for v in range(dimension + 1)]]
                np.testing.assert_allclose(level.nodes[corners], level.mesh.points[level.mesh.cells], atol=1e-14)
                self.assertEqual(level.stress.shape, (*level.cell_nodes.shape, 6))
                np.testing.assert_allclose(
                    (level.eta**2).sum() ** 0.5,
                    level.bound - result.components["quad"] - result.components["alg"],
                )
                copy = displacement.copy()
                with self.assertRaises(ValueError):
                    displacement[0] = 1
                del level, result
                tb.run(block(dimension, degree))
                np.testing.assert_array_equal(displacement, copy)

    def test_probes_agree_with_nodes(self) -> None:
        for dimension, degree in ((2, 2), (3, 1)):
            level = tb.run(block(dimension, degree)).level
            cells = np.random.default_rng(1).choice(len(level.cell_nodes), 10)
            weights = np.full(level.mesh.cells.shape[1], 1 / (dimension + 1))
            x = np.einsum("v,cvd->cd", weights, level.mesh.points[level.mesh.cells[cells]])
            probe = level.at(x)
            np.testing.assert_array_equal(probe.x, x)
            if degree == 1:
                u = level.displacement[level.cell_nodes[cells]].mean(axis=1)
                np.testing.assert_allclose(probe.displacement, u, atol=1e-14)
                np.testing.assert_allclose(probe.stress, level.stress[cells].mean(axis=1), atol=1e-13)
            self.assertEqual(set(probe.region), {"box"})
        self.assertEqual(level.at(x[0]).displacement.shape, (1, dimension))
        with self.assertRaisesRegex(tb.InputError, "outside"):
            level.at([9.0] * dimension)
        with self.assertRaisesRegex(tb.InputError, "shape"):
            level.at([1.0])

    def test_what_is_not_known_is_an_error(self) -> None:
        with self.assertRaisesRegex(ValueError, "not known"):
            tb.run(block(2, 2), stop=lambda level: level.resultant("left").force[0] > 1)
        with self.assertRaisesRegex(tb.InputError, "not finite"):
            solved(2, 2).level.at([1, np.nan])

    def test_forces_balance(self) -> None:
        for dimension in (2, 3):
            level = tb.run(block(dimension, 2)).level
            forces = [level.resultant(name) for name in level.mesh.boundaries]
            np.testing.assert_allclose(sum(f.force for f in forces), 0, atol=1e-12)
            np.testing.assert_allclose(sum(f.moment for f in forces), 0, atol=1e-11)
            size = 2.0 if dimension == 2 else 2.0
            self.assertAlmostEqual(level.resultant("top").force[1], -0.1 * size, places=12)
            cut = level.section([1] * dimension, [1] + [0] * (dimension - 1))
            self.assertAlmostEqual(cut.measure, 1, places=12)
            with self.assertRaisesRegex(KeyError, "bottom"):
                level.resultant("roof")
            with self.assertRaises(tb.InputError):
                level.section([1] * dimension, [0] * dimension)

    def test_sections_carry_what_is_beyond_them(self) -> None:
        case = block(2, 2)
        case["boundary"]["bottom"] = {"traction": [0, 0]}
        level = tb.run(case).level
        # 0.06, 0.04 at the right end, and the load on the top from x = 1 to 2.
        np.testing.assert_allclose(level.section([1, 0.5], [1, 0]).force, [0.06, 0.04 - 0.1], atol=1e-12)

    def test_contact(self) -> None:
        for dimension in (2, 3):
            result = tb.run(block(dimension, 2))
            contact = result.level.contact["bottom"]
            self.assertAlmostEqual(contact.weight.sum(), 2, places=12)
            np.testing.assert_allclose(np.linalg.norm(contact.normal, axis=1), 1)
            np.testing.assert_allclose((contact.traction * contact.normal).sum(axis=1), -contact.pressure, atol=1e-14)
            tangential = np.linalg.norm(contact.traction + contact.pressure[:, None] * contact.normal, axis=1)
            self.assertLessEqual((tangential - contact.limit).max(), 1e-12)
            np.testing.assert_allclose(contact.limit, 0.5 * contact.pressure, atol=1e-14)
            self.assertEqual(set(contact.status) - {0, 1, 2}, set())
            self.assertEqual(contact.arc is None, dimension == 3)
            normal = (contact.weight * contact.pressure).sum()
            self.assertAlmostEqual(normal, -result.certificate["contact"]["normal"], delta=1e-6)

    def test_pairs_and_quantities(self) -> None:
        case = two_boxes([8, 4], [6, 3], quantity=[{"kind": "energy"}], adapt={"tolerance": 0.05})
        result = tb.run(case)
        self.assertTrue(result.is_certified, result.reason)
        (quantity,) = result.quantities.values()
        self.assertLess(quantity.lower, quantity.value)
        self.assertLess(quantity.value, quantity.upper)
        self.assertIn("upper.bottom", result.level.contact)


class Others(unittest.TestCase):
    def test_check(self) -> None:
        found = tb.check(block(2, 2))
        self.assertEqual(found["d"], 2)
        self.assertIn("findings", found)
        with self.assertRaises(tb.InputError):
            tb.check(block(2, 2, load={"body": [1]}))

    def test_verify(self) -> None:
        verification = tb.verify(block(2, 1), refinements=1)
        self.assertGreaterEqual(verification.effectivity, 1)
        self.assertEqual(verification["guarantee"], "holds")

    def test_study(self) -> None:
        study = tb.study(block(2, 1, study={"figures": False}), set={"adapt.tolerance": 0.2})
        self.assertEqual(study["guarantee"] if "guarantee" in study else "holds", "holds")
        self.assertTrue((study.directory / "study.csv").exists())

    def test_what_cannot_be_computed_is_an_exception(self) -> None:
        with self.assertRaises(tb.SolveError):
            tb.verify(block(2, 1), refinements=1, set={"newton.max_steps": 1})

    def test_version(self) -> None:
        self.assertRegex(tb.__version__, r"^\d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main()
