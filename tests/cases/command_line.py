#!/usr/bin/env python3
"""Compares the program's help with its manual and with the completions of shells.

    command_line.py PROGRAM MANUAL BASH_COMPLETION ZSH_COMPLETION OUTPUT_PAGE

Every command and every option of --help must be in the manual and in its synopsis. Every file of the page docs/output.md
must be in its list of files. bash, and zsh where it is installed, must complete the commands, their options and the case
files, and nothing else.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path


def printed(*arguments, directory=None):
    return subprocess.run(arguments, capture_output=True, text=True, check=True, timeout=60, cwd=directory).stdout


@cache
def commands(program):
    """The names in the lists of commands, which end where the examples begin."""
    text = printed(program, "--help").split("Examples:")[0]
    names = re.findall(r"^  ([a-z]\w*)\s{2,}\S", text, re.MULTILINE)
    if len(names) < 5:
        raise SystemExit(f"command_line: found only the commands {names} in\n{text}")
    return names


@cache
def spellings(program, *command):
    """The options of a command, in all their spellings."""
    text = printed(program, *command, "--help").split("Examples:")[0]
    lines = [line.split("   ")[0] for line in text.splitlines() if line.startswith("  -")]
    return [re.findall(r"(?<![\w-])--?[a-z][a-z-]*", line) for line in lines]


def options(program, *command):
    return sorted({name for names in spellings(program, *command) for name in names})


def manual_text(file):
    """The manual without roff's escapes."""
    return re.sub(r"\\f[BIRP]", "", file.read_text().replace("\\-", "-"))


def section(text, name):
    return re.search(rf"^\.SH {name}\n(.*?)(?=^\.SH |\Z)", text, re.MULTILINE | re.DOTALL).group(1)


def synopsis_differences(program, text):
    synopses = dict(re.findall(r"^\.B tribound (\w+)\n(.*?)(?=^\.br|\Z)", section(text, "SYNOPSIS"), re.MULTILINE | re.DOTALL))
    for command in commands(program):
        for names in spellings(program, command):
            if "--help" not in names and not set(names) & set(re.findall(r"--?[a-z][a-z-]*", synopses.get(command, ""))):
                yield f"the synopsis of {command} has no option {names[-1]}"


def file_differences(text, page):
    """Files and directories in the first column of the page's tables."""
    for table in re.findall(r"^\| file \| contents \|\n(.*?)\n\n", page.read_text(), re.MULTILINE | re.DOTALL):
        for row in table.splitlines():
            for name in re.findall(r"`([^`]+)`", row.split("|")[1].replace("0001", "NNNN").replace("0002", "NNNN")):
                if not re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.]\w)", section(text, "FILES")):
                    yield f"the manual has no file {name}"


def manual_differences(program, file, page):
    text = manual_text(file)
    yield from synopsis_differences(program, text)
    yield from file_differences(text, page)
    for command in commands(program):
        if not re.search(rf"^\.BI? {command}\b", section(text, "COMMANDS"), re.MULTILINE):
            yield f"the manual has no command {command}"
        for option in options(program, command):
            if not re.search(rf"(?<![\w-]){option}\b", section(text, "OPTIONS")):
                yield f"the manual has no option {option} of {command}"
    for option in options(program):
        if option not in section(text, "OPTIONS"):
            yield f"the manual has no option {option}"
    for code in range(5):
        if f"\n.B {code}\n" not in section(text, "EXIT STATUS"):
            yield f"the manual has no exit code {code}"
    if shutil.which("man"):
        result = subprocess.run(
            ["man", "--warnings", "-l", file], capture_output=True, text=True, env=os.environ | {"MANPAGER": "cat"}
        )
        if result.returncode or result.stderr:
            yield f"man says\n{result.stderr}"


def bash_completed(file, directory, lines):
    """What bash completes at the end of each line; words are split at single spaces."""
    script = (
        f'source "{file}"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tribound; printf "%s\\n" "${{COMPREPLY[@]}}"'
    )
    return {line: printed("bash", "-c", script, "bash", *line.split(" "), directory=directory).split() for line in lines}


def zsh_completed(file, directory, lines):
    """The same for zsh, which gives only the last part of a path."""
    script = Path(__file__).with_name("zsh_completion.zsh").resolve()
    found = {line: [] for line in lines}
    for match in printed("zsh", "-f", script, file.parent, *lines, directory=directory).splitlines():
        if match:
            line, word = match.split("\t")
            path = line.split(" ")[-1]
            found[line].append(path[: path.rfind("/") + 1] + word)
    return found


def expected_completions(program):
    """The words that belong at the end of a line, without -h and -q, which zsh offers too."""
    expected = {
        "tribound ": [*commands(program), "--help", "--version"],
        "tribound ver": ["verify"],
        "tribound init d": ["dam"],
        "tribound init --directory ": ["folder"],
        "tribound verify --refinements ": list("12345"),
        "tribound run --set ": [],
        "tribound sweep --jobs ": list("1248"),
        "tribound judge --solution ": ["folder", "theirs.vtu"],
        "tribound judge --number ": [],
        "tribound report ": ["folder"],
    }
    for command in commands(program):
        expected[f"tribound {command} --"] = [o for o in options(program, command) if o.startswith("--")]
    for command in ["check", "run", "sweep", "judge", "verify", "study"]:
        expected[f"tribound {command} ca"] = ["case.toml"]
    expected["tribound mesh ca"] = ["case.toml", "cave.txt"]
    for command in ["check", "run", "judge", "verify", "study"]:
        expected[f"tribound {command} --quiet folder/"] = ["folder/inner.toml"]
    return expected


def completion_differences(program, shell, completed, file):
    expected = expected_completions(program)
    with tempfile.TemporaryDirectory() as directory:
        (Path(directory) / "folder").mkdir()
        for name in ["case.toml", "cave.txt", "theirs.vtu", "folder/inner.toml"]:
            (Path(directory) / name).touch()
        found = completed(file, directory, expected)
    for line, words in expected.items():
        offered = sorted(set(found[line]) - {"-h", "-q"})
        if offered != sorted(words):
            yield f'{shell} completes "{line}" to {offered}, expected {words}'


def bash_differences(program, file):
    yield from completion_differences(program, "bash", bash_completed, file)
    if "tribound" not in printed("bash", "-c", f'source "{file}"; complete -p tribound'):
        yield "bash knows no completion of tribound"


def zsh_differences(program, file):
    if shutil.which("zsh"):
        yield from completion_differences(program, "zsh", zsh_completed, file)
    else:
        print("zsh is not installed: its completion is not tested")


def main():
    program, manual, bash_completion, zsh_completion, page = (Path(argument).resolve() for argument in sys.argv[1:])
    problems = [
        *manual_differences(program, manual, page),
        *bash_differences(program, bash_completion),
        *zsh_differences(program, zsh_completion),
    ]
    print(*problems or ["manual and completions agree with the program"], sep="\n")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
