"""Cases: what a case file says, from a dictionary, a text or a file, with functions of Python as data."""

import inspect
import os
from collections.abc import Callable, Mapping
from operator import index
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribound import _tribound
from tribound.errors import InputError

Datum = Callable[..., Any]  # numbers, but mypy knows no type of what NumPy returns


class Function:
    """A function of Python as a datum: f(x), or f(x, t) with the load factor t of a history.

    x has the shape (d, n): x[0] are the first coordinates of n points. f returns n numbers, or one for all of
    them. For a polynomial, `degree` tells its total degree; what f does between the points at which it is
    evaluated is otherwise unknown, and the certificate says so.
    """

    def __init__(self, f: Datum, degree: int | None = None) -> None:
        if not callable(f):
            raise TypeError(f"{f!r} is no function")
        if degree is not None and not 0 <= index(degree) <= 1000:
            raise ValueError(f"the degree of a polynomial is {degree}: 0 to 1000, None for other functions")
        self._f = f
        self.degree = degree
        self.uses_time = _takes_time(f)

    def call(self, x: NDArray[np.float64], *t: float) -> Any:
        """What f returns; what it masks is undefined."""
        values: Any = self._f(x, *t)
        if isinstance(values, np.ma.MaskedArray):
            values = values.astype(float)
            values = values.filled(np.nan)
        return values

    def component(self, i: int, n: int, key: str) -> "Function":
        """A component of a function that returns an array of shape (n, number of points), or a list of n."""

        def call(x: NDArray[np.float64], *t: float) -> Any:
            returned = self.call(x, *t)
            if isinstance(returned, list | tuple) and len(returned) == n:
                return returned[i]
            values = np.asarray(returned)
            if values.shape not in ((n, x.shape[1]), (n, 1), (n,)):
                raise InputError.at(
                    key,
                    f"the function returns an array of shape {values.shape} for {x.shape[1]} points",
                    f"({n}, {x.shape[1]})",
                )
            return np.broadcast_to(values[i], x.shape[1])

        one = Function(call, self.degree)
        one.uses_time = self.uses_time
        return one


def _takes_time(f: Datum) -> bool:
    """Whether f must be called with a second argument."""
    try:
        parameters = inspect.signature(f).parameters.values()
    except (TypeError, ValueError):  # of some functions in C nothing is known
        return False
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    others = [p for p in parameters if p.kind in positional][1:]
    if others and others[0].name == "t" and others[0].default is not inspect.Parameter.empty:
        raise TypeError(
            f"{f!r} has a default for t, so that it is not known whether t is the load factor: "
            "f(x, t) if it is, another name if it is not"
        )
    return any(p.default is inspect.Parameter.empty for p in others)


class Case:
    """A case: a dictionary with the tables and keys of a case file, or the TOML text of one.

    `set` overrides keys, as `--set` does: {"degree": 3, "boundary.top.pressure": "2*x"}. The names are those of
    docs/case-format.md; a Function, or any function f(x), may stand wherever a formula may, except for
    directions and surfaces. Relative paths start from the current directory, or from that of the file.
    """

    def __init__(
        self, source: Mapping[str, Any] | str, *, set: Mapping[str, Any] | None = None, name: str = "case"
    ) -> None:
        if not isinstance(source, Mapping | str):
            hint = "tb.Case.read(file)" if isinstance(source, os.PathLike) else "a dict, or TOML text"
            raise TypeError(f"a case is made of {type(source).__name__}; right would be {hint}")
        if isinstance(source, str) and source.endswith(".toml") and "\n" not in source:
            problem = "is the name of a file, where the text of a case stands"
            raise InputError.at(source, problem, f"tb.Case.read({source!r})", name)
        self.source = source
        self.name = name
        self.overrides = dict(set or {})

    @classmethod
    def read(cls, file: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None) -> "Case":
        """The case of a file."""
        return cls(_tribound.read_text(os.fspath(file)), set=set, name=os.fspath(file))

    def but(self, **set: Any) -> "Case":
        """The same case with other values; dotted names as `case.but(**{"adapt.tolerance": 0.1})`."""
        return Case(self.source, set={**self.overrides, **set}, name=self.name)

    def has_functions(self) -> bool:
        """Whether there are functions of Python in it."""
        return _has_functions(self.source)

    def document(self, dimension: Callable[[], int]) -> _tribound.Document:
        """What the program reads. `dimension` is asked where a function gives all components of a vector."""
        if isinstance(self.source, str):
            return _tribound.Document.parse(self.source, self.name)
        return _tribound.Document(_prepared(self.source, "", dimension), self.name)

    def assignments(self) -> list[str]:
        """The overrides, as `--set` has them."""
        return [f"{key}={_assigned(key, value)}" for key, value in self.overrides.items()]

    def __repr__(self) -> str:
        keys = "TOML" if isinstance(self.source, str) else ", ".join(self.source)
        return f"tribound.Case({self.name}: {keys})"


def _assigned(key: str, value: Any) -> str:
    """The value as TOML."""
    if _has_functions(value):
        raise InputError.at(key, "is a function", "functions stand in the dictionary of the case", "set")
    try:
        return _tribound.to_toml(_prepared(value, key, lambda: 0))
    except InputError as error:
        raise InputError.at(key, error.problem, error.hint, "set") from None


def _is_function(value: Any) -> bool:
    return isinstance(value, Function) or callable(value)


def _has_functions(value: Any) -> bool:
    if isinstance(value, Mapping):
        return any(map(_has_functions, value.values()))
    if isinstance(value, list | tuple):
        return any(map(_has_functions, value))
    return _is_function(value)


_VECTOR_KEYS = _tribound.vector_keys()


def _prepared(value: Any, key: str, dimension: Callable[[], int]) -> Any:
    """The value with functions as Function, and those for vectors taken apart."""
    if isinstance(value, Mapping):
        return {
            name: _prepared(item, f"{key}.{name}" if key else str(name), dimension)
            for name, item in value.items()
        }
    if isinstance(value, list | tuple):
        return [
            _function(item) if _is_function(item) else _prepared(item, f"{key}[{i}]", dimension)
            for i, item in enumerate(value)
        ]
    if isinstance(value, np.bool_):  # for C++ a number
        return bool(value)
    if not _is_function(value):
        return value
    name = key.rsplit(".", 1)[-1]
    if name not in _VECTOR_KEYS:
        return _function(value)
    d = dimension()
    n = d * (d + 1) // 2 if name == "initial_stress" else d
    return [_function(value).component(i, n, key) for i in range(n)]


def _function(value: Any) -> Function:
    return value if isinstance(value, Function) else Function(value)
