"""Meshes of meshio as arguments of Mesh."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribound.errors import InputError
from tribound.msh import ELEMENTS

# Where the order of nodes in meshio, which is that of VTK, differs from Gmsh's: position in Gmsh -> position in meshio.
_ORDER = {
    "tetra10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
    "hexahedron20": [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
    "hexahedron27": [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23, 25, 26],
    "wedge15": [0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10],
    "pyramid13": [0, 1, 2, 3, 4, 5, 8, 9, 6, 10, 7, 11, 12],
}


def to_arguments(mesh: Any) -> dict[str, Any]:
    """points, cells, regions and boundaries; the groups are cell sets, or the physical groups of a .msh."""
    blocks = [(block.type, np.asarray(block.data)) for block in mesh.cells]
    unknown = {kind for kind, _ in blocks} - ELEMENTS.keys() - {"vertex"}
    if unknown:
        raise InputError.at("cells", f"has elements of type {', '.join(sorted(unknown))}", "solids", "mesh")
    d = max((ELEMENTS[kind][1] for kind, _ in blocks if kind != "vertex"), default=0)
    if d < 2:
        raise InputError.at("cells", "has no cells", "triangles, quadrilaterals or solids", "mesh")
    points = np.asarray(mesh.points, dtype=float)
    if d == 2 and points.shape[1] == 3:
        if np.ptp(points[:, 2]) > 0:
            raise InputError.at("points", "are those of a surface in space", "a plane at z = const", "mesh")
        points = points[:, :2]
    groups = _groups(mesh, blocks)
    cells: dict[str, NDArray[Any]] = {}
    regions: dict[str, list[int]] = {}
    boundaries: dict[str, NDArray[Any]] = {}
    n_cells = 0
    by_kind = sorted({kind for kind, _ in blocks if kind != "vertex" and ELEMENTS[kind][1] == d})
    for kind in by_kind:
        for index, (of_block, data) in enumerate(blocks):
            if of_block != kind:
                continue
            rows = data[:, _ORDER[kind]] if kind in _ORDER else data
            cells[kind] = np.concatenate([cells[kind], rows]) if kind in cells else rows
            for name, members in groups.items():
                if len(members[index]):
                    regions.setdefault(name, []).extend(n_cells + int(i) for i in members[index])
            n_cells += len(data)
    for name, members in groups.items():
        facets = [
            data[members[index]]
            for index, (kind, data) in enumerate(blocks)
            if kind != "vertex" and ELEMENTS[kind][1] == d - 1 and len(members[index])
        ]
        if len({array.shape[1] for array in facets}) > 1:
            raise InputError.at(name, "has facets of several types", "a boundary for each type", "mesh")
        if facets:
            boundaries[name] = np.concatenate(facets)
    rest = sorted(set(range(n_cells)).difference(*regions.values())) if regions else list(range(n_cells))
    if rest:
        regions["body"] = rest
    return {"points": points, "cells": cells, "regions": regions, "boundaries": boundaries}


def _groups(mesh: Any, blocks: list[tuple[str, NDArray[Any]]]) -> dict[str, list[NDArray[Any]]]:
    """The members of each group in each block."""
    empty = np.empty(0, dtype=int)
    groups: dict[str, list[NDArray[Any]]] = {}
    for name, members in (mesh.cell_sets or {}).items():
        if not name.startswith("gmsh:"):
            groups[name] = [
                empty if numbers is None else _members(numbers, name, len(data))
                for numbers, (_, data) in zip(members, blocks, strict=True)
            ]
    tags = (mesh.cell_data or {}).get("gmsh:physical")
    if tags is not None:
        names = {(int(tag), int(dim)): name for name, (tag, dim) in (mesh.field_data or {}).items()}
        for index, ((kind, _), of_block) in enumerate(zip(blocks, tags)):
            if kind == "vertex":
                continue
            for tag in np.unique(of_block):
                name = names.get((int(tag), ELEMENTS[kind][1]), f"group_{tag}")
                groups.setdefault(name, [empty] * len(blocks))[index] = np.flatnonzero(of_block == tag)
    return groups


def _members(numbers: Any, name: str, count: int) -> NDArray[Any]:
    array = np.asarray(numbers)
    if array.size and (array.dtype.kind not in "iu" or array.min() < 0 or array.max() >= count):
        raise InputError.at(name, "has other members than cells of its block", f"integers from 0 to {count - 1}", "mesh")
    return array.astype(int)
