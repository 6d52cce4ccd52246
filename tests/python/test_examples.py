"""Runs the scripts of examples/python, which check their own numbers, and the example of the guide."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
EXAMPLES = SOURCE / "examples/python"
OWN_LOOP = os.environ.get("TRIBOUND_OWN_LOOP")  # examples/cpp/own_loop.cpp, built


class Examples(unittest.TestCase):
    def run_script(self, name: str, *arguments: str) -> str:
        ended = subprocess.run([sys.executable, EXAMPLES / name, *arguments], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended.stdout

    def draws(self, name: str) -> None:
        with tempfile.TemporaryDirectory() as directory:
            picture = Path(directory) / "picture.png"
            self.run_script(name, str(picture))
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_friction_study(self) -> None:
        self.draws("friction_study.py")

    def test_hertz(self) -> None:
        self.draws("hertz.py")

    def test_own_load(self) -> None:
        self.run_script("own_load.py")

    def test_dam_sweep(self) -> None:
        self.run_script("dam_sweep.py", "2")

    def test_adaptive_loop(self) -> None:
        printed = self.run_script("adaptive_loop.py")
        self.assertIn("the friction force has settled", printed)
        if OWN_LOOP:
            self.assertEqual(printed, subprocess.run([OWN_LOOP], capture_output=True, text=True, check=True).stdout)

    def test_guide(self) -> None:
        code = re.findall(r"^```python\n(.*?)^```", (SOURCE / "docs/python.md").read_text(), re.S | re.M)[0]
        *lines, last = code.splitlines()
        values, comment = last.split("#")
        found: dict[str, object] = {}
        exec("\n".join([*lines, f"found = {values}"]), found)
        self.assertTrue(str(found["found"]).startswith(comment.strip().removesuffix("...)")), found["found"])

    def test_every_script_is_run(self) -> None:
        tests = {name.removeprefix("test_") for name in dir(self) if name.startswith("test_")}
        self.assertLessEqual({script.stem for script in EXAMPLES.glob("*.py")}, tests)


if __name__ == "__main__":
    unittest.main()
