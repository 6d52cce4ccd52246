"""The example that the interface was designed with."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

import numpy as np
import tribound as tb


def body() -> tb.Mesh:
    """A plate of 8 x 4 as arrays."""
    box = tb.Mesh.box([0, 0], [8, 4], [8, 4])
    points, triangles, sides = box.points, box.cells, box.boundaries
    return tb.Mesh(
        points,
        triangles,
        regions={"steel": np.arange(len(triangles))},
        boundaries={name: sides[name] for name in ("left", "top", "bottom")},
    )


class Example(unittest.TestCase):
    def test_as_it_stands(self) -> None:
        case = tb.Case({
            "degree": 2,
            "material": {"E": 210e3, "nu": 0.3},
            "boundary": {
                "left":   {"displacement": [0, "free"]},
                "top":    {"pressure": lambda x: 120 * np.maximum(0, 1 - (x[0] / 8) ** 2)},
                "bottom": {"contact": {"friction": "coulomb", "coefficient": 0.3, "gap": lambda x: x[0] ** 2 / 1000}},
            },
            "adapt": {"tolerance": 0.01},
        })
        mesh = body()
        seen: list[tb.Level] = []
        result = tb.run(case, mesh, on_level=seen.append)
        self.assertEqual(result.status, "certified")
        self.assertLess(result.relative, 0.01)
        self.assertGreater(result.components["str"], 0)
        self.assertEqual(result.certificate["status"], "certified")
        level = result.level
        self.assertEqual(seen[-1].number, level.number)
        self.assertEqual(level.mesh.points.shape[1], 2)
        self.assertEqual(level.mesh.cells.shape[1], 3)
        self.assertEqual(level.displacement.shape, level.nodes.shape)
        self.assertEqual(level.cell_nodes.shape, (len(level.mesh.cells), 6))
        self.assertEqual(level.eta.shape, level.eta_components["cnt"].shape)
        self.assertEqual(level.at([4, 2]).displacement.shape, (1, 2))
        c = level.contact["bottom"]
        N = (c.weight * c.pressure).sum()
        self.assertAlmostEqual(N, 120 * (8 - 8 / 3), delta=1e-6)  # it carries all of the load
        self.assertEqual(c.slip.shape, c.traction.shape)
        np.testing.assert_allclose(level.resultant("left").force + level.resultant("bottom").force, [0, N], atol=1e-6)
        self.assertAlmostEqual(level.section([4, 2], [1, 0]).measure, 4)
        self.assertGreaterEqual(tb.verify(case, mesh, refinements=1).effectivity, 1)
        if importlib.util.find_spec("matplotlib"):
            level.plot(scalars="von_mises")
            level.plot_contact()
        if importlib.util.find_spec("meshio"):
            with tempfile.TemporaryDirectory() as directory:
                level.to_meshio().write(Path(directory) / "a.vtu")
        if importlib.util.find_spec("pyvista"):
            level.to_pyvista()
        table = tb.sweep(case, {"boundary.bottom.contact.coefficient": np.linspace(0.1, 0.8, 2)}, mesh, jobs=2)
        self.assertEqual(list(table["status"]), ["certified"] * 2)


if __name__ == "__main__":
    unittest.main()
