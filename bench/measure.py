"""CPU time, wall time and memory of whole commands; used by bench/adapt and bench/peers/compare."""

import os
import subprocess
import sys
from dataclasses import dataclass


@dataclass
class Measured:
    cpu: float  # seconds, user and system
    wall: float  # seconds
    memory: int  # bytes, largest resident
    printed: str


def measure(command, exit_codes=(0,), **environment):
    """Runs a command with additional variables of the environment; ends the program for other exit codes."""
    begin = os.times().elapsed
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ | environment)
    printed = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in exit_codes:
        sys.exit(f"{' '.join(map(str, command))} ended with exit code {process.returncode}\n{printed}")
    wall = os.times().elapsed - begin
    return Measured(usage.ru_utime + usage.ru_stime, wall, 1024 * usage.ru_maxrss, printed)
