#!/usr/bin/env python3
"""A run leaves its effective case, with every --set, beside its results. The file is named by its hash and gives the same
numbers when it is run.

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


def hashed(*files):
    """As in `case.files` of a certificate."""
    return [{"file": file.name, "sha256": hashlib.sha256(file.read_bytes()).hexdigest()} for file in files]


def without_times(file):
    return [{key: value for key, value in row.items() if not key.startswith("t_")} for row in csv.DictReader(file.open())]


def numbers(directory):
    """What a repeated run must reproduce."""
    certificate = json.loads((directory / "certificate.json").read_text())
    return (without_times(directory / "convergence.csv"), (directory / "contact.csv").read_bytes(),
            {key: certificate[key] for key in ("bound", "relative", "balance", "contact", "mesh", "assumptions")})


def obstacle_from_a_file(program, directory):
    """The effective case finds it from anywhere; when the file is missing, the message names it."""
    (directory / "down").mkdir()
    result = run(program, "run", "-q", "../input/on_triangles.toml", "--set", "output.directory=results", cwd=directory / "down")
    assert result.returncode == 3, result.stderr  # max_levels
    first = directory / "down/results"
    assert 'surface = "../../input/ridge.stl"' in (first / "case.toml").read_text()
    files = json.loads((first / "certificate.json").read_text())["case"]["files"]
    assert files == hashed(directory / "input/ridge.stl"), files
    result = run(program, "run", "-q", first.resolve() / "case.toml", "--set", "output.directory=again_triangles", cwd=directory)
    assert result.returncode == 3, result.stderr
    assert numbers(directory / "again_triangles") == numbers(first)
    (directory / "input/ridge.stl").rename(directory / "input/elsewhere.stl")
    result = run(program, "run", "-q", first.resolve() / "case.toml", cwd=directory)
    assert result.returncode == 1 and "obstacle.ridge.surface" in result.stderr and "cannot be read" in result.stderr, result.stderr


def main():
    program, directory = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    shutil.rmtree(directory, ignore_errors=True)
    (directory / "input").mkdir(parents=True)
    for name in ("polygon.toml", "polygon.geo", "on_triangles.toml", "ridge.stl"):
        shutil.copy(HERE / name, directory / "input")
    overrides = ["adapt.tolerance=0.1", "degree=2", 'boundary.contact.contact.gap="max(0, 1.0*y)"']
    settings = [word for assignment in overrides for word in ("--set", assignment)]
    tribound(program, "run", "input/polygon.toml", *settings, cwd=directory)

    first = directory / "out/polygon"
    case = first / "case.toml"
    certificate = json.loads((first / "certificate.json").read_text())
    expected = {**hashed(case)[0], "files": hashed(directory / "input/polygon.geo"), "overrides": overrides}
    assert certificate["case"] == expected, certificate["case"]

    (directory / "elsewhere").mkdir()
    tribound(program, "run", case.resolve(), "--set", "output.directory=again", cwd=directory / "elsewhere")
    again = directory / "elsewhere/again"
    assert numbers(again) == numbers(first)

    # Run in place, it writes the same file again.
    text = case.read_text()
    tribound(program, "run", "out/polygon/case.toml", cwd=directory)
    assert case.read_text() == text and not (first / "case_effective.toml").exists()
    obstacle_from_a_file(program, directory)
    print("the effective case gives the same numbers")


if __name__ == "__main__":
    main()
