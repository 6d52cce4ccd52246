"""Judges a run from its files and the case alone, without any code of the program. Every finding is a sentence.

VIOLATION: the residual of the displacement in the file exceeds the bound claimed for it.
INCONSISTENT: files, exit code or numbers contradict each other, the case, or the documentation.
"""

from pathlib import Path

import numpy as np

from case_data import read_case
from judge_contact import judge_contact
from judge_moments import judge_moments
from judge_solution import judge_cells, judge_displacement, judge_mesh, judge_probes, judge_residual
from level import Inconsistent, Level
from residual import Residual
from results import Unreadable, read_results
from verdict import Verdict, near

STATUS_OF_EXIT = {0: ["certified"], 2: ["failed", "not certified"], 3: ["budget"]}
COMPONENTS = ["osc", "str", "neu", "lin1", "cnt", "frc", "lin2n", "lin2t", "quad", "alg"]


def judge(case_file, directory, exit_code, killed=False):
    """The Verdict on the results in the directory. After a kill the fields of the last level may be missing."""
    verdict = Verdict()
    if not Path(directory).is_dir():
        verdict.check(False, f"exit code {exit_code} without results")
        return verdict
    try:
        results = read_results(directory)
        judge_files(verdict, read_case(case_file), results, exit_code, killed)
    except Unreadable as error:
        verdict.findings.append(f"INCONSISTENT: unreadable: {error}")
    except Inconsistent as error:
        verdict.findings.append(f"INCONSISTENT: {error}")
    except (KeyError, TypeError, IndexError, np.linalg.LinAlgError) as error:
        verdict.findings.append(f"INCONSISTENT: something expected is missing or malformed: {error!r}")
    return verdict


def judge_files(verdict, case, results, exit_code, killed):
    if killed:
        keep_what_is_claimed(verdict, results)
    else:
        left = [f.name for f in results.directory.iterdir() if f.name.endswith(".part")]
        verdict.check(not left, f"left over: {left}")
    certificate = results.certificate
    if certificate is None:
        verdict.check(False, f"exit code {exit_code} without certificate.json")
        return
    status = certificate["status"]
    verdict.check(status in STATUS_OF_EXIT.get(exit_code, []), f"exit code {exit_code} with status {status!r}")
    verdict.check((certificate["reason"] is None) == (status == "certified"), f"reason {certificate['reason']!r}")
    verdict.check(
        (certificate["d"], certificate["p"]) == (case.dimension, case.degree), "dimension or degree is not the case's"
    )
    verdict.check(near(certificate["gamma0"], case.gamma0), "gamma0 is not the case's")
    verdict.check(near(certificate["tolerance"], case.get("adapt.tolerance", 0.01)), "tolerance is not the case's")
    judge_arithmetic(verdict, certificate)
    judge_tables(verdict, results)
    if status in ("certified", "budget"):
        judge_levels(verdict, case, results, killed)
    else:
        verdict.check(certificate.get("bound") is None, f"a bound with status {status!r}")


def keep_what_is_claimed(verdict, results):
    """Keeps the rows of levels in the certificate, which is written after the tables. The fields are written after it; there
    must be none of other levels."""
    n = len(results.certificate["levels"])
    results.convergence = [row for row in results.convergence or [] if row["level"] < n]
    results.newton = [row for row in results.newton or [] if row["level"] < n]
    for name in results.levels:
        verdict.check(int(name[len("level_") : -len(".vtu")]) < n, f"{name}, and {n} levels in the certificate")
    bounded = [level["level"] for level in results.certificate["levels"] if level["bound"] is not None]
    of_contact = {row["level"] for row in results.contact or []}
    verdict.check(of_contact <= set(bounded[-1:]), f"contact.csv of level {of_contact}, and levels {bounded} with a bound")


def judge_arithmetic(verdict, certificate):
    """The verdict and what follows from the numbers themselves."""
    status, bound, sigma = certificate["status"], certificate.get("bound"), certificate.get("sigma_norm")
    if status not in ("certified", "budget"):
        return
    verdict.check(bound is not None and np.isfinite(bound) and bound >= 0, f"bound {bound!r} with status {status!r}")
    verdict.check(sigma is not None and np.isfinite(sigma), f"sigma_norm {sigma!r}")
    certified = bound <= certificate["tolerance"] * sigma * (1 + 1e-14)
    rounding = bound == 0 or near(bound, certificate["tolerance"] * sigma, 1e-12)
    consistent = certified == (status == "certified") or rounding or sigma == 0
    verdict.check(consistent, f"bound {bound}, sigma_norm {sigma}: {status!r}")
    if certificate["relative"] is not None and sigma > 0:
        verdict.check(near(certificate["relative"], bound / sigma), "relative is not bound / sigma_norm")
    if certificate["identities"] is None:
        judge_zero_stress(verdict, certificate)
        return
    has_symmetry = certificate["stress"] == "afw" and certificate["p"] > 1 and certificate["model"] is None
    defects = [x for name, x in certificate["identities"].items() if name != "symmetry" or has_symmetry]
    limit = certificate["constants"]["identity_limit"]
    verdict.check(all(x is not None and 0 <= x <= limit for x in defects), f"identities {certificate['identities']}")
    verdict.check(bound <= certificate["bound_plain"] * (1 + 1e-12), "bound above bound_plain")
    for name, x in certificate["components"].items():
        verdict.check(x is not None and x >= 0, f"component {name} is {x}")
    verdict.check(certificate["energy"] >= 0, f"energy {certificate['energy']}")


