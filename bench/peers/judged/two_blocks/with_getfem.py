#!/usr/bin/python3
"""The blocks in GetFEM, where mesh.msh is; writes getfem.vtu."""

import getfem as gf
from getfem_model import Body, solve, write

E = 1.0
UNSYMMETRIC_ALART_CURNIER = 1

model = gf.Model("real")
upper, lower = Body(model, "upper", E, 0.3), Body(model, "lower", E, 0.3)
upper.hold("upper.left", [0, 1])
upper.load("upper.top", (0, -0.1))
upper.load("upper.right", (0.04, 0.06))
lower.hold("lower.bottom", [0, 1])
model.add_initialized_data("r", [E])
model.add_initialized_data("friction", [0.5])
model.add_integral_contact_between_nonmatching_meshes_brick(
    upper.contact_rule, upper.variable, lower.variable, upper.multiplier("upper.bottom", 2), "r", "friction",
    upper.boundaries["upper.bottom"], lower.boundaries["lower.top"], UNSYMMETRIC_ALART_CURNIER)
solve(model)
write(upper, lower)
print("RESULT lift", upper.mean_displacement("upper.right", "[0; 1]"))
