#!/usr/bin/env python3
"""A run killed before any change to its directory of results leaves nothing there that contradicts the certificate.

    kills.py PROGRAM AT_CHANGE MPIRUN

AT_CHANGE is the library of at_change.cpp. A run of one process copies its directory at each place where it could be killed.
Runs of several processes are killed at one place after the other, until a run is no longer killed.
"""

import itertools
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import runner

sys.path.insert(0, str(Path(__file__).parent.parent / "fuzz"))
from results import read_grid  # noqa: E402

PROGRAM, LIBRARY, MPIRUN = sys.argv[1:4]
ENVIRONMENT = runner.ENVIRONMENT | {
    "OMP_NUM_THREADS": "1",  # files are written in place, in one order
    "OPENBLAS_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}

LEVELS = """
degree = 1
[mesh]
box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
[material]
E = 1.0
nu = 0.3
[boundary.left]
displacement = [0, 0]
[boundary.top]
traction = [0, -0.1]
[boundary.bottom]
contact = {}
[adapt]
tolerance = 1e-6
max_levels = 2
[output]
directory = "out"
checkpoint = true
"""
STEPS = """
degree = 1
[mesh]
box = { lower = [0, 0], upper = [0.1, 1], cells = [1, 4] }
[material]
E = 1000.0
nu = 0.2
[boundary.left]
displacement = [0, "free"]
[boundary.right]
traction = ["0.5*y", 0]
[boundary.top]
displacement = ["free", "t"]
[boundary.bottom]
interface = { law = "joint", tensile_strength = 2, fracture_energy = 6e-3 }
[history]
steps = [0.0005, 0.001, 0.0015, 0.002]
[adapt]
tolerance = 1e-6
max_levels = 1
[output]
directory = "out"
checkpoint = "all"
"""
ALL = ["--set", 'output.levels="all"']
OTHER = ["--set", "material.E=1010.0"]
SHORTER = ["--set", "history.steps=[0.0005, 0.001, 0.0011]"]
MORE = ["--set", "adapt.max_levels=3"]


def tribound(directory, *arguments, at_change=None, ranks=1):
    """at_change: a variable of at_change.cpp and its value."""
    command = [PROGRAM, "run", "-q", *arguments]
    if at_change:
        command = ["env", f"LD_PRELOAD={LIBRARY}", "=".join(map(str, at_change)), *command]
    if ranks > 1:
        command = [MPIRUN, "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-n", str(ranks), *command]
    return subprocess.run(command, cwd=directory, env=ENVIRONMENT, capture_output=True, text=True, timeout=runner.TIME_LIMIT)


def read_certificate(out):
    path = out / "certificate.json"
    return json.loads(path.read_text()) if path.exists() else None


def number_in(name):
    found = re.fullmatch(r"(?:level|step|contact)_(\d{3,})(?:\.vtu|\.pvtu|)", name)
    return int(found[1]) if found else None


def contradictions(out, references):
    """What the files say beyond their certificate, as sentences; references: directories of runs that were not killed."""
    certificate = read_certificate(out)
    if certificate is None:
        return  # nothing is claimed
    of_case = [r for r in references if read_certificate(r)["case"]["sha256"] == certificate["case"]["sha256"]]
    claimed = certificate.get("steps") or certificate["levels"]
    key = "step" if "steps" in certificate else "level"
    numbers = {record[key] for record in claimed}
    for path in sorted(out.iterdir()):
        if (number := number_in(path.name)) is None:
            continue
        if number not in numbers:
            yield f"{path.name}, but the certificate knows {sorted(numbers)}"
            continue
        cells = next(record["cells"] for record in claimed if record[key] == number)
        if path.suffix == ".vtu" and not path.name.startswith("contact_") and n_cells(path) != cells:
            yield f"{path.name} has {n_cells(path)} cells, in the certificate {cells}"
        known = [r / path.name for r in of_case if (r / path.name).is_file() and same_mesh(r, certificate, key, number)]
        if path.suffix == ".vtu" and known and not any(alike(path, k) for k in known):
            yield f"{path.name} is of another run than the certificate"
    listed = re.findall(r'file="([^"]*)"', (out / "series.pvd").read_text()) if (out / "series.pvd").exists() else []
    for name in listed:
        if not (out / name).exists() or number_in(name) not in numbers:
            yield f"series.pvd lists {name}"
    if (out / "contact.csv").exists():
        header, *rows = (out / "contact.csv").read_text().splitlines()
        place = header.split(",").index("level")
        if {int(row.split(",")[place]) for row in rows} != {max(numbers)}:
            yield f"contact.csv is not of {key} {max(numbers)}"
    if (out / "adapted.msh").exists():
        cells = len(re.findall(r"^\d+ 2 2 ", (out / "adapted.msh").read_text(), re.MULTILINE))
        if cells != claimed[-1]["cells"]:
            yield f"adapted.msh has {cells} cells, the last {key} of the certificate {claimed[-1]['cells']}"
    if (out / "report.html").exists():
        on_page = {int(n) for n in re.findall(r'"level":(\d+),"dimension"', (out / "report.html").read_text())}
        if max(on_page) != max(numbers):
            yield f"the page shows {sorted(on_page)}, the certificate knows {sorted(numbers)}"


def n_cells(path):
    return int(re.search(rb'NumberOfCells="(\d+)"', path.read_bytes())[1])


def alike(one, other):
    """Whether two files of fields have the same displacement, up to rounding."""
    u, v = (read_grid(path).arrays["displacement"] for path in (one, other))
    return u.shape == v.shape and np.abs(u - v).max() <= 1e-6 * np.abs(v).max()


def same_mesh(reference, certificate, key, number):
    """Whether the reference has the mesh of the certificate: passes over a history number their steps alike."""
    records = [c.get("steps") or c["levels"] for c in (read_certificate(reference), certificate)]
    cells = [{r[key]: r["cells"] for r in found}.get(number) for found in records]
    return cells[0] == cells[1]


def left_by_kills(folder, arguments, ranks, stride):
    """Pairs of the place of a kill and the directory of results left by it; at the end None and the one of a whole run."""
    if ranks == 1:
        restore(folder)
        (folder / "copies").mkdir()
        result = tribound(folder, *arguments, at_change=("COPIES", folder / "copies"))
        yield from sorted((int(copy.name), copy) for copy in (folder / "copies").iterdir())
    else:
        for kill_at in itertools.count(1, stride):
            restore(folder)
            result = tribound(folder, *arguments, at_change=("KILL_AT_CHANGE", kill_at), ranks=ranks)
            if result.returncode in (0, 3):
                break
            yield kill_at, folder / "out"
    if result.returncode not in (0, 3):
        sys.exit(f"exit code {result.returncode} without a kill: {result.stderr}")
    yield None, folder / "out"


def restore(folder):
    shutil.rmtree(folder / "out")
    shutil.copytree(folder / "base", folder / "out")


def scenario(name, case, before, arguments, ranks=1, stride=1):
    """`before`: runs that leave their results, one after the other. Then the run with the arguments, which is killed."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "case.toml").write_text(case)
        references = []
        for k, earlier in enumerate([*before, arguments]):
            if k == len(before):
                shutil.copytree(folder / "out", folder / "base") if before else (folder / "base").mkdir()
            result = tribound(folder, *earlier, ranks=ranks)
            if result.returncode not in (0, 3):
                problems.append(f"{name}: exit code {result.returncode} without a kill: {result.stderr}")
                return problems
            problems += [f"{name}, not killed: {text}" for text in contradictions(folder / "out", [])]
            references.append(folder / f"whole_{k}")
            shutil.copytree(folder / "out", references[-1])
        places = 0
        for place, out in left_by_kills(folder, arguments, ranks, stride):
            places += place is not None
            problems += [f"{name}, killed at change {place}: {text}" for text in contradictions(out, references)]
        if not places:
            problems.append(f"{name}: no place was found")
        files = [{str(path.relative_to(top)) for path in top.rglob("*")} for top in (references[-1], folder / "out")]
        if files[0] != files[1]:
            problems.append(f"{name}: {files[0] ^ files[1]} differ from a run that was not killed")
    print(f"{name}: {places} places, {len(problems)} problems")
    return problems


def agree(one, other):
    """Whether they differ by rounding alone: after a restart nodes come in another order, and sums with them."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(agree(value, other[key]) for key, value in one.items())
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) <= 1e-8 * abs(one)
    return one == other


