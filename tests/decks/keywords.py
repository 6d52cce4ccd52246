"""Keywords of decks for CalculiX: lists of lines."""

from bodies import Body, at, breaks, mesh_lines, node_set, surface


def material(bodies, E=210e3, nu=0.3, name="STEEL", more=(), thickness=None):
    text = [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{E:g}, {nu:g}", *more]
    for body in bodies:
        text += [f"*SOLID SECTION, ELSET={body.name}, MATERIAL={name}", *([f"{thickness:g}"] if thickness else [])]
    return text


def contact(slave, master, kind="SURFACE TO SURFACE", law="LINEAR", data="1.e6", mu=None, options=""):
    friction = ["*FRICTION", f"{mu:g}, 1.e5"] if mu else []
    return [f"*SURFACE INTERACTION, NAME=I_{slave}", f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={law}", *([data] if data else []), *friction,
            f"*CONTACT PAIR, INTERACTION=I_{slave}, TYPE={kind}{options}", f"{slave}, {master}"]


def step(*loads, supports, pairs=(), static="0.25, 1.", more=""):
    """pairs: (slave, master) whose forces are printed; node to surface has no such output."""
    text = ["*STEP" + more, "*STATIC", static, *loads]
    for support in supports:
        text += [f"*NODE PRINT, NSET={support}, TOTALS=ONLY, FREQUENCY=100", "RF"]
    for slave, master in pairs:
        text += [f"*CONTACT PRINT, SLAVE={slave}, MASTER={master}, FREQUENCY=100", "CF"]
    return [*text, "*NODE FILE, FREQUENCY=100", "U, RF", "*EL FILE, FREQUENCY=100", "S, E", "*END STEP"]


def fixed(*sets):
    """(name, first, last)."""
    return ["*BOUNDARY", *(f"{name}, {first}, {last}" for name, first, last in sets)]


def moved(name, axis, value, options=""):
    return [f"*BOUNDARY{options}", f"{name}, {axis}, {axis}, {value:g}"]


def block(name, kind, lower, upper, cells, **options):
    return Body(name, kind, *(breaks(a, (b, n)) for a, b, n in zip(lower, upper, cells)), **options)


def planes(low, up, z):
    """Base, top, symmetry in x and y of two stacked bodies, and the surfaces between them."""
    return [*node_set("BASE", (low, at(2, 0))), *node_set("TOP", (up, at(2, z[1]))), *node_set("SYM_X", (low, at(0, 0)), (up, at(0, 0))),
            *node_set("SYM_Y", (low, at(1, 0)), (up, at(1, 0))), *surface("LOW_TOP", low, at(2, z[0])), *surface("UP_BASE", up, at(2, z[0]))]


SUPPORTS = ["BASE", "TOP", "SYM_X", "SYM_Y"]
SYMMETRIES = [("BASE", 3, 3), ("SYM_X", 1, 1), ("SYM_Y", 2, 2)]


def stack(low, up, z=(5, 10)):
    return [*mesh_lines(low, up), *planes(low, up, z), *material((low, up))]


def plane(kind_low, kind_up, cells_below=4, thickness=None):
    """A body on a wider one, in the plane or on the meridian; SYM_X is the plane of symmetry, or the axis."""
    low = Body("LOW", kind_low, breaks(0, (8, cells_below), (16, 3)), breaks(0, (8, 5)))
    up = Body("UP", kind_up, breaks(0, (8, 5)), breaks(8, (16, 5)))
    return [*mesh_lines(low, up), *node_set("BASE", (low, at(1, 0))), *node_set("TOP", (up, at(1, 16))), *node_set("SYM_X", (low, at(0, 0)), (up, at(0, 0))),
            *surface("LOW_TOP", low, at(1, 8)), *surface("UP_BASE", up, at(1, 8)), *surface("LOADED", up, at(1, 16)),
            *material((low, up), thickness=thickness), *contact("UP_BASE", "LOW_TOP", mu=0.25), *fixed(("BASE", 2, 2), ("SYM_X", 1, 1))]
