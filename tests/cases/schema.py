#!/usr/bin/env python3
"""Checks cases against the JSON Schema that `tribound schema` prints, with the validator ajv.

    schema.py PROGRAM SOURCES PACKAGE

Every case of the examples, the tests, the templates and the guide is valid, and so are random ones. The rows of
BAD_INPUTS.toml that say `schema = true` are invalid, and no others. PACKAGE is a folder with ajv; without it the test is
skipped (exit code 77).
"""

import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import bad_inputs
import runner

RANDOM_CASES = 200
LEAST_BAD = 30


def in_files(sources):
    """The cases in the source tree, by name."""
    for file in sorted(sources.glob("*/**/*.toml")):
        if "build" in file.parts or "out" in file.parts:
            continue
        case = tomllib.loads(file.read_text())
        if "mesh" in case and "row" not in case:
            yield str(file.relative_to(sources)), case


def in_guide(sources):
    """The blocks of docs/case-format.md, completed by a mesh and a material where these are missing."""
    blocks = (sources / "docs/case-format.md").read_text().split("```toml\n")[1:]
    for number, block in enumerate(blocks, 1):
        case = {"mesh": {"file": "a.msh"}, "material": {"E": 1, "nu": 0}} | tomllib.loads(block.split("```")[0])
        yield f"block {number} of case-format.md", case


def at_random(sources):
    """Cases of the fuzzer; none without NumPy."""
    sys.path.insert(0, str(sources / "tests/fuzz"))
    try:
        from random_cases import random_case
    except ImportError:
        return
    with tempfile.TemporaryDirectory() as directory:
        for seed in range(RANDOM_CASES):
            yield f"random case {seed}", tomllib.loads(random_case(seed, Path(directory)).read_text())


def bad(sources):
    """The rows whose case file itself is wrong, and whether the schema says so."""
    table = tomllib.loads((sources / "tests/cases/bad_inputs.toml").read_text())
    for row in table["row"]:
        if row.get("arguments") or row.get("set") or row.get("exit", 1) != 1:
            continue
        with tempfile.TemporaryDirectory() as directory:
            bad_inputs.write_inputs(row, table, Path(directory))
            try:
                yield row["name"], tomllib.loads((Path(directory) / "case.toml").read_text()), row.get("schema", False)
            except (tomllib.TOMLDecodeError, UnicodeDecodeError):
                pass  # not TOML


def verdicts(schema, cases, package):
    """What is wrong with each case, or null."""
    text = json.dumps({"schema": schema, "documents": cases}, default=str).replace("Infinity", '"inf"').replace("NaN", '"nan"')
    script = Path(__file__).with_name("schema.mjs")
    result = subprocess.run(["node", script, package], input=text, capture_output=True, text=True, timeout=120)
    if result.returncode:
        print(result.stdout, result.stderr, sep="\n")
        sys.exit(result.returncode)
    return json.loads(result.stdout)


def main():
    program, sources, package = (Path(argument).resolve() for argument in sys.argv[1:])
    schema = json.loads(runner.run(program, "schema").stdout)
    expected = [(name, case, False) for source in (in_files, in_guide, at_random) for name, case in source(sources)]
    expected += bad(sources)
    found = verdicts(schema, [case for _, case, _ in expected], package)
    problems = []
    for (name, _, is_bad), fault in zip(expected, found):
        if is_bad and not fault:
            problems.append(f"{name}: is valid under the schema")
        if fault and not is_bad:
            problems.append(f"{name}: is not valid under the schema: {fault}")
    n_bad = sum(is_bad for _, _, is_bad in expected)
    if n_bad < LEAST_BAD:
        problems.append(f"only {n_bad} bad cases")
    summary = f"{len(expected) - n_bad} cases are valid under the schema, {n_bad} bad ones are not"
    return runner.told("schema", problems, summary, "not as expected")


if __name__ == "__main__":
    sys.exit(main())
