"""Judgements against errors by true_errors.py, code that shares nothing with the program."""

import importlib.util
import json
import os
import subprocess
import tempfile
import unittest
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb
from numpy.typing import NDArray

from small_cases import block, two_boxes
from true_errors import Fields, Squares, squared_errors

Floats = NDArray[np.float64]
PROGRAM = os.environ.get("TRIBOUND_PROGRAM")
CASES = int(os.environ.get("TRIBOUND_CASES", "12"))


def fields(level: tb.Level, stress: Floats | None = None) -> Fields:
    """stress: at the nodes of the level."""
    of_cells = level.cell_nodes
    return Fields(level.mesh.points[level.mesh.cells], level.cell_node_indices, level.displacement[of_cells],
                  None if stress is None else stress[of_cells])


def averaged_stress(level: tb.Level) -> Floats:
    """At the nodes, the mean over their cells."""
    total, count = np.zeros((len(level.nodes), 6)), np.zeros(len(level.nodes))
    np.add.at(total, level.cell_nodes, level.stress)
    np.add.at(count, level.cell_nodes, 1)
    return total / count[:, None]


def random_case(random: np.random.Generator, d: int) -> dict[str, Any]:
    law = random.choice(["none", "tresca"])
    contact: dict[str, Any] = {"friction": str(law), "gap": float(random.choice([0, 0.01]))}
    if law == "tresca":
        contact["threshold"] = float(random.uniform(0.01, 0.1))
    cells = [int(n) for n in random.integers(1, 5 if d == 2 else 3, d)]
    load = [float(x) for x in random.uniform(-0.1, 0.1, d)]
    load[1] = -abs(load[1]) - 0.02
    box = {"lower": [0.0] * d, "upper": [2.0, 1.0, 1.0][:d], "cells": cells}
    material: dict[str, Any] = {"E": 1.0, "nu": float(random.choice([0.0, 0.3, 0.45]))}
    E = float(random.uniform(0.5, 2))
    material["inner"] = {"E": E, "nu": material["nu"], "where": random_half(random, box)}
    return {
        "degree": 2,
        "mesh": {"box": box},
        "material": material,
        "boundary": {
            "left": {"displacement": [0.0] * d},
            "top": {"traction": load},
            "bottom": {"contact": contact},
        },
        "quantity": [{"name": "energy", "kind": "energy"}],
        "adapt": {"max_dofs": 3000 if d == 2 else 6000, "max_levels": 20},
    }


def random_half(random: np.random.Generator, box: dict[str, Any]) -> str:
    """A formula for one side of a plane that has cells on both of its sides."""
    mesh = tb.Mesh.box(**box)
    slopes = random.uniform(-1, 1, mesh.dimension)
    heights = np.unique(mesh.points[mesh.cells].mean(axis=1) @ slopes)
    cut = int(random.integers(1, len(heights)))
    terms = " + ".join(f"({float(slope)!r})*{axis}" for slope, axis in zip(slopes, "xyz"))
    return f"{terms} > {float(heights[cut - 1 : cut + 1].mean())!r}"


class AgainstTrueErrors(unittest.TestCase):
    """Intervals of two regions, "box" and "inner", hold the errors."""

    def check_fields(self, judgement: tb.Judgement, true: Squares, theirs: tb.Level, own: float) -> None:
        """On the body and on every region."""
        for field in ("displacement", "stress"):
            squares, record = getattr(true, field), judgement[field]
            self.assert_between(record["error"], squares, own)
            self.assertEqual({region["name"] for region in record["regions"]}, {"box", "inner"})
            for region in record["regions"]:
                self.assert_between(region["error"], squares[theirs.mesh.regions[region["name"]]], own)

    def assert_between(self, interval: Sequence[float], squares: Floats, own: float) -> None:
        """own: the error of the finer solution that the squares were computed with."""
        error = float(np.sqrt(squares.sum()))
        self.assertLessEqual(interval[0] - own, error)
        self.assertLessEqual(error, interval[1] + own)


