#!/usr/bin/python3
"""The decks of make.py, solved by CalculiX and by Tribound.

    compare.py PROGRAM FOLDER import [NAME ...]     imports and checks every deck, in seconds
    compare.py PROGRAM FOLDER ccx [NAME ...]        compares with CalculiX; exit code 77 where ccx is not installed
    compare.py PROGRAM FOLDER write                 the same, and writes the table of docs/decks.md
    compare.py PROGRAM FOLDER refined               compares some on finer meshes, and writes that table there

CalculiX presses bodies apart by springs; K, the stiffness of the deck, is multiplied by 1, 10 and 100. Forces of
supports and contacts must agree to a percent with 100 K, displacements to what discretisation leaves; and CalculiX must
come to rest as K grows.
"""

import json
import re
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "scripts"))  # before a package that has the name of one of the modules

import axisymmetric  # noqa: E402
import ccx  # noqa: E402
import make  # noqa: E402
from result_files import read_grid  # noqa: E402
from tables import table, update  # noqa: E402

STIFFNESSES = (1, 10, 100)
FORCES = 0.01  # of the largest force
DISPLACEMENTS = 0.03  # at 100 K, root mean square: discretisation
REST = 1e-4  # relative change that does not count
# What CalculiX computes is so much of what Tribound does: a sheet of this thickness; 2 of 360 degrees.
SHARES = {"14_plane_stress": 2.5, **dict.fromkeys(axisymmetric.DECKS, 1 / 180)}
ACCEPTED = {"15_prisms": ["NLGEOM"]}
PERIOD = 1.0  # of every step
COLUMNS = ["deck|", "elements|", "cells", "steps", "forces, deviation", *(f"displacements at {k}, deviation" for k in ("K", "10 K", "100 K")),
           "ccx, seconds", "Tribound, seconds"]
REFINED = {"11_instances": (1, 2, 3), "16_gravity": (1, 2, 3), "20_prepomax": (1, 2)}  # cells in place of one, along each axis
SKIPPED = 77


class Failure(Exception):
    pass


def tribound(program, *arguments):
    run = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=1800)
    if run.returncode not in (0, 3):  # 3: the bound has not reached its tolerance
        raise Failure(f"tribound {' '.join(map(str, arguments))}: exit code {run.returncode}\n{run.stdout[-500:]}{run.stderr[-1500:]}")
    return run.stdout


def is_part(boundary, name):
    """Whether a boundary of the case is a set of the deck, or lies in it: sets that overlap are cut, and joined by +."""
    parts = re.sub(r" \d+$", "", boundary.upper().replace(".", "_")).split("+")
    return name in parts


def imported(program, deck, folder):
    """The case that a deck becomes; `import` checks it."""
    for suffix in (".toml", ".msh"):
        (folder / f"{deck.stem}{suffix}").unlink(missing_ok=True)
    accepted = [f"--accept={keyword}" for keyword in ACCEPTED.get(deck.stem, [])]
    tribound(program, "import", deck, "--directory", folder, *accepted)
    return folder / f"{deck.stem}.toml"


class Run:
    """The case on its mesh, degree 2: forces and displacements at the ends of the steps of the deck."""

    def __init__(self, program, case, folder):
        began = time.monotonic()
        shutil.rmtree(folder, ignore_errors=True)
        settings = [f'output.directory="{folder}"', "degree=2", "adapt.max_levels=0", "output.report=false"]
        tribound(program, "run", case, *(word for setting in settings for word in ("--set", setting)))
        self.seconds = time.monotonic() - began
        self.certificate = json.loads((folder / "certificate.json").read_text())
        self.case = tomllib.loads(case.read_text())
        self.is_axisymmetric = self.case.get("model") == "axisymmetric"
        steps = self.certificate.get("steps")
        if steps:
            ends = [s for s in steps if abs(s["t"] / PERIOD - round(s["t"] / PERIOD)) < 1e-9]
            self.balances = [s["balance"]["rows"] for s in ends]
            self.grids = [read_grid(folder / f"step_{s['step']:03}.vtu") for s in ends]
        else:
            self.balances = [self.certificate["balance"]["rows"]]
            self.grids = [read_grid(sorted(folder.glob("level_*.vtu"))[-1])]

    def force(self, step, kind, name):
        """The sum of the rows whose boundary is the set, or a part of it; None if there are none."""
        rows = [row for row in self.balances[step] if row["kind"] == kind and is_part(row["name"], name)]
        return np.sum([row["force"] for row in rows], axis=0) if rows else None

    def is_held(self, name, component):
        return any(
            is_part(boundary, name) and "displacement" in data and data["displacement"][component] != "free"
            for boundary, data in self.case["boundary"].items()
        )


def forces(run, name, solution):
    """The largest difference of any force at the end of any step, over the largest force."""
    differences, largest = [], 0.0
    for set_name, steps in solution.forces.items():
        for step, reference in enumerate(steps):
            expected = reference / SHARES.get(name, 1)
            reaction, contact = (run.force(step, kind, set_name) for kind in ("reaction", "contact"))
            force = contact if reaction is None else reaction
            if force is None:
                raise Failure(f"no boundary is {set_name}: {[row['name'] for row in run.balances[step]]}")
            for c, value in enumerate(force):
                if run.is_axisymmetric and c == 0:  # radial forces cancel over the full circle
                    continue
                largest = max(largest, abs(expected[c]))
                if reaction is None or run.is_held(set_name, c):
                    differences.append((abs(value - expected[c]), f"{set_name}, step {step + 1}, {'xyz'[c]}: {value:.6g}, ccx {expected[c]:.6g}"))
    difference, where = max(differences)
    return difference / largest, where


