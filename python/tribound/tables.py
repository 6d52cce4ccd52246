"""The tables of a run, pandas.DataFrame where pandas is installed, else dict of arrays (docs/output.md)."""

import csv
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribound.result import Result

NAMES = ("convergence", "newton", "history", "contact", "quantities", "probes", "sections")
# Names that a user chose may look like numbers, and a column of measured numbers may by chance be whole.
WORDS = {"body", "boundary", "control", "name", "probe", "region", "rests_on", "section", "unit"}
COUNTS = {"accepted", "cells", "cuts", "delta_updates", "dofs", "exact", "facet", "in_equilibrium", "level"}
COUNTS |= {"load_step", "newton_steps", "passes", "point", "status", "step"}


def table(result: Result, name: str) -> Any:
    """`name`: convergence, newton, history, contact, quantities, probes or sections.

    Unknown numbers are NaN. ValueError: no such table; FileNotFoundError: this run has not written it.
    """
    if name not in NAMES:
        raise ValueError(f"there is no table {name!r}; there are {', '.join(NAMES)}")
    file = Path(result.directory) / f"{name}.csv"
    if not file.is_file():
        written = [known for known in NAMES if file.with_name(f"{known}.csv").is_file()]
        raise FileNotFoundError(f"this run has no {file.name}; it has {', '.join(written) or 'no tables'}")
    columns = read(file)
    if find_spec("pandas") is None:
        return columns
    return import_module("pandas").DataFrame(columns)


def read(file: Path) -> dict[str, NDArray[Any]]:
    """A CSV file, column by column."""
    with file.open(newline="", encoding="utf-8") as stream:
        head, *rows = csv.reader(stream)
    return {name: _column(name, [row[i] for row in rows]) for i, name in enumerate(head)}


def _column(name: str, words: list[str]) -> NDArray[Any]:
    if name in WORDS:
        return np.array(words, object)
    if name in COUNTS:
        return np.array(words, np.int64)
    return np.array([float(word) if word else np.nan for word in words])
