"""The verdict of a result for notebooks and terminals, in the words of the report page.

The style is inline and its colours suit light and dark pages: notebooks may drop style sheets.
"""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any, NamedTuple

from tribound.result import Result
from tribound.words import Units, count, measured, number, percent, plural, quantity_unit, seconds, unit

Record = Mapping[str, Any]

GOOD, WARN, BAD = "38,143,88", "196,120,16", "205,62,52"  # red, green, blue
VERDICTS = {
    "certified": ("Certified", "✓", GOOD),
    "budget": ("Budget used up", "!", WARN),
    "not certified": ("Not certified", "×", BAD),
    "failed": ("Failed", "×", BAD),
}
TARGETS = {
    "solution": "from the exact solution",
    "tresca_with_computed_threshold": "for the computed friction threshold",
}
RULE = "1px solid rgba(128,128,128,.3)"
SOFT = "opacity:.72"
STAGES = ("setup", "solve", "certify", "bisect", "discretise", "transfer", "output")
QUANTITIES = 6  # more are in the table and on the page


class Figure(NamedTuple):
    value: str
    name: str
    note: str = ""


def _is_solved(run: Record) -> bool:
    return run["status"] in ("certified", "budget")


def _sentence(text: str | None) -> str:
    return f"{text[0].upper()}{text[1:]}." if text else ""


def _share(run: Record) -> tuple[str, str]:
    """What the bound is a share of, and how large it is."""
    if run.get("steps"):
        worst = max(step["relative_path"] or 0 for step in run["steps"])
        return "In every load step the error", f"{percent(worst)} of the largest norm of the stress up to it"
    if run["relative"] is None:
        size = measured(number(run["bound"]), unit(run["units"], "stress_norm"))
        return "The error", f"{size} of a stress that is zero"
    return "The error", f"{percent(run['relative'])} of the norm of the stress"


def guarantee(run: Record) -> str:
    """What is guaranteed, in a sentence or two, from the certificate."""
    reason = run["reason"]
    if run["status"] == "not certified":
        return f"A solution was computed, but nothing is guaranteed of its error: {reason}."
    if not _is_solved(run):
        return f"No solution was found: {reason or 'unknown reason'}."
    if run["status"] == "certified" and run["relative"] is None and not run.get("steps"):
        return "The stress is zero up to rounding, and so is the bound of its error."
    who, share = _share(run)
    asked = f"{percent(run['tolerance'])} was asked for."
    text = f"{who}, measured by the dual norm of the residual, is guaranteed to be at most {share}; {asked}"
    return text if run["status"] == "certified" else f"{text} {_sentence(reason)}"


def interval(quantity: Record, label: str) -> str:
    """between 1.63 and 1.66 N; or as much as is known."""
    if quantity["reason"] or quantity["exact"]:
        return ", ".join(filter(None, [label, "no error bar" if quantity["reason"] else "exact"]))
    return measured(f"between {number(quantity['lower'], 5)} and {number(quantity['upper'], 5)}", label)


def _figures(run: Record) -> Iterable[Figure]:
    units = run["units"]
    if run.get("relative") is not None:
        size = measured(number(run["bound"]), unit(units, "stress_norm"))
        yield Figure(percent(run["relative"]), "bound of the error", size)
    energy = run.get("energy_error") or {}
    if energy.get("relative"):
        target = TARGETS[energy["guaranteed_for"]]
        yield Figure(percent(energy["relative"]), "error in the energy norm, at most", target)
    if _is_solved(run):
        for quantity in (run.get("quantities") or [])[:QUANTITIES]:
            bar = interval(quantity, quantity_unit(units, quantity["name"]))
            yield Figure(number(quantity["value"], 5), quantity["name"], bar)
        yield Figure(number(run["max_displacement"]), "largest displacement", unit(units, "length"))
    size = f"{plural(run['dofs'], 'unknown')}, {plural(len(run['levels']), 'mesh', 'meshes')}"
    yield Figure(count(run["cells"]), "cells", size)
    yield Figure(seconds(_time(run)), "computing time")


