"""A case with several values of some of its keys."""

import itertools
import json
import os
import pickle
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribound import _tribound
from tribound.case import Case
from tribound.errors import InputError, SolveError
from tribound.mesh import Mesh
from tribound.run import AnyCase, Input, Place, run

# What the program ends with, by the status of a run.
_EXIT_CODES = {"certified": 0, "budget": 3}
_FAILED = 2


def sweep(
    case: AnyCase,
    values: Mapping[str, Sequence[Any] | NDArray[Any]],
    mesh: Mesh | None = None,
    *,
    jobs: int = 1,
    set: Mapping[str, Any] | None = None,
    directory: str | os.PathLike[str] | None = None,
) -> dict[str, NDArray[Any]]:
    """Solves the case with all combinations of the values, the first key varying slowest.

    Keys are dotted ones of the case, or names of its parameters. jobs: processes at a time. Returns a column for
    each key, then "status", "reason" and the figures of sweep.csv (docs/output.md), a row for each run; numbers
    that a run does not have are nan. The files of the runs stay in `directory`, if it is given. A run that fails
    has its row; input that is wrong in any run raises InputError before anything is solved.
    """
    if not values:
        raise InputError.at("values", "is empty", "keys with values")
    if jobs < 1:
        raise ValueError(f"jobs is {jobs}; right would be the number of processes at a time, 1 or more")
    base = case if isinstance(case, Case) else Case(case)
    place = Place(directory)
    keys = list(values)
    combinations = list(itertools.product(*(list(column) for column in values.values())))
    cases = [base.but(**{**dict(set or {}), **dict(zip(keys, row))}) for row in combinations]
    for one in cases:
        _check(one, mesh)
    folders = [place.path / f"{number:04d}" for number in range(1, len(cases) + 1)]
    if jobs == 1:
        codes = [solve(one, mesh, folder) for one, folder in zip(cases, folders)]
    else:
        codes = _solve_apart(cases, mesh, folders, jobs)
    rows = [_row(folder, code) for folder, code in zip(folders, codes)]
    table = {key: np.array([row[i] for row in combinations]) for i, key in enumerate(keys)}
    for name in dict.fromkeys(name for row in rows for name in row):
        table[name] = _column([row.get(name) for row in rows])
    return table


def _check(case: Case, mesh: Mesh | None) -> None:
    """Raises InputError for a case that is wrong without looking at its mesh."""
    given = Input(case, mesh, None, Place(None))
    given.document.check(given.overrides)


def _row(folder: Path, code: int) -> dict[str, Any]:
    file = folder / "certificate.json"
    sha256 = json.loads(file.read_text())["case"]["sha256"] if file.exists() else ""
    return _tribound.read_results(str(folder), code, sha256)


def _column(values: list[Any]) -> NDArray[Any]:
    if any(isinstance(value, str) for value in values):
        return np.array([value or "" for value in values])
    return np.array([np.nan if value is None else value for value in values], dtype=float)


def solve(case: Case, mesh: Mesh | None, folder: Path) -> int:
    """A run of the sweep; returns the exit code that the program would have."""
    try:
        status = run(case, mesh, directory=folder).status
    except SolveError:
        status = "failed"
    return _EXIT_CODES.get(status, _FAILED)


def _solve_apart(cases: list[Case], mesh: Mesh | None, folders: list[Path], jobs: int) -> list[int]:
    threads = str(max(1, (os.cpu_count() or 1) // jobs))
    environment = {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads, **os.environ}
    environment["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)
    running: list[subprocess.Popen[bytes]] = []

    def solve_one(task: bytes) -> int:
        with subprocess.Popen([sys.executable, "-m", "tribound.worker"], stdin=subprocess.PIPE, env=environment) as child:
            running.append(child)
            child.communicate(task)
        return child.returncode

    tasks = [_dump((case, mesh, folder)) for case, folder in zip(cases, folders)]
    with ThreadPoolExecutor(jobs) as pool:
        try:
            codes = list(pool.map(solve_one, tasks))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for child in running:
                child.terminate()
            raise
    return [128 - code if code < 0 else code for code in codes]


def _dump(task: tuple[Case, Mesh | None, Path]) -> bytes:
    """The task for another process; functions of the script itself need cloudpickle."""
    if not task[0].has_functions():
        return pickle.dumps(task)
    try:
        import cloudpickle
    except ImportError as error:
        raise ImportError(
            "functions reach other processes by cloudpickle: apt install python3-cloudpickle, or jobs=1"
        ) from error
    return cloudpickle.dumps(task)  # type: ignore[no-any-return]
