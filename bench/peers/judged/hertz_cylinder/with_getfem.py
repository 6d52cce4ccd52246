#!/usr/bin/python3
"""The cylinder in GetFEM, where mesh.msh is; writes getfem.vtu."""

from getfem_rigid import press

press("cylinder", {"symmetry": 0}, 0.05)
