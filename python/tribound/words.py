"""Numbers and units as text, as on the report page."""

from collections.abc import Mapping
from math import floor, isfinite, log10
from typing import Any

SUPERSCRIPTS = str.maketrans("-0123456789.", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹·")
Units = Mapping[str, Any] | None


def superscript(number: float) -> str:
    return f"{number:g}".translate(SUPERSCRIPTS)


def unit(units: Units, kind: str) -> str:
    """The label of a kind of number, "" without one: mm^2 as mm², MPa mm^(3/2) as MPa mm¹·⁵."""
    return typeset((units or {}).get(kind))


def quantity_unit(units: Units, name: str) -> str:
    return typeset(((units or {}).get("quantities") or {}).get(name))


def typeset(label: str | None) -> str:
    text = label or ""
    for n in range(1, 10):
        text = text.replace(f"^({n}/2)", superscript(n / 2)).replace(f"^{n}", superscript(n))
    return text


def labelled(words: str, units: Units, kind: str) -> str:
    """Words with the unit of their kind in brackets, if the case names its units."""
    label = unit(units, kind)
    return f"{words} [{label}]" if label else words


def measured(text: str, label: str) -> str:
    return f"{text} {label}" if label else text


def number(value: float | None, digits: int = 4) -> str:
    """0.01234, 1.234×10⁻⁵; a dash where nothing is known."""
    if value is None or not isfinite(value):
        return "–"
    if value == 0:
        return "0"
    text = f"{value:.{digits - 1}e}"
    mantissa, exponent = text.split("e")
    if 1e-3 <= abs(value) < 1e5:
        decimals = max(0, digits - 1 - int(exponent))
        plain = f"{float(text):.{decimals}f}"
        return (plain.rstrip("0").rstrip(".") if "." in plain else plain).replace("-", "−")
    shown = mantissa.rstrip("0").rstrip(".").replace("-", "−")
    power = f"10{superscript(int(exponent))}"
    return power if shown == "1" else f"{shown}×{power}"


def percent(value: float | None) -> str:
    return "–" if value is None or not isfinite(value) else f"{number(100 * value, 3)}\u00a0%"


def count(value: int) -> str:
    """12 345"""
    return f"{value:,}".replace(",", "\u202f")


def plural(value: int, one: str, many: str = "") -> str:
    return f"{count(value)} {one if value == 1 else many or one + 's'}"


def seconds(value: float) -> str:
    if value < 0.1:
        return f"{number(1000 * value, 3)} ms"
    return f"{number(value, 3)} s" if value < 100 else f"{floor(value / 60)} min {round(value % 60)} s"


def round_factor(largest: float) -> float:
    """The largest of 1, 2, 5, 10, ... (or 0.5, 0.2, ...) that does not exceed a number > 0."""
    power = 10.0 ** floor(log10(largest))
    return power * max(digit for digit in (1, 2, 5) if digit * power <= largest)
