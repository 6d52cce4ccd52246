"""The solution for meshio and VTK: what is written can be read, and VTK finds what the program finds."""

import sys
import tempfile
import unittest
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from small_cases import block, solved

import tribound as tb

CASES = [(2, 1), (2, 2), (2, 3), (3, 1), (3, 2), (3, 3)]


def random_points(level: tb.Level, count: int) -> tuple[Any, Any]:
    """Cells and barycentric points inside, away from the sides, where stresses jump."""
    random = np.random.default_rng(1)
    cells = random.integers(len(level.mesh.cells), size=count)
    return cells, 0.7 * random.dirichlet(np.ones(level.dimension + 1), size=count) + 0.3 / (
        level.dimension + 1
    )


@unittest.skipUnless(find_spec("vtkmodules"), "no VTK")
class Vtk(unittest.TestCase):
    def read_back(self, grid: Any) -> Any:
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

        with tempfile.TemporaryDirectory() as folder:
            file = str(Path(folder) / "level.vtu")
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetFileName(file)
            writer.SetInputData(grid)
            self.assertTrue(writer.Write())
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(file)
            reader.Update()
            return reader.GetOutput()

    def test_interpolates_the_solution(self) -> None:
        from vtkmodules.util.numpy_support import vtk_to_numpy

        for dimension, degree in CASES:
            with self.subTest(dimension=dimension, degree=degree):
                level = solved(dimension, degree).level
                grid = self.read_back(level.to_vtk())
                points = vtk_to_numpy(grid.GetPoints().GetData())
                fields = {
                    name: vtk_to_numpy(grid.GetPointData().GetArray(name))
                    for name in ("displacement", "stress", "equilibrated_stress")
                }
                cells, barycentric = random_points(level, 50)
                nodes, weights = [], []
                for number, at in zip(cells, barycentric):
                    cell = grid.GetCell(int(number))
                    values = [0.0] * cell.GetNumberOfPoints()
                    cell.InterpolateFunctions([*at[1:], 0.0][:3], values)
                    nodes.append([cell.GetPointId(i) for i in range(len(values))])
                    weights.append(values)
                interpolated = {
                    name: np.einsum("ki,kic->kc", weights, values[nodes]) for name, values in fields.items()
                }
                x = np.einsum("ki,kic->kc", weights, points[nodes])[:, :dimension]
                vertices = level.mesh.points[level.mesh.cells[cells]]
                np.testing.assert_allclose(x, np.einsum("ka,kac->kc", barycentric, vertices), atol=1e-14)
                probe = level.at(x)
                u = np.abs(level.displacement).max()
                np.testing.assert_allclose(
                    interpolated["displacement"][:, :dimension], probe.displacement, rtol=0, atol=1e-12 * u
                )
                largest = np.abs(level.stress).max()
                np.testing.assert_allclose(interpolated["stress"], probe.stress, rtol=0, atol=1e-12 * largest)

    def test_has_the_data_of_the_cells(self) -> None:
        from vtkmodules.util.numpy_support import vtk_to_numpy

        level = solved(2, 2).level
        data = self.read_back(level.to_vtk()).GetCellData()
        np.testing.assert_array_equal(vtk_to_numpy(data.GetArray("eta_tot")), level.eta)
        for name, values in level.eta_components.items():
            np.testing.assert_array_equal(vtk_to_numpy(data.GetArray(f"eta_{name}")), values)
        self.assertEqual(set(vtk_to_numpy(data.GetArray("region"))), set(range(len(level.mesh.regions))))

    def test_is_what_the_program_writes(self) -> None:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

        reader = vtkXMLUnstructuredGridReader()
        with tempfile.TemporaryDirectory() as folder:
            result = tb.run(block(2, 3), directory=folder)
            reader.SetFileName(str(sorted(Path(folder).glob("level_*.vtu"))[-1]))
            reader.Update()
        written, ours = reader.GetOutput(), result.level.to_vtk()
        self.assertEqual(written.GetCellType(0), ours.GetCellType(0))
        corners = [vtk_to_numpy(grid.GetPoints().GetData()) for grid in (written, ours)]
        np.testing.assert_allclose(corners[0], corners[1], rtol=0, atol=1e-15)
        for data in ("GetPointData", "GetCellData"):
            known, here = getattr(written, data)(), getattr(ours, data)()
            for i in range(here.GetNumberOfArrays()):
                name = here.GetArrayName(i)
                expected, found = vtk_to_numpy(known.GetArray(name)), vtk_to_numpy(here.GetArray(name))
                np.testing.assert_allclose(
                    found, expected, rtol=0, atol=2e-7 * np.abs(expected).max(), err_msg=name
                )


