#!/usr/bin/env python3
"""Boxes of all types of cells, as VTK itself writes them in all its formats, and meshio and libmed where they are installed.

Usage: foreign_meshes.py DIRECTORY

The box is 3 * 2 * 2 (2D: 3 * 2). Cells with x < 1 are region 1, others 2; the faces at the bottom are cells of their own, 5. The
places of nodes are those that VTK's cells report.
"""

import itertools
import random
import sys
from pathlib import Path

import numpy as np
from vtkmodules import vtkCommonCore as core
from vtkmodules import vtkCommonDataModel as model
from vtkmodules import vtkIOLegacy, vtkIOXML

try:
    import meshio
except ImportError:
    meshio = None
try:
    from med import medenum, medfamily, medfile, medmesh
except ImportError:
    medfile = None

CUBE = [[0, 1, 2, 3, 4, 5, 6, 7]]
PRISMS = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]
TETRAHEDRA = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
PYRAMIDS = [[0, 1, 2, 3, 8], [4, 7, 6, 5, 8], [0, 4, 5, 1, 8], [1, 5, 6, 2, 8], [2, 6, 7, 3, 8], [3, 7, 4, 0, 8]]
TRIANGLES = [[0, 1, 2], [0, 2, 3]]
SQUARE = [[0, 1, 2, 3]]
VOXEL = [[0, 1, 3, 2, 4, 5, 7, 6]]
PIXEL = [[0, 1, 3, 2]]
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0.5, 0.5, 0.5]])

# Class, the linear cell of the same shape, number of nodes, cells of a cube or a square.
TYPES = [
    ("vtkTriangle", "vtkTriangle", 3, TRIANGLES),
    ("vtkQuadraticTriangle", "vtkTriangle", 6, TRIANGLES),
    ("vtkLagrangeTriangle", "vtkTriangle", 6, TRIANGLES),
    ("vtkLagrangeTriangle", "vtkTriangle", 10, TRIANGLES),
    ("vtkLagrangeTriangle", "vtkTriangle", 15, TRIANGLES),
    ("vtkQuad", "vtkQuad", 4, SQUARE),
    ("vtkPixel", "vtkPixel", 4, PIXEL),
    ("vtkQuadraticQuad", "vtkQuad", 8, SQUARE),
    ("vtkBiQuadraticQuad", "vtkQuad", 9, SQUARE),
    ("vtkLagrangeQuadrilateral", "vtkQuad", 9, SQUARE),
    ("vtkTetra", "vtkTetra", 4, TETRAHEDRA),
    ("vtkQuadraticTetra", "vtkTetra", 10, TETRAHEDRA),
    ("vtkLagrangeTetra", "vtkTetra", 10, TETRAHEDRA),
    ("vtkLagrangeTetra", "vtkTetra", 20, TETRAHEDRA),
    ("vtkLagrangeTetra", "vtkTetra", 35, TETRAHEDRA),
    ("vtkHexahedron", "vtkHexahedron", 8, CUBE),
    ("vtkVoxel", "vtkVoxel", 8, VOXEL),
    ("vtkQuadraticHexahedron", "vtkHexahedron", 20, CUBE),
    ("vtkTriQuadraticHexahedron", "vtkHexahedron", 27, CUBE),
    ("vtkLagrangeHexahedron", "vtkHexahedron", 27, CUBE),
    ("vtkWedge", "vtkWedge", 6, PRISMS),
    ("vtkQuadraticWedge", "vtkWedge", 15, PRISMS),
    ("vtkBiQuadraticQuadraticWedge", "vtkWedge", 18, PRISMS),
    ("vtkLagrangeWedge", "vtkWedge", 18, PRISMS),
    ("vtkPyramid", "vtkPyramid", 5, PYRAMIDS),
    ("vtkQuadraticPyramid", "vtkPyramid", 13, PYRAMIDS),
]


