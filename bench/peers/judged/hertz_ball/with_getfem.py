#!/usr/bin/python3
"""The ball in GetFEM, where mesh.msh is; writes getfem.vtu."""

import getfem as gf
from getfem_model import Body, solve, write
from getfem_rigid import add_obstacle, print_force

E = 200000

model = gf.Model("real")
ball = Body(model, "ball", E, 0.3)
ball.hold("symmetry_x", [0])
ball.hold("symmetry_z", [2])
ball.hold("top", [1], -0.1)
add_obstacle(ball, "contact", "y", E)
solve(model, E)
write(ball)
print_force(ball, "contact")
