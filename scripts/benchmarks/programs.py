"""Benchmarks with exact solutions, and digit by digit against other programs."""

import json

from tables import ROOT, table

from .comparison import OPEN, SLIP, STICK, Comparison, contact_points, transition

EXACT = 1e-10  # rounding: with the gap of 1 the first Newton step closes contact and is off by 100 times the solution


def exact(program):
    """Constant stress in every state of contact."""
    open_D = -1.5 * 0.1 / 3.5
    states = {
        "slip, Tresca": ([], 0.6),
        "slip, Coulomb": ([f'boundary.bottom.contact={{ friction = "coulomb", coefficient = {0.2 / 0.9!r} }}'], 0.6),
        "stick, Tresca": (['boundary.left.displacement=["0.2*y", "-0.3*y"]', "boundary.top.displacement=[0.2, -0.3]",
                           "boundary.right.traction=[-0.45, 0.2]", "boundary.bottom.contact.threshold=0.4"], 0.71),
        "closed, frictionless": (['boundary.left.displacement=[0.05, "-0.3*y"]', 'boundary.top.displacement=["0.1*x + 0.05", -0.3]',
                                  "boundary.right.traction=[-0.1, 0]", "boundary.bottom.contact={}"], 0.52),
        "open, frictionless": ([f'boundary.left.displacement=[0.05, "{open_D!r}*y"]',
                                f'boundary.top.displacement=["0.1*x + 0.05", {open_D!r}]',
                                f"boundary.right.traction=[{0.35 + 1.5 * open_D!r}, 0]", "boundary.bottom.contact.friction=none",
                                "boundary.bottom.contact={ gap = 1 }"], 2 * 0.1 * (0.35 + 1.5 * open_D)),
    }
    rows, problems = [], []
    for state, (settings, energy) in states.items():
        errors = []
        for p in (1, 2, 3, 4):
            certificate = program.run("tests/cases/constant_stress.toml", f"degree={p}", *settings).certificate
            errors.append(max(abs(certificate["energy"] / energy - 1), certificate["relative"]))
            if errors[-1] > EXACT:
                problems.append(f"exact: {state}, degree {p}: {errors[-1]:.1e}")
        rows.append([state, f"{energy:.8g}", *(f"below {EXACT:g}" if error <= EXACT else f"{error:.1e}" for error in errors)])
    return table(["state|", "a(u, u)", *(f"degree {p}" for p in (1, 2, 3, 4))], rows), problems


def t2d(program):
    """Fixed meshes, digit by digit, against an independent prototype."""
    reference = json.loads((ROOT / "tests/verification/data/t2d.json").read_text())
    rows, problems = [], []
    for case in reference["results"]:
        p, nx, ny = case["p"], case["nx"], case["ny"]
        certificate = program.run("tests/cases/t2d.toml", f"degree={p}", f"mesh.box.cells=[{nx}, {ny}]").certificate
        pairs = {
            "energy": (certificate["energy"], case["energy"]),
            "normal": (certificate["contact"]["normal"], case["contact_normal"]),
            "tangential": (certificate["contact"]["tangential"], case["contact_tangential"]),
            "bound": (certificate["bound_plain"], case["converged_est"]["eta_tot"]),
        }
        worst = max(abs(value / expected - 1) for value, expected in pairs.values())
        rows.append([p, f"{nx} x {ny}", f"{pairs['energy'][0]:.10g}", f"{case['energy']:.10g}", f"{pairs['bound'][0]:.8g}",
                     f"{case['converged_est']['eta_tot']:.8g}", "below 1e-8" if worst < 1e-8 else f"{worst:.0e}"])
        if worst > 1e-8:
            problems.append(f"t2d: degree {p}, {nx} x {ny}: deviation {worst:.1e}")
    columns = ["degree", "squares", "energy", "reference", "bound", "reference", "largest deviation"]
    return table(columns, rows), problems


