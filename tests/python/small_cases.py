"""Results that several tests look at."""

from functools import lru_cache
from typing import Any

import tribound as tb

UNITS = {"length": "mm", "force": "N"}


def block(dimension: int, degree: int, **more: Any) -> dict[str, Any]:
    """A block on a rigid floor with Coulomb friction; `more`: further tables of the case."""
    upper, cells = ([2, 1], [8, 4]) if dimension == 2 else ([2, 1, 1], [3, 2, 2])
    zero = [0.0] * dimension
    return {
        "title": "Block",
        "degree": degree,
        "mesh": {"box": {"lower": zero, "upper": upper, "cells": cells}},
        "material": {"E": 1.0, "nu": 0.3},
        "boundary": {
            "left": {"displacement": zero},
            "top": {"traction": [0, -0.1, 0][:dimension]},
            "right": {"traction": [0.06, 0.04, 0][:dimension]},
            "bottom": {"contact": {"friction": "coulomb", "coefficient": 0.5, "gap": 0}},
        },
        "adapt": {"tolerance": 0.02 if dimension == 2 else 0.5, "max_levels": 12},
        **more,
    }


def two_boxes(lower: list[int], upper: list[int], **more: Any) -> dict[str, Any]:
    """A box on another one, each with so many cells, pressed together without friction."""
    return {
        "degree": 2,
        "mesh": {"boxes": {
            "lower": {"lower": [0, 0], "upper": [2, 1], "cells": lower},
            "upper": {"lower": [0, 1], "upper": [2, 2], "cells": upper},
        }},
        "material": {"E": 1.0, "nu": 0.3},
        "boundary": {"lower.bottom": {"displacement": [0, 0]}, "upper.top": {"displacement": [0, -0.01]}},
        "contact": [{"slave": "upper.bottom", "master": "lower.top", "friction": "none", "gap": 0}],
        **more,
    }


@lru_cache(maxsize=None)
def solved(dimension: int, degree: int) -> tb.Result:
    return tb.run(block(dimension, degree, units=UNITS))
