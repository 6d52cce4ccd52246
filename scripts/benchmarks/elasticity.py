"""Benchmarks with other solutions of the theory of elasticity."""

import math

import numpy as np

from .comparison import OPEN, STICK, Comparison


def thick_cylinder(program):
    """Lame: u_r = A r + B / r."""
    probe = program.run("examples/28_thick_cylinder/case.toml").certificate["probes"][0]["points"][0]
    E, nu, p, a, b = 200e3, 0.3, 100, 50, 100
    A = (1 + nu) * (1 - 2 * nu) / E * p * a**2 / (b**2 - a**2)
    B = (1 + nu) / E * p * a**2 * b**2 / (b**2 - a**2)
    comparison = Comparison("thick_cylinder")
    comparison.add("u_r at the bore, mm", probe["displacement"][0], A * a + B / a, 5e-4, 6)
    comparison.add("stress around the axis at the bore, MPa", probe["stress"][2], p * (b**2 + a**2) / (b**2 - a**2), 0.01, 5)
    return comparison.table(), comparison.problems


def press_fit(program):
    """Two rings whose radii differ, by half of the interference of the diameters."""
    inner, middle, outer, interference, E = 40, 50, 70, 0.05, 210e3
    squares = (middle**2 - inner**2) * (outer**2 - middle**2)
    pressure = E * interference * squares / (2 * middle**3 * (outer**2 - inner**2))
    certificate = program.run("examples/08_press_fit/case.toml").certificate
    contact = certificate["contact"]["boundaries"]["shaft.outside"]
    comparison = Comparison("press_fit")
    comparison.add("pressure, MPa", -contact["normal"] / contact["covered"], pressure, 2e-3, 5)
    comparison.add("force in x, N/mm", -contact["force"][0], pressure * middle, 2e-3, 5)
    comparison.add("force in y, N/mm", -contact["force"][1], pressure * middle, 2e-3, 5)
    return comparison.table(), comparison.problems


def flat_punch(program):
    """The half-space; for the pressure the computed force."""
    result = program.run("examples/30_flat_punch/case.toml")
    force, a = abs(result.certificate["contact"]["normal"]), 5
    rows = [(float(row["x"]), float(row["pressure"]), float(row["weight"])) for row in result.contact]
    comparison = Comparison("flat_punch")
    comparison.add("force, N", force, 2 * 200000 / (1 - 0.3**2) * a * 0.01, 0.06, 5)
    for inner, outer in ((0, 0.5), (0.5, 0.8), (0.8, 0.95)):
        part = sum(2 * math.pi * p * weight for r, p, weight in rows if inner * a <= r < outer * a)
        area = sum(2 * math.pi * weight for r, _, weight in rows if inner * a <= r < outer * a)
        theory = sum(weight * force / (a * math.sqrt(a**2 - r**2)) for r, _, weight in rows if inner * a <= r < outer * a)
        comparison.add(f"mean pressure for {inner:g} < r / a < {outer:g}, MPa", part / area, theory / area, 0.02, 4)
    return comparison.table(), comparison.problems


def strip_punch(program):
    """The half-plane, for the computed force: p = P / (pi (a^2 - x^2)^(1/2))."""
    result = program.run("tests/cases/strip_punch.toml")
    force = 2 * abs(result.certificate["contact"]["normal"])  # half of it is computed
    rows = [(float(row["x"]), float(row["pressure"]), float(row["weight"])) for row in result.contact]
    comparison = Comparison("strip_punch")
    for inner, outer in ((0, 0.5), (0.5, 0.8), (0.8, 0.95)):
        part = [(x, p, weight) for x, p, weight in rows if inner <= x < outer]
        area = sum(weight for *_, weight in part)
        comparison.add(f"a p / P, mean for {inner:g} < x / a < {outer:g}", sum(p * weight for _, p, weight in part) / area / force,
                       sum(weight / (math.pi * math.sqrt(1 - x * x)) for x, _, weight in part) / area, 0.01, 5)
    return comparison.table(), comparison.problems


