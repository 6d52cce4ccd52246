"""What the judge collects."""

from dataclasses import dataclass, field


@dataclass
class Verdict:
    findings: list = field(default_factory=list)
    effectivities: list = field(default_factory=list)
    n_bounds: int = 0

    def check(self, holds, text, kind="INCONSISTENT"):
        if not holds:
            self.findings.append(f"{kind}: {text}")


def near(a, b, relative=1e-9, absolute=0.0):
    if a is None or b is None:
        return a is b
    return abs(a - b) <= relative * max(abs(a), abs(b)) + absolute