class Guarantee(AgainstTrueErrors):
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
            stress = averaged_stress(theirs)
            solution = (theirs.nodes, theirs.displacement, stress)
            wide = tb.judge(case, solution, set={"judge.sharpness": 1e6})
            narrow = tb.judge(case, solution, set={"judge.sharpness": 0.02, "degree": 3})
            with self.subTest(seed=seed, d=d, degree=degree):
                self.check_widths(wide, narrow)
                finest = tb.run(case, set={"degree": 3, "adapt.measure": "energy", "adapt.tolerance": 1e-5,
                                           "adapt.max_dofs": 20000})
                own = finest.certificate["energy_error"]["bound"]  # of the finer solution itself
                of_region = [case["material"].get(name, case["material"]) for name in theirs.mesh.regions]
                E, nu = (np.array([m[key] for m in of_region])[theirs.mesh.region_of] for key in ("E", "nu"))
                true = squared_errors(fields(theirs, stress), fields(finest.level), E, nu)
                for judgement in (wide, narrow):
                    self.check_fields(judgement, true, theirs, own)
                    self.check_parts(judgement, true, theirs, own, random)
                (energy,) = narrow["quantities"]
                self.assertLessEqual(energy["wrong_by"][0], energy["wrong_by"][1])

    def check_widths(self, wide: tb.Judgement, narrow: tb.Judgement) -> None:
        self.assertEqual(wide.status, "judged")
        self.assertEqual(narrow["displacement"]["bound"] <= 0.02 * narrow["displacement"]["distance"],
                         narrow.status == "judged")
        for field in ("displacement", "stress"):
            (lower, upper), (low, high) = wide[field]["error"], narrow[field]["error"]
            self.assertLessEqual(lower, high)
            self.assertLessEqual(low, upper)
            self.assertLessEqual(high - low, upper - lower)

    def check_parts(self, judgement: tb.Judgement, true: Squares, theirs: tb.Level, own: float,
                    random: np.random.Generator) -> None:
        """On unions of cells, by the distances of the cells."""
        table = np.genfromtxt(judgement.directory / "judged_cells.csv", delimiter=",", names=True, dtype=None,
                              encoding=None)
        centres = np.stack([table[axis] for axis in "xyz"[: theirs.dimension]], axis=1)
        np.testing.assert_allclose(centres, theirs.mesh.points[theirs.mesh.cells].mean(axis=1), atol=1e-9)
        bound = judgement["displacement"]["bound"]
        for _ in range(4):
            part = random.random(len(table)) < random.random()
            distance = float(np.sqrt((table["distance"][part] ** 2).sum()))
            self.assert_between((distance - bound, distance + bound), true.displacement[part], own)

    def test_distance_is_that_of_an_independent_quadrature(self) -> None:
        for d, degree in ((2, 1), (2, 2), (3, 1)):
            case = block(d, 2, adapt={"max_levels": 3})
            theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": degree}).level
            stress = averaged_stress(theirs)
            solution = (theirs.nodes, theirs.displacement, stress)
            with tempfile.TemporaryDirectory() as directory:
                judged = tb.judge(case, solution, set={"judge.sharpness": 1e-9}, directory=directory)
                ours = tb.run(tb.Case.read(Path(directory) / "judge/case.toml"), set={
                    "adapt.measure": "energy", "certify.energy": "every", "adapt.tolerance": 1e-12,
                }).level
            self.assertEqual(judged["cells"], len(ours.eta))
            expected = squared_errors(fields(theirs, stress), fields(ours), 1.0, 0.3)
            for field in ("displacement", "stress"):
                distance = np.sqrt(getattr(expected, field).sum())
                self.assertAlmostEqual(judged[field]["distance"] / distance, 1, places=6)

    def test_stresses(self) -> None:
        case = block(2, 2, adapt={"max_dofs": 20000})
        theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": 1}).level
        solution = (theirs.nodes, theirs.displacement, averaged_stress(theirs))
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
        stress = averaged_stress(level)
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory) / "analysis.frd"
            write_frd(file, points, cells, level.displacement[order], stress[order])
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
        sigma = averaged_stress(level)[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
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
