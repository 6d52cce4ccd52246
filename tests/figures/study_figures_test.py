#!/usr/bin/env python3
"""Draws the figures of small studies, in 2D and 3D, and inspects the files.

    study_figures_test.py PROGRAM SCRIPT DIRECTORY

The studies are made here: runs of the program, with invented true errors.
"""

import csv
import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

FIGURES = ("convergence", "components", "effectivity", "newton", "meshes", "contact", "maps")
LARGEST_FILE = 300_000  # bytes

CASE_2D = """
degree = 2
units = { length = "mm", force = "N" }
mesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
material = { E = 1, nu = 0.3 }
[boundary.left]
displacement = [0, 0]
[boundary.top]
traction = [0, -0.1]
[boundary.right]
traction = [0.06, 0.05]
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.5 }
"""

CASE_3D = """
degree = 1
mesh.box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 1, 1] }
material = { E = 1, nu = 0.3 }
[boundary.left]
displacement = [0, 0, 0]
[boundary.top]
traction = [0, -0.1, 0]
[boundary.right]
traction = [0.04, 0.06, 0]
[boundary.bottom]
contact = { friction = "tresca", threshold = 0.03 }
"""

# "uniform" marks every cell: maximum marking with a threshold near 0.
SETTINGS = {"adaptive": ["adapt.theta=0.5"], "uniform": ['adapt.marking="maximum"', "adapt.theta=1e-9"]}
CONVERGED = ["newton.stopping=\"tolerance\""]


def run(program, case, directory, settings):
    overrides = [f'output.directory="{directory}"', "adapt.tolerance=1e-6", *settings]
    arguments = [program, "run", case, "--quiet"]
    for override in overrides:
        arguments += ["--set", override]
    code = subprocess.run(arguments, stdout=subprocess.DEVNULL).returncode
    assert code == 3, f"exit code {code}, expected 3: budget used up"


def add_error(file):
    """Cell data `stress_error`: three quarters of the bound's share."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    share = grid.GetCellData().GetArray("eta_tot")
    error = vtkDoubleArray()
    error.SetName("stress_error")
    for cell in range(grid.GetNumberOfCells()):
        error.InsertNextValue(0.75 * share.GetValue(cell))
    grid.GetCellData().AddArray(error)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(grid)
    writer.Write()


def make_study(program, directory, text, dimension):
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    case = directory / "case.toml"
    case.write_text(text)
    rows = []
    for base, settings in SETTINGS.items():
        levels = "adapt.max_levels=4" if base == "adaptive" else "adapt.max_levels=1"
        for variant, further in ((base, []), (f"{base}_converged", CONVERGED)):
            run(program, case, directory / variant, [levels, *settings, *further])
            with (directory / variant / "convergence.csv").open(newline="") as stream:
                for row in csv.DictReader(stream):
                    bound = float(row["total_sharp"])
                    rows.append({"variant": variant, **row, "energy_error": bound / 2, "stress_error": bound / 1.05,
                                 "dual_norm": bound / 1.2 if row["level"] < "3" else "",  # not always affordable
                                 "effectivity": 1.2 if row["level"] < "3" else "", "effectivity_stress": 1.05,
                                 "energy_effectivity": 1.3 if base == "adaptive" else "",  # not without a bound
                                 "rate_error": "", "rate_bound": ""})
        for file in (directory / base).glob("level_*.vtu"):
            add_error(file)
    with (directory / "study.csv").open("w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    units = json.loads((directory / "adaptive/certificate.json").read_text())["units"]
    rates = {"adaptive": {"rates": {"error": -0.5, "bound": -0.5}}, "uniform": {"rates": {"error": None, "bound": None}}}
    (directory / "study.json").write_text(json.dumps({"title": "A <small> study", "d": dimension, "units": units, "variants": rates}))


def interrupt(directory):
    """Keeps what a study has before its reference is known, without fields."""
    with (directory / "study.csv").open(newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["variant"] == "adaptive"]
    for row in rows:
        row.update(dict.fromkeys(("energy_error", "stress_error", "dual_norm", "effectivity", "effectivity_stress",
                                  "energy_effectivity"), ""))
    with (directory / "study.csv").open("w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    (directory / "study.json").write_text(json.dumps({"title": "", "d": 2, "variants": {"adaptive": {"rates": None}}}))
    for file in (directory / "adaptive").glob("*.vtu"):
        file.unlink()


def check_figures(directory, names=FIGURES):
    found = sorted(file.stem for file in (directory / "figures").iterdir())
    assert found == sorted(names), f"{directory}: figures {found}"
    for name in names:
        file = directory / "figures" / f"{name}.svg"
        root = xml.parse(file).getroot()
        assert root.tag == "{http://www.w3.org/2000/svg}svg", f"{file} is no SVG but {root.tag}"
        drawn = sum(1 for element in root.iter() if element.tag.endswith(("}path", "}use", "}image")))
        assert drawn > 30, f"{file}: only {drawn} things drawn"
        assert file.stat().st_size < LARGEST_FILE, f"{file} has {file.stat().st_size} bytes"


def draw(script, directory):
    subprocess.run([script, directory], check=True, stdout=subprocess.DEVNULL)


def main():
    program, script, output = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    for text, dimension in ((CASE_2D, 2), (CASE_3D, 3)):
        directory = output / f"{dimension}d"
        make_study(program, directory, text, dimension)
        draw(script, directory)
        check_figures(directory)
        before = {name: (directory / "figures" / f"{name}.svg").read_bytes() for name in FIGURES[:4]}
        draw(script, directory)
        for name, content in before.items():
            assert (directory / "figures" / f"{name}.svg").read_bytes() == content, f"{name}.svg differs when drawn again"
        # Text drawn as paths is repeated in comments.
        titles = (directory / "figures/contact.svg").read_text()
        assert all(f"<!-- {title} -->" in titles for title in ("stress [MPa]", "length [mm]")) == (dimension == 2)
        print(f"{dimension}D: {len(FIGURES)} figures")
    interrupt(output / "2d")
    draw(script, output / "2d")
    check_figures(output / "2d", ("convergence", "components", "newton", "contact"))
    print("interrupted study: 4 figures")


if __name__ == "__main__":
    main()