def judge_zero_stress(verdict, certificate):
    """Where everything is rounding, the certificate says so; the residual tells whether that is true."""
    verdict.check("stress" in certificate["assumptions"], "no identities, and nothing is said of a stress of zero")
    verdict.check(certificate["sigma_norm"] == 0 and certificate["relative"] is None, "no identities, but a stress")


def judge_tables(verdict, results):
    """convergence.csv and newton.csv against certificate.json and each other."""
    certificate, levels = results.certificate, results.certificate["levels"]
    convergence, newton = results.convergence, results.newton
    if convergence is None or newton is None:
        verdict.check(False, "a table is missing")
        return
    verdict.check(len(convergence) == len(levels), f"{len(convergence)} rows in convergence.csv, {len(levels)} levels")
    for row, level in zip(convergence, levels):
        for name in ("level", "cells", "dofs", "relative", "energy"):
            verdict.check(near(row[name], level[name]), f"level {level['level']}: {name} {row[name]} and {level[name]}")
        for name, here in (("total_sharp", "bound"), ("total", "bound_plain")):
            verdict.check(near(row[name], level[here]), f"level {level['level']}: {name} {row[name]} and {level[here]}")
        steps = [step for step in newton if step["level"] == row["level"]]
        known = row["newton_steps"] + level["finishing_steps"]
        verdict.check(known == len(steps), f"level {level['level']}: {len(steps)} rows in newton.csv, {known} steps")
        verdict.check(level["finishing_steps"] == 0 or level is levels[-1] or level["relative"] > certificate["tolerance"], f"level {level['level']} is finished")
        verdict.check([s["step"] for s in steps] == list(range(1, len(steps) + 1)), "Newton steps are not numbered")
        accepted = [step for step in steps if step["accepted"] == 1]
        if row["total_sharp"] is not None:
            verdict.check(accepted == steps[-1:], f"level {level['level']}: {len(accepted)} accepted steps")
            for name in [*COMPONENTS, "total"]:
                verdict.check(near(row[name], steps[-1][name]), f"level {level['level']}: {name} of the accepted step")
    verdict.check(
        sorted({s["level"] for s in newton}) == sorted({r["level"] for r in convergence} | {s["level"] for s in newton}),
        "a level without Newton steps",
    )
    if certificate["status"] in ("certified", "budget"):
        last = convergence[-1]
        for name, here in (("total_sharp", "bound"), ("relative", "relative"), ("energy", "energy"), ("dofs", "dofs")):
            verdict.check(near(last[name], certificate[here]), f"{here} is not that of the last level")


def judge_levels(verdict, case, results, killed):
    """Every level that has a bound and a displacement."""
    certificate = results.certificate
    names = [region["name"] for region in certificate["mesh"]["regions"]]
    bounds = [level for level in certificate["levels"] if level["bound"] is not None]
    if killed and len(results.levels) == len(bounds) - 1:
        bounds.pop()  # the certificate is written before the fields
    if not results.levels:
        verdict.check(killed or case.get("output.vtu", True) is False, "no level_NNN.vtu")
        return
    verdict.check(len(results.levels) == len(bounds), f"{len(results.levels)} VTU files, {len(bounds)} levels with a bound")
    for number, entry in enumerate(bounds):
        level = Level(results.level(number), case)
        residual = Residual(level, case, names)
        judge_cells(verdict, level, entry, number)
        judge_displacement(verdict, residual, entry, number)
        judge_residual(verdict, case, residual, entry, number)
        judge_probes(verdict, residual, entry)
        if number + 1 == len(bounds):
            if not killed or results.contact is not None:
                judge_contact(verdict, residual, results)
                if not case.is_axisymmetric:  # around the axis they cancel
                    judge_moments(verdict, residual, results)
            judge_mesh(verdict, case, residual)
