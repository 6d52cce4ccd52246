#!/usr/bin/python3
"""Prints the gaps of case.toml after grouting: what the weight of the monoliths makes of the joints, fitted by polynomials of x and z.

    tribound run case.toml --set mesh.file=full.geo --set 'history.steps=[0]' --set output.directory=out/weight
    grout.py out/weight/contact.csv
"""

import csv
import sys

import numpy as np

BEFORE = 5e-3  # m: the gap of case.toml before grouting
POWERS = ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2))  # of x and z in m, for mm


def fitted(rows, joint):
    """The formula for a joint and its mirror image, and the largest distance from it in mm."""
    names = {f"joint_{joint}", f"joint_{8 - joint}"}
    x, z, gap = np.array([[float(row[key]) for key in ("x", "z", "gap")] for row in rows if row["boundary"] in names]).T
    columns = np.stack([x**a * z**b for a, b in POWERS], axis=1)
    filled = 1e3 * (BEFORE - gap)
    factors = np.linalg.lstsq(columns, filled, rcond=None)[0]
    terms = [f"{factor:.3g}" + a * "*x" + b * "*z" for factor, (a, b) in zip(factors, POWERS, strict=True)]
    return f"1e-3*({' + '.join(terms)})".replace("+ -", "- "), np.abs(columns @ factors - filled).max()


def main():
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    for joint in range(1, 5):
        formula, distance = fitted(rows, joint)
        print(f'joints {joint} and {8 - joint}: gap = "t == 0 ? {BEFORE:g} : {formula}", at most {distance:.2f} mm off')


if __name__ == "__main__":
    main()
