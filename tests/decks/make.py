#!/usr/bin/python3
"""Writes the decks of the comparison with CalculiX: make.py FOLDER [NAME ...]

Small models of the kinds that CalculiX and PrePoMax come with; mm, N, MPa. What contact does not hold, symmetry does.
A component of a node is fixed by one set only and then carries no load, so that forces of sets can be compared. Of two
files for one deck, NAME.ccx.inp is for CalculiX, which knows no *PART.
"""

import math
import sys
from pathlib import Path

import axisymmetric
from bodies import Body, at, breaks, mesh_lines, node_set, surface
from keywords import SUPPORTS, SYMMETRIES, block, contact, fixed, material, moved, plane, planes, stack, step

DECKS = {}


def deck(function):
    name = function.__name__.lstrip("_")
    DECKS[name] = function
    return function


@deck
def _01_block_on_block():
    """Slave nodes on all lines of the master: else forces at nodes do not give a uniform pressure."""
    low, up = block("LOW", "C3D8", (0, 0, 0), (10, 10, 5), (3, 3, 3)), block("UP", "C3D8", (0, 0, 5), (10, 10, 10), (6, 6, 3))
    return [*stack(low, up), *contact("UP_BASE", "LOW_TOP", "NODE TO SURFACE", data="1.e6, 0.01"), *fixed(*SYMMETRIES),
            *step(*moved("TOP", 3, -0.01), supports=SUPPORTS)]


@deck
def _02_second_order():
    """A punch on a larger block, exponential law."""
    low = Body("LOW", "C3D20R", breaks(0, (10, 4), (20, 2)), breaks(0, (10, 4), (20, 2)), breaks(0, (10, 3)))
    up = block("UP", "C3D20R", (0, 0, 10), (10, 10, 20), (4, 4, 3))
    return [*stack(low, up, (10, 20)), *surface("LOADED", up, at(2, 20)),
            *contact("UP_BASE", "LOW_TOP", law="EXPONENTIAL", data="2.e-4, 1."), *fixed(*SYMMETRIES),
            *step("*DSLOAD", "LOADED, P, 50.", supports=["BASE", "SYM_X", "SYM_Y"], pairs=[("UP_BASE", "LOW_TOP")])]


@deck
def _03_tetrahedra():
    low = Body("LOW", "C3D10", breaks(0, (10, 3), (20, 2)), breaks(0, (10, 3), (20, 2)), breaks(0, (10, 3)))
    up = block("UP", "C3D10", (0, 0, 10), (10, 10, 20), (4, 4, 3))
    return [*stack(low, up, (10, 20)), *contact("UP_BASE", "LOW_TOP", mu=0.2), *fixed(*SYMMETRIES),
            *step(*moved("TOP", 3, -0.02), supports=SUPPORTS, pairs=[("UP_BASE", "LOW_TOP")])]


