"""Benchmarks of structures: statics, published results."""

from .comparison import Comparison, contact_points, interpolate


def ssnv128(program):
    points = contact_points(program.run("examples/04_ssnv128/case.toml"))
    comparison = Comparison("ssnv128")
    for x, published in ((0, 2.86), (1.25, 2.72), (5, 2.28), (7.5, 1.98), (11.25, 1.50)):
        value = 1e5 * interpolate(points, "slip_x", 1e-3 * x)
        comparison.add(f"u_x at x = {x:g} mm, 1e-5 m", value, published, 0.05, 4)
    return comparison.table(), comparison.problems


PULL = 2.5 * 20 * 10  # N, of a quarter of the flange
CONVERGED = {"bolt": 1832.43, "plates": 1332.43}  # --set adapt.tolerance=0.1: 110 454 unknowns


def flange(program):
    """A bolted flange: what bolt and plates carry, against statics and a richer run."""
    contact = program.run("examples/12_flange/case.toml").certificate["contact"]["boundaries"]
    head, nut, plates = (abs(contact[name]["normal"]) for name in ("head", "nut", "upper.bottom"))
    comparison = Comparison("flange")
    comparison.add("force of the head less that of the plates, N", head - plates, PULL, 1e-6, 6)
    comparison.add("force of the nut less that of the plates, N", nut - plates, PULL, 1e-6, 6)
    comparison.add("force of the bolt, a quarter, N", head, CONVERGED["bolt"], 0.02, 5)
    comparison.add("force between the plates, a quarter, N", plates, CONVERGED["plates"], 0.02, 5)
    return comparison.table(), comparison.problems


def resultant_position(points):
    """The x at which the resultant of the pressure acts."""
    forces = [float(row["pressure"]) * float(row["weight"]) for _, row in points]
    return sum(force * x for force, (x, _) in zip(forces, points)) / sum(forces)


WEIGHT, WATER = 2400 * 9.81e-6 * 50 * (5 + 45) / 2, 1000 * 9.81e-6 * 50**2 / 2  # MN per metre of the dam


def gravity_dam(program, name, case):
    """What the base of a gravity dam carries, against statics."""
    areas, centres = (5 * 50, 40 * 50 / 2), (2.5, 5 + 40 / 3)  # rectangle and triangle of the section
    centre = sum(area * x for area, x in zip(areas, centres)) / sum(areas)
    result = program.run(case)
    x_force, y_force = result.certificate["contact"]["force"]
    comparison = Comparison(name)
    comparison.add("N, MN/m", y_force, WEIGHT, 1e-8)
    comparison.add("H, MN/m", -x_force, WATER, 1e-8)
    comparison.add("N acts at x, m", resultant_position(contact_points(result)), centre + WATER / WEIGHT * 50 / 3, 1e-6, 6)
    sliding = result.certificate["contact"]["boundaries"]["base"]["sliding"]
    comparison.add("factor of safety against sliding", sliding["safety_factor"], 0.75 * WEIGHT / WATER, 1e-8)
    return comparison.table(), comparison.problems


def dam(program):
    """On rigid rock."""
    return gravity_dam(program, "dam", "examples/05_dam/case.toml")


def dam_monolith(program):
    """15 m of it in 3D."""
    x_force, y_force, _ = program.run("examples/05_dam/case3d.toml").certificate["contact"]["force"]
    comparison = Comparison("dam_monolith")
    comparison.add("N, MN", y_force, 15 * WEIGHT, 5e-4, 5)
    comparison.add("H, MN", -x_force, 15 * WATER, 5e-4, 5)
    return comparison.table(), comparison.problems


def dam_on_rock(program):
    """On elastic rock."""
    return gravity_dam(program, "dam_on_rock", "examples/09_dam_on_rock/case.toml")


def dam_on_rock_monolith(program):
    """On elastic rock, 15 m of it in 3D."""
    contact = program.run("examples/09_dam_on_rock/case3d.toml").certificate["contact"]["boundaries"]["base"]
    x_force, y_force, _ = contact["force"]
    comparison = Comparison("dam_on_rock_monolith")
    comparison.add("N, MN", y_force, 15 * WEIGHT, 5e-4, 5)
    comparison.add("H, MN", -x_force, 15 * WATER, 5e-4, 5)
    comparison.add("factor of safety against sliding", contact["sliding"]["safety_factor"], 0.75 * WEIGHT / WATER, 1e-3, 5)
    return comparison.table(), comparison.problems
