"""The annotations of the package and of its examples: mypy --strict."""

import importlib.util
import os
import subprocess
import sys
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed (Debian: mypy)")
class Types(unittest.TestCase):
    def check(self, *files: Path) -> None:
        # Not all modules that the package uses have annotations: matplotlib, meshio, VTK.
        command = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", os.devnull]
        environment = os.environ | {"MYPYPATH": str(SOURCE / "python")}
        ended = subprocess.run([*command, *files], cwd=SOURCE, env=environment, capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_package(self) -> None:
        self.check(SOURCE / "python/tribound")

    def test_examples(self) -> None:
        self.check(*sorted((SOURCE / "examples/python").glob("*.py")))


if __name__ == "__main__":
    unittest.main()
