"""Pictures of a level and of a result, by matplotlib."""

import numpy as np

from tribound.contact_picture import plot_contact
from tribound.optional import Axes, needed
from tribound.picture import BLUE, GREEN, RED, label_decades, plot
from tribound.result import Result

__all__ = ["plot", "plot_contact", "plot_convergence"]


def plot_convergence(result: Result, ax: Axes | None = None) -> Axes:
    """The relative bounds of the levels over the degrees of freedom, and the rates of the last half."""
    pyplot = needed("matplotlib.pyplot", "plot_convergence()")
    if ax is None:
        ax = pyplot.figure(figsize=(5.6, 3.9), layout="constrained").add_subplot()
    certificate = result.certificate
    levels = certificate["levels"]
    energy = [(level.get("energy_error") or {}).get("relative") for level in levels]
    dofs = [level["dofs"] for level in levels]
    drawn = _curve(ax, dofs, [level["relative"] for level in levels], BLUE, "o", "bound of the error")
    drawn |= _curve(ax, dofs, energy, GREEN, "s", "error in the energy norm, at most")
    if not drawn:
        raise ValueError("no level has a bound relative to its stress: there is nothing to draw")
    ax.axhline(100 * certificate["tolerance"], color=RED, linewidth=1, linestyle="--", label="asked for")
    ax.set(xscale="log", yscale="log", xlabel="degrees of freedom", ylabel="relative bound [%]")
    ax.set_title(certificate["title"] or certificate["file"], fontsize="medium")
    for axis in (ax.xaxis, ax.yaxis):
        label_decades(axis)
    ax.grid(which="major", color="#dde2e7", linewidth=0.8)
    ax.grid(which="minor", color="#eef1f4", linewidth=0.5)
    ax.set_axisbelow(True)
    ax.legend(frameon=False, fontsize="small")
    return ax


def _curve(ax: Axes, dofs: list[int], shares: list[float | None], colour: str, mark: str, words: str) -> bool:
    """Whether there is anything to draw."""
    known = np.array([(n, 100 * share) for n, share in zip(dofs, shares) if share])
    if len(known) == 0:
        return False
    last = np.log(known[len(known) // 2 :])
    if len(last) > 1 and np.ptp(last[:, 0]) > 0:
        words += f" ∝ dofs$^{{{np.polyfit(last[:, 0], last[:, 1], 1)[0]:.2f}}}$"
    ax.plot(*known.T, color=colour, marker=mark, markersize=4, label=words)
    return True
