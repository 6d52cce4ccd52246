"""Draws what a run says of its contact boundary, and its path over load steps, into matplotlib axes."""

import numpy as np
from matplotlib.patches import Patch
from matplotlib.tri import Triangulation

from result_files import OPEN, SLIP, STICK, TIED, friction, weighted_quantile
from result_surface import surface
from study_bodies import ZONE_COLOUR, shade_zones
from study_fields import BLUE, GREEN, ORANGE, PURPLE, RED, STATUS_NAME

SHOWN = 0.99  # fraction of the values within a scale: those at singular points would flatten the rest


def along(contact):
    """A coordinate along a contact boundary in 2D, and its name."""
    for axis, other in (("x", "y"), ("y", "x")):
        if np.ptp(contact[other]) <= 1e-9 * np.ptp(contact[axis]):
            return contact[axis], axis
    return contact["arc"] - contact["arc"].min(), "length along the boundary"


def boundaries(contact):
    """The rows of contact.csv, boundary by boundary, each sorted along it."""
    for name in dict.fromkeys(contact["boundary"]):
        rows = np.flatnonzero([boundary == name for boundary in contact["boundary"]])
        part = {key: np.asarray(values)[rows] for key, values in contact.items()}
        order = np.argsort(along(part)[0], kind="stable")
        yield name, {key: values[order] for key, values in part.items()}


def shown_part(parts):
    """From where to where: what is closed and as much again on either side."""
    x, closed = np.concatenate([along(part)[0] for part in parts]), np.concatenate([part["status"] != OPEN for part in parts])
    if not closed.any():
        closed[:] = True
    margin = np.ptp(x[closed]) + 1e-9 * np.ptp(x)
    return max(x.min(), x[closed].min() - margin), min(x.max(), x[closed].max() + margin)


def contact_line(axes, run):
    """2D: pressure and friction along the contact boundary, and of a boundary alone where it sticks, slips and is open."""
    parts = list(boundaries(run.points))
    alone = len(parts) == 1
    handles = []
    for (name, part), colour in zip(parts, (BLUE, RED, GREEN, ORANGE, PURPLE)):
        x, coordinate = along(part)
        of = "" if alone else f", {name}"
        handles += axes.plot(x, part["pressure"], color=colour, label=f"pressure{of}")
        if np.any(part["limit"] > 0):
            style = {"color": RED} if alone else {"color": colour, "linestyle": "--"}
            handles += axes.plot(x, np.linalg.norm(friction(part), axis=1), linewidth=1.2, label=f"friction{of}", **style)
        if alone and np.any(part["limit"] > 0):
            handles += axes.plot(x, part["limit"], ":", color="black", linewidth=1, label="what friction can carry")
    if alone:
        shade_zones(axes, x, part["status"])
        names = STATUS_NAME if np.any(part["limit"] > 0) else {**STATUS_NAME, SLIP: "closed"}
        handles += [Patch(color=ZONE_COLOUR[zone], label=names[zone]) for zone in (TIED, STICK, SLIP, OPEN)
                    if np.any(part["status"] == zone)]
    least, most = (weighted_quantile(run.points["pressure"], run.points["weight"], share) for share in (1 - SHOWN, SHOWN))
    if least < most:
        axes.set_ylim(min(0, 1.1 * least), 1.15 * most)
    axes.set_xlim(*shown_part([part for _, part in parts]))
    axes.set(xlabel=run.labelled(coordinate, "length"), ylabel=run.labelled("stress", "stress"),
             title="Along the contact " + ("boundary" if alone else "boundaries"))
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=3, columnspacing=1, handlelength=1.5)


class ContactPlan:
    """3D: the pressure on a contact boundary, that with the largest force, seen along its normal."""

    def __init__(self, run, boundary=None):
        self.run = run
        forces = run.certificate["contact"]["boundaries"]
        self.boundary = boundary or max(forces, key=lambda name: abs(forces[name]["normal"]))
        number = [known["name"] for known in run.certificate["mesh"]["boundaries"]].index(self.boundary)
        self.skin = surface(run.contact.part(run.contact.cell_data["boundary"] == number), 3)
        rows = [name == self.boundary for name in run.points["boundary"]]
        normal = [np.abs(run.points[f"n{axis}"][rows]).mean() for axis in "xyz"]
        self.axes = [i for i in range(3) if i != np.argmax(normal)]
        self.points = self.skin.points[:, self.axes]
        self.pressure = self.skin.fields["contact_pressure"]
        closed = self.pressure > 0.02 * max(self.pressure.max(), 0)
        self.largest = np.quantile(self.pressure[closed], SHOWN) if closed.any() else 1
        shown = self.points[closed] if closed.any() else self.points
        margin = 0.06 * np.ptp(shown, axis=0)
        self.low = np.maximum(self.points.min(axis=0), shown.min(axis=0) - margin)
        self.high = np.minimum(self.points.max(axis=0), shown.max(axis=0) + margin)

    def shape(self):
        """Width over height."""
        width, height = self.high - self.low
        return width / height

    def draw(self, figure):
        run, axes = self.run, figure.subplots()
        colours = axes.tripcolor(Triangulation(*self.points.T, self.skin.triangles), self.pressure, shading="gouraud",
                                 cmap="viridis", vmin=0, vmax=self.largest)
        (left, bottom), (right, top) = self.low, self.high
        x, y = (run.labelled("xyz"[i], "length") for i in self.axes)
        alone = len(run.certificate["contact"]["boundaries"]) == 1
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xlabel=x, ylabel=y,
                 title="Contact boundary" if alone else f"On {self.boundary}")
        axes.grid(visible=False)
        figure.colorbar(colours, ax=axes, shrink=0.85, extend="max", label=run.labelled("contact pressure", "stress"))


# Columns of history.csv in words, and the kind of each number, by which its unit is found.
FORCES = {"contact_normal": ("contact force, normal", "force"), "contact_tangential": ("contact force, tangential", "force")}


def path_axes(history):
    """What is drawn where nobody said: t over what is watched, else over t the part of the contact force that varies more."""
    watched = [name for name in history if name.startswith("watch.")]
    if watched:
        return (watched[0], watched[0].removeprefix("watch."), "length"), ("t", "t", None)
    name = max(FORCES, key=lambda name: np.ptp(history[name]))
    return ("t", "t", None), (name, *FORCES[name])


def path(axes, run, horizontal, vertical):
    """The load steps as a line through points, both axes being (column, words, kind); the peak of t is marked."""
    history, (x, x_words, x_kind), (y, y_words, y_kind) = run.history, horizontal, vertical
    axes.plot(history[x], history[y], color=BLUE, marker="o", markersize=3.5, markerfacecolor="white")
    axes.set(xlabel=run.labelled(x_words, x_kind), ylabel=run.labelled(y_words, y_kind))
    axes.set_title("Load path")
    axes.locator_params(axis="x", nbins=6)
    peak = (run.certificate.get("path") or {}).get("peak")
    if peak and y == "t":
        top = int(np.nanargmax(history["t"]))
        axes.plot(history[x][top], history["t"][top], "o", color=RED, markersize=5)
        far = history[x][top] > np.mean([np.nanmin(history[x]), np.nanmax(history[x])])
        axes.annotate(f"peak {peak['t']:.4g}", (history[x][top], history["t"][top]), xytext=(0, 7), textcoords="offset points",
                      ha="right" if far else "center", color=RED, fontsize=8.5)
        axes.margins(y=0.12)
