"""Starts the program as a user would, with limits, and reports what is wrong whatever the exit code."""

import os
import re
import resource
import signal
import subprocess
import time
from dataclasses import dataclass

TIME_LIMIT = 60  # seconds of CPU time; the limit of wall time is PATIENCE times as long, as the machine may be busy
PATIENCE = 10
MEMORY = 8 << 30  # bytes; protects the machine
SINGLE = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1"}
ENVIRONMENT = os.environ | SINGLE | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
# What the underlying libraries print when they end a program.
DUMP = re.compile(
    r"PETSC ERROR|MPI_Abort|terminate called|what\(\):|Assertion .* failed|Sanitizer|malloc|stack smashing"
    r"|(?<!signal 11 \()Segmentation"  # the program reports one in Gmsh's process itself
    r"|^\[[\w.-]+:\d+\]",
    re.MULTILINE | re.IGNORECASE,
)

CRASHED = "tribound: crashed"  # printed by its own signal handler, with exit code 2


@dataclass
class Run:
    code: int | None  # None: it did not end
    out: str
    err: str
    seconds: float


def limits(seconds):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))


def start(program, arguments, directory, limit=TIME_LIMIT):
    if arguments[0] == "run" and not any("output.directory" in argument for argument in arguments):
        arguments = [*arguments, "--set", "output.directory=out"]
    return subprocess.Popen(
        [program, *arguments],
        cwd=directory,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=ENVIRONMENT,
        start_new_session=True,
        preexec_fn=lambda: limits(limit),
    )


def run(program, arguments, directory, limit=TIME_LIMIT):
    began = time.monotonic()
    with start(program, arguments, directory, limit) as process:
        try:
            out, err = process.communicate(timeout=PATIENCE * limit)
            code = process.returncode
            if code in (-signal.SIGXCPU, -signal.SIGKILL):
                code = None
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            out, err = process.communicate()
            code = None
    return Run(code, out.decode(errors="replace"), err.decode(errors="replace"), time.monotonic() - began)


def misbehaviour(result, limit=TIME_LIMIT):
    """Findings that do not depend on the command."""
    if result.code is None:
        return [f"HANG: not ended after {limit} s of CPU, or {PATIENCE * limit} s"]
    if result.code not in (0, 1, 2, 3):
        return [f"CRASH: exit code {result.code}: {tail(result.err)}"]
    if CRASHED in result.err:
        return [f"CRASH: {tail(result.err)}"]
    if match := DUMP.search(result.err):
        return [f"DUMP: stderr holds {match.group()!r}: {tail(result.err)}"]
    if result.code == 1:
        return message_defects(result.err)
    return []


def message_defects(err):
    """A message says where the mistake is, and what is wrong."""
    lines = [line for line in err.splitlines() if line.strip()]
    if not lines:
        return ["MESSAGE: exit code 1 without a message"]
    place = re.match(r"tribound: (\S.*?): (\S.*)", lines[0])
    if not place or len(place[2]) < 8:
        return [f"MESSAGE: without place or reason: {tail(err)}"]
    return []


def tail(text, length=300):
    return repr(text.strip()[-length:])
