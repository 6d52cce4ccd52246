"""Contact with a rigid obstacle without friction, as in GetFEM's demo_static_contact.py."""

import getfem as gf
import numpy as np
from getfem_model import Body

UNSYMMETRIC_ALART_CURNIER = 1


def add_obstacle(body: Body, boundary: str, distance: str, youngs_modulus: float) -> None:
    """The obstacle by its signed distance. r, the augmentation, is of the size of the stiffness, as in the demo."""
    model, values = body.model, body.scalars.eval(distance, {"sqrt": np.sqrt})
    model.add_initialized_data("r", [youngs_modulus])
    model.add_initialized_fem_data("obstacle", body.scalars, values)
    model.add_integral_contact_with_rigid_obstacle_brick(
        body.contact_rule, body.variable, body.multiplier(boundary), "obstacle", "r", body.boundaries[boundary],
        UNSYMMETRIC_ALART_CURNIER)


def print_force(body: Body, boundary: str) -> None:
    pressure = gf.asm_generic(body.contact_rule, 0, "-contact", body.boundaries[boundary], body.model)
    print("RESULT contact_force", float(pressure))
