"""A number that the program predicts beside a measured, printed or exact one, and its source."""

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
ROUNDING = 0.5001  # of the last digit that is printed
TOLERANCE = 2e-3  # of agreement beyond that: prints round in between, and end numbers with zeros


@dataclass(frozen=True)
class Printed:
    """A number in print, and where a run has its own: a row of printed.csv.

    source: its name in sources.toml. study: in studies/evidence, with " in contact" where the joint
    is solved; empty for a public function. check, at: of the margin; read: what of it is compared,
    multiplied by `times`. text: the number as printed. fault: whether a difference is an error in
    print, or one of the program's models. remark: why. resolution: of the prediction, as of cells.
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
        """Half of the last decimal that is printed."""
        return ROUNDING * 10.0 ** -len(self.text.partition(".")[2])


@dataclass(frozen=True)
class Comparison:
    """A prediction beside a number. kind: of KINDS."""

    kind: str
    printed: Printed
    predicted: float

    @property
    def ratio(self) -> float:
        """Predicted over measured or printed."""
        return self.predicted / self.printed.value

    @property
    def agrees(self) -> bool:
        """Whether the prediction is the number to the digits in print."""
        off = abs(self.predicted - self.printed.value)
        near = self.printed.rounding + self.printed.resolution
        return off <= near + TOLERANCE * abs(self.printed.value)


@dataclass(frozen=True)
class Source:
    """Where numbers are from: kind of KINDS (of tests, the first), what it is, errors in print, and
    what agreement with it does not establish. function: what was called where no study has it.
    """

    kind: str
    title: str
    cited: str
    limits: str
    errors: str = ""
    function: str = ""


@cache
def sources() -> dict[str, Source]:
    """All sources by name, in the order of the page."""
    text = (Path(__file__).parent / "sources.toml").read_text(encoding="utf-8")
    return {name: Source(**table) for name, table in tomllib.loads(text).items()}


def records(name: str) -> list[dict[str, str]]:
    """The rows of a table in studies/evidence."""
    with (STUDIES / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def printed_numbers() -> list[Printed]:
    """The rows of printed.csv."""
    return [
        Printed(
            row["source"], row["study"], row["quantity"], row["check"], row["at"], row["read"],
            float(row["times"]), row["printed"], row["unit"], FAULTS[row["fault"]], row["remark"],
        )
        for row in records("printed.csv")
    ]  # fmt: skip
