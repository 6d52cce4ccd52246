"""A guest in the interpreter: threads, Ctrl-C, memory, other libraries."""

import gc
import importlib.util
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import tribound as tb

from small_cases import block

HERE = os.path.dirname(__file__)
LARGE = block(2, 2, mesh={"box": {"lower": [0, 0], "upper": [2, 1], "cells": [200, 100]}})


def python(script: str, *before: str) -> subprocess.CompletedProcess[str]:
    """Runs a script in a process of its own, after `before`."""
    script = "from small_cases import block\n" + script
    # The environment of before MPI was started here: what MPI adds to it is for this process alone.
    return subprocess.run(
        [*before, sys.executable, "-c", script], cwd=HERE, env=dict(os.environ), capture_output=True, text=True, timeout=300
    )


class Threads(unittest.TestCase):
    def test_others_run_meanwhile(self) -> None:
        ticks = []
        done = threading.Event()

        def tick() -> None:
            while not done.wait(0.005):
                ticks.append(time.monotonic())

        other = threading.Thread(target=tick)
        other.start()
        try:
            begin = time.monotonic()
            tb.run(LARGE, set={"adapt.max_levels": 1})
            end = time.monotonic()
        finally:
            done.set()
            other.join()
        pauses = [b - a for a, b in zip([begin, *ticks], [*ticks, end])]
        self.assertLess(max(pauses), max(0.5, 0.5 * (end - begin)))

    def test_one_run_at_a_time(self) -> None:
        with self.assertRaisesRegex(RuntimeError, "one thing at a time"):
            tb.run(block(2, 2), on_level=lambda level: tb.run(block(2, 2)))
        with self.assertRaisesRegex(RuntimeError, "one thing at a time"):
            for _ in tb.levels(block(2, 2)):
                tb.check(block(2, 2))
        self.assertTrue(tb.run(block(2, 2)).is_certified)

    def test_a_run_in_another_thread(self) -> None:
        results: list[tb.Result] = []
        thread = threading.Thread(target=lambda: results.append(tb.run(block(2, 2))))
        thread.start()
        thread.join()
        self.assertTrue(results[0].is_certified)

    def test_callbacks_run_in_the_thread_of_the_caller(self) -> None:
        seen = set()
        tb.run(block(2, 2), on_level=lambda level: seen.add(threading.current_thread()))
        self.assertEqual(seen, {threading.current_thread()})


class Interruption(unittest.TestCase):
    def test_ctrl_c_returns_within_half_a_second(self) -> None:
        begun = threading.Event()
        sent: list[float] = []

        def interrupt() -> None:
            begun.wait()
            time.sleep(0.3)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        killer = threading.Thread(target=interrupt)
        killer.start()
        with self.assertRaises(KeyboardInterrupt):
            begun.set()
            tb.run(LARGE)
        self.assertLess(time.monotonic() - sent[0], 0.5)
        killer.join()
        self.assertTrue(tb.run(block(2, 2)).is_certified)  # waits for the end of the other

    def test_ctrl_c_ends_a_script(self) -> None:
        script = f"""
import os, signal, threading, tribound as tb
threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
tb.run({LARGE!r})
"""
        ended = python(script)
        self.assertIn("KeyboardInterrupt", ended.stderr)
        self.assertEqual(ended.returncode, -signal.SIGINT, ended.stderr)

    def test_ctrl_c_at_any_time_leaves_the_next_run_alone(self) -> None:
        case = block(2, 2)
        begin = time.monotonic()
        bound = tb.run(case).bound
        longest = time.monotonic() - begin
        before = signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        n_interrupted = 0
        try:
            for i in range(40):
                try:
                    signal.setitimer(signal.ITIMER_REAL, (i + 1) / 40 * longest)
                    try:
                        tb.run(case, directory=directory.name, on_level=lambda level: level.eta)
                    finally:
                        signal.setitimer(signal.ITIMER_REAL, 0)
                except KeyboardInterrupt:
                    n_interrupted += 1
                self.assertEqual(tb.run(case).bound, bound)
        finally:
            signal.signal(signal.SIGALRM, before)
        self.assertGreater(n_interrupted, 10)


