"""Starts the program for the tests of whole cases."""

import os
import subprocess

TIME_LIMIT = 600  # seconds per run on a busy machine
ENVIRONMENT = os.environ | {"OMPI_MCA_ess_singleton_isolated": "1"}  # MPI does without files


def run(program, *arguments, **options):
    """The finished program with its output; `options` of subprocess.run replace these."""
    defaults = {"capture_output": True, "text": True, "timeout": TIME_LIMIT, "env": ENVIRONMENT}
    if "stdout" in options or "stderr" in options:
        defaults |= {"capture_output": False, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.run([program, *arguments], **(defaults | options))


def told(name, problems, right, wrong):
    """Prints the outcome of a run and each of its problems; returns whether there are any."""
    problems = list(problems)
    print(f"{name}: {wrong if problems else right}")
    for problem in problems:
        print(f"  {problem}")
    return bool(problems)


def words(text):
    """The text with single spaces, however it was wrapped."""
    return " ".join(text.split())
