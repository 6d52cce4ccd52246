"""Reads the files of io_write_vtu with VTK's own reader and compares them with the polynomials."""

import json
import math
import random
import sys
import xml.etree.ElementTree
from pathlib import Path

from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

CELL_TYPES = {1: 68, 2: 69, 3: 71}
E, NU = 1.0, 0.3
LAMBDA = E * NU / ((1 + NU) * (1 - 2 * NU))
MU = E / (2 * (1 + NU))
GAP, THRESHOLD = 0.25, 0.03


def displacement(dimension, degree, x):
    """Value and gradient of the displacement in write_vtu.cpp, always with 3 components."""
    u, gradient = [0.0] * 3, [[0.0] * 3 for _ in range(3)]
    for a in range(dimension):
        c = [1.0 + a, 0.5 * a - 2.0, 0.5 + a if dimension == 3 else 0.0]
        s = sum(ci * xi for ci, xi in zip(c, x)) - 0.1 * a
        u[a] = sum(0.1 * s**j for j in range(degree + 1))
        slope = sum(0.1 * j * s ** (j - 1) for j in range(1, degree + 1))
        gradient[a] = [slope * ci for ci in c]
    return u, gradient


def stress(gradient):
    """(xx, yy, zz, xy, yz, xz) in three dimensions and in plane strain."""
    trace = sum(gradient[i][i] for i in range(3))
    entry = lambda i, j: MU * (gradient[i][j] + gradient[j][i]) + (LAMBDA * trace if i == j else 0.0)
    return [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)]


def von_mises(s):
    xx, yy, zz, xy, yz, xz = s
    return math.sqrt(
        0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + xz**2)
    )


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def check_close(actual, expected, tolerance, message):
    scale = max(1.0, max(abs(e) for e in expected))
    error = max(abs(a - e) for a, e in zip(actual, expected))
    check(len(actual) == len(expected), f"{message}: {len(actual)} components, not {len(expected)}")
    check(error <= tolerance * scale, f"{message}: {actual} instead of {expected}")


def read(path):
    head = path.read_bytes()[:400].decode("latin-1")
    check('compressor="vtkZLibDataCompressor"' in head, f"{path.name} is not compressed")
    check('header_type="UInt64"' in head, f"{path.name} has no 64-bit headers")
    reader = vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("error"))
    reader.SetFileName(str(path))
    reader.Update()
    check(not errors and reader.GetErrorCode() == 0, f"VTK cannot read {path.name}")
    return reader.GetOutput()


def check_cells(grid, k, degree, n_cells, name):
    """Cell types; every cell has its own points, at VTK's parametric coordinates."""
    n_nodes = math.comb(degree + k, k)
    check(grid.GetNumberOfCells() == n_cells, f"{name}: {grid.GetNumberOfCells()} cells, not {n_cells}")
    check(grid.GetNumberOfPoints() == n_cells * n_nodes, f"{name}: {grid.GetNumberOfPoints()} points")
    for c in range(n_cells):
        cell = grid.GetCell(c)
        check(cell.GetCellType() == CELL_TYPES[k], f"{name}: cell type {cell.GetCellType()}")
        check(cell.GetNumberOfPoints() == n_nodes, f"{name}: {cell.GetNumberOfPoints()} nodes in a cell")
        parametric = cell.GetParametricCoords()
        corners = [cell.GetPoints().GetPoint(i) for i in range(k + 1)]
        for i in range(n_nodes):
            r = parametric[3 * i : 3 * i + k]
            b = [1.0 - sum(r), *r]
            x = [sum(bj * corner[a] for bj, corner in zip(b, corners)) for a in range(3)]
            check_close(cell.GetPoints().GetPoint(i), x, 1e-13, f"{name}: node {i} of cell {c}")


def random_points(grid, k, rng):
    """A few points per cell: x and VTK's interpolation weights of the nodes there."""
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        nodes = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        for _ in range(4):
            cuts = sorted(rng.random() for _ in range(k))
            r = [b - a for a, b in zip([0.0, *cuts], cuts)] + [0.0] * (3 - k)
            x, weights = [0.0] * 3, [0.0] * len(nodes)
            cell.EvaluateLocation(mutable(0), r, x, weights)
            yield c, x, nodes, weights


def interpolate(array, nodes, weights):
    n = array.GetNumberOfComponents()
    return [sum(w * array.GetComponent(i, a) for i, w in zip(nodes, weights)) for a in range(n)]


def check_principal(values, s, name):
    """They are in descending order and have the invariants of the stress."""
    xx, yy, zz, xy, yz, xz = s
    a, b, c = values
    size = max(abs(x) for x in s)
    check(a >= b >= c, f"{name}: principal stresses {values} do not fall")
    check_close([a + b + c], [xx + yy + zz], 2e-6, f"{name}: trace")
    second = xx * yy + yy * zz + zz * xx - xy**2 - yz**2 - xz**2
    check(abs(a * b + b * c + c * a - second) <= 2e-6 * max(1.0, size) ** 2, f"{name}: second invariant of {s}")
    third = xx * (yy * zz - yz**2) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    check(abs(a * b * c - third) <= 4e-6 * max(1.0, size) ** 3, f"{name}: determinant of {s}")


