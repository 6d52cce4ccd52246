"""Judgements of all load steps at once, against separate ones and against runs of the steps alone."""

import json
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import tribound as tb

from small_cases import block


def pressed(**contact: Any) -> dict[str, Any]:
    """A block that is pressed down and pushed, in two steps."""
    floor = {"name": "floor", "kind": "contact_force", "direction": [0, 1]}
    quantities = [{"name": "work", "kind": "load_work"}, floor]
    case = block(2, 2, history={"steps": [0.5, 1.0]}, adapt={"tolerance": 0.03}, quantity=quantities)
    case["boundary"]["bottom"]["contact"] = {"gap": 0, **contact}
    case["boundary"]["top"] = {"traction": [0, "-0.1*t"]}
    case["boundary"]["right"] = {"traction": ["0.06*t*t", "0.04*t"]}
    return case


LAWS: tuple[dict[str, Any], ...] = ({"friction": "none"}, {"friction": "tresca", "threshold": 0.03})
COARSE = {"degree": 1, "adapt.max_levels": 0}


def arrays(level: tb.Level) -> tuple[Any, ...]:
    """Points, displacements, and stresses averaged at the nodes."""
    stress, count = np.zeros((len(level.nodes), 6)), np.zeros(len(level.nodes))
    np.add.at(stress, level.cell_nodes, level.stress)
    np.add.at(count, level.cell_nodes, 1)
    return level.nodes, level.displacement, stress / count[:, None]


def work_of_loads(level: tb.Level, t: float) -> float:
    """Of the tractions of pressed() on straight edges of degree 1, by the trapezoidal rule."""
    total = 0.0
    for axis, place, traction in ((1, 1.0, (0, -0.1 * t)), (0, 2.0, (0.06 * t * t, 0.04 * t))):
        on_edge = np.flatnonzero(np.isclose(level.nodes[:, axis], place))
        on_edge = on_edge[np.argsort(level.nodes[on_edge, 1 - axis])]
        x = level.nodes[on_edge, 1 - axis]
        power = level.displacement[on_edge] @ np.array(traction)
        total += float(np.sum((power[1:] + power[:-1]) / 2 * np.diff(x)))
    return total


