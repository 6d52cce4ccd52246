"""Meshes from arrays, files, boxes and meshio."""

import importlib.util
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb

from small_cases import block

SQUARE = np.array([[0.0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]])
QUADS = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
SIDES = {"bottom": [[0, 1], [1, 2]], "top": [[3, 4], [4, 5]], "left": [[0, 3]], "right": [[2, 5]]}


def without_mesh(dimension: int, degree: int) -> dict[str, Any]:
    case = block(dimension, degree)
    del case["mesh"]
    return case


def hexahedra(n: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """The box of block(3, p) in n hexahedra, with its sides as quadrilaterals."""
    axes = [np.linspace(0, size, k + 1) for size, k in zip((2, 1, 1), n)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape([k + 1 for k in n])
    corner = [number[i : n[0] + i, j : n[1] + j, k : n[2] + k].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    cells = np.stack([corner[i] for i in (0, 4, 6, 2, 1, 5, 7, 3)], axis=1)

    def side(grid: np.ndarray) -> np.ndarray:
        return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1).reshape(-1, 4)

    sides = {
        "left": side(number[0]), "right": side(number[-1]), "bottom": side(number[:, 0]), "top": side(number[:, -1]),
        "back": side(number[:, :, 0]), "front": side(number[:, :, -1]),
    }
    return points, cells, sides


class Arrays(unittest.TestCase):
    def test_triangles_are_taken_as_they_are(self) -> None:
        box = tb.Mesh.box([0, 0], [2, 1], [8, 4])
        mesh = tb.Mesh(box.points, box.cells, regions={"box": np.arange(len(box.cells))}, boundaries=box.boundaries)
        np.testing.assert_array_equal(mesh.points, box.points)
        np.testing.assert_array_equal(np.sort(mesh.cells), np.sort(box.cells))
        np.testing.assert_allclose(tb.run(without_mesh(2, 2), mesh).bound, tb.run(block(2, 2)).bound, rtol=1e-9)

    def test_quadrilaterals_and_hexahedra_are_split(self) -> None:
        mesh = tb.Mesh(SQUARE, QUADS, boundaries=SIDES)
        self.assertEqual(mesh.cells.shape, (4, 3))
        self.assertEqual(mesh.dimension, 2)
        self.assertEqual({name: len(facets) for name, facets in mesh.boundaries.items()},
                         {"bottom": 2, "top": 2, "left": 1, "right": 1})
        self.assertTrue(tb.run(without_mesh(2, 2), mesh).is_certified)
        points, cells, sides = hexahedra((3, 2, 2))
        solid = tb.Mesh(points, cells, boundaries=sides)
        corners = solid.points[solid.cells]
        self.assertAlmostEqual(abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6, 2, places=12)
        case = without_mesh(3, 1)
        for free in ("back", "front"):
            case["boundary"][free] = {"traction": [0, 0, 0]}
        result = tb.run(case, solid)
        self.assertIn(result.status, ("certified", "budget"))
        np.testing.assert_allclose(result.level.resultant("top").force, [0, -0.2, 0], atol=1e-12)

    def test_regions(self) -> None:
        mesh = tb.Mesh(SQUARE, QUADS, regions={"soft": [0], "stiff": [1]}, boundaries=SIDES)
        self.assertEqual({name: len(cells) for name, cells in mesh.regions.items()}, {"soft": 2, "stiff": 2})
        case = without_mesh(2, 1)
        case["material"] = {"soft": {"E": 1, "nu": 0.3}, "stiff": {"E": 10, "nu": 0.2}}
        level = tb.run(case, mesh).level
        self.assertEqual(set(level.mesh.regions), {"soft", "stiff"})
        self.assertEqual(level.at([[0.4, 0.3], [1.7, 0.3]]).region, ["soft", "stiff"])

    def test_second_order(self) -> None:
        angle = np.array([0.0, 45, 90]) * np.pi / 180
        arc = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        points = np.array([[0, 0], arc[0], arc[2], [0.5, 0], arc[1], [0, 0.5]])
        mesh = tb.Mesh(points, [[0, 1, 2, 3, 4, 5]], boundaries={"arc": [[1, 2, 4]], "rest": [[0, 1, 3], [0, 2, 5]]})
        self.assertEqual(mesh.cells.shape, (1, 3))
        self.assertEqual(len(mesh.points), 3)

    def test_the_run_keeps_the_mesh(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            first = tb.run(without_mesh(2, 2), tb.Mesh(SQUARE, QUADS, boundaries=SIDES), directory=directory)
            again = tb.run(tb.Case.read(Path(directory) / "case.toml"))
            np.testing.assert_allclose(first.bound, again.bound, rtol=1e-9)

    def test_a_mesh_stays_what_it_is(self) -> None:
        points = SQUARE.copy()
        mesh = tb.Mesh(points, QUADS)
        points *= 2
        np.testing.assert_array_equal(mesh.points, SQUARE)

    def test_wrong_arrays(self) -> None:
        for arguments, key, problem in (
            ((np.zeros((3, 4)), [[0, 1, 2]]), "points", "shape (3, 4)"),
            (([[0, 0], [1, 0], [0, np.nan]], [[0, 1, 2]]), "points", "not finite in row 2"),
            ((SQUARE, [[0, 1]]), "cells", "shape (1, 2)"),
            ((SQUARE, [[0, 1, 6]]), "cells", "number 6"),
            ((SQUARE, [[-1, 1, 2]]), "cells", "number -1"),
            ((SQUARE, [[0.0, 1.0, 3.0]]), "cells", "float64"),
            ((SQUARE, [[0, 1, 2**40]]), "cells", "number 1099511627776"),
            ((SQUARE + 1j, [[0, 1, 3]]), "points", "complex128"),
            ((SQUARE.astype(str), [[0, 1, 3]]), "points", "<U"),
            ((np.ma.masked_array(SQUARE, SQUARE > 1), [[0, 1, 3]]), "points", "masked"),
            ((np.column_stack([SQUARE, SQUARE[:, 0]]), [[0, 1, 3]]), "cells", "(n, 2)"),
            ((SQUARE, {"quad": QUADS, "line": [[0, 1]]}), "cells", "'line'"),
            ((SQUARE, {"tetra": QUADS}), "cells", "'tetra'"),
            ((SQUARE, {"quad": [[0, 1, 4]]}), "cells", "quad in an array of shape (1, 3)"),
            ((SQUARE, {"pentagon": [[0, 1, 4]]}), "cells", "pentagon"),
        ):
            with self.assertRaises(tb.InputError) as caught:
                tb.Mesh(*arguments).points
            self.assertEqual(caught.exception.key, key)
            self.assertIn(problem, str(caught.exception))
        for regions in ({"a": [0]}, {"a": [0, 1], "b": [1]}, {"a": [0, 1, 2]}):
            with self.assertRaises(tb.InputError):
                tb.Mesh(SQUARE, QUADS, regions=regions)
        for name in ("", " ", 'a"b', "a\0b", "a\rb", 3, "a" * 300):
            with self.assertRaisesRegex(tb.InputError, "has the name"):
                tb.Mesh(SQUARE, QUADS, regions={name: [0, 1]}).points  # type: ignore[dict-item]
        with self.assertRaisesRegex(TypeError, "a mesh is a tb.Mesh"):
            tb.run(without_mesh(2, 1), "part.msh")  # type: ignore[arg-type]
        with self.assertRaisesRegex(tb.InputError, "inside the domain"):
            tb.run(without_mesh(2, 1), tb.Mesh(SQUARE, QUADS, boundaries={**SIDES, "inside": [[1, 4]]}))


class Files(unittest.TestCase):
    def test_read(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            tb.run(block(2, 2), directory=directory, set={"adapt.max_levels": 1})
            mesh = tb.Mesh.read(Path(directory) / "adapted.msh")
            self.assertEqual(mesh.dimension, 2)
            self.assertEqual(set(mesh.boundaries), {"left", "right", "bottom", "top"})
            self.assertTrue(tb.run(without_mesh(2, 2), mesh).is_certified)
        with self.assertRaisesRegex(tb.InputError, "nowhere.msh"):
            tb.Mesh.read("nowhere.msh").points

    def test_box(self) -> None:
        mesh = tb.Mesh.box([0, 0, 0], [1, 2, 3], [1, 2, 3])
        self.assertEqual(mesh.dimension, 3)
        np.testing.assert_array_equal(mesh.points.max(axis=0), [1, 2, 3])
        with self.assertRaises(ValueError):
            mesh.points[0] = 1
        with self.assertRaises(tb.InputError):
            tb.Mesh.box([0, 0], [1, -1], [1, 1]).points


@unittest.skipUnless(importlib.util.find_spec("meshio"), "meshio is not installed (Debian: python3-meshio)")
class Meshio(unittest.TestCase):
    def test_nodes_have_the_order_of_gmsh(self) -> None:
        from meshio.gmsh.common import _meshio_to_gmsh_order
        from tribound.meshio_reader import _ORDER
        from tribound.msh import ELEMENTS

        for kind, (_, _, nodes) in ELEMENTS.items():
            expected = _meshio_to_gmsh_order(kind, np.arange(nodes)[None])[0]
            np.testing.assert_array_equal(_ORDER.get(kind, list(range(nodes))), expected, kind)

    def test_cell_sets(self) -> None:
        import meshio

        mesh = meshio.Mesh(
            np.column_stack([SQUARE, np.zeros(6)]),
            [("quad", QUADS), ("line", np.concatenate([SIDES[name] for name in SIDES]))],
            cell_sets={
                "soft": [np.array([0]), np.array([], int)],
                **{name: [np.array([], int), np.array(rows)] for name, rows in
                   {"bottom": [0, 1], "top": [2, 3], "left": [4], "right": [5]}.items()},
            },
        )
        read = tb.Mesh.from_meshio(mesh)
        self.assertEqual(set(read.regions), {"soft", "body"})
        self.assertEqual({name: len(facets) for name, facets in read.boundaries.items()},
                         {"bottom": 2, "top": 2, "left": 1, "right": 1})

    def test_groups_of_gmsh(self) -> None:
        import meshio

        with tempfile.TemporaryDirectory() as directory:
            tb.run(block(3, 1), directory=directory, set={"adapt.max_levels": 1})
            file = Path(directory) / "adapted.msh"
            read, expected = tb.Mesh.from_meshio(meshio.read(file)), tb.Mesh.read(file)
            np.testing.assert_allclose(read.points, expected.points)
            self.assertEqual({name: len(f) for name, f in read.boundaries.items()},
                             {name: len(f) for name, f in expected.boundaries.items()})

    def test_wrong_members_of_sets(self) -> None:
        import meshio

        for members in ([True, False], [2], [-1], [0.0]):
            cells = [("quad", QUADS), ("line", np.array([[0, 1], [1, 2]]))]
            mesh = meshio.Mesh(SQUARE, cells)
            mesh.cell_sets = {"bottom": [None, np.array(members)]}
            with self.assertRaisesRegex(tb.InputError, "bottom: has other members"):
                tb.Mesh.from_meshio(mesh)

    def test_what_is_no_body(self) -> None:
        import meshio

        surface = meshio.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 1]], [("triangle", np.array([[0, 1, 2]]))])
        with self.assertRaisesRegex(tb.InputError, "surface in space"):
            tb.Mesh.from_meshio(surface)
        with self.assertRaisesRegex(tb.InputError, "no cells"):
            tb.Mesh.from_meshio(meshio.Mesh([[0.0, 0], [1, 0]], [("line", np.array([[0, 1]]))]))


if __name__ == "__main__":
    unittest.main()
