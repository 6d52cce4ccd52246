#!/usr/bin/python3
"""The block of examples/01_tresca_block in GetFEM: Nitsche's method as in docs/method.md, section 2, degree 2.

    bench/peers/block.py N [COEFFICIENT]

N squares along the height; Coulomb friction with a coefficient, Tresca friction without. Debian has the module
for its own Python only.
"""

import sys

import getfem as gf
import numpy as np

LEFT, RIGHT, TOP, BOTTOM = 1, 2, 3, 4
DIRECTIONS = {LEFT: (-1, 0), RIGHT: (1, 0), TOP: (0, 1), BOTTOM: (0, -1)}
TRACTIONS = {TOP: (0, -0.1), RIGHT: (0.04, 0.06)}


def block(n):
    """The mesh of the block, its sides as regions."""
    mesh = gf.Mesh("triangles grid", np.linspace(0, 2, 2 * n + 1), np.linspace(0, 1, n + 1))
    outer = mesh.outer_faces()
    normals = mesh.normal_of_faces(outer)
    for region, direction in DIRECTIONS.items():
        mesh.set_region(region, outer[:, direction @ normals > 0.5])
    return mesh


def elasticity(mf, mim, gamma, friction):
    """The model without contact: stiffness and loads; data and terms of the contact conditions.

    gamma: over lambda + 2 mu.
    """
    E, nu = 1, 0.3
    lam, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    threshold = 0.0 if friction else 0.03
    model = gf.Model("real")
    model.add_fem_variable("u", mf)
    data = {"lam": lam, "mu": mu, "gamma": gamma * (lam + 2 * mu), "friction": friction, "threshold": threshold}
    for name, value in data.items():
        model.add_initialized_data(name, value)
    model.add_isotropic_linearized_elasticity_brick(mim, "u", "lam", "mu")
    for region, traction in TRACTIONS.items():
        model.add_initialized_data(f"traction{region}", traction)
        model.add_source_term_brick(mim, "u", f"traction{region}", region)
    model.add_macro("P", "((lam*Trace(Grad_u)*Id(2) + mu*(Grad_u + Grad_u'))*Normal - gamma*u)")
    model.add_macro("pressure", "neg_part(P.Normal)")
    model.add_macro("tangential", "Ball_projection(P - (P.Normal)*Normal, threshold + friction*pressure)")
    return model


def solve(model, mim):
    """Newton steps of the contact problem; mim: rule of the contact integrals."""
    # The first step: closed and sticking. Newton's method from u = 0 would need twice as many steps.
    glued = model.add_linear_term(mim, "-P.Test_u", BOTTOM)
    model.solve("lsolver", "mumps")
    model.disable_bricks(glued)
    model.add_nonlinear_term(mim, "pressure*(Test_u.Normal) - tangential.Test_u", BOTTOM)
    steps, converged = model.solve("max_res", 1e-10, "max_iter", 50, "lsolver", "mumps")
    if not converged:
        sys.exit("Newton's method does not converge")
    return 1 + steps


def main(n, friction):
    gf.util_trace_level(0)
    mesh = block(n)
    full = gf.MeshFem(mesh, 2)
    full.set_classical_fem(2)
    # Without the nodes on the left, where u = 0: if the model eliminated them, each would clear a vector of all unknowns in
    # every assembly.
    mf = gf.MeshFem("partial", full, np.setdiff1d(np.arange(full.nbdof()), full.basic_dof_on_region(LEFT)))
    mim, mim_contact = gf.MeshIm(mesh, 2), gf.MeshIm(mesh, 9)
    model = elasticity(mf, mim, 10 * n, friction)
    steps = solve(model, mim_contact)

    def integral(rule, expression, region=-1):
        return float(gf.asm_generic(rule, 0, expression, region, model))

    print("dofs", full.nbdof())
    print("steps", steps)
    print("energy", integral(mim, "lam*sqr(Trace(Grad_u)) + mu*(Grad_u + Grad_u'):Grad_u"))
    print("normal", integral(mim_contact, "-pressure", BOTTOM))
    print("tangential", integral(mim_contact, "tangential(1)", BOTTOM))


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 0.0)
