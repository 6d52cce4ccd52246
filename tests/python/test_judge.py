"""Judgements against errors that are computed here, with code that shares nothing with the program."""

import importlib.util
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb
from numpy.typing import NDArray

from small_cases import block, two_boxes

Floats = NDArray[np.float64]
PROGRAM = os.environ.get("TRIBOUND_PROGRAM")
CASES = int(os.environ.get("TRIBOUND_CASES", "12"))


class Polynomials:
    """Lagrange functions on a simplex, from the monomials of the first barycentric coordinates."""

    def __init__(self, indices: NDArray[np.int32]) -> None:
        d = indices.shape[1] - 1
        self.p = int(indices[0].sum())
        powers = np.array(np.meshgrid(*[range(self.p + 1)] * d)).reshape(d, -1).T
        self.powers = powers[powers.sum(axis=1) <= self.p]
        self.coefficients = np.linalg.inv(self.monomials(indices[:, 1:] / self.p))

    def monomials(self, x: Floats) -> Floats:
        return np.prod(x[:, None, :] ** self.powers[None], axis=2)

    def values(self, x: Floats) -> Floats:
        return self.monomials(x) @ self.coefficients

    def gradients(self, x: Floats) -> Floats:
        """(points, functions, d)."""
        parts = []
        for k in range(x.shape[1]):
            lower = np.maximum(self.powers - (np.arange(x.shape[1]) == k), 0)
            parts.append((self.powers[:, k] * np.prod(x[:, None, :] ** lower[None], axis=2)) @ self.coefficients)
        return np.stack(parts, axis=2)


