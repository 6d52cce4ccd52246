"""Draws a field on the body of a level, by matplotlib."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribound.level import Level
from tribound.mesh import Floats
from tribound.optional import Axes, needed
from tribound.projection import Projection, draw_solid, side_of
from tribound.simplices import Integers
from tribound.surface import Surface, von_mises
from tribound.words import labelled, number, percent, plural, round_factor

BLUE, GREEN, RED = "#0072B2", "#009E73", "#D55E00"  # Okabe and Ito's, distinguishable for colour-blind people
COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
# Share of the surface whose stresses are within the scale: singular points would flatten the rest.
SHOWN = 0.995
UNIFORM = 1e-6  # relative: below this, a field is uniform
DECADES = 1e5  # the largest eta over the smallest that has a colour of its own
FEW_DECADES = 50  # top over bottom of an axis on which 2 and 5 have ticks, too
FROM_ZERO, SIGNED, LOGARITHMIC = "from zero", "signed", "logarithmic"  # scales of colours
WIDTH, BAR, HEAD = 5.0, 1.3, 0.9  # inches: the body, beside it the scale, above and below it words
TRIANGLES = 40_000  # a picture has about as many; more than two pieces per degree and side are of no use


class Field(NamedTuple):
    values: Floats  # at the points of the surface, or one per facet
    words: str
    kind: str  # of its unit
    scale: str  # of the colours


def field_on(surface: Surface, scalars: str, equilibrated: bool) -> Field:
    """A named field on what is seen of a level; ValueError lists the names."""
    level = surface.level
    if scalars == "von_mises" or scalars in COMPONENTS:
        nodal = level.equilibrated_stress if equilibrated else level.stress
        if nodal is None:
            raise ValueError("without a bound there is no equilibrated stress; use equilibrated=False")
        stress = surface.at_points(nodal)
        if scalars == "von_mises":
            return Field(von_mises(stress), "von Mises stress", "stress", FROM_ZERO)
        return Field(stress[:, COMPONENTS.index(scalars)], f"stress {scalars}", "stress", SIGNED)
    axes = {f"u{axis}": i for i, axis in enumerate("xyz"[: level.dimension])}
    if scalars == "displacement" or scalars in axes:
        u = surface.at_points(level.displacement[level.cell_nodes])
        if scalars == "displacement":
            return Field(np.linalg.norm(u, axis=1), "displacement", "length", FROM_ZERO)
        return Field(u[:, axes[scalars]], f"displacement {scalars[1]}", "length", SIGNED)
    eta = {"eta": level.eta, **{f"eta_{name}": values for name, values in level.eta_components.items()}}
    if scalars in eta:
        return Field(eta[scalars][surface.cells], f"{scalars} of the cells", "stress_norm", LOGARITHMIC)
    known = ["von_mises", *COMPONENTS, "displacement", *axes, *eta]
    raise ValueError(f"there is no field {scalars!r}; there are {', '.join(known)}")


def plot(
    level: Level,
    scalars: str = "von_mises",
    *,
    deformation: float | str | None = None,
    equilibrated: bool = True,
    edges: bool = False,
    view: ArrayLike | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draws a field on the body; in 3D on its surface, seen from the direction `view`.

    scalars       von_mises, xx, yy, zz, xy, yz, xz, displacement, ux, uy, uz, eta, or eta_NAME: a component
    deformation   factor of the displacements; "auto": a round one, the largest is about a tenth of the body
    equilibrated  stresses: that behind the bound, else that of the displacement
    edges         whether the edges of cells are drawn
    """
    pyplot = needed("matplotlib.pyplot", "plot()")
    shown = len(level.mesh.cells) if level.dimension == 2 else 2 * len(level.mesh.cells) ** (2 / 3)
    surface = Surface(level, int(np.clip(np.sqrt(TRIANGLES / max(shown, 1)), 1, 2 * level.degree + 1)))
    field = field_on(surface, scalars, equilibrated)
    factor = _factor(level, deformation)
    points = surface.points + factor * surface.at_points(level.displacement[level.cell_nodes])
    colours, extend = _colours(field, surface, points)
    projection = _projection(level, view) if level.dimension == 3 else None
    if ax is None:
        width, height = np.ptp(projection(points)[:, :2] if projection else points, axis=0)
        size = (WIDTH + BAR, float(np.clip(WIDTH * height / width, 1.4, WIDTH)) + HEAD)
        ax = pyplot.figure(figsize=size, layout="constrained").add_subplot()
    if projection is None:
        _draw_flat(ax, surface, points, field.values, colours, edges)
        ax.set(xlabel=labelled("x", level.units, "length"), ylabel=labelled("y", level.units, "length"))
    else:
        at_points = len(field.values) == len(points)
        means = field.values[surface.triangles].mean(axis=1) if at_points else field.values[surface.facet]
        draw_solid(ax, surface, points, colours.to_rgba(means), edges, projection)
    label = labelled(field.words, level.units, field.kind)
    bar = ax.figure.colorbar(colours, ax=ax, label=label, extend=extend, shrink=0.9)
    if field.scale == LOGARITHMIC:
        label_decades(bar.ax.yaxis)
    ax.set_title(_title(level) + (f"\ndisplacements × {factor:g}" if factor else ""), fontsize="medium")
    return ax


