#!/usr/bin/env python3
"""Checks that every example has a picture, a section in the gallery and a line in the guide, and that pictures are small.

    gallery.py ROOT
"""

import re
import struct
import sys
from pathlib import Path

LARGEST, ALL = 120_000, 2_500_000  # bytes: one picture, all pictures
NARROWEST = 800  # pixels
FIGURES = (  # of other pages: scripts/study_figures, scripts/validation
    "paper_components.svg", "paper_convergence.svg", "paper_revolution.svg", "validation.png")


def png_size(file):
    """Width and height in pixels; None if the file is no PNG."""
    head = file.read_bytes()[:24]
    return struct.unpack(">II", head[16:24]) if head[:8] == b"\x89PNG\r\n\x1a\n" and head[12:16] == b"IHDR" else None


def picture_problems(file):
    size = png_size(file) if file.is_file() else None
    if size is None:
        return [f"docs/images/{file.name} is missing or no PNG: scripts/pictures --only {file.stem}"]
    problems = [f"docs/images/{file.name} is {size[0]} pixels wide, less than {NARROWEST}"] if size[0] < NARROWEST else []
    if file.stat().st_size > LARGEST:
        problems.append(f"docs/images/{file.name} has {file.stat().st_size} bytes, more than {LARGEST}")
    return problems


def section_problems(name, gallery):
    """What the section of an example lacks: the picture, a sentence, the numbers and the command."""
    section = next((part for part in re.split(r"^## ", gallery, flags=re.M)[1:] if f"(images/{name}.png)" in part), None)
    if section is None:
        return [f"docs/gallery.md shows no images/{name}.png"]
    needed = {
        "the sentence, with a link to the example": rf"^\w.*\. \[.*\]\(\.\./examples/{name}\)$",
        "numbers of scripts/pictures": rf"<!-- begin {name}: .*?-->\n(\|.*\|\n){{3}}<!-- end {name} -->",
        "the command": rf"^    tribound run examples/{name}/case\.toml$",
    }
    return [f"docs/gallery.md: the section of {name} lacks {what}" for what, how in needed.items() if not re.search(how, section, re.M)]


def problems(root):
    examples = sorted(case.parent.name for case in (root / "examples").glob("*/case.toml"))
    images = root / "docs/images"
    gallery, index = (root / "docs/gallery.md").read_text(), (root / "docs/index.md").read_text()
    for name in examples:
        yield from picture_problems(images / f"{name}.png")
        yield from section_problems(name, gallery)
        if f"(../examples/{name})" not in index:
            yield f"docs/index.md does not link to examples/{name}"
    yield from picture_problems(images / "report.png")
    for file in images.iterdir():
        if file.name not in FIGURES and (file.suffix != ".png" or file.stem not in [*examples, "report"]):
            yield f"docs/images/{file.name} belongs to no example"
    if (total := sum(file.stat().st_size for file in images.iterdir())) > ALL:
        yield f"docs/images has {total} bytes, more than {ALL}"


def main():
    found = list(problems(Path(sys.argv[1])))
    for problem in found:
        print(problem, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
