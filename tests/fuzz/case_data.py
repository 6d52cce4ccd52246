"""A case file as the judge reads it: docs/case-format.md. Of a mesh only the positions of its groups are known."""

import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from formulas import formula

NUMBER = r"[-+]?[\d.]+(?:[eE][-+]?\d+)?"


@dataclass
class Material:
    """sigma = lam tr(eps) I + 2 mu eps; in plane stress lam is the reduced value."""

    E: float
    lam: float
    mu: float
    beta: float  # pressure per degree where nothing can expand in the plane


@dataclass
class InitialStress:
    """sigma_0 = entries - beta (temperature - reference) I."""

    entries: dict  # (row, column) -> Formula
    temperature: object  # Formula
    reference: object  # Formula
    beta: float

    def formulas(self):
        return [*self.entries.values(), self.temperature, self.reference]

    def __call__(self, places):
        d = places.shape[1]
        heated = self.beta * (self.temperature(places) - self.reference(places))
        result = -heated[:, None, None] * np.eye(d)
        for (i, j), entry in self.entries.items():
            result[:, i, j] += entry(places)
            if i != j:
                result[:, j, i] += entry(places)
        return result


@dataclass
class Condition:
    """The conditions on a named boundary."""

    displacement: list  # per component a Formula or None
    traction: list  # Formulas
    pressure: object  # Formula
    contact: dict | None = None  # friction, gap, threshold, coefficient
    spring: dict | None = None  # normal, tangential, rest


