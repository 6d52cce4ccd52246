#!/usr/bin/python3
"""Random trials of the program: valid cases judged from their results, damaged inputs, kills, damaged geometries.

    fuzz.py PROGRAM SECONDS [--kind KIND ...] [--seed N] [--count N] [--jobs N] [--keep DIRECTORY]

A trial is determined by its kind and its number. Every finding is kept in DIRECTORY/KIND-NUMBER with its inputs, and
`--kind KIND --seed NUMBER --count 1` repeats it. Exit code 1 when anything was found.
"""

import argparse
import os
import shutil
import sys
import tempfile
import time
import traceback
from collections import Counter
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[name] = "1"  # before numpy

import numpy as np  # noqa: E402

import cases  # noqa: E402
import geometries  # noqa: E402
import inputs  # noqa: E402
import kills  # noqa: E402

TRIALS = {"cases": cases.trial, "inputs": inputs.trial, "kills": kills.trial, "geometries": geometries.trial}
SHARES = {"cases": 6, "inputs": 12, "kills": 1, "geometries": 2}  # trials of each kind in turn


@dataclass
class Trial:
    """What a trial reports; outcome is one word for the summary."""

    kind: str
    number: int
    outcome: str
    findings: list
    effectivities: list = field(default_factory=list)
    n_bounds: int = 0
    seconds: float = 0.0


def attempt(kind, number, program, keep):
    """One trial in a directory of its own, kept when something is found."""
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="tribound-fuzz-") as directory:
        directory = Path(directory) / "trial"
        directory.mkdir()
        try:
            outcome, findings, numbers = TRIALS[kind](number, directory, program)
        except Exception:  # an error in the fuzzer is also a finding
            outcome, findings, numbers = "fuzzer failed", [f"FUZZER: {traceback.format_exc()}"], {}
        if findings:
            place = Path(keep) / f"{kind}-{number}"
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(directory, place, symlinks=True)
            again = f"scripts/fuzz --kind {kind} --seed {number} --count 1"
            (place / "finding.txt").write_text("\n".join([*findings, f"again: {again}", ""]))
    return Trial(kind, number, outcome, findings, seconds=time.monotonic() - began, **numbers)


def plan(kinds, seed, count):
    """Kind and number of each trial, in order."""
    turn = [kind for kind in kinds for _ in range(SHARES[kind])]
    numbers = dict.fromkeys(kinds, seed)
    made = 0
    while count is None or made < count:
        kind = turn[made % len(turn)]
        yield kind, numbers[kind]
        numbers[kind] += 1
        made += 1


def trials(options, program):
    """Runs the plan until the time or the count is used up; yields Trials."""
    deadline = time.monotonic() + options.seconds if options.seconds else float("inf")
    todo = plan(options.kind or list(TRIALS), options.seed, options.count)
    with ProcessPoolExecutor(options.jobs) as workers:
        running = set()
        while True:
            while len(running) < options.jobs and time.monotonic() < deadline and (next_one := next(todo, None)):
                running.add(workers.submit(attempt, *next_one, program, options.keep))
            if not running:
                return
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                yield future.result()


def summary(results):
    lines = []
    for kind in TRIALS:
        own = [trial for trial in results if trial.kind == kind]
        if not own:
            continue
        outcomes = ", ".join(f"{n} {word}" for word, n in Counter(trial.outcome for trial in own).most_common())
        seconds = np.median([trial.seconds for trial in own])
        lines.append(f"{kind}: {len(own)} trials, median {seconds:.2f} s: {outcomes}")
        effectivities = [e for trial in own for e in trial.effectivities]
        if effectivities:
            lines.append(
                f"  {sum(trial.n_bounds for trial in own)} bounds judged, effectivity at least {min(effectivities):.3f}, "
                f"median {np.median(effectivities):.2f}"
            )
    found = Counter(text.split(":")[0] for trial in results for text in trial.findings)
    lines.append("findings: " + (", ".join(f"{n} {word}" for word, n in found.most_common()) or "none"))
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description="Random trials of the program.")
    parser.add_argument("program", type=Path)
    parser.add_argument("seconds", type=float, nargs="?", help="how long new trials are begun; without: --count of them")
    parser.add_argument("--kind", action="append", choices=list(TRIALS), help="can be repeated; default: all")
    parser.add_argument("--seed", type=int, default=0, help="number of the first trial of each kind")
    parser.add_argument("--count", type=int, help="how many trials")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path("build/fuzz"), help="where findings are kept")
    options = parser.parse_args()
    if options.seconds is None and options.count is None:
        parser.error("give SECONDS or --count")
    results = []
    for trial in trials(options, options.program.resolve()):
        results.append(trial)
        for text in trial.findings:
            print(f"{trial.kind} {trial.number}: {text}", flush=True)
    print(summary(results))
    return 1 if any(trial.findings for trial in results) else 0


if __name__ == "__main__":
    sys.exit(main())
