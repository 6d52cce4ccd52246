"""Elasticity in GetFEM on the mesh of a problem, with the settings of its demo_static_contact.py, and its export.

Displacements of degree 2, contact multipliers of degree 1, contact integrals by a composite rule.
Debian has the module for its own Python only.
"""

import sys
from collections.abc import Sequence

import getfem as gf
import meshio
import numpy as np
import numpy.typing as npt

SIMPLEX = {2: "triangle", 3: "tetra"}
FACET = {2: "line", 3: "triangle"}
VOLUME_RULE = {2: "IM_TRIANGLE(4)", 3: "IM_TETRAHEDRON(5)"}

gf.util_trace_level(0)


class Body:
    """A body of mesh.msh: its mesh, the numbers of its boundaries, its displacement u_NAME in a model."""

    def __init__(self, model: gf.Model, body: str, youngs_modulus: float, nu: float) -> None:
        source = meshio.read("mesh.msh")
        self.model, self.variable, self.dim = model, f"u_{body}", 3 if source.points[:, 2].any() else 2
        points = source.points[:, : self.dim]
        cells = source.cells_dict[SIMPLEX[self.dim]]
        own = cells[source.cell_data_dict["gmsh:physical"][SIMPLEX[self.dim]] == source.field_data[body][0]]
        self.mesh = gf.Mesh("empty", self.dim)
        self.mesh.add_convex(gf.GeoTrans(f"GT_PK({self.dim},1)"), points[own].transpose(2, 1, 0))
        self.boundaries: dict[str, int] = {}
        facets = source.cells_dict[FACET[self.dim]]
        groups = source.cell_data_dict["gmsh:physical"][FACET[self.dim]]
        for boundary, (number, dimension) in source.field_data.items():
            vertices = facets[groups == number] if dimension == self.dim - 1 else facets[:0]
            if vertices.size and np.isin(vertices, own).all():
                self._add_boundary(boundary, int(number), points[np.unique(vertices)])
        self.displacements = gf.MeshFem(self.mesh, self.dim)
        self.displacements.set_classical_fem(2)
        self.scalars = gf.MeshFem(self.mesh, 1)
        self.scalars.set_classical_fem(2)
        self.rule = gf.MeshIm(self.mesh, gf.Integ(VOLUME_RULE[self.dim]))
        composite = f"IM_STRUCTURED_COMPOSITE({VOLUME_RULE[self.dim]},4)"
        self.contact_rule = gf.MeshIm(self.mesh, gf.Integ(composite))
        self.lame = (youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu)), youngs_modulus / (2 * (1 + nu)))
        model.add_fem_variable(self.variable, self.displacements)
        for constant, value in zip(("lam", "mu"), self.lame):
            model.add_initialized_data(f"{constant}_{body}", value)
        constants = (f"lam_{body}", f"mu_{body}")
        model.add_isotropic_linearized_elasticity_brick(self.rule, self.variable, *constants)

    def _add_boundary(self, name: str, number: int, corners: npt.NDArray[np.float64]) -> None:
        pids = [int(np.argmin(np.linalg.norm(self.mesh.pts().T - corner, axis=1))) for corner in corners]
        faces = self.mesh.faces_from_pid(pids)
        outer = {tuple(face) for face in self.mesh.outer_faces().T}
        self.mesh.set_region(number, np.array([face for face in faces.T if tuple(face) in outer]).T)
        self.boundaries[name] = number

    def multiplier(self, boundary: str, components: int = 1) -> str:
        """A new unknown of degree 1 on a boundary: the contact stress."""
        space = gf.MeshFem(self.mesh, components)
        space.set_classical_fem(1)
        self.model.add_filtered_fem_variable("contact", space, self.boundaries[boundary])
        return "contact"

    def load(self, boundary: str, traction: Sequence[float]) -> None:
        data = f"traction_{self.variable}_{boundary.replace('.', '_')}"
        self.model.add_initialized_data(data, list(traction))
        self.model.add_source_term_brick(self.rule, self.variable, data, self.boundaries[boundary])

    def hold(self, boundary: str, components: Sequence[int], value: float = 0) -> None:
        """A displacement that is given in some directions."""
        name = f"held_{self.variable}_{self.boundaries[boundary]}"
        selector = np.zeros(self.dim)
        selector[list(components)] = 1
        self.model.add_initialized_data(name, value * selector)
        self.model.add_initialized_data(f"{name}_H", np.diag(selector).ravel())
        self.model.add_generalized_Dirichlet_condition_with_multipliers(
            self.rule, self.variable, self.displacements, self.boundaries[boundary], name, f"{name}_H")

    def mean_displacement(self, boundary: str, direction: str) -> float:
        region = self.boundaries[boundary]
        moved, length = (float(gf.asm_generic(self.rule, 0, term, region, self.model))
                         for term in (f"{self.variable}.{direction}", "1"))
        return moved / length

    def stress(self) -> str:
        lam, mu = (repr(float(value)) for value in self.lame)
        u = self.variable
        return f"({lam}*Trace(Grad_{u})*Id({self.dim})+{mu}*(Grad_{u}+Grad_{u}'))"

    def fields(self) -> tuple[npt.NDArray[np.float64], ...]:
        """Of the nodes: position, displacement, stress xx yy zz xy yz xz, where elements meet the mean."""
        nodes = self.scalars.basic_dof_nodes().T
        displacement = self.model.variable(self.variable).reshape(-1, self.dim)
        tensor = self.stress()
        components = ["1,1", "2,2", "3,3", "1,2", "2,3", "1,3"] if self.dim == 3 else ["1,1", "2,2", "", "1,2"]
        along = f"{float(self.lame[0])!r}*Trace(Grad_{self.variable})"  # szz in plane strain
        stress = [self.model.interpolation(f"{tensor}({k})" if k else along, self.scalars) for k in components]
        columns = ((nodes, 3), (displacement, 3), (np.column_stack(stress), 6))
        return tuple(np.pad(column, ((0, 0), (0, width - column.shape[1]))) for column, width in columns)

    def cells(self) -> npt.NDArray[np.int64]:
        """The nodes of each cell, in the order of VTK; GetFEM counts them along x, then y, then z."""
        order = [0, 2, 5, 1, 4, 3] if self.dim == 2 else [0, 2, 5, 9, 1, 4, 3, 6, 7, 8]
        dofs, starts = self.scalars.basic_dof_from_cvid()
        return np.asarray(dofs).reshape(len(starts) - 1, -1)[:, order]


def solve(model: gf.Model, scale: float = 1) -> None:
    """scale: of the residual; without loads GetFEM does not divide it by them."""
    _, converged = model.solve("max_res", 1e-9 * scale, "max_iter", 50, "lsearch", "default")
    if not converged:
        sys.exit("Newton's method does not converge")


def write(*bodies: Body) -> None:
    """getfem.vtu"""
    counts = np.cumsum([0, *(body.scalars.nbdof() for body in bodies)])
    fields = zip(*(body.fields() for body in bodies))
    points, displacements, stresses = (np.concatenate(parts) for parts in fields)
    cells = np.concatenate([body.cells() + first for body, first in zip(bodies, counts)])
    kind = SIMPLEX[bodies[0].dim] + ("6" if bodies[0].dim == 2 else "10")
    values = {"displacement": displacements, "stress": stresses}
    meshio.Mesh(points, [(kind, cells)], values).write("getfem.vtu")
