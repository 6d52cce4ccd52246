#!/usr/bin/env python3
"""Gives the program bad input and compares its messages with the expected ones.

    bad_inputs.py PROGRAM BAD_INPUTS.toml [ROW ...]        with --show it prints the messages instead

BAD_INPUTS.toml describes its own format. Every row runs in a directory of its own, which must be unchanged afterwards. The
message on stderr must match the expected one to the letter.
"""

import argparse
import difflib
import fnmatch
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import runner

TIME_LIMIT = 60  # seconds per row
WORKERS = 2

# Elements of Gmsh: type number, dimension.
ELEMENTS = {
    "line": (1, 1),
    "triangle": (2, 2),
    "quad": (3, 2),
    "tetrahedron": (4, 3),
    "hexahedron": (5, 3),
    "line3": (8, 1),
    "triangle6": (9, 2),
    "quad16": (36, 2),
}


def msh(mesh):
    """The text of a .msh file (version 2.2, ASCII): every group is one entity of the geometry."""
    elements = [line.split() for line in mesh["elements"]]
    groups = {}  # name -> dimension, tag
    for group, kind, *_ in elements:
        groups.setdefault(group, (ELEMENTS[kind][1], len(groups) + 1))
    names = [f'{dim} {tag} "{name}"' for name, (dim, tag) in groups.items()]
    nodes = [f"{number} {position}" for number, position in enumerate(mesh["vertices"], 1)]
    cells = []
    for number, (group, kind, *vertices) in enumerate(elements, 1):
        tag = groups[group][1]
        cells.append(f"{number} {ELEMENTS[kind][0]} 2 {tag} {tag} {' '.join(vertices)}")
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    for section, lines in (("PhysicalNames", names), ("Nodes", nodes), ("Elements", cells)):
        text += "\n".join([f"${section}", str(len(lines)), *lines, f"$End{section}", ""])
    return text


def replaced(text, old, new):
    if text.count(old) != 1:
        raise SystemExit(f"bad_inputs: {old!r} stands {text.count(old)} times in\n{text}")
    return text.replace(old, new)


def edited(mesh, edits):
    """The mesh with vertices and elements replaced, added or left out."""
    mesh = {part: list(lines) for part, lines in mesh.items()}
    for part in ("vertices", "elements"):
        for line in edits.get(f"drop_{part}", []):
            mesh[part].remove(line)
        mesh[part] += edits.get(f"add_{part}", [])
    return mesh


def write_inputs(row, table, directory):
    """The case file, the mesh and whatever else the row asks for."""
    case = table["cases"][row.get("case", "block")]
    if "replace" in row:
        case = replaced(case, *row["replace"])
    case += row.get("append", "")
    (directory / "case.toml").write_text(case)
    if "mesh" in row:
        mesh = edited(table["meshes"][row["mesh"]], row)
        (directory / "mesh.msh").write_text(msh(mesh))
    for name, text in row.get("files", {}).items():
        (directory / name).write_text(text)
    for name in row.get("directories", []):
        (directory / name).mkdir()


def contents(directory):
    return sorted(str(path.relative_to(directory)) for path in directory.rglob("*"))


def run(program, row, directory):
    """Runs the program in the directory. A limit on the file size stands in for a full disk."""
    arguments = row.get("arguments", ["run", "case.toml"])
    for assignment in row.get("set", []):
        arguments = [*arguments, "--set", assignment]
    limit = ["prlimit", f"--fsize={row['file_size']}"] if "file_size" in row else []
    # Python ignores SIGXFSZ, so writing too much fails instead of ending the program.
    return runner.run(*limit, program, *arguments, cwd=directory, timeout=TIME_LIMIT, restore_signals=False)


def differences(program, row, table, directory):
    """Yields whatever differs from what is expected."""
    write_inputs(row, table, directory)
    before = contents(directory)
    result = run(program, row, directory)
    if result.returncode != row.get("exit", 1):
        yield f"exit code {result.returncode}, expected {row.get('exit', 1)}\n{result.stdout}{result.stderr}"
    if "message" in row:
        expected = row["message"].rstrip("\n").splitlines()
        found = result.stderr.removeprefix("tribound: ").rstrip("\n").splitlines()
        if found != expected:
            yield "\n".join(difflib.unified_diff(expected, found, "expected", "found", lineterm=""))
    for name, text in row.get("contents", {}).items():
        if not (directory / name).exists():  # it is missing in `written`, too
            yield f"has not written {name}, but\n{result.stdout}{result.stderr}"
        elif text not in (directory / name).read_text():
            yield f"{name} does not hold {text!r}"
    for text in row.get("fragments", []):
        if text not in result.stdout + result.stderr:
            yield f"does not say {text!r} but\n{result.stdout}{result.stderr}"
    written = sorted(set(contents(directory)) - set(before))
    if written != row.get("written", []):
        yield f"has written {written}, expected {row.get('written', [])}"


def show(program, row, table, directory):
    """Yields what the program does and says."""
    write_inputs(row, table, directory)
    before = contents(directory)
    result = run(program, row, directory)
    yield f"exit code {result.returncode}, writes {sorted(set(contents(directory)) - set(before))}"
    yield result.stderr.rstrip("\n") or result.stdout.rstrip("\n")


def main():
    parser = argparse.ArgumentParser(description="Gives the program bad input and compares its messages.")
    parser.add_argument("program", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("rows", nargs="*", metavar="ROW", help="names or patterns; default: all")
    parser.add_argument("--show", action="store_true", help="print the messages, compare nothing")
    options = parser.parse_args()
    program = options.program.resolve()
    table = tomllib.loads(options.table.read_text())

    names = [row["name"] for row in table["row"]]
    if len(set(names)) != len(names):
        raise SystemExit("bad_inputs: two rows have the same name")
    rows = [row for row in table["row"] if any(fnmatch.fnmatch(row["name"], pattern) for pattern in options.rows or "*")]
    def process(row):
        with tempfile.TemporaryDirectory() as directory:
            return list((show if options.show else differences)(program, row, table, Path(directory)))

    failed = 0
    with ThreadPoolExecutor(WORKERS) as workers:
        for row, lines in zip(rows, workers.map(process, rows)):
            failed += bool(lines)
            if lines:
                print(f"[{row['name']}]", *lines, sep="\n", end="\n\n")
    if options.show:
        return 0
    print(f"{len(rows) - failed} of {len(rows)} rows as expected")
    return 1 if failed or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
