#!/usr/bin/env python3
"""Makes pictures of small results and inspects them: 2D and 3D, several boundaries, load steps, no contact.

    picture_test.py PROGRAM SCRIPT DIRECTORY
"""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

from study_figures_test import CASE_2D, CASE_3D

PAIRS = """
degree = 1
[mesh]
boxes.lower = { lower = [-0.5, -0.5, -0.5], upper = [2.5, 1.5, 0], cells = [3, 2, 1] }
boxes.upper = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 1, 1] }
boxes.top = { lower = [0, 0, 1], upper = [2, 1, 2], cells = [2, 1, 1] }
[material]
E = 1
nu = 0.3
[boundary."lower.back"]
displacement = [0, 0, 0]
[boundary."top.front"]
displacement = [0, 0, -0.02]
[[contact]]
slave = "upper.back"
master = "lower.front"
friction = "tied"
[[contact]]
slave = "top.back"
master = "upper.front"
friction = "coulomb"
coefficient = 0.5
"""

HISTORY = """[history]
steps = [0.5, 1]
watch = { end = "right.x" }
"""

CASES = {
    "plane": CASE_2D,
    "solid": CASE_3D,
    "pairs": PAIRS,
    "degree": CASE_3D.replace("degree = 1", "degree = 3"),
    "path": CASE_2D.replace("traction = [0.06, 0.05]", 'traction = ["0.06*t", 0.05]') + HISTORY,
    "unloaded": CASE_2D.replace("-0.1", "0").replace("[0.06, 0.05]", "[0, 0]"),
    "free": CASE_2D.replace('contact = { friction = "coulomb", coefficient = 0.5 }', "traction = [0, 0]"),
}


def look_at(file):
    """Something is drawn in many colours over most of the picture, and nothing touches its edges."""
    image = np.array(Image.open(file).convert("RGB")).astype(int)
    rows, columns, _ = image.shape
    assert columns >= 800 and 300 <= rows <= 600, f"{file} has {columns} x {rows} pixels"
    inked = np.any(image < 250, axis=2)
    assert len(np.unique(image.reshape(-1, 3), axis=0)) > 60, f"{file}: few colours"
    for side, line in (("left", inked[:, 0]), ("right", inked[:, -1]), ("top", inked[0]), ("bottom", inked[-1])):
        assert not line.any(), f"{file}: something is cut off at the {side}"
    thirds = [part.mean() for part in np.array_split(inked, 3, axis=1)]
    assert min(thirds) > 0.01 and max(thirds) > 0.2, f"{file}: nothing drawn in a third of it, {thirds}"


def main():
    program, script, output = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    for name, text in CASES.items():
        case, results, picture = output / f"{name}.toml", output / name, output / f"{name}.png"
        case.write_text(text)
        settings = [f'output.directory="{results}"', "adapt.max_levels=0"]
        arguments = [word for setting in settings for word in ("--set", setting)]
        code = subprocess.run([program, "run", case, "--quiet", *arguments]).returncode
        assert code in (0, 3), f"{name}: exit code {code}"
        subprocess.run([script, results, picture, "--mesh"], check=True)
        look_at(picture)
    print(f"{len(CASES)} pictures")
    empty = subprocess.run([script, output / "nothing", output / "nothing.png"], capture_output=True, text=True)
    assert empty.returncode == 1 and "certificate.json" in empty.stderr, empty.stderr


if __name__ == "__main__":
    main()
