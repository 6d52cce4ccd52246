"""Tribound: certified frictional contact.

    import tribound as tb

    result = tb.run(tb.Case.read("case.toml"))
    result.status, result.relative, result.level.displacement
"""

from tribound import _tribound
from tribound.case import Case, Function
from tribound.errors import InputError, SolveError, WriteError
from tribound.judge import Judgement, judge
from tribound.level import Contact, Level, Probe, Resultant, Section
from tribound.mesh import Mesh, MeshArrays
from tribound.result import Quantity, Result, Step, Study, Verification
from tribound.run import check, levels, run, study, verify
from tribound.sweep import sweep

__version__: str = _tribound.version

__all__ = [
    "Case",
    "Contact",
    "Function",
    "InputError",
    "Judgement",
    "Level",
    "Mesh",
    "MeshArrays",
    "Probe",
    "Quantity",
    "Result",
    "Resultant",
    "Section",
    "SolveError",
    "Step",
    "Study",
    "Verification",
    "WriteError",
    "check",
    "judge",
    "levels",
    "run",
    "study",
    "sweep",
    "verify",
]
