#!/usr/bin/env python3
"""Checks that tribound.h reaches every public header, and that these need nothing but the standard library and Eigen.

    headers.py ROOT

Headers that it does not reach are internal: to their own folder, to base, or to the program (app). A header that another
folder uses is public.
"""

import re
import sys
from pathlib import Path


def includes(file):
    return re.findall(r'#include "(.*?)"', file.read_text())


def foreign(file):
    """Headers of libraries that users of this one would have to install."""
    found = re.findall(r"#include <(.*?)>", file.read_text())
    return [header for header in found if not re.fullmatch(r"[a-z_0-9]+|Eigen/.*", header)]


def room(file):
    return file.parts[1]


def main():
    root = Path(sys.argv[1])
    source = root / "src"
    users = {file.relative_to(source): includes(file) for file in source.rglob("*") if file.suffix in (".h", ".cpp")}
    reached, pending = set(), ["tribound/tribound.h"]
    while pending:
        header = pending.pop()
        if header not in reached and Path(header) in users:
            reached.add(header)
            pending += users[Path(header)]
    problems = [f"{header} includes {name}" for header in sorted(reached) for name in foreign(source / header)]
    for file in users:
        if file.suffix != ".h" or str(file) in reached or file.parent.name == "base":
            continue
        for user, headers in users.items():
            if str(file) in headers and room(user) != room(file):
                problems.append(f"{file} is used by {user}, but tribound.h does not reach it")
    print(f"tribound.h reaches {len(reached) - 1} headers", *problems, sep="\n")
    return 1 if problems or len(reached) < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
