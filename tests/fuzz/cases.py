"""Trials of valid cases: the program runs, and its results are judged."""

import re

from judge import judge
from program import misbehaviour, run
from random_cases import random_case
from results import Unreadable, read_json

# A random case may have no solution or contradict itself; the program then gives one of these messages.
REFUSALS = {
    "not held": r"nothing stops the body|contact cannot hold the body",
    "contradiction": r"prescribes",
    "outside": r"outside the mesh|cuts no cell|no part where within",
}
# Failures without a claimed bound are counted by reason, not reported.
FAILURES = {
    "newton": r"was the last of newton|no step length|singular",
    "identity": r"identity of the equilibrated stress",
    "gmres": r"GMRES",
    "too flat": r"too flat|no equilibrated stress",
}


def trial(number, directory, program):
    file = random_case(number, directory)
    result = run(program, ["run", file.name], directory)
    findings = misbehaviour(result)
    if findings:
        return "misbehaved", findings, {}
    if result.code == 1:
        for word, pattern in REFUSALS.items():
            if re.search(pattern, result.err):
                return f"refused ({word})", [], {}
        return "refused", [f"REFUSED: {result.err.strip()}"], {}
    verdict = judge(file, directory / "out", result.code)
    numbers = {"effectivities": verdict.effectivities, "n_bounds": verdict.n_bounds}
    return outcome(directory / "out", result.code), verdict.findings, numbers


def outcome(directory, code):
    """One word for the summary."""
    if code != 2:
        return {0: "certified", 3: "limit reached"}[code]
    try:
        reason = read_json(directory / "certificate.json").get("reason") or ""
    except (Unreadable, OSError):
        return "failed"
    for word, pattern in FAILURES.items():
        if re.search(pattern, reason):
            return f"failed ({word})"
    return "failed (other)"
