"""Judges moments: of contact, by contact.csv and the balance; of loads, by the case; and their balance."""

import numpy as np

from judge_contact import representation_errors
from residual import Residual
from simplices import lattice

LEFT_OF_NEWTON = ["lin2n", "lin2t", "reg2n", "reg2t"]
ROUNDING = 1e-8  # relative to forces times arms
DATA = 1e-5  # the same, where formulas are integrated with other rules
FINER = 2  # fineness of the rules for loads that are far off
SOLVER = 1e-6  # the same, for the remainder of linear solvers


def cross(arms, forces):
    """arm x force, row by row; in 2D its only component, positive from x to y."""
    if arms.shape[1] == 3:
        return np.cross(arms, forces)
    return (arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0])[:, None]


def about_origin(row, about):
    """The moment of a row of the balance, taken about the origin; the balance uses another point."""
    return np.array(row["moment"]) + cross(np.array([about]), np.array([row["force"]]))[0]


def resultant(points, forces):
    """Force, moment about the origin, and the sum of |x| |f|, to which rounding is proportional."""
    arms = np.linalg.norm(points, axis=1)
    return forces.sum(axis=0), cross(points, forces).sum(axis=0), arms @ np.linalg.norm(forces, axis=1)


def resultant_of_rows(rows):
    """The resultant of T on a boundary from its rows of contact.csv."""
    axes = [key[-1] for key in rows[0] if key.startswith("traction_")]
    column = lambda prefix: np.array([[float(row[prefix + a]) for a in axes] for row in rows])
    weights = np.array([float(row["weight"]) for row in rows])
    return resultant(column(""), weights[:, None] * column("traction_"))


def judge_moments(verdict, residual, results):
    """The moments of the last level."""
    certificate = results.certificate
    balance, contact = certificate["balance"], certificate["contact"]
    if contact is not None:
        judge_contact_moments(verdict, residual, results)
    if balance is not None:
        judge_balance(verdict, residual, balance, certificate["sigma_norm"])


def judge_contact_moments(verdict, residual, results):
    """On each boundary with contact: contact.csv gives the moment of the certificate and, up to the remainder of Newton's
    method, that of the equilibrated stress."""
    contact, balance = results.certificate["contact"], results.certificate["balance"]
    of_stress = {row["name"]: row for row in balance["rows"] if row["kind"] == "contact"} if balance else {}
    total = resolution = 0
    for name in residual.contact:
        _, found, scale = resultant_of_rows([row for row in results.contact if row["boundary"] == name])
        entry = np.array(contact["boundaries"][name]["moment"])
        rounding, left = allowed_moments(residual, name, results.certificate, scale)
        if balance:  # without a row nothing acts there
            known = about_origin(of_stress[name], balance["about"]) if name in of_stress else 0 * entry
            distance = np.linalg.norm(found - known)
            verdict.check(distance <= left, f"contact {name}: moment {found}, of the equilibrated stress {known}")
            left = distance + rounding  # the certificate gives the digits that this leaves
        close = np.abs(entry - found).max() <= left
        verdict.check(close, f"contact {name}: moment {entry}, found {found}")
        total, resolution = total + entry, resolution + 2 * left
    verdict.check(np.abs(total - contact["moment"]).max() <= resolution, "contact: the moments do not add up")


def allowed_moments(residual, name, certificate, scale):
    """How much moments may differ: by summation and by polynomials in place of gap and threshold; and, in addition, by
    t^k - T(u), since |x| <= R and the components sum up ||t^k - T(u)||_F h_F^(1/2)."""
    facets, level = residual.boundary[name], residual.level
    radius = np.linalg.norm(level.vertices[level.cells[facets.cells]], axis=2).max()
    stress = certificate["sigma_norm"] / np.sqrt(level.volumes.sum())
    data = sum(representation_errors(residual, name)[1:])
    rounding = ROUNDING * scale + (ROUNDING * stress + data) * facets.measures.sum() * radius
    norms = sum(certificate["components"].get(key) or 0 for key in LEFT_OF_NEWTON)
    return rounding, rounding + radius * np.sqrt((facets.measures / facets.sizes).sum()) * norms