class EndOfTheInterpreter(unittest.TestCase):
    """A run that nobody ends does not keep the process, nor does the end of MPI come before its own."""

    def check_ends(self, script: str) -> None:
        ended = python(script)
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "end\n", ""))

    def test_a_generator_left_half_way(self) -> None:
        self.check_ends("import tribound as tb\nlevels = tb.levels(block(2, 2))\nnext(levels)\nprint('end')")

    def test_a_run_in_a_daemon_thread(self) -> None:
        self.check_ends(f"""
import threading, tribound as tb
begun = threading.Event()
def run():
    try:
        tb.run({LARGE!r}, on_step=lambda step: begun.set())
    except BaseException:
        pass
threading.Thread(target=run, daemon=True).start()
begun.wait()
print('end')
""")


class Memory(unittest.TestCase):
    def test_memory_does_not_grow(self) -> None:
        def resident() -> float:
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        def once() -> None:
            result = tb.run(block(2, 2, adapt={"tolerance": 0.2}), keep_levels=True)
            result.level.stress, result.level.contact, result.level.at([1, 0.5])

        for _ in range(20):
            once()
        gc.collect()
        before, files = resident(), len(os.listdir("/proc/self/fd"))
        for _ in range(int(os.environ.get("TRIBOUND_RUNS", "100"))):
            once()
        gc.collect()
        self.assertLess(resident() - before, 5e6)
        self.assertEqual(len(os.listdir("/proc/self/fd")), files)
        self.assertEqual(threading.active_count(), 1)

    def test_failures_leave_nothing(self) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("error", ResourceWarning)
            for _ in range(5):
                with self.assertRaises(ZeroDivisionError):
                    tb.run(block(2, 2), on_level=lambda level: 1 / 0)
            gc.collect()


class Company(unittest.TestCase):
    """Other libraries that start MPI, PETSc or Gmsh, or bring the same libraries."""

    IMPORTS = {
        "petsc4py": "from petsc4py import PETSc",
        "mpi4py": "from mpi4py import MPI",
        "gmsh": "import gmsh; gmsh.initialize(); gmsh.option.setNumber('General.Terminal', 0); gmsh.model.add('mine')",
        "vtk": "import vtkmodules.vtkCommonCore",
    }
    USES = {
        "petsc4py": """
m = PETSc.Mat().createAIJ([2, 2], comm=PETSc.COMM_SELF); m.setUp(); m.setValue(0, 0, 2.0); m.assemble()
assert m.norm() == 2
try:
    m.setValue(7, 7, 1.0)
    raise SystemExit('no error')
except PETSc.Error as error:
    assert error.ierr == 63, error
""",
        "mpi4py": "assert MPI.COMM_WORLD.allreduce(1) == 1",
        "gmsh": "assert gmsh.model.getCurrent() == 'mine'; gmsh.finalize()",
        "vtk": "",
    }

    def test_any_order(self) -> None:
        present = [name for name in self.IMPORTS if importlib.util.find_spec(name if name != "vtk" else "vtkmodules")]
        orders = [[name, "tribound"] for name in present] + [["tribound", name] for name in present]
        for order in [*orders, [*present, "tribound"]]:
            with self.subTest(order=order):
                imports = "\n".join(self.IMPORTS.get(name, "import tribound as tb") for name in order)
                uses = "\n".join(self.USES.get(name, "") for name in order)
                run = "assert tb.run(block(2, 2)).is_certified, 'run'"
                ended = python(f"{imports}\n{run}\n{uses}\n{run}\nprint('done')")
                self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "done\n", ""))


if __name__ == "__main__":
    unittest.main()
