#!/usr/bin/env python3
"""Tests the comparison of tables that checks generated pages (scripts/tables.py).

    tables_test.py ROOT
"""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(sys.argv.pop(1)) / "scripts"))

from tables import differences, section, table  # noqa: E402

COLUMNS = ["case|", "cells", "bound", "CPU seconds"]
ROW = ["block", 470, "0.921 %", 0.5]


def found(row, tolerance=0.01):
    return list(differences(table(COLUMNS, [ROW]), table(COLUMNS, [row]), tolerance))


class Differences(unittest.TestCase):
    def test_equal_tables_do_not_differ(self):
        self.assertEqual(found(ROW), [])

    def test_numbers_agree_to_the_tolerance(self):
        self.assertEqual(found(["block", 471, "0.92 %", 0.5]), [])
        self.assertEqual(len(found(["block", 480, "0.921 %", 0.5])), 1)
        self.assertEqual(len(found(["block", 470, "0.95 %", 0.5])), 1)

    def test_words_are_equal(self):
        self.assertEqual(len(found(["blocks", 470, "0.921 %", 0.5])), 1)

    def test_seconds_are_not_compared(self):
        self.assertEqual(found(["block", 470, "0.921 %", 100]), [])

    def test_rows_are_counted(self):
        one, two = table(COLUMNS, [ROW]), table(COLUMNS, [ROW, ROW])
        self.assertTrue(list(differences(one, two, 0.01)))

    def test_rounding_is_not_compared(self):
        self.assertEqual(list(differences("neu  1.2e-16\n", "neu  3.4e-17\n", 0.01)), [])
        self.assertTrue(list(differences("neu  1.2e-6\n", "neu  3.4e-7\n", 0.01)))

    def test_a_section_is_what_stands_between_its_lines(self):
        text = "a\n<!-- begin x: made by scripts/y -->\nold\n<!-- end x -->\nb\n"
        self.assertEqual(section("x").search(text).group(2), "old\n")


if __name__ == "__main__":
    unittest.main()
