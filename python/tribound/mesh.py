"""Meshes: from arrays, files, boxes and meshio."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribound import _tribound
from tribound.errors import InputError
from tribound.msh import ELEMENTS, write_msh

Ints = NDArray[np.int32]
Floats = NDArray[np.float64]

# Number of nodes of a cell, by dimension: its name in meshio and its number in Gmsh.
_CELLS = {2: {3: "triangle", 4: "quad", 6: "triangle6"}, 3: {4: "tetra", 8: "hexahedron", 10: "tetra10"}}
_FACETS = {2: {2: "line", 3: "line3"}, 3: {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8"}}


class MeshArrays:
    """A simplicial mesh as arrays, which cannot be written to."""

    def __init__(self, arrays: Mapping[str, Any]) -> None:
        self.points: Floats = arrays["points"]  #: (vertices, d)
        self.cells: Ints = arrays["cells"]  #: (cells, d + 1), vertex numbers
        self._region: Ints = arrays["region"]
        self._region_names: list[str] = arrays["region_names"]
        self._facets: Ints = arrays["facets"]
        self._group: Ints = arrays["facet_group"]
        self._boundary_names: list[str] = arrays["boundary_names"]

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.points.shape[1]

    @property
    def regions(self) -> dict[str, NDArray[np.intp]]:
        """The numbers of the cells of each region."""
        return {name: np.flatnonzero(self._region == i) for i, name in enumerate(self._region_names)}

    @property
    def region_of(self) -> Ints:
        """The number of the region of each cell, in the order of `regions`."""
        return self._region

    @property
    def boundaries(self) -> dict[str, Ints]:
        """The facets of each boundary, (facets, d) vertex numbers."""
        return {name: self._facets[self._group == i] for i, name in enumerate(self._boundary_names)}

    def __repr__(self) -> str:
        return f"{len(self.points)} vertices, {len(self.cells)} cells in {self.dimension}D"


class Mesh:
    """A mesh to solve on.

    points: (n, d). cells: (m, k) numbers of points, for triangles (k = 3), quadrilaterals (4), triangles of
    order 2 (6), in 3D tetrahedra (4), hexahedra (8), tetrahedra of order 2 (10), with the nodes in the order of
    Gmsh; or several such arrays in a dictionary by the name of meshio: {"hexahedron": a, "wedge": b}. regions:
    names with the numbers of their cells, all cells by default "body". boundaries: names with arrays of facets.
    """

    def __init__(
        self,
        points: ArrayLike,
        cells: ArrayLike | Mapping[str, ArrayLike],
        *,
        regions: Mapping[str, ArrayLike] | None = None,
        boundaries: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        self._points = _numbers(points, "points")
        self._blocks = _cell_blocks(cells, self._points.shape)
        self._regions = _regions(regions, sum(len(block) for _, block in self._blocks))
        self._boundaries = _boundaries(boundaries or {}, self._points.shape)
        self._table: dict[str, Any] | None = None
        self._arrays: MeshArrays | None = None

    @classmethod
    def _of(cls, table: dict[str, Any]) -> "Mesh":
        mesh = cls.__new__(cls)
        mesh._table = table
        mesh._arrays = None
        return mesh

    @classmethod
    def read(cls, file: str | os.PathLike[str], **options: Any) -> "Mesh":
        """A file of any format of docs/case-format.md, with the options of [mesh]: size, merge, ..."""
        return cls._of({"file": str(Path(file).absolute()), **options})

    @classmethod
    def box(cls, lower: Sequence[float], upper: Sequence[float], cells: Sequence[int]) -> "Mesh":
        """A box with the boundaries left, right, bottom, top, in 3D also back and front; region "box"."""
        return cls._of({"box": {"lower": list(lower), "upper": list(upper), "cells": list(cells)}})

    @classmethod
    def from_meshio(cls, mesh: Any) -> "Mesh":
        """A mesh of meshio. Regions and boundaries come from its cell sets, or from the physical groups of Gmsh."""
        from tribound.meshio_reader import to_arguments

        return cls(**to_arguments(mesh))

    @property
    def arrays(self) -> MeshArrays:
        """What the program makes of it: simplices, with all regions and boundaries."""
        if self._arrays is None:
            self._arrays = MeshArrays(self._read())
        return self._arrays

    @property
    def points(self) -> Floats:
        """(vertices, d)."""
        return self.arrays.points

    @property
    def cells(self) -> Ints:
        """(cells, d + 1), vertex numbers of simplices."""
        return self.arrays.cells

    @property
    def regions(self) -> dict[str, NDArray[np.intp]]:
        """The numbers of the cells of each region."""
        return self.arrays.regions

    @property
    def boundaries(self) -> dict[str, Ints]:
        """The facets of each boundary, (facets, d) vertex numbers."""
        return self.arrays.boundaries

    @property
    def dimension(self) -> int:
        """2 or 3."""
        if self._table is None:
            return self._points.shape[1]
        if "box" in self._table:
            return len(self._table["box"]["cells"])
        return self.arrays.dimension

    def table(self, directory: Path) -> dict[str, Any]:
        """[mesh] of a case; arrays are written into the directory."""
        if self._table is not None:
            return self._table
        file = directory / "mesh.msh"
        if _tribound.is_first_process():
            write_msh(file, self._points, self._blocks, self._regions, self._boundaries)
        return {"file": str(file)}

    def _read(self) -> dict[str, Any]:
        if self._table is None:
            import tempfile

            with tempfile.TemporaryDirectory(prefix="tribound-") as directory:
                file = Path(directory) / "mesh.msh"
                write_msh(file, self._points, self._blocks, self._regions, self._boundaries)
                return _tribound.read_mesh(str(file))
        if "box" in self._table:
            return _tribound.box_mesh(**self._table["box"])
        options = {key: value for key, value in self._table.items() if key != "file"}
        return _tribound.read_mesh(self._table["file"], **options)

    def __repr__(self) -> str:
        if self._table is not None:
            return f"tribound.Mesh({self._table})"
        count = sum(len(block) for _, block in self._blocks)
        return f"tribound.Mesh({len(self._points)} points, {count} cells)"


def _fail(argument: str, problem: str, hint: str) -> InputError:
    return InputError.at(argument, problem, hint, file="mesh")


def _array(values: ArrayLike, name: str, kinds: str, hint: str) -> NDArray[Any]:
    """A copy, so that the mesh stays what it is."""
    array = np.array(values, subok=True)
    if isinstance(array, np.ma.MaskedArray) and np.any(array.mask):
        raise _fail(name, "is masked in some places", "whole arrays")
    if array.size and array.dtype.kind not in kinds:
        raise _fail(name, f"has the type {array.dtype}", hint)
    return np.asarray(array)


def _numbers(points: ArrayLike, name: str) -> Floats:
    array = _array(points, name, "fiu", "real numbers").astype(np.float64)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise _fail(name, f"has the shape {array.shape}", "(n, 2) in 2D, (n, 3) in 3D")
    if not np.isfinite(array).all():
        raise _fail(name, f"is not finite in row {np.flatnonzero(~np.isfinite(array).all(axis=1))[0]}", "numbers")
    return array


def _indices(values: ArrayLike, name: str, below: int) -> NDArray[np.int64]:
    array = _array(values, name, "iu", "integers, counted from 0")
    if array.size and (array.min() < 0 or array.max() >= below):
        raise _fail(name, f"has the number {array.min() if array.min() < 0 else array.max()}", f"0 to {below - 1}")
    return array.astype(np.int64)


def _elements(values: ArrayLike, name: str, n_points: int, kinds: Mapping[int, str]) -> tuple[str, NDArray[np.int64]]:
    array = _indices(values, name, n_points)
    if array.ndim != 2 or array.shape[1] not in kinds:
        shapes = ", ".join(f"(n, {k}): {kind}" for k, kind in kinds.items())
        if kinds is _CELLS[3]:
            shapes += "; points of a plane mesh have the shape (n, 2)"
        raise _fail(name, f"has the shape {array.shape}", shapes)
    return kinds[array.shape[1]], array


def _cell_blocks(
    cells: ArrayLike | Mapping[str, ArrayLike], shape: tuple[int, ...]
) -> list[tuple[str, NDArray[np.int64]]]:
    n_points, d = shape
    if isinstance(cells, Mapping):
        for kind in cells:
            if kind not in ELEMENTS or ELEMENTS[kind][1] != d:
                known = ", ".join(name for name, (_, of, _) in ELEMENTS.items() if of == d)
                raise _fail("cells", f"has {kind!r}, no cells of a mesh in {d}D", known)
        return [(kind, _indices(block, f"cells of {kind}", n_points)) for kind, block in cells.items()]
    return [_elements(cast(ArrayLike, cells), "cells", n_points, _CELLS[d])]


def _regions(regions: Mapping[str, ArrayLike] | None, n_cells: int) -> dict[str, NDArray[np.int64]]:
    if regions is None:
        return {"body": np.arange(n_cells)}
    result = {name: _indices(ids, f"regions of {name}", n_cells).ravel() for name, ids in regions.items()}
    times = np.bincount(np.concatenate([*result.values(), np.empty(0, np.int64)]), minlength=n_cells)
    if (times != 1).any():
        cell = int(np.flatnonzero(times != 1)[0])
        raise _fail("regions", f"has cell {cell} {times[cell]} times", "each cell in one region")
    return result


def _boundaries(
    boundaries: Mapping[str, ArrayLike], shape: tuple[int, ...]
) -> dict[str, tuple[str, NDArray[np.int64]]]:
    n_points, d = shape
    return {
        name: _elements(facets, f"boundaries of {name}", n_points, _FACETS[d]) for name, facets in boundaries.items()
    }
