"""Contact with a rigid obstacle without friction, as in GetFEM's demo_static_contact.py."""

import getfem as gf
import numpy as np
from getfem_model import Body, solve, write

UNSYMMETRIC_ALART_CURNIER = 1


def add_obstacle(body: Body, boundary: str, distance: str, youngs_modulus: float) -> None:
    """The obstacle by its signed distance. r, the augmentation, is of the size of the stiffness, as in the demo."""
    model, values = body.model, body.scalars.eval(distance, {"sqrt": np.sqrt})
    model.add_initialized_data("r", [youngs_modulus])
    model.add_initialized_fem_data("obstacle", body.scalars, values)
    model.add_integral_contact_with_rigid_obstacle_brick(
        body.contact_rule, body.variable, body.multiplier(boundary), "obstacle", "r", body.boundaries[boundary],
        UNSYMMETRIC_ALART_CURNIER)


def press(name: str, symmetry: dict[str, int], distance: float) -> None:
    """A body of steel whose boundary "top" is moved down, on the floor y = 0; writes getfem.vtu, prints the force.

    symmetry: boundaries with the direction in which each is held.
    """
    E = 200000
    model = gf.Model("real")
    body = Body(model, name, E, 0.3)
    for boundary, direction in symmetry.items():
        body.hold(boundary, [direction])
    body.hold("top", [1], -distance)
    add_obstacle(body, "contact", "y", E)
    solve(model, E)
    write(body)
    pressure = gf.asm_generic(body.contact_rule, 0, "-contact", body.boundaries["contact"], model)
    print("RESULT contact_force", float(pressure))
