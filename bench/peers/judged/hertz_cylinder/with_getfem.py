#!/usr/bin/python3
"""The cylinder in GetFEM, where mesh.msh is; writes getfem.vtu."""

import getfem as gf
from getfem_model import Body, solve, write
from getfem_rigid import add_obstacle, print_force

E = 200000

model = gf.Model("real")
cylinder = Body(model, "cylinder", E, 0.3)
cylinder.hold("symmetry", [0])
cylinder.hold("top", [1], -0.05)
add_obstacle(cylinder, "contact", "y", E)
solve(model, E)
write(cylinder)
print_force(cylinder, "contact")
