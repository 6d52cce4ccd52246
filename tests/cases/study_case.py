#!/usr/bin/env python3
"""Runs `tribound study` on small cases and checks that its output is complete, consistent and within the guarantee.

    study_case.py PROGRAM OUTPUT_DIRECTORY
"""

import csv
import json
import math
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

TIME_LIMIT = 600  # seconds
HERE = Path(__file__).resolve().parent
VARIANTS = ["adaptive", "adaptive_converged", "uniform", "uniform_converged"]
COLUMNS = (
    "variant,level,cells,dofs,newton_steps,osc,str,neu,lin1,cnt,frc,lin2n,lin2t,quad,alg,total,total_sharp,relative,energy_error,"
    "stress_error,dual_norm,effectivity,effectivity_stress,energy_bound,energy_effectivity,intervals_agree,rate_error,rate_bound,t_solve,t_certify,t_level"
)
ADAPTIVE = ["newton.stopping=adaptive", "newton.tolerance=1e-10", "adapt.theta=0.6", "adapt.max_levels=12", "study.figures=false"]
BETWEEN_BODIES = ["mor", "str_mor"]  # further columns with pairs
# name, case, overrides, exit code
STUDIES = [
    ("t2d_p1", "t2d.toml", [*ADAPTIVE, "degree=1", "adapt.tolerance=0.12"], 0),
    ("t2d_p2", "t2d.toml", [*ADAPTIVE, "degree=2", "adapt.tolerance=0.03"], 0),
    ("block_3d", "study_3d.toml", ["study.figures=false"], 3),
    ("pair_p1", "study_pair.toml", ["study.figures=false", "degree=1"], 3),
    ("pair_p2", "study_pair.toml", ["study.figures=false", "degree=2", "output.report=false"], 3),
    ("coarse_reference", "t2d.toml", [*ADAPTIVE, "adapt.max_levels=1", "study.max_reference_dofs=100", "study.dual_norm_dofs=0"], 3),
]


def numbers(row):
    """A row of study.csv in the form of study.json."""
    return {name: None if text == "" else float(text) for name, text in row.items() if name != "variant"}


def arguments(case, overrides, directory):
    """The command line behind the program."""
    result = ["study", str(HERE / case), "--set", f'output.directory="{directory}"']
    for override in overrides:
        result += ["--set", override]
    return result


def check_tables(directory, study, variants):
    """study.csv against study.json and the tables of the variants."""
    text = (directory / "study.csv").read_text()
    between_bodies = BETWEEN_BODIES if "pair" in directory.name else []
    assert text.splitlines()[0] == ",".join([COLUMNS, *between_bodies]), "columns"
    rows = list(csv.DictReader(text.splitlines()))
    assert list(study["variants"]) == variants, "variants"
    for name in variants:
        levels = study["variants"][name]["levels"]
        assert [numbers(row) for row in rows if row["variant"] == name] == levels, f"{name}: csv and json differ"
        convergence = list(csv.DictReader((directory / name / "convergence.csv").open()))
        assert len(convergence) == len(levels), f"{name}: levels"
        for row, level in zip(convergence, levels):
            for column in ("cells", "dofs", "newton_steps", "str", "total_sharp", "relative", *between_bodies):
                assert float(row[column]) == level[column], f"{name}: {column}"
        for column, row in enumerate(study["newton_table"][: len(levels)]):
            assert row[name] == levels[column]["newton_steps"], "newton_table"
        certificate = json.loads((directory / name / "certificate.json").read_text())
        assert certificate["status"] == study["variants"][name]["status"], f"{name}: status"


def check_levels(study):
    """The guarantee, and how rates and effectivities are computed."""
    for name, variant in study["variants"].items():
        before = None
        for level in variant["levels"]:
            assert level["effectivity"] is None or level["effectivity"] >= 1, f"{name}: effectivity"
            assert level["energy_effectivity"] is None or level["energy_effectivity"] >= 1, f"{name}: energy effectivity"
            assert level["intervals_agree"] != 0, f"{name}: intervals"
            assert level["energy_error"] > 0 and level["stress_error"] > 0, f"{name}: errors"
            assert math.isclose(level["effectivity_stress"], level["total_sharp"] / level["stress_error"]), name
            if before:
                growth = math.log(level["dofs"] / before["dofs"])
                for rate, value in (("rate_error", "energy_error"), ("rate_bound", "total_sharp")):
                    assert math.isclose(level[rate], math.log(level[value] / before[value]) / growth), f"{name}: {rate}"
            before = level
        if name.startswith("uniform"):
            cells = [level["cells"] for level in variant["levels"]]
            assert all(b == a * 2 ** study["d"] for a, b in zip(cells, cells[1:])), f"{name}: {cells}"


