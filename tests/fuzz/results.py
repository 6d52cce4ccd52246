"""Reads the files of a run with the standard library alone: docs/output.md. What does not parse raises Unreadable."""

import csv
import json
import re
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

DIMENSION_OF_CELL_TYPE = {68: 1, 69: 2, 71: 3}  # VTK Lagrange curve, triangle, tetrahedron
TYPES = {"Float64": "<f8", "Float32": "<f4", "Int32": "<i4", "Int64": "<i8", "UInt8": "<u1", "UInt64": "<u8"}
ARRAY = re.compile(rb'<DataArray type="(\w+)" Name="(\w+)"(?: NumberOfComponents="(\d+)")? format="appended" offset="(\d+)"')


class Unreadable(Exception):
    """A file that is incomplete or not in its format."""


@dataclass
class Grid:
    """A VTU file: cells of one type with their own points."""

    dimension: int
    points: np.ndarray  # cells x nodes x 3
    arrays: dict  # of points: cells x nodes x components; of cells: cells


def inflate(data, at):
    """An array of compressed blocks: number of blocks, size of a block, size of the last one, compressed sizes."""
    n_blocks, size, last = np.frombuffer(data, "<u8", 3, at)
    sizes = np.frombuffer(data, "<u8", n_blocks, at + 24)
    at += 24 + 8 * int(n_blocks)
    parts = []
    for n in sizes.tolist():
        parts.append(zlib.decompress(data[at : at + n]))
        at += n
    whole = [size] * len(parts)
    if parts and last:
        whole[-1] = last
    if [len(part) for part in parts] != whole:
        raise Unreadable("a block has not the size it announces")
    return b"".join(parts)


def read_grid(file):
    """None where the grid has no cells."""
    data = file.read_bytes()
    try:
        counts = re.search(rb'NumberOfPoints="(\d+)" NumberOfCells="(\d+)"', data)
        n_points, n_cells = int(counts[1]), int(counts[2])
        start = data.index(b'<AppendedData encoding="raw">')
        start = data.index(b"_", start) + 1
        if not data.endswith(b"</VTKFile>\n"):
            raise Unreadable("the end is missing")
        if n_cells == 0:
            return None
        arrays = {}
        for kind, name, components, offset in ARRAY.findall(data[:start]):
            values = np.frombuffer(inflate(data, start + int(offset)), TYPES[kind.decode()])
            arrays[name.decode()] = values.reshape(-1, int(components)) if components not in (b"", b"1") else values
        types = np.unique(arrays.pop("types"))
        n_nodes = n_points // n_cells
        nodes = arrays.pop("connectivity").reshape(n_cells, n_nodes)
        arrays.pop("offsets")
        points = arrays.pop("Points")[nodes]
        named = {n: a[nodes] if len(a) == n_points and n_points != n_cells else a for n, a in arrays.items()}
        return Grid(DIMENSION_OF_CELL_TYPE[int(types.item())], points, named)
    except (KeyError, ValueError, TypeError, IndexError, zlib.error) as error:
        raise Unreadable(f"{file.name}: {error!r}") from error


def read_json(file):
    try:
        return json.loads(file.read_text(), parse_constant=lambda word: no_constant(file, word))
    except (ValueError, UnicodeDecodeError) as error:
        raise Unreadable(f"{file.name}: {error}") from error


def no_constant(file, word):
    raise Unreadable(f"{file.name}: {word} is no JSON")


def read_table(file):
    """Rows as dictionaries of numbers, None for empty entries; words stay words."""
    try:
        text = file.read_text()
        if not text.endswith("\n"):
            raise Unreadable(f"{file.name}: the last line is not complete")
        rows = list(csv.reader(text.splitlines()))
        if any(len(row) != len(rows[0]) for row in rows):
            raise Unreadable(f"{file.name}: rows of different lengths")
        return [dict(zip(rows[0], map(number, row))) for row in rows[1:]]
    except (UnicodeDecodeError, IndexError) as error:
        raise Unreadable(f"{file.name}: {error}") from error


def number(word):
    if word == "":
        return None
    try:
        return float(word)
    except ValueError:
        return word


@dataclass
class Results:
    """What a run left in its directory; absent files are None or missing."""

    directory: Path
    certificate: dict
    convergence: list
    newton: list
    contact: list
    levels: list  # names of the VTU files, in order

    def level(self, number):
        return read_grid(self.directory / self.levels[number])


def read_results(directory):
    """Reads everything, and so notices incomplete files."""
    directory = Path(directory)

    def table(name):
        return read_table(directory / name) if (directory / name).exists() else None

    certificate = directory / "certificate.json"
    return Results(
        directory,
        read_json(certificate) if certificate.exists() else None,
        table("convergence.csv"),
        table("newton.csv"),
        table("contact.csv"),
        sorted(file.name for file in directory.glob("level_*.vtu")),
    )