class Steps(unittest.TestCase):
    def test_they_are_what_separate_judgements_say(self) -> None:
        for law in LAWS:
            case = pressed(**law)
            theirs = [arrays(level) for level in tb.run(case, keep_levels=True, set=COARSE).levels]
            floor = [0.03, 0.06]
            together = tb.judge(case, theirs, steps=True, numbers={"floor": floor})
            self.assertEqual(len(together.steps), 2)
            for number, step in enumerate(together.steps, 1):
                own = {"floor": floor[number - 1]}
                alone = tb.judge(case, theirs[number - 1], load_step=number, numbers=own)
                with self.subTest(law=law, number=number):
                    self.assertEqual((step["load_step"], step["t"]), (number, [0.5, 1.0][number - 1]))
                    different = {key for key in alone if alone[key] != step[key]}
                    self.assertLessEqual(different, {"solution"})
                    self.assertEqual(step["solution"]["description"], alone["solution"]["description"])
                    self.assertIn(step.status, ("judged", "wide"))
            relative = [step.relative or (0.0, 0.0) for step in together.steps]
            self.assertEqual(together["worst"], 1 + int(np.argmax([upper for _, upper in relative])))
            self.assertEqual(together.relative, relative[together["worst"] - 1])

    def test_intervals_hold_the_numbers_of_a_finer_run(self) -> None:
        """Loads, and so their work, are those of the step."""
        case = pressed(**LAWS[1])
        levels = tb.run(case, keep_levels=True, set=COARSE).levels
        judged = tb.judge(case, [arrays(level)[:2] for level in levels], steps=True)
        finest = tb.run(case, set={"degree": 3, "adapt.tolerance": 0.005, "certify.energy": "every"})
        for step, level, record in zip(judged.steps, levels, finest.certificate["steps"]):
            work, floor = step["quantities"]
            self.assertAlmostEqual(work["theirs"], work_of_loads(level, step["t"]), places=12)
            self.assertIsNone(floor["theirs"])
            for judged_number, ours in zip((work, floor), record["quantities"]):
                self.assertEqual(judged_number["name"], ours["name"])
                self.assertLessEqual(judged_number["lower"], ours["upper"])
                self.assertLessEqual(ours["lower"], judged_number["upper"])

    def test_thresholds_are_those_of_the_worst(self) -> None:
        case = pressed(**LAWS[0])
        fair = tb.run(case, keep_levels=True, set={"adapt.max_levels": 0})
        good = [arrays(level)[:2] for level in fair.levels]
        bad = [good[0], (good[1][0], 2 * good[1][1])]
        for theirs, status in ((good, "accepted"), (bad, "rejected")):
            judged = tb.judge(case, theirs, steps=True, accept=0.5)
            self.assertEqual(judged.status, status)
            self.assertEqual(judged.steps[0].status, "accepted")
            self.assertEqual(judged.steps[1].status, status)
        self.assertEqual(judged["worst"], 2)

    def test_without_a_bound_statics_count(self) -> None:
        case = pressed(friction="none")
        joint = {"law": "joint", "tensile_strength": 10, "fracture_energy": 1000}
        case["boundary"]["bottom"] = {"interface": joint}
        del case["quantity"]
        theirs = [arrays(level) for level in tb.run(case, keep_levels=True, set=COARSE).levels]
        judged = tb.judge(case, theirs, steps=True, set={"adapt.tolerance": 0.2})
        self.assertEqual(judged.status, "no bound")
        self.assertIsNone(judged.relative)
        for step in judged.steps:
            self.assertIn("bond", step["reason"])
            self.assertGreater(step["imbalance"], 0)
            (pushed,) = (force for force in step["forces"] if force["boundary"] == "right")
            t = step["t"]
            np.testing.assert_allclose(pushed["ours"], [0.06 * t * t, 0.04 * t], rtol=1e-9)

    def test_a_path_that_ends_before_its_last_value(self) -> None:
        """The block slides away at t = 1.5. What halved steps find before is no load step of the case."""
        case = pressed(**LAWS[1])
        case["boundary"]["left"] = {"traction": [0, 0]}
        case["boundary"]["right"] = {"traction": ["0.04*t", 0]}
        coarse = tb.run(case, keep_levels=True, set=COARSE)
        theirs = [arrays(level)[:2] for level in coarse.levels]
        case["history"]["steps"] = [0.5, 1.0, 2.0]
        with tempfile.TemporaryDirectory() as directory:
            judged = tb.judge(case, [*theirs, theirs[1]], steps=True, directory=directory)
            certificate = json.loads((judged.directory / "certificate.json").read_text())
        self.assertEqual([step["t"] for step in certificate["steps"]], [0.5, 1.0, 1.5])
        self.assertEqual([step["load_step"] for step in judged.steps], [1, 2, None])
        self.assertEqual([step["t"] for step in judged.steps], [0.5, 1.0, 2.0])
        self.assertIn("has not come so far", judged.steps[2]["reason"])
        self.assertIsNotNone(judged.steps[1].relative)
        self.assertIn(judged["worst"], (1, 2))


