#!/usr/bin/python3
"""The judge finds deliberate errors, and nothing in correct results.

    self_test.py PROGRAM DIRECTORY
"""

import json
import re
import shutil
import sys
import zlib
from pathlib import Path

import numpy as np

import program
from judge import judge
from results import ARRAY, TYPES, inflate

CASE = """degree = 2
[mesh]
box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
[material]
E = 3.0
nu = 0.3
[load]
body = [0, "-0.02*sin(3*x)"]
[boundary.left]
displacement = [0, "free"]
[boundary.top]
traction = [0.01, "x < 0.7 ? -0.1 : 0"]
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.3, gap = "0.01*x^2" }
[adapt]
tolerance = 0.1
max_levels = 2
[output]
levels = "all"
report = false
"""


def rewrite_grid(file, name, change):
    """The VTU file with one array changed."""
    data = file.read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    end = data.index(b"</AppendedData>")
    head, body, offset = data[:start], b"", 0
    for kind, array, _, at in ARRAY.findall(data[:start]):
        raw = inflate(data, start + int(at))
        if array.decode() == name:
            values = np.frombuffer(raw, TYPES[kind.decode()])
            raw = change(values).astype(values.dtype).tobytes()
        packed = zlib.compress(raw)
        body += np.array([1, len(raw), 0, len(packed)], "<u8").tobytes() + packed
        pattern = rb'(Name="%s"[^>]*offset=")%s(" *)' % (array, at)
        head = re.sub(pattern, rb"\g<1>%d\g<2>" % offset, head, count=1)
        offset = len(body)
    file.write_bytes(head + body + b"\n" + data[end:])


def edit_certificate(directory, change):
    file = directory / "certificate.json"
    certificate = json.loads(file.read_text())
    change(certificate)
    file.write_text(json.dumps(certificate))


def scale_bounds(directory, factor):
    """Scales all bounds and components consistently: only the residual can tell."""

    def scale(entry):
        for key in ("bound", "bound_plain", "relative"):
            entry[key] *= factor
        entry["components"] = {key: factor * x for key, x in entry["components"].items()}

    edit_certificate(directory, lambda c: [scale(entry) for entry in (c, *c["levels"])])
    for name in ("convergence.csv", "newton.csv"):
        rows = [row.split(",") for row in (directory / name).read_text().splitlines()]
        columns = [k for k, key in enumerate(rows[0]) if re.fullmatch(r"osc|str|neu|lin\w+|cnt|frc|quad|total\w*|relative", key)]
        for row in rows[1:]:
            for k in columns:
                row[k] = row[k] and repr(factor * float(row[k]))  # not every iterate has a complete bound
        (directory / name).write_text("".join(",".join(row) + "\n" for row in rows))
    for file in directory.glob("level_*.vtu"):
        for key in ("tot", "osc", "str", "neu", "lin1", "cnt", "frc", "lin2n", "lin2t"):
            rewrite_grid(file, f"eta_{key}", lambda values: factor * values)


def perturb(directory, change):
    for file in directory.glob("level_*.vtu"):
        rewrite_grid(file, "displacement", change)


def set_status(status):
    return lambda directory: edit_certificate(directory, lambda c: c.update(status=status))


def set_bound(factor):
    return lambda directory: edit_certificate(directory, lambda c: c.update(bound=factor * c["bound"]))


def first_row(directory, name, column, value):
    rows = [row.split(",") for row in (directory / name).read_text().splitlines()]
    rows[1][rows[0].index(column)] = value
    (directory / name).write_text("".join(",".join(row) + "\n" for row in rows))


def turn_contact(factor):
    """Scales all moments of contact alike: sums cannot tell."""

    def turn(certificate):
        contact = certificate["contact"]
        for entry in (contact, *contact["boundaries"].values()):
            entry["moment"] = [factor * x for x in entry["moment"]]

    return lambda directory: edit_certificate(directory, turn)


