"""A level: a mesh with its certified solution."""

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribound.errors import InputError
from tribound.mesh import Floats, Ints, MeshArrays


@dataclass
class Probe:
    """The solution at points; one row for each point, and on interfaces for each side."""

    point: NDArray[np.int64]  #: number of the point of each row
    x: Floats  #: (rows, d)
    displacement: Floats  #: (rows, d)
    stress: Floats  #: (rows, 6) xx yy zz xy yz xz of sigma(u_h)
    equilibrated_stress: Floats | None  #: the same of the stress behind the bound
    region: list[str]
    body: list[str]


@dataclass
class Contact:
    """The state of a contact boundary at its quadrature points; weights sum to its length or area."""

    x: Floats  #: (k, d)
    normal: Floats  #: (k, d)
    weight: Floats
    pressure: Floats
    traction: Floats  #: (k, d), on the body
    limit: Floats  #: of the tangential traction
    status: Ints  #: 0 open, 1 stick, 2 slip, 3 tied
    gap: Floats
    slip: Floats  #: (k, d)
    facet: Ints
    cell: Ints  #: of the mesh, with that facet
    arc: Floats | None  #: length along the boundary, in 2D

    def __len__(self) -> int:
        return len(self.weight)


@dataclass
class Resultant:
    """A force and its moment about the point of the case's balance; per unit of depth in 2D."""

    force: Floats  #: (d,)
    moment: Floats  #: (1,) or (3,)


@dataclass
class Section:
    """What the part in front of a plane exerts on the part behind it."""

    measure: float
    force: Floats
    moment: Floats
    N: float
    V: Floats
    M: Floats
    note: str


