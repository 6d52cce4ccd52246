#!/usr/bin/python3
"""How far a block is pulled along a floor, over the coefficient of friction. Each displacement comes with the
interval that is certain to contain it, with friction as large as the computed pressure makes it.

    friction_study.py [PICTURE]      also draws the curve with its error bars, such as study.png
"""

import sys
from typing import Any

import numpy as np
import numpy.typing as npt
import tribound as tb

CASE: dict[str, Any] = {
    "title": "Block pulled along a floor",
    "mesh": {"box": {"lower": [0, 0], "upper": [2, 1], "cells": [8, 4]}},
    "material": {"E": 1.0, "nu": 0.3},
    "boundary": {
        "left": {"displacement": [0, 0]},
        "top": {"traction": [0, -0.1]},
        "right": {"traction": [0.06, 0.0]},
        "bottom": {"contact": {"friction": "coulomb", "coefficient": 0.3}},
    },
    "quantity": [{"name": "pull", "kind": "mean_displacement", "boundary": "right", "direction": [1, 0]}],
    "adapt": {"tolerance": 0.05, "goal": "pull", "goal_tolerance": 0.01},
}


def draw(coefficients: list[float], bars: npt.NDArray[np.float64], picture: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    lower, value, upper = bars.T
    _, axes = pyplot.subplots(figsize=(6, 4))
    axes.errorbar(coefficients, value, yerr=(value - lower, upper - value), capsize=4, marker=".")
    axes.set(xlabel="coefficient of friction", ylabel="mean displacement of the right side", ylim=(0, None))
    pyplot.savefig(picture, dpi=150, bbox_inches="tight")


def main() -> None:
    coefficients = [0.1, 0.2, 0.3, 0.4, 0.5]
    rows = []
    for coefficient in coefficients:
        result = tb.run(tb.Case(CASE), set={"boundary.bottom.contact.coefficient": coefficient})
        pull = result.quantities["pull"]
        assert pull.value is not None and pull.lower is not None and pull.upper is not None, result.reason
        assert result.is_certified and pull.lower <= pull.value <= pull.upper
        print(f"mu = {coefficient}: {pull.value:.4f} in [{pull.lower:.4f}, {pull.upper:.4f}]")
        rows.append((pull.lower, pull.value, pull.upper))
    bars = np.array(rows)
    assert (bars[1:, 1] < bars[:-1, 1]).all(), "more friction, less displacement"
    if len(sys.argv) > 1:
        draw(coefficients, bars, sys.argv[1])


if __name__ == "__main__":
    main()