def judge_balance(verdict, residual, balance, sigma_norm):
    """The loads and forces of springs are those of the case; all rows add up to nothing."""
    rows = {(row["name"], row["source"] in ("body force", "spring") and row["source"]): row for row in balance["rows"]
            if row["kind"] in ("load", "spring")}
    about = np.array(balance["about"])
    wrong = differences(residual, about, rows)
    if any(difference > DATA * scale for difference, scale, _ in wrong.values()):
        finer = Residual(residual.level, residual.case, residual.region_names, FINER)
        coarse, wrong = wrong, differences(finer, about, rows)
        for load, (difference, scale, text) in wrong.items():
            allowed = DATA * scale + 2 * np.abs(coarse[load][0] - difference)
            verdict.check(difference <= allowed, text)
    level = residual.level
    stress = sigma_norm / np.sqrt(level.volumes.sum()) + 1e-5 * residual.materials.max() * np.abs(level.nodal).max() / level.size
    rounding = ROUNDING * stress * level.size ** (level.dimension - 1)
    parts = [row for row in balance["rows"] if row["kind"] != "sum"]
    force = np.sum([row["force"] for row in parts], axis=0)
    size = sum(np.linalg.norm(row["force"]) for row in parts)
    verdict.check(np.all(np.abs(force) <= SOLVER * size + rounding), f"balance: forces add up to {force}")
    moment = np.sum([row["moment"] for row in parts], axis=0)
    scale = sum(np.linalg.norm(row["moment"]) for row in parts) + size * level.size
    verdict.check(np.all(np.abs(moment) <= SOLVER * scale + rounding * level.size), f"balance: moments add up to {moment}")


def differences(residual, about, rows):
    """Of force and moment of each load and of its row: the largest difference, the scale of rounding, and both in words."""
    result, least = {}, 1e-8 * sum(np.linalg.norm(row["force"]) for row in rows.values())
    for load, (points, forces) in loads(residual).items():
        force, moment, scale = resultant(points - about, forces)
        size = max(least, np.linalg.norm(forces, axis=1).sum())
        scale = max(least * residual.level.size, scale)
        row = rows.get(load) or {"force": 0 * force, "moment": 0 * moment}  # without a row nothing acts there
        for key, found, allowed in (("force", force, size), ("moment", moment, scale)):
            text = f"load {load[0]}: {key} {row[key]}, found {found}"
            result[*load, key] = (np.abs(row[key] - found).max(), allowed, text)
    return result


def loads(residual):
    """Points and forces of body forces and, in the free components, of boundaries; by name and source, if no traction."""
    level, result = residual.level, {}
    d = level.dimension
    at = np.einsum("av,cvi->cai", lattice(d + 1, 1), level.vertices[level.cells])  # of linear functions, whose
    of_cells = residual.body_load(1)  # forces at the vertices have the same moments
    for number, name in enumerate(residual.region_names):
        cells = level.regions == number
        result[name, "body force"] = (at[cells].reshape(-1, d), of_cells[cells].reshape(-1, d))
    for name, facets in residual.boundary.items():
        if len(facets) == 0 or name in residual.contact:
            continue
        owners, points, weights, traction = residual.boundary_load(name)
        free = np.array([datum is None for datum in residual.conditions[name].displacement])
        result[name, False] = (level.places(facets.cells[owners], points), weights[:, None] * traction * free)
    for name in residual.springs:
        spring = residual.conditions[name].spring
        if not all(f.is_constant for f in [spring["normal"], spring["tangential"], *spring["rest"]]):
            continue  # the rules of the program may miss a part
        owners, points, weights, traction = residual.spring_load(name)
        places = level.places(residual.boundary[name].cells[owners], points)
        result[name, "spring"] = (places, weights[:, None] * traction)
    return result
