#!/usr/bin/env python3
"""A run leaves its case, with every --set, beside its results: named by its hash, and read again to the same numbers.

    effective_case.py PROGRAM DIRECTORY
"""

import csv
import hashlib
import json
import shutil
import sys
from pathlib import Path

from runner import run

HERE = Path(__file__).resolve().parent


def tribound(program, *arguments, cwd):
    result = run(program, *arguments, cwd=cwd)
    assert result.returncode == 0, f"{arguments}: exit code {result.returncode}\n{result.stdout}{result.stderr}"


def without_times(file):
    return [{key: value for key, value in row.items() if not key.startswith("t_")} for row in csv.DictReader(file.open())]


def main():
    program, directory = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    shutil.rmtree(directory, ignore_errors=True)
    shutil.copytree(HERE, directory / "input", ignore=lambda folder, names: [n for n in names if not n.startswith("polygon")])
    overrides = ["adapt.tolerance=0.1", "degree=2", 'boundary.contact.contact.gap="max(0, 1.0*y)"']
    settings = [word for assignment in overrides for word in ("--set", assignment)]
    tribound(program, "run", "input/polygon.toml", *settings, cwd=directory)

    first = directory / "out/polygon"
    case = first / "case.toml"
    certificate = json.loads((first / "certificate.json").read_text())
    expected = {"file": "case.toml", "sha256": hashlib.sha256(case.read_bytes()).hexdigest(), "overrides": overrides}
    assert certificate["case"] == expected, certificate["case"]

    (directory / "elsewhere").mkdir()
    tribound(program, "run", case.resolve(), "--set", "output.directory=again", cwd=directory / "elsewhere")
    again = directory / "elsewhere/again"
    assert without_times(again / "convergence.csv") == without_times(first / "convergence.csv")
    assert (again / "contact.csv").read_bytes() == (first / "contact.csv").read_bytes()
    repeated = json.loads((again / "certificate.json").read_text())
    for key in ("bound", "relative", "balance", "contact", "mesh"):
        assert repeated[key] == certificate[key], key

    # In its own place it is the same file again.
    text = case.read_text()
    tribound(program, "run", "out/polygon/case.toml", cwd=directory)
    assert case.read_text() == text and not (first / "case_effective.toml").exists()
    print("the effective case gives the same numbers")


if __name__ == "__main__":
    main()
