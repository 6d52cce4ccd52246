"""Random small meshes of all kinds that a case can name: boxes, polygons for Gmsh, .msh files of format 2.2."""

from dataclasses import dataclass
from itertools import permutations

import numpy as np


@dataclass
class RandomMesh:
    table: dict  # [mesh] of the case
    lower: np.ndarray
    upper: np.ndarray
    boundaries: list  # names; the first is made for contact
    regions: list
    scale_E: float = 1.0


def random_mesh(dice, degree, directory):
    if dice.chance(0.12):
        return box_mesh(dice, 3, degree) if dice.chance(0.5) else msh_mesh(dice, 3, degree, directory)
    return dice.one_of([box_mesh2, box_mesh2, polygon_mesh, polygon_mesh, msh_mesh2])(dice, degree, directory)


def box_mesh2(dice, degree, _):
    return box_mesh(dice, 2, degree)


def msh_mesh2(dice, degree, directory):
    return msh_mesh(dice, 2, degree, directory)


def extents(dice, d):
    size = 1.0 if dice.chance(0.6) else dice.power(-3, 3)
    lower = np.round(size * dice.rng.uniform(-1, 1, d), 4) if dice.chance(0.3) else np.zeros(d)
    upper = lower + np.array([float(f"{size * dice.between(0.5, 3):.3g}") for _ in range(d)])
    return lower, upper


def cells_per_side(dice, d, degree):
    most = (5 if degree < 3 else 4) if d == 2 else (2 if degree < 3 else 1)
    return [dice.integer(1, most) for _ in range(d)]


def box_mesh(dice, d, degree):
    lower, upper = extents(dice, d)
    table = {"lower": lower.tolist(), "upper": upper.tolist(), "cells": cells_per_side(dice, d, degree)}
    others = ["left", "right", "top", "back", "front"] if d == 3 else ["left", "right", "top"]
    dice.rng.shuffle(others)
    return RandomMesh({"box": table}, lower, upper, ["bottom", *others], ["box"])


def polygon_mesh(dice, degree, directory):
    """A polygon with a flat bottom, star-shaped or convex. Convex ones are sometimes cut into two regions, corner to corner."""
    n = dice.integer(4, 8)
    size = 1.0 if dice.chance(0.6) else dice.power(-3, 3)
    angles = np.pi * (np.arange(n - 1) + 0.5 * dice.rng.uniform(-0.6, 0.6, n - 1)) / (n - 2)
    angles[0], angles[-1] = 0.0, np.pi
    convex = dice.chance(0.6)
    radius = size * (np.ones(n - 1) if convex else dice.rng.uniform(0.6, 1.4, n - 1))
    corners = np.stack([radius * np.cos(angles), radius * np.sin(angles)], axis=1)
    corners[[0, -1], 1] = 0.0
    corners = np.round(corners, 6 - int(np.floor(np.log10(size))))
    n = len(corners)
    h = size / dice.between(0.8, 2.5 if degree < 3 else 1.6)
    lines = [(k + 1, (k + 1) % n + 1) for k in range(n)]
    loops = [list(range(1, n + 1))]
    if n >= 5 and convex and dice.chance(0.6):
        middle = dice.integer(2, n - 2)  # from corner 1 to corner middle + 1
        lines.append((1, middle + 1))
        loops = [[*range(1, middle + 1), -(n + 1)], [n + 1, *range(middle + 1, n + 1)]]
    text = "".join(f"Point({k + 1}) = {{{x!r}, {y!r}, 0, {h:.6g}}};\n" for k, (x, y) in enumerate(corners.tolist()))
    text += "\n".join(f"Line({k + 1}) = {{{a}, {b}}};" for k, (a, b) in enumerate(lines)) + "\n"
    for k, loop in enumerate(loops, 1):
        text += f"Curve Loop({k}) = {{{', '.join(map(str, loop))}}};\nPlane Surface({k}) = {{{k}}};\n"
    names = ["floor", *(f"side {k}" if dice.chance(0.1) else f"side{k}" for k in range(1, n))]
    tags = [n, *range(1, n)]  # the flat line closes the polygon
    order = [0, *(1 + dice.rng.permutation(n - 1))]
    for k in order:
        text += f'Physical Curve("{names[k]}") = {{{tags[k]}}};\n'
    regions = [f"part{k}" for k in range(1, len(loops) + 1)]
    for k, region in enumerate(regions, 1):
        text += f'Physical Surface("{region}") = {{{k}}};\n'
    (directory / "mesh.geo").write_text("\n" + text)
    return RandomMesh({"file": "mesh.geo"}, corners.min(axis=0), corners.max(axis=0), [names[k] for k in order], regions)


