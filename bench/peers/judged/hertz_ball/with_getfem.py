#!/usr/bin/python3
"""The ball in GetFEM, where mesh.msh is; writes getfem.vtu."""

from getfem_rigid import press

press("ball", {"symmetry_x": 0, "symmetry_z": 2}, 0.1)
