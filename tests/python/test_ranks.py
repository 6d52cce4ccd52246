"""Several processes of the interpreter, and judgements on two against those on one."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb

from test_judge import averaged_stress
from test_judge_revolution import body
from test_judge_steps import COARSE, LAWS, pressed
from test_manners import python

PROGRAM = os.environ.get("TRIBOUND_PROGRAM")
MPIRUN = ("mpirun", "--oversubscribe", "--mca", "mpi_yield_when_idle", "1", "-n", "2")


@unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
class Interpreters(unittest.TestCase):
    def test_results_are_the_same_on_all(self) -> None:
        script = """
import tribound as tb, numpy as np
result = tb.run(block(2, 2), keep_levels=True, on_level=lambda level: None)
f = result.level.at([1, 0.5])
print(f"{result.status} {result.bound:.9e} {f.displacement[0, 1]:.9e} {len(result.level.eta) < 400}\\n", end="")
"""
        one, two = python(script), python(script, *MPIRUN)
        self.assertEqual(two.returncode, 0, two.stderr)
        words = two.stdout.split()
        self.assertEqual(words[:4], words[4:])
        for a, b in zip(one.stdout.split()[1:3], words[1:3]):
            self.assertAlmostEqual(float(a) / float(b), 1, places=5)

    def test_errors_arrive_on_all(self) -> None:
        script = """
import tribound as tb
for case, error in (({**block(2, 2), "degree": 9}, tb.InputError), (block(2, 2), KeyError)):
    def observe(level):
        raise KeyError("here")
    try:
        tb.run(case, on_level=observe)
    except error as found:
        print(type(found).__name__ + "\\n", end="")  # in one piece: both processes print
"""
        ended = python(script, *MPIRUN)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(sorted(ended.stdout.split()), ["InputError"] * 2 + ["KeyError"] * 2)


@unittest.skipUnless(PROGRAM and shutil.which("mpirun"), "no program, or no mpirun")
class Judgements(unittest.TestCase):
    def setUp(self) -> None:
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.folder = Path(directory.name)

    def judge(self, case: str, output: str, *options: str, ranks: int = 1) -> subprocess.CompletedProcess[str]:
        start = MPIRUN if ranks == 2 else ()
        command = [*start, str(PROGRAM), "judge", case, "-q", *options, "--set", f'output.directory="{output}"']
        environment = dict(os.environ)  # without what MPI has set in this process
        return subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True)

    def judged(self, output: str) -> Any:
        return json.loads((self.folder / output / "judge/judgement.json").read_text())

    def test_load_steps(self) -> None:
        tb.run(pressed(**LAWS[1]), set=COARSE, directory=self.folder / "theirs")
        series = ("--steps", "--solution", "theirs/series.pvd")
        sets = ("--set", "degree=2", "--set", "adapt.max_levels=12", "--set", "adapt.tolerance=0.02")
        one = self.judge("theirs/case.toml", "one", *series, *sets)
        two = self.judge("theirs/case.toml", "two", *series, *sets, ranks=2)
        self.assertEqual((one.returncode, two.returncode), (0, 0), one.stdout + two.stderr)
        table = [line.split() for line in one.stdout.splitlines()[1:4]]
        self.assertEqual(table[0][:4], ["errors", "step", "t", "displacement"])
        self.assertEqual([row[0] for row in table[1:]], ["1", "2"])
        self.assertEqual([row[1] for row in table[1:]], ["0.5", "1"])
        for a, b in zip(self.judged("one")["steps"], self.judged("two")["steps"]):
            for field in ("displacement", "stress"):
                np.testing.assert_allclose(a[field]["error"], b[field]["error"], rtol=1e-8)
        for number in ("001", "002"):
            for name in ("judged.vtu", "judged_cells.csv"):
                self.assertTrue((self.folder / "two/judge/judged_steps" / number / name).exists())
        self.assertEqual(self.judge("theirs/case.toml", "one", *series, *sets, "--accept", "0.001").returncode, 4)
        run = [str(PROGRAM), "run", "theirs/case.toml", "-q", "--set", 'output.directory="two/judge"']
        ended = subprocess.run(run, cwd=self.folder, capture_output=True, text=True)
        self.assertIn(ended.returncode, (0, 3), ended.stderr)
        self.assertFalse((self.folder / "two/judge/judged_steps").exists())

    def test_bodies_of_revolution(self) -> None:
        case = body(0.0)
        level = tb.run(case, set={"adapt.max_levels": 0, "degree": 1}).level
        tb.judge(case, (level.nodes, level.displacement, averaged_stress(level)), directory=self.folder)
        for output, ranks in (("one", 1), ("two", 2)):
            ended = self.judge("judge/case.toml", output, "--solution", "solution.csv", ranks=ranks)
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        one, two = self.judged("one"), self.judged("two")
        self.assertEqual(one["cells"], two["cells"])
        for field in ("displacement", "stress"):
            np.testing.assert_allclose(two[field]["error"], one[field]["error"], rtol=1e-6)
            np.testing.assert_allclose(two[field]["distance"], one[field]["distance"], rtol=1e-8)


if __name__ == "__main__":
    unittest.main()