def two_bodies(program):
    """Two and three bodies on meshes that do not match, digit by digit: solutions against GetFEM, bounds against a prototype."""
    reference = json.loads((ROOT / "tests/verification/data/two_bodies.json").read_text())
    getfem = json.loads((ROOT / "tests/verification/data/two_bodies_getfem.json").read_text())
    solutions = {(case["name"], case["p"]): case for case in getfem["cases"]}
    laws = {"none": "", "tresca": ", threshold=0.03", "coulomb": ", coefficient=0.5", "tied": ""}
    fixed = ["nitsche.gamma0=10", "newton.stopping=tolerance", "newton.tolerance=1e-12", "adapt.max_levels=0",
             "certify.contact_rule=reference", "certify.stress=afw"]
    rows, problems = [], []
    for case in reference["cases"]:
        kind, law, *meshes = case["name"].split("_")
        settings = [f"degree={case['p']}", *fixed]
        if kind == "B2":
            gap = ', gap="0.06*(x - 1)^2"' if meshes == ["gap"] else ""
            settings.append(f'contact.0={{slave="upper.bottom", master="lower.top", friction="{law}"{laws[law]}{gap}}}')
            upper, lower = ("6x3", "5x2") if gap else meshes
            for name, cells in (("upper", upper), ("lower", lower)):
                settings.append(f"mesh.boxes.{name}.cells=[{cells.replace('x', ', ')}]")
        elif kind != "B3":
            continue
        example = "examples/06_two_blocks" if kind == "B2" else "examples/07_three_blocks"
        certificate = program.run(f"{example}/case.toml", *settings).certificate
        solution = solutions[case["name"], case["p"]]
        pairs = {
            "energy": (certificate["energy"], solution["energy"]),
            "normal": (certificate["contact"]["normal"], solution["normal"]),
            "tangential": (certificate["contact"]["tangential"], solution["tangential"]),
            "bound": (certificate["bound"], case["iterates"]["last"]["components"]["total"]),
        }
        scale = max(abs(value) for value in pairs["normal"])
        worst = max(abs(value - other) / (scale if name == "tangential" else abs(other)) for name, (value, other) in pairs.items())
        bodies = {"gap": "two, with a gap", "4x2": "two, coarse meshes"}.get((meshes or [""])[0], "two" if kind == "B2" else "three")
        rows.append([bodies, {"none": "no friction", "tied": "tied"}.get(law, law.capitalize()), case["p"], f"{pairs['energy'][0]:.10g}", f"{pairs['energy'][1]:.10g}",
                     f"{pairs['bound'][0]:.8g}", f"{pairs['bound'][1]:.8g}", "below 1e-8" if worst < 1e-8 else f"{worst:.0e}"])
        if worst > 1e-8:
            problems.append(f"two_bodies: {case['name']}, degree {case['p']}: deviation {worst:.1e}")
    columns = ["bodies|", "contact|", "degree", "energy", "GetFEM", "bound", "prototype", "largest deviation"]
    return table(columns, rows), problems


def overkill(program):
    """Adapted to a small tolerance, against much finer solutions of the prototype."""
    result = program.run("examples/01_tresca_block/case.toml", "degree=3", "adapt.tolerance=1e-4", "adapt.theta=0.6")
    certificate, points = result.certificate, contact_points(result)
    comparison = Comparison("overkill")
    comparison.add("energy a(u, u)", certificate["energy"], 0.0168043384, 1e-6, 9)
    comparison.add("contact force, normal", certificate["contact"]["normal"], -0.1035195, 1e-5, 7)
    comparison.add("contact force, tangential", certificate["contact"]["tangential"], -0.0398077, 1e-5, 6)
    comparison.add("largest displacement", certificate["max_displacement"], 0.118643, 1e-3, 6)
    comparison.add("stick to slip at x", transition(points, [STICK], [SLIP]), 0.6562, 2e-3, 4)
    comparison.add("closed to open at x", transition(points, [STICK, SLIP], [OPEN]), 1.6021, 2e-3, 5)
    return comparison.table(), comparison.problems
