"""The results of runs, verifications and studies."""

import json
import webbrowser
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribound.level import Level

if TYPE_CHECKING:
    from tribound.run import Place


@dataclass
class Step:
    """A step of Newton's method."""

    number: int
    residual: float
    relative: float | None  #: the bound after it over the norm of the stress, where it was computed
    seconds: float


@dataclass
class Quantity:
    """A number of the case with its guaranteed interval; `lower` and `upper` are None where there is none."""

    name: str
    value: float | None
    lower: float | None
    upper: float | None
    record: Mapping[str, Any]  #: as in certificate.json


class Result:
    """A run: its status, its certificate, its levels and its files."""

    def __init__(self, place: "Place", levels: list[Level]) -> None:
        self._place = place  # a temporary directory goes with it
        self.levels = levels  #: all with keep_levels, else the last
        for level in levels:
            level.units = self.certificate["units"]

    @property
    def directory(self) -> Path:
        """The files of the run, see docs/output.md."""
        return self._place.path

    @property
    def level(self) -> Level:
        """The last level, or load step."""
        if not self.levels:
            raise ValueError(f"the run has no level with a bound: {self.status}, {self.reason}")
        return self.levels[-1]

    @cached_property
    def certificate(self) -> dict[str, Any]:
        """certificate.json."""
        return json.loads((self.directory / "certificate.json").read_text())  # type: ignore[no-any-return]

    @property
    def status(self) -> str:
        """certified, budget (the bound holds, but is above the tolerance), not certified or failed."""
        return str(self.certificate["status"])

    @property
    def is_certified(self) -> bool:
        """Whether the bound is below the tolerance and all identities hold."""
        return self.status == "certified"

    @property
    def reason(self) -> str:
        """Why the run is not certified."""
        return str(self.certificate.get("reason") or "")

    @property
    def relative(self) -> float | None:
        """The bound over the norm of the stress."""
        return self.certificate["relative"]  # type: ignore[no-any-return]

    @property
    def bound(self) -> float | None:
        """The guaranteed bound of the residual."""
        return self.certificate["bound"]  # type: ignore[no-any-return]

    @property
    def components(self) -> dict[str, float]:
        """The components of the bound."""
        return self.certificate["components"]  # type: ignore[no-any-return]

    @property
    def warnings(self) -> list[Any]:
        """What is doubtful about the last level."""
        return self.certificate.get("warnings") or []

    @cached_property
    def quantities(self) -> dict[str, Quantity]:
        """The numbers that the case asks for, with their intervals."""
        return {
            found["name"]: Quantity(found["name"], found.get("value"), found.get("lower"), found.get("upper"), found)
            for found in self.certificate.get("quantities") or []
        }

    def to_dict(self) -> dict[str, Any]:
        """The certificate."""
        return self.certificate

    def table(self, name: str) -> Any:
        """A table of the run: convergence, newton, history, contact, quantities, probes or sections."""
        from tribound import tables

        return tables.table(self, name)

    def plot_convergence(self, **options: Any) -> Any:
        """The bound over the degrees of freedom."""
        from tribound import plots

        return plots.plot_convergence(self, **options)

    def report(self) -> Path:
        """Opens the page of the run in the browser, and returns its file."""
        page = self.directory / "report.html"
        if not page.exists():
            raise FileNotFoundError(f"{page}: Tribound was built without the page, or output.report is false")
        webbrowser.open(page.as_uri())
        return page

    def __repr__(self) -> str:
        from tribound import card

        return card.text(self)

    def _repr_html_(self) -> str:
        from tribound import card

        return card.html(self)


class Verification(dict[str, Any]):
    """verify.json, with its effectivity."""

    @property
    def effectivity(self) -> float | None:
        """The bound over the error that it bounds, for the last iterate: at least 1."""
        return self["effectivity"]  # type: ignore[no-any-return]


class Study(dict[str, Any]):
    """study.json, with the directory of its tables and figures."""

    def __init__(self, place: "Place", content: Mapping[str, Any]) -> None:
        super().__init__(content)
        self._place = place

    @property
    def directory(self) -> Path:
        """The files of the study."""
        return self._place.path