@deck
def _04_bolted_flange():
    """A quarter of two plates with a square bolt, tightened by cooling it; then the upper plate is pulled.

    Cells are small at the edges of the contact under the head and at its corner with the shank, where stresses are infinite.
    """
    side, cross = breaks(0, (4, 1), (5, 1), (7, 1), (8, 1), (12, 1)), breaks(0, (2, 1), (3, 1), (4, 1), (5, 1), (7, 1), (8, 1))
    low, up = (Body(name, "C3D10", side, side, breaks(z, (z + 1, 1), (z + 5, 1), (z + 6, 1)), keep=lambda x, y, z: max(x, y) > 4) for name, z in (("LOW", -6), ("UP", 0)))
    bolt = Body("BOLT", "C3D10", cross, cross, breaks(-10, (-7, 1), (-6, 1), (-5, 1), (5, 2), (6, 1), (7, 1), (10, 1)), keep=lambda x, y, z: abs(z) > 6 or max(x, y) < 3)
    bodies, pairs = (low, up, bolt), [("UP_BASE", "LOW_TOP"), ("HEAD", "SEAT"), ("FOOT", "SOLE")]
    ring = lambda height: lambda x, y, z: abs(z - height) < 1e-9 and max(x, y) < 8 + 1e-9
    under = lambda height: lambda x, y, z: abs(z - height) < 1e-9 and max(x, y) > 3 - 1e-9
    rest = lambda x, y, z: abs(z - 6) < 1e-9 and max(x, y) > 8 - 1e-9
    return [*mesh_lines(*bodies), *node_set("RIM", (low, at(0, 12))), *node_set("SYM_X", *((b, at(0, 0)) for b in bodies)),
            *node_set("SYM_Y", *((b, at(1, 0)) for b in bodies)), *surface("LIFTED", up, rest), *surface("LOW_TOP", low, at(2, 0)),
            *surface("UP_BASE", up, at(2, 0)), *surface("HEAD", bolt, under(6)), *surface("FOOT", bolt, under(-6)),
            *surface("SEAT", up, ring(6)), *surface("SOLE", low, ring(-6)), *material(bodies, more=["*EXPANSION", "1.2e-5"]),
            *(line for pair in pairs for line in contact(*pair)), *fixed(("RIM", 3, 3), ("SYM_X", 1, 1), ("SYM_Y", 2, 2)),
            "*INITIAL CONDITIONS, TYPE=TEMPERATURE", *(f"N{b.name}, 20." for b in bodies),
            *step("*TEMPERATURE", "NBOLT, -80.", supports=["RIM", "SYM_X", "SYM_Y"], pairs=pairs),
            *step("*DSLOAD", "LIFTED, P, -5.", supports=["RIM", "SYM_X", "SYM_Y"], pairs=pairs)]


def sheared(kind, cells, **options):
    """A block on a longer one, between walls in y."""
    low = Body("LOW", kind, breaks(0, (5, 2), (15, cells), (20, 2)), breaks(0, (5, 1)), breaks(0, (5, 2)), **options)
    up = block("UP", kind, (5, 0, 5), (15, 5, 10), (cells + 1, 1, 3), **options)
    mesh = mesh_lines(low, up)
    sides = [*node_set("BASE", (low, at(2, 0))), *node_set("TOP", (up, at(2, 10))),
             *node_set("WALL_0", (low, at(1, 0)), (up, at(1, 0))), *node_set("WALL_5", (low, at(1, 5)), (up, at(1, 5))),
             *surface("LOW_TOP", low, at(2, 5)), *surface("UP_BASE", up, at(2, 5)), *surface("LOADED", up, at(2, 10))]
    return [*mesh, *sides, *material((low, up))]


WALLS = ["*BOUNDARY", "BASE, 1", "BASE, 3", "WALL_0, 2, 2", "WALL_5, 2, 2"]


@deck
def _05_friction():
    """Pressed, then pushed until it slides, by an amplitude of the total time."""
    out = {"supports": ["BASE", "TOP"], "pairs": [("UP_BASE", "LOW_TOP")]}
    return ["*HEADING", "a block that is pushed, until it slides", *sheared("C3D20R", 4), *contact("UP_BASE", "LOW_TOP", mu=0.3),
            "*AMPLITUDE, NAME=PUSH, TIME=TOTAL TIME", "0., 0., 1., 0., 1.5, 0.2, 2., 1.", *WALLS,
            *step("*BOUNDARY", "TOP, 1, 1, 0.", "*DLOAD", *(f"LOADED_S{n}, P{n}, 60." for n in [2]), static="0.5, 1.", **out),
            *step(*moved("TOP", 1, 0.05, ", AMPLITUDE=PUSH"), static="0.1, 1.", **out)]


@deck
def _06_tie():
    low, up = block("LOW", "C3D20", (0, 0, 0), (10, 10, 8), (3, 3, 3)), block("UP", "C3D20R", (0, 0, 8), (10, 10, 16), (4, 4, 3))
    return [*mesh_lines(low, up), *node_set("BASE", (low, at(2, 0))), *node_set("TOP", (up, at(2, 16))),
            *surface("LOW_TOP", low, at(2, 8)), *surface("UP_BASE", up, at(2, 8)), *material((low, up)),
            "*TIE, NAME=GLUE, POSITION TOLERANCE=0.01, ADJUST=NO", "UP_BASE, LOW_TOP", *fixed(("BASE", 1, 3)),
            *step("*BOUNDARY", "TOP, 1, 1, 0.003", "TOP, 2, 2, 0.", "TOP, 3, 3, 0.01", supports=["BASE", "TOP"])]


