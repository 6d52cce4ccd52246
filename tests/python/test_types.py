"""The annotations of the package and of its examples: mypy --strict. Those of the extension module are in a file of
their own, which names all that is there."""

import ast
import importlib.util
import inspect
import os
import subprocess
import sys
import unittest
from pathlib import Path

import tribound
from tribound import _tribound

SOURCE = Path(__file__).resolve().parents[2]


def names_of(body: list[ast.stmt]) -> set[str]:
    """What a module or a class of a stub defines for others."""
    names = {node.target.id for node in body if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)}
    names |= {node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    return {name for name in names if not name.startswith("_")}


def public(thing: object) -> set[str]:
    return {name for name in dir(thing) if not name.startswith("_")}


class Types(unittest.TestCase):
    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed (Debian: mypy)")
    def test_package_and_examples(self) -> None:
        # Not all modules that the package uses have annotations: matplotlib, meshio, VTK.
        command = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", os.devnull]
        files = ["python/tribound", *(SOURCE / "examples/python").glob("*.py")]
        environment = os.environ | {"MYPYPATH": str(SOURCE / "python")}
        ended = subprocess.run([*command, *files], cwd=SOURCE, env=environment, capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_stub_names_what_is_bound(self) -> None:
        stub = ast.parse((SOURCE / "python/tribound/_tribound.pyi").read_text())
        self.assertEqual(names_of(stub.body), public(_tribound))
        classes = {node.name: names_of(node.body) for node in stub.body if isinstance(node, ast.ClassDef)}
        self.assertEqual(classes["Document"], public(_tribound.Document))
        self.assertEqual(classes["_Level"], public(_tribound.Level2))
        self.assertEqual(classes["_Level"], public(_tribound.Level3))

    def test_arguments_are_shown(self) -> None:
        for command in (tribound.run, tribound.levels):
            names = list(inspect.signature(command).parameters)
            self.assertEqual(names[:4], ["case", "mesh", "set", "directory"])
            self.assertIn("keep_levels", names)


if __name__ == "__main__":
    unittest.main()
