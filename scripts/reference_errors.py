"""Errors of the solutions of bench/peers/judged against finer ones; this shares nothing with the judge.

Programs' files are read by meshio and NumPy; the norms are those of tests/python/true_errors.py.
"""

import json
import math
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

import ccx
import meshio
import numpy as np
from calculix_mesh import Deck
from measure import measure
from scipy.spatial import cKDTree
from true_errors import Fields, Floats, Ints, squared_errors

DEGREE = 3  # of the finer solutions
DIMENSIONS = {"triangle6": 2, "VTK_LAGRANGE_TRIANGLE": 2, "tetra10": 3, "VTK_LAGRANGE_TETRAHEDRON": 3}


@dataclass
class Reference:
    """A solution of degree 3 on a mesh that is refined until the bound of its own error is small."""

    fields: Fields
    E: float
    nu: float
    bound: float  # of its error in the energy norm
    norm: float  # of itself
    unknowns: int
    seconds: float

    def errors(self, theirs: Fields) -> tuple[float, float]:
        """Of their displacement and their stress."""
        squares = squared_errors(theirs, self.fields, self.E, self.nu)
        assert squares.stress is not None
        return math.sqrt(squares.displacement.sum()), math.sqrt(squares.stress.sum())

    def relative(self, error: float) -> tuple[float, float]:
        """Between which numbers the exact relative error lies, from the distance to this solution."""
        least, most = max(0, error - self.bound), error + self.bound
        return least / (self.norm + self.bound), most / (self.norm - self.bound)


def reference(program: Path, case: Path, tolerance: float, out: Path) -> Reference:
    """tolerance: of the bound of its error, relative to itself."""
    settings = [f"degree={DEGREE}", 'adapt.measure="energy"', f"adapt.energy_tolerance={tolerance}",
                "adapt.tolerance=1", "adapt.max_levels=40", "output.report=false",
                f'output.directory="{out}"']
    words = [word for setting in settings for word in ("--set", setting)]
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    run = measure([str(program), "run", str(case), "--quiet", *words], **threads)
    certificate = json.loads((out / "certificate.json").read_text())
    levels, material = certificate["levels"], tomllib.loads(case.read_text())["material"]
    fields = _of_vtu(out / f"level_{len(levels) - 1:03}.vtu")
    E, nu = material["E"], material["nu"]
    nothing = replace(fields, displacement=np.zeros_like(fields.displacement), stress=None)
    norm = math.sqrt(squared_errors(nothing, fields, E, nu).displacement.sum())
    return Reference(fields, E, nu, certificate["energy_error"]["bound"], norm, levels[-1]["dofs"], run.cpu)


def fields_of(file: Path) -> Fields:
    """A solution on mesh.msh, which lies beside it."""
    if file.suffix == ".vtu":
        return _of_vtu(file)
    deck = Deck(file.with_name("mesh.msh"))
    return _of_table(file, deck) if file.suffix == ".csv" else _of_frd(file, deck)


def _of_vtu(file: Path) -> Fields:
    mesh = meshio.read(file)
    (block,) = mesh.cells
    values = mesh.point_data
    return _fields(DIMENSIONS[block.type], mesh.points, block.data, values["displacement"], values["stress"])


def _of_table(file: Path, deck: Deck) -> Fields:
    """Of FreeFEM, a row for each node."""
    names, *rows = file.read_text().split()
    columns = np.array([row.split(",") for row in rows], dtype=float).T
    table = dict(zip(names.split(","), columns))
    axes = "xyz"[: deck.dim]
    elements = deck.elements if columns.shape[1] == len(deck.nodes) else deck.cells
    nodes = deck.nodes[: elements.max() + 1]
    distance, row = cKDTree(np.column_stack([table[axis] for axis in axes])).query(nodes[:, : deck.dim])
    if distance.max() > 1e-6:
        raise ValueError(f"{file} has no value at a node")
    displacement = np.column_stack([table["u" + axis] for axis in axes])
    stress = np.column_stack([table.get(name, 0 * columns[0])
                              for name in ("sxx", "syy", "szz", "sxy", "syz", "sxz")])
    return _fields(deck.dim, nodes, elements, displacement[row], stress[row])


def _of_frd(file: Path, deck: Deck) -> Fields:
    """Of CalculiX, whose first nodes are those of the deck."""
    solution = ccx.Solution(0)
    ccx.read_fields(file.read_text(), solution)
    return _fields(deck.dim, deck.nodes, deck.elements, solution.displacements[-1], solution.stresses[-1])


def _fields(d: int, points: Floats, elements: Ints, displacement: Floats, stress: Floats) -> Fields:
    """Corners are the first nodes of each element; the rest is seen from their places."""
    nodes = points[elements][..., :d]
    corners = nodes[:, : d + 1]
    degree = next(p for p in range(1, 5) if math.comb(p + d, d) == elements.shape[1])
    local = (nodes[0] - corners[0, 0]) @ np.linalg.inv(corners[0, 1:] - corners[0, 0])
    indices = np.rint(degree * np.column_stack([1 - local.sum(axis=1), local])).astype(np.int32)
    if not np.allclose(indices / degree @ corners, nodes, rtol=0, atol=1e-6):
        raise ValueError("an element has nodes elsewhere than others")
    return Fields(corners, indices, displacement[elements][..., :d], stress[elements])