@deck
def _07_press_fit():
    """A quarter of a ring on a hollow shaft that is 0.01 too thick; axially held."""
    polar = lambda r, angle, z: (r * math.cos(angle), r * math.sin(angle), z)
    ring = lambda name, r0, r1, n: Body(name, "C3D20R", breaks(r0, (r1, n)), breaks(0, (math.pi / 2, 8)), breaks(0, (3, 1)), where=polar)
    shaft, hub = ring("SHAFT", 5, 10.01, 3), ring("HUB", 10, 16, 4)
    both = lambda axis, value: [(shaft, at(axis, value)), (hub, at(axis, value))]
    radius = lambda r: lambda x, y, z: math.hypot(x, y) > r - 1e-9
    return [*mesh_lines(shaft, hub), *node_set("SYM_X", *both(0, 0)), *node_set("SYM_Y", *both(1, 0)), *node_set("END_0", *both(2, 0)),
            *node_set("END_3", *both(2, 3)), *surface("OUTSIDE", shaft, radius(10.01)), *surface("BORE", hub, lambda x, y, z: math.hypot(x, y) < 10 + 1e-9),
            *material((shaft, hub)), *contact("BORE", "OUTSIDE"), *fixed(("SYM_X", 1, 1), ("SYM_Y", 2, 2), ("END_0", 3, 3), ("END_3", 3, 3)),
            *step(supports=["SYM_X", "SYM_Y", "END_0", "END_3"], pairs=[("BORE", "OUTSIDE")])]


@deck
def _08_temperature():
    """A bar, tied to one wall, is heated until it meets the other wall."""
    wall_0, bar, wall_1 = (block(name, kind, (x, 0, 0), (x + length, 8, 8), (n, m, m)) for name, kind, x, length, n, m in
                           (("WALL_A", "C3D15", -4, 4, 2, 2), ("BAR", "C3D20", 0, 20, 6, 3), ("WALL_B", "C3D15", 20.004, 4, 2, 2)))
    bodies = wall_0, bar, wall_1
    walls = wall_0, wall_1
    return [*mesh_lines(*bodies), *node_set("FIX_A", (wall_0, at(0, -4))), *node_set("FIX_B", (wall_1, at(0, 24.004))),
            *node_set("SYM_Y", *((wall, at(1, 0)) for wall in walls)), *node_set("SYM_Z", *((wall, at(2, 0)) for wall in walls)),
            *surface("FACE_A", wall_0, at(0, 0)), *surface("END_A", bar, at(0, 0)), *surface("END_B", bar, at(0, 20)),
            *surface("FACE_B", wall_1, at(0, 20.004)), *material(bodies, more=["*EXPANSION, ZERO=0.", "1.2e-5"]),
            "*TIE, NAME=GLUE", "END_A, FACE_A", *contact("END_B", "FACE_B"),
            *fixed(("FIX_A", 1, 1), ("FIX_B", 1, 1), ("SYM_Y", 2, 2), ("SYM_Z", 3, 3)),
            "*INITIAL CONDITIONS, TYPE=TEMPERATURE", *(f"N{b.name}, 20." for b in bodies),
            *step("*TEMPERATURE", "NBAR, 120.", "NWALL_A, 120.", supports=["FIX_A", "FIX_B", "SYM_Y", "SYM_Z"], pairs=[("END_B", "FACE_B")])]


@deck
def _09_cyclic_shear():
    """Pressed, then to and fro in steps of their own; parts of the contact stick."""
    out = {"supports": ["BASE", "TOP"], "pairs": [("UP_BASE", "LOW_TOP")]}
    waves = {"OUT": "0., 0., 1., 1.", "BACK": "0., 1., 1., -1.", "FORTH": "0., -1., 0.5, 0., 1., 1."}
    return [*sheared("C3D20R", 4), *contact("UP_BASE", "LOW_TOP", mu=0.3),
            *(line for name, values in waves.items() for line in (f"*AMPLITUDE, NAME={name}", values)), *WALLS,
            *step(*moved("TOP", 1, 0), *moved("TOP", 3, -0.005), static="0.5, 1.", **out),
            *(line for name in waves for line in step(*moved("TOP", 1, 0.006, f", AMPLITUDE={name}"), static="0.1, 1.", **out))]