@dataclass
class Case:
    file: Path
    table: dict
    dimension: int
    sides: dict  # boundary -> simplices x (dimension) x dimension
    areas: dict = field(default_factory=dict)  # region -> measure, where known

    @property
    def degree(self):
        return self.table.get("degree", 1)

    @property
    def gamma0(self):
        default = 10.0 if self.degree <= 3 else 48.0
        return float(self.table.get("nitsche", {}).get("gamma0", default))

    @property
    def is_axisymmetric(self):
        return self.table.get("model") == "axisymmetric"

    @property
    def full_circle(self):
        """By which integrals over the meridian are multiplied in the certificate."""
        return 2 * np.pi if self.is_axisymmetric else 1.0

    def get(self, dotted, default):
        value = self.table
        for key in dotted.split("."):
            if not isinstance(value, dict) or key not in value:
                return default
            value = value[key]
        return value

    def material(self, region):
        common = self.table["material"]
        own = common[region] if isinstance(common.get(region), dict) else common
        plane = own.get("plane", common.get("plane", "strain"))
        E, nu, alpha = (number(own.get(key, common.get(key, 0))) for key in ("E", "nu", "alpha"))
        lam, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
        if plane == "stress":
            return Material(E, 2 * lam * mu / (lam + 2 * mu), mu, E * alpha / (1 - nu))
        return Material(E, lam, mu, E * alpha / (1 - 2 * nu))

    def body_force(self, region):
        return [formula(f) for f in self.load(region).get("body", [0] * self.dimension)]

    def load(self, region):
        common = self.table.get("load", {})
        return common[region] if isinstance(common.get(region), dict) else common

    def initial_stress(self, region):
        load = self.load(region)
        axes = [(0, 0), (1, 1), (0, 1)] if self.dimension == 2 else [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
        entries = {at: formula(f) for at, f in zip(axes, load.get("initial_stress", []))}
        beta = self.material(region).beta
        return InitialStress(entries, formula(load.get("temperature", 0)), formula(load.get("reference_temperature", 0)), beta)

    def condition(self, name):
        own = self.table.get("boundary", {}).get(name, {})
        fixed = own.get("displacement", ["free"] * self.dimension)
        contact = own.get("contact")
        if "slider" in own:
            contact = {"friction": "slider", "gap": own["slider"]}
        if contact is not None:
            contact = {
                "friction": contact.get("friction", "none"),
                "gap": formula(contact.get("gap", 0)),
                "threshold": formula(contact.get("threshold", 0)),
                "coefficient": number(contact.get("coefficient", 0)),
            }
        spring = own.get("spring")
        if spring is not None:
            both = {"normal": spring, "tangential": spring}
            keys = spring if isinstance(spring, dict) else both
            spring = {
                "normal": formula(keys.get("normal", 0)),
                "tangential": formula(keys.get("tangential", 0)),
                "rest": [formula(f) for f in keys.get("rest", [0] * self.dimension)],
            }
        return Condition(
            [None if f == "free" else formula(f) for f in fixed],
            [formula(f) for f in own.get("traction", [0] * self.dimension)],
            formula(own.get("pressure", 0)),
            contact,
            spring,
        )


def number(datum):
    """A number, or a formula of numbers."""
    return float(formula(datum)(np.zeros((1, 3)))[0])


def substituted(value, parameters):
    """The numbers of parameters in place of their names, in every formula."""
    if isinstance(value, dict):
        return {key: substituted(entry, parameters) for key, entry in value.items()}
    if isinstance(value, list):
        return [substituted(entry, parameters) for entry in value]
    if isinstance(value, str):
        for name, own in parameters.items():
            plain = own["value"] if isinstance(own, dict) else own
            value = re.sub(rf"\b{name}\b", f"({plain!r})", value)
    return value


def read_case(file):
    file = Path(file)
    table = tomllib.loads(file.read_text())
    table = substituted(table, table.get("parameters", {}))
    mesh = table["mesh"]
    if "box" in mesh:
        return Case(file, table, len(mesh["box"]["lower"]), *box(mesh["box"]))
    path = file.parent / mesh["file"]
    sides, areas = (geo if path.suffix == ".geo" else msh)(path.read_text())
    return Case(file, table, next(iter(sides.values())).shape[2], sides, areas)


def box(table):
    lower, upper = np.array(table["lower"], float), np.array(table["upper"], float)
    names = ["left", "right", "bottom", "top", "back", "front"]
    sides = {}
    for axis in range(len(lower)):
        for end, at in enumerate((lower, upper)):
            others = [a for a in range(len(lower)) if a != axis]
            corners = np.tile(at, (2 ** len(others), 1))
            for k, corner in enumerate(corners):
                for bit, a in enumerate(others):
                    corner[a] = (lower, upper)[k >> bit & 1][a]
            triangles = [[0, 1]] if len(others) == 1 else [[0, 1, 2], [3, 1, 2]]
            sides[names[2 * axis + end]] = corners[np.array(triangles)]
    return sides, {"box": float(np.prod(upper - lower))}


def numbers(text):
    return [abs(int(word)) for word in re.findall(r"-?\d+", text)]


def geo(text):
    """Points, straight lines, loops, plane surfaces and their physical groups, all with literal numbers."""
    points = {
        int(tag): [float(x), float(y)]
        for tag, x, y in re.findall(rf"Point\((\d+)\) = {{({NUMBER}), ({NUMBER}), ", text)
    }
    lines = {int(tag): (int(a), int(b)) for tag, a, b in re.findall(r"\nLine\((\d+)\) = {(\d+), (\d+)}", text)}
    loops = {int(t): [int(w) for w in re.findall(r"-?\d+", b)] for t, b in re.findall(r"Curve Loop\((\d+)\) = {([^}]*)}", text)}
    surfaces = {int(t): numbers(b) for t, b in re.findall(r"Plane Surface\((\d+)\) = {([^}]*)}", text)}
    sides = {
        name: np.array([[points[a], points[b]] for a, b in (lines[tag] for tag in numbers(tags))])
        for name, tags in re.findall(r'Physical Curve\("([^"]*)"\) = {([^}]*)}', text)
    }

    def area(loop):
        corners = np.array([points[lines[abs(tag)][0 if tag > 0 else 1]] for tag in loops[loop]])
        x, y = corners.T
        return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))

    areas = {
        name: float(sum(area(loop) for tag in numbers(tags) for loop in surfaces[tag]))
        for name, tags in re.findall(r'Physical Surface\("([^"]*)"\) = {([^}]*)}', text)
    }
    return sides, areas


def msh(text):
    """Version 2.2, ASCII."""
    lines = iter(text.splitlines())
    names, nodes, elements = {}, {}, []
    for line in lines:
        if line == "$PhysicalNames":
            for _ in range(int(next(lines))):
                dimension, tag, name = next(lines).split(maxsplit=2)
                names[int(dimension), int(tag)] = name.strip('"')
        elif line == "$Nodes":
            for _ in range(int(next(lines))):
                tag, *x = next(lines).split()
                nodes[int(tag)] = [float(value) for value in x]
        elif line == "$Elements":
            elements = [[int(word) for word in next(lines).split()] for _ in range(int(next(lines)))]
    dimension = max(d for d, _ in names)
    kind = {1: 1, 2: 2, 3: 4}  # dimension -> line, triangle, tetrahedron

    def simplices(wanted, tag):
        rows = [e[3 + e[2] :] for e in elements if e[1] == kind[wanted] and e[3] == tag]
        return np.array([[nodes[v][:dimension] for v in row] for row in rows])

    sides = {name: simplices(d, tag) for (d, tag), name in names.items() if d == dimension - 1}
    areas = {}
    for (d, tag), name in names.items():
        if d == dimension:
            corners = simplices(d, tag)
            edges = corners[:, 1:] - corners[:, :1]
            areas[name] = float(np.abs(np.linalg.det(edges)).sum() / (2 if d == 2 else 6))
    return sides, areas
