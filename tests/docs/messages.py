#!/usr/bin/env python3
"""Compares docs/troubleshooting.md with the messages of the program.

    messages.py ROOT

Every message that tests/cases/bad_inputs.toml expects must be on the page, and every message on the page must be in the
sources. On the page a message stands in backquotes in the first column of a table, with "..." for what varies.
"""

import re
import sys
import tomllib
from pathlib import Path

# Worded by libraries or the operating system.
OF_LIBRARIES = ("... is required", "The following argument was not expected: ...", "--set: 1 required KEY=VALUE ...")


def documented(page):
    """The messages of the page."""
    for line in page.splitlines():
        if line.startswith("| `"):
            yield from re.findall(r"`([^`]+)`", line.split("|")[1])


def literals(folders):
    """All string literals of the sources as one text, adjacent ones joined."""
    texts = []
    for folder in folders:
        for file in sorted([*folder.rglob("*.cpp"), *folder.rglob("*.h")]):
            code = re.sub(r"^\s*//.*$", "", file.read_text(), flags=re.M)
            code = re.sub(r'"\s*\n\s*"', "", code)
            texts += [re.sub(r"\\(.)", r"\1", text) for text in re.findall(r'"((?:[^"\\\n]|\\.)*)"', code)]
    return "\n".join(texts)


def pattern(message):
    return re.compile(".*".join(re.escape(part) for part in message.split("...")))


def main():
    root = Path(sys.argv[1])
    messages = list(documented((root / "docs/troubleshooting.md").read_text()))
    rows = tomllib.loads((root / "tests/cases/bad_inputs.toml").read_text())["row"]
    sources = literals([root / "src", root / "app"])
    problems = []
    for row in rows:
        # Anything may stand between two fragments.
        first = row.get("message", "...".join(row.get("fragments", []))).partition("\n")[0]
        if first and "tribound --help" not in row.get("fragments", []):
            if not any(pattern(message).search(first) for message in messages):
                problems.append(f"not on the page: {row['name']}: {first}")
    for message in messages:
        if message in OF_LIBRARIES:
            continue
        for part in filter(None, (part.strip(" ():\"") for part in re.split(r"\.\.\.", message))):
            if part not in sources:
                problems.append(f"not in the sources: {part!r} of {message!r}")
    print(f"{len(messages)} messages on the page, {len(rows)} rows", *problems, sep="\n")
    return 1 if problems or len(messages) < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