def partial_slip(program):
    """Cattaneo and Mindlin, for the computed forces."""
    result = program.run("tests/cases/partial_slip.toml")
    mu, R, modulus = 0.3, 50, 70e3 / (1 - 0.3**2) / 2
    shear, load = (abs(component) for component in result.certificate["contact"]["force"])
    a = math.sqrt(4 * load * R / (math.pi * modulus))
    share = math.sqrt(1 - shear / (mu * load))  # of the stick zone
    p0 = 2 * load / (math.pi * a)
    closed = [(abs(float(row["x"])) / a, float(row["weight"]), abs(float(row["traction_x"])) / (mu * p0), row["status"])
              for row in result.contact if row["status"] != OPEN]
    comparison = Comparison("partial_slip")
    comparison.add("half width a, mm", sum(weight for _, weight, *_ in closed) / 2, a, 0.01, 4)
    comparison.add("stick, c / a", sum(weight for _, weight, _, status in closed if status == STICK) / (2 * a), share, 0.02, 4)

    def theory(r):
        inner = share * math.sqrt(1 - (r / share) ** 2) if r < share else 0
        return math.sqrt(max(0, 1 - r * r)) - inner

    for inner, outer in ((0, 0.3), (0.3, 0.5), (0.7, 0.9)):
        part = [(r, weight, q) for r, weight, q, _ in closed if inner <= r < outer]
        area = sum(weight for _, weight, _ in part)
        comparison.add(f"q / (mu p0), mean for x / a or -x / a in {inner:g} to {outer:g}", sum(weight * q for _, weight, q in part) / area,
                       sum(weight * theory(r) for r, weight, _ in part) / area, 0.01, 4, relative_to=1)
    return comparison.table(), comparison.problems


def receding_layer(program):
    """A layer that lifts off: half width and pressure against the singular integral equation."""
    b, pressure = receding_contact(0.5)
    result = program.run("tests/cases/receding_layer.toml")
    samples = [(float(row["x"]), float(row["pressure"]), float(row["weight"])) for row in result.contact]
    load = 2 * sum(p * weight for _, p, weight in samples)  # half of it is computed
    comparison = Comparison("receding_layer")
    comparison.add("load on the whole width", load, 1e-3, 1e-6)
    comparison.add("half width b, length of the closed part", sum(weight for _, p, weight in samples if p > 0), b, 5e-3, 5)
    for inner, outer in ((0, 0.3), (0.3, 0.6), (0.6, 0.9)):
        part = [(x, p, weight) for x, p, weight in samples if inner <= x / b < outer]
        area = sum(weight for *_, weight in part)
        comparison.add(f"mean pressure over load for {inner:g} < x / b < {outer:g}", sum(p * weight for _, p, weight in part) / area / load,
                       sum(pressure(x) * weight for x, _, weight in part) / area, 5e-3, 5)
    return comparison.table(), comparison.problems


def receding_contact(c, n=40):
    """The layer of height 1, loaded by 1 over |x| < c, on a half-plane of the same material: b, and the pressure as a function of x.

    With P(k), Q(k) the cosine transforms of pressure and load, the slopes of layer and half-plane agree for |x| < b if
    int (((S + A)/2 + 1) P - (A - S)/2 Q) sin(k x) dk = 0, where S and A belong to loads that are symmetric and antisymmetric to the
    middle of the layer. The 2 in (S + A)/2 + 1 = 2 + ((S + A)/2 - 1) is Cauchy's kernel; the rest decays like exp(-k). Gauss-Chebyshev rules (Erdogan) make
    it a homogeneous linear system, which is singular for the right b.
    """
    k, dk = np.polynomial.legendre.leggauss(600)
    k, dk = 30 * (k + 1), 30 * dk
    S, A = 2 * np.sinh(k / 2) ** 2 / (np.sinh(k) + k), 2 * np.cosh(k / 2) ** 2 / (np.sinh(k) - k)
    t = np.cos(np.arange(1, 2 * n + 1) * np.pi / (2 * n + 1))
    s = np.cos((2 * np.arange(1, n + 1) - 1) * np.pi / (2 * (2 * n + 1)))
    weights = np.pi / (2 * n + 1) * (1 - t**2)  # of sqrt(1 - t^2) in (-1, 1)

    def matrix(b):
        sines, cosines = np.sin(np.outer(s * b, k)), np.cos(np.outer(k, t * b))
        rest = b * (sines * (dk * ((S + A) / 2 - 1))) @ cosines - b * (sines @ (dk * (A - S) / 2 * np.sin(k * c) / (k * c)))[:, None]
        full = weights * (rest - 2 / (t[None, :] - s[:, None]))
        return full[:, :n] + full[:, : n - 1 : -1]  # the pressure is even

    def sign(b):
        return np.linalg.slogdet(matrix(b))[0]

    low, high = c + 0.5, c + 2
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (middle, high) if sign(middle) == sign(low) else (low, middle)
    phi = np.linalg.svd(matrix(low))[2][-1]
    phi /= 2 * low * (weights[:n] @ phi)
    even = np.polynomial.Polynomial.fit(t[:n] ** 2, phi, 12, domain=[0, 1])
    return low, lambda x: even((x / low) ** 2) * math.sqrt(max(0, 1 - (x / low) ** 2))
