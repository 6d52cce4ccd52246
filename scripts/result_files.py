"""Reads what the program writes; used by the scripts beside this file. Formats: docs/output.md."""

import csv
from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

OPEN, STICK, SLIP, TIED = 0, 1, 2, 3  # contact status

DIMENSION_OF_CELL_TYPE = {68: 1, 69: 2, 71: 3}  # VTK Lagrange curve, triangle, tetrahedron


@dataclass
class Grid:
    """A VTU file: cells of one type, each with its own points, the corners first, then the nodes of edges."""

    dimension: int  # of the cells
    points: np.ndarray  # points x 3
    nodes: np.ndarray  # cells x nodes of a cell
    point_data: dict
    cell_data: dict

    def corners(self):
        """Cells x (dimension + 1) numbers of points."""
        return self.nodes[:, : self.dimension + 1]

    def part(self, cells):
        """The same with some of the cells."""
        data = {name: values[cells] for name, values in self.cell_data.items()}
        return Grid(self.dimension, self.points, self.nodes[cells], self.point_data, data)


def read_grid(file):
    """None for a file without cells, as that of a contact boundary where there is none."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    n_cells = grid.GetNumberOfCells()
    if n_cells == 0:
        return None

    def arrays(data):
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}

    return Grid(
        DIMENSION_OF_CELL_TYPE[grid.GetCellType(0)],
        vtk_to_numpy(grid.GetPoints().GetData()),
        vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(n_cells, -1),
        arrays(grid.GetPointData()),
        arrays(grid.GetCellData()),
    )


def read_table(file):
    """A CSV file, column by column: numbers, NaN where nothing is known; columns with words as lists."""
    with file.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    table = {}
    for name in rows[0] if rows else []:
        words = [row[name] for row in rows]
        try:
            table[name] = np.array([float(word) if word else np.nan for word in words])
        except ValueError:
            table[name] = words
    return table


def friction(contact):
    """T^t = T + pressure n of contact.csv, points x d."""
    axes = [a for a in "xyz" if a in contact]
    return np.stack([contact[f"traction_{a}"] + contact["pressure"] * contact[f"n{a}"] for a in axes], axis=1)


def displacement_scale(points, displacement):
    """A round factor (1, 2, 5, 10, ...) by which the largest displacement is about a tenth of the body; 1 where nothing moves."""
    largest = np.linalg.norm(displacement, axis=1).max()
    if largest == 0:
        return 1
    factor = 0.1 * np.ptp(points, axis=0).max() / largest
    power = 10.0 ** np.floor(np.log10(factor))
    return power * max(digit for digit in (1, 2, 5) if digit * power <= factor)


def weighted_quantile(values, weights, share):
    """The value below which `share` of the weight lies."""
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return values[order][np.searchsorted(sums, share * sums[-1])]