def check_level(path, dimension, degree, n_cells, rng):
    grid = read(path)
    name = path.name
    check_cells(grid, dimension, degree, n_cells, name)
    check(grid.GetFieldData().GetArray("TimeValue").GetValue(0) == degree, f"{name}: TimeValue")
    point, cell = grid.GetPointData(), grid.GetCellData()
    check(point.GetArray("displacement").GetDataTypeAsString() == "double", f"{name}: displacement type")
    for c in range(n_cells):
        check(cell.GetArray("region").GetValue(c) == 0, f"{name}: region")
        check(cell.GetArray("eta_tot").GetValue(c) == 0.5 * c, f"{name}: eta_tot")
    for i in range(grid.GetNumberOfPoints()):
        _, gradient = displacement(dimension, degree, grid.GetPoint(i))
        check_close(
            [point.GetArray("von_mises").GetValue(i)], [von_mises(stress(gradient))], 2e-6, f"{name}: von_mises"
        )
        check_principal(point.GetArray("principal_stresses").GetTuple(i), stress(gradient), name)
    for c, x, nodes, weights in random_points(grid, dimension, rng):
        u, gradient = displacement(dimension, degree, x)
        where = f"{name}, cell {c} at {x}"
        check_close(interpolate(point.GetArray("displacement"), nodes, weights), u, 1e-11, f"{where}: displacement")
        check_close(interpolate(point.GetArray("stress"), nodes, weights), stress(gradient), 1e-5, f"{where}: stress")
        check_close(
            interpolate(point.GetArray("twice_stress"), nodes, weights),
            [2 * s for s in stress(gradient)],
            1e-5,
            f"{where}: twice_stress",
        )


def check_contact(path, dimension, degree, n_facets, rng):
    """The obstacle is at x_last = 0, so n = -e_last and the plane of the facets is known."""
    grid = read(path)
    name = path.name
    last = dimension - 1
    check_cells(grid, last, degree, n_facets, name)
    data = grid.GetPointData()
    for i in range(grid.GetNumberOfPoints()):
        x = grid.GetPoint(i)
        u, gradient = displacement(dimension, degree, x)
        check(abs(x[last]) <= 1e-15, f"{name}: point {i} is not on the obstacle")
        slip = [0.0 if a == last else u[a] for a in range(3)]
        check_close(data.GetArray("displacement").GetTuple(i), u, 1e-12, f"{name}: displacement")
        check_close(data.GetArray("slip").GetTuple(i), slip, 1e-12, f"{name}: slip")
        check_close([data.GetArray("gap").GetValue(i)], [GAP + u[last]], 1e-12, f"{name}: gap")
        pressure = data.GetArray("contact_pressure").GetValue(i)
        traction = data.GetArray("contact_traction").GetTuple(i)
        status = data.GetArray("contact_status").GetValue(i)
        check(pressure >= 0, f"{name}: negative contact pressure")
        check_close([traction[last]], [pressure], 1e-12, f"{name}: traction and pressure")
        tangential = math.sqrt(sum(traction[a] ** 2 for a in range(3) if a != last))
        check(tangential <= THRESHOLD * (1 + 1e-12), f"{name}: friction above the threshold")
        check(status in (0, 1, 2), f"{name}: contact_status {status}")
        check((status == 0) == (pressure == 0), f"{name}: status {status} at pressure {pressure}")
    for c, x, nodes, weights in random_points(grid, last, rng):
        u, _ = displacement(dimension, degree, x)
        check_close(interpolate(data.GetArray("displacement"), nodes, weights), u, 1e-11, f"{name}, cell {c}")


def check_series(path):
    sets = xml.etree.ElementTree.parse(path).getroot().findall("./Collection/DataSet")
    entries = [(float(s.get("timestep")), s.get("file")) for s in sets]
    check(entries == [(0, "level_000.vtu"), (1, "level_001.vtu")], f"series.pvd: {entries}")


def main():
    directory = Path(sys.argv[1])
    rng = random.Random(1)
    files = json.loads((directory / "manifest.json").read_text())["files"]
    for entry in files:
        dimension, degree = entry["dimension"], entry["degree"]
        check_level(directory / entry["level"], dimension, degree, entry["cells"], rng)
        check_contact(directory / entry["contact"], dimension, degree, entry["contact_facets"], rng)
    check(read(directory / "no_contact.vtu").GetNumberOfCells() == 0, "no_contact.vtu is not empty")
    check_series(directory / "series.pvd")
    print(f"read {2 * len(files)} files with VTK")


if __name__ == "__main__":
    main()
