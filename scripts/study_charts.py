"""The charts of a study: error and bound, components, effectivity, Newton steps."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, NullLocator

from study_fields import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY

VARIANTS = {
    "adaptive": ("adaptive", BLUE),
    "adaptive_converged": ("adaptive, Newton to the end", SKY),
    "uniform": ("uniform", RED),
    "uniform_converged": ("uniform, Newton to the end", ORANGE),
}
COMPONENTS = {  # column: name, colour, marker
    "osc": ("data oscillation", GREY, "x"),
    "str": ("stress", BLUE, "o"),
    "neu": ("Neumann data", PURPLE, "+"),
    "cnt": ("contact condition", RED, "s"),
    "frc": ("friction", ORANGE, "D"),
    "lin": ("linearisation", GREEN, "^"),
}

plt.rcParams.update({
    "svg.fonttype": "path", "svg.hashsalt": "tribound", "font.family": "DejaVu Sans", "font.size": 9,
    "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.labelsize": 9,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#555555", "axes.linewidth": 0.7,
    "axes.grid": True, "grid.color": "#E5E7EA", "grid.linewidth": 0.6, "axes.axisbelow": True,
    "xtick.color": "#444444", "ytick.color": "#444444", "xtick.labelsize": 8, "ytick.labelsize": 8,
    "lines.linewidth": 1.5, "lines.markersize": 4, "legend.fontsize": 8, "legend.frameon": False,
})


def scientific(value):
    """Such as 0.5, 2, or in print what is 2e-05 here."""
    if 0.09 < value < 1001:
        return f"{value:g}"
    digits, exponent = f"{value:.0e}".split("e")
    return ("" if digits == "1" else rf"${digits}\cdot$") + f"$10^{{{int(exponent)}}}$"


def log_axes(axes, y_label=""):
    """Degrees of freedom against something, both logarithmic."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(lambda n, _: f"{n:g}" if n < 1e4 else f"{n / 1e3:g}k")
    axes.xaxis.set_minor_locator(NullLocator())
    low, high = axes.get_ylim()
    if high < 100 * low:
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(lambda y, _: scientific(y))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("degrees of freedom")
    axes.set_ylabel(y_label)


def known(x, *ys):
    """The parts of the columns that a logarithmic axis can show."""
    keep = np.logical_and.reduce([np.isfinite(y) & (y > 0) for y in ys])
    return x[keep], *(y[keep] for y in ys)


def slope_triangle(axes, x, y, rate, colour):
    """Below the last part of the curve (x, y): a triangle with the slope of the fit."""
    if rate is None or len(x) < 3:
        return
    right = x[-1] / 1.1
    left = max(x[0], right / 2.2)
    if left >= 0.8 * right:
        return
    covered = (x >= left) & (x <= 1.11 * right)
    top = 0.72 * min(y[covered] * (x[covered] / left) ** -rate)
    bottom = top * (right / left) ** rate
    axes.fill([left, right, left], [top, bottom, bottom], facecolor=colour, edgecolor="none", alpha=0.18)
    axes.annotate(f"{rate:.2f}".replace("-", "\N{MINUS SIGN}"), (left, bottom), xytext=(-2, 0),
                  textcoords="offset points", ha="right", va="bottom", fontsize=8, color=colour)


def legend_below(figure, handles, columns, rows=1, **options):
    """One legend for all panels, in a strip of its own below them."""
    strip = (0.12 + 0.2 * rows) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))
    figure.legend(handles=handles, loc="lower center", ncols=columns, **options)


def bounds(axes, study):
    for name in study.variants("adaptive", "uniform"):
        label, colour = VARIANTS[name]
        dofs = study.column(name, "dofs")
        columns = (("total_sharp", "bound", "-", "o"), ("stress_error", "error of the stress", "--", "s"),
                   ("dual_norm", "residual, dual norm", ":", "^"))
        for column, what, style, marker in columns:
            x, y = known(dofs, study.column(name, column))
            if x.size:
                axes.plot(x, y, style, color=colour, marker=marker, markerfacecolor="white", label=f"{label}: {what}")
        lowest = np.nanmin([study.column(name, column) for column, *_ in columns], axis=0)
        slope_triangle(axes, *known(dofs, lowest), study.rate(name, "bound"), colour)
    log_axes(axes, "stress x length$^{d/2}$")
    axes.set_title("Bound, and what it bounds")
    axes.legend(fontsize=7, loc="upper right", labelspacing=0.25)
    axes.set_ylim(top=4 * axes.get_ylim()[1])


