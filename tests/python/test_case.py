"""Cases from dictionaries, texts and files, with functions as data."""

import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb

from small_cases import block

TOML = """
title = "Block"
degree = 2
mesh.box = { lower = [0, 0], upper = [2, 1], cells = [8, 4] }
material = { E = 1.0, nu = 0.3 }
boundary.left.displacement = [0, 0]
boundary.top.traction = [0, -0.1]
boundary.right.traction = [0.06, 0.04]
boundary.bottom.contact = { friction = "coulomb", coefficient = 0.5, gap = 0 }
adapt = { tolerance = 0.02, max_levels = 12 }
"""


def with_data(where: str, value: Any) -> dict[str, Any]:
    """The block with another value at a dotted key."""
    case = block(2, 2)
    table = case
    *tables, key = where.split(".")
    for name in tables:
        table[name] = dict(table[name])
        table = table[name]
    table[key] = value
    return case


class Sources(unittest.TestCase):
    def test_dictionary_text_and_file_are_one_case(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory) / "block.toml"
            file.write_text(TOML)
            results = [tb.run(case) for case in (block(2, 2), TOML, tb.Case(TOML), tb.Case.read(file))]
        for result in results:
            self.assertEqual(result.status, "certified")
            np.testing.assert_allclose(result.bound, results[0].bound, rtol=1e-9)

    def test_numbers_of_numpy_and_paths(self) -> None:
        case = block(2, 2)
        case["degree"] = np.int64(2)
        case["material"] = {"E": np.float64(1.0), "nu": np.float32(0.25)}
        case["boundary"]["left"] = {"displacement": np.zeros(2)}
        self.assertEqual(tb.run(case).certificate["p"], 2)

    def test_truth_values_of_numpy(self) -> None:
        tb.check({**block(2, 2), "output": {"report": np.bool_(False)}}, set={"output.vtu": np.bool_(True)})

    def test_set(self) -> None:
        case = tb.Case(TOML, set={"degree": 1, "boundary.top.traction": [0, "-0.2*x"]})
        result = tb.run(case, set={"material.nu": 0.2, "adapt.tolerance": 0.5})
        self.assertEqual(result.certificate["p"], 1)
        self.assertAlmostEqual(result.level.resultant("top").force[1], -0.4, places=12)

    def test_effective_case_gives_the_same_again(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            first = tb.run(block(2, 2), directory=Path(directory) / "a")
            again = tb.run(tb.Case.read(Path(directory) / "a/case.toml"), directory=Path(directory) / "b")
            np.testing.assert_allclose(first.bound, again.bound, rtol=1e-9)


class Functions(unittest.TestCase):
    def test_a_function_is_what_its_formula_is(self) -> None:
        formulas = {
            "boundary.top.traction": [0, "-0.1*(2-x)*x"],
            "boundary.right.traction": ["0.03*exp(y)", 0],
            "boundary.bottom.contact.gap": "0.01*x^2",
            "boundary.bottom.contact": {"friction": "tresca", "threshold": "0.03+0.01*x^2", "gap": 0},
            "boundary.left.displacement": ["0.001*sin(y)", "free"],
            "load": {"body": ["0", "-0.01*y"]},
        }
        functions = {
            "boundary.top.traction": lambda x: np.stack([0 * x[0], -0.1 * (2 - x[0]) * x[0]]),
            "boundary.right.traction": [lambda x: 0.03 * np.exp(x[1]), 0],
            "boundary.bottom.contact.gap": lambda x: 0.01 * x[0] ** 2,
            "boundary.bottom.contact": {
                "friction": "tresca", "threshold": lambda x: 0.03 + 0.01 * x[0] ** 2, "gap": 0,
            },
            "boundary.left.displacement": [lambda x: 0.001 * np.sin(x[1]), "free"],
            "load": {"body": lambda x: [0 * x[1], -0.01 * x[1]]},
        }
        for key, formula in formulas.items():
            with self.subTest(key):
                expected = tb.run(with_data(key, formula))
                found = tb.run(with_data(key, functions[key]))
                self.assertEqual(found.status, "certified")
                if key != "boundary.left.displacement":  # this is interpolated at the nodes, as formulas are
                    self.assertTrue(any("functions" in text for text in found.certificate["not_covered"]))
                np.testing.assert_allclose(found.bound, expected.bound, rtol=1e-6)
                np.testing.assert_allclose(
                    found.level.displacement, expected.level.displacement, atol=1e-8 * 0.5
                )

    def test_polynomials_are_covered(self) -> None:
        result = tb.run(with_data("boundary.top.traction", [0, tb.Function(lambda x: -0.1 * x[0], degree=1)]))
        self.assertFalse(any("functions" in text for text in result.certificate["not_covered"]))

    def test_one_number_serves_all_points(self) -> None:
        constant = tb.run(with_data("boundary.top.traction", [0, lambda x: -0.1]))
        self.assertAlmostEqual(constant.level.resultant("top").force[1], -0.2, places=12)

    def test_a_list_of_components(self) -> None:
        parts = with_data("boundary.top.traction", [0, lambda x: -0.1 * x[0]])
        whole = with_data("boundary.top.traction", lambda x: [0, -0.1 * x[0]])
        self.assertEqual(tb.run(whole).bound, tb.run(parts).bound)

    def test_load_factor(self) -> None:
        history = {"history": {"steps": [0.5, 1.0]}, "adapt": {"tolerance": 0.5}}
        formula = {**with_data("boundary.top.traction", [0, "-0.1*t*x"]), **history}
        function = {**with_data("boundary.top.traction", [0, lambda x, t: -0.1 * t * x[0]]), **history}
        for expected, found in zip(_kept(formula), _kept(function), strict=True):
            self.assertEqual(found.t, expected.t)
            np.testing.assert_allclose(found.displacement, expected.displacement, atol=1e-9)

    def test_time_is_asked_for_by_a_second_argument_alone(self) -> None:
        self.assertTrue(tb.Function(lambda x, t: x[0]).uses_time)
        self.assertFalse(tb.Function(lambda x, scale=2: scale * x[0]).uses_time)
        self.assertFalse(tb.Function(np.sin).uses_time)

    def test_what_a_function_keeps_is_its_own(self) -> None:
        kept = []

        def load(x: np.ndarray) -> np.ndarray:
            kept.append((x, x.copy()))
            x[:] = x  # it may write to it, too
            return -0.1 * x[0]

        tb.run(with_data("boundary.top.traction", [0, load]))
        for array, then in kept:
            np.testing.assert_array_equal(array, then)

    def test_initial_stress_and_springs(self) -> None:
        case = with_data("load", {"initial_stress": lambda x: np.stack([0 * x[0], -0.01 * x[1], 0 * x[0]])})
        expected = tb.run(with_data("load", {"initial_stress": [0, "-0.01*y", 0]}))
        np.testing.assert_allclose(tb.run(case).bound, expected.bound, rtol=1e-6)


def _kept(case: dict[str, Any]) -> list[tb.Level]:
    return tb.run(case, keep_levels=True).levels


class Errors(unittest.TestCase):
    def fails(self, case: Any, key: str, problem: str, **options: Any) -> tb.InputError:
        with self.assertRaises(tb.InputError) as caught:
            tb.run(case, **options)
        self.assertEqual(caught.exception.key, key)
        self.assertIn(problem, caught.exception.problem)
        self.assertIn(caught.exception.problem, str(caught.exception))
        return caught.exception

    def test_messages_name_key_and_what_would_be_right(self) -> None:
        error = self.fails({**block(2, 2), "degre": 2}, "degre", "unknown key")
        self.assertIn('did you mean "degree"', error.hint)
        self.assertIsInstance(error, ValueError)
        self.fails(with_data("material.E", "steel"), "material.E", "must be a number")
        self.fails(with_data("material.E", lambda x: 1), "material.E", "must be a number, found a function")
        self.fails(with_data("boundary.top", None), "boundary.top", "is a NoneType")
        self.fails(with_data("boundary.top.traction", [0, 2**70]), "boundary.top.traction[1]", "64 bits")
        self.fails({1: 2}, "", "no string")

    def test_lines_of_texts(self) -> None:
        error = self.fails(TOML + "\n[load]\nbdy = [0, 1]\n", "load.bdy", "unknown key")
        self.assertEqual(error.line, TOML.count("\n") + 3)

    def test_what_functions_return(self) -> None:
        top = "boundary.top.traction[1]"
        for function, problem in (
            (lambda x: np.zeros((2, x.shape[1])), "an array of shape (2, "),
            (lambda x: "a", "the function returns str"),
            (lambda x: None, "the function returns NoneType"),
            (lambda x: 1j * x[0], "no numbers"),
            (lambda x: x[0] * np.nan, "undefined (nan) at the point"),
            (lambda x: x[0] / 0.0 if np.seterr(all="ignore") else 0, "inf at the point"),
        ):
            self.fails(with_data("boundary.top.traction", [0, function]), top, problem)
        self.fails(with_data("boundary.top.traction", lambda x: x[0]), "boundary.top.traction", "an array of shape (")

    def test_exceptions_of_functions_arrive(self) -> None:
        def load(x: np.ndarray) -> np.ndarray:
            raise KeyError("here")

        with self.assertRaisesRegex(KeyError, "here"):
            tb.run(with_data("boundary.top.traction", [0, load]))

    def test_directions_are_formulas(self) -> None:
        contact = {"friction": "none", "normal": lambda x: x}
        self.fails(with_data("boundary.bottom", {"contact": contact}), "boundary.bottom.contact.normal[0]", "function")

    def test_what_is_masked_is_undefined(self) -> None:
        def load(x: np.ndarray[Any, Any]) -> Any:
            return np.ma.masked_array(0.1 + x[0], x[0] > 1)

        self.fails(with_data("boundary.top", {"pressure": load}), "boundary.top.pressure", "nan")
        self.fails(with_data("boundary.top.traction", lambda x: [0, -load(x)]), "boundary.top.traction[1]", "nan")

    def test_a_default_of_the_load_factor_is_refused(self) -> None:
        with self.assertRaisesRegex(TypeError, "default for t"):
            tb.Function(lambda x, t=1.0: t * x[0])

    def test_degrees_are_numbers(self) -> None:
        self.assertRaises(ValueError, tb.Function, np.sin, -1)
        self.assertRaises(TypeError, tb.Function, np.sin, 1.5)

    def test_other_things_than_cases(self) -> None:
        with self.assertRaisesRegex(tb.InputError, r"hint: tb.Case.read\('case.toml'\)"):
            tb.run("case.toml")
        with self.assertRaisesRegex(TypeError, "tb.Case.read"):
            tb.Case(Path("case.toml"))  # type: ignore[arg-type]
        with self.assertRaisesRegex(TypeError, "a case is made of int"):
            tb.run(5)  # type: ignore[arg-type]

    def test_errors_of_set_name_the_key(self) -> None:
        for value in (None, lambda x: x[0]):
            with self.assertRaises(tb.InputError) as caught:
                tb.run(block(2, 2), set={"boundary.top.pressure": value})
            self.assertEqual(caught.exception.key, "boundary.top.pressure")

    def test_lists_within_themselves(self) -> None:
        endless: list[Any] = []
        endless.append(endless)
        self.assertRaises(RecursionError, tb.run, {**block(2, 2), "title": endless})

    def test_functions_of_vectors_need_the_dimension(self) -> None:
        case = with_data("boundary.top.traction", lambda x: 0 * x)
        mesh = case.pop("mesh")
        self.fails(case, "mesh", "dimension")
        self.fails({**case, "mesh": {"box": {"upper": [1, 1]}}}, "mesh", "dimension")
        self.assertTrue(tb.run(case, set={"mesh": mesh}).is_certified)

    def test_functions_have_no_checkpoints(self) -> None:
        case = {**with_data("boundary.top.traction", [0, lambda x: -0.1]), "output": {"checkpoint": True}}
        self.fails(case, "output.checkpoint", "functions")

    def test_files_that_are_not_there(self) -> None:
        with self.assertRaisesRegex(tb.InputError, "nowhere.toml"):
            tb.Case.read("nowhere.toml")


if __name__ == "__main__":
    unittest.main()
