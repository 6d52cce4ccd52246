#!/usr/bin/env python3
"""Runs the program as a user would and compares what it writes with what is expected.

    run_case.py PROGRAM EXPECTED.json OUTPUT_DIRECTORY

EXPECTED.json holds a list of runs:

    { "case": "t2d.toml",            beside EXPECTED.json
      "runs": [
        { "name": "p1_4x2",
          "set": ["degree=1"],       overrides, passed on with --set
          "command": "run",          or "check", "info", ...; or "arguments": [...] instead of a case
          "exit": 0,
          "options": ["--quiet"],    appended as they stand
          "certificate": { "energy": [0.0137, 1e-8] },     value and relative tolerance; dotted names
          "verification": { ... },   the same for verify.json
          "contact_csv": { "slip_x": [[1.25e-3, 2.72e-5, 0.05], ...] },   x, value there, relative tolerance
          "output": ["text"],        must appear in what the program prints
          "after": "p1_4x2",         in the directory of that run, as it left it
          "absent": ["level_009.vtu"],    files that must not be there
          "files": false } ] }       false: nothing may be written

A value that is not a number must be equal. A tolerance for numbers around zero: [value, relative, absolute].
"""

import csv
import json
import shutil
import sys
from pathlib import Path

import runner


def lookup(document, dotted_name):
    """The entry of nested objects and lists: "levels.0.cells"."""
    for part in dotted_name.split("."):
        document = document[int(part)] if isinstance(document, list) else document[part]
    return document


def difference(found, value, relative, absolute=0.0):
    """What separates two values, or None when they agree."""
    if isinstance(value, (int, float)) and isinstance(found, (int, float)):
        if abs(found - value) <= relative * abs(value) + absolute:
            return None
        scale = abs(value) or 1.0
        return f"is {found!r}, expected {value!r} within {relative:g} (deviation {abs(found - value) / scale:.2e})"
    return None if found == value else f"is {found!r}, expected {value!r}"


def json_differences(file, expected):
    document = json.loads(file.read_text())
    for name, entry in expected.items():
        value, *tolerances = entry if isinstance(entry, list) else [entry, 0.0]
        problem = difference(lookup(document, name), value, *tolerances)
        if problem:
            yield f"{file.name}: {name} {problem}"


def interpolate(rows, column, x):
    """The piecewise linear interpolant of a column of contact.csv at x."""
    points = sorted((float(row["x"]), float(row[column])) for row in rows)
    if x <= points[0][0]:
        (x0, y0), (x1, y1) = points[:2]
    else:
        after = next((i for i, point in enumerate(points) if point[0] >= x), len(points) - 1)
        (x0, y0), (x1, y1) = points[after - 1 : after + 1]
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


def contact_differences(file, expected):
    with file.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    for column, entries in expected.items():
        for x, value, relative in entries:
            problem = difference(interpolate(rows, column, x), value, relative)
            if problem:
                yield f"{file.name}: {column} at x = {x:g} {problem}"


def run(program, expected, run_data, directory):
    """Runs the program once; yields what differs."""
    if "after" not in run_data:
        shutil.rmtree(directory, ignore_errors=True)
    arguments = run_data.get("arguments")
    if arguments is None:
        case = expected["folder"] / run_data.get("case", expected.get("case", ""))
        arguments = [run_data.get("command", "run"), str(case), "--set", f'output.directory="{directory}"']
    for override in run_data.get("set", []):
        arguments = [*arguments, "--set", override]
    arguments = [*arguments, *run_data.get("options", [])]
    result = runner.run(program, *arguments, cwd=expected["folder"])
    printed = result.stdout + result.stderr

    code = run_data.get("exit", 0)
    if result.returncode != code:
        yield f"exit code {result.returncode}, expected {code}\n{printed}"
        return
    for text in run_data.get("output", []):
        if runner.words(text) not in runner.words(printed):  # lines are wrapped
            yield f"does not print {text!r} but\n{printed}"
    if not run_data.get("files", True) and directory.exists():
        yield f"has written {[file.name for file in directory.iterdir()]}"
    for name in run_data.get("absent", []):
        if (directory / name).exists():
            yield f"leaves {name}"
    if "certificate" in run_data:
        yield from json_differences(directory / "certificate.json", run_data["certificate"])
    if "verification" in run_data:
        yield from json_differences(directory / "verify.json", run_data["verification"])
    if "contact_csv" in run_data:
        yield from contact_differences(directory / "contact.csv", run_data["contact_csv"])


def main():
    program, expected_file, output = sys.argv[1:]
    expected_file = Path(expected_file).resolve()
    expected = json.loads(expected_file.read_text())
    expected["folder"] = expected_file.parent
    failed = 0
    for number, run_data in enumerate(expected["runs"]):
        name = run_data.get("name", str(number))
        directory = Path(output).resolve() / run_data.get("after", name)
        failed += runner.told(name, run(program, expected, run_data, directory), "as expected", "DIFFERS")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