def parametric(name, n_nodes):
    """The reference coordinates of the nodes, from VTK."""
    cell = getattr(model, name)()
    if "Lagrange" in name:
        cell.GetPointIds().SetNumberOfIds(n_nodes)
        cell.GetPoints().SetNumberOfPoints(n_nodes)
        if hasattr(cell, "SetUniformOrderFromNumPoints"):
            cell.SetUniformOrderFromNumPoints(n_nodes)
        else:
            cell.Initialize()
    coordinates = cell.GetParametricCoords()
    return cell.GetCellType(), [tuple(coordinates[3 * i + k] for k in range(3)) for i in range(n_nodes)]


class Box:
    def __init__(self, name, linear, n_nodes, cells):
        self.dim = 3 if max(max(c) for c in cells) > 3 else 2
        self.type, nodes = parametric(name, n_nodes)
        base = getattr(model, linear)()
        weights = []
        for node in nodes:
            w = [0.0] * base.GetNumberOfPoints()
            base.InterpolateFunctions(node, w)
            weights.append(w)
        self.weights = np.array(weights)
        self.places, self.points, self.cells, self.values = {}, [], [], []
        for k, j, i in itertools.product(range(2 if self.dim == 3 else 1), range(2), range(3)):
            for corners in cells:
                x = CORNERS[corners] * ([1, 1, 1] if self.dim == 3 else [1, 1, 0]) + [i, j, k]
                self.cells.append((self.type, [self.node(p) for p in self.weights @ x]))
                self.values.append(1 if i < 1 else 2)
        self.renumber(name)
        self.add_faces()

    def node(self, x):
        key = tuple(np.round(x * 24).astype(int))
        if key not in self.places:
            self.places[key] = len(self.points)
            self.points.append(x)
        return self.places[key]

    def renumber(self, seed):
        order = list(range(len(self.points)))
        random.Random(seed).shuffle(order)
        points = [None] * len(order)
        for old, new in enumerate(order):
            points[new] = self.points[old]
        self.points = points
        self.cells = [(kind, [order[v] for v in nodes]) for kind, nodes in self.cells]

    def add_faces(self):
        grid = self.grid(core.vtkDoubleArray, core.vtkIntArray)
        axis = self.dim - 1
        for c in range(grid.GetNumberOfCells()):
            cell = grid.GetCell(c)
            for f in range(cell.GetNumberOfFaces() if self.dim == 3 else cell.GetNumberOfEdges()):
                face = cell.GetFace(f) if self.dim == 3 else cell.GetEdge(f)
                ids = [face.GetPointId(i) for i in range(face.GetNumberOfPoints())]
                if all(abs(self.points[v][axis]) < 1e-12 for v in ids):
                    self.cells.append((face.GetCellType(), ids))
                    self.values.append(5)

    def grid(self, points_type, values_type):
        coordinates = points_type()
        coordinates.SetNumberOfComponents(3)
        for x in self.points:
            coordinates.InsertNextTuple3(*x)
        points = core.vtkPoints()
        points.SetData(coordinates)
        grid = model.vtkUnstructuredGrid()
        grid.SetPoints(points)
        values = values_type()
        values.SetName("material")
        for (kind, nodes), value in zip(self.cells, self.values):
            grid.InsertNextCell(kind, len(nodes), nodes)
            values.InsertNextValue(value)
        other = core.vtkDoubleArray()
        other.SetName("a b, of which there are 3")
        other.SetNumberOfComponents(3)
        other.SetNumberOfTuples(grid.GetNumberOfCells())
        other.Fill(0.25)
        field = core.vtkFloatArray()
        field.SetName("u")
        field.SetNumberOfTuples(len(self.points))
        field.Fill(1.5)
        grid.GetPointData().SetScalars(field)
        grid.GetCellData().AddArray(other)
        grid.GetCellData().AddArray(values)
        return grid


POINTS = [core.vtkDoubleArray, core.vtkFloatArray]
VALUES = [core.vtkIntArray, core.vtkUnsignedCharArray, core.vtkShortArray, core.vtkLongLongArray, core.vtkUnsignedIntArray,
          core.vtkIdTypeArray, core.vtkSignedCharArray, core.vtkUnsignedLongArray]  # fmt: skip


