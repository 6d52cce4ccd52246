#!/usr/bin/env python3
"""Checks that each room of src/tribound includes only those before it.

    rooms.py ROOT

The rooms and their order are the table of src/README.md. Only the program prints and starts other programs.
"""

import re
import sys
from pathlib import Path

PROGRAM_ONLY = re.compile(r"\b(?:std::(?:cout|cerr|printf|puts|fprintf|system)|fmt::print|posix_spawnp?|execvp?|popen)\b")


def rooms(root):
    text = (root / "src/README.md").read_text()
    return re.findall(r"^\| `([a-z]+)` \|", text[text.index("## Rooms") :], re.M)


def without_comments(text):
    return re.sub(r"//.*", "", text)


def main():
    root = Path(sys.argv[1])
    order = rooms(root)
    library = root / "src/tribound"
    problems = [f"src/README.md does not list {folder.name}" for folder in library.iterdir() if folder.is_dir() and folder.name not in order]
    n_includes = 0
    for file in sorted(library.rglob("*")):
        if file.suffix not in (".h", ".cpp") or file.parent == library:
            continue
        name = file.relative_to(library)
        room = name.parts[0]
        text = file.read_text()
        for included in re.findall(r'#include "(.*?)"', text):
            n_includes += 1
            parts = included.split("/")
            if parts[0] != "tribound":
                problems.append(f"{name} includes {included}, which is not of the library")
            elif parts[1] not in order or order.index(parts[1]) > order.index(room):
                problems.append(f"{name} includes {included}: {room} stands before {parts[1]}")
        for found in PROGRAM_ONLY.findall(without_comments(text)):
            problems.append(f"{name} uses {found}: only the program prints and starts programs")
    print(f"{n_includes} includes between {len(order)} rooms", *problems, sep="\n")
    return 1 if problems or n_includes < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