def energy_errors(axes, study):
    for name in study.variants("adaptive", "uniform"):
        label, colour = VARIANTS[name]
        dofs, error = study.column(name, "dofs"), study.column(name, "energy_error")
        bound = error * study.column(name, "energy_effectivity")  # unknown where it is one of another problem
        x, y = known(dofs, bound)
        if x.size:
            axes.plot(x, y, "-", color=colour, marker="o", markerfacecolor="white", label=f"{label}: guaranteed bound")
        x, y = known(dofs, error)
        if x.size:
            axes.plot(x, y, "--", color=colour, marker="s", markerfacecolor="white", label=f"{label}: error")
            slope_triangle(axes, x, y, study.rate(name, "error"), colour)
    log_axes(axes, "energy norm")
    axes.set_title("Error in the energy norm")
    axes.legend(fontsize=7, labelspacing=0.25)


def convergence(study):
    panels = [bounds]
    if np.isfinite(study.table["energy_error"]).any():  # missing in a study that ended before its reference
        panels.append(energy_errors)
    figure, axes = plt.subplots(1, len(panels), figsize=(4.3 * len(panels), 3.7), squeeze=False, layout="constrained")
    for draw, panel in zip(panels, axes[0]):
        draw(panel, study)
    return figure


def components(study):
    names = study.variants("adaptive", "uniform")
    figure, panels = plt.subplots(1, len(names), figsize=(8.6, 3.5), sharey=True, squeeze=False, layout="constrained")
    largest = max(np.nanmax(study.column(name, "total_sharp")) for name in names)
    for axes, name in zip(panels[0], names):
        dofs = study.column(name, "dofs")
        total = study.column(name, "total_sharp")
        axes.plot(*known(dofs, total), color="black", linewidth=1.8, label="bound")
        for column, (what, colour, marker) in COMPONENTS.items():
            parts = ("lin1", "lin2n", "lin2t") if column == "lin" else (column,)
            x, y = dofs, np.sqrt(sum(study.column(name, part) ** 2 for part in parts))
            y[y < 1e-6 * largest] = np.nan  # round-off
            if np.isfinite(y).any():
                axes.plot(x, y, "-", color=colour, marker=marker, markerfacecolor="white", linewidth=1.1, label=what)
        log_axes(axes)
        axes.set_title(f"Components, {VARIANTS[name][0]}")
    panels[0, 0].set_ylabel(study.with_unit("stress x length$^{d/2}$", "stress_norm"))
    handles, labels = panels[0, 0].get_legend_handles_labels()
    legend_below(figure, handles, len(labels))
    return figure


def effectivity(study):
    if not np.isfinite([study.table["effectivity"], study.table["effectivity_stress"]]).any():
        return None
    figure, axes = plt.subplots(figsize=(5.2, 3.3), layout="constrained")
    columns = (("effectivity", "bound / dual norm of the residual", "-", "o"),
               ("effectivity_stress", "bound / error of the stress", "--", "s"))
    for name in study.variants("adaptive", "uniform"):
        label, colour = VARIANTS[name]
        for column, what, style, marker in columns:
            values = study.column(name, column)
            keep = np.isfinite(values)
            if not keep.any():
                continue
            axes.plot(study.column(name, "level")[keep], values[keep], style, color=colour, marker=marker,
                      markerfacecolor="white", label=f"{label}: {what}")
    axes.axhline(1, color="black", linewidth=0.9, label="1: what is guaranteed for the residual")
    low, high = axes.get_ylim()
    axes.set_ylim(min(0.9, low), high + 0.6 * (high - 0.9))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("level")
    axes.set_title("How much larger than the error the bound is")
    axes.legend(loc="upper right", fontsize=7.5)
    return figure


def newton(study):
    pairs = [study.variants(name, f"{name}_converged") for name in ("adaptive", "uniform")]
    pairs = [pair for pair in pairs if pair]
    widths = np.array([len(study.column(pair[0], "level")) for pair in pairs])
    figure, panels = plt.subplots(1, len(pairs), figsize=(8.6, 2.8), sharey=True, squeeze=False, layout="constrained",
                                  width_ratios=np.maximum(widths, 0.6 * widths.max()))
    for axes, pair in zip(panels[0], pairs):
        for i, name in enumerate(pair):
            level, steps = study.column(name, "level"), study.column(name, "newton_steps")
            label = "to the end" if name.endswith("_converged") else "stopped by the bound"
            axes.bar(level + 0.4 * (i - 0.5 * (len(pair) - 1)), steps, 0.38, color=VARIANTS[name][1],
                     label=f"{label}: {int(steps.sum())} steps")
        axes.set_title(f"Newton steps, {pair[0]}")
        axes.set_xlabel("level")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.grid(axis="x", visible=False)
        axes.set_xlim(-0.7, max(level[-1], 4) + 0.7)
        axes.legend(loc="upper right")
    panels[0, 0].set_ylim(top=1.3 * panels[0, 0].get_ylim()[1])
    return figure
