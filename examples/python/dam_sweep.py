#!/usr/bin/python3
"""The gravity dam of example 05 over the level of the reservoir: how safe it is against sliding, which statics
knows, and how much of its base opens, which it does not.

    dam_sweep.py [JOBS]      that many runs at a time
"""

import sys
from pathlib import Path

import numpy as np
import tribound as tb

CASE = Path(__file__).resolve().parent.parent / "05_dam/case.toml"
WATER = {"parameters.level": 50, "boundary.upstream.pressure": "1000*9.81*1e-6*max(0, level - y)"}
WEIGHT = 2400 * 9.81e-6 * 50 * (5 + 45) / 2  # MN per metre of dam


def main() -> None:
    jobs = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    levels = np.array([20.0, 30.0, 40.0, 45.0, 50.0])
    table = tb.sweep(tb.Case.read(CASE, set=WATER), {"level": levels}, jobs=jobs)

    thrust = 1000 * 9.81e-6 * levels**2 / 2
    by_hand = 0.75 * WEIGHT / thrust
    lower, upper = (table[f"quantity.safety_factor base.{end}"] for end in ("lower", "upper"))
    print("level   status      bound   safety   by hand   opened")
    for i, level in enumerate(levels):
        print(f"{level:4.0f} m  {table['status'][i]}  {table['relative'][i]:6.2%}  "
              f"{lower[i]:6.3f}  {by_hand[i]:8.3f}  {table['opened'][i]:6.2f} m")
    assert (table["status"] == "certified").all()
    assert np.allclose(lower, by_hand, rtol=1e-9) and np.allclose(upper, by_hand, rtol=1e-9)
    assert (np.diff(table["opened"]) >= 0).all()  # the higher the water, the longer the crack at the heel


if __name__ == "__main__":
    main()