class Pairs(unittest.TestCase):
    case: dict[str, Any]
    folder: Path
    theirs: list[tuple[Any, ...]]

    @classmethod
    def setUpClass(cls) -> None:
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.folder = Path(directory.name)
        cls.case = pressed(**LAWS[0])
        result = tb.run(cls.case, keep_levels=True, set=COARSE, directory=cls.folder / "theirs")
        cls.theirs = [arrays(level)[:2] for level in result.levels]

    def test_a_series_of_paraview(self) -> None:
        series = self.folder / "theirs/series.pvd"
        judged = tb.judge(self.case, series, steps=True)
        table = tb.judge(self.case, self.theirs, steps=True)
        last = tb.judge(self.case, series)
        for step, other in zip(judged.steps, table.steps):
            assert step.error and other.error
            np.testing.assert_allclose(step.error, other.error, rtol=1e-9)
            self.assertIsNotNone(step.stress)
        self.assertIn("step 2", judged.steps[1]["solution"]["description"])
        self.assertEqual(dict(last), dict(judged.steps[1]))

    def test_times_choose_among_more_steps(self) -> None:
        """The series has the states before the first load step and between both, too."""
        files = ((0, 2), (0.5, 1), (0.75, 1), (1, 2))
        text = "".join(f'<DataSet timestep="{t}" file="theirs/step_00{number}.vtu"/>' for t, number in files)
        series = self.folder / "more.pvd"
        series.write_text(f'<VTKFile type="Collection"><Collection>{text}</Collection></VTKFile>')
        more = tb.judge(self.case, series, steps=True)
        two = tb.judge(self.case, self.folder / "theirs/series.pvd", steps=True)
        for step, other in zip(more.steps, two.steps):
            self.assertEqual(step["displacement"], other["displacement"])
        series.write_text(series.read_text().replace('"1"', '"2"').replace('"0.75"', '"1.5"'))
        words = r"4 steps \(t = 0, 0.5, 1.5, 2\), the case 2 load steps \(t = 0.5, 1\)"
        with self.assertRaisesRegex(tb.InputError, words):
            tb.judge(self.case, series, steps=True)

    def test_the_steps_of_calculix(self) -> None:
        """Without friction and gap half of the loads have half of the displacement."""
        from test_judge import write_frd
        from test_mesh import hexahedra

        points, cells, sides = hexahedra((4, 2, 2))
        mesh = tb.Mesh(points, cells, boundaries=sides)
        case = block(3, 1, history={"steps": [1, 2]}, adapt={"max_levels": 0})
        del case["mesh"]
        for free in ("back", "front"):
            case["boundary"][free] = {"traction": [0, 0, 0]}
        case["boundary"]["bottom"]["contact"] = {"friction": "none", "gap": 0}
        case["boundary"]["top"] = {"traction": [0, "-0.05*t", 0]}
        case["boundary"]["right"] = {"traction": ["0.03*t", "0.02*t", 0]}
        nodes, displacement, stress = arrays(tb.run(case, mesh, set={"history.steps": [2]}).level)
        order = [int(np.argmin(((nodes - x) ** 2).sum(axis=1))) for x in points]
        file = self.folder / "analysis.frd"
        write_frd(file, points, cells, displacement[order], stress[order])
        judged = tb.judge(case, file, mesh, steps=True)
        for number, step in enumerate(judged.steps, 1):
            self.assertIn(f"step {number} (t = {number})", step["solution"]["description"])
        first, second = (step["displacement"] for step in judged.steps)
        self.assertAlmostEqual(2 * first["distance"] / second["distance"], 1, places=4)
        self.assertAlmostEqual(2 * first["bound"] / second["bound"], 1, places=4)

    def test_what_does_not_pair_is_refused(self) -> None:
        alone = block(2, 2)
        refused: list[tuple[dict[str, Any], list[Any], dict[str, Any], str]] = [
            (self.case, self.theirs[:1], {"steps": True}, "has 1 step, the case 2 load steps"),
            (self.case, [*self.theirs, *self.theirs], {"steps": True}, "has 4 steps, the case 2 load steps"),
            (self.case, self.theirs, {}, "is a second solution"),
            (self.case, self.theirs, {"steps": True, "load_step": 1}, "either --steps"),
            (self.case, self.theirs, {"steps": True, "numbers": {"floor": 1}}, "has 1 value for 2 steps"),
            (alone, self.theirs, {"steps": True}, "has no load steps"),
        ]
        for case, theirs, options, words in refused:
            with self.subTest(words=words), self.assertRaisesRegex(tb.InputError, words):
                tb.judge(case, theirs, **options)

    def test_a_node_without_a_value_is_named_with_its_file(self) -> None:
        points, displacement = self.theirs[1]
        broken = displacement.copy()
        broken[3, 1] = np.nan
        with self.assertRaisesRegex(tb.InputError, "solution1.csv: has no displacement at node"):
            tb.judge(self.case, [self.theirs[0], (points, broken)], steps=True)


if __name__ == "__main__":
    unittest.main()