class Level:
    """A mesh with its solution, or a load step. Arrays cannot be written to and live as long as needed."""

    def __init__(self, core: Any) -> None:
        self._core = core
        #: `units` of the certificate, the label of every kind of number; None until the run has ended.
        self.units: Mapping[str, Any] | None = None

    @property
    def number(self) -> int:
        """From 0, the given mesh; of load steps from 1."""
        return int(self._core.number)

    @property
    def t(self) -> float | None:
        """The load factor of a load step."""
        t: float | None = self._core.t
        return t

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return int(self._core.dimension)

    @property
    def degree(self) -> int:
        """p."""
        return int(self._core.degree)

    @cached_property
    def mesh(self) -> MeshArrays:
        """The mesh of the level."""
        return MeshArrays(self._core.mesh_arrays())

    @cached_property
    def nodes(self) -> Floats:
        """Positions of the nodes, (nodes, d)."""
        array: Floats = self._core.nodes()
        return array

    @cached_property
    def cell_nodes(self) -> Ints:
        """The nodes of each cell, (cells, nodes of a cell)."""
        array: Ints = self._core.cell_nodes()
        return array

    @cached_property
    def cell_node_indices(self) -> Ints:
        """Where the nodes of a cell are: barycentric coordinates times p, (nodes of a cell, d + 1)."""
        array: Ints = self._core.cell_node_indices()
        return array

    @cached_property
    def displacement(self) -> Floats:
        """u_h at the nodes, (nodes, d)."""
        array: Floats = self._core.displacement()
        return array

    @cached_property
    def stress(self) -> Floats:
        """sigma(u_h) at the nodes of each cell, (cells, nodes of a cell, 6): xx yy zz xy yz xz."""
        array: Floats = self._core.stress()
        return array

    @cached_property
    def equilibrated_stress(self) -> Floats | None:
        """sigma_h, the stress behind the bound, likewise."""
        array: Floats | None = self._core.equilibrated_stress()
        return array

    @cached_property
    def _cell_errors(self) -> dict[str, Floats]:
        errors: dict[str, Floats] = self._core.cell_errors()
        return errors

    @property
    def eta(self) -> Floats:
        """The contribution of each cell to the bound."""
        return self._cell_errors["eta_tot"]

    @property
    def eta_components(self) -> dict[str, Floats]:
        """The components of the bound, cell by cell: "str", "cnt", ..."""
        return {name[4:]: values for name, values in self._cell_errors.items() if name != "eta_tot"}

    @property
    def bound(self) -> float:
        """The guaranteed bound of the residual."""
        return float(self._core.bound)

    @property
    def relative(self) -> float | None:
        """The bound over the norm of the stress."""
        size = float(self._core.sigma_norm)
        return self.bound / size if size > 0 else None

    @cached_property
    def record(self) -> dict[str, Any]:
        """The level as in `levels` of certificate.json; empty in a marking or a stopping rule."""
        return json.loads(self._core.record or "{}")  # type: ignore[no-any-return]

    @cached_property
    def contact(self) -> dict[str, Contact]:
        """The contact boundaries by name."""
        rows = list(csv.reader(StringIO(self._core.contact_csv())))
        columns = {name: column for name, column in zip(rows[0], zip(*rows[1:]))} if len(rows) > 1 else {}
        names = np.array(columns.get("boundary", ()))
        cells = self._core.contact_cells()
        return {str(name): _contact(columns, cells, names == name, self.dimension) for name in dict.fromkeys(names)}

    def at(self, x: ArrayLike) -> Probe:
        """The solution at a point (d,), or at points (k, d) of the body."""
        points = np.atleast_2d(np.asarray(x, dtype=float))
        if points.ndim != 2 or points.shape[1] != self.dimension:
            raise InputError.at("x", f"has the shape {points.shape}", f"(k, {self.dimension})", file="at")
        if not np.isfinite(points).all():
            raise InputError.at("x", "is not finite", "points of the body", file="at")
        found = self._core.probe(points.tolist())
        return Probe(x=points[found["point"]], **found)

    def section(self, point: Sequence[float], normal: Sequence[float], within: str = "") -> Section:
        """The force through the plane at `point` across `normal`, where the formula `within` is positive."""
        found = json.loads(self._core.section(list(point), list(normal), within))
        return Section(
            measure=float(found["measure"]),
            force=np.array(found["force"]),
            moment=np.atleast_1d(found["moment"]),
            N=float(found["N"]),
            V=np.atleast_1d(found["V"]),
            M=np.atleast_1d(found["M"]),
            note=found.get("note") or "",
        )

    def resultant(self, boundary: str) -> Resultant:
        """The force on the body at a boundary: reaction, spring, contact and load together, in equilibrium
        with all others to rounding."""
        if boundary not in self.mesh.boundaries:
            raise KeyError(f"there is no boundary {boundary!r}: {', '.join(self.mesh.boundaries)}")
        if "balance" not in self.record:
            raise ValueError("the forces of this level are not known: in a marking or a stopping rule there are none yet")
        rows = [
            row
            for row in self.record["balance"]["rows"]
            if row["name"] == boundary and row["source"] != "body force"
        ]
        d = self.dimension
        force = np.sum([np.zeros(d)] + [np.array(row["force"]) for row in rows], axis=0)
        zero = np.zeros(1 if d == 2 else 3)
        moment = np.sum([zero] + [np.atleast_1d(row["moment"]) for row in rows], axis=0)
        return Resultant(force, moment)

    def plot(self, scalars: str = "von_mises", **options: Any) -> Any:
        """A picture of the level; see tribound.plots.plot."""
        from tribound import plots

        return plots.plot(self, scalars, **options)

    def plot_contact(self, boundary: str | None = None, **options: Any) -> Any:
        """Pressure and friction along the contact; see tribound.plots.plot_contact."""
        from tribound import plots

        return plots.plot_contact(self, boundary, **options)

    def to_meshio(self) -> Any:
        """The level as a mesh of meshio."""
        from tribound import export

        return export.to_meshio(self)

    def to_vtk(self) -> Any:
        """The level as a vtkUnstructuredGrid of degree p."""
        from tribound import export

        return export.to_vtk(self)

    def to_pyvista(self) -> Any:
        """The level as a grid of PyVista."""
        from tribound import export

        return export.to_pyvista(self)

    def __repr__(self) -> str:
        what = f"level {self.number}" if self.t is None else f"load step {self.number}, t = {self.t:g}"
        relative = f"{100 * self.relative:.4g} %" if self.relative is not None else f"{self.bound:.4g}"
        return f"{what}: {len(self.mesh.cells)} cells, bound {relative}"


def _contact(columns: dict[str, tuple[str, ...]], cells: Ints, where: NDArray[np.bool_], d: int) -> Contact:
    def column(name: str) -> Floats:
        return np.array(columns[name], dtype=float)[where]

    def vector(stem: str) -> Floats:
        return np.stack([column(stem + axis) for axis in "xyz"[:d]], axis=1)

    facet = column("facet").astype(np.int32)
    return Contact(
        x=vector(""),
        normal=vector("n"),
        weight=column("weight"),
        pressure=column("pressure"),
        traction=vector("traction_"),
        limit=column("limit"),
        status=column("status").astype(np.int32),
        gap=column("gap"),
        slip=vector("slip_"),
        facet=facet,
        cell=cells[facet],
        arc=column("arc") if d == 2 else None,
    )
