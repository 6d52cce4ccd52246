#!/usr/bin/python3
"""A pressure that was measured at nine points, interpolated by NumPy: any function of Python can be a load. The
pressure on the floor adds up to the measured one."""

import numpy as np
import numpy.typing as npt
import tribound as tb

PLACES = np.linspace(0, 2, 9)
MEASURED = np.array([0.02, 0.05, 0.09, 0.14, 0.15, 0.13, 0.08, 0.04, 0.01])


def pressure(x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """x has the coordinates of n points in its rows, shape (2, n); the result has shape (n,)."""
    return np.interp(x[0], PLACES, MEASURED)


def main() -> None:
    case = tb.Case({
        "title": "Block under a measured pressure",
        "mesh": {"box": {"lower": [0, 0], "upper": [2, 1], "cells": [8, 4]}},
        "material": {"E": 1.0, "nu": 0.3},
        "boundary": {
            "left": {"displacement": [0, "free"]},
            "top": {"pressure": pressure},
            "bottom": {"contact": {"friction": "coulomb", "coefficient": 0.3}},
        },
        "adapt": {"tolerance": 0.01},
    })
    result = tb.run(case)
    floor = result.level.contact["bottom"]
    on_floor = float((floor.weight * floor.pressure).sum())
    on_top = float(np.trapz(MEASURED, PLACES))
    print(f"{result.status}: bound {result.relative:.2%}")
    print(f"pressure on the floor {on_floor:.6f}, on the top {on_top:.6f}")
    assert result.is_certified
    assert abs(on_floor - on_top) < 1e-6 * on_top  # equilibrium, up to what Newton's method leaves
    # What no program can see in a function, how it behaves between the points, the certificate names:
    print("not covered:", *result.certificate["not_covered"], sep="\n  ")


if __name__ == "__main__":
    main()
