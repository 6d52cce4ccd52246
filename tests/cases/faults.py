#!/usr/bin/env python3
"""What the program does when the world around it fails: signals, kills, full disks, closed pipes, two runs in one place.

    faults.py PROGRAM
"""

import fcntl
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import runner

PROGRAM = str(Path(sys.argv[1]).resolve())
# With several threads OpenBLAS takes more memory than little_address_space leaves before the program begins.
ENVIRONMENT = runner.ENVIRONMENT | {"OPENBLAS_NUM_THREADS": "1"}
TIME_LIMIT = 120  # seconds per run

CASE = """
degree = 2
[mesh]
box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
[material]
E = 1.0
nu = 0.3
[boundary.left]
displacement = [0, 0]
[boundary.top]
traction = [0, -0.1]
[boundary.bottom]
contact = {}
[adapt]
max_levels = 2
[output]
directory = "out"
"""
LONG = ["--set", "mesh.box.cells=[300, 150]"]  # the first level takes some seconds
MANY_LEVELS = ["--set", "adapt.max_levels=60", "--set", "adapt.tolerance=1e-6", "--set", 'output.levels="all"']
ENDLESS_GEO = "For i In {1:1000000000}\nEndFor\n"  # keeps Gmsh busy


def start(directory, *arguments, **options):
    """The program, with the signal handling that a terminal gives it."""
    defaults = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": ENVIRONMENT}
    return subprocess.Popen([PROGRAM, *arguments], cwd=directory, **(defaults | options))


def run(directory, *arguments, **options):
    result = runner.run(PROGRAM, *arguments, cwd=directory, **({"env": ENVIRONMENT, "timeout": TIME_LIMIT} | options))
    return result.returncode, result.stdout, result.stderr


def wait_for(condition):
    for _ in range(40 * TIME_LIMIT):
        if condition():
            return
        time.sleep(0.025)
    raise AssertionError("waited in vain")


def has_ended(process):
    """From a folder of /proc. Orphans that nobody waits for, as in a container without init, stay as zombies."""
    try:
        return (process / "stat").read_text().rpartition(") ")[2].startswith(("Z", "X"))
    except OSError:
        return True


def hidden(directory):
    return [path.name for path in directory.iterdir() if path.name.startswith(".")]


def expect(condition, *what):
    if not condition:
        raise AssertionError("\n".join(str(part) for part in what))


def kill_in_first_level_leaves_no_old_certificate(directory):
    code, output, errors = run(directory, "run", "case.toml", "--set", "adapt.tolerance=0.5")
    out = directory / "out"
    expect(code == 0 and json.loads((out / "certificate.json").read_text())["status"] == "certified", output, errors)
    (out / ".level_000.vtu.99999.part").write_text("of a program that was killed")
    (out / "notes.part").write_text("of somebody else")

    def left():  # the case may be the user's own
        return {path.name for path in out.iterdir()} - {"notes.part", ".tribound.lock", "case.toml"}

    process = start(directory, "run", "case.toml", *LONG)
    wait_for(lambda: not left() or process.poll() is not None)
    process.kill()
    process.communicate()
    expect(not left(), left())
    code, output, errors = run(directory, "run", "case.toml", "--set", "adapt.tolerance=0.5")
    expect(code == 0 and not hidden(out) and (out / "notes.part").exists(), output, errors, hidden(out))


def a_failed_run_leaves_nothing_of_the_one_before(directory):
    run(directory, "run", "case.toml")
    code, output, errors = run(directory, "run", "case.toml", "--set", "newton.max_steps=1", "--set", "boundary.bottom.contact.gap=0.05")
    left = {path.name for path in (directory / "out").iterdir()} - {"report.html"}
    expect(code == 2 and left == {"case.toml", "certificate.json", "convergence.csv", "newton.csv"}, code, left, output, errors)


def two_runs_in_one_directory(directory):
    (directory / "out").mkdir()
    with open(directory / "out/.tribound.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        lock.write("process 42 on elsewhere\n")
        lock.flush()
        code, _, errors = run(directory, "run", "case.toml")
    expect(code == 1 and "another run is writing to it: process 42 on elsewhere" in errors, code, errors)


def a_closed_pipe_does_not_end_a_run(directory):
    reading, writing = os.pipe()
    os.close(reading)
    code, _, errors = run(directory, "run", "case.toml", stdout=writing)
    expect(code == 3 and "level_002.vtu" in os.listdir(directory / "out"), code, errors)
    code, _, errors = run(directory, "check", "case.toml", "--json", stdout=writing)
    expect(code == 0 and not errors, code, errors)
    os.close(writing)


def an_interrupt_while_the_mesh_is_made(directory):
    (directory / "endless.geo").write_text(ENDLESS_GEO)
    case = CASE.replace("box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }", 'file = "endless.geo"')
    (directory / "case.toml").write_text(case)

    def children(process):
        found = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        return [Path(f"/proc/{child}") for child in found]

    for command, number, expected in (("run", signal.SIGTERM, 2), ("check", signal.SIGINT, -signal.SIGINT)):
        process = start(directory, command, "case.toml")
        wait_for(lambda: children(process))
        child = children(process)[0]
        process.send_signal(number)
        _, errors = process.communicate(timeout=TIME_LIMIT)
        expect(process.returncode == expected, command, process.returncode, errors)
        expect(expected < 0 or "interrupted while the mesh was read" in errors, errors)
        wait_for(lambda: has_ended(child))
        expect(not (directory / "out").exists(), "something is written")


def the_second_signal_ends_at_once(directory):
    process = start(directory, "run", "case.toml", *LONG)
    wait_for((directory / "out").exists)
    process.send_signal(signal.SIGINT)
    time.sleep(0.1)
    process.send_signal(signal.SIGTERM)
    begin = time.monotonic()
    process.communicate()
    expect(process.returncode == -signal.SIGTERM and time.monotonic() - begin < 1, process.returncode)


def little_address_space(directory):
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (400_000_000, 400_000_000))

    code, _, errors = run(directory, "run", "case.toml", preexec_fn=limit)
    expect(code == 1 and "the address space is limited to 0.4 GB (ulimit -v)" in errors, code, errors)


