"""Judgements of bodies of revolution against errors by true_errors.py, code that shares nothing with them."""

import os
import tempfile
import unittest
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb
from numpy.typing import NDArray

from test_judge import AgainstTrueErrors, averaged_stress, fields, random_half
from true_errors import squared_errors

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
ALPHA = 0.5
CASES = int(os.environ.get("TRIBOUND_CASES", "6"))


def body(inner: float, **more: Any) -> dict[str, Any]:
    """A cylinder, hollow where `inner` is not 0, is pressed on a rigid floor."""
    left: dict[str, Any] = {"pressure": 0.05} if inner else {"displacement": [0, "free"]}
    return {
        "model": "axisymmetric",
        "degree": 2,
        "mesh": {"box": {"lower": [inner, 0], "upper": [inner + 1, 1], "cells": [4, 4]}},
        "material": {"E": 1.0, "nu": 0.3},
        "boundary": {
            "left": left,
            "right": {"traction": [0, 0]},
            "top": {"pressure": "0.05*(1 + x)"},
            "bottom": {"contact": {"friction": "none", "gap": 0}},
        },
        "adapt": {"max_dofs": 6000},
        **more,
    }


def random_case(random: np.random.Generator) -> dict[str, Any]:
    case = body(float(random.choice([0, 0, 0.05, 1, 20])), quantity=[{"name": "energy", "kind": "energy"}])
    box = case["mesh"]["box"]
    box["cells"] = [int(n) for n in random.integers(1, 5, 2)]
    law = str(random.choice(["none", "tresca"]))
    contact = case["boundary"]["bottom"]["contact"]
    contact.update({"friction": law, "gap": float(random.choice([0, 0.01]))})
    if law == "tresca":
        contact["threshold"] = float(random.uniform(0.01, 0.1))
    pull, push = (float(random.uniform(-0.1, upper)) for upper in (0.1, 0))
    case["boundary"]["right"] = {"traction": [pull, push]}
    if random.random() < 0.5:
        case["boundary"]["top"] = {"displacement": ["free", -0.03]}
    case["material"]["nu"] = nu = float(random.choice([0.0, 0.3, 0.45]))
    E = float(random.uniform(0.5, 2))
    case["material"]["inner"] = {"E": E, "nu": nu, "where": random_half(random, box)}
    case["adapt"] = {"max_dofs": 3000, "max_levels": 12}
    support = int(random.integers(5))
    if support == 0:
        case["boundary"]["right"]["spring"] = {"normal": float(random.uniform(0, 1)), "tangential": 0.2}
    elif support == 1:
        case["boundary"]["top"] = {"rigid": {"force": [0, -0.3]}}
    elif support == 2:
        case["boundary"]["top"] = {"slider": -0.03}
    if random.random() < 0.5:
        slopes = [f"{float(x)!r}" for x in random.uniform(-0.03, 0.03, 10)]
        form = str(random.choice(["{} + {}*y", "{}*x + {}*exp(y)", "{}*x*y + {}*y*y"]))
        texts = [form.format(*slopes[k : k + 2]) for k in range(0, 10, 2)]
        case["load"] = {"temperature": texts[0], "initial_stress": texts[1:]}
        case["material"]["alpha"] = case["material"]["inner"]["alpha"] = ALPHA
    return case


def initial_stress(case: dict[str, Any], E: Floats, nu: float) -> Callable[[Floats, Ints], Floats] | None:
    """sigma_0 at points (cells, points, 2) in cells with these numbers, E being that of every cell."""
    if "load" not in case:
        return None
    texts = (case["load"]["temperature"], *case["load"]["initial_stress"])

    def at(points: Floats, cells: Ints) -> Floats:
        names = {"x": points[..., 0], "y": points[..., 1], "exp": np.exp}
        temperature, rr, zz, rz, hoop = (eval(text, names) for text in texts)
        thermal = -ALPHA * E[cells, None] / (1 - 2 * nu) * temperature  # 3 lambda + 2 mu = E / (1 - 2 nu)
        stress = np.zeros((*temperature.shape, 3, 3))
        stress[..., 0, 0], stress[..., 1, 1], stress[..., 2, 2] = rr + thermal, zz + thermal, hoop + thermal
        stress[..., 0, 1] = stress[..., 1, 0] = rz
        return stress

    return at


