"""Charts of a level and of a result, by matplotlib."""

from typing import TYPE_CHECKING

import numpy as np

from tribound.optional import Axes, needed
from tribound.picture import label_decades, plot
from tribound.simplices import Floats
from tribound.words import labelled

if TYPE_CHECKING:
    from tribound.level import Contact, Level
    from tribound.result import Result

__all__ = ["plot", "plot_contact", "plot_convergence"]

BLUE, GREEN, RED = "#0072B2", "#009E73", "#D55E00"  # Okabe and Ito's, distinguishable for colour-blind people
OPEN, STICK, SLIP, TIED = range(4)  # contact status
STATUS_NAME = {TIED: "tied", STICK: "sticks", SLIP: "slips", OPEN: "open"}
ZONE_COLOUR = {OPEN: "#E9ECEF", STICK: "#DCEBF7", SLIP: "#FBE7D9", TIED: "#D9F0E7"}
SHOWN = (
    0.99  # share of the boundary whose pressures are within the scale: singular points would flatten the rest
)
FAR = 1.8  # sizes of a facet: points of its triangulation that are further apart do not belong together


def plot_contact(level: "Level", boundary: str | None = None, ax: Axes | None = None) -> Axes:
    """Draws a contact boundary (default: that with the largest force).

    2D: pressure and friction along it, with what friction can carry and where it sticks, slips and is open;
    3D: the pressure, seen along the normal.
    """
    pyplot = needed("matplotlib.pyplot", "plot_contact()")
    names = list(level.contact)
    if not names:
        raise ValueError("this level has no contact boundary")
    if boundary is not None and boundary not in names:
        raise ValueError(f"there is no contact on {boundary!r}; there is on {', '.join(names)}")
    name = boundary or max(
        names, key=lambda known: abs(float(level.contact[known].weight @ level.contact[known].pressure))
    )
    if ax is None:
        ax = pyplot.figure(figsize=(6.4, 3.9), layout="constrained").add_subplot()
    (_draw_line if level.dimension == 2 else _draw_plan)(ax, level, level.contact[name])
    when = "" if level.t is None else f", t = {level.t:.4g}"
    ax.set_title(f"Contact on {name}{when}", fontsize="medium")
    return ax


def _along(contact: "Contact") -> tuple[Floats, str]:
    """A coordinate along a contact boundary in 2D, and its name."""
    for axis in (0, 1):
        if np.ptp(contact.x[:, 1 - axis]) <= 1e-9 * np.ptp(contact.x[:, axis]):
            return contact.x[:, axis], "xy"[axis]
    assert contact.arc is not None  # in 2D
    return contact.arc - contact.arc.min(), "length along the boundary"


def _friction(contact: "Contact") -> Floats:
    """|T^t|."""
    tangential = contact.traction + contact.pressure[:, None] * contact.normal
    sizes: Floats = np.linalg.norm(tangential, axis=1)
    return sizes


def _largest_shown(contact: "Contact") -> float:
    order = np.argsort(contact.pressure)
    sums = np.cumsum(contact.weight[order])
    return float(contact.pressure[order][min(np.searchsorted(sums, SHOWN * sums[-1]), len(sums) - 1)])


def _draw_line(ax: Axes, level: "Level", contact: "Contact") -> None:
    patch = needed("matplotlib.patches", "plot_contact()").Patch
    along, words = _along(contact)
    order = np.argsort(along, kind="stable")
    x, status = along[order], contact.status[order]
    pressure, friction, limit = contact.pressure[order], _friction(contact)[order], contact.limit[order]
    changes = np.flatnonzero(np.diff(status)) + 1
    ends = np.concatenate([[x[0]], 0.5 * (x[changes - 1] + x[changes]), [x[-1]]])
    for begin, end, zone in zip(ends, ends[1:], status[np.concatenate([[0], changes])]):
        ax.axvspan(begin, end, color=ZONE_COLOUR[int(zone)], linewidth=0, zorder=0)
    ax.axhline(0, color="#777777", linewidth=0.6)
    handles = ax.plot(x, pressure, color=BLUE, label="pressure")
    has_friction = bool(np.any(limit > 0))
    if has_friction or np.any(friction > 1e-9 * np.abs(pressure).max()):
        handles += ax.plot(x, friction, color=RED, linewidth=1.2, label="friction")
    if has_friction:
        handles += ax.plot(x, limit, ":", color="black", linewidth=1, label="what friction can carry")
    names = STATUS_NAME if has_friction else {**STATUS_NAME, SLIP: "closed"}
    handles += [patch(color=ZONE_COLOUR[zone], label=names[zone]) for zone in names if np.any(status == zone)]
    top = max(_largest_shown(contact), float(np.quantile(friction, SHOWN)), float(np.quantile(limit, 0.9)))
    if top > 0:
        ax.set_ylim(min(0, 1.1 * float(np.quantile(pressure, 1 - SHOWN))) - 0.02 * top, 1.15 * top)
    ax.set(
        xlim=(x[0], x[-1]),
        xlabel=labelled(words, level.units, "length"),
        ylabel=labelled("stress", level.units, "stress"),
    )
    ax.legend(
        handles=handles,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.2),
        ncols=3,
        frameon=False,
        fontsize="small",
    )


