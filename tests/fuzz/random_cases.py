"""Random valid cases: all laws, degrees and kinds of mesh; data with features that rules may miss; cheap on purpose."""

import json
from pathlib import Path

import numpy as np

from random_meshes import random_mesh


class Dice:
    """The source of randomness of the generators."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)

    def chance(self, probability):
        return self.rng.random() < probability

    def one_of(self, choices):
        return choices[self.rng.integers(len(choices))]

    def between(self, low, high):
        return float(self.rng.uniform(low, high))

    def power(self, low, high):
        """10^U(low, high), with few digits."""
        return float(f"{10.0 ** self.rng.uniform(low, high):.3g}")

    def integer(self, low, high):
        return int(self.rng.integers(low, high + 1))


def random_tree(dice, leaves, depth):
    """An expression that is finite everywhere, built from everything that formulas may contain."""
    if depth == 0 or dice.chance(0.15):
        return dice.one_of([*leaves, "pi", "e", f"{dice.between(0, 3):.3g}", f"{dice.integer(1, 9)}e-1", ".5"])
    a, b, c = (random_tree(dice, leaves, depth - 1) for _ in range(3))
    return dice.one_of(
        [f"{a}+{b}", f"({a})-({b})", f"({a})*({b})", f"({a})/(1+({b})^2)"]
        + [f"-({a})^2", f"({a})^3", f"abs({a})^1.5", f"2^-abs({a})"]
        + [f"sin({a})", f"cos({a})", f"tanh({a})", f"exp(-abs({a}))", f"sqrt(abs({a}))", f"ln(1+abs({a}))", f"log(2+({a})^2)"]
        + [f"log10(1+({a})^2)", f"log2(3+abs({a}))", f"asin(sin({a}))", f"acos(cos({a}))", f"asinh({a})", f"atanh(0.9*sin({a}))"]
        + [f"acosh(1+abs({a}))", f"atan2({a}, 1+({b})^2)", f"sinh(sin({a}))", f"cosh(cos({a}))", f"tan(atan({a}))", f"sign({a})"]
        + [f"max({a}, {b}, {c})", f"min({a}, {b})", f"sum({a}, {b}, {c})", f"avg({a}, {b})", f"abs({a})", f"rint({a})"]
        + [f"({a} < {b} ? {c} : {a})", f"({a} >= {b} && {b} > {c})", f"({a} <= {b} || {c} != {a})", f"({a} == {b})"]
    )


def random_formula(dice, size, lower, upper, positive=False):
    """A datum of about the given size on the box [lower, upper]: a number or a quoted formula."""
    a = int(dice.rng.integers(len(lower)))
    name, low, width = "xyz"[a], float(lower[a]), float(upper[a] - lower[a])
    s = f"(({name}-({low:.6g}))/{width:.6g})"  # runs from 0 to 1
    scaled = [f"({axis}/{width:.4g})" for axis in "xyz"[: len(lower)]]
    c, k = dice.between(0.05, 0.95), dice.integer(1, 9)
    w = dice.power(-2.5, -0.5)
    sign = dice.one_of([-1, 1])
    m = f"{sign * size * dice.between(0.2, 1):.4g}"
    formulas = {
        "number": m,
        "linear": f"{m}*(1-{c:.3f}*{s})",
        "quadratic": f"{m}*{s}*({c:.3f}-{s})*4",
        "wave": f"{m}*sin({dice.between(0.5, 6):.3f}*{s}+{c:.3f})",
        "exp": f"{m}*exp(-{dice.between(0.1, 5):.3f}*{s})",
        "kink": f"{m}*max(0, {s}-{c:.3f})",
        "abs": f"{m}*abs({s}-{c:.3f})",
        "jump": f"{s} < {c:.3f} ? {m} : {dice.one_of(['0', f'-0.5*({m})'])}",
        "strip": f"{s} > {c:.4f} && {s} < {c + w:.4f} ? {m} : 0",
        "spike": f"{m}*exp(-(({s}-{c:.3f})/{max(w, 0.05):.4f})^2)",
        "oscillation": f"{m}*cos({10 * k}*{s})",
        "tree": f"{m}*atan({random_tree(dice, scaled, 3)})",
        "product": f"{m}*(1+{'xy'[1 - min(a, 1)]}/{width:.4g})*{s}",
    }
    shape = dice.one_of([*["number"] * 5, *formulas])
    formula = formulas[shape]
    if positive:
        formula = formula.lstrip("-") if shape == "number" else f"abs({formula})"
    return float(formula) if shape == "number" else formula


def random_case(seed, directory):
    """Writes case.toml into the directory, with a mesh if it needs one; returns the file."""
    dice = Dice(seed)
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    degree = dice.one_of([1, 1, 2, 2, 2, 3, 3, 4])
    mesh = random_mesh(dice, degree, directory)
    table = {
        "title": f"seed {seed}",
        "degree": degree,
        "mesh": mesh.table,
        "material": random_material(dice, mesh),
        "boundary": random_boundaries(dice, mesh),
        **random_keys(dice, degree),
        "output": {"report": False, "levels": "all"},
    }
    conditions = table["boundary"].values()
    loaded = any(str(entry.get("traction", [])).strip("[0, ]") or "pressure" in entry for entry in conditions)
    load = random_load(dice, mesh, table["material"], dice.chance(0.4 if loaded else 0.95))
    if load:
        table["load"] = load
    table |= random_observations(dice, mesh)
    has_names, is_meridian = dice.chance(0.2), dice.chance(0.3)
    if is_meridian and "box" in mesh.table and len(mesh.lower) == 2:
        make_meridian(table, mesh)
    if has_names:
        name_numbers(dice, table)
    file = directory / "case.toml"
    file.write_text(toml(table))
    return file


def random_material(dice, mesh):
    mesh.scale_E = dice.power(0, 0.1) if dice.chance(0.5) else dice.power(-2, 11)

    def one(E):
        nu = dice.one_of([0.0, 0.2, 0.3, 0.3, 0.45, -0.3, 0.49, 0.499, 0.4999])
        return {"E": E, "nu": nu, **({"plane": "stress"} if len(mesh.lower) == 2 and dice.chance(0.2) else {})}

    if len(mesh.regions) == 1:
        return one(mesh.scale_E)
    return {name: one(mesh.scale_E * dice.power(-3, 0)) for name in mesh.regions}


def random_load(dice, mesh, material, has_body):
    """Body force, initial stress and temperature, one table for all regions."""
    strain = dice.power(-4, -2)

    def datum(size):
        return random_formula(dice, size, mesh.lower, mesh.upper)

    load = {}
    if has_body:
        size = mesh.scale_E * strain / np.ptp([mesh.lower, mesh.upper], axis=0).max()
        load["body"] = [datum(size) for _ in mesh.lower]
    materials = list(material.values()) if isinstance(next(iter(material.values())), dict) else [material]
    if dice.chance(0.2):
        n = 6 if len(mesh.lower) == 3 else 3
        if n == 3 and not any("plane" in own for own in materials) and dice.chance(0.3):
            n = 4
        load["initial_stress"] = [datum(mesh.scale_E * strain) if dice.chance(0.6) else 0 for _ in range(n)]
    if dice.chance(0.25):
        for own in materials:
            own["alpha"] = dice.one_of([1e-5, 1e-5, 0])
        load["temperature"] = datum(strain * 1e5)
        if dice.chance(0.5):
            load["reference_temperature"] = datum(strain * 1e5)
    return load


def random_observations(dice, mesh):
    """Probes and sections."""
    place = lambda: [float(f"{dice.between(a, b):.6g}") for a, b in zip(mesh.lower, mesh.upper)]
    tables = {}
    if dice.chance(0.15):
        tables["probe"] = {"crest": {"point": place()}}
        if dice.chance(0.5):
            tables["probe"]["line"] = {"from": place(), "to": place(), "points": dice.integer(2, 9)}
    if dice.chance(0.15):
        tables["section"] = {"base": {"point": place(), "normal": [round(dice.between(-1, 1), 3) for _ in mesh.lower]}}
        if dice.chance(0.3):
            tables["section"]["base"]["within"] = str(random_formula(dice, 1.0, mesh.lower, mesh.upper))
    return tables


def make_meridian(table, mesh):
    """A body of revolution, without what the judge does not integrate there: initial stresses, springs, sliders, narrow bores."""
    if mesh.lower[0] != 0 and mesh.lower[0] < 0.1 * mesh.upper[0]:
        return
    table["model"] = "axisymmetric"
    for key in ("plane", "alpha"):
        table["material"].pop(key, None)
    for key in ("initial_stress", "temperature", "reference_temperature"):
        table.get("load", {}).pop(key, None)
    for name, entry in table["boundary"].items():
        entry.pop("spring", None)
        if not entry or "slider" in entry:
            table["boundary"][name] = {"traction": [0, 0]}
    if mesh.lower[0] == 0:
        table["boundary"]["left"] = {"displacement": [0, "free"]}


def name_numbers(dice, table):
    """Parameters in place of numbers."""
    parameters = {}
    if "E" in table["material"]:
        parameters["stiffness"] = {"value": table["material"]["E"], "label": "Young's modulus"}
        table["material"]["E"] = "stiffness"
    loaded = [entry for entry in table["boundary"].values() if "traction" in entry]
    if loaded:
        parameters["factor"] = dice.power(-0.1, 0.1)
    for entry in loaded:
        entry["traction"] = [f"factor*({datum})" for datum in entry["traction"]]
    if parameters:
        table["parameters"] = parameters


def random_boundaries(dice, mesh):
    """The first boundary is usually in contact, the second holds the body; the others are loaded, held, in contact or free."""
    d = len(mesh.lower)
    length = float(np.ptp([mesh.lower, mesh.upper], axis=0).max())
    strain = dice.power(-5, -2)
    stress, shift = strain * mesh.scale_E, strain * length

    def datum(size, positive=False):
        return random_formula(dice, size, mesh.lower, mesh.upper, positive)

    def contact():
        law = dice.one_of(["none", "tresca", "coulomb", "coulomb"])
        entry = {"friction": law}
        if law == "tresca":
            entry["threshold"] = datum(stress * dice.power(-1.5, 0.5), True)
        if law == "coulomb":
            entry["coefficient"] = dice.one_of([0, 0.1, 0.3, 0.3, 0.7, 1.5])
        if dice.chance(0.4):
            entry["gap"] = datum(shift * dice.power(-2, 0.5), True)
            if dice.chance(0.15):  # zero up to rounding along the bottom
                entry["gap"] = f"{strain:.3g}*(y-({float(mesh.lower[1])!r}))"
        return {"contact": entry}

    # One displacement for all boundaries, so that they agree where they meet.
    prescribed = [0.0 if dice.chance(0.6) else float(f"{shift * dice.between(-1, 1):.4g}") for _ in range(d)]
    if dice.chance(0.1):
        prescribed[0] = datum(shift)

    def held(all_components):
        free = dice.integer(0, d - 1)
        keep = dice.chance(0.8)
        return {"displacement": ["free" if not all_components and (k == free) == keep else prescribed[k] for k in range(d)]}

    def loaded():
        entry = {"traction": [datum(stress) if dice.chance(0.6) else 0 for _ in range(d)]}
        if dice.chance(0.4):
            entry["pressure"] = datum(stress)
        if dice.chance(0.25):
            entry["spring"] = spring()
        return entry

    def spring():
        stiffness = mesh.scale_E / length * dice.power(-2, 2)
        if dice.chance(0.3):
            return datum(stiffness, True)
        keys = {"normal": datum(stiffness, True)}
        if dice.chance(0.6):
            keys["tangential"] = datum(stiffness * dice.power(-1, 0), True)
        if dice.chance(0.5):
            keys["rest"] = [datum(shift) for _ in range(d)]
        return keys

    def slider():
        return {"slider": 0 if dice.chance(0.5) else datum(shift)}

    free = {"traction": [0] * d}
    names = list(mesh.boundaries)
    conditions = {}
    for number, name in enumerate(names):
        if number == 0 and dice.chance(0.9):
            conditions[name] = contact()
        elif number == 1 and dice.chance(0.15):  # nothing else holds it
            stiffness = mesh.scale_E / length * dice.power(-1, 1)
            conditions[name] = {"spring": {"normal": stiffness, "tangential": stiffness / 3}}
        elif number == 1:
            conditions[name] = held(dice.chance(0.85))
        else:
            kind = dice.one_of([loaded, loaded, loaded, lambda: free, lambda: free, contact, slider, lambda: held(False)])
            conditions[name] = kind()
    return conditions


def random_keys(dice, degree):
    """Everything else, mostly left out."""
    adapt = {"tolerance": dice.power(-2, 0), "max_levels": dice.one_of([0, 0, 0, 1, 1, 2, 3]), "max_dofs": 3000}
    if dice.chance(0.3):
        adapt |= {"marking": dice.one_of(["doerfler", "maximum", "uniform"]), "theta": round(dice.between(0.1, 1), 2)}
    if dice.chance(0.1):
        adapt["separate_contact"] = True
    keys = {"adapt": adapt}
    if dice.chance(0.25):
        keys["nitsche"] = {"gamma0": dice.power(np.log10(max(1.0, degree**2)), 2.5)}
    if dice.chance(0.4):
        keys["newton"] = {"stopping": dice.one_of(["adaptive", "adaptive_local", "tolerance"])}
        if dice.chance(0.5):
            keys["newton"]["gamma_lin"] = dice.power(-3, 0.5)
        if dice.chance(0.2):
            keys["newton"]["damping"] = False
        if dice.chance(0.1):
            keys["newton"]["max_steps"] = dice.integer(1, 8)
    if dice.chance(0.12):
        keys["regularisation"] = {"delta": dice.power(-2, 1)} if dice.chance(0.7) else {}
    if dice.chance(0.2):
        keys["solver"] = {"method": dice.one_of(["direct", "condensed", "iterative"])}
        if keys["solver"]["method"] == "direct":
            keys["solver"]["package"] = dice.one_of(["mumps", "umfpack", "auto"])
        elif dice.chance(0.5):
            keys["solver"]["tolerance"] = dice.power(-13, -9)
    if dice.chance(0.03):
        keys["certify"] = {"contact_rule": "reference"}
    if dice.chance(0.5):
        keys.setdefault("certify", {})["stress"] = "afw"
    return keys


def toml(table, prefix=""):
    """The table in TOML: sections down to those of one boundary or region, inline tables below."""
    lines, sections = [], []
    for key, value in table.items():
        name = key if key.replace("_", "").isalnum() else json.dumps(key)
        if isinstance(value, dict) and prefix in ("", "boundary.", "material.", "probe.", "section."):
            sections.append(f"\n[{prefix}{name}]\n" + toml(value, f"{prefix}{name}."))
        else:
            lines.append(f"{name} = {inline(value)}")
    return "\n".join(lines) + ("\n" if lines else "") + "".join(sections)


def inline(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {inline(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    return json.dumps(value)