def check_files(directory, study):
    """Complete files, the page where pages are written, and the true error of every cell in the files for ParaView."""
    assert (directory / "report.html").exists() == (directory / "adaptive" / "report.html").exists(), "report.html"
    leftovers = [
        file
        for file in directory.rglob("*")
        if file.is_file() and file.suffix not in (".csv", ".json", ".vtu", ".pvd", ".html", ".toml")
    ]
    assert not leftovers, f"left behind: {leftovers}"
    for name in VARIANTS:
        files = sorted((directory / name).glob("level_*.vtu"))
        assert len(files) == (0 if name.endswith("converged") else len(study["variants"][name]["levels"])), f"{name}: {files}"
        for file in files:
            head = file.read_bytes()[:8192]
            assert b'"energy_error"' in head and b'"stress_error"' in head and b'"eta_tot"' in head, file


def check_words(directory, study):
    """A variant's own certificate and page give the same reason as the study."""
    for name in VARIANTS:
        certificate = json.loads((directory / name / "certificate.json").read_text())
        assert certificate["reason"] == study["variants"][name]["reason"], f"{name}: {certificate['reason']}"


def check_pairs(directory, study):
    """Two bodies whose meshes do not match: what is lost between them is bounded as part of the bound; its force is known."""
    for name, variant in study["variants"].items():
        for level in variant["levels"]:
            assert 0 < level["mor"] < level["total_sharp"] and level["str_mor"] <= level["str"] + level["mor"], f"{name}: {level}"
        certificate = json.loads((directory / name / "certificate.json").read_text())
        assert [body["name"] for body in certificate["bodies"]] == ["upper", "lower"], f"{name}: bodies"
        assert certificate["contact"]["boundaries"]["upper.bottom"]["master"] == ["lower.top"], f"{name}: master"
        rows = csv.DictReader((directory / name / "contact.csv").open())
        assert {(row["boundary"], row["pair"]) for row in rows} == {("upper.bottom", "0")}, f"{name}: contact.csv"


def run(program, name, case, overrides, exit_code, directory):
    result = subprocess.run([program, *arguments(case, overrides, directory)], capture_output=True, text=True, timeout=TIME_LIMIT)
    assert result.returncode == exit_code, f"exit code {result.returncode}\n{result.stdout}{result.stderr}"
    study = json.loads((directory / "study.json").read_text())
    check_tables(directory, study, VARIANTS)
    check_levels(study)
    check_files(directory, study)
    check_words(directory, study)
    if "pair" in name:
        check_pairs(directory, study)
    reference = study["reference"]
    assert reference["fine_enough"] == (name != "coarse_reference"), "reference"
    assert reference["fine_enough"] == (reference["relative"] <= reference["required"]), "reference"
    assert ("coarser than asked for" in result.stdout) == (name == "coarse_reference"), result.stdout
    known = [level["effectivity"] for v in study["variants"].values() for level in v["levels"] if level["effectivity"]]
    assert bool(known) == (name != "coarse_reference"), "dual norms"
    for text in ("Newton steps per level", "rates", "criterion", "guarantee"):
        assert text in result.stdout, result.stdout


def interrupt(program, directory):
    """Ctrl-C in the middle of the first variant leaves its tables."""
    overrides = [*ADAPTIVE, "degree=3", "adapt.tolerance=1e-6", "adapt.max_levels=100"]
    with subprocess.Popen([program, *arguments("t2d.toml", overrides, directory)], stdout=subprocess.PIPE, text=True) as process:
        end = time.monotonic() + TIME_LIMIT / 2
        while not (directory / "adaptive" / "contact_001.vtu").exists() and time.monotonic() < end:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        printed, _ = process.communicate(timeout=TIME_LIMIT)
    assert process.returncode == 3, printed
    study = json.loads((directory / "study.json").read_text())
    check_tables(directory, study, ["adaptive"])
    assert study["interrupted"] and study["reference"] is None, study["interrupted"]
    assert "interrupted" in printed, printed


def main():
    program, output = sys.argv[1], Path(sys.argv[2]).resolve()
    shutil.rmtree(output, ignore_errors=True)
    for name, *study in STUDIES:
        begin = time.monotonic()
        run(program, name, *study, output / name)
        print(f"{name}: as expected, {time.monotonic() - begin:.1f} s")
    interrupt(program, output / "interrupt")
    print("interrupt: as expected")


if __name__ == "__main__":
    main()
