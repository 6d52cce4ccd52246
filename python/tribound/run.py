"""Runs, checks and verifications: the commands of the program."""

import inspect
import json
import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribound import _tribound
from tribound.case import Case
from tribound.errors import InputError
from tribound.level import Level
from tribound.mesh import Mesh
from tribound.result import Result, Step, Study, Verification
from tribound.session import Work

AnyCase = Case | Mapping[str, Any] | str
P = ParamSpec("P")
R = TypeVar("R")


class Place:
    """Where a run writes: a directory that is given, or a temporary one that lives as long as this."""

    def __init__(self, directory: str | os.PathLike[str] | None) -> None:
        self.is_temporary = directory is None
        if directory is None:
            first = _tribound.is_first_process()
            if _tribound.n_processes() > 1:
                _tribound.start()
            directory = _tribound.from_first(tempfile.mkdtemp(prefix="tribound-") if first else "")
            if first:
                weakref.finalize(self, shutil.rmtree, directory, ignore_errors=True)
        self.path = Path(directory).absolute()
        self.path.mkdir(parents=True, exist_ok=True)


class Input:
    """A case with its mesh, as the program reads it."""

    def __init__(
        self, case: AnyCase, mesh: Mesh | None, set: Mapping[str, Any] | None, place: Place
    ) -> None:
        self._case = case if isinstance(case, Case) else Case(case)
        if not isinstance(mesh, Mesh | None):
            raise TypeError(f"a mesh is a tb.Mesh, such as tb.Mesh.read(file), and not a {type(mesh).__name__}")
        self._mesh = mesh
        self._set = set or {}
        self.document = self._case.document(self._dimension)
        self.overrides = self._case.assignments() + Case({}, set=set).assignments()
        if mesh is not None:
            self.overrides.append(f"mesh={_tribound.to_toml(mesh.table(place.path))}")
        if place.is_temporary:
            self.overrides += ["output.vtu=false", "output.mesh=false"]
        self.overrides.append(f"output.directory={_tribound.to_toml(str(place.path))}")

    def _dimension(self) -> int:
        if self._mesh is not None:
            return self._mesh.dimension
        source = self._case.source if isinstance(self._case.source, Mapping) else {}
        table = {**source, **self._case.overrides, **self._set}.get("mesh")
        if isinstance(table, Mapping):
            for box in [table.get("box"), *(table.get("boxes") or {}).values()]:
                if isinstance(box, Mapping) and "lower" in box:
                    return len(box["lower"])
            if "file" in table:
                return Mesh.read(**table).dimension
        raise InputError.at(
            "mesh", "does not tell the dimension, on which functions of vectors depend", "a box, a file, or a Mesh"
        )


class Hooks:
    """What the program calls while it runs, in its own thread."""

    def __init__(
        self,
        work: "Work[Result]",
        on_level: Callable[[Level], Any] | None,
        on_step: Callable[[Step], Any] | None,
        mark: Callable[[Level], ArrayLike] | None,
        stop: Callable[[Level], str | bool | None] | None,
        keep_levels: bool,
    ) -> None:
        self.levels: list[Level] = []
        self._work = work
        self._on_level = on_level
        self._keep_levels = keep_levels
        self._on_step = on_step
        self.mark = None if mark is None else self._mark(mark)
        self.stop = None if stop is None else self._stop(stop)

    def level(self, core: Any) -> None:
        """Called for every level with a bound, and for every load step."""
        level = Level(core)
        if self.levels and (not self._keep_levels or self.levels[-1].number == level.number):
            self.levels.pop()
        while self.levels and self.levels[-1].number >= level.number:  # another pass over the load steps
            self.levels.pop()
        self.levels.append(level)
        if self._on_level is not None:
            self._work.call(self._on_level, level)
        self._work.show(level)

    def step(self, number: int, residual: float, relative: float | None, seconds: float) -> None:
        """Called after every step of Newton's method."""
        self._work.go_on()
        if self._on_step is not None:
            self._work.call(self._on_step, Step(number, residual, relative, seconds))

    def _mark(self, mark: Callable[[Level], ArrayLike]) -> Callable[[Any], NDArray[np.int64]]:
        def marked(core: Any) -> NDArray[np.int64]:
            level = Level(core)
            cells = np.asarray(self._work.call(mark, level))
            if cells.dtype == bool:
                if cells.shape != level.eta.shape:
                    raise IndexError(f"the marking returns {cells.shape} truth values for {len(level.eta)} cells")
                cells = np.flatnonzero(cells)
            if cells.ndim != 1 or (cells.size and cells.dtype.kind not in "iu"):
                raise TypeError("a marking returns the numbers of cells, or one truth value per cell")
            cells = np.unique(cells)  # ascending
            if cells.size and (cells[0] < 0 or cells[-1] >= len(level.eta)):
                wrong = cells[0] if cells[0] < 0 else cells[-1]
                raise IndexError(f"the marking returns cell {wrong}, but there are {len(level.eta)}, counted from 0")
            return cells.astype(np.int64)

        return marked

    def _stop(self, stop: Callable[[Level], str | bool | None]) -> Callable[[Any], str]:
        def reason(core: Any) -> str:
            why = self._work.call(stop, Level(core))
            return why if isinstance(why, str) else "the stopping rule of the program is met" if why else ""

        return reason


