"""Sweeps."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

import numpy as np
import tribound as tb

from small_cases import block

KEY = "boundary.bottom.contact.coefficient"


class Sweep(unittest.TestCase):
    def test_rows_are_runs(self) -> None:
        values = np.linspace(0.2, 0.8, 3)
        with tempfile.TemporaryDirectory() as directory:
            table = tb.sweep(block(2, 1), {KEY: values, "degree": [1, 2]}, directory=directory)
            self.assertEqual(sorted(p.name for p in Path(directory).iterdir()), [f"{i:04d}" for i in range(1, 7)])
        np.testing.assert_array_equal(table[KEY], np.repeat(values, 2))  # the first key varies slowest
        np.testing.assert_array_equal(table["degree"], [1, 2] * 3)
        self.assertEqual(set(table["status"]) - {"certified", "budget"}, set())
        for i in range(6):
            result = tb.run(block(2, 1), set={KEY: table[KEY][i], "degree": table["degree"][i]})
            np.testing.assert_allclose(result.relative, table["relative"][i], rtol=1e-9)
            self.assertEqual(result.certificate["dofs"], table["dofs"][i])

    def test_processes(self) -> None:
        values = {KEY: [0.2, 0.5, 0.8]}
        alone, together = tb.sweep(block(2, 1), values), tb.sweep(block(2, 1), values, jobs=2)
        np.testing.assert_allclose(alone["bound"], together["bound"], rtol=1e-9)

    @unittest.skipUnless(importlib.util.find_spec("cloudpickle"), "cloudpickle is not installed")
    def test_functions_reach_processes(self) -> None:
        scale = 0.1
        case = block(2, 1)
        case["boundary"]["top"] = {"traction": [0, lambda x: -scale * np.minimum(x[0], 1)]}
        values = {KEY: [0.2, 0.8]}
        alone, together = tb.sweep(case, values), tb.sweep(case, values, jobs=2)
        np.testing.assert_allclose(alone["bound"], together["bound"], rtol=1e-9)

    def test_parameters_and_meshes(self) -> None:
        case = block(2, 1, parameters={"load": 0.1})
        case["boundary"]["top"] = {"traction": [0, "-load"]}
        del case["mesh"]
        table = tb.sweep(case, {"load": [0.1, 0.2]}, tb.Mesh.box([0, 0], [2, 1], [4, 2]))
        self.assertEqual(list(table["load"]), [0.1, 0.2])

    def test_failures_have_rows(self) -> None:
        table = tb.sweep(block(2, 1), {"newton.max_steps": [1, 20]})
        self.assertEqual(list(table["status"]), ["failed", "certified"])
        self.assertTrue(np.isnan(table["bound"][0]))
        self.assertGreater(table["bound"][1], 0)

    def test_wrong_values_are_found_first(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            with self.assertRaises(tb.InputError):
                tb.sweep(block(2, 1), {"degree": [1, 9]}, directory=directory)
            self.assertEqual(list(Path(directory).iterdir()), [])
        with self.assertRaises(tb.InputError):
            tb.sweep(block(2, 1), {})


if __name__ == "__main__":
    unittest.main()
