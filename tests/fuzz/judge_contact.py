"""Judges contact.csv and the resultants of the last level."""

import numpy as np

from residual import dot
from simplices import bernstein, lattice
from verdict import near

SHARE = 10.0  # deviation allowed in contact.csv, as a multiple of the distance of gap and threshold from polynomials
SAMPLES = {2: 512, 3: 160}  # per edge of a facet; narrow strips must be seen


def judge_contact(verdict, residual, results):
    """contact.csv and the resultants against u of the last level."""
    entry = results.certificate["contact"]
    if not residual.contact:
        verdict.check(entry is None, "contact in the certificate, none in the case")
        return
    for name in residual.contact:
        own = entry["boundaries"][name]
        rows = [row for row in results.contact if row["boundary"] == name]
        judge_points(verdict, residual, name, rows)
        error = sum(representation_errors(residual, name)[1:])
        judge_resultants(verdict, residual, name, rows, own, error)
    total = np.sum([b["force"] for b in entry["boundaries"].values()], axis=0)
    size = sum(abs(b["normal"]) + b["abs_tangential"] for b in entry["boundaries"].values())
    known = entry["resolution"] + sum(b["resolution"] for b in entry["boundaries"].values())
    verdict.check(np.allclose(total, entry["force"], 1e-9, 1e-9 * size + known), "contact: the forces do not add up")


def judge_points(verdict, residual, name, rows):
    """Every row of contact.csv on the boundary."""
    level, facets = residual.level, residual.boundary[name]
    d = level.dimension
    axes = "xyz"[:d]
    column = lambda keys: np.array([[row[key] for key in keys] for row in rows])
    places, normals = column(axes), column(["n" + a for a in axes])
    from_first = places[:, None, :] - level.vertices[level.cells[facets.cells, 0]]
    points = np.einsum("pfj,fvj->pfv", from_first, level.gradients[facets.cells])
    points[:, :, 0] += 1
    outside = np.maximum(-points.min(axis=2), np.abs(points[:, np.arange(len(facets)), facets.opposite]))
    owners = outside.argmin(axis=1)
    rowwise = np.arange(len(rows))
    verdict.check(outside[rowwise, owners].max() < 1e-8, f"contact.csv: a point is not on {name}")
    verdict.check(len(np.unique(owners)) == len(facets), f"contact.csv: a facet of {name} has no rows")
    verdict.check(np.abs(normals - facets.normals[owners]).max() < 1e-8, "contact.csv: a normal")
    on_facet = points[rowwise, owners]
    on_facet[rowwise, facets.opposite[owners]] = 0  # a formula may switch at the plane of the facet
    state = residual.contact_state(name, owners, on_facet)
    gamma = residual.penalties(name)[owners]
    # Where nothing happens, u is pure rounding.
    length = np.abs(level.nodal).max() + np.abs(state["gap"]).max() + 1e-13 * level.size
    stress = residual.materials.max() * length / facets.sizes.min() + (gamma * length).max()
    gap_error, error, limit_error = representation_errors(residual, name)
    for key, keys, allowed in (
        ("pressure", ["pressure"], 1e-9 * stress + error),
        ("limit", ["limit"], 1e-9 * stress + limit_error),
        ("traction", ["traction_" + a for a in axes], 1e-9 * stress + error + limit_error),
        ("gap", ["gap"], 1e-9 * length + gap_error),
        ("slip", ["slip_" + a for a in axes], 1e-9 * length),
    ):
        difference = np.abs(column(keys) - state[key].reshape(len(rows), -1)).max()
        verdict.check(difference <= allowed, f"contact.csv: {key} of {name} differs by {difference:.3g}, allowed {allowed:.3g}")
    status = column(["status"]).ravel()
    clear = 1e-9 * stress + error
    verdict.check((status[state["normal"] > clear] != 1).all(), "contact.csv: sticks where it is open")
    verdict.check((status[state["normal"] < -clear] != 0).all(), "contact.csv: open under pressure")


def representation_errors(residual, name):
    """How much polynomials in place of gap, threshold and initial stress may change the gap, the pressure and the limit."""
    contact = residual.conditions[name].contact
    gap_error = SHARE * distance_from_polynomials(residual, name, contact["gap"])
    error = residual.penalties(name).max() * gap_error + SHARE * stress_distance(residual, name)
    error *= 1 + contact["coefficient"]
    return gap_error, error, error + SHARE * distance_from_polynomials(residual, name, contact["threshold"])


def stress_distance(residual, name):
    """The same of sigma_0 from P^p."""
    distance = 0.0
    for sigma_0 in residual.initial:
        distance += sum(distance_from_polynomials(residual, name, f, 0) for f in sigma_0.entries.values())
        heated = (sigma_0.temperature, sigma_0.reference)
        distance += sigma_0.beta * sum(distance_from_polynomials(residual, name, f, 0) for f in heated)
    return distance


def distance_from_polynomials(residual, name, formula, more=1):
    """The largest distance of a formula from P^(p+more) on a facet; the program may replace it by such a polynomial."""
    if formula.is_constant:
        return 0.0
    level, facets = residual.level, residual.boundary[name]
    d, p = level.dimension, level.degree
    points = lattice(d, SAMPLES[d]) / SAMPLES[d]
    owners = np.repeat(np.arange(len(facets)), len(points))
    places = level.places(facets.cells[owners], facets.in_cell(owners, np.tile(points, (len(facets), 1))))
    values = formula(places).reshape(len(facets), -1).T
    table = bernstein(points, p + more)
    return float(np.abs(values - table @ np.linalg.lstsq(table, values, rcond=None)[0]).max())


def judge_resultants(verdict, residual, name, rows, entry, error):
    """The resultants of the certificate as sums over the rows of contact.csv; on a meridian its weights are of one radian."""
    level, facets = residual.level, residual.boundary[name]
    weights = np.array([row["weight"] for row in rows])
    everywhere = np.arange(len(facets))
    middle = facets.in_cell(everywhere, np.full((len(facets), level.dimension), 1 / level.dimension))
    expected = (facets.measures * level.weight(facets.cells, middle)).sum()
    axes = [key[-1] for key in rows[0] if key.startswith("traction_")]
    traction = np.array([[row["traction_" + a] for a in axes] for row in rows])
    normals = np.array([[row["n" + a] for a in axes] for row in rows])
    along = dot(traction, normals)
    tangential = traction - along[:, None] * normals
    area = weights.sum()
    verdict.check(near(area, expected, 1e-8), f"contact.csv: the weights of {name} add up to {area}")
    weights = residual.case.full_circle * weights
    tolerance = weights @ (1e-8 * np.linalg.norm(traction, axis=1) + error) + entry["resolution"]
    found = {
        "normal": weights @ along,
        "abs_tangential": weights @ np.linalg.norm(tangential, axis=1),
        "tangential": weights @ (tangential[:, 1] * normals[:, 0] - tangential[:, 0] * normals[:, 1])
        if len(axes) == 2
        else np.linalg.norm(weights @ tangential),
    }
    for key, x in found.items():
        verdict.check(near(x, entry[key], 0, tolerance), f"contact {name}: {key} {entry[key]}, found {x}")
    force = weights @ traction
    if level.is_axisymmetric:
        force[0] = 0  # around the axis
    verdict.check(np.abs(force - entry["force"]).max() <= tolerance, f"contact {name}: force {entry['force']}")