def turn_balance(kind, factor):
    """Scales the moments of the rows of one kind in the balance."""

    def turn(certificate):
        for row in certificate["balance"]["rows"]:
            if row["kind"] == kind:
                row["moment"] = [factor * x for x in row["moment"]]

    return lambda directory: edit_certificate(directory, turn)


def cut_short(name):
    return lambda directory: (directory / name).write_bytes((directory / name).read_bytes()[:-40])


# Change to correct results -> text of a finding.
DECEITS = {
    "bounds of a third": (lambda d: scale_bounds(d, 0.3), "VIOLATION"),
    "bound of the certificate alone": (set_bound(0.3), "bound_plain|relative|level|bound"),
    "displacement not continuous": (lambda d: perturb(d, lambda u: u * np.linspace(1, 1.001, len(u))), "not continuous"),
    "displacement scaled": (lambda d: perturb(d, lambda u: 1.001 * u), "max_displacement|sigma_norm"),
    "displacement shifted": (lambda d: perturb(d, lambda u: u + 1e-4), "VIOLATION|prescribed"),
    "wrong status": (set_status("certified"), "status 'certified'"),
    "failure with a bound": (set_status("failed"), "status 'failed'"),
    "energy of a table": (lambda d: first_row(d, "convergence.csv", "energy", "1.5"), "energy 1.5"),
    "Newton step of a table": (lambda d: first_row(d, "newton.csv", "accepted", "1"), "accepted"),
    "pressure of a table": (lambda d: first_row(d, "contact.csv", "pressure", "0.5"), "pressure of bottom"),
    "moments of contact": (turn_contact(1.01), "contact bottom: moment"),
    "moments of contact by the stress": (turn_balance("contact", 1.01), "of the equilibrated stress"),
    "moments of loads": (turn_balance("load", 1.01), "load .*: moment"),
    "moments of reactions": (turn_balance("reaction", 1.01), "balance: moments"),
    "half a certificate": (cut_short("certificate.json"), "unreadable"),
    "half a table": (cut_short("contact.csv"), "unreadable"),
    "half a VTU file": (cut_short("level_000.vtu"), "unreadable"),
    "no fields": (lambda d: [file.unlink() for file in d.glob("level_*.vtu")], "no level_NNN.vtu"),
    "a left file": (lambda d: (d / ".contact.csv.17.part").touch(), "left over"),
}


def crash_is_found(directory):
    """A program that ends the way app/interrupt.cpp ends it."""
    fake = directory / "crashing"
    fake.write_text("#!/bin/sh\necho 'tribound: crashed: an internal error' >&2\nexit 2\n")
    fake.chmod(0o755)
    return program.misbehaviour(program.run(fake, ["run", "case.toml"], directory))[:1]


def main():
    executable, directory = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    case = directory / "case.toml"
    case.write_text(CASE)
    result = program.run(executable, ["run", "case.toml"], directory)
    true = judge(case, directory / "out", result.code)
    failures = [f"true results: {text}" for text in [*program.misbehaviour(result), *true.findings]]
    if true.n_bounds < 2 or not all(1 < e < 10 for e in true.effectivities):
        failures.append(f"{true.n_bounds} bounds judged, effectivities {true.effectivities}")
    if not judge(case, directory / "out", 2).findings:
        failures.append("a wrong exit code is not found")
    if not any(text.startswith("CRASH") for text in crash_is_found(directory)):
        failures.append("a crash is not found")
    for name, (deceive, expected) in DECEITS.items():
        wrong = directory / name.replace(" ", "_")
        shutil.copytree(directory / "out", wrong)
        deceive(wrong)
        findings = judge(case, wrong, result.code).findings
        if not any(re.search(expected, text) for text in findings):
            failures.append(f"{name}: found {findings}")
    print(*failures, f"{len(DECEITS) + 3 - len(failures)} of {len(DECEITS) + 3} as expected", sep="\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
