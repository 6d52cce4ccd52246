#!/usr/bin/env python3
"""Runs sweeps of a case: grids, tables, exit codes, continuing after an interruption.

    sweep.py PROGRAM DIRECTORY
"""

import csv
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from runner import run

CASE = """\
degree = 1
[mesh]
box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
[material]
E = 1
nu = 0.3
[boundary.left]
displacement = [0, "free"]
[boundary.top]
traction = [0.01, -0.1]
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.5 }
[adapt]
tolerance = 0.3
[output]
vtu = false
report = false
"""
COEFFICIENT = "boundary.bottom.contact.coefficient"


def tribound(program, directory, *arguments, code=0):
    result = run(program, "sweep", *arguments, cwd=directory)
    assert result.returncode == code, f"{arguments}: exit code {result.returncode}, expected {code}\n{result.stdout}{result.stderr}"
    return result.stdout + result.stderr


def rows(directory):
    return list(csv.DictReader((directory / "sweep.csv").open()))


def check_grid(program, directory):
    held_by_friction = ("--set", 'boundary.left.displacement=["free", 0]')
    tribound(program, directory, "case.toml", "degree=[1, 2]", f"{COEFFICIENT}=0.3:0.5:3", "--jobs", "2", *held_by_friction)
    sweep = directory / "out/case/sweep"
    table = rows(sweep)
    assert [(row["degree"], row[COEFFICIENT]) for row in table] == [(p, mu) for p in "12" for mu in ("0.3", "0.4", "0.5")]
    assert [row["run"] for row in table] == [f"{i:04}" for i in range(1, 7)]
    for row, record in zip(table, json.loads((sweep / "sweep.json").read_text())["runs"], strict=True):
        certificate = json.loads((sweep / row["run"] / "certificate.json").read_text())
        assert row["status"] == "certified" == certificate["status"] and record["exit_code"] == 0
        assert certificate["p"] == int(row["degree"])
        assert record["sha256"] == hashlib.sha256((sweep / row["run"] / "case.toml").read_bytes()).hexdigest()
        for name in ("relative", "bound", "cells", "dofs"):
            assert float(row[name]) == certificate[name] == record[name], name
        bottom = certificate["contact"]["boundaries"]["bottom"]
        assert float(row["contact_normal"]) == bottom["normal"]
        assert float(row["sliding_factor.bottom"]) == bottom["sliding"]["sliding_factor"]
        # The roller takes part of the weight; friction takes all of the push.
        reaction = next(part for part in certificate["balance"]["rows"] if part["kind"] == "reaction")
        assert float(row["reaction_y.left"]) == reaction["force"][1] and float(row["reaction_x.left"]) == 0
        points = list(csv.DictReader((sweep / row["run"] / "contact.csv").open()))
        assert float(row["largest_pressure"]) == max(float(point["pressure"]) for point in points)
        assert abs(float(row["opened"]) - sum(float(p["weight"]) for p in points if p["status"] == "0")) < 1e-12
        assert "certified" in (sweep / row["run"] / "log.txt").read_text()


def check_exit_codes(program, directory):
    tribound(program, directory, "case.toml", "adapt.tolerance=[0.5, 1e-9]", "--set", "adapt.max_levels=1", code=3)
    assert [row["status"] for row in rows(directory / "out/case/sweep")] == ["certified", "budget"]
    tribound(program, directory, "case.toml", "newton.max_steps=[1, 50]", "--set", "newton.stopping=tolerance", code=2)
    assert [row["status"] for row in rows(directory / "out/case/sweep")] == ["failed", "certified"]
    # A boundary that does not exist is noticed only with the mesh; a key that does not exist, at once.
    tribound(program, directory, "case.toml", "boundary.lid.traction=[[0, 0], [0, 1]]", code=1)
    assert [row["status"] for row in rows(directory / "out/case/sweep")] == ["bad input", "bad input"]
    shutil.rmtree(directory / "out")
    for arguments in (["case.toml", "degre=[1, 2]"], ["case.toml", "degree=[1, 9]"], ["case.toml"], ["case.toml", "degree"]):
        assert "hint:" in tribound(program, directory, *arguments, code=1)
    assert not (directory / "out").exists()


def check_table(program, directory):
    (directory / "runs.csv").write_text('degree,boundary.top.traction\n1,"[0, -0.1]"\n2,"[0, ""-0.1*x""]"\n')
    tribound(program, directory, "case.toml", "--table", "runs.csv", "--set", "output.directory=by table")
    table = rows(directory / "by table/sweep")
    assert [row["boundary.top.traction"] for row in table] == ["[0, -0.1]", '[0, "-0.1*x"]']
    assert [abs(float(row["contact_normal"]) + force) < 1e-6 for row, force in zip(table, (0.2, 0.2))] == [True, True]


