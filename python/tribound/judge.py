"""The guaranteed error of any program's solution."""

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribound import _tribound
from tribound.errors import InputError
from tribound.mesh import Mesh
from tribound.run import AnyCase, Input, Place
from tribound.session import Work

Interval = tuple[float, float]
Solution = str | os.PathLike[str] | tuple[ArrayLike, ...]


class Judgement(dict[str, Any]):
    """judgement.json, see docs/output.md; intervals as pairs, of which the upper end may be infinite.

    Of all load steps: intervals are those of the worst.
    """

    def __init__(self, place: Place, content: Mapping[str, Any]) -> None:
        super().__init__(content)
        self._place = place

    @property
    def status(self) -> str:
        """judged, wide or no bound; with accept: accepted, rejected or undecided."""
        return str(self["status"])

    @property
    def steps(self) -> list["Judgement"]:
        """Of every load step; with steps=True, else empty."""
        return [Judgement(self._place, step) for step in self.get("steps", [])]

    @property
    def relative(self) -> Interval | None:
        """The relative error of their displacement in the energy norm; None where there is no bound."""
        return self._interval("displacement", "relative")

    @property
    def stress(self) -> Interval | None:
        """That of their stress; None where it was not read, or has no bound."""
        return self._interval("stress", "relative")

    @property
    def error(self) -> Interval | None:
        """The error of their displacement in the energy norm."""
        return self._interval("displacement", "error")

    @property
    def directory(self) -> Path:
        """The files of the judgement, and of the run behind it."""
        return self._place.path / "judge"

    def _interval(self, field: str, name: str) -> Interval | None:
        judged = self["steps"][self["worst"] - 1] if "steps" in self else self
        if judged[field] is None or judged[field][name] is None:
            return None
        lower, upper = judged[field][name]
        return lower, np.inf if upper is None else upper


def judge(
    case: AnyCase,
    solution: Solution | Sequence[Solution],
    mesh: Mesh | None = None,
    *,
    field: str = "",
    stress: str = "",
    interpolate: bool = False,
    steps: bool = False,
    step: int | None = None,
    load_step: int | None = None,
    numbers: Mapping[str, float | Sequence[float]] | None = None,
    accept: float | None = None,
    set: Mapping[str, Any] | None = None,
    directory: str | os.PathLike[str] | None = None,
    verbose: bool = False,
) -> Judgement:
    """Bounds the error of a solution on the mesh of the case from both sides, as `tribound judge`.

    solution: a file of docs/judge.md, or arrays: points (n, d), displacements (n, d) and perhaps stresses
    (n, 3) xx yy xy or (n, 6) xx yy zz xy yz xz. field, stress, step: which of the file. interpolate: a file
    on another mesh is judged by its interpolant. steps: every load step of the case is judged; solution may
    be a list then, one for each. numbers: what was computed for quantities of the case, with steps a list
    each. accept: the largest relative error.
    """
    place = Place(directory)
    given = Input(case, mesh, set, place)
    values = {name: np.atleast_1d(value).tolist() for name, value in (numbers or {}).items()}
    solutions: Sequence[Any] = solution if isinstance(solution, list) else [solution]
    options = {
        "solutions": [_file(place.path, number, one) for number, one in enumerate(solutions)],
        "field": field,
        "stress": stress,
        "interpolate": interpolate,
        "steps": steps,
        "step": step,
        "load_step": load_step,
        "numbers": [f"{name}={','.join(map(repr, listed))}" for name, listed in values.items()],
        "accept": accept,
    }
    Work(lambda _: _tribound.judge(given.document, given.overrides, not verbose, options), verbose).result()
    return Judgement(place, json.loads((place.path / "judge/judgement.json").read_text()))


def _file(directory: Path, number: int, solution: Solution) -> str:
    if isinstance(solution, str | os.PathLike):
        return os.fspath(solution)
    return str(_write(directory / f"solution{number or ''}.csv", *solution))


def _write(file: Path, points: ArrayLike, displacement: ArrayLike, stress: ArrayLike | None = None) -> Path:
    """The arrays as a table."""
    x, u = np.asarray(points, dtype=float), np.asarray(displacement, dtype=float)
    if x.ndim != 2 or x.shape[1] not in (2, 3) or u.shape != x.shape:
        problem = f"has points of shape {x.shape} and displacements of shape {u.shape}"
        raise InputError.at("solution", problem, "(n, d) both", "judge")
    names = [*"xyz"[: x.shape[1]], *("u" + axis for axis in "xyz"[: x.shape[1]])]
    columns = [x, u]
    if stress is not None:
        s = np.asarray(stress, dtype=float)
        components = {3: ("xx", "yy", "xy"), 6: ("xx", "yy", "zz", "xy", "yz", "xz")}
        if s.ndim != 2 or len(s) != len(x) or s.shape[1] not in components:
            raise InputError.at("solution", f"has stresses of shape {s.shape}", "(n, 3) or (n, 6)", "judge")
        names += ["s" + component for component in components[s.shape[1]]]
        columns.append(s)
    np.savetxt(file, np.column_stack(columns), delimiter=",", header=",".join(names), comments="", fmt="%.17g")
    return file
