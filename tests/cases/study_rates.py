#!/usr/bin/env python3
"""Numerical results of the method on problem T2D: rates of error and bound, the effect of the stopping criterion of Newton's
method, and the values of an independent overkill computation.

    study_rates.py PROGRAM OUTPUT_DIRECTORY
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
COMMON = [
    "newton.stopping=adaptive", "newton.gamma_lin=0.1", "newton.tolerance=1e-10", "certify.contact_rule=resolved",
    "adapt.theta=0.6", "adapt.max_levels=60", "study.figures=false", "study.dual_norm_dofs=0", "output.report=false", "output.vtu=false",
]
# degree: tolerance, deviation of the adaptive rates from -degree/2
STUDIES = {1: (0.02, 0.04), 2: (0.002, 0.06), 3: (0.00003, 0.12)}
# Adaptive P2 and P3 results of another program, with the uncertainty of the last digits.
OVERKILL = {
    "energy": (0.0168043384, 1e-10),
    "contact_normal": (-0.1035195, 4e-7),
    "contact_tangential": (-0.0398077, 1e-7),
    "max_displacement": (0.118643, 3e-6),
}


def study(program, degree, tolerance, directory):
    command = [program, "study", HERE / "t2d.toml", "--quiet"]
    for override in [*COMMON, f"degree={degree}", f"adapt.tolerance={tolerance}", f'output.directory="{directory}"']:
        command += ["--set", override]
    result = subprocess.run(command, capture_output=True, text=True, timeout=900)
    assert result.returncode == 0, f"exit code {result.returncode}\n{result.stdout}{result.stderr}"
    return json.loads((directory / "study.json").read_text())


def check(degree, deviation, found):
    variants = found["variants"]
    for name in ("adaptive", "adaptive_converged"):
        for what in ("error", "bound"):
            rate = variants[name]["rates"][what]
            print(f"p = {degree}, {name}, {what}: {rate:.3f}")
            assert abs(rate + degree / 2) <= deviation, f"p = {degree}, {name}: rate of the {what} is {rate}"
    for what in ("error", "bound"):  # the singular ends of the clamped side
        rate = variants["uniform"]["rates"][what]
        print(f"p = {degree}, uniform, {what}: {rate:.3f}")
        assert abs(rate + 0.39) <= 0.04, f"p = {degree}, uniform: rate of the {what} is {rate}"
    change = max(abs(x) for x in found["difference"]["adaptive"] if x is not None)
    steps = [row["adaptive"] for row in found["newton_table"] if row["adaptive"] is not None]
    print(f"p = {degree}: the criterion changes the error by {100 * change:.2g} %, Newton steps {steps}")
    assert change < 0.05, f"p = {degree}: the criterion changes the error by {change}"
    # The first mesh starts from scratch, with contact closed and sticking.
    assert len(steps) > 10 and max(steps[1:]) <= 6, f"p = {degree}: Newton steps {steps}"


def check_overkill(reference):
    for name, (value, uncertainty) in OVERKILL.items():
        print(f"{name}: {reference[name]:.10g}, overkill {value} +- {uncertainty}")
        assert abs(reference[name] - value) <= max(3 * uncertainty, 5e-6 * abs(value)), name


def main():
    program, output = sys.argv[1], Path(sys.argv[2]).resolve()
    shutil.rmtree(output, ignore_errors=True)
    for degree, (tolerance, deviation) in STUDIES.items():
        found = study(program, degree, tolerance, output / f"p{degree}")
        check(degree, deviation, found)
    check_overkill(found["reference"])


if __name__ == "__main__":
    main()
