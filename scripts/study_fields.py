"""Draws meshes, cell maps and contact boundaries of a study into matplotlib axes."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from result_files import OPEN, SLIP, STICK, TIED
from result_surface import FACETS, outer_facets

MOST_VECTOR_CELLS = 3000  # above this, a mesh goes into the SVG as an image

# Okabe and Ito's colours, distinguishable for colour-blind people.
BLUE, ORANGE, GREEN, RED, SKY, PURPLE, GREY = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7", "#999999",
)
STATUS_COLOUR = {OPEN: GREY, STICK: BLUE, SLIP: RED, TIED: GREEN}
STATUS_NAME = {OPEN: "open", STICK: "sticks", SLIP: "slips", TIED: "tied"}


class View:
    """Where to look from: in 2D from above; in 3D parallel projection, the contact boundary (or -y) in sight."""

    def __init__(self, dimension, contact_normal=None):
        self.dimension = dimension
        if dimension == 2:
            self.axes = np.eye(3)
            return
        # An axis not along the normal is turned slightly towards the viewer, and so is the normal.
        normal = np.array([0.0, -1.0, 0.0]) if contact_normal is None else contact_normal
        normal = normal / np.linalg.norm(normal)
        side = np.eye(3)[np.argmin(np.abs(normal) + [0, 0, 1e-9])]
        side -= (side @ normal) * normal
        side /= np.linalg.norm(side)
        depth = 0.55 * normal - 0.65 * side + 0.52 * np.cross(normal, side)
        depth /= np.linalg.norm(depth)
        up = -normal + (normal @ depth) * depth
        up /= np.linalg.norm(up)
        self.axes = np.stack([np.cross(up, depth), up, depth])

    def __call__(self, points):
        """Two coordinates in the plane of the picture."""
        return points @ self.axes[:2].T

    def depth(self, points):
        """Larger is nearer."""
        return points @ self.axes[2]


def outline(grid, scale=0.0):
    """Polygons (cells x corners x 3) with the cells they belong to: the cells in 2D, in 3D the facets of the surface."""
    points = grid.points
    if scale:
        points = points + scale * grid.point_data["displacement"]
    cells, facets = outer_facets(grid)
    corners = grid.corners()[cells[:, None], FACETS[grid.dimension][facets]]
    return points[corners], cells


def visible(polygons, view):
    """Which polygons face the viewer, the farthest first (in 3D; all in 2D)."""
    if view.dimension == 2:
        return np.arange(len(polygons))
    normal = np.cross(polygons[:, 1] - polygons[:, 0], polygons[:, 2] - polygons[:, 0])
    facing = np.flatnonzero(view.depth(normal) > 0)
    return facing[np.argsort(view.depth(polygons[facing].mean(axis=1)))]


def compound(polygons, closed=True):
    """One path of many polygons (n x k x 2): far smaller as SVG than many paths."""
    n, k = polygons.shape[:2]
    extra = 1 if closed else 0
    vertices = np.zeros((n, k + extra, 2))
    vertices[:, :k] = polygons
    codes = np.full((n, k + extra), Path.LINETO)
    codes[:, 0] = Path.MOVETO
    if closed:
        codes[:, -1] = Path.CLOSEPOLY
    return Path(vertices.reshape(-1, 2), codes.ravel())


def frame(axes, flat):
    """Limits around what is drawn, no ticks."""
    low, high = flat.reshape(-1, 2).min(axis=0), flat.reshape(-1, 2).max(axis=0)
    margin = 0.03 * (high - low).max()
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.set(xticks=[], yticks=[])
    axes.spines[:].set_visible(False)


def draw_mesh(axes, grid, view, scale=0.0, face="#F3F6F9", line="#3B4A5A", width=0.25):
    polygons, _ = outline(grid, scale)
    flat = view(polygons[visible(polygons, view)])
    axes.add_patch(PathPatch(compound(flat), facecolor=face, edgecolor=line, linewidth=width, joinstyle="round",
                             rasterized=len(flat) > MOST_VECTOR_CELLS))
    frame(axes, flat)


def logarithmic_levels(values, count=18):
    """Levels from the largest value down to the one below which a fiftieth of the positive values lie, at most 5 decades."""
    positive = np.concatenate([v[v > 0] for v in values])
    high = positive.max()
    low = max(np.quantile(positive, 0.02), 1e-5 * high)
    return np.geomspace(min(low, 0.5 * high), high, count + 1)


def draw_cell_map(axes, grid, view, values, levels, colours):
    """Cells coloured by the level their value lies in; all cells of a level are one path."""
    polygons, cells = outline(grid)
    order = visible(polygons, view)
    flat = view(polygons[order])
    level = np.clip(np.searchsorted(levels, values[cells[order]], side="right") - 1, 0, len(levels) - 2)
    dense = len(flat) > MOST_VECTOR_CELLS
    for i in np.unique(level):
        colour = colours((i + 0.5) / (len(levels) - 1))
        axes.add_patch(PathPatch(compound(flat[level == i]), facecolor=colour, edgecolor=colour if dense else "white",
                                 linewidth=0.2, joinstyle="round", rasterized=dense))
    frame(axes, flat)
    return ScalarMappable(BoundaryNorm(levels, colours.N), colours)


def facet_status(contact):
    """Of every contact facet: the status of most of its nodes."""
    status = np.rint(contact.point_data["contact_status"][contact.nodes]).astype(int)
    counts = np.stack([(status == s).sum(axis=1) for s in STATUS_NAME], axis=1)
    return counts.argmax(axis=1)


def draw_contact_boundary(axes, contact, view, scale):
    """The deformed contact boundary, coloured by status; returns which status occur."""
    moved = contact.points + scale * contact.point_data["displacement"]
    status = facet_status(contact)
    along = contact.nodes
    if contact.dimension == 1:  # the ends come first, then the nodes between them
        along = np.concatenate([along[:, :1], along[:, 2:], along[:, 1:2]], axis=1)
    else:
        along = contact.corners()
    for value in np.unique(status):
        flat = view(moved[along[status == value]])
        if contact.dimension == 1:
            style = {"fill": False, "edgecolor": STATUS_COLOUR[value], "linewidth": 2.2, "capstyle": "round"}
        else:
            style = {"facecolor": STATUS_COLOUR[value], "edgecolor": "white", "linewidth": 0.2, "alpha": 0.85,
                     "rasterized": len(status) > MOST_VECTOR_CELLS}
        axes.add_patch(PathPatch(compound(flat, closed=contact.dimension == 2), **style))
    return [int(value) for value in np.unique(status)]


def contact_normal(contact, body):
    """The mean outward normal of a contact boundary in 3D."""
    a, b, c = (contact.points[contact.corners()[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals *= np.sign(np.sum(normals * (a - body.points.mean(axis=0)), axis=1))[:, None]
    return normals.sum(axis=0)
