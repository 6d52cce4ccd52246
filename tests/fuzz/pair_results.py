#!/usr/bin/env python3
"""Checks contact between bodies in 3D results by other files: gaps and slips by u on the cells, sums by the points.

    pair_results.py PROGRAM DIRECTORY

Three blocks on an obstacle, degree 1, non-matching meshes: a pair with friction across a gap, a tied pair, an obstacle.
"""

import csv
import json
import shutil
import sys
from pathlib import Path

import numpy as np

from judge_moments import about_origin, cross, resultant_of_rows
from results import read_grid

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cases"))
from runner import run  # noqa: E402

DISTANCE = 0.005
CASE = f"""
degree = 1
[mesh]
boxes.upper = {{ lower = [0, 0, {DISTANCE}], upper = [2, 1, 1], cells = [3, 2, 2] }}
boxes.middle = {{ lower = [-0.1, 0.1, -0.5], upper = [1.8, 1.3, 0], cells = [2, 2, 1] }}
boxes.lower = {{ lower = [-0.2, 0, -1], upper = [2, 1.4, -0.5], cells = [4, 3, 1] }}
[material]
E = 1.0
nu = 0.3
[boundary."upper.front"]
displacement = [0.01, 0.004, -0.03]
[boundary."lower.back"]
contact = {{ friction = "coulomb", coefficient = 0.6 }}
[[contact]]
slave = "upper.back"
master = "middle.front"
friction = "coulomb"
coefficient = 0.2
[[contact]]
slave = "lower.front"
master = "middle.back"
friction = "tied"
[adapt]
max_levels = 1
"""
# slave: z of its plane, normal, region, then z and region of the opposite side; "upper", "middle", "lower" are 0, 1, 2
SIDES = {"upper.back": (DISTANCE, -1, 0, 0.0, 1), "lower.front": (-0.5, 1, 2, -0.5, 1), "lower.back": (-1.0, -1, 2, None, None)}


def trace(grid, region, z):
    """u on a side of a region in a plane of constant z, as a function of the points of that plane."""
    corners = np.argwhere((grid.arrays["region"] == region)[:, None] & (np.abs(grid.points[:, :, 2] - z) < 1e-12))
    cells = [c for c in np.unique(corners[:, 0]) if np.sum(corners[:, 0] == c) == 3]
    faces = [corners[corners[:, 0] == c, 1] for c in cells]
    x = np.array([grid.points[c][f] for c, f in zip(cells, faces)])
    u = np.array([grid.arrays["displacement"][c][f] for c, f in zip(cells, faces)])

    def value(point):
        edges = (x[:, 1:, :2] - x[:, :1, :2]).transpose(0, 2, 1)
        s = np.linalg.solve(edges, (point[:2] - x[:, 0, :2])[:, :, None])[:, :, 0]
        weights = np.column_stack([1 - s.sum(axis=1), s])
        best = weights.min(axis=1).argmax()
        assert weights[best].min() > -1e-9, f"{point} is not on the side"
        return weights[best] @ u[best]

    return value


def check_points(grid, name, points):
    """Gap and slip of points (x, gap, slip) on a slave from u on both sides."""
    z, sign, region, opposite, other = SIDES[name]
    normal = np.array([0, 0, sign])
    slave = trace(grid, region, z)
    master = trace(grid, other, opposite) if other is not None else None
    for x, gap, slip in points:
        jump = slave(x) - (master(x) if master else 0)
        distance = (opposite - z) * sign if master else 0
        assert abs(gap - (distance - jump @ normal)) < 1e-9, (name, x, gap, distance, jump)
        assert np.abs(slip - (jump - jump @ normal * normal)).max() < 1e-9, (name, x, slip, jump)


def check_balance(certificate):
    """Moments of T(u_h) on both sides against those of the equilibrated stress, which other code integrates. Also on the two
    bodies held by contact alone, where T(u_h) is in equilibrium."""
    balance = {row["name"]: row for row in certificate["balance"]["rows"] if row["kind"] == "contact"}
    on_body = {"middle": np.zeros(3), "lower": np.zeros(3)}
    size = 0
    for name, entry in certificate["contact"]["boundaries"].items():
        sides = [(name, entry["moment"])] + [(master, entry["moment_on_master"]) for master in entry.get("master", [])]
        size += np.linalg.norm(entry["force"])
        for side, moment in sides:
            of_stress = about_origin(balance[side], certificate["balance"]["about"])
            assert np.abs(of_stress - moment).max() < 1e-6 * np.linalg.norm(entry["force"]), (side, of_stress, moment)
            if (body := side.split(".")[0]) in on_body:
                on_body[body] += moment
    for body, moment in on_body.items():
        assert np.abs(moment).max() < 1e-6 * size, (body, moment)