def _time(run: Record) -> float:
    """Of all stages; `times` has a count and times of processors, too."""
    total: float = sum(run["times"][stage] for stage in STAGES)
    return total


def _kind(run: Record) -> str:
    contact = f"friction: {run['friction']}" if run["friction"] else "no contact"
    return f"{run['file']} · {run['d']}D, degree {run['p']}, {contact}"


CARD = (
    f"max-width:62em;line-height:1.45;border:{RULE};border-radius:8px;overflow:hidden;"
    "font-variant-numeric:tabular-nums;"
    "font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif"
)
MARK = "flex:none;width:1.7em;line-height:1.7em;align-self:start;border-radius:50%;text-align:center"
TITLE = "font-size:1.25em;font-weight:650;padding:.5em .8em 0"
FIGURES = "display:flex;flex-wrap:wrap;gap:.9em 1.9em;padding:.8em 1em .9em"


def html(result: Result) -> str:
    """The card of a result, for a notebook."""
    run = result.certificate
    title, mark, tone = VERDICTS[run["status"]]
    circle = _box("span", f"{MARK};color:#fff;background:rgb({tone})", mark)
    strong = _box("strong", "font-size:1.08em", title)
    words = _box("div", "", strong, _box("div", "", escape(guarantee(run))))
    parts = [
        _box("div", TITLE, escape(run["title"] or run["file"])),
        _box("div", f"font-size:.86em;padding:0 1.16em .6em;{SOFT}", escape(_kind(run))),
        _box("div", f"display:flex;gap:.8em;{_band(tone)}", circle, words),
    ]
    if run.get("warnings"):
        parts.append(_warnings(run["warnings"]))
    if run.get("cells"):
        parts.append(_box("div", FIGURES, *map(_figure, _figures(run))))
    return _box("div", CARD, *parts)


def _box(tag: str, style: str, *content: str) -> str:
    """`content` is HTML."""
    attribute = f' style="{style}"' if style else ""
    return f"<{tag}{attribute}>{''.join(content)}</{tag}>"


def _band(tone: str) -> str:
    """The style of a strip."""
    return f"padding:.6em 1em;border-left:5px solid rgb({tone});background:rgba({tone},.12)"


def _figure(figure: Figure) -> str:
    value = _box("div", "font-size:1.3em;font-weight:620;white-space:nowrap", escape(figure.value))
    name = _box("div", "font-size:.88em", escape(figure.name))
    return _box("div", "", value, name, _box("div", f"font-size:.8em;{SOFT}", escape(figure.note)))


def _warnings(warnings: Sequence[Record]) -> str:
    texts = [": ".join(filter(None, (warning["where"], warning["text"]))) for warning in warnings]
    items = [_box("li", "", escape(words)) for words in texts]
    title = _box("strong", "", plural(len(texts), "warning"))
    return _box("div", _band(WARN), title, _box("ul", "margin:.2em 0 0;padding-left:1.2em", *items))


def text(result: Result) -> str:
    """The same in a few lines, for a terminal."""
    run = result.certificate
    lines = [f"{VERDICTS[run['status']][0]}: {run['title'] or run['file']}", guarantee(run)]
    if run.get("cells"):
        size = f"{plural(run['cells'], 'cell')} of degree {run['p']}, {plural(run['dofs'], 'unknown')}"
        lines.append(f"{size}, {seconds(_time(run))}")
    if _is_solved(run) and run.get("quantities"):
        lines.append("; ".join(_bar(quantity, run["units"]) for quantity in run["quantities"][:QUANTITIES]))
    if run.get("warnings"):
        lines.append(f"{plural(len(run['warnings']), 'warning')}: result.warnings")
    return "\n".join(lines)


def _bar(quantity: Record, units: Units) -> str:
    label = quantity_unit(units, quantity["name"])
    return f"{quantity['name']} {number(quantity['value'], 5)} ({interval(quantity, label)})"
