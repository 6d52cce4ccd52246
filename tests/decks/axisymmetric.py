"""Decks of axisymmetric elements: what make.py is for bodies of revolution. x is the distance from the axis, y runs along it."""

import math

from bodies import Body, at, breaks, lines, mesh_lines, node_set, surface
from keywords import contact, fixed, material, moved, plane, step


def thick_cylinder():
    """A piece of a thick cylinder between two planes, pressed from inside."""
    ring = Body("RING", "CAX8R", breaks(10, (20, 5)), breaks(0, (5, 3)))
    return [*mesh_lines(ring), *node_set("END_0", (ring, at(1, 0))), *node_set("END_5", (ring, at(1, 5))), *surface("BORE", ring, at(0, 10)),
            *material([ring]), *fixed(("END_0", 2, 2), ("END_5", 2, 2)), *step("*DSLOAD", "BORE, P, 50.", supports=["END_0", "END_5"])]


def ring_forces(body, on, traction):
    """The consistent nodal forces, over the full circle, of a uniform axial traction on edges of three nodes across the axis: Simpson's rule."""
    forces = {}
    for element, face in body.faces(on):
        (a, b), (middle,) = body.face_nodes(element, face)
        length = abs(body.points[a][0] - body.points[b][0])
        for node, share in ((a, 1 / 6), (b, 1 / 6), (middle, 4 / 6)):
            forces[node] = forces.get(node, 0) + 2 * math.pi * body.points[node][0] * share * length * traction
    return [f"{body.first_node + node}, 2, {force:.10g}" for node, force in sorted(forces.items())]


def spinning_ring():
    """A ring that spins, and is pulled along its axis by nodal forces."""
    ring = Body("RING", "CAX6", breaks(20, (24, 4), (30, 6)), breaks(0, (8, 8), (12, 4)), keep=lambda r, z: r < 24 or z < 8)
    return [*mesh_lines(ring), *node_set("BASE", (ring, at(1, 0))), *material([ring], more=["*DENSITY", "7.8e-9"]), *fixed(("BASE", 2, 2)),
            *step("*DLOAD", "RING, CENTRIF, 1.e6, 0., 0., 0., 0., 1., 0.", "*CLOAD", *ring_forces(ring, at(1, 12), 20), supports=["BASE"])]


def weight():
    """A cylinder and a ring around it stand on a plane. Their upper halves are heavy: forces of supports would contain the loads of their nodes."""
    bodies = Body("DISC", "CAX4", breaks(0, (10, 8)), breaks(0, (20, 16))), Body("RING", "CAX3", breaks(15, (25, 8)), breaks(0, (20, 16)))
    mesh = mesh_lines(*bodies)
    heavy = [body.first_element + e for body in bodies for e, nodes in enumerate(body.elements) if all(body.points[n][1] > 10 - 1e-9 for n in nodes)]
    return [*mesh, "*ELSET, ELSET=HEAVY", *lines(heavy), *node_set("BASE", *((body, at(1, 0)) for body in bodies)), *node_set("AXIS", (bodies[0], at(0, 0))),
            *material(bodies, E=50, nu=0.3, more=["*DENSITY", "1.2e-6"]), *fixed(("BASE", 2, 2), ("AXIS", 1, 1)),
            *step("*DLOAD", "HEAVY, GRAV, 9810., 0., -1., 0.", supports=["BASE"])]


def pressed_cylinder():
    """A cylinder is pressed on a wider one; the meshes match there."""
    return [*plane("CAX8", "CAX8R", cells_below=5), *step(*moved("TOP", 2, -0.02), supports=["BASE", "TOP"], pairs=[("UP_BASE", "LOW_TOP")])]


def shrunk_ring():
    """A ring on a hollow shaft that is 0.01 too thick, between two planes; the meshes match."""
    shaft, hub = Body("SHAFT", "CAX8R", breaks(5, (10, 4)), breaks(0, (3, 2))), Body("HUB", "CAX8R", breaks(10, (16, 5)), breaks(0, (3, 2)))
    ends = {f"{name}_{z}": (body, at(1, z)) for name, body in (("SHAFT", shaft), ("HUB", hub)) for z in (0, 3)}
    return [*mesh_lines(shaft, hub), *(line for name, on in ends.items() for line in node_set(name, on)), *surface("OUTSIDE", shaft, at(0, 10)),
            *surface("BORE", hub, at(0, 10)), *material((shaft, hub)), *contact("BORE", "OUTSIDE"), "*CLEARANCE, MASTER=OUTSIDE, SLAVE=BORE, VALUE=-0.01",
            *fixed(*((name, 2, 2) for name in ends)),
            *step(supports=list(ends), pairs=[("BORE", "OUTSIDE")])]


def hot_shaft():
    """A hollow shaft between two planes becomes hot and presses on the ring around it, which becomes less so and has no plane above. The meshes match."""
    shaft, hub = Body("SHAFT", "CAX8R", breaks(5, (10, 4)), breaks(0, (6, 4))), Body("HUB", "CAX6", breaks(10, (16, 5)), breaks(0, (6, 4)))
    return [*mesh_lines(shaft, hub), *node_set("BASE", (shaft, at(1, 0)), (hub, at(1, 0))), *node_set("END", (shaft, at(1, 6))),
            *surface("OUTSIDE", shaft, at(0, 10)), *surface("BORE", hub, at(0, 10)),
            *material((shaft, hub), more=["*EXPANSION, ZERO=20.", "1.2e-5"]), *contact("BORE", "OUTSIDE"), *fixed(("BASE", 2, 2), ("END", 2, 2)),
            "*INITIAL CONDITIONS, TYPE=TEMPERATURE", "NSHAFT, 20.", "NHUB, 20.",
            *step("*TEMPERATURE", "NSHAFT, 170.", "NHUB, 50.", supports=["BASE", "END"], pairs=[("BORE", "OUTSIDE")])]


def rigid_lid():
    """A ring under a lid that is rigid: a force on its reference node, of the full circle, presses it on a wider ring."""
    low, up = Body("LOW", "CAX8", breaks(2, (4, 2), (10, 6), (14, 4)), breaks(0, (6, 4))), Body("UP", "CAX8R", breaks(4, (10, 6)), breaks(6, (12, 4)))
    lid, rotation = 90001, 90002
    return [*mesh_lines(low, up), "*NODE", f"{lid}, 0., 15., 0.", f"{rotation}, 0., 15., 0.", *node_set("BASE", (low, at(1, 0))), *node_set("LID", (up, at(1, 12))),
            *surface("LOW_TOP", low, at(1, 6)), *surface("UP_BASE", up, at(1, 6)), *material((low, up)), *contact("UP_BASE", "LOW_TOP", "NODE TO SURFACE", mu=0.25),
            f"*RIGID BODY, NSET=LID, REF NODE={lid}, ROT NODE={rotation}", *fixed(("BASE", 2, 2), (lid, 1, 1), (lid, 3, 3), (rotation, 1, 3)),
            *step("*CLOAD", f"{lid}, 2, -5.e4", supports=["BASE"])]


DECKS = {"21_thick_cylinder": thick_cylinder, "22_spinning_ring": spinning_ring, "23_weight": weight, "24_pressed_cylinder": pressed_cylinder, "25_shrunk_ring": shrunk_ring,
         "26_hot_shaft": hot_shaft, "27_rigid_lid": rigid_lid}
