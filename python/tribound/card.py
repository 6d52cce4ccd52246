"""The verdict of a result for notebooks and terminals, in the words of the report page.

The style is inline and its colours suit light and dark pages: notebooks may drop style sheets.
"""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

from tribound.words import count, measured, number, percent, plural, quantity_unit, seconds, unit

if TYPE_CHECKING:
    from tribound.result import Result

Record = Mapping[str, Any]

GOOD, WARN, BAD = "38,143,88", "196,120,16", "205,62,52"  # red, green, blue
VERDICTS = {
    "certified": ("Certified", "✓", GOOD),
    "budget": ("Budget used up", "!", WARN),
    "not certified": ("Not certified", "×", BAD),
    "failed": ("Failed", "×", BAD),
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
        return (
            "The error",
            f"{measured(number(run['bound']), unit(run['units'], 'stress_norm'))} of a stress that is zero",
        )
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
        yield Figure(
            percent(run["relative"]),
            "bound of the error",
            measured(number(run["bound"]), unit(units, "stress_norm")),
        )
    energy = run.get("energy_error") or {}
    if energy.get("relative"):
        target = {
            "solution": "from the exact solution",
            "tresca_with_computed_threshold": "for the computed friction threshold",
        }
        yield Figure(
            percent(energy["relative"]), "error in the energy norm, at most", target[energy["guaranteed_for"]]
        )
    if _is_solved(run):
        for quantity in (run.get("quantities") or [])[:QUANTITIES]:
            yield Figure(
                number(quantity["value"], 5),
                quantity["name"],
                interval(quantity, quantity_unit(units, quantity["name"])),
            )
        yield Figure(number(run["max_displacement"]), "largest displacement", unit(units, "length"))
    yield Figure(
        count(run["cells"]),
        "cells",
        f"{plural(run['dofs'], 'unknown')}, {plural(len(run['levels']), 'mesh', 'meshes')}",
    )
    yield Figure(seconds(_time(run)), "computing time")


def _time(run: Record) -> float:
    """Of all stages; `times` has a count and times of processors, too."""
    return float(sum(run["times"][stage] for stage in STAGES))


def _kind(run: Record) -> str:
    contact = f"friction: {run['friction']}" if run["friction"] else "no contact"
    return f"{run['file']} · {run['d']}D, degree {run['p']}, {contact}"


CARD = (
    f"max-width:62em;line-height:1.45;border:{RULE};border-radius:8px;overflow:hidden;"
    "font-variant-numeric:tabular-nums;"
    "font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif"
)
MARK = (
    "flex:none;width:1.7em;line-height:1.7em;align-self:start;border-radius:50%;text-align:center;color:#fff"
)


def html(result: "Result") -> str:
    """The card of a result, for a notebook."""
    run = result.certificate
    title, mark, tone = VERDICTS[run["status"]]
    verdict = _box(
        "div", "", _box("strong", "font-size:1.08em", title), _box("div", "", escape(guarantee(run)))
    )
    parts = [
        _box(
            "div", "font-size:1.25em;font-weight:650;padding:.5em .8em 0", escape(run["title"] or run["file"])
        ),
        _box("div", f"font-size:.86em;padding:0 1.16em .6em;{SOFT}", escape(_kind(run))),
        _box(
            "div",
            f"display:flex;gap:.8em;{_band(tone)}",
            _box("span", f"{MARK};background:rgb({tone})", mark),
            verdict,
        ),
    ]
    if run.get("warnings"):
        parts.append(_warnings(run["warnings"]))
    if run.get("cells"):
        figures = "".join(map(_figure, _figures(run)))
        parts.append(_box("div", "display:flex;flex-wrap:wrap;gap:.9em 1.9em;padding:.8em 1em .9em", figures))
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
    texts = [
        f"{warning['where']}: {warning['text']}" if warning["where"] else warning["text"]
        for warning in warnings
    ]
    items = _box(
        "ul", "margin:.2em 0 0;padding-left:1.2em", *(_box("li", "", escape(words)) for words in texts)
    )
    return _box("div", _band(WARN), _box("strong", "", plural(len(texts), "warning")), items)


def text(result: "Result") -> str:
    """The same in a few lines, for a terminal."""
    run = result.certificate
    lines = [f"{VERDICTS[run['status']][0]}: {run['title'] or run['file']}", guarantee(run)]
    if run.get("cells"):
        lines.append(
            f"{plural(run['cells'], 'cell')} of degree {run['p']}, {plural(run['dofs'], 'unknown')}, "
            f"{seconds(_time(run))}"
        )
    known = run.get("quantities") or []
    bars = [
        f"{q['name']} {number(q['value'], 5)} ({interval(q, quantity_unit(run['units'], q['name']))})"
        for q in known[:QUANTITIES]
    ]
    lines += ["; ".join(bars)] if bars and _is_solved(run) else []
    lines += (
        [f"{plural(len(run['warnings']), 'warning')}: see .certificate[\"warnings\"]"]
        if run.get("warnings")
        else []
    )
    return "\n".join(lines)
