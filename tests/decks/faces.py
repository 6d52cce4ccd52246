#!/usr/bin/python3
"""Faces of every element type: a pressure on each of them gives the same force in CalculiX and in Tribound.

    faces.py PROGRAM FOLDER       exit code 77 where ccx is not installed
"""

import json
import subprocess
import sys
from pathlib import Path

import ccx
from bodies import CORNERS, EDGES, FACES, SHAPES, continued

CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
CORNERS_OF = {"tri": [0, 1, 2], "quad": [0, 1, 2, 3], "tet": [0, 1, 3, 4], "wedge": [0, 1, 3, 4, 5, 7], "brick": range(8)}
TYPES = ["C3D4", "C3D10", "C3D6", "C3D15", "C3D8", "C3D8R", "C3D8I", "C3D20", "C3D20R", "CPE3", "CPE4", "CPE6", "CPE8", "CPS3", "CPS4", "CPS6", "CPS8R"]
PRESSURE = 6.0


def element(kind):
    """Its nodes in a distorted unit cube."""
    dim = 2 if kind.startswith("CP") else 3
    digits = kind[3:].rstrip("RI")
    shape = SHAPES[dim - 2][digits]
    skew = lambda x, y, z: (x + 0.2 * y + 0.1 * z, 1.5 * y + (0.3 * z if dim == 3 else 0), 2.0 * z if dim == 3 else 0.0)
    points = [skew(*CUBE[i]) for i in CORNERS_OF[shape]]
    if int(digits) > CORNERS[shape]:
        points += [tuple((a + b) / 2 for a, b in zip(points[i], points[j])) for i, j in EDGES[shape]]
    return dim, shape, points


def deck(kind, points, faces):
    return ["*NODE, NSET=ALL", *(f"{i + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(points)),
            f"*ELEMENT, TYPE={kind}, ELSET=CELL", *continued([1, *range(1, len(points) + 1)]),
            *(line for f in range(len(faces)) for line in (f"*SURFACE, NAME=F{f + 1}", f"1, S{f + 1}")),
            "*MATERIAL, NAME=M", "*ELASTIC", "1000., 0.3", "*SOLID SECTION, ELSET=CELL, MATERIAL=M"]


def normal(points, face, dim):
    """Outwards, of any length; and a point of the face."""
    a, b, c = (points[face[i]] for i in (0, 1, -1))
    u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
    if dim == 2:
        return [u[1], -u[0], 0.0], a
    return [-(u[1] * v[2] - u[2] * v[1]), -(u[2] * v[0] - u[0] * v[2]), -(u[0] * v[1] - u[1] * v[0])], a


def force_of_ccx(kind, points, faces, f, dim, folder):
    """Its nodes move along one axis alone: there the forces at them are the load. Returns the axis and their sum."""
    n, a = normal(points, faces[f], dim)
    axis = max(range(dim), key=lambda i: abs(n[i]))
    on_face = [i for i, x in enumerate(points) if abs(sum((p - q) * m for p, q, m in zip(x, a, n))) < 1e-9]
    fixed = [f"{i + 1}, {c + 1}" for i in range(len(points)) for c in range(dim) if i not in on_face or c != axis]
    text = [*deck(kind, points, faces), "*NSET, NSET=FACE", *(str(i + 1) for i in on_face), "*BOUNDARY", *fixed, "*STEP", "*STATIC", "*DSLOAD",
            f"F{f + 1}, P, {PRESSURE}", "*NODE PRINT, NSET=FACE", "RF", "*END STEP"]
    (folder / "face.inp").write_text("\n".join(text) + "\n")
    (folder / "face.dat").unlink(missing_ok=True)
    subprocess.run([ccx.PROGRAM, "face"], cwd=folder, capture_output=True, timeout=60)
    rows = [line.split() for line in (folder / "face.dat").read_text().splitlines()]
    return axis, sum(float(row[1 + axis]) for row in rows if len(row) == 4 and row[0].isdigit())


def forces_of_tribound(program, kind, points, faces, folder):
    """By face: of all but one that is held, then of this one."""
    (folder / "element.inp").write_text("\n".join(deck(kind, points, faces)) + "\n")
    forces = {}
    for held in (1, 2):
        case = ['degree = 1', '[mesh]', 'file = "element.inp"', '[material]', 'E = 1000', 'nu = 0.3']
        zeros = [0] * (2 if kind.startswith("CP") else 3)
        for f in range(1, len(faces) + 1):
            case += [f'[boundary.F{f}]', f"displacement = {zeros}" if f == held else f"pressure = {PRESSURE}"]
        (folder / "element.toml").write_text("\n".join(case) + "\n")
        run = subprocess.run([program, "run", folder / "element.toml", "--set", f'output.directory="{folder / "run"}"', "--set", "adapt.max_levels=0"],
                             capture_output=True, text=True, timeout=120)
        if run.returncode not in (0, 3):
            raise SystemExit(f"{kind}: {run.stdout}{run.stderr}")
        rows = json.loads((folder / "run/certificate.json").read_text())["balance"]["rows"]
        forces |= {int(row["name"][1:]) - 1: row["force"] for row in rows if row["kind"] == "load"}
    return forces


def main(program, folder):
    if ccx.PROGRAM is None:
        print("ccx is not installed: scripts/ccx installs it")
        return 77
    folder = Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    wrong = 0
    for kind in TYPES:
        dim, shape, points = element(kind)
        faces = FACES[shape]
        ours = forces_of_tribound(program, kind, points, faces, folder)
        for f in range(len(faces)):
            axis, expected = force_of_ccx(kind, points, faces, f, dim, folder)
            if abs(ours[f][axis] - expected) > 1e-5 * PRESSURE:  # ccx writes seven digits
                wrong += 1
                print(f"{kind}, S{f + 1}: force {ours[f]}, of ccx {expected:g} along axis {axis}")
    print(f"faces of {len(TYPES)} element types: {wrong or 'none'} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
