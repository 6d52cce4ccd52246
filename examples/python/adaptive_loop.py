#!/usr/bin/python3
"""An adaptive loop of its own: the load is a function, cells in which the contact changes are refined, too, and
the loop ends when the friction force has settled. The program examples/cpp/own_loop.cpp in Python; it finds the
same numbers."""

import numpy as np
import numpy.typing as npt
import tribound as tb

CASE = tb.Case({
    "degree": 2,
    "mesh": {"box": {"lower": [0, 0], "upper": [2, 1], "cells": [8, 4]}},
    "material": {"E": 1.0, "nu": 0.3},
    "boundary": {
        "left": {"displacement": [0, "free"]},
        # Of a polynomial the bound needs only the degree.
        "top": {"traction": [0, tb.Function(lambda x: -0.1 * x[0] * (2 - x[0]), degree=2)]},
        "bottom": {"contact": {"friction": "coulomb", "coefficient": 0.2}},
    },
    "adapt": {"tolerance": 1e-6, "max_dofs": 200_000},  # never reached: the rule below ends the loop
})


def friction(level: tb.Level) -> float:
    """The force with which the floor holds the block back."""
    floor = level.contact["bottom"]
    return float((floor.weight * floor.traction[:, 0]).sum())


def mark(level: tb.Level) -> npt.NDArray[np.bool_]:
    """Every cell with at least half of the largest indicator, and those where the contact changes."""
    floor = level.contact["bottom"]
    marked: npt.NDArray[np.bool_] = level.eta >= 0.5 * level.eta.max()
    for cell in np.unique(floor.cell):
        marked[cell] |= np.ptp(floor.status[floor.cell == cell]) > 0
    return marked


def main() -> None:
    forces: list[float] = []

    def stop(level: tb.Level) -> str:
        assert level.relative is not None
        forces.append(friction(level))
        print(f"level {level.number:2d}: {len(level.mesh.cells):5d} cells, "
              f"bound {100 * level.relative:6.3f} %, friction {forces[-1]:.6f}")
        last = np.array(forces[-4:])
        settled = len(last) == 4 and (np.abs(np.diff(last)) < 1e-4 * np.abs(last[1:])).all()
        return "the friction force has settled" if settled else ""

    result = tb.run(CASE, mark=mark, stop=stop)
    print(f"{result.status}: {result.reason}")
    assert result.bound is not None and "settled" in result.reason


if __name__ == "__main__":
    main()