def several_processes(directory):
    for variable in ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE"):
        code, _, errors = run(directory, "verify", "case.toml", env=ENVIRONMENT | {variable: "2"})
        expect(code == 1 and "was started as 2" in errors, code, errors)


def a_page_that_cannot_be_written(directory):
    (directory / "out/report.html").mkdir(parents=True)
    code, output, errors = run(directory, "run", "case.toml")
    expect(code == 2 and "level 0" in output and "report.html: cannot write this file" in errors, code, output, errors)
    certificate = json.loads((directory / "out/certificate.json").read_text())
    expect(certificate["status"] == "budget", certificate)


def runs_in_threads(directory):
    """A long run that has written its second level, in place and beside the computation."""
    for threads in ("1", "2"):
        process = start(directory, "run", "case.toml", *MANY_LEVELS, env=ENVIRONMENT | {"OMP_NUM_THREADS": threads})
        wait_for((directory / "out/level_001.vtu").exists)
        yield process
        (directory / "out").rename(directory / f"out_{threads}")


def the_output_directory_goes_away(directory):
    out = directory / "out"
    for process in runs_in_threads(directory):
        out.rename(directory / "elsewhere")
        out.write_text("not a directory")
        _, errors = process.communicate(timeout=TIME_LIMIT)
        expect(process.returncode == 2 and "out/" in errors and "cannot write this file" in errors, process.returncode, errors)
        (directory / "elsewhere").rename(directory / f"elsewhere_{process.pid}")


def an_interrupt_leaves_a_complete_level(directory):
    out = directory / "out"
    for process in runs_in_threads(directory):
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=TIME_LIMIT)
        certificate = json.loads((out / "certificate.json").read_text())
        expect(process.returncode == 3 and "interrupted" in certificate["reason"], process.returncode, errors)
        numbers = [level["level"] for level in certificate["levels"]]
        fields = sorted(out.glob("level_*.vtu"))
        expect([f"level_{number:03}.vtu" for number in numbers] == [file.name for file in fields], numbers, fields)
        expect((out / "series.pvd").read_text().count("<DataSet") == len(numbers) and not hidden(out), hidden(out))
        expect(f'"level":{numbers[-1]},"dimension"' in (out / "report.html").read_text(), "the page lacks the last level")


def check_tries_the_output_directory(directory):
    (directory / "taken").write_text("")
    code, _, errors = run(directory, "check", "case.toml", "--set", "output.directory=taken/out")
    expect(code == 1 and "taken/out: output.directory: cannot create this directory" in errors, code, errors)
    code, _, errors = run(directory, "check", "case.toml", "--set", "output.directory=a/b")
    expect(code == 0 and not (directory / "a").exists(), code, errors)


def a_mesh_that_the_run_would_remove(directory):
    run(directory, "run", "case.toml")
    case = CASE.replace("box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }", 'file = "out/adapted.msh"')
    (directory / "again.toml").write_text(case)
    for command in ("run", "check"):
        code, _, errors = run(directory, command, "again.toml")
        expect(code == 1 and "mesh.file: is the adapted.msh" in errors and (directory / "out/adapted.msh").exists(), code, errors)
    code, _, errors = run(directory, "run", "again.toml", "--set", "output.directory=elsewhere", "--set", "adapt.max_levels=0")
    expect(code == 3, code, errors)


def quiet(directory):
    code, output, _ = run(directory, "run", "case.toml", "--quiet")
    expect(code == 3 and "status" in output and "results" in output and "level" not in output.split("status")[0], output)


def lines_fit_a_terminal(directory):
    """Progress, which only a terminal shows, and the lines of the levels."""
    terminal, end = os.openpty()
    _, output, _ = run(directory, "run", "case.toml", stderr=end)
    os.close(end)
    progress = os.read(terminal, 1 << 16).decode().splitlines()
    os.close(terminal)
    levels = [line for line in output.splitlines() if line.startswith("level")]
    expect(levels and any("residual" in line for line in progress), output, *progress)
    expect(max(map(len, [*levels, *progress])) <= 80, output, *progress)


TESTS = (
    kill_in_first_level_leaves_no_old_certificate,
    a_failed_run_leaves_nothing_of_the_one_before,
    two_runs_in_one_directory,
    a_closed_pipe_does_not_end_a_run,
    an_interrupt_while_the_mesh_is_made,
    the_second_signal_ends_at_once,
    little_address_space,
    several_processes,
    a_page_that_cannot_be_written,
    the_output_directory_goes_away,
    an_interrupt_leaves_a_complete_level,
    check_tries_the_output_directory,
    a_mesh_that_the_run_would_remove,
    quiet,
    lines_fit_a_terminal,
)


def main():
    failed = 0
    for test in TESTS:
        with tempfile.TemporaryDirectory() as directory:
            (Path(directory) / "case.toml").write_text(CASE)
            try:
                test(Path(directory))
            except AssertionError as problem:
                failed += 1
                print(f"[{test.__name__}]", problem, sep="\n", end="\n\n")
    print(f"{len(TESTS) - failed} of {len(TESTS)} as expected")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
