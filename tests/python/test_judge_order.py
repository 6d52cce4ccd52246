"""Fields of degree 3 and 4 in files of VTK and Gmsh, whose libraries place the nodes: judged as in a table."""

import tempfile
import unittest
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb
from numpy.typing import NDArray

from small_cases import block

Floats = NDArray[np.float64]
CASES = [(2, 3), (2, 4), (3, 3), (3, 4)]


def in_space(values: Floats) -> Floats:
    return np.pad(values, [(0, 0), (0, 3 - values.shape[1])])


def vtk_cell(d: int, degree: int) -> tuple[int, Floats]:
    """The number of VTK's cell, and the reference coordinates of its nodes."""
    from vtkmodules import vtkCommonDataModel as model

    cell = model.vtkLagrangeTriangle() if d == 2 else model.vtkLagrangeTetra()
    n = int(np.prod([degree + k for k in range(1, d + 1)])) // (2 if d == 2 else 6)
    cell.GetPointIds().SetNumberOfIds(n)
    cell.GetPoints().SetNumberOfPoints(n)
    cell.Initialize()
    coordinates = [cell.GetParametricCoords()[i] for i in range(3 * n)]
    return cell.GetCellType(), np.reshape(coordinates, (n, 3))[:, :d]


def write_vtu(file: Path, kind: int, points: Floats, cells: NDArray[np.int64], u: Floats) -> None:
    from vtkmodules import vtkCommonCore as core
    from vtkmodules import vtkCommonDataModel as model
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    places = core.vtkPoints()
    places.SetData(numpy_to_vtk(in_space(points), deep=True))
    grid = model.vtkUnstructuredGrid()
    grid.SetPoints(places)
    for cell in cells.tolist():
        grid.InsertNextCell(kind, len(cell), cell)
    values = numpy_to_vtk(in_space(u), deep=True)
    values.SetName("displacement")
    grid.GetPointData().AddArray(values)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(grid)
    assert writer.Write()


def on_cells(level: tb.Level, reference: Floats) -> tuple[Floats, NDArray[np.int64], Floats]:
    """Points of the cells at these places, each once, the points of each cell, and the displacement there."""
    corners = level.mesh.points[level.mesh.cells]
    barycentric = np.column_stack([1 - reference.sum(axis=1), reference])
    x = np.einsum("na,cad->cnd", barycentric, corners)
    _, first, number = np.unique(
        np.round(x.reshape(-1, level.dimension), 9), axis=0, return_index=True, return_inverse=True
    )
    points = x.reshape(-1, level.dimension)[first]
    return points, number.reshape(len(corners), -1), level.at(points).displacement


def write_by_gmsh(file: Path, level: tb.Level) -> None:
    import gmsh

    d = level.dimension
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        entity = gmsh.model.addDiscreteEntity(d)
        tags = list(range(1, len(level.mesh.points) + 1))
        gmsh.model.mesh.addNodes(d, entity, tags, in_space(level.mesh.points).ravel())
        numbers = list(range(1, len(level.mesh.cells) + 1))
        corners = (level.mesh.cells + 1).ravel()
        gmsh.model.mesh.addElements(d, entity, [2 if d == 2 else 4], [numbers], [corners])
        gmsh.model.mesh.setOrder(level.degree)
        tags, x, _ = gmsh.model.mesh.getNodes()
        u = in_space(level.at(np.reshape(x, (-1, 3))[:, :d]).displacement)
        view = gmsh.view.add("displacement")
        gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), "NodeData", tags, u.tolist(), 0, 3)
        gmsh.view.write(view, str(file))
    finally:
        gmsh.finalize()


class Order(unittest.TestCase):
    def compare(self, level: tb.Level, write: Any) -> tb.Judgement:
        case = block(level.dimension, 1, judge={"sharpness": 1e6})
        table = tb.judge(case, (level.nodes, level.displacement))
        with tempfile.TemporaryDirectory() as directory:
            judged = write(case, Path(directory))
        self.assertIn(f"degree {level.degree}, their function", judged["read_as"])
        self.assertGreater(table["displacement"]["distance"], 0)
        self.assertAlmostEqual(
            judged["displacement"]["distance"] / table["displacement"]["distance"], 1, places=9
        )
        return judged

    @unittest.skipUnless(find_spec("vtkmodules"), "no VTK")
    def test_vtk(self) -> None:
        for d, degree in CASES:
            with self.subTest(d=d, degree=degree):
                level = tb.run(block(d, degree), set={"adapt.max_levels": 0}).level
                kind, reference = vtk_cell(d, degree)

                def write(case: Any, folder: Path) -> tb.Judgement:
                    write_vtu(folder / "theirs.vtu", kind, *on_cells(level, reference))
                    return tb.judge(case, folder / "theirs.vtu")

                self.assertNotIn("equidistant", self.compare(level, write)["read_as"])

    @unittest.skipUnless(find_spec("vtkmodules"), "no VTK")
    def test_nodes_of_fenicsx(self) -> None:
        """Its points are the nodes of its elements: of degree 3 those of Gauss and Lobatto on edges."""
        for d in (2, 3):
            with self.subTest(d=d):
                level = tb.run(block(d, 3), set={"adapt.max_levels": 0}).level
                kind, reference = vtk_cell(d, 3)
                barycentric = np.column_stack([1 - reference.sum(axis=1), reference])
                lobatto = (1 + np.array([-1, 1]) / np.sqrt(5)) / 2
                on_edge = (np.round(3 * barycentric).max(axis=1) == 2)[:, None] & (barycentric > 1e-9)
                barycentric[on_edge] = lobatto[np.round(3 * barycentric[on_edge]).astype(int) - 1]

                def write(case: Any, folder: Path) -> tb.Judgement:
                    write_vtu(folder / "theirs.vtu", kind, *on_cells(level, barycentric[:, 1:]))
                    return tb.judge(case, folder / "theirs.vtu")

                self.assertIn("not equidistant", self.compare(level, write)["read_as"])

    @unittest.skipUnless(find_spec("gmsh"), "no Python module of Gmsh")
    def test_gmsh(self) -> None:
        for d, degree in CASES:
            with self.subTest(d=d, degree=degree):
                level = tb.run(block(d, degree), set={"adapt.max_levels": 0}).level

                def write(case: Any, folder: Path) -> tb.Judgement:
                    write_by_gmsh(folder / "theirs.msh", level)
                    return tb.judge(case, folder / "theirs.msh")

                self.compare(level, write)


if __name__ == "__main__":
    unittest.main()