@deck
def _10_generate():
    """All sets by GENERATE; *CLEARANCE."""
    low, up = block("LOW", "C3D8", (0, 0, 0), (10, 10, 5), (4, 4, 3)), block("UP", "C3D8", (0, 0, 5), (10, 10, 10), (4, 4, 3))
    text = mesh_lines(low, up)
    n = up.first_node  # 25 nodes a level
    sets = {"BASE": [(1, 25, 1)], "TOP": [(n + 75, n + 99, 1)], "SYM_X": [(1, n + 95, 5)],
            "SYM_Y": [(1 + 25 * level, 5 + 25 * level, 1) for level in range(8)]}
    cells = {"LAYER": (3, 48, 3), "FOOT": (up.first_element, up.first_element + 45, 3)}  # columns of 3
    for name, ranges in sets.items():
        text += [f"*NSET, NSET={name}, GENERATE", *(", ".join(map(str, r)) for r in ranges)]
    for name, numbers in cells.items():
        text += [f"*ELSET, ELSET={name}, GENERATE", ", ".join(map(str, numbers))]
    return [*text, "*SURFACE, NAME=LOW_TOP", "LAYER, S2", "*SURFACE, NAME=UP_BASE", "FOOT, S1", *material((low, up)),
            *contact("UP_BASE", "LOW_TOP"), "*CLEARANCE, MASTER=LOW_TOP, SLAVE=UP_BASE, VALUE=0.002", *fixed(*SYMMETRIES),
            *step(*moved("TOP", 3, -0.01), supports=SUPPORTS, pairs=[("UP_BASE", "LOW_TOP")])]


def instanced(assembled):
    """The same body twice, the upper one shifted and turned; as parts, or flat."""
    body = block("CUBE", "C3D8I", (0, 0, 0), (8, 8, 4), (4, 4, 2))
    turned = block("CUBE", "C3D8I", (0, 0, 0), (8, 8, 4), (4, 4, 2), where=lambda x, y, z: (8 - y, x, z + 4))
    turned.name = "CUBE2"
    ends = lambda b, z: [*node_set("FOOT", (b, at(2, z))), *node_set("HEAD", (b, at(2, z + 4)))]
    if assembled:
        mesh = ["*PART, NAME=BLOCK", *mesh_lines(body), *ends(body, 0), *surface("BELOW", body, at(2, 0)), *surface("ABOVE", body, at(2, 4)),
                "*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL", "*END PART", "*ASSEMBLY, NAME=PAIR", "*INSTANCE, NAME=LOW, PART=BLOCK", "*END INSTANCE",
                "*INSTANCE, NAME=UP, PART=BLOCK", "8., 0., 4.", "8., 0., 4., 8., 0., 5., 90.", "*END INSTANCE", "*END ASSEMBLY",
                "*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3"]
        return mesh, "LOW.", "UP."
    mesh = [*mesh_lines(body, turned)]
    for prefix, b, z in (("LOW_", body, 0), ("UP_", turned, 4)):
        mesh += [*node_set(prefix + "FOOT", (b, at(2, z))), *node_set(prefix + "HEAD", (b, at(2, z + 4))),
                 *surface(prefix + "BELOW", b, at(2, z)), *surface(prefix + "ABOVE", b, at(2, z + 4))]
    return [*mesh, *material((body, turned))], "LOW_", "UP_"


@deck
def _11_instances():
    files = {}
    for suffix, assembled in (("", True), (".ccx", False)):
        mesh, low, up = instanced(assembled)
        files[suffix] = [*mesh, *contact(up + "BELOW", low + "ABOVE", mu=0.4), *fixed((low + "FOOT", 1, 3)),
                         *step("*BOUNDARY", f"{up}HEAD, 1, 1, 0.001", f"{up}HEAD, 2, 2, 0.", f"{up}HEAD, 3, 3, -0.01",
                               supports=[low + "FOOT", up + "HEAD"], pairs=[(up + "BELOW", low + "ABOVE")], static="0.1, 1.")]
    return files


