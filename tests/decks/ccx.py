"""Runs CalculiX and reads what it writes."""

import re
import shutil
import subprocess
import time
from dataclasses import dataclass, field

import numpy as np

PROGRAM = shutil.which("ccx")
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:E[-+]?\d+)?"


@dataclass
class Solution:
    """At the ends of the steps. Forces of sets are those of their supports on the body, of pairs those on the slave."""

    seconds: float
    forces: dict = field(default_factory=dict)  # name in capitals -> [force of each step]
    points: np.ndarray = None  # nodes x 3; of plane elements both sides of the sheet
    displacements: list = field(default_factory=list)  # of each step, nodes x 3
    stresses: list = field(default_factory=list)  # of each step, nodes x 6: xx yy zz xy yz xz


def stiffened(text, factor):
    """The deck with contact that is stiffer by the factor, in both directions."""

    def law(match):
        kind, first, rest = match[2].upper(), float(match[3] or 50 * young(text)), match[4] or ""
        if kind == "EXPONENTIAL":
            return f"{match[1]}{kind}\n{first / factor:g}{rest}"
        return f"{match[1]}LINEAR\n{first * factor:g}{rest}"

    text = re.sub(rf"(?i)(\*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=)(\w+)(?:\n\s*({NUMBER})(.*))?", law, text)
    return re.sub(rf"(?i)(\*FRICTION\n.*, *)({NUMBER})", lambda match: f"{match[1]}{float(match[2]) * factor:g}", text)


def young(text):
    return float(re.search(r"(?i)\*ELASTIC\n([^,]*),", text)[1])


def solve(deck, folder, factor):
    """Solves a deck beside whose copy its included files lie already."""
    job = f"stiff_{factor:g}"
    (folder / f"{job}.inp").write_text(stiffened(deck.read_text(), factor))
    began = time.monotonic()
    run = subprocess.run([PROGRAM, job], cwd=folder, capture_output=True, text=True, timeout=600)
    solution = Solution(time.monotonic() - began)
    if "Job finished" not in run.stdout:
        raise RuntimeError(f"ccx did not finish {deck.name} with contact {factor:g} times as stiff\n{run.stdout[-600:]}")
    read_forces((folder / f"{job}.dat").read_text(), solution)
    read_fields((folder / f"{job}.frd").read_text(), solution)
    return solution


def read_forces(text, solution):
    """Totals of *NODE PRINT and *CONTACT PRINT: three numbers behind a heading."""
    title = rf"(?:total force \(fx,fy,fz\) for set (\S+) and time|statistics for slave set (\S+), master set \S+ and time) +{NUMBER}"
    for match in re.finditer(rf"{title}\s+(?:total surface force[^\n]*\n\s*)?({NUMBER}) +({NUMBER}) +({NUMBER})", text):
        name = (match[1] or match[2]).rstrip(",")
        solution.forces.setdefault(name, []).append(np.array([float(match[i]) for i in (3, 4, 5)]))


def read_fields(text, solution):
    """Coordinates, and the blocks DISP and STRESS; numbers have 12 columns, and no blanks between them."""
    lines = iter(text.splitlines())
    number_of = {}

    def at_nodes(components):
        numbers, values = block(lines, components)
        field = np.zeros((len(solution.points), components))
        field[[number_of[node] for node in numbers]] = values
        return field

    for line in lines:
        if line.startswith("    2C"):
            numbers, values = block(lines, 3)
            number_of = {node: i for i, node in enumerate(numbers)}
            solution.points = values
        elif line.startswith(" -4  DISP"):
            solution.displacements.append(at_nodes(3))
        elif line.startswith(" -4  STRESS"):
            solution.stresses.append(at_nodes(6))


def block(lines, components):
    numbers, values = [], []
    for line in lines:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            numbers.append(int(line[3:13]))
            values.append([float(line[13 + 12 * i : 25 + 12 * i]) for i in range(components)])
    return numbers, np.array(values)
