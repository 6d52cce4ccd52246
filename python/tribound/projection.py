"""Surfaces in 3D in a plane picture: parallel projection, the farthest triangles are drawn first."""

import numpy as np
from numpy.typing import NDArray

from tribound.mesh import Floats
from tribound.optional import Axes, needed
from tribound.simplices import Integers
from tribound.surface import Surface

DARKEST = 0.62  # shade of a face seen edge-on
LIGHT = np.array([-0.35, 0.45, 1]) / np.linalg.norm([-0.35, 0.45, 1])  # right, up, towards the viewer
SEAM = 0.35  # width of the outline of a triangle: without it the page shows between triangles
VIEW = (0.6, -1.0, 0.55)  # sideways, in front and above: where the viewer is when nobody says
AXIS_COLOURS = ("#c0392b", "#2e8b57", "#2f6fb5")


class Projection:
    """Looks from the direction `side`, the direction `up` being upwards."""

    def __init__(self, side: Floats, up: Floats) -> None:
        back = side / np.linalg.norm(side)
        if np.linalg.norm(np.cross(up, back)) < 1e-6:  # seen along `up`: another axis is upwards
            up = np.roll(up, 1)
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        self.axes = np.stack([right, np.cross(back, right), back])

    def __call__(self, points: Floats) -> Floats:
        """Points x (right, up, nearness)."""
        turned: Floats = points @ self.axes.T
        return turned


def side_of(up: Floats) -> Floats:
    """Where the viewer is: in front, a little to the side and above."""
    sideways = np.eye(3)[(int(np.argmax(np.abs(up))) + 1) % 3]
    side: Floats = np.stack([sideways, np.cross(up, sideways), up]).T @ np.array(VIEW)
    return side


def draw_solid(
    ax: Axes, surface: Surface, points: Floats, fill: Floats, edges: bool, projection: Projection
) -> None:
    """Triangles that face the viewer, in the colours `fill`, and the lines on them."""
    seen = projection(points)
    corners = seen[surface.triangles]
    normals = _normals(surface, corners, projection)
    front = normals[:, 2] > 0
    corners, fill = corners[front], fill[front]
    fill[:, :3] *= (DARKEST + (1 - DARKEST) * np.maximum(normals[front] @ LIGHT, 0))[:, None]
    drawn, line_fill, widths = _lines(surface, front.reshape(len(surface.cells), -1).any(axis=1), edges)
    segments = np.stack([seen[drawn[:, :-1]], seen[drawn[:, 1:]]], axis=2).reshape(-1, 2, 3)
    # A line is drawn after the triangles around it.
    bias = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    order = np.argsort(np.concatenate([corners[:, :, 2].mean(axis=1), segments[:, :, 2].mean(axis=1) + bias]))
    polygons = np.concatenate([corners, segments[:, [0, 1, 1]]])[order, :, :2]
    collection = needed("matplotlib.collections", "plot()").PolyCollection(
        polygons,
        facecolors=np.concatenate([fill, 0 * line_fill])[order],
        edgecolors=np.concatenate([fill, line_fill])[order],
        linewidths=np.concatenate([np.full(len(fill), SEAM), widths])[order],
        rasterized=True,
    )
    ax.add_collection(collection)
    _frame(ax, polygons.reshape(-1, 2), projection)


def _normals(surface: Surface, corners: Floats, projection: Projection) -> Floats:
    """The unit normals of the triangles, on the side of the outer normals of their facets."""
    normals: Floats = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outer = projection(surface.normals())[surface.facet]
    sizes = np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)
    normals *= (np.sign(np.sum(normals * outer, axis=1)) / sizes)[:, None]
    return normals


def _lines(surface: Surface, visible: NDArray[np.bool_], edges: bool) -> tuple[Integers, Floats, Floats]:
    """The lines of visible facets that are drawn, with the colour and width of each of their segments."""
    sharp = surface.sharp()
    drawn = np.repeat(visible, 3) & (sharp | edges)
    colour = np.where(sharp[drawn, None], [0.13, 0.13, 0.13, 1], [0.06, 0.09, 0.11, 0.4])
    width = np.where(sharp[drawn], 0.8, 0.3)
    segments = surface.lines.shape[1] - 1
    return surface.lines[drawn], np.repeat(colour, segments, axis=0), np.repeat(width, segments)


def _frame(ax: Axes, flat: Floats, projection: Projection) -> None:
    """Limits around what is drawn, no axes but a small triad."""
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = (high - low).max()
    origin, length = low - 0.03 * size, 0.12 * size
    for i in np.argsort(projection.axes[2]):  # the axis that points to the viewer last
        tip = origin + length * projection.axes[:2, i]
        ax.plot(*np.stack([origin, tip]).T, color=AXIS_COLOURS[i], linewidth=1.8, solid_capstyle="round")
        x, y = origin + 1.3 * length * projection.axes[:2, i]
        ax.text(x, y, "xyz"[i], color=AXIS_COLOURS[i], ha="center", va="center")
    ax.set_aspect("equal")
    ax.margins(0.04)
    ax.set_axis_off()
    ax.autoscale_view()
