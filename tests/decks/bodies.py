"""Bodies of structured meshes for the decks: nodes, elements, and the sets and surfaces on them.

A body begins as a grid of bricks (quadrilaterals in 2D). Bricks may be left out, cut into tetrahedra or prisms, given
middle nodes and mapped. Faces have the numbers of Abaqus and CalculiX.
"""

import itertools

# Corners of the faces, and edges in the order of their middle nodes.
FACES = {
    "tri": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tet": [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
    "wedge": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    "brick": [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
}
EDGES = {
    "tri": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tet": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "brick": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
}
SHAPES = {"3": "tri", "4": "quad", "6": "tri", "8": "quad"}, {"4": "tet", "10": "tet", "6": "wedge", "15": "wedge", "8": "brick", "20": "brick"}
CORNERS = {"tri": 3, "quad": 4, "tet": 4, "wedge": 6, "brick": 8}
# Pieces of a brick whose faces fit those of its neighbours.
PRISMS = [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)]
TETRAHEDRA = [(0, a, b, 6) for a, b in [(1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)]]


def breaks(*parts):
    """Coordinates from pairs (end, cells) behind a start: breaks(0, (3, 2), (8, 1)) = [0, 1.5, 3, 8]."""
    points = [float(parts[0])]
    for end, cells in parts[1:]:
        start = points[-1]
        points += [start + (end - start) * (i + 1) / cells for i in range(cells)]
    return points


class Body:
    """`kind` is the type of the deck, such as C3D20R or CPE4; `keep` takes the centre of a brick."""

    refinement = 1  # how many cells along each axis become of one

    def __init__(self, name, kind, *axes, keep=lambda *centre: True, where=lambda *point: point):
        axes = [breaks(axis[0], *((end, self.refinement) for end in axis[1:])) for axis in axes]
        digits = kind[3:].rstrip("RI")
        self.name, self.kind, self.dim = name, kind, len(axes)
        self.shape = SHAPES[self.dim - 2][digits]
        grid = list(itertools.product(*(range(len(axis) - 1) for axis in axes)))
        centre = lambda cell: [(axis[i] + axis[i + 1]) / 2 for axis, i in zip(axes, cell)]
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        corners = corners if self.dim == 2 else [(*c, k) for k in (0, 1) for c in corners]
        bricks = [[tuple(i + d for i, d in zip(cell, corner)) for corner in corners] for cell in grid if keep(*centre(cell))]
        used = sorted({point for brick in bricks for point in brick}, key=lambda p: p[::-1])
        number = {point: i for i, point in enumerate(used)}
        self.points = [tuple(where(*(axis[i] for axis, i in zip(axes, point)))) for point in used]
        pieces = {"tri": [(0, 1, 2), (0, 2, 3)], "wedge": PRISMS, "tet": TETRAHEDRA}.get(self.shape, [range(len(corners))])
        self.elements = [[number[brick[i]] for i in piece] for brick in bricks for piece in pieces]
        if int(digits) > CORNERS[self.shape]:
            self.add_middles()
        self.first_node = self.first_element = None  # until mesh_lines

    def add_middles(self):
        middles = {}
        for element in self.elements:
            for a, b in EDGES[self.shape]:
                edge = tuple(sorted((element[a], element[b])))
                if edge not in middles:
                    middles[edge] = len(self.points)
                    self.points.append(tuple((x + y) / 2 for x, y in zip(*(self.points[i] for i in edge))))
                element.append(middles[edge])

    def nodes(self, on):
        """Numbers of the nodes at points where on(x, y[, z]) holds."""
        return [self.first_node + i for i, point in enumerate(self.points) if on(*point)]

    def faces(self, on):
        """(element, face) all of whose corners are on it, from 1."""
        marked = [on(*point) for point in self.points]
        return [
            (self.first_element + e, f + 1)
            for e, element in enumerate(self.elements)
            for f, face in enumerate(FACES[self.shape])
            if all(marked[element[corner]] for corner in face)
        ]

    def face_nodes(self, element, face):
        """Corners, then middles, of a face, as places among the points."""
        nodes = self.elements[element - self.first_element]
        corners = FACES[self.shape][face - 1]
        edges = [tuple(sorted((a, b))) for a, b in EDGES[self.shape]]
        sides = [tuple(sorted((a, b))) for a, b in zip(corners, (*corners[1:], corners[0]))][: 1 if self.dim == 2 else None]
        has_middles = len(nodes) > CORNERS[self.shape]
        return [nodes[i] for i in corners], [nodes[CORNERS[self.shape] + edges.index(s)] for s in sides] if has_middles else []


def at(axis, value, tolerance=1e-9):
    """The points on a plane: at(2, 5) is z = 5."""
    return lambda *point: abs(point[axis] - value) < tolerance


def lines(numbers, per_line=16):
    return [", ".join(str(n) for n in numbers[i : i + per_line]) for i in range(0, len(numbers), per_line)]


def mesh_lines(*bodies, width=16):
    """*NODE and *ELEMENT of all bodies, numbered one after the other; each an element set of its name."""
    node = element = 1
    text = []
    for body in bodies:
        body.first_node, body.first_element = node, element
        text.append(f"*NODE, NSET=N{body.name}")
        text += [f"{node + i}, " + ", ".join(f"{x:.10g}" for x in (*point, 0.0)[:3]) for i, point in enumerate(body.points)]
        text.append(f"*ELEMENT, TYPE={body.kind}, ELSET={body.name}")
        for i, nodes in enumerate(body.elements):
            text += continued([element + i, *(node + n for n in nodes)], width)
        node, element = node + len(body.points), element + len(body.elements)
    return text


def continued(numbers, width=16):
    rows = lines(numbers, width)
    return [row + "," for row in rows[:-1]] + rows[-1:]


def node_set(name, *parts):
    """parts: (body, on)."""
    return [f"*NSET, NSET={name}", *lines([n for body, on in parts for n in body.nodes(on)])]


def surface(name, body, on):
    """One element set for each number of a face, as PrePoMax writes surfaces."""
    faces, text, entries = body.faces(on), [], []
    for number in sorted({f for _, f in faces}):
        text += [f"*ELSET, ELSET={name}_S{number}", *lines([e for e, f in faces if f == number])]
        entries.append(f"{name}_S{number}, S{number}")
    return [*text, f"*SURFACE, NAME={name}, TYPE=ELEMENT", *entries]
