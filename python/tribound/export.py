"""The solution of a level for other libraries.

Every cell has its own points, because stresses are discontinuous. Arrays have the names that they have in
level_NNN.vtu (docs/output.md).
"""

from typing import Any

import numpy as np

from tribound.level import Level
from tribound.mesh import Floats
from tribound.optional import needed
from tribound.simplices import cut, vtk_order
from tribound.surface import von_mises

VTK_LAGRANGE = {2: 69, 3: 71}
MESHIO = {(2, 1): "triangle", (2, 2): "triangle6", (3, 1): "tetra", (3, 2): "tetra10"}  # dimension, degree


def _in_space(values: Floats) -> Floats:
    """Points or vectors, with z = 0 in 2D."""
    return np.pad(values, [(0, 0)] * (values.ndim - 1) + [(0, 3 - values.shape[-1])])


def _point_data(level: Level) -> dict[str, Floats]:
    """At the nodes of the cells (cells, nodes, components)."""
    data = {"displacement": _in_space(level.displacement[level.cell_nodes]), "stress": level.stress}
    if level.equilibrated_stress is not None:
        data["equilibrated_stress"] = level.equilibrated_stress
    return {**data, "von_mises": von_mises(level.stress)}


def _cell_data(level: Level) -> dict[str, Any]:
    components = {f"eta_{name}": eta for name, eta in level.eta_components.items()}
    return {"eta_tot": level.eta, **components, "region": level.mesh.region_of}


def _flat(values: Floats) -> Floats:
    return np.ascontiguousarray(values).reshape(-1, *values.shape[2:])


def to_meshio(level: Level) -> Any:
    """A meshio.Mesh: cells of degree 1 and 2 as they are, those of a higher degree p, for which meshio has no
    names, cut into p^d flat ones through their nodes.
    """
    meshio = needed("meshio", "to_meshio()")
    d, p = level.dimension, level.degree
    points, data, cell_data = _in_space(level.nodes[level.cell_nodes]), _point_data(level), _cell_data(level)
    m, n = level.cell_nodes.shape
    if p <= 2:
        cells, kind = vtk_order(level.cell_node_indices)[None], MESHIO[d, p]
    else:
        positions, pieces = cut(d, p)
        number = {tuple(node): i for i, node in enumerate(level.cell_node_indices.tolist())}
        cells, kind = np.array([number[tuple(node)] for node in positions.tolist()])[pieces], MESHIO[d, 1]
        cell_data = {name: np.repeat(values, len(cells)) for name, values in cell_data.items()}
    connectivity = (n * np.arange(m)[:, None, None] + cells).reshape(-1, cells.shape[1])
    return meshio.Mesh(
        _flat(points),
        [(kind, connectivity)],
        point_data={name: _flat(values) for name, values in data.items()},
        cell_data={name: [values] for name, values in cell_data.items()},
    )


def to_vtk(level: Level) -> Any:
    """A vtkUnstructuredGrid of Lagrange cells of the degree of the level: VTK interpolates exactly."""
    core = needed("vtkmodules.vtkCommonCore", "to_vtk()")
    support = needed("vtkmodules.util.numpy_support", "to_vtk()")
    model = needed("vtkmodules.vtkCommonDataModel", "to_vtk()")
    m, n = level.cell_nodes.shape
    order = vtk_order(level.cell_node_indices)
    grid, points, cells = model.vtkUnstructuredGrid(), core.vtkPoints(), model.vtkCellArray()
    points.SetData(support.numpy_to_vtk(_flat(_in_space(level.nodes[level.cell_nodes[:, order]])), deep=True))
    grid.SetPoints(points)
    offsets, connectivity = n * np.arange(m + 1, dtype=np.int64), np.arange(m * n, dtype=np.int64)
    cells.SetData(*(support.numpy_to_vtkIdTypeArray(array, deep=True) for array in (offsets, connectivity)))
    grid.SetCells(VTK_LAGRANGE[level.dimension], cells)
    point_data = {name: _flat(values[:, order]) for name, values in _point_data(level).items()}
    for attributes, arrays in ((grid.GetPointData(), point_data), (grid.GetCellData(), _cell_data(level))):
        for name, values in arrays.items():
            array = support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            attributes.AddArray(array)
    _name_components(grid)
    return grid


def _name_components(grid: Any) -> None:
    for name in ("stress", "equilibrated_stress"):
        array = grid.GetPointData().GetArray(name)
        for i, component in enumerate(("XX", "YY", "ZZ", "XY", "YZ", "XZ") if array else ()):
            array.SetComponentName(i, component)


def to_pyvista(level: Level) -> Any:
    """The same as a pyvista.UnstructuredGrid."""
    return needed("pyvista", "to_pyvista()").wrap(to_vtk(level))