def main():
    program, directory = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    (directory / "case.toml").write_text(CASE)
    result = run(program, "run", "case.toml", "--quiet", cwd=directory)
    assert result.returncode == 3, result.stdout + result.stderr
    out = directory / "out/case"
    certificate = json.loads((out / "certificate.json").read_text())
    level = read_grid(out / "level_001.vtu")
    contact = read_grid(out / "contact_001.vtu")
    rows = list(csv.DictReader((out / "contact.csv").open()))
    vector = lambda row, what: np.array([float(row[what + axis]) for axis in "xyz"])
    names = [boundary["name"] for boundary in certificate["mesh"]["boundaries"]]
    boundaries = certificate["contact"]["boundaries"]
    assert set(boundaries) == set(SIDES)

    totals = {"normal": 0, "tangential": np.zeros(3)}
    for name, entry in boundaries.items():
        own = [row for row in rows if row["boundary"] == name]
        assert {row["pair"] for row in own} == {{"upper.back": "0", "lower.front": "1", "lower.back": ""}[name]}
        check_points(level, name, [(vector(row, ""), float(row["gap"]), vector(row, "slip_")) for row in own])
        segments = [k for k in range(len(contact.points)) if names[int(contact.arrays["boundary"][k])] == name]
        assert segments == sorted({int(row["facet"]) for row in own}), name
        nodes = [(contact.points[k][i], contact.arrays["gap"][k][i], contact.arrays["slip"][k][i]) for k in segments for i in range(3)]
        check_points(level, name, [(x, float(np.squeeze(gap)), slip) for x, gap, slip in nodes])
        areas = [np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0])) / 2 for p in contact.points[segments]]
        weights = np.array([float(row["weight"]) for row in own])
        tractions = np.array([vector(row, "traction_") for row in own])
        points = np.array([vector(row, "") for row in own])
        z, sign, _, opposite, other = SIDES[name]
        moment = resultant_of_rows(own)[1]
        scale = weights @ np.linalg.norm(tractions, axis=1)
        assert np.abs(moment - entry["moment"]).max() < 1e-7 * scale, (name, moment, entry["moment"])
        totals["normal"] += sign * weights @ tractions[:, 2]
        totals["tangential"] += weights @ np.column_stack([tractions[:, :2], np.zeros(len(own))])
        if other is None:
            assert "moment_on_master" not in entry
            continue
        assert len(segments) == entry["segments"]
        for area in (weights.sum(), sum(areas)):
            assert abs(area - entry["covered"]) < 1e-12
        assert abs(entry["covered_master"] - entry["covered"]) < 1e-12  # parallel
        across = np.column_stack([points[:, :2], np.full(len(points), opposite)])
        on_master = -weights @ cross(across, tractions)
        assert np.abs(on_master - entry["moment_on_master"]).max() < 1e-7 * scale, (name, on_master)
    check_balance(certificate)
    covered = {name: entry["covered"] for name, entry in boundaries.items() if "covered" in entry}
    assert abs(covered["upper.back"] - 1.8 * 0.9) < 1e-12 and abs(covered["lower.front"] - 1.9 * 1.2) < 1e-12, covered

    row = list(csv.DictReader((out / "convergence.csv").open()))[-1]
    assert abs(float(row["contact_normal"]) - totals["normal"]) < 1e-7 * abs(totals["normal"])
    tangential = np.linalg.norm(totals["tangential"])
    assert abs(float(row["contact_tangential"]) - tangential) < 1e-6 * abs(totals["normal"]), (row, tangential)
    bodies = certificate["bodies"]
    assert sorted(body["name"] for body in bodies) == ["lower", "middle", "upper"]
    assert abs(sum(body["energy"] for body in bodies) - certificate["energy"]) < 1e-12 * certificate["energy"]
    eta = np.ravel(level.arrays["eta_tot"])
    for body in bodies:
        number = [region["name"] for region in certificate["mesh"]["regions"]].index(body["name"])
        of_body = np.ravel(level.arrays["region"]) == number
        assert body["cells"] == of_body.sum()
        assert abs(body["bound"] - np.sqrt(np.sum(eta[of_body] ** 2))) < 1e-6 * certificate["bound"], body
    print("gaps, slips, resultants, moments and bodies are those of the other files")


main()
