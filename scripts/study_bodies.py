"""The pictures of a study's body: meshes, contact boundary, maps of bound and error."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator

import study_fields as fields
from result_files import OPEN, SLIP, STICK, TIED, displacement_scale, friction, read_table
from study_charts import legend_below, scientific
from study_fields import BLUE, GREEN, PURPLE, RED

MOST_MAP_CELLS = 1500  # of a map whose cells can still be distinguished
ZONE_COLOUR = {OPEN: "#E9ECEF", STICK: "#DCEBF7", SLIP: "#FBE7D9", TIED: "#D9F0E7"}


def chosen(levels, count):
    """The first, the last and some between, evenly."""
    return [levels[i] for i in sorted({round(t) for t in np.linspace(0, len(levels) - 1, count)})]


def view_of(body, contact):
    if body.dimension == 2 or contact is None:
        return fields.View(body.dimension)
    return fields.View(body.dimension, fields.contact_normal(contact, body))


def panel_shape(grid, view):
    """Width over height of what is drawn."""
    width, height = np.ptp(view(grid.points), axis=0)
    return np.clip(width / height, 0.3, 4)


def meshes(study):
    levels = study.drawn_levels("adaptive")
    if not levels:
        return None
    levels = chosen(levels, 4)
    bodies = [study.grid("adaptive", "level", level) for level in levels]
    contacts = [study.grid("adaptive", "contact", level) for level in levels]
    view = view_of(bodies[-1], contacts[-1])
    scale = displacement_scale(bodies[-1].points, bodies[-1].point_data["displacement"])
    shape = panel_shape(bodies[-1], view)
    columns = 2 if shape > 1.3 else len(levels)
    rows = -(-len(levels) // columns)
    width = 8.6 / columns
    figure, panels = plt.subplots(rows, columns, figsize=(8.6, rows * (width / shape + 0.4) + 0.6), squeeze=False,
                                  layout="constrained")
    for axes in panels.flat[len(levels):]:
        axes.set_axis_off()
    present = set()
    for axes, level, body, contact in zip(panels.flat, levels, bodies, contacts):
        fields.draw_mesh(axes, body, view, scale)
        if contact is not None:
            present.update(fields.draw_contact_boundary(axes, contact, view, scale))
        relative = study.column("adaptive", "relative")[level]
        axes.set_title(f"level {level}: {len(body.nodes)} cells{',' if columns == 2 else chr(10)} "
                       f"bound {100 * relative:.3g} %", fontsize=8.5)
    handles = [Patch(color=fields.STATUS_COLOUR[s], label=f"contact {fields.STATUS_NAME[s]}") for s in sorted(present)]
    legend_below(figure, handles, 3, 2, title=f"displacement x {scale:g}", title_fontsize=8)
    return figure


def zones(x, status):
    """Begin, end and status of the pieces of equal status along sorted x."""
    changes = np.flatnonzero(np.diff(status)) + 1
    limits = np.concatenate([[x[0]], 0.5 * (x[changes - 1] + x[changes]), [x[-1]]])
    return zip(limits[:-1], limits[1:], status[np.concatenate([[0], changes])])


def shade_zones(axes, x, status):
    for begin, end, value in zones(x, status):
        axes.axvspan(begin, end, color=ZONE_COLOUR[int(value)], linewidth=0, zorder=0)
    axes.grid(visible=False)


def contact_line(study):
    """2D: the profile of the contact boundary."""
    file = study.directory / "adaptive" / "contact.csv"
    table = read_table(file) if file.exists() else {}
    if not table:
        return None
    straight = len(set(table["boundary"])) == 1 and np.ptp(table["y"]) == 0
    x = table["x" if straight else "arc"]
    tangent = np.stack([-table["ny"], table["nx"]], axis=1)
    along = np.sum(friction(table) * tangent, axis=1)
    slip = np.sum(np.stack([table["slip_x"], table["slip_y"]], axis=1) * tangent, axis=1)
    limit = table["limit"]

    figure, (traction, distance) = plt.subplots(2, 1, figsize=(7.2, 4.8), sharex=True, layout="constrained",
                                                height_ratios=[1.35, 1])
    for axes in (traction, distance):
        shade_zones(axes, x, table["status"])
        axes.axhline(0, color="#777777", linewidth=0.6)
    traction.plot(x, table["pressure"], color=BLUE, label="pressure")
    traction.plot(x, along, color=RED, label="tangential traction")
    if np.any(limit > 0):
        traction.plot(x, limit, ":", color="black", linewidth=1, label="what friction can carry")
        traction.plot(x, -limit, ":", color="black", linewidth=1)
    top = 1.15 * np.quantile(table["pressure"], 0.99)
    traction.set_ylim(min(0, 1.15 * along.min(), -1.1 * np.quantile(limit, 0.9)), max(top, 1.1 * along.max()))
    traction.set_ylabel(study.with_unit("stress", "stress"))
    traction.set_title("Along the contact boundary")
    distance.plot(x, table["gap"], color=GREEN, label="gap that is left")
    distance.plot(x, slip, color=PURPLE, label="tangential displacement")
    distance.set_ylabel(study.with_unit("length", "length"))
    distance.set_xlabel("x" if straight else "length along the boundary")
    distance.set_xlim(x.min(), x.max())
    lines = sum((axes.get_legend_handles_labels()[0] for axes in (traction, distance)), [])
    shades = [Patch(color=ZONE_COLOUR[s], label=fields.STATUS_NAME[s]) for s in (TIED, STICK, SLIP, OPEN)
              if np.any(table["status"] == s)]
    legend_below(figure, lines + shades, 4, 2)
    return figure


def contact_surface(study):
    """3D: pressure, friction and status on the contact boundary, seen along its normal."""
    levels = study.drawn_levels("adaptive")
    contact = study.grid("adaptive", "contact", levels[-1]) if levels else None
    if contact is None:
        return None
    body = study.grid("adaptive", "level", levels[-1])
    normal = fields.contact_normal(contact, body)
    normal /= np.linalg.norm(normal)
    keep = [i for i in range(3) if i != np.argmax(np.abs(normal))]
    x, y = contact.points[:, keep].T
    data = contact.point_data
    traction = data["contact_traction"]
    tangential = np.linalg.norm(traction - np.outer(traction @ normal, normal), axis=1)
    shape = np.clip(np.ptp(x) / np.ptp(y), 0.4, 3)
    figure, (panels, bars) = plt.subplots(2, 3, figsize=(8.6, 2.6 / shape + 1.2), layout="constrained",
                                          height_ratios=[1, 0.13 * shape / 2.6])
    triangles = contact.corners()
    for axes, bar, values, title in ((panels[0], bars[0], data["contact_pressure"], "Pressure"),
                                     (panels[1], bars[1], tangential, "Tangential traction")):
        picture = axes.tripcolor(x, y, triangles, values, shading="gouraud", cmap="viridis", rasterized=True,
                                 vmin=0, vmax=max(np.quantile(values, 0.99), 1e-300))
        axes.set_title(title)
        figure.colorbar(picture, cax=bar, orientation="horizontal", extend="max")
    plane = contact.points[:, keep]
    status = fields.facet_status(contact)
    for value in np.unique(status):
        panels[2].add_patch(fields.PathPatch(fields.compound(plane[triangles[status == value]]),
                                             facecolor=fields.STATUS_COLOUR[value], edgecolor="white", linewidth=0.2,
                                             rasterized=len(status) > fields.MOST_VECTOR_CELLS))
    panels[2].set_title("Status")
    bars[2].set_axis_off()
    bars[2].legend(handles=[Patch(color=fields.STATUS_COLOUR[s], label=fields.STATUS_NAME[s])
                            for s in np.unique(status)], loc="center", ncols=3)
    for axes in panels:
        axes.set_aspect("equal")
        axes.grid(visible=False)
        axes.set_xlim(x.min(), x.max())
        axes.set_ylim(y.min(), y.max())
        axes.set_xlabel("xyz"[keep[0]])
    panels[0].set_ylabel("xyz"[keep[1]])
    return figure


def contact(study):
    return contact_line(study) if study.facts["d"] == 2 else contact_surface(study)


def maps(study):
    levels = study.drawn_levels("adaptive")
    if not levels:
        return None
    cells = study.column("adaptive", "cells")
    level = max((level for level in levels if cells[level] <= MOST_MAP_CELLS), default=levels[0])
    body, boundary = study.grid("adaptive", "level", level), study.grid("adaptive", "contact", level)
    if "stress_error" not in body.cell_data:
        return None
    view = view_of(body, boundary)
    pairs = [(f"The bound's share of each cell, level {level}", body.cell_data["eta_tot"]),
             ("Error of the stress in it", body.cell_data["stress_error"])]
    steps = fields.logarithmic_levels([values for _, values in pairs])
    colours = plt.get_cmap("viridis")
    figure, panels = plt.subplots(1, 2, figsize=(8.6, min(4.0 / panel_shape(body, view), 4.6) + 1.1), layout="constrained")
    for axes, (title, values) in zip(panels, pairs):
        picture = fields.draw_cell_map(axes, body, view, values, steps, colours)
        axes.set_title(title)
    bar = figure.colorbar(picture, ax=panels, orientation="horizontal", shrink=0.6, aspect=40, extend="min")
    ticks = LogLocator(subs=(1, 2, 5) if steps[-1] < 100 * steps[0] else (1,)).tick_values(steps[0], steps[-1])
    ticks = [tick for tick in ticks if steps[0] <= tick <= steps[-1]]
    bar.set_ticks(ticks, labels=[scientific(tick) for tick in ticks])
    bar.ax.minorticks_off()
    return figure
