#!/usr/bin/python3
"""A cylinder on a plane, certified, against the theory of Hertz: the case file of example 03b, the pressure at the
points of contact, and a picture of both.

    hertz.py [PICTURE]      such as hertz.png
"""

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
import tribound as tb

CASE = Path(__file__).resolve().parent.parent / "03b_hertz_cylinder/case.toml"
E, NU, RADIUS, FORCE = 200e3, 0.3, 10.0, 200.0 * 20.0  # MPa, mm, N per mm of length

HALF_WIDTH = np.sqrt(4 * FORCE * RADIUS * (1 - NU**2) / (np.pi * E))
LARGEST = 2 * FORCE / (np.pi * HALF_WIDTH)


def theory(x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    pressure: npt.NDArray[np.float64] = LARGEST * np.sqrt(np.maximum(0, 1 - (x / HALF_WIDTH) ** 2))
    return pressure


def draw(level: tb.Level, picture: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    level.plot("von_mises", ax=left)
    contact = level.contact["contact"]
    x = np.linspace(0, 1.5 * HALF_WIDTH, 400)
    right.plot(x, theory(x), "k-", label="Hertz")
    right.plot(contact.x[:, 0], contact.pressure, ".", label="computed")
    right.set(xlim=(0, x[-1]), xlabel="x [mm]", ylabel="pressure [MPa]")
    right.legend()
    figure.savefig(picture, dpi=150)


def main() -> None:
    result = tb.run(tb.Case.read(CASE, set={"adapt.tolerance": 0.01}))
    contact = result.level.contact["contact"]
    touched = contact.x[contact.pressure > 0, 0].max()
    deviation = np.abs(contact.pressure - theory(contact.x[:, 0])).max() / LARGEST
    print(f"{result.status}: bound {result.relative:.2%}")
    print(f"largest pressure {contact.pressure.max():.0f} MPa, Hertz {LARGEST:.0f} MPa")
    print(f"half width {touched:.3f} mm, Hertz {HALF_WIDTH:.3f} mm")
    print(f"largest deviation of the pressure {deviation:.1%} of the largest pressure")
    assert result.is_certified
    assert abs(contact.pressure.max() / LARGEST - 1) < 0.02
    assert abs(touched / HALF_WIDTH - 1) < 0.05
    if len(sys.argv) > 1:
        draw(result.level, sys.argv[1])


if __name__ == "__main__":
    main()
