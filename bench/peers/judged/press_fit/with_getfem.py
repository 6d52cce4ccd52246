#!/usr/bin/python3
"""The ring in GetFEM, where mesh.msh is; writes getfem.vtu."""

import getfem as gf
from getfem_model import Body, solve, write
from getfem_rigid import add_obstacle

E = 210000

model = gf.Model("real")
ring = Body(model, "ring", E, 0.3)
ring.hold("bottom", [1])
ring.hold("left", [0])
add_obstacle(ring, "contact", "sqrt(x*x + y*y) - 50.05", E)
solve(model, E)
write(ring)
print("RESULT growth", ring.mean_displacement("outside", "[1; 1]") / 2**0.5)
