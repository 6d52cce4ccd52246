"""Benchmarks with the theory of Hertz."""

import math

from .comparison import Comparison, add_profile, contact_points, hertz_fit


def hertz_cylinder(program):
    result = program.run("examples/03b_hertz_cylinder/case.toml")
    force = 2 * abs(result.certificate["contact"]["normal"])  # half of the cylinder is computed
    a = math.sqrt(4 * force * 10 * (1 - 0.3**2) / (math.pi * 200000))
    samples = [(x, float(row["pressure"])) for x, row in contact_points(result)]
    width, pressure = hertz_fit(samples, 0.8 * a)
    comparison = Comparison("hertz_cylinder")
    comparison.add("force per length, N/mm", force, 4000, 1e-3, 5)
    comparison.add("largest pressure p0, MPa", pressure, 2 * force / (math.pi * a), 0.01, 5)
    comparison.add("half width a, mm", width, a, 0.01, 4)
    comparison.add("half width a, last closed point, mm", max(x for x, p in samples if p > 0), a, 0.02, 4)
    return comparison.table(), comparison.problems


def hertz_sphere(program):
    result = program.run("examples/03_hertz_sphere/case.toml")
    force = 4 * abs(result.certificate["contact"]["normal"])  # a quarter of the ball is computed
    a = (3 * force * 10 * (1 - 0.3**2) / (4 * 200000)) ** (1 / 3)
    samples = [(math.hypot(float(row["x"]), float(row["z"])), float(row["pressure"])) for row in result.contact]
    radius, pressure = hertz_fit(samples, 0.8 * a)
    comparison = Comparison("hertz_sphere")
    comparison.add("force, N", force, 100 * math.pi * 10**2, 0.01, 6)
    comparison.add("largest pressure p0, MPa", pressure, 3 * force / (2 * math.pi * a**2), 0.02, 5)
    comparison.add("radius a, mm", radius, a, 0.02, 4)
    return comparison.table(), comparison.problems


def hertz_meridian(program):
    result = program.run("examples/29_hertz_ball/case.toml")
    force = abs(result.certificate["contact"]["normal"])
    a = (3 * force * 10 * (1 - 0.3**2) / (4 * 200000)) ** (1 / 3)
    samples = [(float(row["x"]), float(row["pressure"])) for row in result.contact]
    radius, pressure = hertz_fit(samples, 0.8 * a)
    comparison = Comparison("hertz_meridian")
    comparison.add("force, N", force, 100 * math.pi * 10**2, 1e-6, 7)
    comparison.add("largest pressure p0, MPa", pressure, 3 * force / (2 * math.pi * a**2), 0.01, 5)
    comparison.add("radius a, mm", radius, a, 0.01, 4)
    return comparison.table(), comparison.problems


STEEL, ALUMINIUM = (210e3, 0.3), (70e3, 0.33)  # E and nu of examples 10 and 11


def contact_modulus():
    """E* of Hertz's theory: 1/E* is the sum of (1 - nu^2)/E."""
    return 1 / sum((1 - nu**2) / E for E, nu in (STEEL, ALUMINIUM))


def hertz_cylinders(program):
    """Steel, R = 10 mm, on aluminium, R = 15 mm."""
    result = program.run("examples/10_hertz_cylinders/case.toml")
    force = 2 * abs(result.certificate["contact"]["normal"])  # half of the cylinders is computed
    a = math.sqrt(4 * force / (1 / 10 + 1 / 15) / (math.pi * contact_modulus()))
    p0 = 2 * force / (math.pi * a)
    samples = [(x, float(row["pressure"]), float(row["weight"])) for x, row in contact_points(result)]
    width, pressure = hertz_fit([(x, p) for x, p, _ in samples], 0.8 * a)
    comparison = Comparison("hertz_cylinders")
    comparison.add("force per length, N/mm", force, 2000, 1e-6, 5)
    comparison.add("largest pressure p0, MPa", pressure, p0, 2e-3, 5)
    comparison.add("half width a, mm", width, a, 2e-3, 4)
    comparison.add("half width a, length of the closed part, mm", sum(weight for _, p, weight in samples if p > 0), a, 5e-3, 4)
    add_profile(comparison, samples, a, p0, 5e-3)
    return comparison.table(), comparison.problems


def balls(name, result, radius, modulus, pressure_on_load):
    """A ball of radius 10 mm on a body with the sum of curvatures 1/radius, a quarter of it computed; theory for the force on the mesh."""
    force = 4 * abs(result.certificate["contact"]["force"][1])
    a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    p0 = 3 * force / (2 * math.pi * a**2)
    samples = [(math.hypot(float(row["x"]), float(row["z"])), float(row["pressure"]), float(row["weight"])) for row in result.contact]
    width, pressure = hertz_fit([(r, p) for r, p, _ in samples], 0.8 * a)
    area = 4 * sum(weight for _, p, weight in samples if p > 0)
    comparison = Comparison(name)
    comparison.add("force, N", force, pressure_on_load * math.pi * 10**2, 0.015, 6)
    comparison.add("largest pressure p0, MPa", pressure, p0, 0.03, 4)
    comparison.add("radius a, mm", width, a, 0.02, 4)
    comparison.add("radius a, area of the closed part, mm", math.sqrt(area / math.pi), a, 0.02, 4)
    add_profile(comparison, samples, a, p0, 0.02)
    return comparison.table(), comparison.problems


def hertz_ball_block(program):
    """Steel, R = 10 mm, on a block of aluminium."""
    return balls("hertz_ball_block", program.run("examples/11_hertz_ball_block/case.toml"), 10, contact_modulus(), 25)


def hertz_spheres(program):
    """Two balls of one material, R = 10 and 15 mm, with friction."""
    modulus = 200e3 / (1 - 0.3**2) / 2
    return balls("hertz_spheres", program.run("examples/16_hertz_on_spheres/case.toml"), 1 / (1 / 10 + 1 / 15), modulus, 40)


def nafems(name, result, thickness):
    """A cylinder of steel on a block of aluminium; a and p0 as published."""
    force = 2 * abs(result.certificate["contact"]["force"][1]) / thickness  # half of it is computed
    samples = [(float(row["x"]), float(row["pressure"]), float(row["weight"])) for row in result.contact]
    width, pressure = hertz_fit([(x, p) for x, p, _ in samples], 0.8 * 6.21)
    comparison = Comparison(name)
    comparison.add("force, N per mm", force, 35000, 1e-6, 6)
    comparison.add("largest pressure p0, MPa", pressure, 3585.37, 0.02, 5)
    comparison.add("half width a, mm", width, 6.21, 0.02, 4)
    comparison.add("half width a, area of the closed part, mm", sum(weight for _, p, weight in samples if p > 0) / thickness, 6.21, 0.02, 4)
    add_profile(comparison, samples, 6.2146, 3585.37, 0.02)
    return comparison.table(), comparison.problems


def nafems_cylinder(program):
    return nafems("nafems_cylinder", program.run("tests/cases/nafems_cylinder.toml"), 1)


def nafems_cylinder_3d(program):
    return nafems("nafems_cylinder_3d", program.run("tests/cases/nafems_cylinder_3d.toml"), 4)