def label_decades(axis: Any) -> None:
    """Ticks of a logarithmic axis, in the numbers of this package."""
    ticker = needed("matplotlib.ticker", "a logarithmic axis")
    low, top = axis.get_view_interval()
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if top < FEW_DECADES * low else (1,)))
    axis.set_major_formatter(ticker.FuncFormatter(lambda x, _: number(x, 3)))
    axis.set_minor_formatter(ticker.NullFormatter())


def _projection(level: Level, view: ArrayLike | None) -> Projection:
    up = _up(level)
    return Projection(side_of(up) if view is None else np.asarray(view, float), up)


def _up(level: Level) -> Floats:
    """The axis along which contact pushes the body, where most of its force is along one, else the last."""
    parts = [-(c.weight * c.pressure)[:, None] * c.normal for c in level.contact.values()]
    forces = np.concatenate([np.zeros((1, 3)), *parts])
    total = forces.sum(axis=0)
    axis = int(np.argmax(np.abs(total)))
    if abs(total[axis]) <= 0.5 * np.abs(forces).sum():
        axis, total = 2, np.ones(3)
    up: Floats = np.eye(3)[axis] * np.sign(total[axis])
    return up


def _title(level: Level) -> str:
    where = f"Level {level.number}" if level.t is None else f"t = {level.t:.4g}"
    bound = "" if level.relative is None else f", bound {percent(level.relative)}"
    return f"{where}: {plural(len(level.mesh.cells), 'cell')}{bound}"


def _factor(level: Level, deformation: float | str | None) -> float:
    if deformation != "auto":
        return float(deformation or 0)
    largest = np.linalg.norm(level.displacement, axis=1).max()
    return round_factor(0.1 * np.ptp(level.mesh.points, axis=0).max() / largest) if largest > 0 else 1.0


def _areas(points: Floats, triangles: Integers) -> Floats:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    areas: Floats = 0.5 * (np.abs(normals) if normals.ndim == 1 else np.linalg.norm(normals, axis=1))
    return areas


def _limits(field: Field, surface: Surface, points: Floats) -> tuple[float, float]:
    """The ends of the scale of colours."""
    values = field.values
    low, top = float(values.min()), float(values.max())
    if field.scale == LOGARITHMIC:
        positive = values[values > 0]
        low = max(np.quantile(positive, 0.02), top / DECADES) if len(positive) else 0.5
        return min(low, 0.5 * top or low), top or 1.0
    if field.kind == "stress":
        areas, means = _areas(points, surface.triangles), values[surface.triangles].mean(axis=1)
        order = np.argsort(means)
        sums = np.cumsum(areas[order]) / areas.sum()
        low, top = (float(means[order][np.searchsorted(sums, share)]) for share in (1 - SHOWN, SHOWN))
    if field.scale == FROM_ZERO:
        low = 0.0
    elif low < 0 < top:
        low, top = -max(-low, top), max(-low, top)
    if top - low <= UNIFORM * max(abs(low), abs(top)):
        return min(0.0, 1.25 * low), max(0.0, 1.25 * top) or 1.0
    return low, top


def _colours(field: Field, surface: Surface, points: Floats) -> tuple[Any, str]:
    """Scale and map of the colours, and at which ends values lie beyond the scale."""
    colors, maps = needed("matplotlib.colors", "plot()"), needed("matplotlib.cm", "plot()")
    low, top = _limits(field, surface, points)
    norm = (colors.LogNorm if field.scale == LOGARITHMIC else colors.Normalize)(low, top)
    margin = UNIFORM * (top - low)
    is_below, is_above = field.values.min() < low - margin, field.values.max() > top + margin
    extend = "both" if is_below and is_above else "min" if is_below else "max" if is_above else "neither"
    name = "RdBu_r" if field.scale == SIGNED and low < 0 < top else "viridis"
    return maps.ScalarMappable(norm, name), extend


def _draw_flat(ax: Axes, surface: Surface, points: Floats, values: Floats, colours: Any, edges: bool) -> None:
    lines = needed("matplotlib.collections", "plot()").LineCollection
    style = {"cmap": colours.cmap, "norm": colours.norm, "rasterized": True}
    if len(values) == len(points):
        ax.tripcolor(*points.T, surface.triangles, values, shading="gouraud", **style)
    else:
        ax.tripcolor(*points.T, surface.triangles, facecolors=values[surface.facet], **style)
    sharp = surface.sharp()
    if edges:
        ax.add_collection(lines(points[surface.lines[~sharp]], colors="white", linewidths=0.4, alpha=0.5))
    ax.add_collection(lines(points[surface.lines[sharp]], colors="#222222", linewidths=0.8, capstyle="round"))
    ax.set_aspect("equal")
    ax.margins(0.02)
    ax.autoscale_view()
    ax.spines[:].set_visible(False)
