#!/usr/bin/python3
"""Stacks of elastic blocks on meshes that do not match, in GetFEM: Nitsche's method as in docs/method.md, section 2.

    bench/peers/stacks.py > tests/verification/data/two_bodies_getfem.json

The cases of tests/verification/data/two_bodies.json: examples 06 and 07 on fixed meshes. Contact integrals run over meshes of
intervals, which GetFEM's own interpolation connects with those of the bodies. Debian has the module for its own Python only.
"""

import json
import sys

import getfem as gf
import numpy as np

NU = 0.3
SIDES = {"left": (-1, 0), "right": (1, 0), "bottom": (0, -1), "top": (0, 1)}
TRESCA, COULOMB = 0.03, 0.5
UPPER = {"x": (0, 2), "y": (0, 1), "fixed": "left", "loads": {"top": (0, -0.1), "right": (0.04, 0.06)}}
LOWER = {"x": (0, 2), "y": (-1, 0), "fixed": "bottom"}
THREE = [{"x": (0, 2), "y": (0, 1), "cells": (8, 4), "roller": "left", "loads": {"top": (0.06, -0.1)}},
         {"x": (0.2, 2.2), "y": (-0.5, 0), "cells": (5, 3), "E": 3, "loads": {"right": (-0.11, 0)}},
         {"x": (-0.2, 2.4), "y": (-1.5, -0.5), "cells": (6, 3), "E": 0.5, "fixed": "bottom"}]


def two(law, upper, lower, gap="0"):
    """A block on another one."""
    pair = {"none": {}, "tresca": {"threshold": TRESCA}, "coulomb": {"coefficient": COULOMB}, "tied": {"tied": True}}[law]
    return [{**UPPER, "cells": upper}, {**LOWER, "cells": lower}], [{**pair, "gap": gap}]


CASES = {
    **{f"B2_{law}_8x4_6x3": (two(law, (8, 4), (6, 3)), (1, 2)) for law in ("none", "tresca", "coulomb", "tied")},
    "B2_coulomb_4x2_3x2": (two("coulomb", (4, 2), (3, 2)), (1, 2, 3)),
    "B2_coulomb_gap": (two("coulomb", (6, 3), (5, 2), "0.06*sqr(X(1) - 1)"), (1, 2)),
    "B3_coulomb": ((THREE, [{"coefficient": 0.3}, {"coefficient": 0.2}]), (1, 2)),
}


def lame(body):
    """lambda and mu, plane strain."""
    E = body.get("E", 1)
    return E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))


def add_body(model, k, body, degree):
    """The stiffness, loads and fixed sides of a body, whose displacement is u<k>; its mesh and rule."""
    mesh = gf.Mesh("triangles grid", *(np.linspace(*body[axis], n + 1) for axis, n in zip("xy", body["cells"])))
    outer = mesh.outer_faces()
    normals = mesh.normal_of_faces(outer)
    for region, direction in enumerate(SIDES.values(), 1):
        mesh.set_region(region, outer[:, direction @ normals > 0.5])
    mf, mim = gf.MeshFem(mesh, 2), gf.MeshIm(mesh, 2 * degree)
    mf.set_classical_fem(degree)
    regions = {side: region for region, side in enumerate(SIDES, 1)}
    if "fixed" in body:  # as in block.py
        held = mf.basic_dof_on_region(regions[body["fixed"]])
        mf = gf.MeshFem("partial", mf, np.setdiff1d(np.arange(mf.nbdof()), held))
    model.add_fem_variable(f"u{k}", mf)
    for name, value in zip(("lam", "mu"), lame(body)):
        model.add_initialized_data(f"{name}{k}", value)
    model.add_isotropic_linearized_elasticity_brick(mim, f"u{k}", f"lam{k}", f"mu{k}")
    for side, load in body.get("loads", {}).items():
        model.add_initialized_data(f"load{k}{side}", load)
        model.add_source_term_brick(mim, f"u{k}", f"load{k}{side}", regions[side])
    if "roller" in body:
        model.add_normal_Dirichlet_condition_with_multipliers(mim, f"u{k}", degree, regions[body["roller"]])
    return mesh, mim