class Guarantee(AgainstTrueErrors):
    def test_the_error_lies_in_the_interval(self) -> None:
        """Of displacements and stresses that are moved at random, on the body and on each region."""
        judged = 0
        for seed in range(CASES):
            random = np.random.default_rng(seed)
            case = random_case(random)
            degree = int(random.integers(1, 4))
            theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": degree}).level
            size = float(random.choice([0, 1e-3, 1e-1])) * np.abs(theirs.displacement).max()
            moved = theirs.displacement + size * random.uniform(-1, 1, theirs.displacement.shape)
            moved[theirs.nodes[:, 0] == 0, 0] = 0
            stress = averaged_stress(theirs)
            solution = (theirs.nodes, moved, stress)
            wide = tb.judge(case, solution, set={"judge.sharpness": 1e6})
            narrow = tb.judge(case, solution, set={"judge.sharpness": 0.02, "degree": 3})
            with self.subTest(seed=seed, degree=degree, case=case):
                finest = tb.run(case, set={"degree": 3, "adapt.measure": "energy", "adapt.tolerance": 1e-5,
                                           "adapt.max_dofs": 10000})
                own = finest.certificate["energy_error"]["bound"]  # of the finer solution itself
                of_region = [case["material"].get(name, case["material"]) for name in theirs.mesh.regions]
                E, nu = (np.array([m[key] for m in of_region])[theirs.mesh.region_of] for key in ("E", "nu"))
                their_fields = replace(fields(theirs, stress), displacement=moved[theirs.cell_nodes])
                true = squared_errors(their_fields, fields(finest.level), E, nu, of_revolution=True,
                                      initial=initial_stress(case, E, float(nu[0])))
                for judgement in (wide, narrow):
                    self.assertNotEqual(judgement.status, "no bound", judgement["reason"])
                    self.check_fields(judgement, true, theirs, own)
                (energy,) = narrow["quantities"]
                self.assertIsNotNone(energy["theirs"])
                judged += 1
        self.assertEqual(judged, CASES)


class Distances(unittest.TestCase):
    def test_our_own_solution(self) -> None:
        """On the coarse mesh of the case the distance is 0, and the interval holds."""
        for inner in (0.0, 1.0):
            case = body(inner)
            once = {"adapt.max_levels": 0}
            level = tb.run(case, set=once).level
            judged = tb.judge(case, (level.nodes, level.displacement), set=once)
            self.assertLess(judged["displacement"]["distance"], 1e-9 * judged["energy_norm"])
            lower, upper = judged["displacement"]["error"]
            self.assertEqual(lower, 0)
            self.assertAlmostEqual(upper / judged["displacement"]["bound"], 1, places=6)

    def test_nothing_is_wrong_by_the_energy_norm(self) -> None:
        case = body(0.0, quantity=[{"name": "energy", "kind": "energy"}])
        once = {"adapt.max_levels": 0}
        run = tb.run(case, set=once)
        judged = tb.judge(case, (run.level.nodes, 0 * run.level.displacement), set=once)
        self.assertAlmostEqual(judged["displacement"]["distance"] / judged["energy_norm"], 1, places=12)
        ours = fields(run.level)
        nothing = replace(ours, displacement=0 * ours.displacement)
        square = squared_errors(nothing, ours, 1.0, 0.3, of_revolution=True).displacement.sum()
        self.assertAlmostEqual(judged["energy_norm"] ** 2 / square, 1, places=9)
        (energy,) = tb.judge(case, (run.level.nodes, run.level.displacement), set=once)["quantities"]
        self.assertAlmostEqual(energy["theirs"] / square, 1, places=9)
        assert judged.relative
        self.assertLessEqual(judged.relative[0], 1)
        self.assertGreaterEqual(judged.relative[1], 1)

    def test_distance_is_that_of_an_independent_quadrature(self) -> None:
        for inner, degree in ((0.0, 1), (0.0, 2), (0.05, 3), (10.0, 2)):
            case = body(inner, adapt={"max_levels": 3})
            theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": degree}).level
            stress = averaged_stress(theirs)
            with tempfile.TemporaryDirectory() as directory:
                judged = tb.judge(case, (theirs.nodes, theirs.displacement, stress),
                                  set={"judge.sharpness": 1e-9}, directory=directory)
                ours = tb.run(tb.Case.read(Path(directory) / "judge/case.toml"), set={
                    "adapt.measure": "energy", "certify.energy": "every", "adapt.tolerance": 1e-12,
                }).level
            self.assertEqual(judged["cells"], len(ours.eta))
            expected = squared_errors(fields(theirs, stress), fields(ours), 1.0, 0.3, of_revolution=True)
            for field in ("displacement", "stress"):
                distance = np.sqrt(getattr(expected, field).sum())
                self.assertAlmostEqual(judged[field]["distance"] / distance, 1, places=6)


