"""Draws a contact boundary of a level, by matplotlib."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribound.level import Contact, Level
from tribound.mesh import Floats
from tribound.optional import Axes, needed
from tribound.picture import BLUE, RED
from tribound.words import labelled

OPEN, STICK, SLIP, TIED = range(4)  # contact status
STATUS_NAME = {TIED: "tied", STICK: "sticks", SLIP: "slips", OPEN: "open"}
ZONE_COLOUR = {OPEN: "#E9ECEF", STICK: "#DCEBF7", SLIP: "#FBE7D9", TIED: "#D9F0E7"}
# Share of the boundary whose pressures are within the scale: singular points would flatten the rest.
SHOWN = 0.99
BELOW = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2), "fontsize": "small"}  # a legend
FLAT = 0.7  # length of the mean normal of a boundary that can be seen from one side
ROUND = 0.02  # of the radius: points of a cylinder are nearer to it
FAR = 1.8  # sizes of a facet: points of its triangulation that are further apart do not belong together


def plot_contact(level: Level, boundary: str | None = None, ax: Axes | None = None) -> Axes:
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
    forces = {known: abs(float(part.weight @ part.pressure)) for known, part in level.contact.items()}
    name = boundary or max(names, key=forces.__getitem__)
    if ax is None:
        ax = pyplot.figure(figsize=(6.4, 3.9), layout="constrained").add_subplot()
    (_draw_line if level.dimension == 2 else _draw_plan)(ax, level, level.contact[name])
    when = "" if level.t is None else f", t = {level.t:.4g}"
    ax.set_title(f"Contact on {name}{when}", fontsize="medium")
    return ax


def _along(contact: Contact) -> tuple[Floats, str]:
    """A coordinate along a contact boundary in 2D, and its name."""
    for axis in (0, 1):
        if np.ptp(contact.x[:, 1 - axis]) <= 1e-9 * np.ptp(contact.x[:, axis]):
            return contact.x[:, axis], "xy"[axis]
    assert contact.arc is not None  # in 2D it is known
    return contact.arc - contact.arc.min(), "length along the boundary"


def _friction(contact: Contact) -> Floats:
    """|T^t|."""
    tangential = contact.traction + contact.pressure[:, None] * contact.normal
    sizes: Floats = np.linalg.norm(tangential, axis=1)
    return sizes


def _largest_shown(contact: Contact) -> float:
    order = np.argsort(contact.pressure)
    sums = np.cumsum(contact.weight[order])
    return float(contact.pressure[order][min(np.searchsorted(sums, SHOWN * sums[-1]), len(sums) - 1)])


def _shade(ax: Axes, x: Floats, status: NDArray[np.int32]) -> None:
    """Where it sticks, slips and is open."""
    changes = np.flatnonzero(np.diff(status)) + 1
    ends = np.concatenate([[x[0]], 0.5 * (x[changes - 1] + x[changes]), [x[-1]]])
    for begin, end, zone in zip(ends, ends[1:], status[np.concatenate([[0], changes])]):
        ax.axvspan(begin, end, color=ZONE_COLOUR[int(zone)], linewidth=0, zorder=0)


def _draw_line(ax: Axes, level: Level, contact: Contact) -> None:
    patch = needed("matplotlib.patches", "plot_contact()").Patch
    along, words = _along(contact)
    order = np.argsort(along, kind="stable")
    x, status = along[order], contact.status[order]
    pressure, friction, limit = contact.pressure[order], _friction(contact)[order], contact.limit[order]
    _shade(ax, x, status)
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
    ax.set(xlim=(x[0], x[-1]), xlabel=labelled(words, level.units, "length"))
    ax.set_ylabel(labelled("stress", level.units, "stress"))
    ax.legend(handles=handles, ncols=3, frameon=False, **BELOW)


def _plan(contact: Contact) -> tuple[Floats, list[str]]:
    """The points in the plane of the picture, with the names of its axes.

    They are seen along the coordinate axis nearest to the mean normal; a cylinder that this hides is unrolled.
    """
    mean = np.abs(contact.weight @ contact.normal) / contact.weight.sum()
    if np.linalg.norm(mean) < FLAT and (unrolled := _unrolled(contact)):
        return unrolled
    axes = [i for i in range(3) if i != np.argmax(contact.weight @ np.abs(contact.normal))]
    return contact.x[:, axes], ["xyz"[i] for i in axes]


def _unrolled(contact: Contact) -> tuple[Floats, list[str]] | None:
    """The same of a cylinder along an axis: x = centre + radius normal across it. None: it is no cylinder."""
    axis = int(np.argmin(contact.weight @ np.abs(contact.normal)))
    across = [(axis + 1) % 3, (axis + 2) % 3]
    x, normal = contact.x[:, across], contact.normal[:, across]
    ones, zeros = np.ones(len(x)), np.zeros(len(x))
    columns = [np.concatenate([ones, zeros]), np.concatenate([zeros, ones]), normal.T.ravel()]
    solution = np.linalg.lstsq(np.stack(columns, axis=1), x.T.ravel(), rcond=None)[0]
    centre, radius = solution[:2], abs(solution[2])
    if np.abs(np.linalg.norm(x - centre, axis=1) - radius).max() > ROUND * radius:
        return None
    angle = np.arctan2(*(x - centre).T[::-1])
    return np.stack([radius * angle, contact.x[:, axis]], axis=1), ["length around", "xyz"[axis]]


def _triangulation(contact: Contact, points: Floats) -> Any:
    """The points joined to triangles, but not across gaps between facets."""
    triangulation = needed("matplotlib.tri", "plot_contact()").Triangulation(*points.T)
    facet_size = np.sqrt(2 * np.bincount(contact.facet, weights=contact.weight))[contact.facet]
    corners = triangulation.triangles
    sides = np.linalg.norm(contact.x[corners] - contact.x[np.roll(corners, 1, axis=1)], axis=2)
    triangulation.set_mask(sides.max(axis=1) > FAR * facet_size[corners].max(axis=1))
    return triangulation


def _draw_plan(ax: Axes, level: Level, contact: Contact) -> None:
    line = needed("matplotlib.lines", "plot_contact()").Line2D
    points, names = _plan(contact)
    triangulation, pressure, top = _triangulation(contact, points), contact.pressure, _largest_shown(contact)
    limits = {"vmin": min(0, float(pressure.min())), "vmax": top if top > 0 else 1}
    style = {"shading": "gouraud", "cmap": "viridis", "rasterized": True}
    colours = ax.tripcolor(triangulation, pressure, **style, **limits)
    handles = []
    edges = ((OPEN, "white", "edge of the open part"), (STICK, RED, "edge of where it sticks"))
    for zone, colour, words in edges:
        inside = contact.status == zone
        if inside.any() and not inside.all():
            ax.tricontour(triangulation, inside.astype(float), levels=[0.5], colors=[colour], linewidths=1.2)
            handles.append(line([], [], color=colour, label=words))
    if handles:
        ax.legend(handles=handles, ncols=2, facecolor="#8a949e", **BELOW)
    x, y = (labelled(name, level.units, "length") for name in names)
    ax.set(aspect="equal", xlabel=x, ylabel=y)
    ax.spines[:].set_visible(False)
    label = labelled("contact pressure", level.units, "stress")
    extend = "max" if pressure.max() > top else "neither"
    ax.figure.colorbar(colours, ax=ax, label=label, extend=extend, shrink=0.9)