def msh_mesh(dice, d, degree, directory):
    """A box of simplices with moved vertices, sometimes in two layers."""
    lower, upper = extents(dice, d)
    shape = [n + 1 for n in cells_per_side(dice, d, degree)]
    places = np.stack(np.meshgrid(*[np.linspace(0, 1, n) for n in shape], indexing="ij"), axis=-1).reshape(-1, d)
    inside = (places > 1e-9) & (places < 1 - 1e-9)
    step = 1 / (np.array(shape) - 1)
    numbers = np.arange(len(places)).reshape(shape)
    cells = np.array(list(simplices(numbers)))
    moved = places + inside * dice.rng.uniform(-0.2, 0.2, places.shape) * step
    shear = np.eye(d)
    shear[0, 1] = dice.between(-0.5, 0.5) if dice.chance(0.4) else 0.0
    vertices = lower + (moved * (upper - lower)) @ shear.T
    edges = vertices[cells[:, 1:]] - vertices[cells[:, :1]]
    turned = np.linalg.det(edges) < 0
    cells[turned, :2] = cells[turned, 1::-1]
    layers = ["base", "block"] if shape[1] > 2 and dice.chance(0.4) else ["block"]
    region = np.zeros(len(cells), int)
    if len(layers) == 2:
        region = (places[cells].mean(axis=1)[:, 1] > places[numbers[(0, 1, *[0] * (d - 2))], 1]).astype(int)
    sides = {}
    for axis, pair in enumerate((("left", "right"), ("bottom", "top"), ("back", "front"))[:d]):
        for end, name in enumerate(pair):
            on = np.abs(places[:, axis] - end) < 1e-9
            facets = np.concatenate([np.delete(cells, k, axis=1) for k in range(d + 1)])
            sides[name] = np.unique(np.sort(facets[on[facets].all(axis=1)], axis=1), axis=0)
    (directory / "mesh.msh").write_text(msh_text(d, vertices, sides, {n: cells[region == k] for k, n in enumerate(layers)}))
    others = [name for name in sides if name != "bottom"]
    dice.rng.shuffle(others)
    names = ["bottom", *others]
    return RandomMesh({"file": "mesh.msh"}, vertices.min(axis=0), vertices.max(axis=0), names, layers)


def simplices(numbers):
    """Kuhn's triangulation: one simplex per order of the axes in every cube."""
    d = numbers.ndim
    for corner in np.ndindex(*(n - 1 for n in numbers.shape)):
        for order in permutations(range(d)):
            at = list(corner)
            cell = [numbers[tuple(at)]]
            for axis in order:
                at[axis] += 1
                cell.append(numbers[tuple(at)])
            yield cell


def msh_text(d, vertices, sides, regions):
    """Format 2.2, ASCII."""
    names, elements = [], []
    for dimension, groups in ((d - 1, sides), (d, regions)):
        for name, rows in groups.items():
            names.append(f'{dimension} {len(names) + 1} "{name}"')
            kind = {1: 1, 2: 2, 3: 4}[dimension]
            elements += [f"{kind} 2 {len(names)} {len(names)} " + " ".join(str(v + 1) for v in row) for row in rows]
    nodes = [f"{k} " + " ".join(f"{x:.17g}" for x in [*v, 0.0][:3]) for k, v in enumerate(vertices.tolist(), 1)]
    elements = [f"{k} {row}" for k, row in enumerate(elements, 1)]
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    for section, lines in (("PhysicalNames", names), ("Nodes", nodes), ("Elements", elements)):
        text += "\n".join([f"${section}", str(len(lines)), *lines, f"$End{section}", ""])
    return text
