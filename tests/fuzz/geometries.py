"""Trials of damaged CAD: a mesh, or a message that says what is wrong; no crash, no hang."""

import shutil
from pathlib import Path

from damage import damage_mesh
from program import misbehaviour, run
from random_cases import Dice

TIME_LIMIT = 60  # seconds


def trial(number, directory, program):
    """A cylinder with words, numbers and lines changed."""
    dice = Dice([number, 3])
    part = Path(directory) / "part.step"
    shutil.copy(Path(__file__).with_name("part.step"), part)
    damage_mesh(dice, part)
    meshed = run(program, ["mesh", part.name, "part.msh", "--size", "0.7"], directory, TIME_LIMIT)
    findings = misbehaviour(meshed, TIME_LIMIT)
    if findings:
        return "misbehaved", findings, {}
    written = (Path(directory) / "part.msh").exists()
    if meshed.code not in (0, 1) or written != (meshed.code == 0):
        return "misbehaved", [f"CODE: exit code {meshed.code}, mesh written: {written}"], {}
    return "meshed" if written else "refused", [], {}
