"""Trials of kills: a run over the results of another run is killed at a random moment; whatever it leaves must be true."""

import os
import re
import shutil
import signal
import subprocess
import time

from judge import judge
from program import CRASHED, DUMP, misbehaviour, run, start, tail
from random_cases import Dice, random_case
from results import Unreadable, read_json

GRACE = 200  # seconds of wall time on a busy machine, from the signal to the end: the current Newton step is finished
EXIT_OF_STATUS = {"certified": 0, "budget": 3, "failed": 2, "not certified": 2}
ORDERLY = [0, 2, 3]


def trial(number, directory, program):
    """Two undisturbed runs show what each leaves; then the second runs over the results of the first and is killed."""
    dice = Dice([number, 2])
    old, new = longer_cases(dice, number, directory)
    runs = []
    for case in (old, new):
        result = run(program, ["run", case.name], directory)
        findings = misbehaviour(result)
        if findings or result.code == 1:
            return "no case to kill", findings, {}
        runs.append(result)
        (directory / "out").rename(directory / f"whole_{case.stem}")
    shutil.copytree(directory / "whole_old", directory / "out")

    number = dice.one_of([signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
    delay = dice.power(-4, -0.5) if (writing := dice.chance(0.6)) else dice.between(0, 1.1 * runs[1].seconds)
    code, err = killed(program, new, directory, number, delay, writing)
    findings = what_is_left(directory, new)
    if number != signal.SIGKILL:
        findings += orderly_end(directory, number, code, err)
    findings += next_run(directory, program, new, runs[1].code)
    return f"{number.name}, exit code {code}", findings, {}


def longer_cases(dice, number, directory):
    """A case of some levels, and the same with another stiffness, so that their results cannot be confused."""
    for seed in range(1000 * number, 1000 * number + 1000):
        text = random_case(seed, directory / "made").read_text()
        if re.search(r"box = { lower = \[[^,]*,[^,]*\]", text) and "contact" in text:
            break
    text = re.sub(r"max_levels = \d+", f"max_levels = {dice.integer(3, 8)}", text)
    text = re.sub(r"tolerance = [\d.e+-]+\nmax_levels", "tolerance = 1e-4\nmax_levels", text)
    shutil.rmtree(directory / "made")
    (directory / "old.toml").write_text(text)
    stiffer = re.sub(r"E = ([\d.e+-]+)", lambda m: f"E = {2 * float(m[1]):.6g}", text)
    (directory / "new.toml").write_text(stiffer)
    return directory / "old.toml", directory / "new.toml"


def killed(program, case, directory, number, delay, writing):
    """Exit code and stderr; the delay starts with the program or with the first file it writes."""
    with start(program, ["run", case.name], directory) as process:
        before = names(directory / "out")
        while writing and process.poll() is None and names(directory / "out") == before:
            time.sleep(1e-4)
        time.sleep(delay)
        process.send_signal(number)
        try:
            _, err = process.communicate(timeout=GRACE)
            code = process.returncode
        except subprocess.TimeoutExpired:
            process.kill()
            _, err = process.communicate()
            code = None
        return code, err.decode(errors="replace")


def names(directory):
    return {(entry.name, entry.inode()) for entry in os.scandir(directory)}


def what_is_left(directory, new):
    """Findings unless the old results are untouched, or there are exactly the new ones that the certificate claims, or there
    is no certificate."""
    out = directory / "out"
    try:
        certificate = read_json(out / "certificate.json") if (out / "certificate.json").exists() else None
    except Unreadable as error:
        return [f"INCONSISTENT: after the signal: {error}"]
    if certificate is None or "status" not in certificate:
        return []
    if contents(out) == contents(directory / "whole_old"):
        return []
    verdict = judge(new, out, EXIT_OF_STATUS[certificate["status"]], killed=True)
    return [f"after the signal: {text}" for text in verdict.findings]


def contents(directory):
    return {f.name: f.read_bytes() for f in directory.iterdir() if f.suffix in (".json", ".csv", ".vtu", ".pvd")}


def orderly_end(directory, number, code, err):
    if code is None:
        return [f"HANG: {number.name} ignored for {GRACE} s"]
    if CRASHED in err:
        return [f"CRASH: after {number.name}: {tail(err)}"]
    if match := DUMP.search(err):
        return [f"DUMP: after {number.name} stderr holds {match.group()!r}: {tail(err)}"]
    before_set_up = code == -number or (code == 2 and "nothing is written" in err)
    if before_set_up and contents(directory / "out") == contents(directory / "whole_old"):
        return []
    if code not in ORDERLY:
        return [f"CRASH: {number.name} leads to exit code {code}: {tail(err)}"]
    try:
        status = read_json(directory / "out" / "certificate.json")["status"]
    except (Unreadable, OSError, KeyError) as error:
        return [f"INCONSISTENT: exit code {code} after {number.name}, certificate: {error!r}"]
    if EXIT_OF_STATUS[status] != code:
        return [f"INCONSISTENT: exit code {code} after {number.name} with status {status!r}"]
    return []


def next_run(directory, program, case, expected):
    """Nothing that was left hinders the next run or stays in its results."""
    result = run(program, ["run", case.name], directory)
    findings = misbehaviour(result)
    if not findings and result.code != expected:
        findings = [f"INCONSISTENT: the next run ends with exit code {result.code}, not {expected}: {tail(result.err)}"]
    if not findings:
        findings = judge(case, directory / "out", result.code).findings
    return [f"next run: {text}" for text in findings]
