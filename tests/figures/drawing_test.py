#!/usr/bin/env python3
"""Tests what pictures are drawn from: surfaces of cells (scripts/result_surface.py) and hidden parts (scripts/raster.py).

    drawing_test.py SCRIPTS
"""

import sys
import unittest
from itertools import permutations

import numpy as np

sys.path.insert(0, sys.argv.pop(1))

from raster import Camera, Raster  # noqa: E402
from result_files import Grid  # noqa: E402
from result_surface import lattice, outer_facets, surface  # noqa: E402


def one_cell(corners, degree):
    """A cell with the nodes of a Lagrange element of the given degree: corners first, the others in any order."""
    d = len(corners) - 1
    powers = [np.array(p) for p in np.ndindex(*[degree + 1] * (d + 1)) if sum(p) == degree]
    powers.sort(key=lambda p: (-max(p), tuple(-p)))
    nodes = np.array(powers) / degree @ np.pad(np.array(corners, float), ((0, 0), (0, 3 - d)))
    return Grid(d, nodes, np.arange(len(nodes))[None], {}, {})


def cube(regions=None):
    """A cube of six tetrahedra around its diagonal, each with its own points."""
    points = []
    for order in permutations(range(3)):
        corner = np.zeros(3)
        points.append(corner.copy())
        for axis in order:
            corner[axis] = 1
            points.append(corner.copy())
    data = {} if regions is None else {"region": np.array(regions)}
    return Grid(3, np.array(points), np.arange(24).reshape(6, 4), {}, data)


class Surfaces(unittest.TestCase):
    def test_fields_are_those_of_the_element(self):
        for degree in (1, 2, 3, 4):
            for corners in ([(0, 0), (2, 0.5), (0.3, 1)], [(0, 0, 0), (2, 0.5, 0), (0.3, 1, 0), (0.2, 0.1, 3)]):
                grid = one_cell(corners, degree)
                field = lambda x: (1 + x[:, 0] - 2 * x[:, 1] + 0.5 * x[:, 2]) ** degree
                grid.point_data["f"] = field(grid.points)
                skin = surface(grid, 3)
                self.assertEqual(len(skin.triangles), 9 * (1 if grid.dimension == 2 else 4))
                np.testing.assert_allclose(skin.fields["f"], field(skin.points), atol=1e-9)

    def test_triangles_cover_the_facet(self):
        points, triangles, sides = lattice(4)
        a, b, c = (points[triangles[:, i], 1:] for i in range(3))
        areas = np.cross(b - a, c - a) / 2
        np.testing.assert_allclose(areas, 1 / 32)
        for corner, side in enumerate(sides):
            np.testing.assert_allclose(points[side][[0, -1]], np.eye(3)[[corner, (corner + 1) % 3]])

    def test_facets_between_cells_of_a_region_are_inside(self):
        self.assertEqual(len(outer_facets(cube())[0]), 12)
        self.assertEqual(len(outer_facets(cube([0, 0, 0, 0, 0, 1]))[0]), 16)

    def test_edges_of_the_body_are_where_facets_meet_at_an_angle(self):
        skin = surface(cube(), 2)
        ends = skin.points[skin.edges[:, [0, -1]]]
        along_an_axis = np.count_nonzero(ends[:, 0] != ends[:, 1], axis=1) == 1
        np.testing.assert_array_equal(skin.sharp, along_an_axis)
        self.assertEqual(skin.sharp.sum(), 24)  # each edge is in two facets


class Hidden(unittest.TestCase):
    def test_what_is_nearer_hides_what_is_behind(self):
        square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.0)])
        points = np.concatenate([square, 0.5 * square + (0.25, 0.25, 0.3)])
        triangles = np.array([(4, 5, 6), (4, 6, 7), (0, 1, 2), (0, 2, 3)])
        values = np.array([0.0] * 4 + [1.0] * 4)
        for side, seen in ((1, 1), (-1, 0)):
            raster = Raster(points, Camera(points, (0, 0, side), (0, 1, 0)), 60)
            raster.draw(points, triangles, values, lambda x: np.stack([x, 1 - x, x], axis=1))
            middle = raster.image()[30, 30]
            self.assertEqual(middle[0] > middle[1], seen == 1)
            self.assertTrue(np.all(np.isfinite(raster.values[30:-30, 30:-30])))

    def test_lines_behind_are_not_drawn(self):
        square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        points = np.array(square + [(0.2, 0.5, -0.4), (0.8, 0.5, -0.4), (0.2, 0.5, 0), (0.8, 0.5, 0)])
        triangles = np.array([(0, 1, 2), (0, 2, 3)])
        for line, drawn in (([4, 5], False), ([6, 7], True)):
            raster = Raster(points, Camera(points, (0, 0, 1), (0, 1, 0)), 60)
            raster.draw(points, triangles, np.zeros(8), lambda x: np.ones((len(x), 3)))
            before = raster.image()
            raster.line(points, np.array([line]), 3, 1)
            self.assertEqual(bool(np.any(raster.image() < before)), drawn)


if __name__ == "__main__":
    unittest.main()
