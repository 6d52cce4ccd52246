#!/usr/bin/python3
"""`tribound judge` on CalculiX's bodies of revolution, from nothing but deck and .frd.

    judged.py PROGRAM FOLDER        exit code 77 where ccx is not installed

The errors must lie in the intervals, by code that shares nothing with the judge: tests/python/true_errors.py, against a
solution of degree 3 that is bounded itself, with what ccx.py reads from the .frd.
"""

import json
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent.parent / "scripts"), str(HERE.parent / "python")]

import axisymmetric  # noqa: E402
import ccx  # noqa: E402
from bodies import Body  # noqa: E402
from compare import SKIPPED, Failure, imported, tribound  # noqa: E402
from result_files import read_grid  # noqa: E402
from true_errors import Fields, squared_errors  # noqa: E402

DECKS = {"shrunk_ring": (1, 10), "spinning_ring": (1,)}  # stiffness of contact in place of K
E, NU = 210e3, 0.3  # of material()
REFERENCE = ["degree=3", 'adapt.measure="energy"', "adapt.energy_tolerance=0.003", "adapt.tolerance=1", "adapt.max_levels=30", "output.report=false"]
BLUR = 0.5  # of an interval's width: the bound of the reference solution is less
CAX6 = np.array([[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]], dtype=np.int32)


class Meshed(Body):
    """Remembers all bodies of a deck; its elements are triangles of second order."""

    all = []

    def __init__(self, name, kind, *axes, **options):
        super().__init__(name, "CAX6", *axes, **options)
        self.all.append(self)


def deck_of(name):
    """The deck, and corners and nodes of its elements: nodes are numbered one body after the other."""
    Meshed.all = []
    axisymmetric.Body = Meshed
    lines = getattr(axisymmetric, name)()
    points = np.array([point for body in Meshed.all for point in body.points])
    elements = np.array([[body.first_node - 1 + node for node in nodes] for body in Meshed.all for nodes in body.elements])
    return "\n".join([*lines, ""]), points[elements[:, :3]], elements


def settings(*words):
    return [word for setting in words for word in ("--set", setting)]


def reference_of(program, case, out):
    """Fields, and the bound of their error."""
    tribound(program, "run", case, *settings(*REFERENCE, f'output.directory="{out}"'))
    grid = read_grid(sorted(out.glob("level_*.vtu"))[-1])
    points, displacement = grid.points[grid.nodes][..., :2], grid.point_data["displacement"][grid.nodes][..., :2]
    corners = points[:, :3]
    local = (points[0] - corners[0, 0]) @ np.linalg.inv(corners[0, 1:] - corners[0, 0])
    indices = np.rint(3 * np.column_stack([1 - local.sum(axis=1), local])).astype(np.int32)
    bound = json.loads((out / "certificate.json").read_text())["energy_error"]["bound"]
    return Fields(corners, indices, displacement), bound


def problems_of(name, judgement, theirs, reference, own):
    """Where an interval cannot hold the error."""
    squares = squared_errors(theirs, reference, E, NU, of_revolution=True)
    for field in ("displacement", "stress"):
        error, (lower, upper) = math.sqrt(getattr(squares, field).sum()), judgement[field]["error"]
        relative = ", ".join(f"{100 * end:.3g} %" for end in judgement[field]["relative"])
        print(f"{name}, {field}: {error:.5g} +- {own:.2g} in {lower:.5g} to {upper:.5g}, relative {relative}", flush=True)
        if not lower - own <= error <= upper + own:
            yield f"{name}: the error of the {field} is {error:.6g}, not {lower:.6g} to {upper:.6g}"
        if own > BLUR * (upper - lower):
            yield f"{name}: the reference solution is too coarse for the interval of the {field}"


def check(program, folder, name, factors):
    text, corners, elements = deck_of(name)
    deck = folder / f"{name}.inp"
    deck.write_text(text)
    case = imported(program, deck, folder)
    reference, own = reference_of(program, case, folder / f"{name}_reference")
    nothing = replace(reference, displacement=0 * reference.displacement)
    norm = math.sqrt(squared_errors(nothing, reference, E, NU, of_revolution=True).displacement.sum())
    problems = []
    for factor in factors:
        solution = ccx.solve(deck, folder, factor)
        out = folder / f"{name}_{factor}"
        tribound(program, "judge", case, "--solution", folder / f"stiff_{factor}.frd", *settings(f'output.directory="{out}"'))
        judgement = json.loads((out / "judge/judgement.json").read_text())
        if not norm - own <= judgement["energy_norm"] <= norm + 2 * own:
            problems.append(f"{name}: the energy norm is {judgement['energy_norm']:.6g}, that of the reference {norm:.6g}")
        theirs = Fields(corners, CAX6, solution.displacements[-1][elements][..., :2], solution.stresses[-1][elements])
        problems += problems_of(f"{name}, {factor} K", judgement, theirs, reference, own)
    return problems


def main(program, folder):
    if ccx.PROGRAM is None:
        print("ccx is not installed: scripts/ccx installs it")
        return SKIPPED
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    problems = []
    for name, factors in DECKS.items():
        try:
            problems += check(program, folder, name, factors)
        except (Failure, RuntimeError) as failure:
            problems.append(f"{name}: {failure}")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    raise SystemExit(main(*sys.argv[1:]))
