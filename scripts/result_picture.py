"""Draws the result of a run: the deformed body, and beside it its contact boundary or its path over load steps."""

import io
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.tri import Triangulation
from PIL import Image

from raster import Camera, Raster
from result_charts import SHOWN, ContactPlan, contact_line, path, path_axes
from result_files import displacement_scale, read_grid, read_table, weighted_quantile
from result_surface import surface

WIDTH, HEIGHTS, DOTS = 10, (3.4, 4.6), 120  # inches; pixels of an inch
BAR = 1.1  # inches, width of labels and colour bars
CHART, LONG = 1.45, 4  # width over height: of charts, of bodies that take all of a row
SOLID = 600  # pixels, the width at which bodies in 3D are drawn
HIGHEST = "highest"
UNIFORM = 1e-6  # relative: below this, a stress is uniform
MANY_CELLS = 2500  # from here on facets need not be cut as finely
VIEW = (0.6, -1.0, 0.55)  # 3D: sideways, in front and above, where the viewer is


class Run:
    """The files of a run; of load steps the last, one by its number, or the one with the highest t."""

    def __init__(self, directory, step=None):
        self.directory = Path(directory)
        certificate = self.directory / "certificate.json"
        if not certificate.is_file():
            raise SystemExit(f"picture: there is no {certificate}; RESULTS is the output directory of a run")
        self.certificate = json.loads(certificate.read_text())
        self.points = self.table("contact.csv")
        self.history = self.table("history.csv")
        self.step = None
        if self.history:
            row = int(np.nanargmax(self.history["t"])) if step == HIGHEST else (step or 0) - 1
            self.step = int(self.history["step"][row])
            self.t = self.history["t"][row]
        self.body = self.grid("level" if self.step is None else "step")
        if self.body is None:
            raise SystemExit(f"picture: {directory} has no level_NNN.vtu or step_NNN.vtu; a run of one process with output.vtu = true writes them")
        self.contact = self.grid("contact")

    def grid(self, stem):
        files = sorted(self.directory.glob(f"{stem}_{'*' if self.step is None else f'{self.step:03}'}.vtu"))
        return read_grid(files[-1]) if files else None

    def table(self, name):
        file = self.directory / name
        return read_table(file) if file.exists() else {}

    def labelled(self, words, kind):
        """Words with the unit of their kind, if the case names its units."""
        unit = (self.certificate.get("units") or {}).get(kind)
        return f"{words} [{unit.replace('^2', '²').replace('^3', '³')}]" if unit else words

    def upwards(self):
        """The axis that is upwards: that of the contact force, where there is one, else the last."""
        if not self.points or "z" not in self.points:
            return np.eye(3)[2]
        force = -self.points["pressure"] * self.points["weight"] * np.stack([self.points[f"n{axis}"] for axis in "xyz"])
        axis = np.argmax(np.abs(force).sum(axis=1))
        return np.eye(3)[axis] * (1 if force[axis].sum() >= 0 else -1)