def write_vtu(directory, name, grid, mode, order, compressor, header):
    writer = vtkIOXML.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(directory / f"{name}-{mode}-{order}-{compressor}-{header}.vtu"))
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}.get(mode, writer.SetDataModeToAppended)()
    writer.SetEncodeAppendedData(mode == "base64")
    writer.SetByteOrder(order == "little")
    writer.SetHeaderType(header)
    writer.SetBlockSize(256)
    {"none": writer.SetCompressorTypeToNone, "zlib": writer.SetCompressorTypeToZLib, "lz4": writer.SetCompressorTypeToLZ4}[compressor]()
    assert writer.Write() == 1


def write_vtk(directory, name, grid, binary, version):
    writer = vtkIOLegacy.vtkUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileVersion(version)
    writer.SetFileName(str(directory / f"{name}-{'binary' if binary else 'ascii'}-{version}.vtk"))
    writer.SetFileType(2 if binary else 1)
    assert writer.Write() == 1


def write_by_meshio(directory, name, grid_file):
    """Nothing for types that meshio does not know, or does not write as .med."""
    try:
        mesh = meshio.read(grid_file)
    except (KeyError, SystemExit):
        return
    mesh.cell_data = {"material": mesh.cell_data["material"]}
    mesh.point_data = {}
    for suffix, options in [("vtu", {}), ("vtu", {"binary": False}), ("vtk", {}), ("vtk", {"binary": False})]:
        mesh.write(directory / f"{name}-meshio{len(options)}.{suffix}", **options)
    mesh.cell_data = {"cell_tags": [-values.astype(int) for values in mesh.cell_data["material"]]}
    mesh.cell_tags = {-1: ["1"], -2: ["2"], -5: ["5"]}
    path = directory / f"{name}-meshio.med"
    try:
        mesh.write(path)
    except (KeyError, ImportError):  # or h5py is not there, which Debian's meshio does not ask for
        path.unlink(missing_ok=True)


# VTK's cell type: libmed's name, and for each of its nodes that of VTK, which has the opposite orientation.
MED_TYPES = {
    3: ("MED_SEG2", [0, 1]),
    21: ("MED_SEG3", [0, 1, 2]),
    5: ("MED_TRIA3", [0, 2, 1]),
    22: ("MED_TRIA6", [0, 2, 1, 5, 4, 3]),
    9: ("MED_QUAD4", [0, 3, 2, 1]),
    23: ("MED_QUAD8", [0, 3, 2, 1, 7, 6, 5, 4]),
    28: ("MED_QUAD9", [0, 3, 2, 1, 7, 6, 5, 4, 8]),
    10: ("MED_TETRA4", [0, 2, 1, 3]),
    24: ("MED_TETRA10", [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]),
    12: ("MED_HEXA8", [0, 3, 2, 1, 4, 7, 6, 5]),
    25: ("MED_HEXA20", [0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17]),
    29: ("MED_HEXA27", [0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 24, 20, 23, 21, 22, 25, 26]),
    13: ("MED_PENTA6", [0, 2, 1, 3, 5, 4]),
    26: ("MED_PENTA15", [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]),
    32: ("MED_PENTA18", [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13, 17, 16, 15]),
    14: ("MED_PYRA5", [0, 3, 2, 1, 4]),
    27: ("MED_PYRA13", [0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10]),
}


