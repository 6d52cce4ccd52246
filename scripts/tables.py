"""What scripts/pictures, scripts/choosing and scripts/validation share: runs of the program, and tables of Markdown.

Each of them replaces what stands between the lines

    <!-- begin NAME: made by scripts/SCRIPT -->
    <!-- end NAME -->

of a Markdown file by tables of fresh runs, or with --check compares: text must be equal, numbers must agree to a
tolerance; columns of seconds and of deviations are not compared.
"""

import argparse
import csv
import json
import re
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
NOT_COMPARED = re.compile("seconds|deviation")  # in the header of a column
TIME_LIMIT = 1800  # seconds, of one run
ROUNDING = 1e-12  # smaller numbers are not compared
VERDICTS = (0, 3)  # exit codes with a valid bound


def cpu_seconds():
    """Of all programs that were run so far: on a machine shared with others, wall time says little."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Result:
    """What a run has left: its certificate, the rows of its tables, what it printed, and the CPU seconds it took."""

    def __init__(self, directory, printed, seconds):
        self.certificate = json.loads((directory / "certificate.json").read_text())
        self.levels = self.rows(directory / "convergence.csv")
        self.steps = self.rows(directory / "newton.csv")
        self.contact = self.rows(directory / "contact.csv")
        self.printed = printed
        self.seconds = f"{seconds:.2g}" if seconds < 10 else f"{seconds:.0f}"

    @staticmethod
    def rows(file):
        if not file.exists():
            return []
        with file.open(newline="") as stream:
            return list(csv.DictReader(stream))


class Program:
    def __init__(self, path):
        self.path = Path(path).resolve()
        if not self.path.is_file():
            raise SystemExit(f"{self.path} does not exist: cmake --preset release && cmake --build --preset release")

    def run(self, case, *assignments, directory=None, verdicts=VERDICTS):
        """Runs a case, a path below the root of the project; without a directory the results are kept in memory only."""
        if directory is None:
            with tempfile.TemporaryDirectory() as scratch:
                return self.run(case, "output.vtu=false", *assignments, directory=Path(scratch), verdicts=verdicts)
        arguments = [self.path, "run", case, "--set", f'output.directory="{Path(directory).resolve()}"']
        for assignment in assignments:
            arguments += ["--set", assignment]
        before = cpu_seconds()
        process = subprocess.run(arguments, capture_output=True, text=True, timeout=TIME_LIMIT, cwd=ROOT)
        if process.returncode not in verdicts:
            raise SystemExit(f"{case} {' '.join(assignments)}: exit code {process.returncode}\n{process.stderr}")
        return Result(Path(directory), process.stdout, cpu_seconds() - before)


def table(columns, rows):
    """A table of Markdown; a column whose name ends in "|" is aligned to the left."""
    lines = ["| " + " | ".join(name.rstrip("|") for name in columns) + " |"]
    lines.append("|" + "|".join("---" if name.endswith("|") else "---:" for name in columns) + "|")
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def section(name):
    """The lines around a generated piece, and the piece."""
    return re.compile(rf"(<!-- begin {re.escape(name)}: [^\n]*-->\n)(.*?)(<!-- end {re.escape(name)} -->)", re.S)


def cells(text):
    """Lines of words and numbers without the columns that are not compared."""
    skipped = set()
    for line in text.splitlines():
        if not line.startswith("|"):
            skipped = set()
            yield [" ".join(line.split())]
            continue
        parts = [part.strip() for part in line.strip("|").split("|")]
        skipped = skipped or {i for i, part in enumerate(parts) if NOT_COMPARED.search(part)}
        yield [part for i, part in enumerate(parts) if i not in skipped]


def differences(old, new, tolerance):
    """Yields how two texts differ: numbers by more than the tolerance, or anything else."""
    old_lines, new_lines = list(cells(old)), list(cells(new))
    if len(old_lines) != len(new_lines):
        yield f"{len(old_lines)} lines, now {len(new_lines)}"
    for before, after in zip(old_lines, new_lines):
        for a, b in zip(before, after):
            numbers_a, numbers_b = ([float(number) for number in NUMBER.findall(text)] for text in (a, b))
            near = len(numbers_a) == len(numbers_b) and all(
                abs(x - y) <= tolerance * max(abs(x), abs(y)) + ROUNDING for x, y in zip(numbers_a, numbers_b)
            )
            if not near or NUMBER.sub("", a) != NUMBER.sub("", b):
                yield f"{a!r}, now {b!r}"


def update(file, pieces, check=False, tolerance=0.05):
    """Replaces the pieces, name -> text, in a file below the root of the project, or checks them; returns what differs."""
    path = ROOT / file
    text, problems = path.read_text(), []
    for name, new in pieces.items():
        if not (match := section(name).search(text)):
            raise SystemExit(f"{file} has no lines <!-- begin {name}: ... --> and <!-- end {name} -->")
        if check:
            problems += [f"{file}, {name}: {difference}" for difference in differences(match.group(2), new, tolerance)]
        else:
            text = text[: match.start(2)] + new + text[match.end(2) :]
    if not check:
        path.write_text(text)
    return problems


def finish(problems):
    """The exit code of a script."""
    for problem in problems:
        print(problem)
    return 1 if problems else 0


def arguments(description, **options):
    """The command line of the scripts: --program, --check and further options."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--program", default=ROOT / "build/release/app/tribound", help="default: that of preset release")
    parser.add_argument("--check", action="store_true", help="compare with what is written instead of writing")
    for name, settings in options.items():
        parser.add_argument(f"--{name}", **settings)
    return parser.parse_args()