class Use(unittest.TestCase):
    def setUp(self) -> None:
        self.case = body(0.0)
        self.level = tb.run(self.case, set={"adapt.max_levels": 0, "degree": 1}).level

    def test_forces_are_axial(self) -> None:
        """A stress that is constant, sigma_zz = 3: its forces are those on a disc."""
        stress = np.tile([2.0, 3.0, 2.0, 0, 0, 0], (len(self.level.nodes), 1))
        judged = tb.judge(self.case, (self.level.nodes, self.level.displacement, stress))
        forces = {force["boundary"]: force["theirs"] for force in judged["forces"]}
        np.testing.assert_allclose(forces["top"], [0, 3 * np.pi], rtol=1e-12)
        np.testing.assert_allclose(forces["bottom"], [0, -3 * np.pi], rtol=1e-12)
        np.testing.assert_allclose(forces["right"], [0, 0], atol=1e-12)
        ours = {force["boundary"]: force["ours"] for force in judged["forces"]}
        np.testing.assert_allclose(ours["top"], [0, -0.05 * 2 * np.pi * (1 / 2 + 1 / 3)], rtol=1e-9)
        self.assertEqual(judged["model"], "axisymmetric")

    def test_thresholds(self) -> None:
        solution = (self.level.nodes, self.level.displacement)
        self.assertEqual(tb.judge(self.case, solution, accept=0.9).status, "accepted")
        self.assertEqual(tb.judge(self.case, solution, accept=1e-3).status, "rejected")

    def test_other_meshes_and_files(self) -> None:
        """The stress of a .vtu has its hoop part; on another mesh both are interpolated."""
        other = body(0.0, mesh={"box": {"lower": [0, 0], "upper": [1, 1], "cells": [6, 5]}})
        with tempfile.TemporaryDirectory() as directory:
            file = tb.run(other, set={"adapt.max_levels": 0}, directory=directory).directory / "level_000.vtu"
            with self.assertRaisesRegex(tb.InputError, "--interpolate"):
                tb.judge(self.case, file)
            judged = tb.judge(self.case, file, interpolate=True)
            whole = tb.judge(other, file)
        for judgement in (judged, whole):
            assert judgement.relative and judgement.stress
            self.assertLess(judgement.relative[1], 0.1)
            self.assertLess(judgement.stress[1], 0.1)

    def test_load_steps(self) -> None:
        """Of a path each step is judged; half of the load has half of the error without contact that opens."""
        case = body(0.5, history={"steps": [0.5, 1.0]}, adapt={"tolerance": 0.05})
        case["boundary"]["top"] = {"pressure": "0.1*t"}
        case["boundary"]["left"] = {"pressure": "0.05*t"}
        with tempfile.TemporaryDirectory() as directory:
            theirs = tb.run(case, set={"adapt.max_levels": 0, "degree": 1}, directory=directory)
            judged = tb.judge(case, theirs.directory / "series.pvd", steps=True)
        half, full = judged.steps
        assert half.error and full.error
        self.assertLess(half.error[0], full.error[1] / 2)
        self.assertGreater(half.error[1], full.error[0] / 2)

    def test_rigid_motions_along_the_axis(self) -> None:
        moved = self.level.displacement + [0, 0.25]
        judged, other = (tb.judge(self.case, (self.level.nodes, u)) for u in (moved, self.level.displacement))
        ((motion,), (usual,)) = judged["rigid_difference"], other["rigid_difference"]
        self.assertAlmostEqual(motion["translation"][1] - usual["translation"][1], 0.25, places=9)
        self.assertEqual((motion["translation"][0], motion["rotation"]), (0, [0]))
        np.testing.assert_allclose(judged["displacement"]["error"], other["displacement"]["error"], rtol=1e-9)

    def test_what_is_refused(self) -> None:
        moved = self.level.displacement + [0.1, 0]
        with self.assertRaisesRegex(tb.InputError, "of the axis by"):
            tb.judge(self.case, (self.level.nodes, moved))
        stress = averaged_stress(self.level)[:, [0, 1, 3]]
        with self.assertRaisesRegex(tb.InputError, "without zz"):
            tb.judge(self.case, (self.level.nodes, self.level.displacement, stress))


if __name__ == "__main__":
    unittest.main()