def _work(
    case: AnyCase | None = None,
    mesh: Mesh | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    directory: str | os.PathLike[str] | None = None,
    on_level: Callable[[Level], Any] | None = None,
    on_step: Callable[[Step], Any] | None = None,
    mark: Callable[[Level], ArrayLike] | None = None,
    stop: Callable[[Level], str | bool | None] | None = None,
    keep_levels: bool = False,
    verbose: bool = False,
    restart: str | os.PathLike[str] | None = None,
) -> "Work[Result]":
    if (case is None) == (restart is None):
        raise TypeError("either a case or restart, the directory of a run, is given")
    if restart is not None:
        if mesh is not None or directory is not None:
            raise TypeError("a restart goes on with the mesh and in the directory of its run")
        found = Path(restart)
        place = Place(found if found.is_dir() else found.parent)
        given = None
    else:
        assert case is not None
        place = Place(directory)
        given = Input(case, mesh, set, place)

    def command(work: "Work[Result]") -> Result:
        hooks = Hooks(work, on_level, on_step, mark, stop, keep_levels)
        if given is not None:
            _tribound.run(given.document, given.overrides, not verbose, hooks)
        else:
            _tribound.restart(str(restart), Case({}, set=set).assignments(), not verbose, hooks)
        return Result(place, hooks.levels)

    return Work(command, verbose)


def _options_of(work: Callable[P, Any]) -> Callable[[Callable[..., R]], Callable[P, R]]:
    """Gives a function the arguments of another one, for callers, editors and mypy."""

    def give(function: Callable[..., R]) -> Callable[P, R]:
        returns = inspect.signature(function).return_annotation
        signature = inspect.signature(work).replace(return_annotation=returns)
        setattr(function, "__signature__", signature)
        return function

    return give


@_options_of(_work)
def run(*arguments: Any, **options: Any) -> Result:
    """Solves a case, as `tribound run`.

    mesh: in place of that of the case. set: keys to override. directory: where the files of the run go; by
    default a temporary one, which goes with the result. on_level(level) is called after every level or load
    step, a second time for the last one where that has changed since; on_step(step) after every step of
    Newton's method. mark(level) returns the cells to bisect, in place of adapt.marking; stop(level) a reason
    to stop, or True. keep_levels: all levels stay in result.levels. verbose: the text of the program is
    printed. restart: the directory of a run with checkpoints, in place of a case.

    Not to converge, or not to be certified, is no exception: see result.status.
    """
    return _work(*arguments, **options).result()


@_options_of(_work)
def levels(*arguments: Any, **options: Any) -> Iterator[Level]:
    """The levels, or load steps, of a run as they come, with the options of run(). To leave the loop ends the
    run. The last level comes a second time where it has changed since."""
    return _work(*arguments, **options).values()


def check(case: AnyCase, mesh: Mesh | None = None, *, set: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """What a run would work on, with what is doubtful about it, as `tribound check --json`."""
    place = Place(None)
    given = Input(case, mesh, set, place)
    work = Work(lambda _: _tribound.check(given.document, given.overrides), False)
    found: dict[str, Any] = json.loads(work.result())
    return found


def verify(
    case: AnyCase,
    mesh: Mesh | None = None,
    *,
    refinements: int = 2,
    set: Mapping[str, Any] | None = None,
    directory: str | os.PathLike[str] | None = None,
    verbose: bool = False,
) -> Verification:
    """Compares the bound with the error that it bounds, as `tribound verify`; for small cases."""
    place = Place(directory)
    given = Input(case, mesh, set, place)
    Work(lambda _: _tribound.verify(given.document, given.overrides, not verbose, refinements), verbose).result()
    return Verification(json.loads((place.path / "verify.json").read_text()))


def study(
    case: AnyCase,
    mesh: Mesh | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    directory: str | os.PathLike[str] | None = None,
    verbose: bool = False,
) -> Study:
    """Measures what adaptation and stopping by the bound bring, as `tribound study`; slow."""
    place = Place(directory)
    given = Input(case, mesh, set, place)
    Work(lambda _: _tribound.study(given.document, given.overrides, not verbose), verbose).result()
    return Study(place, json.loads((place.path / "study.json").read_text()))