def a_check_of_the_history_that_is_killed():
    """The results are there before the check begins; a restart with nothing left to do makes up for a lost check."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "case.toml").write_text(STEPS.replace("[adapt]", "check = true\n[adapt]"))
        tribound(folder, "case.toml")
        whole = read_certificate(folder / "out")["history_check"]
        (folder / "base").mkdir()
        found = False
        for place, out in left_by_kills(folder, ["case.toml"], ranks=1, stride=1):
            certificate = read_certificate(out)
            files = {"contact.csv", "adapted.msh", "report.html", "step_004.vtu"}
            if not certificate or "history_check" in certificate or not all((out / f).exists() for f in files):
                continue
            found = True
            tribound(folder, "--restart", out)
            if not agree(whole, read_certificate(out).get("history_check")):
                return [f"killed at change {place}: no check after a restart that had nothing left to do"]
        return [] if found else ["no place where all is there but the check"]


def a_shorter_path_leaves_nothing_of_the_old_one():
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "case.toml").write_text(STEPS)
        tribound(folder, "case.toml")
        (folder / "out/step_004.txt").write_text("of the user")
        result = tribound(folder, "--restart", "out/checkpoint_002.h5", *SHORTER)
        names = {path.name for path in (folder / "out").iterdir()}
        old = {"step_004.vtu", "contact_004.vtu", "checkpoint_004.h5", "unfinished_pass", "unfinished_steps"} & names
        return [f"exit code {result.returncode}, left: {sorted(old)}"] if old or "step_004.txt" not in names else []


def checkpoints_do_not_grow_with_the_path():
    """A step in the middle and the last one, on one mesh; the file of each step is that of the run."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "case.toml").write_text(STEPS.replace("max_levels = 1", "max_levels = 0"))
        steps = [round(0.00002 * (k + 1), 7) for k in range(40)]
        tribound(folder, "case.toml", "--set", f"history.steps={steps}")
        out = folder / "out"
        sizes = [(out / f"checkpoint_{k:03}.h5").stat().st_size for k in (10, 40)]
        problems = [f"{sizes[0]} bytes after 10 steps, {sizes[1]} after 40"] if sizes[1] > sizes[0] + 512 else []
        if not (out / "checkpoint.h5").samefile(out / "checkpoint_040.h5"):
            problems.append("checkpoint.h5 was written twice")
        return problems


