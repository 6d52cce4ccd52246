#!/usr/bin/env python3
"""The cases that `tribound init` writes pass `check` without a warning, and `run` certifies them. Nothing is overwritten.

    init.py PROGRAM SCRATCH_DIRECTORY
"""

import json
import shutil
import sys
from pathlib import Path

from runner import run

CASES = {"block": ["block.toml"], "hertz": ["hertz.geo", "hertz.toml"], "dam": ["dam.geo", "dam.toml"]}


def tribound(program, directory, *arguments):
    return run(program, *arguments, cwd=directory)


def names(directory):
    return sorted(path.name for path in directory.iterdir())


def differences(program, directory, name, files):
    """Yields what is wrong with one case."""
    directory.mkdir(parents=True)
    result = tribound(program, directory, "init", name)
    if result.returncode or names(directory) != files:
        yield f"exit code {result.returncode}, has written {names(directory)}\n{result.stderr}"
        return
    case = f"{name}.toml"

    result = tribound(program, directory, "check", case, "--json")
    if result.returncode:
        yield f"check: exit code {result.returncode}\n{result.stderr}"
        return
    found = json.loads(result.stdout)
    if found["warnings"]:
        yield f"check warns: {[f['text'] for f in found['findings'] if f['severity'] == 'warning']}"

    result = tribound(program, directory, "run", case)
    certificate = json.loads((directory / "out" / name / "certificate.json").read_text())
    if result.returncode or certificate["status"] != "certified":
        yield f"run: exit code {result.returncode}\n{result.stdout}{result.stderr}"
    if name == "dam":
        yield from no_safety(certificate)
        yield from to_failure(program, directory)

    (directory / case).write_text("mine")
    result = tribound(program, directory, "init", name)
    if result.returncode != 1 or (directory / case).read_text() != "mine" or case not in result.stderr:
        yield f"init again: exit code {result.returncode}\n{result.stderr}"


def to_failure(program, directory):
    """The dam beyond the level that it bears. With water in the crack: until the whole joint is broken. Without: until all of
    it opens or slides, then on friction alone."""
    text = (directory / "dam.toml").read_text()
    slides = ["history.then={ displacement = 'base.x', step = 2e-4, until = 6e-3 }"]
    for crack, peak, more in (("true", 63.6, []), ("false", 66.5, slides)):
        (directory / "fails.toml").write_text(text.replace("crack = true", f"crack = {crack}"))
        given = ["history.control='auto'", "history.steps=[0, 25, 50, 60, 80]", "adapt.max_levels=0", "output.directory='out/fails'", "output.vtu=false", "output.report=false", *more]
        result = tribound(program, directory, "run", "fails.toml", *(part for key in given for part in ("--set", key)))
        certificate = json.loads((directory / "out/fails/certificate.json").read_text())
        path, base = certificate["path"], certificate["steps"][-1]["interfaces"]["base"]
        if result.returncode != 3 or certificate["status"] != "budget":
            yield f"to failure: exit code {result.returncode}\n{result.stdout}{result.stderr}"
        elif abs(path["peak"]["t"] - peak) > 1 or base["damage"] < 0.98 * 45:
            yield f"to failure: peak {path['peak']}, expected {peak}; {base['damage']} of 45 m are broken"
        elif not more and path["notes"]:
            yield f"to failure: {path['notes']}"
        elif more and ("with 100 % of the bonds open or slipping" not in path["notes"][0] or abs(base["sliding_safety"] - 1) > 0.01):
            yield f"to failure: {path['notes']}, sliding safety {base['sliding_safety']}"


def no_safety(certificate):
    """The dam: the margin against sliding shrinks as the water rises. By statics: weight, uplift with drain, and water on the
    upstream face."""
    weight, gamma = 9.81e-3 * 2.4 * 50 * 25, 9.81e-3
    for step in certificate["steps"]:
        level, base = step["t"], step["interfaces"]["base"]
        if level == 0:
            continue
        thrust = gamma * (level**2 - max(0, level - 50) ** 2) / 2
        drain = 0.4 * gamma * level * (45 - 5) / 45  # pressure behind the drain at x = 5
        uplift = (gamma * level + drain) / 2 * 5 + drain / 2 * (45 - 5)
        effective = weight - uplift
        for key, expected in (("effective_normal", -effective), ("sliding_safety", 0.75 * effective / thrust)):
            if abs(base[key] - expected) > 1e-8 * abs(expected):
                yield f"t = {level}: {key} is {base[key]}, by statics {expected}"


def refusals(program, directory):
    """What init does not do."""
    result = tribound(program, directory, "init", "hrtz")
    if result.returncode != 1 or 'did you mean "hertz"' not in result.stderr:
        yield f"init hrtz: exit code {result.returncode}\n{result.stderr}"
    result = tribound(program, directory, "init", "--directory", "new/folder")
    if result.returncode or names(directory / "new" / "folder") != ["block.toml"]:
        yield f"init --directory: exit code {result.returncode}\n{result.stderr}"
    (directory / "elsewhere").mkdir()
    (directory / "elsewhere" / "dam.geo").write_text("mine")
    result = tribound(program, directory, "init", "dam", "--directory", "elsewhere")
    if result.returncode != 1 or names(directory / "elsewhere") != ["dam.geo"]:
        yield f"init beside dam.geo: exit code {result.returncode}, {names(directory / 'elsewhere')}"


def main():
    program, scratch = sys.argv[1:]
    scratch = Path(scratch)
    shutil.rmtree(scratch, ignore_errors=True)
    failed = 0
    for name, files in CASES.items():
        problems = list(differences(program, scratch / name, name, files))
        print(f"{name}: {'as expected' if not problems else 'DIFFERS'}", *problems, sep="\n  ")
        failed += len(problems)
    problems = list(refusals(program, scratch))
    print(f"refusals: {'as expected' if not problems else 'DIFFERS'}", *problems, sep="\n  ")
    return 1 if failed + len(problems) else 0


if __name__ == "__main__":
    sys.exit(main())