@deck
def _12_include():
    low, up = block("LOW", "C3D20", (0, 0, 0), (10, 10, 5), (2, 2, 1)), block("UP", "C3D20", (0, 0, 5), (10, 10, 10), (3, 3, 1))
    return {".mesh": [*mesh_lines(low, up), *planes(low, up, (5, 10))],
            "": ["*INCLUDE, INPUT=12_include.mesh.inp", *material((low, up), nu=0.2), *contact("UP_BASE", "LOW_TOP"), *fixed(*SYMMETRIES),
                 *step(*moved("TOP", 3, -0.01), supports=SUPPORTS, pairs=[("UP_BASE", "LOW_TOP")])]}


@deck
def _13_plane_strain():
    return [*plane("CPE8", "CPE8R"), *step(*moved("TOP", 2, -0.02), supports=["BASE", "TOP", "SYM_X"], pairs=[("UP_BASE", "LOW_TOP")])]


@deck
def _14_plane_stress():
    return [*plane("CPS8", "CPS6", thickness=2.5), *step("*DSLOAD", "LOADED, P, 40.", supports=["BASE", "SYM_X"], pairs=[("UP_BASE", "LOW_TOP")])]


@deck
def _15_prisms():
    low, up = block("LOW", "C3D6", (0, 0, 0), (10, 10, 5), (3, 3, 2)), block("UP", "C3D6", (0, 0, 5), (10, 10, 10), (4, 4, 2))
    return [*stack(low, up), *contact("UP_BASE", "LOW_TOP"), *fixed(*SYMMETRIES),
            *step(*moved("TOP", 3, -0.01), supports=SUPPORTS, pairs=[("UP_BASE", "LOW_TOP")], more=", NLGEOM")]


@deck
def _16_gravity():
    """A heavy soft block on one without weight: forces of supports would contain the loads of their nodes."""
    low, up = block("LOW", "C3D8", (0, 0, 0), (60, 60, 30), (6, 6, 3)), block("UP", "C3D8", (0, 0, 30), (40, 40, 90), (4, 4, 5))
    return [*mesh_lines(low, up), *planes(low, up, (30, 90)), *material((low, up), E=30, nu=0.3, name="CLAY", more=["*DENSITY", "2.e-9"]),
            *contact("UP_BASE", "LOW_TOP", data="30., 1.e-6", mu=0.5, kind="NODE TO SURFACE"), *fixed(*SYMMETRIES),
            *step("*DLOAD", "UP, GRAV, 9810., 0., 0., -1.", supports=["BASE", "SYM_X", "SYM_Y"])]


@deck
def _17_pressure():
    """Pressure in both forms, hard contact."""
    low, up = block("LOW", "C3D20R", (0, 0, 0), (10, 10, 5), (3, 3, 2)), block("UP", "C3D20R", (0, 0, 5), (10, 10, 10), (3, 3, 2))
    return [*stack(low, up), *surface("SIDE", up, at(0, 10)), *surface("LID", up, at(2, 10)), *contact("UP_BASE", "LOW_TOP", law="HARD", data=None),
            *fixed(*SYMMETRIES), *step("*DSLOAD", "SIDE, P, 30.", "*DLOAD", "LID_S2, P2, 80.", supports=["BASE", "SYM_X", "SYM_Y"], pairs=[("UP_BASE", "LOW_TOP")])]


def nodal_forces(body, on, traction):
    """The consistent nodal forces of a uniform traction on faces of six-node triangles: a third at each middle."""
    forces = {}
    for element, face in body.faces(on):
        corners, middles = body.face_nodes(element, face)
        a, b, c = (body.points[n] for n in corners)
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        area = math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
        for node in middles:
            forces[node] = forces.get(node, 0) + area / 3
    return [f"{body.first_node + node}, {axis + 1}, {force * t:.10g}" for node, force in sorted(forces.items()) for axis, t in enumerate(traction) if t]


