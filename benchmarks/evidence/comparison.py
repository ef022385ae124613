"""A number that the program predicts, compared with a measured, printed or exact one, and its
source.
"""

from __future__ import annotations

import csv
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

from benchmarks import ROOT

STUDIES = ROOT / "studies" / "evidence"
Fault = Literal["", "print", "model"]
FAULTS: dict[str, Fault] = {"": "", "print": "print", "model": "model"}
# In the order of the page.
KINDS = {
    "limit": "Metal that broke: limit load at yield",
    "ultimate": "Metal that broke: ultimate load",
    "worked": "Worked examples in print",
    "other": "Worked examples by a method that we do not have",
    "elements": "Published finite elements",
    "exact": "Exact solutions",
}
ROUNDING = 0.5001  # of the last printed digit
TOLERANCE = 2e-3  # beyond rounding: publications round intermediate results and large numbers


@dataclass(frozen=True)
class Printed:
    """A printed number, and where a run has the corresponding one: a row of printed.csv.

    source: its name in sources.toml.
    study: in studies/evidence, with " in contact" if the joint is solved; empty for a public
    function.
    check, at: of the margin.
    read: the quantity of the margin that is compared, multiplied by `times`.
    text: the number as printed.
    fault: whether a difference is an error in print, or of the program's model.
    remark: the reason of a difference.
    resolution: of the prediction, as by the size of cells.
    """

    source: str
    study: str
    quantity: str
    check: str
    at: str
    read: str
    times: float
    text: str
    unit: str
    fault: Fault = ""
    remark: str = ""
    resolution: float = 0.0

    @property
    def value(self) -> float:
        """The number."""
        return float(self.text)

    @property
    def rounding(self) -> float:
        """Half a unit of the last printed decimal."""
        return ROUNDING * 10.0 ** -len(self.text.partition(".")[2])


@dataclass(frozen=True)
class Comparison:
    """A prediction compared with a number. kind: of KINDS."""

    kind: str
    printed: Printed
    predicted: float

    @property
    def ratio(self) -> float:
        """Predicted over measured or printed."""
        return self.predicted / self.printed.value

    @property
    def agrees(self) -> bool:
        """Whether the prediction equals the number within the printed digits."""
        off = abs(self.predicted - self.printed.value)
        near = self.printed.rounding + self.printed.resolution
        return off <= near + TOLERANCE * abs(self.printed.value)


@dataclass(frozen=True)
class Source:
    """The origin of numbers.

    kind: of KINDS (of tests, the first). title, cited: the source.
    limits: what agreement with the source does not establish.
    errors: errors in print.
    function: the function that was called where there is no study.
    """

    kind: str
    title: str
    cited: str
    limits: str
    errors: str = ""
    function: str = ""


@cache
def sources() -> dict[str, Source]:
    """Return all sources by name, in the order of the page."""
    text = (Path(__file__).parent / "sources.toml").read_text(encoding="utf-8")
    return {name: Source(**table) for name, table in tomllib.loads(text).items()}


def records(name: str) -> list[dict[str, str]]:
    """Return the rows of a table in studies/evidence."""
    with (STUDIES / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def printed_numbers() -> list[Printed]:
    """Return the rows of printed.csv."""
    return [
        Printed(
            row["source"], row["study"], row["quantity"], row["check"], row["at"], row["read"],
            float(row["times"]), row["printed"], row["unit"], FAULTS[row["fault"]], row["remark"],
        )
        for row in records("printed.csv")
    ]  # fmt: skip
