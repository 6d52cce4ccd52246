"""Trials of damaged inputs: the program says what is wrong or computes something that can be judged; no crash, no hang."""

import json
import re

from damage import damage_case, damage_mesh, write_as_format_4
from judge import judge
from program import misbehaviour, run
from random_cases import Dice, random_case

TIME_LIMIT = 20  # seconds
MOST_DOFS = 3000  # larger cases are not run


def trial(number, directory, program):
    dice = Dice([number, 1])
    case = random_case(number, directory)
    mesh = next((file for file in directory.iterdir() if file.suffix in (".msh", ".geo")), None)
    if mesh and mesh.suffix == ".msh" and dice.chance(0.6):
        write_as_format_4(mesh, binary=dice.chance(0.6))
    if mesh and dice.chance(0.6):
        damage_mesh(dice, mesh)
    else:
        damage_case(dice, case)
    checked = run(program, ["check", "--json", case.name], directory, TIME_LIMIT)
    findings = misbehaviour(checked, TIME_LIMIT)
    if findings:
        return "misbehaved", findings, {}
    if checked.code == 1:
        return "refused", [], {}
    if checked.code != 0:
        return "misbehaved", [f"CODE: check ends with exit code {checked.code}"], {}
    try:
        dofs = json.loads(checked.out)["dofs"]
    except (ValueError, KeyError) as error:
        return "misbehaved", [f"INCONSISTENT: check --json: {error!r}"], {}
    if dofs > MOST_DOFS or dice.chance(0.4):
        return "accepted", [], {}
    return run_accepted(case, directory, program)


def run_accepted(case, directory, program):
    """A case that check accepts is run on its first mesh."""
    options = ["--set", "adapt.max_levels=0", "--set", "output.report=false", "--set", 'output.directory="out"']
    result = run(program, ["run", case.name, *options], directory, TIME_LIMIT)
    findings = misbehaviour(result, TIME_LIMIT)
    if findings:
        return "misbehaved", findings, {}
    if result.code == 1:
        return "refused by run", [], {}
    try:
        verdict = judge(case, directory / "out", result.code)
    except Exception:  # the judge reads the formats of the random cases only
        return "run, not judged", [], {}
    # The judge may read a damaged case differently; a violated bound is left to people to inspect.
    serious = [text for text in verdict.findings if re.search("^VIOLATION|exit code|unreadable", text)]
    return "run and judged", serious, {"effectivities": verdict.effectivities, "n_bounds": verdict.n_bounds}