def write_by_libmed(path, box, version):
    """The families have the groups "1" and "all", "2" and "all", "5"; a family of nodes is in no group of a boundary."""
    when = ("box", medenum.MED_NO_DT, medenum.MED_NO_IT)
    file = medfile.MEDfileVersionOpen(str(path), medenum.MED_ACC_CREAT, *version)
    three = [name.ljust(16) for name in "xyz"]
    medmesh.MEDmeshCr(file, "box", box.dim, box.dim, medenum.MED_UNSTRUCTURED_MESH, "", "", medenum.MED_SORT_DTIT,
                      medenum.MED_CARTESIAN, "".join(three[: box.dim]), "m".ljust(16) * box.dim)  # fmt: skip
    coordinates = [float(c) for x in box.points for c in x[: box.dim]]
    medmesh.MEDmeshNodeCoordinateWr(file, *when, 0.0, medenum.MED_FULL_INTERLACE, len(box.points), medmesh.MEDFLOAT(coordinates))
    first = 101
    for kind in sorted({kind for kind, _ in box.cells}):
        name, order = MED_TYPES[kind]
        cells = [(nodes, value) for (k, nodes), value in zip(box.cells, box.values) if k == kind]
        where = (*when, medenum.MED_CELL, getattr(medenum, name))
        nodes = [ids[place] + 1 for ids, _ in cells for place in order]
        medmesh.MEDmeshElementConnectivityWr(file, *when, 0.0, *where[3:], medenum.MED_NODAL, medenum.MED_FULL_INTERLACE,
                                             len(cells), medmesh.MEDINT(nodes))  # fmt: skip
        medmesh.MEDmeshEntityFamilyNumberWr(file, *where, len(cells), medmesh.MEDINT([-value for _, value in cells]))
        medmesh.MEDmeshEntityNumberWr(file, *where, len(cells), medmesh.MEDINT(list(range(first, first + len(cells)))))
        first += len(cells)
    medfamily.MEDfamilyCr(file, "box", "FAMILLE_ZERO", 0, 0, medfamily.MEDCHAR(""))
    for number, groups in [(-1, ["1", "all"]), (-2, ["all", "2"]), (-5, ["5"])]:
        padded = "".join(group.ljust(80, "\0") for group in groups)
        medfamily.MEDfamilyCr(file, "box", f"FAM_{number}", number, len(groups), medfamily.MEDCHAR(padded))
    medfile.MEDfileClose(file)


def main():
    directory = Path(sys.argv[1])
    directory.mkdir(parents=True, exist_ok=True)
    for old in directory.glob("*.*"):
        old.unlink()
    forms = itertools.cycle(itertools.product(VALUES, POINTS))
    for name, linear, n_nodes, cells in TYPES:
        box = Box(name, linear, n_nodes, cells)
        name = f"{name}{n_nodes}"
        every = name.startswith(("vtkQuadraticWedge", "vtkQuadraticTriangle"))
        modes = ["ascii", "binary", "base64", "raw"]
        for mode, order, compressor, header in itertools.product(modes, ["little", "big"], ["none", "zlib"], [32, 64]):
            if every or (mode, order, compressor, header) in [("ascii", "little", "none", 32), ("raw", "big", "zlib", 64)]:
                values, points = next(forms)
                write_vtu(directory, name, box.grid(points, values), mode, order, compressor, header)
        # In version 4.2 VTK's writer keeps the new order of nodes of these hexahedra, and its reader expects the old one.
        versions = [51] if name.startswith("vtkLagrangeHex") else [42, 51]
        for binary, version in itertools.product([False, True], versions):
            values, points = next(forms)
            if not binary and name in ("vtkLagrangeTriangle10", "vtkLagrangeTetra20"):
                points = core.vtkDoubleArray  # of single precision VTK writes six digits here, too few for thirds
            write_vtk(directory, name, box.grid(points, values), binary, version)
        if meshio and not name.startswith(("vtkPixel", "vtkVoxel")):
            write_by_meshio(directory, name, directory / f"{name}-ascii-little-none-32.vtu")
        if medfile and box.type in MED_TYPES:
            # Prisms of 18 nodes came with version 4.
            for version in [(4, 1, 0), (4, 0, 0), (3, 3, 1), (3, 2, 0)][: 2 if box.type == 32 else 4]:
                write_by_libmed(directory / f"{name}-libmed{version[0]}{version[1]}.med", box, version)
    write_vtu(directory, "refused2", Box(*TYPES[0]).grid(*POINTS[:1], VALUES[0]), "raw", "little", "lz4", 32)


main()