def check_resume(program, directory):
    """Interrupted in the second of three runs, then continued."""
    tolerances = "adapt.tolerance=[0.5, 0.0005, 0.4]"
    sweep = directory / "out/case/sweep"
    with subprocess.Popen([program, "sweep", "case.toml", tolerances], cwd=directory, stdout=subprocess.PIPE, text=True) as process:
        end = time.monotonic() + 120
        while not (sweep / "0002/certificate.json").exists() and time.monotonic() < end:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
    assert process.returncode == 3, process.returncode
    assert [row["status"] for row in rows(sweep)] == ["certified", "budget", "not run"]
    assert "interrupted" in rows(sweep)[1]["reason"]

    before = (sweep / "0001/certificate.json").stat().st_mtime_ns
    tribound(program, directory, "case.toml", "adapt.tolerance=[0.5, 0.45, 0.4]", "--resume")
    assert [row["status"] for row in rows(sweep)] == ["certified"] * 3
    assert (sweep / "0001/certificate.json").stat().st_mtime_ns == before, "what is complete is kept"
    said = tribound(program, directory, "case.toml", "adapt.tolerance=[0.5, 0.45, 0.4]", "--resume", "--set", "degree=2")
    assert "kept" not in said, "another case is solved again"


MESH = """\
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {2, 1, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Physical Surface("box") = {1};
Mesh.MeshSizeMax = 0.6;
"""


def case_with_mesh_file(directory, file="box.geo"):
    lines = [f'file = "{file}"' if line.startswith("box =") else line for line in CASE.splitlines()]
    text = "\n".join(lines) + '\n[boundary.right]\ntraction = [0, 0]\n'
    (directory / "mesh.toml").write_text(text)


def check_mesh_file(program, directory):
    """An earlier result does not count when the mesh has changed or is gone."""
    case_with_mesh_file(directory)
    arguments = ["mesh.toml", "degree=[1]", "--resume"]
    sweep = directory / "out/mesh/sweep"
    (directory / "box.geo").write_text(MESH)
    tribound(program, directory, *arguments)
    cells = rows(sweep)[0]["cells"]
    assert "kept" in tribound(program, directory, *arguments)
    (directory / "box.geo").write_text(MESH.replace("0.6", "0.1"))
    assert "kept" not in tribound(program, directory, *arguments) and rows(sweep)[0]["cells"] != cells
    (directory / "box.geo").unlink()
    assert "bound" not in tribound(program, directory, *arguments, code=1)
    assert rows(sweep)[0]["status"] == "bad input" and not (sweep / "0001/certificate.json").exists()


def check_included_file(program, directory):
    """Nor when a file that a deck includes has changed."""
    case_with_mesh_file(directory, "box.inp")
    sides = enumerate(["bottom", "right", "top", "left"], start=1)
    surfaces = "".join(f"*SURFACE, NAME={side}\n1, S{number}\n" for number, side in sides)
    (directory / "box.inp").write_text("*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n" + surfaces)
    nodes = "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 1\n4, 0, 1\n"
    (directory / "nodes.inp").write_text(nodes)
    arguments = ["mesh.toml", "degree=[1]", "--resume"]
    tribound(program, directory, *arguments)
    assert "kept" in tribound(program, directory, *arguments)
    (directory / "nodes.inp").write_text(nodes.replace("3, 2, 1", "3, 2, 1.1"))
    assert "kept" not in tribound(program, directory, *arguments)


def check_interrupted_before_the_first_level(program, directory):
    case_with_mesh_file(directory)
    (directory / "box.geo").write_text("For i In {1:1000000000}\nEndFor\n")  # keeps Gmsh busy
    with subprocess.Popen([program, "sweep", "mesh.toml", "degree=[1]"], cwd=directory, stdout=subprocess.PIPE) as process:
        log = directory / "out/mesh/sweep/0001/log.txt"
        while not log.exists():
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
    assert process.returncode == 3 and rows(log.parents[1])[0]["status"] == "not run", process.returncode


def check_surroundings(program, directory):
    """Nobody reads the output; the parent ignores the end of children; the second run cannot begin."""
    reading, writing = os.pipe()
    os.close(reading)
    titles = [f'title=["{"a" * 5000}", "b"]']
    result = run(program, "sweep", "case.toml", *titles, cwd=directory, stdout=writing)
    os.close(writing)
    assert result.returncode == 0 and not result.stderr, result.stderr

    ignore = lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    result = run(program, "sweep", "case.toml", "degree=1", cwd=directory, preexec_fn=ignore, timeout=60)
    assert result.returncode == 0, result.returncode

    sweep = directory / "out/case/sweep"
    shutil.rmtree(sweep / "0002")
    (sweep / "0002").write_text("a file")
    tribound(program, directory, "case.toml", "degree=[1, 2]", "--set", "mesh.box.cells=[300, 150]", "--jobs", "2", code=2)
    assert not (sweep / "0001/.tribound.lock").exists() and not running_in(sweep / "0001"), "the first run goes on alone"


def running_in(directory):
    """Whether a process has a file open there."""
    for opened in Path("/proc").glob("[0-9]*/fd/*"):
        try:
            if opened.readlink().parent == directory:
                return True
        except OSError:
            continue  # it has ended, or is not ours
    return False


CHECKS = (
    check_grid,
    check_exit_codes,
    check_table,
    check_resume,
    check_mesh_file,
    check_included_file,
    check_interrupted_before_the_first_level,
    check_surroundings,
)


def main():
    program, directory = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    (directory / "case.toml").write_text(CASE)
    for check in CHECKS:
        shutil.rmtree(directory / "out", ignore_errors=True)
        check(program, directory)
    print("sweeps are as they should be")


if __name__ == "__main__":
    main()
