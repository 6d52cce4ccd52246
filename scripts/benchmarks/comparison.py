"""What the benchmarks of scripts/validation share: comparisons, and what is read from the contact boundary."""

import math

from tables import table

OPEN, STICK, SLIP = "0", "1", "2"


class Comparison:
    """Rows of a table: quantity, program, reference, deviation; and what is outside its tolerance."""

    def __init__(self, name):
        self.name, self.rows, self.problems = name, [], []

    def add(self, quantity, value, reference, tolerance, digits=8, relative_to=None):
        deviation = (value - reference) / abs(relative_to or reference)
        self.rows.append([quantity, f"{value:.{digits}g}", f"{reference:.{digits}g}", percent(deviation), f"{100 * tolerance:g} %"])
        if not abs(deviation) <= tolerance:
            self.problems.append(f"{self.name}: {quantity} is {value:g}, the reference is {reference:g}: {percent(deviation)}")

    def table(self):
        return table(["quantity|", "Tribound", "reference", "deviation", "tolerance"], self.rows)


def percent(deviation):
    """A deviation to one digit: what differs in the last digits is not worth a change of the page."""
    return "below 1e-8" if abs(deviation) < 1e-8 else f"{100 * deviation:+.1g} %"


def contact_points(result):
    """Points of the contact boundary along x: (x, row)."""
    return sorted(((float(row["x"]), row) for row in result.contact), key=lambda point: point[0])


def transition(points, before, after):
    """The x between the last point of one status and the next one of the other."""
    for (x, row), (x_next, row_next) in zip(points, points[1:]):
        if row["status"] in before and row_next["status"] in after:
            return (x + x_next) / 2
    return math.nan


def interpolate(points, column, x):
    """Linear between the points next to x; beyond the ends, extrapolated."""
    after = next((i for i, (position, _) in enumerate(points) if position >= x), len(points) - 1)
    (x0, row0), (x1, row1) = points[max(after, 1) - 1 : max(after, 1) + 1]
    y0, y1 = float(row0[column]), float(row1[column])
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


def hertz_fit(samples, r_max):
    """a, p0 of p^2 = p0^2 (1 - (r/a)^2), least squares over r < r_max."""
    pairs = [(r * r, p * p) for r, p in samples if r < r_max]
    n, x, y = len(pairs), sum(a for a, _ in pairs), sum(b for _, b in pairs)
    xx, xy = sum(a * a for a, _ in pairs), sum(a * b for a, b in pairs)
    slope = (n * xy - x * y) / (n * xx - x * x)
    p0_squared = (y - slope * x) / n
    return math.sqrt(-p0_squared / slope), math.sqrt(p0_squared)


def add_profile(comparison, samples, a, p0, tolerance):
    """Means of the pressure over parts of the closed boundary against those of sqrt(1 - (r/a)^2); samples: (r, p, weight)."""
    for tenth in (0, 3, 6, 8):
        part = [(r / a, p / p0, weight) for r, p, weight in samples if tenth <= 10 * r / a < tenth + 1]
        area = sum(weight for _, _, weight in part)
        mean, theory = (sum(weight * value for value, weight in values) / area for values in
                        ([(p, weight) for _, p, weight in part], [(math.sqrt(1 - r * r), weight) for r, _, weight in part]))
        comparison.add(f"p / p0, mean over {tenth / 10} a to {(tenth + 1) / 10} a", mean, theory, tolerance, 4, relative_to=1)