def rule(d: int, n: int) -> tuple[Floats, Floats]:
    """A Gauss rule on the reference simplex, by collapsing a cube."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    grid = np.stack(np.meshgrid(*[x] * d, indexing="ij"), axis=-1).reshape(-1, d)
    weights = np.prod(np.stack(np.meshgrid(*[w] * d, indexing="ij"), axis=-1).reshape(-1, d), axis=1)
    points = np.empty_like(grid)
    rest = np.ones(len(grid))
    for k in range(d):
        points[:, k] = rest * grid[:, k]
        weights = weights * rest
        rest = rest * (1 - grid[:, k])
    return points, weights


def energy_distance(theirs: tb.Level, ours: tb.Level, E: float, nu: float) -> float:
    """||v - u|| over cells of the finer mesh, each inside one of theirs; plane strain in 2D."""
    d = theirs.dimension
    lame, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)
    fine, coarse = Polynomials(ours.cell_node_indices), Polynomials(theirs.cell_node_indices)
    corners = theirs.mesh.points[theirs.mesh.cells]
    inverse = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
    x, w = rule(d, 4)
    total = 0.0
    for c, cell in enumerate(ours.mesh.cells):
        own = ours.mesh.points[cell]
        jacobian = (own[1:] - own[0]).T
        points = own[0] + x @ jacobian.T
        inside = np.einsum("cij,cj->ci", inverse, own.mean(axis=0) - corners[:, 0])
        parent = int(np.argmax(np.minimum(inside.min(axis=1), 1 - inside.sum(axis=1))))
        local = (points - corners[parent, 0]) @ inverse[parent].T
        gradient = np.einsum(
            "qnk,nd,kj->qdj", fine.gradients(x), ours.displacement[ours.cell_nodes[c]], np.linalg.inv(jacobian)
        ) - np.einsum(
            "qnk,nd,kj->qdj", coarse.gradients(local), theirs.displacement[theirs.cell_nodes[parent]], inverse[parent]
        )
        strain = (gradient + np.swapaxes(gradient, 1, 2)) / 2
        trace = np.trace(strain, axis1=1, axis2=2)
        density = lame * trace**2 + 2 * mu * (strain**2).sum(axis=(1, 2))
        total += abs(np.linalg.det(jacobian)) * (w * density).sum()
    return float(np.sqrt(total))


def random_case(random: np.random.Generator, d: int) -> dict[str, Any]:
    law = random.choice(["none", "tresca"])
    contact: dict[str, Any] = {"friction": str(law), "gap": float(random.choice([0, 0.01]))}
    if law == "tresca":
        contact["threshold"] = float(random.uniform(0.01, 0.1))
    cells = [int(n) for n in random.integers(1, 5 if d == 2 else 3, d)]
    load = [float(x) for x in random.uniform(-0.1, 0.1, d)]
    load[1] = -abs(load[1]) - 0.02
    return {
        "degree": 2,
        "mesh": {"box": {"lower": [0.0] * d, "upper": [2.0, 1.0, 1.0][:d], "cells": cells}},
        "material": {"E": 1.0, "nu": float(random.choice([0.0, 0.3, 0.45]))},
        "boundary": {
            "left": {"displacement": [0.0] * d},
            "top": {"traction": load},
            "bottom": {"contact": contact},
        },
        "quantity": [{"name": "energy", "kind": "energy"}],
        "adapt": {"max_dofs": 3000 if d == 2 else 6000, "max_levels": 20},
    }


class Guarantee(unittest.TestCase):
    def test_the_error_lies_in_the_interval(self) -> None:
        """Wide and narrow intervals contain one number, that computed here from a much finer solution."""
        for seed in range(CASES):
            random = np.random.default_rng(seed)
            d = 2 if seed % 4 else 3
            case = random_case(random, d)
            degree = int(random.integers(1, 3))
            theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": degree}).level
            if np.abs(theirs.displacement).max() == 0:
                continue
            solution = (theirs.nodes, theirs.displacement)
            wide = tb.judge(case, solution, set={"judge.sharpness": 1e6})
            narrow = tb.judge(case, solution, set={"judge.sharpness": 0.02})
            with self.subTest(seed=seed, d=d, degree=degree):
                self.assertEqual(wide.status, "judged")
                self.assertEqual(narrow["displacement"]["bound"] <= 0.02 * narrow["displacement"]["distance"],
                                 narrow.status == "judged")
                assert wide.error and narrow.error
                self.assertLessEqual(wide.error[0], narrow.error[1])
                self.assertLessEqual(narrow.error[0], wide.error[1])
                self.assertLessEqual(narrow.error[1] - narrow.error[0], wide.error[1] - wide.error[0])
                finest = tb.run(case, set={"degree": 3, "adapt.measure": "energy", "adapt.tolerance": 1e-4})
                true = energy_distance(theirs, finest.level, 1.0, case["material"]["nu"])
                own = finest.certificate["energy_error"]["bound"]  # of the finer solution itself
                for judgement in (wide, narrow):
                    assert judgement.error
                    self.assertLessEqual(judgement.error[0] - own, true)
                    self.assertLessEqual(true, judgement.error[1] + own)
                (energy,) = narrow["quantities"]
                self.assertLessEqual(energy["wrong_by"][0], energy["wrong_by"][1])

    def test_distance_is_that_of_an_independent_quadrature(self) -> None:
        for d, degree in ((2, 1), (2, 2), (3, 1)):
            case = block(d, 2, adapt={"max_levels": 3})
            theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": degree}).level
            with tempfile.TemporaryDirectory() as directory:
                judged = tb.judge(
                    case, (theirs.nodes, theirs.displacement), set={"judge.sharpness": 1e-9}, directory=directory
                )
                ours = tb.run(tb.Case.read(Path(directory) / "judge/case.toml"), set={
                    "adapt.measure": "energy", "certify.energy": "every", "adapt.tolerance": 1e-12,
                }).level
            self.assertEqual(judged["cells"], len(ours.eta))
            expected = energy_distance(theirs, ours, 1.0, 0.3)
            self.assertAlmostEqual(judged["displacement"]["distance"] / expected, 1, places=6)

    def test_stresses(self) -> None:
        case = block(2, 2, adapt={"max_dofs": 20000})
        theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": 1}).level
        nodal, count = np.zeros((len(theirs.nodes), 6)), np.zeros(len(theirs.nodes))
        np.add.at(nodal, theirs.cell_nodes, theirs.stress)
        np.add.at(count, theirs.cell_nodes, 1)
        solution = (theirs.nodes, theirs.displacement, nodal / count[:, None])
        wide = tb.judge(case, solution, set={"judge.sharpness": 1e6})
        narrow = tb.judge(case, solution, set={"judge.sharpness": 0.05})
        assert wide.stress and narrow.stress and narrow.relative
        self.assertLessEqual(wide.stress[0], narrow.stress[1])
        self.assertLessEqual(narrow.stress[0], wide.stress[1])
        self.assertEqual(narrow["tension"]["facets"] > 0, narrow["tension"]["largest"] > 0)
        self.assertLess(narrow.stress[1], narrow.relative[1])  # averaged stresses are better than those of P1

    def test_regions_and_bodies(self) -> None:
        case = two_boxes([6, 3], [6, 3], adapt={"max_dofs": 20000})
        theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": 1}).level
        with self.assertRaisesRegex(tb.InputError, "to which body"):
            tb.judge(case, (theirs.nodes, theirs.displacement))
        if importlib.util.find_spec("meshio"):
            with tempfile.TemporaryDirectory() as directory:
                file = Path(directory) / "theirs.vtu"
                theirs.to_meshio().write(file)
                judged = tb.judge(case, file)
                other = two_boxes([8, 4], [5, 4], adapt={"max_dofs": 20000})
                with self.assertRaisesRegex(tb.InputError, "--interpolate"):
                    tb.judge(other, file)
                interpolated = tb.judge(other, file, interpolate=True)
            self.assertEqual(judged.status, "judged")
            self.assertEqual(interpolated.status, "judged")
            self.assertIn("interpolates", interpolated["read_as"])
            assert interpolated.relative and judged.relative
            self.assertLess(interpolated.relative[0], 2 * judged.relative[1])
            regions = judged["displacement"]["regions"]
            self.assertEqual([region["name"] for region in regions], ["lower", "upper"])
            squares = sum(region["distance"] ** 2 for region in regions)
            self.assertAlmostEqual(squares, judged["displacement"]["distance"] ** 2, places=12)
            self.assertEqual(len(judged["rigid_difference"]), 2)


def write_frd(file: Path, points: Floats, hexahedra: NDArray[np.int64], displacement: Floats, stress: Floats) -> None:
    """As PrePoMax has it from CalculiX: two steps, of which the first has half of the displacement."""

    def rows(values: Floats) -> str:
        return "".join(f" -1{i:10d}" + "".join(f"{x:12.5E}" for x in row) + "\n" for i, row in enumerate(values, 1)) + " -3\n"

    text = "    1C\n    1UPGM               CalculiX\n" + f"    2C{len(points):30d}{1:38d}\n" + rows(points)
    text += f"    3C{len(hexahedra):30d}{1:38d}\n"
    for number, element in enumerate(hexahedra, 1):
        text += f" -1{number:10d}{1:5d}{0:5d}{1:5d}\n -2" + "".join(f"{node + 1:10d}" for node in element) + "\n"
    text += " -3\n"
    for step, factor in ((1, 0.5), (2, 1.0)):
        for name, components, values in (
            ("DISP", ["D1", "D2", "D3", "ALL"], displacement),
            ("STRESS", ["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"], stress),
        ):
            text += f"    1PSTEP{2 * step:26d}{1:12d}{step:12d}\n"
            text += f"  100CL  10{step}{float(step):12.9f}{len(points):12d}{0:22d}{step:5d}{1:12d}\n"
            text += f" -4  {name:8s}{len(components):5d}    1\n"
            text += "".join(f" -5  {c:8s}    1    2    1{0:5d}{int(c == 'ALL'):5d}\n" for c in components)
            text += rows(factor * values)
    file.write_text(text + " 9999\n")


class Strangers(unittest.TestCase):
    """Files as other programs write them, judged at the first try."""

    def test_prepomax(self) -> None:
        from test_mesh import hexahedra

        points, cells, sides = hexahedra((4, 2, 2))
        mesh = tb.Mesh(points, cells, boundaries=sides)
        case = block(3, 2, adapt={"max_dofs": 20000}, judge={"sharpness": 0.5})
        del case["mesh"]
        for free in ("back", "front"):
            case["boundary"][free] = {"traction": [0, 0, 0]}
        level = tb.run(case, mesh, set={"adapt.max_levels": 0, "degree": 1}).level
        number = {tuple(np.round(x, 9)): i for i, x in enumerate(level.nodes)}
        order = [number[tuple(np.round(x, 9))] for x in points]
        stress, count = np.zeros((len(level.nodes), 6)), np.zeros(len(level.nodes))
        np.add.at(stress, level.cell_nodes, level.stress)
        np.add.at(count, level.cell_nodes, 1)
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory) / "analysis.frd"
            write_frd(file, points, cells, level.displacement[order], (stress / count[:, None])[order])
            judged = tb.judge(case, file, mesh)
            first = tb.judge(case, file, mesh, step=1)
        self.assertIn(judged.status, ("judged", "wide"))
        self.assertIn("CalculiX", judged["solution"]["description"])
        self.assertIn("quadratic", judged["read_as"])  # hexahedra
        assert judged.relative and judged.stress and first.relative
        self.assertGreater(first.relative[0], judged.relative[0])

    @unittest.skipUnless(importlib.util.find_spec("meshio"), "meshio is not installed")
    def test_fenicsx(self) -> None:
        """Vectors of three components and tensors of nine, also in the plane."""
        import meshio

        case = block(2, 2, adapt={"max_dofs": 20000})
        level = tb.run(case, set={"adapt.max_levels": 0, "degree": 1}).level
        space = np.column_stack([level.nodes, np.zeros(len(level.nodes))])
        u = np.column_stack([level.displacement, np.zeros(len(level.nodes))])
        sigma = np.zeros((len(space), 3, 3))
        count = np.zeros(len(space))
        tensor = level.stress[:, :, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(*level.cell_nodes.shape, 3, 3)
        np.add.at(sigma, level.cell_nodes, tensor)
        np.add.at(count, level.cell_nodes, 1)
        sigma /= count[:, None, None]
        shuffled = np.random.default_rng(3).permutation(len(space))
        back = np.argsort(shuffled)
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory) / "u.vtu"
            meshio.Mesh(
                space[shuffled],
                [("triangle", back[level.cell_nodes])],
                point_data={"u": u[shuffled], "stress": sigma[shuffled].reshape(-1, 9)},
            ).write(file)
            judged = tb.judge(case, file)
        table = tb.judge(case, (level.nodes, level.displacement, np.stack([sigma[:, 0, 0], sigma[:, 1, 1], sigma[:, 0, 1]], axis=1)))
        self.assertEqual(judged.status, "judged")
        assert judged.relative and judged.stress and table.relative and table.stress
        np.testing.assert_allclose(judged.relative, table.relative, rtol=1e-9)
        np.testing.assert_allclose(judged.stress, table.stress, rtol=1e-9)


class Use(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        force = {"name": "force", "kind": "contact_force", "direction": [0, 1]}
        cls.case = block(2, 2, quantity=[force, {"name": "energy", "kind": "energy"}])
        cls.case["adapt"] = {"max_dofs": 20000}
        cls.level = tb.run(cls.case, set={"adapt.max_levels": 0, "degree": 1}).level
        cls.solution = (cls.level.nodes, cls.level.displacement)

    def test_numbers(self) -> None:
        judged = tb.judge(self.case, self.solution, numbers={"force": 0.15})
        force, energy = judged["quantities"]
        self.assertEqual(force["theirs"], 0.15)
        self.assertAlmostEqual(
            force["wrong_by"][0], max(0, force["lower"] - 0.15, 0.15 - force["upper"]), places=12
        )
        self.assertIsNotNone(energy["theirs"])
        with self.assertRaisesRegex(tb.InputError, "no \\[\\[quantity\\]\\]"):
            tb.judge(self.case, self.solution, numbers={"weight": 1})

    def test_thresholds(self) -> None:
        for accept, status in ((0.5, "accepted"), (0.05, "rejected")):
            self.assertEqual(tb.judge(self.case, self.solution, accept=accept).status, status)
        relative = tb.judge(self.case, self.solution).relative
        assert relative
        undecided = tb.judge(self.case, self.solution, accept=sum(relative) / 2)
        self.assertEqual(undecided.status, "undecided")

    def test_units_and_signs(self) -> None:
        points, displacement = self.solution
        self.assertIn("1000 times too small", tb.judge(self.case, (points, displacement / 1000))["doubt"])
        self.assertIn("other sign", tb.judge(self.case, (points, -displacement))["doubt"])
        self.assertIsNone(tb.judge(self.case, self.solution)["doubt"])
        with self.assertRaisesRegex(tb.InputError, "1000 times as large"):
            tb.judge(self.case, (1000 * points, displacement))

    def test_load_steps(self) -> None:
        """With a temperature that varies with t: the stress of ours is that of the step."""
        case = block(2, 2, history={"steps": [0.5, 1.0]}, load={"temperature": "20*t"}, adapt={"tolerance": 0.02})
        case["material"] = {"E": 1.0, "nu": 0.3, "alpha": 1e-3}
        case["boundary"]["bottom"]["contact"] = {"friction": "tresca", "threshold": 0.03, "gap": 0}
        case["boundary"]["top"] = {"traction": [0, "-0.1*t"]}
        finest = tb.run(case, keep_levels=True, set={"adapt.tolerance": 0.005})
        relative = []
        for number in (1, 2):
            theirs = tb.run(case, keep_levels=True, set={"degree": 3, "adapt.max_levels": 0}).levels[number - 1]
            x = np.unique(theirs.nodes, axis=0)
            probe = finest.levels[number - 1].at(x)
            order = [int(np.argmin(((theirs.nodes - point) ** 2).sum(axis=1))) for point in x]
            judged = tb.judge(case, (x, theirs.displacement[order], probe.stress), load_step=number)
            self.assertEqual(judged["load_step"], number)
            self.assertNotEqual(judged.status, "no bound", judged["reason"])
            assert judged.relative and judged["stress"]
            relative.append(judged.relative[1])
            size = judged["energy_norm"]
            self.assertLess(judged["stress"]["distance"], 0.2 * size)
        self.assertLess(max(relative), 0.5)

    def test_wrong_arrays(self) -> None:
        points, displacement = self.solution
        for arrays in ((points, displacement[:-1]), (points, displacement, displacement), (points[:, :1], displacement)):
            with self.assertRaises(tb.InputError):
                tb.judge(self.case, arrays)
        broken = displacement.copy()
        broken[3, 1] = np.nan
        with self.assertRaises(tb.InputError):
            tb.judge(self.case, (points, broken))

    def test_files(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            judged = tb.judge(self.case, self.solution, directory=directory)
            written = json.loads((Path(directory) / "judge/judgement.json").read_text())
            self.assertEqual(dict(judged), written)
            rows = np.genfromtxt(Path(directory) / "judge/judged_cells.csv", delimiter=",", names=True, dtype=None, encoding=None)
            self.assertAlmostEqual(rows["part"].sum(), 1, places=9)
            self.assertEqual(rows["marked"].sum(), judged["displacement"]["halving_cells"])
            left = np.sqrt((rows["distance"][rows["marked"] == 0] ** 2).sum())
            self.assertLessEqual(left, judged["displacement"]["distance"] / 2)
            for name in ("judged.vtu", "certificate.json"):
                self.assertTrue((Path(directory) / "judge" / name).exists())

    @unittest.skipUnless(PROGRAM, "the program is not named")
    def test_exit_codes(self) -> None:
        with tempfile.TemporaryDirectory() as directory:
            folder = Path(directory)
            tb.judge(self.case, self.solution, directory=folder)
            command = [str(PROGRAM), "judge", str(folder / "judge/case.toml"), "--solution", str(folder / "solution.csv"), "-q"]
            for options, code in (([], 0), (["--accept", "0.5"], 0), (["--accept", "0.05"], 4),
                                  (["--set", "adapt.max_levels=0", "--set", "judge.sharpness=1e-3"], 3),
                                  (["--number", "force"], 1), (["--field", "velocity"], 1)):
                ended = subprocess.run([*command, *options], cwd=folder, capture_output=True, text=True)
                self.assertEqual(ended.returncode, code, (options, ended.stdout, ended.stderr))


if __name__ == "__main__":
    unittest.main()
