"""The tables of a run: the numbers of the files, to the last bit."""

import tempfile
import unittest
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest import mock

import numpy as np

from small_cases import solved
from tribound import tables


class Tables(unittest.TestCase):
    def test_convergence_is_that_of_the_certificate(self) -> None:
        result = solved(2, 2)
        convergence = result.table("convergence")
        levels = result.certificate["levels"]
        for column, key in (("total_sharp", "bound"), ("dofs", "dofs"), ("relative", "relative")):
            self.assertEqual(list(convergence[column]), [level[key] for level in levels], column)
        kinds = {name: np.asarray(convergence[name]).dtype.kind for name in ("level", "dofs", "neu", "total")}
        self.assertEqual(kinds, {"level": "i", "dofs": "i", "neu": "f", "total": "f"})

    def test_contact_is_that_of_the_level(self) -> None:
        result = solved(2, 2)
        contact = result.table("contact")
        self.assertEqual(set(contact["boundary"]), {"bottom"})
        np.testing.assert_array_equal(contact["pressure"], result.level.contact["bottom"].pressure)

    @unittest.skipUnless(find_spec("pandas"), "no pandas")
    def test_with_and_without_pandas(self) -> None:
        import pandas

        result = solved(2, 2)
        frame = result.table("newton")
        self.assertIsInstance(frame, pandas.DataFrame)
        with mock.patch.object(tables, "find_spec", return_value=None):
            columns = result.table("newton")
        self.assertIsInstance(columns, dict)
        self.assertEqual(list(columns), list(frame.columns))
        for name, values in columns.items():
            np.testing.assert_array_equal(values, frame[name])

    def test_names_stay_words_and_unknown_numbers_are_nan(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "contact.csv").write_text(
                'boundary,pressure,pair\n007,0.1,\nNA,-2e-05,0\n"a, b",3,1\n'
            )
            result: Any = SimpleNamespace(directory=Path(folder))
            table = tables.table(result, "contact")
        self.assertEqual(list(table["boundary"]), ["007", "NA", "a, b"])
        self.assertEqual(list(table["pressure"]), [0.1, -2e-05, 3])
        self.assertTrue(np.isnan(table["pair"][0]))
        self.assertEqual(list(table["pair"][1:]), [0, 1])

    def test_says_what_there_is(self) -> None:
        result = solved(2, 2)
        with self.assertRaisesRegex(
            ValueError, "no table 'contacts'; there are convergence, newton, .*contact"
        ):
            result.table("contacts")
        with self.assertRaisesRegex(
            FileNotFoundError, r"no history.csv; it has convergence, newton, contact"
        ):
            result.table("history")


if __name__ == "__main__":
    unittest.main()