def _plan(contact: "Contact") -> tuple[Floats, list[int]]:
    """The points seen along the axis nearest to the mean normal, and the axes of the picture."""
    normal = np.abs(contact.weight @ np.abs(contact.normal))
    axes = [i for i in range(3) if i != np.argmax(normal)]
    return contact.x[:, axes], axes


def _draw_plan(ax: Axes, level: "Level", contact: "Contact") -> None:
    tri = needed("matplotlib.tri", "plot_contact()")
    points, axes = _plan(contact)
    triangulation = tri.Triangulation(*points.T)
    facet_size = np.sqrt(2 * np.bincount(contact.facet, weights=contact.weight))[contact.facet]
    corners = triangulation.triangles
    sides = np.linalg.norm(contact.x[corners] - contact.x[np.roll(corners, 1, axis=1)], axis=2)
    triangulation.set_mask(sides.max(axis=1) > FAR * facet_size[corners].max(axis=1))
    top = _largest_shown(contact)
    colours = ax.tripcolor(
        triangulation,
        contact.pressure,
        shading="gouraud",
        cmap="viridis",
        rasterized=True,
        vmin=min(0, float(contact.pressure.min())),
        vmax=top if top > 0 else 1,
    )
    handles = []
    for zone, colour, words in (
        (OPEN, "#ffffff", "edge of the open part"),
        (STICK, RED, "edge of where it sticks"),
    ):
        inside = contact.status == zone
        if inside.any() and not inside.all():
            ax.tricontour(triangulation, inside.astype(float), levels=[0.5], colors=[colour], linewidths=1.2)
            handles.append(
                needed("matplotlib.lines", "plot_contact()").Line2D([], [], color=colour, label=words)
            )
    if handles:
        ax.legend(
            handles=handles,
            loc="upper center",
            bbox_to_anchor=(0.5, -0.2),
            ncols=2,
            fontsize="small",
            facecolor="#8a949e",
            frameon=True,
        )
    x, y = (labelled("xyz"[i], level.units, "length") for i in axes)
    ax.set(aspect="equal", xlabel=x, ylabel=y)
    ax.spines[:].set_visible(False)
    label = labelled("contact pressure", level.units, "stress")
    ax.figure.colorbar(
        colours, ax=ax, label=label, extend="max" if contact.pressure.max() > top else "neither", shrink=0.9
    )


def plot_convergence(result: "Result", ax: Axes | None = None) -> Axes:
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
    ax.set(
        xscale="log",
        yscale="log",
        xlabel="degrees of freedom",
        ylabel="relative bound [%]",
        title=certificate["title"] or certificate["file"],
    )
    for axis in (ax.xaxis, ax.yaxis):
        label_decades(axis)
    ax.grid(which="major", color="#dde2e7", linewidth=0.8)
    ax.grid(which="minor", color="#eef1f4", linewidth=0.5)
    ax.set_axisbelow(True)
    ax.legend(frameon=False, fontsize="small")
    return ax


def _curve(
    ax: Axes, dofs: list[int], shares: list[float | None], colour: str, marker: str, words: str
) -> bool:
    known = np.array([(n, 100 * share) for n, share in zip(dofs, shares) if share])
    if len(known) == 0:
        return False
    last = np.log(known[len(known) // 2 :])
    if len(last) > 1 and np.ptp(last[:, 0]) > 0:
        words += f" ∝ dofs$^{{{np.polyfit(last[:, 0], last[:, 1], 1)[0]:.2f}}}$"
    ax.plot(*known.T, color=colour, marker=marker, markersize=4, label=words)
    return True
