"""Whole runs by several processes against one process, and their behaviour when something goes wrong.

Usage: program.py MPIRUN PROGRAM FAULT EXAMPLES CASES DIRECTORY
"""

import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

MPIRUN, PROGRAM, FAULT, EXAMPLES, CASES, DIRECTORY = sys.argv[1:7]
ENVIRONMENT = os.environ | {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
TIME_LIMIT = 100  # seconds
COUNTS = ("level", "cells", "dofs", "newton_steps")
failures = []


def command(n, program, *arguments):
    return [MPIRUN, "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-n", str(n), program, *arguments]


def run(n, program, *arguments):
    start = [program, *arguments] if n == 1 else command(n, program, *arguments)
    return subprocess.run(start, capture_output=True, text=True, timeout=TIME_LIMIT, env=ENVIRONMENT)


def expect(what, holds, *shown):
    if not holds:
        failures.append(f"{what}: {shown}")


def out(name, n):
    return pathlib.Path(DIRECTORY) / f"{name}_{n}"


def run_case(name, n, *arguments):
    return run(n, PROGRAM, "run", "-q", *arguments, "--set", f"output.directory='{out(name, n)}'")


def run_on_all(name, numbers, *arguments):
    """The runs by one process and by several, at the same time: those of several leave a core idle while they wait."""
    with ThreadPoolExecutor() as pool:
        codes = dict(zip(numbers, pool.map(lambda n: run_case(name, n, *arguments), numbers)))
    for n, code in codes.items():
        expect(f"{name} {n}", code.returncode in (0, 3), code.returncode, code.stderr)


def table(name, n):
    with open(out(name, n) / "convergence.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def expect_same_tables(name, n):
    one, several = table(name, 1), table(name, n)
    expect(f"{name} {n}", len(one) == len(several), len(one), len(several))
    for expected, found in zip(one, several):
        scale = float(expected["energy"]) ** 0.5 + float(expected["total_sharp"])
        for key, value in expected.items():
            if key.startswith("t_") or value == found[key]:
                continue
            difference = abs(float(value) - float(found[key]))
            expect(f"{name} {n} level {expected['level']} {key}", key not in COUNTS and difference <= 1e-8 * scale,
                   value, found[key])


def largest(part):
    if isinstance(part, (dict, list)):
        return max(map(largest, part.values() if isinstance(part, dict) else part), default=0)
    return abs(part) if isinstance(part, float) else 0


def alike(one, other, zero=None):
    """Whether two parts of certificates agree up to rounding. A zero next to moments of 1e5 is rounding of these."""
    if zero is None:
        zero = max(1e-9, 1e-12 * largest(one))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(alike(value, other[key], zero) for key, value in one.items())
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(alike(a, b, zero) for a, b in zip(one, other))
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) <= 1e-6 * max(abs(one), abs(other)) + zero
    return one == other


def the_same_as_one(name, *arguments):
    run_on_all(name, (1, 3), *arguments)
    n = 3
    expect_same_tables(name, n)
    number = len(table(name, n)) - 1
    pieces = [out(name, n) / f"level_{number:03}" / f"part_{rank:04}.vtu" for rank in range(n)]
    expect(f"{name} {n}", all(piece.is_file() for piece in pieces), pieces)
    for file in (f"level_{number:03}.pvtu", f"contact_{number:03}.vtu", "adapted.msh", "newton.csv"):
        expect(f"{name} {n}", (out(name, n) / file).is_file(), file)
    certificates = [json.loads((out(name, k) / "certificate.json").read_text()) for k in (1, n)]
    for key in ("status", "reason", "warnings", "contact", "bodies", "balance", "probes", "sections", "mesh", "constants"):
        pair = [certificate.get(key) for certificate in certificates]
        # A moment that vanishes is rounding of forces times their arms.
        zero = max(1e-9, 1e-12 * largest(pair[0]) * largest(pair[0]["about"])) if key == "balance" else None
        expect(f"{name} {n} {key}", alike(*pair, zero), *pair)
    lines = [sorted(len(row) for row in csv.reader(open(out(name, k) / "contact.csv"))) for k in (1, n)]
    expect(f"{name} {n}", lines[0] == lines[1], "contact.csv", len(lines[0]), len(lines[1]))


def load_steps(name, n):
    with open(out(name, n) / "history.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def damage(name, n):
    with open(out(name, n) / "contact.csv", encoding="utf-8") as file:
        return sum(float(row["weight"]) * float(row["damage"]) for row in csv.DictReader(file))


def expect_same_steps(name, n, also=()):
    rows, alone = load_steps(name, n), load_steps(name, 1)
    expect(f"{name} {n}", len(rows) == len(alone) > 1, len(rows), len(alone))
    for found, expected in zip(rows, alone):
        scale = max(abs(float(expected["work"])), abs(float(expected["total_sharp"])), float(expected["energy"]))
        for key, value in expected.items():
            # Rounding decides the status of points with no pressure or with friction just at its limit.
            if key.startswith("t_") or key in ("opened", "slipping", "newton_steps", *also) or value == found[key]:
                continue
            expect(f"{name} {n} step {expected['step']} {key}",
                   key not in COUNTS and abs(float(value) - float(found[key])) <= 1e-7 * scale + 1e-9, value, found[key])
    expect(f"{name} {n}", abs(damage(name, n) - damage(name, 1)) <= 1e-8 * damage(name, 1), damage(name, n), damage(name, 1))
    expect(f"{name} {n}", not (out(name, n) / "unfinished_pass").exists(), "unfinished_pass")


def load_steps_the_same_as_one(name, *arguments):
    run_on_all(name, (1, 2), *arguments)
    for n in (1, 2):
        expect_same_steps(name, n)
        number = int(load_steps(name, n)[-1]["step"])
        pieces = [out(name, n) / f"step_{number:03}" / f"part_{rank:04}.vtu" for rank in range(n)] if n > 1 else []
        files = [out(name, n) / file for file in ("step_001.pvtu" if n > 1 else "step_001.vtu", f"contact_{number:03}.vtu", "series.pvd")]
        for file in pieces + files:
            expect(f"{name} {n}", file.is_file(), file)


def load_steps_go_on(name, step, *arguments):
    """Restarts by one to three processes from a load step of a run by two, either finished or killed."""
    case = [*arguments, "--set", "output.checkpoint='all'"]
    run_on_all(name, (1, 2), *case)
    whole = json.loads((out(name, 1) / "certificate.json").read_text())
    for n in (1, 2, 3):
        shutil.copytree(out(name, 2), out(name, n + 10))
        result = run(n, PROGRAM, "run", "-q", "--restart", str(out(name, n + 10) / f"checkpoint_{step:03}.h5"))
        expect(f"{name} on {n}", result.returncode in (0, 3), result.returncode, result.stderr)
        expect_same_steps(name, n + 10)
        expect(f"{name} on {n}", len(table(name, n + 10)) == len(table(name, 1)), len(table(name, n + 10)))
        certificate = json.loads((out(name, n + 10) / "certificate.json").read_text())
        for key in ("status", "reason", "path", "history_check", "contact", "bodies", "balance", "not_covered"):
            expect(f"{name} on {n} {key}", alike(whole.get(key), certificate.get(key)), whole.get(key), certificate.get(key))
        for key in ("levels", "steps"):
            expect(f"{name} on {n}", len(whole[key]) == len(certificate[key]), key)
        before = (out(name, n + 10) / "certificate.json").read_text()
        again = run(n, PROGRAM, "run", "-q", "--restart", str(out(name, n + 10)))  # nothing is left to do
        expect(f"{name} again on {n}", again.returncode == result.returncode, again.returncode, again.stderr)
        expect(f"{name} again on {n}", (out(name, n + 10) / "certificate.json").read_text() == before, "certificate.json")


def killed_load_steps_go_on(name, *arguments):
    """Killed during a pass after the first: the previous pass stays until the new one is complete."""
    case = [*arguments, "--set", "output.checkpoint='all'"]
    run_case(name, 1, *case)
    out(name, 2).mkdir(parents=True, exist_ok=True)
    process = subprocess.Popen(command(2, PROGRAM, "run", "-q", *case, "--set", f"output.directory='{out(name, 2)}'"), env=ENVIRONMENT,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    end = time.monotonic() + TIME_LIMIT
    while not (out(name, 2) / "unfinished_pass" / "checkpoint_002.h5").exists() and time.monotonic() < end and process.poll() is None:
        time.sleep(0.002)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    expect(f"{name} before", (out(name, 2) / "unfinished_pass").exists() and len(json.loads((out(name, 2) / "certificate.json").read_text())["levels"]) > 0)
    for n in (1, 3):
        shutil.copytree(out(name, 2), out(name, n + 10))
        result = run(n, PROGRAM, "run", "-q", "--restart", str(out(name, n + 10)))
        expect(f"{name} on {n}", result.returncode in (0, 3), result.returncode, result.stderr)
        expect_same_steps(name, n + 10)


def bad_input_is_told_once():
    result = run_case("bad", 2, f"{EXAMPLES}/01_tresca_block/case.toml", "--set", "nitsche.gamma0=-1")
    expect("bad input", result.returncode == 1 and result.stderr.count("tribound:") == 1, result.returncode, result.stderr)
    result = run_case("bad", 2, f"{EXAMPLES}/01_tresca_block/case.toml", "--set", "boundary.top.traction=[0, '-sqrt(1.99 - x)']")
    expect("bad formula", result.returncode == 1 and result.stderr.count("tribound:") == 1 and "boundary.top" in result.stderr,
           result.returncode, result.stderr)
    slider = "boundary.right={ slider = 0, normal = ['(x < 1.9 || y < 0.9) ? 1 : 0', 1] }"  # only one process has these facets
    result = run_case("bad", 2, f"{EXAMPLES}/01_tresca_block/case.toml", "--set", slider)
    expect("bad slider", result.returncode == 1 and "acts at 90 degrees" in result.stderr and "MPI_ABORT" not in result.stderr,
           result.returncode, result.stderr)


def commands_for_one_process():
    case = f"{EXAMPLES}/01_tresca_block/case.toml"
    for name in ("verify", "study"):
        result = run(2, PROGRAM, name, case)
        expect(name, result.returncode == 1 and "started as 2" in result.stderr, result.returncode, result.stderr)
    result = run(2, PROGRAM, "info")
    expect("info", result.returncode == 0 and result.stdout.count("PETSc") == 1, result.returncode, result.stdout, result.stderr)
    result = run(2, PROGRAM, "check", case)
    expect("check", result.returncode == 0 and result.stdout.count("Tresca block") <= 1, result.returncode, result.stdout)


def interrupted():
    arguments = ["run", f"{EXAMPLES}/01_tresca_block/case.toml", "--set", "adapt.tolerance=1e-9", "--set",
                 f"output.directory='{out('stopped', 2)}'"]
    process = subprocess.Popen(command(2, PROGRAM, *arguments), env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
    end = time.monotonic() + TIME_LIMIT
    while not (out("stopped", 2) / "certificate.json").exists() and time.monotonic() < end:
        time.sleep(0.05)
    process.send_signal(signal.SIGUSR1)
    _, errors = process.communicate(timeout=TIME_LIMIT)
    certificate = json.loads((out("stopped", 2) / "certificate.json").read_text())
    expect("interrupted", process.returncode == 3 and "interrupted" in certificate["reason"], process.returncode, certificate["reason"],
           errors)


def a_run_goes_on():
    """Written by 3 processes, read by 1, 2 and 4, after a kill in mid-run."""
    case = [f"{EXAMPLES}/05_dam/case.toml", "--set", "output.checkpoint=true", "--set", "adapt.tolerance=0.002"]
    run_case("whole", 1, *case)
    out("killed", 3).mkdir(parents=True, exist_ok=True)
    process = subprocess.Popen(command(3, PROGRAM, "run", "-q", *case, "--set", f"output.directory='{out('killed', 3)}'"),
                               env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    end = time.monotonic() + TIME_LIMIT
    while not (out("killed", 3) / "checkpoint.h5").exists() and time.monotonic() < end and process.poll() is None:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    for n in (1, 2, 4):
        shutil.rmtree(out("whole", n + 10), ignore_errors=True)
        shutil.copytree(out("killed", 3), out("whole", n + 10))
        directory = str(out("whole", n + 10))
        result = run(n, PROGRAM, "run", "-q", "--restart", directory)
        expect(f"restart on {n}", result.returncode == 0, result.returncode, result.stderr)
        expect_same_tables("whole", n + 10)
    checkpoint = out("whole", 12) / "checkpoint.h5"
    result = run(2, PROGRAM, "run", "--restart", str(out("whole", 12)), "--set", "degree=1")
    expect("another degree", result.returncode == 1 and "degree" in result.stderr, result.returncode, result.stderr)
    data = checkpoint.read_bytes()
    checkpoint.write_bytes(data[: len(data) // 2])
    for n in (1, 2):
        result = run(n, PROGRAM, "run", "--restart", str(out("whole", 12)))
        expect("damaged", result.returncode == 1 and "checkpoint.h5" in result.stderr, result.returncode, result.stderr)
    result = run(2, PROGRAM, "run", "--restart", f"{DIRECTORY}/nowhere")
    expect("nothing", result.returncode == 1 and "checkpoint.h5" in result.stderr, result.returncode, result.stderr)
    result = run(1, PROGRAM, "run")
    expect("no case", result.returncode == 1 and "--restart" in result.stderr, result.returncode, result.stderr)


def bodies_go_on():
    """Joints and several boxes: the interfaces come with the mesh. An obstacle is read from its file again, a shape comes
    from the first mesh."""
    for name, case in (("blocks", f"{EXAMPLES}/07_three_blocks/case.toml"), ("joint", f"{CASES}/joint.toml"),
                       ("triangles", f"{CASES}/on_triangles.toml"), ("order2", f"{CASES}/order2.toml"),
                       ("order2_pair", f"{CASES}/order2_pair.toml")):
        run_case(f"{name}_begun", 3, case, "--set", "output.checkpoint=true", "--set", "adapt.max_levels=1", "--set", "adapt.tolerance=1e-9")
        for n in (1, 2):
            shutil.copytree(out(f"{name}_begun", 3), out(f"{name}_on", n))
            result = run(n, PROGRAM, "run", "-q", "--restart", str(out(f"{name}_on", n)), "--set", "adapt.max_levels=3")
            expect(f"{name} on {n}", result.returncode == 3, result.returncode, result.stderr)
        expect_same_tables(f"{name}_on", 2)


def a_box_goes_on():
    for n in (1, 3):
        run_case("box", n, f"{EXAMPLES}/01_tresca_block/case.toml", "--set", "output.checkpoint=true", "--set", "adapt.max_levels=2")
        result = run(n, PROGRAM, "run", "-q", "--restart", str(out("box", n)), "--set", "adapt.max_levels=4")
        expect("box", result.returncode == 3 and len(table("box", n)) == 5, n, result.returncode, result.stderr)
    expect_same_tables("box", 3)


def one_thread_each():
    others = {name: value for name, value in ENVIRONMENT.items() if not name.endswith("_NUM_THREADS")}
    for words, threads in (({}, 1), ({"OMP_NUM_THREADS": "2"}, 2)):
        subprocess.run(command(2, PROGRAM, "run", "-q", f"{EXAMPLES}/01_tresca_block/case.toml", "--set", "adapt.max_levels=0", "--set",
                               f"output.directory='{out('threads', 2)}'"), capture_output=True, timeout=TIME_LIMIT, env=others | words)
        program = json.loads((out("threads", 2) / "certificate.json").read_text())["program"]
        expect("threads", program["threads"] == threads and program["processes"] == 2, words, program)


def faults():
    for name, code, words in (("throw_together", 1, "all: "), ("throw_alone", 2, "process 1: alone"), ("fail_alone", 2, "process 1: out of memory"), ("die", None, "")):
        begin = time.monotonic()
        result = run(3, FAULT, name)
        good = result.returncode == code if code is not None else result.returncode != 0
        expect(name, good and words in result.stdout and time.monotonic() - begin < 30, result.returncode, result.stdout, result.stderr)


shutil.rmtree(DIRECTORY, ignore_errors=True)
# Through corners of cells, so that several ranks have a point, and along facets.
LOOKED_AT = ["--set", "probe.line={ from = [0, 0], to = [2, 1], points = 9 }", "--set", "section.across={ point = [1, 0.5], normal = [1, 0.2] }", "--set",
             "section.along={ point = [0, 0.5], normal = [0, 1] }"]
the_same_as_one("tresca", f"{EXAMPLES}/01_tresca_block/case.toml", *LOOKED_AT)
the_same_as_one("groups", f"{EXAMPLES}/01_tresca_block/case.toml", "--set", "boundary.half={where='x < 1 + 1e-9', of='top', traction=[0, -0.2]}",
                "--set", "material.soft={where='x > 1.4', E=0.5, nu=0.3}", "--set", "adapt.max_levels=2")
the_same_as_one("coulomb", f"{EXAMPLES}/02_coulomb_block/case.toml", "--set", "degree=3")
the_same_as_one("dam", f"{EXAMPLES}/05_dam/case.toml")
the_same_as_one("dam3d", f"{EXAMPLES}/05_dam/case3d.toml", "--set", "adapt.max_levels=2", "--set", "solver.method=direct")
the_same_as_one("multigrid", f"{EXAMPLES}/05_dam/case3d.toml", "--set", "adapt.max_levels=2", "--set", "solver.method=iterative", "--set",
                "newton.stopping=tolerance", "--set", "newton.tolerance=3e-11")
load_steps_the_same_as_one("peeled", f"{EXAMPLES}/17_double_cantilever/case.toml", "--set", "adapt.max_levels=1", "--set", "history.steps=[0.2, 0.5, 0.8]")
load_steps_the_same_as_one("sheared", f"{EXAMPLES}/18_shear_cycle/case.toml", "--set", "adapt.max_levels=1")
load_steps_the_same_as_one("carried", f"{EXAMPLES}/17_double_cantilever/case.toml", "--set", "history.refine=transfer", "--set", "adapt.tolerance=0.02",
                           "--set", "newton.tolerance=1e-12", "--set", "history.steps=[0.2, 0.5, 0.8]")
load_steps_the_same_as_one("dam_to_failure", f"{EXAMPLES}/20_dam_to_failure/case.toml", "--set", "adapt.max_levels=0", "--set", "history.damage_step=6", "--set",
                           "newton.tolerance=1e-12", "--set", "boundary.base.interface.water.crack=true", "--set", "history.steps=[0, 40, 70, 80]")
the_same_as_one("blocks", f"{EXAMPLES}/07_three_blocks/case.toml")
the_same_as_one("joint", f"{CASES}/joint.toml", "--set", "adapt.max_levels=4")
the_same_as_one("rock3d", f"{EXAMPLES}/09_dam_on_rock/case3d.toml", "--set", "adapt.max_levels=1", "--set", "solver.method=direct")
the_same_as_one("triangles", f"{CASES}/on_triangles.toml")
the_same_as_one("order2", f"{CASES}/order2.toml")
the_same_as_one("order2_pair", f"{CASES}/order2_pair.toml")
DAM_TO_FAILURE = [f"{EXAMPLES}/20_dam_to_failure/case.toml", "--set", "history.damage_step=6", "--set", "newton.tolerance=1e-12"]
load_steps_go_on("past_the_peak", 7, *DAM_TO_FAILURE, "--set", "adapt.max_levels=0", "--set", "boundary.base.interface.water.crack=true", "--set",
                 "history.steps=[0, 40, 70, 80]")
load_steps_go_on("second_pass", 3, f"{EXAMPLES}/18_shear_cycle/case.toml", "--set", "adapt.max_levels=1", "--set", "newton.tolerance=1e-12", "--set",
                 "history.check=true")
load_steps_go_on("joint_of_two", 2, f"{EXAMPLES}/22_contraction_joint/case.toml", "--set", "history.check=true")
load_steps_go_on("rock3d_in_steps", 2, f"{EXAMPLES}/09_dam_on_rock/case3d.toml", "--set", "degree=1", "--set", "adapt.max_levels=0", "--set",
                 "solver.method=direct", "--set", "history.steps=[30, 45, 50]", "--set", "newton.tolerance=1e-12", "--set",
                 "boundary.upstream.pressure='1000*9.81*1e-6*max(0, t - y)'", "--set", "boundary.reservoir.pressure='1000*9.81*1e-6*t'")
load_steps_go_on("thin_segments", 1, f"{EXAMPLES}/24_arch_dam/case.toml", "--set", "degree=1", "--set", "adapt.tolerance=0.9", "--set", "history.steps=[0, 1]",
                 "--set", "solver.method=direct", "--set", "newton.tolerance=1e-12")
killed_load_steps_go_on("killed_steps", *DAM_TO_FAILURE, "--set", "adapt.max_levels=1")
bad_input_is_told_once()
commands_for_one_process()
interrupted()
a_run_goes_on()
a_box_goes_on()
bodies_go_on()
one_thread_each()
faults()
print("\n".join(failures) or "as by one process")
sys.exit(1 if failures else 0)
