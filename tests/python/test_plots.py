"""Pictures: what is drawn are the numbers of the solution."""

import sys
import unittest
from importlib.util import find_spec
from types import SimpleNamespace
from typing import Any
from unittest import mock

import numpy as np

from small_cases import block, solved

import tribound as tb
from tribound import plots
from tribound.mesh import Floats

if find_spec("matplotlib"):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    from matplotlib.collections import LineCollection, PolyCollection, TriMesh


def mises(s: Floats) -> Floats:
    deviator = s.copy()
    deviator[:, :3] -= s[:, :3].mean(axis=1, keepdims=True)
    stresses: Floats = np.sqrt(
        1.5 * ((deviator[:, :3] ** 2).sum(axis=1) + 2 * (deviator[:, 3:] ** 2).sum(axis=1))
    )
    return stresses


def drawn(axes: Any, kind: type) -> list[Any]:
    return [collection for collection in axes.collections if isinstance(collection, kind)]


@unittest.skipUnless(find_spec("matplotlib"), "no matplotlib")
class Plots(unittest.TestCase):
    def tearDown(self) -> None:
        pyplot.close("all")

    def mesh(self, axes: Any) -> tuple[Any, Any, Any]:
        """Points, triangles and values of what fills the body in 2D."""
        (mesh,) = drawn(axes, TriMesh)
        return (
            np.stack([mesh._triangulation.x, mesh._triangulation.y], axis=1),
            mesh._triangulation.triangles,
            mesh.get_array(),
        )

    def inside(self, points: Floats, count: int = 40) -> Any:
        """Some points that are inside of their cells: no other cell has a point there."""
        _, first, twins = np.unique(np.round(points, 9), axis=0, return_index=True, return_counts=True)
        alone = first[twins == 1]
        alone = alone[np.all((points[alone] > 1e-9) & (points[alone] < np.array([2, 1]) - 1e-9), axis=1)]
        return np.random.default_rng(1).choice(alone, min(count, len(alone)), replace=False)

    def test_stress_is_that_of_the_solution(self) -> None:
        level = solved(2, 2).level
        for scalars, equilibrated in (("von_mises", True), ("von_mises", False), ("xy", True), ("yy", False)):
            with self.subTest(scalars=scalars, equilibrated=equilibrated):
                points, _, values = self.mesh(level.plot(scalars, equilibrated=equilibrated))
                sample = self.inside(points)
                self.assertGreater(len(sample), 20)
                probe = level.at(points[sample])
                stress = probe.equilibrated_stress if equilibrated else probe.stress
                assert stress is not None
                expected = (
                    mises(stress)
                    if scalars == "von_mises"
                    else stress[:, ["xx", "yy", "zz", "xy"].index(scalars)]
                )
                np.testing.assert_allclose(
                    values[sample], expected, rtol=0, atol=1e-11 * np.abs(level.stress).max()
                )

    def test_body_is_filled(self) -> None:
        points, triangles, _ = self.mesh(solved(2, 1).level.plot())
        a, b, c = (points[triangles[:, i]] for i in range(3))
        areas = np.cross(b - a, c - a) / 2
        self.assertTrue(np.all(areas != 0))
        self.assertAlmostEqual(np.abs(areas).sum(), 2.0, places=12)

    def test_deformation(self) -> None:
        level = solved(2, 2).level
        before, _, _ = self.mesh(level.plot())
        after, _, _ = self.mesh(level.plot(deformation=3.0))
        sample = self.inside(before)
        u = np.abs(level.displacement).max()
        np.testing.assert_allclose(
            (after - before)[sample], 3 * level.at(before[sample]).displacement, rtol=0, atol=1e-11 * u
        )
        axes = level.plot(deformation="auto")
        factor = float(axes.get_title().split("×")[1])
        moved = np.abs(self.mesh(axes)[0] - before).max()
        self.assertTrue(0.02 * 2 < moved <= 0.1 * 2, moved)
        self.assertAlmostEqual(moved, factor * np.abs(level.displacement).max(), delta=0.05 * moved)

    def test_labels_have_the_units_of_the_case(self) -> None:
        axes = solved(2, 2).level.plot()
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x [mm]", "y [mm]"))
        self.assertEqual(axes.figure.axes[1].get_ylabel(), "von Mises stress [MPa]")
        without = tb.run(block(2, 1)).level.plot("displacement")
        self.assertEqual(without.get_xlabel(), "x")
        self.assertEqual(without.figure.axes[1].get_ylabel(), "displacement")

    def test_errors_of_the_cells(self) -> None:
        level = solved(2, 1).level
        for scalars, eta in (("eta", level.eta), ("eta_cnt", level.eta_components["cnt"])):
            (cells,) = drawn(level.plot(scalars), PolyCollection)
            pieces = len(cells.get_array()) // len(eta)
            np.testing.assert_array_equal(cells.get_array(), np.repeat(eta, pieces))

    def test_edges(self) -> None:
        level = solved(2, 1).level
        outer, _ = [
            len(collection.get_segments())
            for collection in reversed(drawn(level.plot(edges=True), LineCollection))
        ]
        sides = np.sort(level.mesh.cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        self.assertEqual(outer, np.sum(np.unique(sides, axis=0, return_counts=True)[1] == 1))

    def test_solid_seen_along_its_axes(self) -> None:
        level = solved(3, 1).level
        for view, area in (((0, 0, 1), 2), ((0, -1, 0), 2), ((1, 0, 0), 1), ((1, 1, 1), 5 / np.sqrt(3))):
            axes = level.plot("uz", view=view)
            (polygons,) = drawn(axes, PolyCollection)
            corners = np.array([path.vertices[:3] for path in polygons.get_paths()])
            areas = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])) / 2
            self.assertAlmostEqual(areas.sum(), area, places=9)

    def test_draws_into_given_axes(self) -> None:
        figure, (left, right) = pyplot.subplots(1, 2)
        level = solved(2, 1).level
        self.assertIs(level.plot(ax=left), left)
        self.assertIs(level.plot_contact(ax=right), right)
        figure.canvas.draw()

    def test_names_that_do_not_exist(self) -> None:
        level = solved(2, 1).level
        with self.assertRaisesRegex(ValueError, "no field 'mises'; there are von_mises, xx, .*uy, eta"):
            level.plot("mises")
        with self.assertRaisesRegex(ValueError, "no contact on 'top'; there is on bottom"):
            level.plot_contact("top")

    def test_contact_in_2d(self) -> None:
        level = solved(2, 2).level
        axes = level.plot_contact()
        lines = {line.get_label(): line.get_xydata() for line in axes.lines}
        contact = level.contact["bottom"]
        order = np.argsort(contact.x[:, 0])
        np.testing.assert_array_equal(
            lines["pressure"], np.stack([contact.x[order, 0], contact.pressure[order]], axis=1)
        )
        np.testing.assert_array_equal(lines["what friction can carry"][:, 1], contact.limit[order])
        np.testing.assert_allclose(lines["friction"][:, 1], np.abs(contact.traction[order, 0]), atol=1e-15)
        words = [entry.get_text() for entry in axes.get_legend().get_texts()]
        names = ["open", "sticks", "slips", "tied"]
        self.assertEqual(
            {word for word in words if word in names}, {names[status] for status in np.unique(contact.status)}
        )

    def test_contact_in_3d(self) -> None:
        level = solved(3, 1).level
        (mesh,) = drawn(level.plot_contact(), TriMesh)
        np.testing.assert_array_equal(mesh.get_array(), level.contact["bottom"].pressure)
        np.testing.assert_array_equal(mesh._triangulation.x, level.contact["bottom"].x[:, 0])

    def test_cylinder_in_3d_is_unrolled(self) -> None:
        angle, z = (values.ravel() for values in np.meshgrid(np.linspace(-3, 3, 40), np.linspace(0, 2, 7)))
        across = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        normal = np.insert(-across, 0, 0, axis=1)  # a hole of radius 1.5 along x
        x = np.stack([z, 4 + 1.5 * across[:, 0], 1.5 * across[:, 1] - 2], axis=1)
        one = np.full(len(angle), 18 / len(angle))
        contact: Any = SimpleNamespace(
            x=x, normal=normal, weight=one, pressure=angle + 4, status=0 * angle + 2
        )
        contact.facet = np.arange(len(angle))
        level: Any = SimpleNamespace(contact={"hole": contact}, dimension=3, units={"length": "mm"}, t=None)
        axes = plots.plot_contact(level)
        (mesh,) = drawn(axes, TriMesh)
        np.testing.assert_allclose(mesh._triangulation.x, 1.5 * angle, atol=1e-12)
        np.testing.assert_allclose(mesh._triangulation.y, z)
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("length around [mm]", "x [mm]"))

    def test_convergence(self) -> None:
        result = solved(2, 2)
        axes = result.plot_convergence()
        bound = next(line for line in axes.lines if line.get_label().startswith("bound of the error"))
        levels = result.certificate["levels"]
        np.testing.assert_allclose(
            bound.get_xydata(), [(level["dofs"], 100 * level["relative"]) for level in levels], rtol=1e-15
        )
        (asked,) = {tuple(line.get_ydata()) for line in axes.lines if line.get_label() == "asked for"}
        self.assertEqual(asked, (2.0, 2.0))
        self.assertEqual(axes.get_title(), "Block")
        axes.figure.canvas.draw()


class Missing(unittest.TestCase):
    def test_says_how_to_install(self) -> None:
        result = solved(2, 1)
        with mock.patch.dict(sys.modules, {"matplotlib.pyplot": None}):
            calls: list[Any] = [result.level.plot, result.level.plot_contact, result.plot_convergence]
            for call in calls:
                self.assertRaisesRegex(ImportError, "apt install python3-matplotlib", call)


if __name__ == "__main__":
    unittest.main()
