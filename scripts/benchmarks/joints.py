"""Benchmarks of joints in load steps: beams, fracture mechanics, statics, other programs."""

import math

from .comparison import Comparison


def double_cantilever(program):
    """A bond peeled in load steps: beam theory with Griffith's criterion, and another program on the given mesh."""
    certificate = program.run("examples/17_double_cantilever/case.toml").certificate
    on_given = program.run("examples/17_double_cantilever/case.toml", "adapt.max_levels=0", "adapt.tolerance=0.2").certificate
    other = {0.6: (15.247076605837691, 1.8587325870257465), 0.9: (12.427105373568217, 4.946449673790257),
             1.2: (10.757827051925245, 7.543832553433329)}
    comparison = Comparison("double_cantilever")
    for opening, (force, dissipated) in other.items():
        step, given = ([step for step in run["steps"] if abs(step["t"] - opening) < 1e-9][0] for run in (certificate, on_given))
        theory = (70e3 * 3**3 / 12 / (1 - 0.3**2)) ** 0.25 / math.sqrt(3 * opening)
        comparison.add(f"force at an opening of {opening} mm, N/mm: beam theory", step["balance"]["rows"][0]["force"][1], theory, 0.005, 5)
        comparison.add("on the given mesh: other program", given["balance"]["rows"][0]["force"][1], force, 1e-8)
        comparison.add("dissipated, N: other program", given["dissipated"], dissipated, 1e-8)
    return comparison.table(), comparison.problems


def snap_back(program):
    """A bar on a brittle bond, in closed form."""
    certificate = program.run("examples/19_snap_back/case.toml").certificate
    modulus, strength, critical = 1000 * 0.8 / (1.2 * 0.6), 2, 6e-4
    comparison = Comparison("snap_back")
    for damage in (0.2, 0.4, 0.8):
        step = min(certificate["steps"], key=lambda step: abs(step["interfaces"]["bottom"]["damage"] / 0.1 - damage))
        stress = strength * (1 - damage)
        comparison.add(f"t at D = {damage}", step["t"], stress / modulus + damage * critical, 1e-8)
        comparison.add(f"stress at D = {damage}, MPa", step["contact"]["normal"] / 0.1, stress, 1e-8)
    return comparison.table(), comparison.problems


def mixed_mode(program):
    """A block pulled off a bond at a fixed angle, in closed form: with beta^2 = G / M the effective opening is that of a bar."""
    steps = program.run("examples/21_mixed_mode/case.toml").certificate["steps"]
    modulus, strength, critical, beta, width = 1000 * 0.8 / (1.2 * 0.6), 2, 0.02, math.sqrt(0.375), 2
    softening = strength / critical
    comparison = Comparison("mixed_mode")
    for step in steps:
        opening = min(max(0, (modulus * step["t"] - strength) / (modulus - softening)), critical)
        stress = modulus * (step["t"] - opening)
        comparison.add(f"t = {step['t']}: normal stress, MPa", step["contact"]["normal"] / width, 0.8 * stress, 1e-8)
        comparison.add(f"t = {step['t']}: shear stress, MPa", -step["contact"]["tangential"] / width, 0.6 * beta * stress, 1e-8)
    return comparison.table(), comparison.problems


def contraction_joint(program):
    """Two monoliths and the joint between them, as springs in series."""
    steps = program.run("examples/22_contraction_joint/case.toml").certificate["steps"]
    stiffness, strength, critical = 30e3 / (1 - 0.2**2) / 20, 0.3, 2 * 6e-5 / 0.3
    comparison = Comparison("contraction_joint")
    largest = 0
    for season, step in zip(("autumn", "winter", "spring", "summer", "colder winter", "next summer"), steps, strict=True):
        t = -2.5e-4 * step["t"]  # by how much both would shorten: 1.2 alpha 20 m, alpha = 1/96000
        opening = (stiffness * t - strength) / (stiffness - strength / critical)  # as it softens
        if t <= 0:
            opening = 0
        elif max(opening, largest) >= critical:
            opening = t
        elif 0 < largest and opening <= largest:
            opening = stiffness * t / (stiffness + strength * (1 / largest - 1 / critical))
        opening = max(0, opening)
        largest = max(largest, opening)
        comparison.add(f"{season}: opening, mm", round(1e3 * step["watch"]["opening"], 12) + 0.0, 1e3 * opening, 1e-8, relative_to=1e3 * critical)
        comparison.add(f"{season}: stress, MPa", round(step["contact"]["normal"] / 4, 12) + 0.0, stiffness * (t - opening), 1e-8, relative_to=strength)
    return comparison.table(), comparison.problems


