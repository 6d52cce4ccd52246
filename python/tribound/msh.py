"""Arrays as a file of Gmsh (MSH 2.2, binary), which cases read."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tribound.errors import InputError

Ints = NDArray[np.int64]

# The elements by their names in meshio: number in Gmsh, dimension, nodes.
ELEMENTS = {
    "line": (1, 1, 2),
    "line3": (8, 1, 3),
    "triangle": (2, 2, 3),
    "triangle6": (9, 2, 6),
    "quad": (3, 2, 4),
    "quad8": (16, 2, 8),
    "quad9": (10, 2, 9),
    "tetra": (4, 3, 4),
    "tetra10": (11, 3, 10),
    "hexahedron": (5, 3, 8),
    "hexahedron20": (17, 3, 20),
    "hexahedron27": (12, 3, 27),
    "wedge": (6, 3, 6),
    "wedge15": (18, 3, 15),
    "pyramid": (7, 3, 5),
    "pyramid13": (19, 3, 13),
}


def write_msh(
    file: Path,
    points: NDArray[np.float64],
    blocks: Sequence[tuple[str, Ints]],
    regions: Mapping[str, Ints],
    boundaries: Mapping[str, tuple[str, Ints]],
) -> None:
    """Writes the mesh. Cells are numbered through the blocks; each is in one region."""
    d = points.shape[1]
    tag_of_cell = np.zeros(sum(len(block) for _, block in blocks), np.int32)
    names = [(d, name) for name in regions] + [(d - 1, name) for name in boundaries]
    for tag, cells in enumerate(regions.values(), 1):
        tag_of_cell[cells] = tag
    parts = []
    first = 0
    for kind, block in blocks:
        parts.append((kind, block, tag_of_cell[first : first + len(block)]))
        first += len(block)
    for tag, (kind, facets) in enumerate(boundaries.values(), len(regions) + 1):
        parts.append((kind, facets, np.full(len(facets), tag, np.int32)))
    temporary = file.with_suffix(".part")
    with temporary.open("wb") as out:
        out.write(b"$MeshFormat\n2.2 1 8\n" + np.int32(1).tobytes() + b"\n$EndMeshFormat\n")
        out.write(f"$PhysicalNames\n{len(names)}\n".encode())
        for tag, (dimension, name) in enumerate(names, 1):
            if not isinstance(name, str) or not name.strip() or '"' in name or not name.isprintable() or len(name) > 100:
                hint = "at most 100 printable characters without quotes"
                raise InputError.at("regions and boundaries", f"has the name {name!r}", hint, "mesh")
            out.write(f'{dimension} {tag} "{name}"\n'.encode())
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(points)}\n".encode())
        out.write(_nodes(points) + b"\n$EndNodes\n")
        out.write(f"$Elements\n{sum(len(block) for _, block, _ in parts)}\n".encode())
        number = 1
        for kind, block, tags in parts:
            out.write(_elements(kind, block, tags, number))
            number += len(block)
        out.write(b"\n$EndElements\n")
    os.replace(temporary, file)


def _nodes(points: NDArray[np.float64]) -> bytes:
    nodes = np.zeros(len(points), [("number", "<i4"), ("x", "<f8", 3)])
    nodes["number"] = np.arange(1, len(points) + 1)
    nodes["x"][:, : points.shape[1]] = points
    return nodes.tobytes()


def _elements(kind: str, block: Ints, tags: NDArray[np.int32], first: int) -> bytes:
    if kind not in ELEMENTS or block.ndim != 2 or block.shape[1] != ELEMENTS[kind][2]:
        raise InputError.at(
            "cells", f"has {kind} in an array of shape {block.shape}", f"one of {', '.join(ELEMENTS)}", "mesh"
        )
    if len(block) == 0:
        return b""
    rows = np.empty((len(block), 3 + block.shape[1]), np.int32)
    rows[:, 0] = np.arange(first, first + len(block))
    rows[:, 1] = tags
    rows[:, 2] = tags
    rows[:, 3:] = block + 1
    return np.array([ELEMENTS[kind][0], len(block), 2], np.int32).tobytes() + rows.tobytes()
