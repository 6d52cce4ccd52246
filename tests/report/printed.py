#!/usr/bin/env python3
"""Prints the results of two small cases and a sweep by `tribound report --pdf` and looks for their numbers in the PDF.

    printed.py PROGRAM DIRECTORY

Exit code 77: Chromium, pdftotext or the page is missing.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

BROWSERS = [os.environ.get("CHROMIUM"), "chromium", "chromium-browser", "google-chrome"]
RUN = ["run", "case.toml", "--set", 'output.directory="a #1 b"', "--quiet"]
LEAST_PPI = 200  # of pictures on paper

# A block held by friction alone, in two load steps.
BLOCK = """
title = "Block & <floor>"
degree = 1
units = { length = "m", force = "kN" }
mesh = { box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] } }
material = { E = 1000.0, nu = 0.3 }
[load]
body = [0, "-3*t"]
[boundary.right]
traction = ["0.4*t", 0]
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.5 }
[history]
steps = [0.5, 1]
[adapt]
max_levels = 0
tolerance = 5
"""
CUBE = """
title = "Cube"
purpose = "Which thrust the floor gives to a cube that is pushed along it."
degree = 1
mesh = { box = { lower = [0, 0, 0], upper = [1, 1, 1], cells = [2, 2, 2] } }
material = { E = 1000.0, nu = 0.3 }
[boundary.top]
displacement = [0.0, -0.01, 0.004]
[boundary.bottom]
contact = { friction = "coulomb", coefficient = 0.3, gap = 0 }
[[quantity]]
name = "thrust"
kind = "contact_force"
boundary = "bottom"
direction = [0, 1, 0]
[adapt]
max_levels = 0
tolerance = 5
"""
SECTIONS = [
    *("The case", "Mesh and fields", "The contact boundary", "Balance of forces"),
    "What is guaranteed, and what is not",
    *("The bound and its causes", "Newton\u2019s method", "Levels, times, machine", "The case file"),
]
NEVER = ["NaN", "Infinity", "undefined", "cannot be shown"]


def skip(reason: str) -> None:
    print(f"skipped: {reason}")
    raise SystemExit(77)


Result = subprocess.CompletedProcess[str]


def tribound(program: str, *arguments: str, directory: Path, **variables: str) -> Result:
    command = [program, *arguments]
    env = os.environ | variables
    return subprocess.run(command, cwd=directory, capture_output=True, text=True, env=env, timeout=240)


def printed_by(*command: str | Path) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def text_of(file: Path) -> str:
    """The text of a PDF with one space between words and plain minus signs."""
    return re.sub(r"\s+", " ", printed_by("pdftotext", "-layout", file, "-")).replace("\u2212", "-")


def shown(value: float, digits: int) -> str:
    """A number as the page shows it."""
    return f"{float(f'{value:.{digits}g}'):.12g}"


def expected(certificate: dict[str, Any], directory: Path) -> list[str]:
    """What has to stand in the report of both cases."""
    forces = [x for row in certificate["balance"]["rows"] for x in row["force"] if abs(x) > 1e-3]
    steps = certificate.get("steps", [])
    worst = max((step["relative_path"] for step in steps), default=certificate["relative"])
    return [
        f"{shown(100 * worst, 3)} %",
        certificate["program"]["version"],
        certificate["case"]["sha256"],
        hashlib.sha256((directory / "certificate.json").read_bytes()).hexdigest(),
        *(shown(x, 6) for x in forces),
        *(region["material"] for region in certificate["mesh"]["regions"]),
        *(part["condition"] for part in certificate["mesh"]["boundaries"]),
        *("In plain words", "Guaranteed, without unknown constants", "for the engineer to judge"),
        certificate["purpose"],
        "This report documents",
        *("Figure 1. Solution: displacement, length", "Figure 5. Error", "Supports, loads and contact"),
    ]


def check_sections(text: str, sections: list[str]) -> None:
    """In the contents and, with the same numbers, as headings."""
    for number, title in enumerate(sections, 1):
        assert f"{number}. {title}" in text, f"no {number}. {title} in the contents"
        assert re.search(rf"{number}\s{re.escape(title)}", text), f"no section {number} {title}"


def check_sheets(file: Path) -> None:
    """A4, sharp pictures."""
    facts = printed_by("pdfinfo", file)
    assert "(A4)" in facts, facts
    images = printed_by("pdfimages", "-list", file)
    resolutions = [int(line.split()[12]) for line in images.splitlines()[2:]]
    assert len(resolutions) >= 5 and min(resolutions) >= LEAST_PPI, images


def report(program: str, directory: Path, case: str) -> tuple[str, dict[str, Any]]:
    """Runs a case and prints its result. The name of the directory has to be encoded in addresses."""
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    (directory / "case.toml").write_text(case)
    result = tribound(program, *RUN, directory=directory)
    assert result.returncode == 0, result.stderr
    printed = tribound(program, "report", "a #1 b", "--pdf", directory=directory)
    assert printed.returncode == 0, printed.stderr
    assert printed.stdout.split(maxsplit=1) == ["report", "a #1 b/report.pdf\n"], printed.stdout
    check_sheets(directory / "a #1 b/report.pdf")
    text = text_of(directory / "a #1 b/report.pdf")
    certificate = json.loads((directory / "a #1 b/certificate.json").read_text())
    for words in expected(certificate, directory / "a #1 b"):
        assert words in text, f"{directory.name}: no {words!r} in the report"
    for words in [*NEVER, str(directory)]:
        assert words not in text, f"{directory.name}: {words!r} in the report"
    return text, certificate


def check_block(program: str, directory: Path) -> None:
    text, certificate = report(program, directory, BLOCK)
    check_sections(text, [*SECTIONS[:2], "Load steps", SECTIONS[2], "Factors of safety", *SECTIONS[3:]])
    sliding = certificate["contact"]["boundaries"]["bottom"]["sliding"]
    safety = ["safety against sliding", shown(sliding["safety_factor"], 4)]
    for words in ["Block & <floor>", *safety, 'body = [0, "-3*t"]', "kN/m"]:
        assert words in text, f"no {words!r} in the report of the block"


def check_cube(program: str, directory: Path) -> None:
    text, certificate = report(program, directory, CUBE)
    check_sections(text, [*SECTIONS[:2], "Numbers with error bars", *SECTIONS[2:]])
    [thrust] = certificate["quantities"]
    for end in ["lower", "upper"]:
        assert shown(thrust[end], 6) in text, f"no {end} end in the report of the cube"


def check_sweep(program: str, directory: Path) -> None:
    """Its sections stand close: charts that fit follow on the same sheet."""
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    (directory / "case.toml").write_text(CUBE)
    sweep = tribound(program, "sweep", "case.toml", "material.nu=[0.2, 0.3]", directory=directory)
    assert sweep.returncode == 0, sweep.stderr
    results = directory / "out/case/sweep"
    printed = tribound(program, "report", str(results), "--pdf", directory=directory)
    assert printed.returncode == 0, printed.stderr
    text = text_of(results / "report.pdf")
    check_sections(text, ["Numbers with error bars", "Other numbers", "Bounds and effort", "The runs", "The machine"])
    hashed = hashlib.sha256((results / "sweep.json").read_bytes()).hexdigest()
    purpose = json.loads((results / "sweep.json").read_text())["purpose"]
    for words in [purpose, hashed, "0002", "certified"]:
        assert words in text, f"no {words!r} in the report of the sweep"
    second = printed_by("pdftotext", "-f", "2", "-l", "2", results / "report.pdf", "-")
    assert "Other numbers" in second, "charts that fit do not follow"


def check_failures(program: str, directory: Path) -> None:
    """No Chromium, another program in its place, a page that cannot be shown; a run removes the PDF."""
    results = directory / "a #1 b"
    pdf = results / "report.pdf"
    pdf.unlink()
    address = results.resolve().as_uri() + "/report.html#paper"
    hint = f"apt install chromium, or name it in CHROMIUM, or print {address} in any browser"
    missing = f"Chromium is not installed, which prints the report\n  hint: {hint}"
    for variables, code, words in [
        ({"CHROMIUM": "/nowhere"}, 1, "CHROMIUM names no program: /nowhere"),
        ({"CHROMIUM": "", "PATH": "/nowhere"}, 1, missing),
        ({"CHROMIUM": shutil.which("false") or ""}, 2, "false ended with exit code 1"),
        ({"CHROMIUM": shutil.which("true") or ""}, 2, "true prints nothing"),
    ]:
        result = tribound(program, "report", str(results), "--pdf", directory=directory, **variables)
        assert result.returncode == code and words in result.stderr, result.stderr
    result = tribound(program, "report", str(results), directory=directory)
    assert result.returncode == 0 and address in result.stdout, result.stdout + result.stderr
    page = results / "report.html"
    page.write_text(page.read_text().replace('id="run-data">{', 'id="run-data">{{', 1))
    result = tribound(program, "report", str(results), "--pdf", directory=directory)
    assert result.returncode == 1, result.stderr
    assert "report.html: cannot be shown, so it is not printed" in result.stderr, result.stderr
    assert not pdf.exists()
    pdf.touch()
    tribound(program, *RUN, directory=directory)
    assert not pdf.exists(), "a run leaves the report of an earlier one"


def main() -> None:
    program, directory = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    if not any(name and shutil.which(name) for name in BROWSERS):
        skip("there is no chromium (Debian: chromium)")
    if not shutil.which("pdftotext"):
        skip("there is no pdftotext (Debian: poppler-utils)")
    if "built without" in printed_by(program, "info"):
        skip("the report page is not built")
    check_block(program, directory / "block")
    check_cube(program, directory / "cube")
    check_sweep(program, directory / "sweep")
    check_failures(program, directory / "block")


if __name__ == "__main__":
    main()