def add_interface(model, k, bodies, meshes, degree, pair):
    """The intervals between body k and the one below, their rule, and the contact traction as an expression."""
    upper, lower = bodies[k], bodies[k + 1]
    ends = np.concatenate([np.linspace(*body["x"], body["cells"][0] + 1) for body in (upper, lower)])
    left, right = max(upper["x"][0], lower["x"][0]), min(upper["x"][1], lower["x"][1])
    ends = np.unique(ends[(ends >= left) & (ends <= right)].round(12))
    mesh, y = gf.Mesh("empty", 2), upper["y"][0]
    for a, b in zip(ends, ends[1:]):
        mesh.add_convex(gf.GeoTrans("GT_PK(1,1)"), np.array([[a, b], [y, y]]))
    mim = gf.MeshIm(mesh, gf.Integ(f"IM_GAUSS1D({2 * degree + 5})"))
    for side, body in (("s", k), ("m", k + 1)):
        model.add_interpolate_transformation_from_expression(f"{side}{k}", mesh, meshes[body], "X")
    # Weights by the stiffness of the sides, and n = (0, -1).
    stiff = [(lam + 2 * mu) * body["cells"][0] / (body["x"][1] - body["x"][0])
             for body, (lam, mu) in ((body, lame(body)) for body in (upper, lower))]
    gamma = 10 * stiff[0] * stiff[1] / sum(stiff)
    stress, jump = [], []
    for side, body, weight in (("s", k, stiff[1] / sum(stiff)), ("m", k + 1, stiff[0] / sum(stiff))):
        gradient = f"Interpolate(Grad_u{body},{side}{k})"
        stress.append(f"{weight!r}*(lam{body}*Trace({gradient})*Id(2) + mu{body}*({gradient} + ({gradient})'))")
        jump.append(f"Interpolate(u{body},{side}{k})")
    P = f"(({' + '.join(stress)})*[0;-1] - {gamma!r}*({jump[0]} - {jump[1]} - ({pair.get('gap', '0')})*[0;-1]))"
    if pair.get("tied"):
        return mim, P, P
    normal = f"(-({P})(2))"
    limit = f"({pair.get('threshold', 0)!r} + {pair.get('coefficient', 0)!r}*neg_part({normal}))"
    tangential = f"(max(-{limit}, min({limit}, ({P})(1))))"
    return mim, P, f"[{tangential}; neg_part({normal})]"


def tested(k, traction):
    """-(T, [v])."""
    return f"-({traction}).(Interpolate(Test_u{k},s{k}) - Interpolate(Test_u{k + 1},m{k}))"


def solve(bodies, pairs, degree):
    model = gf.Model("real")
    meshes, rules = zip(*(add_body(model, k, body, degree) for k, body in enumerate(bodies)))
    interfaces = [add_interface(model, k, bodies, meshes, degree, pair) for k, pair in enumerate(pairs)]
    # The first step: closed and sticking. (The constant part of a linear term would remain.)
    glued = [model.add_nonlinear_term(mim, tested(k, P)) for k, (mim, P, _) in enumerate(interfaces)]
    model.solve("lsolver", "mumps")
    for brick in glued:
        model.disable_bricks(brick)
    for k, (mim, _, T) in enumerate(interfaces):
        model.add_nonlinear_term(mim, tested(k, T))
    steps, converged = model.solve("max_res", 1e-12, "max_iter", 60, "lsolver", "mumps")
    if not converged:
        sys.exit("Newton's method does not converge")
    energy = sum(float(gf.asm_generic(rule, 0, f"lam{k}*sqr(Trace(Grad_u{k})) + mu{k}*(Grad_u{k} + Grad_u{k}'):Grad_u{k}", -1, model))
                 for k, rule in enumerate(rules))
    forces = [[float(gf.asm_generic(mim, 0, f"({T})({c})", -1, model)) for c in (1, 2)] for mim, _, T in interfaces]
    return {"energy": energy, "normal": sum(-f[1] for f in forces), "tangential": sum(f[0] for f in forces)}


def main():
    gf.util_trace_level(0)
    results = [{"name": name, "p": degree, **solve(*case, degree)} for name, (case, degrees) in CASES.items() for degree in degrees]
    json.dump({"about": "Made by bench/peers/stacks.py with GetFEM 5.4.2", "cases": results}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