def displacements(run, solution):
    """The root mean square of the differences at the corners of the mesh, over that of the displacements; the largest of all steps."""
    worst = 0.0
    for grid, reference in zip(run.grids, solution.displacements):
        dim = grid.dimension
        corners = np.unique(grid.corners())
        points, u = grid.points[corners, :dim], grid.point_data["displacement"][corners, :dim]
        tolerance = 2e-5 * (points.max(axis=0) - points.min(axis=0)).max()  # ccx writes five digits
        nodes = cKDTree(solution.points[:, :dim])
        ours = cKDTree(points)
        largest, differences, sizes = np.abs(u).max(), [], []
        for i, point in enumerate(points):
            near, same = nodes.query_ball_point(point, tolerance), ours.query_ball_point(point, tolerance)
            spread = max(np.ptp(values, axis=0).max() for values in (u[same], reference[near, :dim])) if near else np.inf
            if spread > 1e-5 * largest:  # not found, or on both sides of a contact: which node is which?
                continue
            differences.append(reference[near[0], :dim] - u[i])
            sizes.append(u[i])
        if len(sizes) < 10:
            raise Failure(f"only {len(sizes)} nodes are found again")
        worst = max(worst, np.linalg.norm(differences) / np.linalg.norm(sizes))
    return worst


def compare(program, folder, name, paths):
    """The row of the table, what is wrong, and the deviation of displacements at 100 K."""
    deck, ccx_deck = paths
    case = imported(program, deck, folder / "cases")
    run = Run(program, case, folder / "runs" / name)
    solutions = [ccx.solve(ccx_deck, folder, factor) for factor in STIFFNESSES]
    shares = [displacements(run, solution) for solution in solutions]
    solution = solutions[-1]
    deviation, where = forces(run, name, solution)
    problems = [f"{name}: force of {where}"] if deviation > FORCES else []
    if shares[-1] > DISPLACEMENTS:
        problems.append(f"{name}: displacements differ by {shares[-1]:.2g} at 100 K")
    first, second = (np.linalg.norm(b.displacements[-1] - a.displacements[-1]) for a, b in zip(solutions, solutions[1:]))
    if second > first / 2 + REST * np.linalg.norm(solution.displacements[-1]):
        problems.append(f"{name}: CalculiX changes by {first:.3g} from K to 10 K, by {second:.3g} to 100 K")
    kinds = sorted(element_types(folder, ccx_deck))
    cells = run.certificate["mesh"]["cells"]
    percents = [f"{100 * share:.2g} %" for share in (deviation, *shares)]
    return [name, " ".join(kinds), cells, len(run.balances), *percents, f"{solution.seconds:.1f}", f"{run.seconds:.1f}"], problems, shares[-1]


def element_types(folder, deck):
    text = "".join(file.read_text().upper() for file in (deck, *folder.glob(f"{deck.stem}.mesh.inp")))
    return set(re.findall(r"\n\*ELEMENT, TYPE=(\w+)", text))


def refined(program, folder):
    """On finer meshes, what is discretisation must become smaller. Returns the rows of the table, and what is wrong."""
    rows, problems = [], []
    for name, refinements in REFINED.items():
        shares = []
        for n in refinements:
            paths = make.write(folder / f"refined_{n}", [name], n)
            row, wrong, share = compare(program, folder / f"refined_{n}", name, paths[name])
            rows.append([name, "h" if n == 1 else f"h / {n}", row[2], *row[4:]])
            print("  ".join(map(str, rows[-1])), flush=True)
            problems += wrong
            shares.append(share)
        if shares != sorted(shares, reverse=True):
            problems.append(f"{name}: displacements at 100 K deviate by {shares} on finer and finer meshes")
    return rows, problems


def all_decks(program, folder, mode, names):
    """The rows of the table, and what is wrong."""
    paths = make.write(folder, names)
    rows, problems = [], []
    for name, decks in paths.items():
        try:
            if mode == "import":
                imported(program, decks[0], folder / "cases")
                print(f"{name}: ok")
                continue
            row, wrong, _ = compare(program, folder, name, decks)
            rows.append(row)
            problems += wrong
            print("  ".join(map(str, row)), flush=True)
        except (Failure, RuntimeError) as failure:
            problems.append(f"{name}: {failure}")
            print(problems[-1], flush=True)
    return rows, problems


def main(program, folder, mode, *names):
    if mode != "import" and ccx.PROGRAM is None:
        print("ccx is not installed: scripts/ccx installs it")
        return SKIPPED
    if mode == "refined":
        rows, problems = refined(program, Path(folder))
        update("docs/decks.md", {"refined": table(["deck|", "edges|", "cells", *COLUMNS[4:]], rows)})
    else:
        rows, problems = all_decks(program, Path(folder), mode, names)
    if mode == "write":
        update("docs/decks.md", {"decks": table(COLUMNS, rows)})
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) < 4 or sys.argv[3] not in ("import", "ccx", "write", "refined"):
        raise SystemExit(__doc__)
    raise SystemExit(main(*sys.argv[1:]))
