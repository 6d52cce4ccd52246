#!/usr/bin/env python3
"""Runs `tribound mesh` on small decks and geometries, and cases on what it writes.

    mesh_command.py PROGRAM DIRECTORY
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

DECK = """*NODE
1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,0,0,2\n10,1,0,2\n11,1,1,2\n12,0,1,2
*ELEMENT, TYPE=C3D8
1, 1,2,3,4,5,6,7,8\n2, 5,6,7,8,9,10,11,12
*ELEMENT, TYPE=SPRING1
5, 9
*ELSET, ELSET=low\n1\n*ELSET, ELSET=up\n2
*SURFACE, NAME=base\n1, S1\n*SURFACE, NAME=lid\n2, S2\n*SURFACE, NAME=between\n2, S1
"""
CASE = """[mesh]
file = "MESH"
[material]
E = 1
nu = 0.3
[boundary.base]
displacement = [0, 0, 0]
[boundary.lid]
traction = [0, 0, -0.01]
"""
GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 2, 3};
Physical Volume("body") = {1};
Physical Surface("base") = {5};
"""


class Runs:
    def __init__(self, program, directory):
        self.program = Path(program).resolve()
        self.directory = Path(directory)
        shutil.rmtree(self.directory, ignore_errors=True)
        self.directory.mkdir(parents=True)
        self.problems = []

    def run(self, *arguments, code=0):
        """What is printed on stdout and on stderr."""
        result = subprocess.run(
            [self.program, *arguments], capture_output=True, text=True, timeout=120, cwd=self.directory
        )
        self.expect(result.returncode == code, f"{arguments} ends with {result.returncode}:\n{result.stderr}")
        return result.stdout, result.stderr

    def expect(self, holds, problem):
        if not holds:
            self.problems.append(problem)

    def expect_words(self, text, *patterns):
        for pattern in patterns:
            self.expect(re.search(pattern, text, re.MULTILINE), f'no "{pattern}" in\n{text}')


def deck_becomes_a_mesh(runs):
    (runs.directory / "deck.inp").write_text(DECK)
    _, message = runs.run("mesh", "deck.inp", "deck.msh", code=1)
    runs.expect_words(message, r"deck.inp:18: element 5 is of type SPRING1, which is not read", "ignore_elements")
    runs.expect(not (runs.directory / "deck.msh").exists(), "a refused mesh is written")
    text, notes = runs.run("mesh", "deck.inp", "deck.msh", "--ignore-elements")
    runs.expect_words(
        text,
        r"^elements +2 x hexahedron of 8 nodes$",
        r"^extent +x from 0 to 1, y from 0 to 1, z from 0 to 2$",
        r"^simplices +12 tetrahedra on 12 vertices, in 1 body$",
        r"^region +low: 6 cells, volume 1$",
        r"^boundary +base: 2 facets, area 1$",
        r"^joint +between: 2 facets, area 1$",
        r"^written +deck.msh$",
    )
    runs.expect_words(notes, r"note: deck.inp: elements left out: 1 of type SPRING1 \(such as 5\)")
    again, _ = runs.run("mesh", "deck.msh", "again.msh")
    runs.expect(again.replace("again.msh", "deck.msh") == text, f"the mesh has changed:\n{text}\n{again}")
    same = (runs.directory / "again.msh").read_text() == (runs.directory / "deck.msh").read_text()
    runs.expect(same, "the file has changed")


def options_choose(runs):
    text, _ = runs.run("mesh", "deck.inp", "some.msh", "--ignore-elements", "--boundaries", "base,lid")
    runs.expect("between" not in text, f"a set that is not chosen:\n{text}")
    silent = runs.run("mesh", "deck.inp", "some.msh", "--ignore-elements", "--boundaries", "base,lid", "--quiet")
    runs.expect(silent == ("", ""), f"--quiet prints {silent}")
    options = 'some.inp"\nignore_elements = true\nboundaries = ["base", "lid"]'
    shutil.copy(runs.directory / "deck.inp", runs.directory / "some.inp")
    facts = []
    for mesh in ['some.msh"', options]:
        (runs.directory / "case.toml").write_text(CASE.replace('MESH"', mesh))
        facts.append(runs.run("check", "case.toml")[0].replace("some.inp", "some.msh"))
    runs.expect(facts[0] == facts[1], f"the written mesh is another one:\n{facts[0]}\n{facts[1]}")
    before = (runs.directory / "some.msh").read_text()
    runs.run("mesh", "deck.inp", "some.msh", "--ignore-elements", "--boundaries", "base,lod", code=1)
    runs.expect((runs.directory / "some.msh").read_text() == before, "a refused mesh has changed the file")


def geometries_are_meshed(runs):
    (runs.directory / "box.geo").write_text(GEOMETRY)
    coarse, _ = runs.run("mesh", "box.geo", "box.msh", "--size", "0.4")
    fine, _ = runs.run("mesh", "box.geo", "box.msh", "--size", "0.2")
    runs.expect_words(fine, r"^region +body: \d+ cells, volume 6$", r"^boundary +base: \d+ facets, area 2$")
    n = [int(re.search(r"(\d+) x tetra", text)[1]) for text in (coarse, fine)]
    runs.expect(n[1] > 4 * n[0], f"sizes 0.4 and 0.2 give {n} tetrahedra")
    _, message = runs.run("mesh", "box.msh", "other.msh", "--size", "1", code=1)
    runs.expect_words(message, "size is of no use for a .msh")
    _, message = runs.run("mesh", "box.msh", "box.msh", code=1)
    runs.expect_words(message, "box.msh: is the mesh that is read")


def main():
    runs = Runs(*sys.argv[1:])
    for work in (deck_becomes_a_mesh, options_choose, geometries_are_meshed):
        work(runs)
    print(*runs.problems or ["tribound mesh does what it says"], sep="\n")
    return 1 if runs.problems else 0


if __name__ == "__main__":
    sys.exit(main())
