#!/usr/bin/python3
"""The block in GetFEM, where mesh.msh is; writes getfem.vtu.

The friction of GetFEM's contact bricks ends where contact is open; that of Tresca's law does not. So the
conditions are written as in GetFEM's tutorial "wheel in contact", an augmented Lagrangian, with the projections
of Tresca's law.
"""

import getfem as gf
from getfem_model import Body, solve, write

E = 1.0

model = gf.Model("real")
block = Body(model, "block", E, 0.3)
block.hold("left", [0, 1])
block.load("top", (0, -0.1))
block.load("right", (0.04, 0.06))
block.multiplier("contact", 2)
model.add_initialized_data("gamma0", [1 / E])
model.add_initialized_data("threshold", [0.03])
model.add_macro("P", "(contact - u_block/(gamma0*element_size))")
model.add_macro("T", "(Ball_projection(P - (P.Normal)*Normal, threshold) - neg_part(P.Normal)*Normal)")
terms = "-contact.Test_u_block - (gamma0*element_size)*(contact - T).Test_contact"
model.add_nonlinear_term(block.contact_rule, terms, block.boundaries["contact"])
solve(model)
write(block)
print("RESULT lift", block.mean_displacement("right", "[0; 1]"))
