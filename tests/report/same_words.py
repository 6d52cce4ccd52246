#!/usr/bin/env python3
"""Compares what the certificate, the program and the page say about a run: verdict, reason and warnings.

    same_words.py PROGRAM CASES DIRECTORY

CASES: the folder of the test cases. The page is read as Chromium renders it. Exit code 77: there is no Chromium, or the
page is not built.
"""

import json
import os
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "cases"))
from runner import run, told, words  # noqa: E402

TIME_LIMIT = 120  # seconds
BROWSERS = [os.environ.get("CHROMIUM"), "chromium", "chromium-browser", "google-chrome"]
BROWSER_OPTIONS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-3d-apis", "--disable-dev-shm-usage"),
    "--virtual-time-budget=20000",
]
TITLES = {
    "certified": "Certified",
    "budget": "Budget used up",
    "not certified": "Not certified",
    "failed": "Failed",
}
FRICTION = 'boundary.bottom.contact={friction="coulomb", coefficient=1.5}'
SMALL = ["degree=2", "mesh.box.cells=[8, 4]"]
RIGID = [
    *(f"boundary.{side}={{displacement=[0.001, 0.002]}}" for side in ("left", "top", "right")),
    'boundary.bottom.contact={friction="coulomb", coefficient=0.3, gap=0.5}',
]

# name, overrides of t2d.toml, status, codes of expected warnings
RUNS = [
    ("certified", [*SMALL, "adapt.tolerance=0.2"], "certified", []),
    ("certified_with_warnings", ["adapt.tolerance=0.7", FRICTION], "certified", ["few_contact_facets"]),
    ("budget", [*SMALL, "adapt.max_levels=1"], "budget", []),
    ("budget_with_warnings", [*SMALL, "nitsche.gamma0=0.01", "adapt.max_levels=0"], "budget", ["penetration"]),
    ("without_stress", [*RIGID, "adapt.tolerance=0.2"], "certified", ["no_contact"]),
    ("not_certified", [*SMALL, "material.nu=0.4999999999"], "not certified", []),
    ("failed", ["newton.max_steps=1", 'newton.stopping="tolerance"'], "failed", []),
]


class Page(HTMLParser):
    """Texts of the page: verdicts, warnings, everything. A formula counts as its source text."""

    VOID = {"meta", "link", "br", "img", "input", "hr"}

    def __init__(self, html):
        super().__init__()
        self.verdicts, self.warnings, self.text = [], [], ""
        self._open = []
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        if tag in self.VOID:
            return
        attributes = dict(attributes)
        classes = (attributes.get("class") or "").split()
        kind = None
        if "warnings" in classes:
            kind = "box"
        elif "verdict" in classes:
            kind = "verdict"
            self.verdicts.append("")
        elif tag == "li" and any(kind == "box" for _, kind in self._open):
            kind = "warning"
            self.warnings.append("")
        elif tag in ("script", "style"):
            kind = "silent"
        elif tag == "math" and "alttext" in attributes:
            self._add(attributes["alttext"])
            kind = "silent"
        self._open.append((tag, kind))

    def handle_endtag(self, tag):
        while self._open and self._open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        self._add(data)

    def _add(self, text):
        kinds = [kind for _, kind in self._open]
        if "silent" in kinds:
            return
        self.text += text
        if "verdict" in kinds:
            self.verdicts[-1] += text
        if "warning" in kinds:
            self.warnings[-1] += text


def dump(browser, page, profile):
    result = subprocess.run(
        [browser, *BROWSER_OPTIONS, f"--user-data-dir={profile}", "--dump-dom", page.as_uri()],
        capture_output=True,
        text=True,
        timeout=TIME_LIMIT,
    )
    return Page(result.stdout)


def differences(status, codes, certificate, printed, page):
    """What the certificate says and the others do not, or what they say beyond it."""
    if certificate["status"] != status:
        yield f"the certificate says {certificate['status']!r}, expected {status!r}"
    for code in codes:
        if code not in [warning["code"] for warning in certificate["warnings"]]:
            yield f"the certificate does not warn of {code!r}"
    said = words(printed)
    if f"status {status}" not in said:
        yield f"the program does not print the status {status!r}"
    if len(page.verdicts) != 1:
        yield f"the page has {len(page.verdicts)} verdicts"
        return
    verdict = words(page.verdicts[0])
    if not verdict[1:].startswith(TITLES[status]):  # after the mark
        yield f"the page does not say {TITLES[status]!r} but {verdict!r}"
    if status == "failed" and "No solution was found" not in verdict:
        yield f"the page says of a failed run {verdict!r}"
    reason = words(certificate["reason"] or "")
    for name, text in (("program", said), ("page", verdict)):
        if reason.lower() not in text.lower():
            yield f"the {name} does not give the reason {reason!r}"
    if len(page.warnings) != len(certificate["warnings"]):
        yield f"the page has {len(page.warnings)} warnings, the certificate {len(certificate['warnings'])}"
    if sum(line.split()[:1] == ["warning"] for line in printed.splitlines()) != len(certificate["warnings"]):
        yield f"the program prints another number of warnings than {len(certificate['warnings'])}"
    for warning, shown in zip(certificate["warnings"], page.warnings):
        for part in (warning["where"], warning["text"]):
            for name, text in (("program", said), ("page", words(shown))):
                if part and words(part) not in text:
                    yield f"the {name} does not say {part!r}"
    if status in ("failed", "not certified") and "safety" in (printed + page.text).lower():
        yield f"a run that is {status} shows a factor of safety"


def main():
    program, cases, results = sys.argv[1], *map(Path, sys.argv[2:])
    browser = next((found for name in BROWSERS if name and (found := shutil.which(name))), None)
    info = run(program, "info").stdout
    if browser is None or "report page   /" not in info:
        print("skipped:", "there is no chromium (Debian: chromium)" if browser is None else "the report page is not built")
        return 77
    failed = 0
    for name, overrides, status, codes in RUNS:
        directory = results.resolve() / name
        shutil.rmtree(directory, ignore_errors=True)
        options = [part for override in [*overrides, f'output.directory="{directory}"'] for part in ("--set", override)]
        result = run(program, "run", str(cases / "t2d.toml"), *options)
        certificate = json.loads((directory / "certificate.json").read_text())
        page = dump(browser, directory / "report.html", results.resolve() / "profile")
        failed += told(name, differences(status, codes, certificate, result.stdout, page), "the same", "DIFFERENT")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