def dam_to_failure(program):
    """A dam whose joint breaks: statics, and another program on its mesh."""
    case, given = "examples/20_dam_to_failure/case.toml", ["mesh.file=../../tests/verification/data/dam_12.msh", "adapt.max_levels=0", "adapt.tolerance=0.05"]
    steps = program.run(case, *given, "history.damage_step=1").certificate["steps"]
    full, first = (step["interfaces"]["base"] for step in (steps[3], steps[5]))
    peaks = [program.run(case, *given, f"history.damage_step={step}").certificate["path"]["peak"]["t"] for step in (1, 0.25)]
    cracked = program.run(case, *given, "boundary.base.interface.water.crack=true", "history.steps=[0, 40, 70, 80]").certificate
    comparison = Comparison("dam_to_failure")
    comparison.add("effective normal force at 80 m, MN/m: statics", full["effective_normal"], -37.6704, 1e-8)
    comparison.add("total resultant at 80 m, x in m: statics", full["resultant_x_total"], 33.80341880341, 1e-8)
    comparison.add("sliding safety at 80 m: statics", full["sliding_safety"], math.tan(math.pi / 6) * 37.6704 / 31.392, 1e-8)
    comparison.add("level after the first step of damage, m: other program", steps[5]["t"], 84.32379864685534, 1e-6)
    comparison.add("damage of the joint then, m: other program", first["damage"], 19.588551446653856, 1e-6)
    comparison.add("peak of the level, steps of 1 m: other program", peaks[0], 86.39012588143882, 2e-3, 5)
    comparison.add("peak, steps of 0.25 m: other program", peaks[1], 86.342, 2e-3, 5)
    comparison.add("peak with full pressure in the crack, m: other program", cracked["path"]["peak"]["t"], 83.05515455380461, 2e-3, 5)
    return comparison.table(), comparison.problems


def monolith_to_failure(program):
    """The same in 3D, 6 m of it: statics, and the dam in 2D."""
    certificate = program.run("examples/23_monolith_to_failure/case.toml").certificate
    full, highest = (certificate["steps"][i] for i in (3, certificate["path"]["peak"]["step"] - 1))
    flat = program.run("examples/20_dam_to_failure/case.toml", "mesh.file=../../tests/verification/data/dam_12.msh", "adapt.max_levels=0", "adapt.tolerance=0.05",
                       "boundary.base.interface.water.crack=true", "history.steps=[0, 40, 70, 80]", "history.damage_step=2.5").certificate
    base, gamma, width = full["interfaces"]["base"], 9.81e-3, 6
    t, crack = highest["t"], highest["interfaces"]["base"]["crack_tip"]
    comparison = Comparison("monolith_to_failure")
    comparison.add("effective normal force at 80 m, MN: statics", base["effective_normal"], -37.6704 * width, 1e-8)
    comparison.add("total resultant at 80 m, x in m: statics", base["resultant_x_total"], 33.80341880341, 1e-8)
    comparison.add("sliding safety at 80 m: statics", base["sliding_safety"], math.tan(math.pi / 6) * 37.6704 / 31.392, 1e-8)
    comparison.add("normal force at the highest step, MN: statics", highest["contact"]["normal"], -2400 * 9.81e-6 * 32.5 * 80 * width, 1e-8)
    comparison.add("uplift then, with its crack, MN: statics", highest["interfaces"]["base"]["uplift"], gamma * t * (crack + (60 - crack) / 2) * width, 1e-8)
    comparison.add("peak of the level, m: the dam in 2D", certificate["path"]["peak"]["t"], flat["path"]["peak"]["t"], 1e-2, 5)
    return comparison.table(), comparison.problems