class Body:
    """The deformed body with its von Mises stress, as it is drawn."""

    def __init__(self, run, scale, view, window, share, up):
        self.skin = surface(run.body, 2 if len(run.body.nodes) > MANY_CELLS else 4)
        displacement = self.skin.fields["displacement"]
        self.scale = displacement_scale(self.skin.points, displacement) if scale is None else scale
        self.points = self.skin.points + self.scale * displacement
        self.values = self.skin.fields["von_mises"]
        self.camera = None
        if run.body.dimension == 3:
            up = run.upwards() if up is None else np.array(up)
            self.camera = Camera(self.points, diagonal(up) if view is None else view, up)
        flat = self.camera(self.points)[:, :2] if self.camera else self.points[:, :2]
        around = flat if self.camera else np.concatenate([flat, self.skin.points[:, :2]])
        self.window = window or np.stack([around.min(axis=0), around.max(axis=0)]).T.ravel()
        self.largest = self.largest_shown(flat, share)

    def largest_shown(self, flat, share):
        """The stress below which this share of the surface in the window is."""
        middle = flat[self.skin.triangles].mean(axis=1)
        left, right, bottom, top = self.window
        triangles = self.skin.triangles[((middle >= (left, bottom)) & (middle <= (right, top))).all(axis=1)]
        a, b, c = (self.points[triangles[:, i]] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        values = self.values[triangles].mean(axis=1)
        largest = weighted_quantile(values, area, share)
        return largest if np.ptp(values) > UNIFORM * largest else 1.25 * values.max() or 1

    def shape(self):
        """Width over height."""
        left, right, bottom, top = self.window
        return (right - left) / (top - bottom)

    def draw(self, axes, run, mesh, width):
        (self.draw_solid if self.camera else self.draw_flat)(axes, run, mesh, width)
        title = f"Displacement × {self.scale:g}"
        if run.step is not None:
            title = f"Step {run.step}, t = {run.t:.4g}" + ("\n" if self.shape() < 1 else ": ") + title.lower()
        axes.set_title(title)
        return ScalarMappable(Normalize(0, self.largest), "viridis")

    def draw_flat(self, axes, run, mesh, _):
        skin, flat, before = self.skin, self.points[:, :2], self.skin.points[:, :2]
        axes.add_collection(LineCollection(before[skin.edges[skin.sharp]], colors="#888888", linewidths=0.8, linestyles=":"))
        axes.tripcolor(Triangulation(*flat.T, skin.triangles), self.values, shading="gouraud", cmap="viridis", vmin=0,
                       vmax=self.largest)
        if mesh:
            width = 0.4 if len(skin.edges) < MANY_CELLS else 0.25
            axes.add_collection(LineCollection(flat[skin.edges], colors="white", linewidths=width, alpha=0.5))
        axes.add_collection(LineCollection(flat[skin.edges[skin.sharp]], colors="#222222", linewidths=0.8, capstyle="round"))
        left, right, bottom, top = self.window
        margin = 0.02 * max(right - left, top - bottom)
        across, up = ("r", "z") if run.certificate.get("model") == "axisymmetric" else ("x", "y")
        axes.set(xlim=(left - margin, right + margin), ylim=(bottom - margin, top + margin), aspect="equal",
                 xlabel=run.labelled(across, "length"), ylabel=run.labelled(up, "length"))
        axes.grid(visible=False)

    def draw_solid(self, axes, _, mesh, width):
        raster, skin = Raster(self.points, self.camera, width), self.skin
        raster.draw(self.points, skin.triangles, self.values, lambda x: plt.get_cmap("viridis")(x / self.largest))
        if mesh:
            raster.line(self.points, skin.edges, 1, 0.35)
        raster.line(self.points, skin.edges[skin.sharp], 3, 0.75)
        axes.imshow(raster.image(), interpolation="antialiased")
        axes.set_axis_off()


def diagonal(up):
    """Where the viewer is: in front, a little to the side and above."""
    sideways = np.eye(3)[(np.argmax(np.abs(up)) + 1) % 3]
    return np.stack([sideways, np.cross(sideways, up), up]).T @ VIEW


def compress(image, file):
    """As PNG with a palette, a third of the size; the background stays white."""
    image = image.convert("RGB").quantize(256, kmeans=1, dither=Image.Dither.NONE)
    palette, background = image.getpalette(), 3 * image.getpixel((0, 0))
    if min(palette[background : background + 3]) > 240:
        palette[background : background + 3] = [255] * 3
        image.putpalette(palette)
    file.parent.mkdir(parents=True, exist_ok=True)
    image.save(file, optimize=True)


def beside(run, boundary, chart):
    """What is drawn beside the body, as a function of a figure, and its width over its height; None where there is nothing."""
    if run.history:
        return lambda figure: path(figure.subplots(), run, *(chart or path_axes(run.history))), CHART
    if not run.points:
        return None, 0
    if run.body.dimension == 2:
        return lambda figure: contact_line(figure.subplots(), run), CHART
    plan = ContactPlan(run, boundary)
    return plan.draw, plan.shape()


def panels(shapes):
    """A figure and its parts beside each other, for drawings of these widths over heights; a long body is above its chart."""
    count = len(shapes)
    if count == 2 and shapes[0] > LONG:
        heights = [WIDTH / shapes[0] + 1, WIDTH / 4]
        figure = plt.figure(figsize=(WIDTH, sum(heights)), layout="constrained")
        parts = figure.subfigures(2, 1, height_ratios=heights)
    else:
        shapes = np.clip(shapes, 0.5, 2)
        height = np.clip((WIDTH - BAR * count) / shapes.sum(), *HEIGHTS)
        widths = height * shapes + BAR
        figure = plt.figure(figsize=(min(WIDTH, widths.sum()), height), layout="constrained")
        parts = figure.subfigures(1, count, squeeze=False, width_ratios=widths)[0]
    figure.get_layout_engine().set(w_pad=0.08, h_pad=0.06)
    return figure, parts


def draw(directory, file, scale=None, mesh=True, view=None, window=None, share=SHOWN, boundary=None, step=None, chart=None, up=None):
    """Draws the result in a directory into a PNG file.

    scale     factor of the displacements (default: the largest is about a tenth of the body)
    mesh      whether the edges of cells are drawn
    view      3D: the direction of the viewer
    window    2D: what is drawn of the body, from x to x, from y to y
    share     of the surface that is within the scale of colours
    boundary  3D: whose pressure is drawn (default: that of the largest force)
    step      of load steps: number of the one that is drawn, or HIGHEST, that with the highest t (default: the last)
    chart     over load steps: what is drawn to the right and upwards, each a column of history.csv, words, and their kind of unit
    up        3D: the direction that is upwards (default: that of the contact force)
    """
    run = Run(directory, step)
    body = Body(run, scale, view, window, share, up)
    draw_beside, shape = beside(run, boundary, chart)
    figure, parts = panels([body.shape(), shape][: 1 + (draw_beside is not None)])
    axes = parts[0].subplots()
    colours = body.draw(axes, run, mesh, SOLID)
    parts[0].colorbar(colours, ax=axes, shrink=0.85, extend="max", label=run.labelled("von Mises stress", "stress"))
    if draw_beside:
        draw_beside(parts[1])
    content = io.BytesIO()
    figure.savefig(content, format="png", dpi=DOTS)
    plt.close(figure)
    compress(Image.open(content), Path(file))
