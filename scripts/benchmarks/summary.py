"""The contents of docs/validation.md and its figure, from its own tables."""

import re
from collections.abc import Iterator

from tables import ROOT, table

ROUNDING = 0.0  # what a cell like "below 1e-8" says
LEFT = 1e-4  # of the figure: rounding, and what is as small


def sections(page: str) -> Iterator[tuple[str, list[tuple[float, float]]]]:
    """Yields every heading of the page with the deviations and tolerances below it, both as numbers."""
    text = (ROOT / page).read_text()
    for part in re.split(r"^## ", text, flags=re.M)[1:]:
        heading, pairs, columns = part.split("\n", 1)[0], [], None
        for line in part.splitlines():
            cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else None
            if cells is None:
                columns = None
            elif columns is None:
                columns = cells
            elif {"deviation", "tolerance"} <= set(columns) and not cells[0].startswith("--"):
                row = dict(zip(columns, cells))
                pairs.append((number(row["deviation"]), number(row["tolerance"])))
        yield heading, pairs


def number(cell: str) -> float:
    """A percentage."""
    return ROUNDING if cell.startswith("below") else abs(float(cell.rstrip("% ")))


def anchor(heading: str) -> str:
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def contents(page: str) -> str:
    """A table of contents: every section, how many numbers it compares, and the largest share of a tolerance that is used."""
    rows = []
    for heading, pairs in sections(page):
        largest = max((deviation / tolerance for deviation, tolerance in pairs), default=None)
        share = "" if largest is None else "rounding" if largest == ROUNDING else f"{largest:.1g}"
        rows.append([f"[{heading}](#{anchor(heading)})", len(pairs) or "", share])
    return table(["section|", "numbers with a tolerance", "largest deviation / tolerance"], rows)


def draw(page: str, figure: str) -> None:
    """One line for each section, one point for each number: deviation / tolerance."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    drawn = [(heading, pairs) for heading, pairs in sections(page) if pairs]
    fig, axes = plt.subplots(figsize=(9, 0.27 * len(drawn) + 1.1), layout="constrained")
    for i, (_, pairs) in enumerate(drawn):
        shares = [max(deviation / tolerance, LEFT) for deviation, tolerance in pairs]
        axes.plot(shares, [i] * len(shares), "o", color="#1f5a92", alpha=0.55, markersize=6, markeredgewidth=0)
    axes.axvline(1, color="#b03a2e", linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(0.7 * LEFT, 2)
    axes.set_xticks([LEFT, 1e-3, 1e-2, 1e-1, 1], ["rounding", "0.001", "0.01", "0.1", "1"])
    axes.set_ylim(len(drawn) - 0.5, -0.5)
    axes.set_yticks(range(len(drawn)), [heading for heading, _ in drawn])
    axes.set_xlabel("deviation from the reference / tolerance")
    axes.grid(axis="x", color="0.9")
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    fig.savefig(ROOT / figure, dpi=110)
    plt.close(fig)