def main():
    problems = scenario("levels, the last one's fields", LEVELS, [["case.toml", *OTHER]], ["case.toml"])
    problems += scenario("levels, the fields of all", LEVELS, [["case.toml", *ALL, *OTHER]], ["case.toml", *ALL])
    problems += scenario("levels that go on", LEVELS, [["case.toml"]], ["--restart", "out", *MORE])
    problems += scenario("levels that go on, the fields of all", LEVELS, [["case.toml", *ALL]], ["--restart", "out", *MORE])
    problems += scenario("levels of two processes", LEVELS, [["case.toml", *OTHER]], ["case.toml", *ALL], ranks=2, stride=11)
    problems += scenario("load steps", STEPS, [["case.toml", *OTHER]], ["case.toml"])
    problems += scenario("load steps that go another way", STEPS, [["case.toml"]], ["--restart", "out/checkpoint_002.h5", *SHORTER])
    problems += scenario("load steps of two processes", STEPS, [["case.toml", *OTHER]], ["case.toml"], ranks=2, stride=23)
    for test in (
        a_check_of_the_history_that_is_killed,
        a_shorter_path_leaves_nothing_of_the_old_one,
        checkpoints_do_not_grow_with_the_path,
    ):
        problems += [f"{test.__name__}: {text}" for text in test()]
    print(*problems, sep="\n")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
