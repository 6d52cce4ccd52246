#!/usr/bin/env python3
"""Compares what the program says about its command line with its manual and with what shells complete.

    command_line.py PROGRAM MANUAL BASH_COMPLETION ZSH_COMPLETION

Every command and every option of --help must be in the manual and in both completions, and bash must complete nothing else.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path


def printed(*arguments):
    return subprocess.run(arguments, capture_output=True, text=True, check=True, timeout=60).stdout


def commands(program):
    """The names in the lists of commands, which end where the examples begin."""
    text = printed(program, "--help").split("Examples:")[0]
    names = re.findall(r"^  ([a-z]\w*)\s{2,}\S", text, re.MULTILINE)
    if len(names) < 5:
        raise SystemExit(f"command_line: found only the commands {names} in\n{text}")
    return names


def options(program, *command):
    """The options of a command, all spellings."""
    text = printed(program, *command, "--help").split("Examples:")[0]
    lines = [line for line in text.splitlines() if line.startswith("  -")]
    return sorted({option for line in lines for option in re.findall(r"(?<![\w-])--?[a-z]+", line.split("   ")[0])})


def manual_text(file):
    """The manual without roff's escapes."""
    return re.sub(r"\\f[BIRP]", "", file.read_text().replace("\\-", "-"))


def section(text, name):
    return re.search(rf"^\.SH {name}\n(.*?)(?=^\.SH |\Z)", text, re.MULTILINE | re.DOTALL).group(1)


def manual_differences(program, file):
    text = manual_text(file)
    for command in commands(program):
        if not re.search(rf"^\.BI? {command}\b", section(text, "COMMANDS"), re.MULTILINE):
            yield f"the manual has no command {command}"
        for option in options(program, command):
            if not re.search(rf"(?<![\w-]){option}\b", section(text, "OPTIONS")):
                yield f"the manual has no option {option} of {command}"
    for option in options(program):
        if option not in section(text, "OPTIONS"):
            yield f"the manual has no option {option}"
    for code in range(4):
        if f"\n.B {code}\n" not in section(text, "EXIT STATUS"):
            yield f"the manual has no exit code {code}"
    if shutil.which("man"):
        result = subprocess.run(
            ["man", "--warnings", "-l", file], capture_output=True, text=True, env=os.environ | {"MANPAGER": "cat"}
        )
        if result.returncode or result.stderr:
            yield f"man says\n{result.stderr}"


def completed(file, *words):
    """What bash completes after the words, the last of which is being typed."""
    script = (
        f'source "{file}"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tribound; printf "%s\\n" "${{COMPREPLY[@]}}"'
    )
    return printed("bash", "-c", script, "bash", "tribound", *words).split()


def bash_differences(program, file):
    if (found := completed(file, "")) != [*commands(program), "--help", "--version"]:
        yield f"bash completes {found}, expected the commands {commands(program)}"
    if completed(file, "ver") != ["verify"]:
        yield "bash does not complete ver to verify"
    if "tribound" not in printed("bash", "-c", f'source "{file}"; complete -p tribound'):
        yield "bash knows no completion of tribound"
    for command in commands(program):
        expected = sorted(option for option in options(program, command) if option.startswith("--"))
        if sorted(completed(file, command, "--")) != expected:
            yield f"bash completes {completed(file, command, '--')} after {command}, expected {expected}"


def zsh_differences(program, file):
    text = file.read_text()
    for command in commands(program):
        if f"'{command}:" not in text or not re.search(rf"^  ([a-z|]*\|)?{command}(\|[a-z|]*)?\)", text, re.MULTILINE):
            yield f"the completion for zsh has no {command}"
        for option in options(program, command):
            if option not in text:
                yield f"the completion for zsh has no {option} of {command}"
    if shutil.which("zsh"):
        subprocess.run(["zsh", "-n", file], check=True)


def main():
    program, manual, bash_completion, zsh_completion = sys.argv[1:]
    problems = [
        *manual_differences(program, Path(manual)),
        *bash_differences(program, Path(bash_completion)),
        *zsh_differences(program, Path(zsh_completion)),
    ]
    print(*problems or ["manual and completions agree with the program"], sep="\n")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