@deck
def _18_nodal_forces():
    """A uniform oblique traction, given by its nodal forces."""
    low = Body("LOW", "C3D10", breaks(0, (10, 3), (15, 1)), breaks(0, (10, 3)), breaks(0, (6, 2)))
    up = block("UP", "C3D10", (0, 0, 6), (10, 10, 12), (4, 4, 2))
    stop = lambda x, y, z: abs(x) < 1e-9 and z < 9 + 1e-9
    return [*mesh_lines(low, up), *planes(low, up, (6, 12)), *node_set("STOP", (up, stop)), *surface("LOADED", up, at(2, 12)),
            *material((low, up)), *contact("UP_BASE", "LOW_TOP", mu=0.1), *fixed(("BASE", 3, 3), ("BASE", 1, 1), ("STOP", 1, 1), ("SYM_Y", 2, 2)),
            *step("*CLOAD", *nodal_forces(up, at(2, 12), (-8, 0, -60)), supports=["BASE", "STOP", "SYM_Y"], pairs=[("UP_BASE", "LOW_TOP")])]


@deck
def _19_hertz():
    """A quarter of a ball of radius 200, a parabola near the point of contact, on a block."""
    fine = breaks(0, (2.5, 5), (5, 2))
    cap = Body("CAP", "C3D20R", fine, fine, breaks(0, (1, 2), (5, 1)), where=lambda x, y, z: (x, y, 5 + z + (x * x + y * y) / 400 * (1 - z / 5)))
    low = Body("LOW", "C3D20R", fine, fine, breaks(0, (4, 1), (5, 2)))
    bottom = lambda x, y, z: abs(z - 5 - (x * x + y * y) / 400) < 1e-9
    return [*mesh_lines(cap, low), *node_set("BASE", (low, at(2, 0))), *node_set("TOP", (cap, at(2, 10))), *node_set("SYM_X", (low, at(0, 0)), (cap, at(0, 0))),
            *node_set("SYM_Y", (low, at(1, 0)), (cap, at(1, 0))), *surface("LOW_TOP", low, at(2, 5)), *surface("BALL", cap, bottom), *material((cap, low)),
            *contact("BALL", "LOW_TOP", data="1.e7"), *fixed(*SYMMETRIES),
            *step(*moved("TOP", 3, -0.02), supports=SUPPORTS, pairs=[("BALL", "LOW_TOP")])]


@deck
def _20_prepomax():
    low = block("Solid_part-1", "C3D10", (0, 0, 0), (20, 12, 6), (5, 3, 2))
    up = block("Solid_part-2", "C3D10", (6, 0, 6), (14, 12, 14), (3, 4, 2))
    loaded, prefix = at(2, 14), "Internal_Selection-1_"
    mesh = [*mesh_lines(low, up), *node_set(prefix + "Fixed-1", (low, at(2, 0))), *node_set(prefix + "Displacement-1", (up, at(1, 0))),
            *surface(prefix + "Pressure-1", up, loaded), *surface("Master_Surface-1", low, at(2, 6)), *surface("Slave_Surface-1", up, at(2, 6))]
    pressure = [f"{prefix}Pressure-1_S{n}, P{n}, 100" for n in sorted({face for _, face in up.faces(loaded)})]
    return (Path(__file__).parent / "prepomax.txt").read_text().format(mesh="\n".join(mesh), pressure="\n".join(pressure)).splitlines()


DECKS |= axisymmetric.DECKS


def write(folder, names=(), refinement=1):
    """The decks, and the paths of those for Tribound and for CalculiX, by name."""
    Body.refinement = refinement
    folder.mkdir(parents=True, exist_ok=True)
    paths = {}
    for name, make in DECKS.items():
        if names and name not in names:
            continue
        files = make()
        files = files if isinstance(files, dict) else {"": files}
        for suffix, text in files.items():
            (folder / f"{name}{suffix}.inp").write_text("\n".join(text) + "\n")
        paths[name] = folder / f"{name}.inp", folder / f"{name}{'.ccx' if '.ccx' in files else ''}.inp"
    return paths


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    write(Path(sys.argv[1]), sys.argv[2:])