@unittest.skipUnless(find_spec("meshio"), "no meshio")
class Meshio(unittest.TestCase):
    def test_files_can_be_read(self) -> None:
        import meshio

        formats: list[tuple[str, dict[str, str]]] = [("vtu", {})]
        if find_spec("h5py"):  # meshio has XDMF with it alone
            formats.append(("xdmf", {"data_format": "XML"}))
        for dimension, degree in CASES:
            for suffix, options in formats:
                with self.subTest(
                    dimension=dimension, degree=degree, suffix=suffix
                ), tempfile.TemporaryDirectory() as folder:
                    level = solved(dimension, degree).level
                    file = Path(folder) / f"level.{suffix}"
                    meshio.write(file, level.to_meshio(), **options)
                    self.check(level, meshio.read(file))

    def check(self, level: tb.Level, mesh: Any) -> None:
        (block,) = mesh.cells
        pieces = 1 if level.degree <= 2 else level.degree**level.dimension
        self.assertEqual(len(block.data), pieces * len(level.mesh.cells))
        corners = mesh.points[block.data[:, : level.dimension + 1], : level.dimension]
        volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / [1, 1, 2, 6][level.dimension]
        self.assertAlmostEqual(np.abs(volumes).sum(), 2.0, places=12)  # the area or volume of the block
        eta, region = mesh.cell_data["eta_tot"][0], mesh.cell_data["region"][0]
        np.testing.assert_allclose(eta[::pieces], level.eta, rtol=1e-14)
        self.assertEqual(set(region), {0})
        sample = np.random.default_rng(2).integers(len(mesh.points), size=20)
        probe = level.at(mesh.points[sample, : level.dimension])
        scale = np.abs(level.displacement).max()
        np.testing.assert_allclose(
            mesh.point_data["displacement"][sample, : level.dimension],
            probe.displacement,
            rtol=0,
            atol=1e-12 * scale,
        )
        self.assertEqual(mesh.point_data["stress"].shape[1:], (6,))

    def test_middle_nodes_are_between_their_vertices(self) -> None:
        edges = {2: [(0, 1), (1, 2), (2, 0)], 3: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]}
        for dimension, ends in edges.items():
            mesh = solved(dimension, 2).level.to_meshio()
            cells = mesh.points[mesh.cells[0].data]
            middle = cells[:, dimension + 1 :]
            np.testing.assert_allclose(
                middle, np.stack([cells[:, list(end)].mean(axis=1) for end in ends], axis=1), atol=1e-15
            )


class Missing(unittest.TestCase):
    def test_says_how_to_install(self) -> None:
        level = solved(2, 1).level
        for call, module, advice in (
            (level.to_meshio, "meshio", "apt install python3-meshio"),
            (level.to_vtk, "vtkmodules.vtkCommonCore", "apt install python3-vtk9"),
            (level.to_pyvista, "pyvista", "pip install pyvista"),
        ):
            with self.subTest(module=module), mock.patch.dict(sys.modules, {module: None}):
                self.assertRaisesRegex(ImportError, advice, call)


if __name__ == "__main__":
    unittest.main()
