"""Standard diameters: steps, the preferred numbers of ISO 3, and lists."""

from __future__ import annotations

import math
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinstress.analysis.remedies.secant import NoSizeError
from pinstress.explore.size.standard_diameters import (
    PREFERRED_NUMBERS,
    StandardDiameters,
    standard_diameters,
)
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import parse_study
from pinstress.study.schema.size import SizeTable
from pinstress.study.schema.units import UNIT_SYSTEMS
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.pins.studies import resized_text

INCH = 0.0254
# ISO 3 rounds no theoretical value by more than this
LARGEST_ROUNDING = 0.0126


@each("name", list(PREFERRED_NUMBERS))
def test_a_series_is_that_of_iso_3(name: str) -> None:
    """Each number is its power of ten, rounded by at most 1.26 %, as the standard says; and a
    coarser series is every second number of the next.
    """
    numbers, count = PREFERRED_NUMBERS[name], int(name[1:])
    assert len(numbers) == count
    for k, number in enumerate(numbers):
        assert abs(math.log(number / 10.0 ** (k / count))) <= LARGEST_ROUNDING
    finer = PREFERRED_NUMBERS.get(f"R{2 * count}")
    if finer is not None:
        assert finer[::2] == numbers


def test_the_next_diameters_by_hand() -> None:
    """5.61 in and 56.1 mm lie between 5.6 and 6.3 of R20; 9.2 is followed by 10."""
    series = StandardDiameters(preferred=PREFERRED_NUMBERS["R20"])
    assert series.up(5.61 * INCH, INCH) == pytest.approx(6.3 * INCH)
    assert series.down(5.61 * INCH, INCH) == pytest.approx(5.6 * INCH)
    assert series.up(0.0561, 1e-3) == pytest.approx(0.063)
    assert series.up(9.2 * INCH, INCH) == pytest.approx(10.0 * INCH)
    assert series.up(5.6 * INCH, INCH) == pytest.approx(5.6 * INCH)
    listed = StandardDiameters(listed=(0.02, 0.025))
    assert listed.up(0.021, 1e-3) == 0.025
    assert listed.down(0.019, 1e-3) == 0.0
    with pytest.raises(NoSizeError, match="no diameter in the list"):
        listed.up(0.0251, 1e-3)


@given(
    diameter=st.floats(1e-4, 10.0),
    unit=st.sampled_from([1.0, 1e-3, INCH]),
    standard=st.sampled_from(
        [StandardDiameters(5e-4), *(StandardDiameters(preferred=x) for x in
         PREFERRED_NUMBERS.values())]
    ),
)  # fmt: skip
def test_no_standard_diameter_lies_between(
    diameter: float, unit: float, standard: StandardDiameters
) -> None:
    above, below = standard.up(diameter, unit), standard.down(diameter, unit)
    assert below <= diameter * (1.0 + 1e-8)
    assert above >= diameter * (1.0 - 1e-8)
    assert standard.up(above, unit) == pytest.approx(above)
    between = standard.up(0.5 * (below + above), unit) if below else above
    assert between == pytest.approx(above)


def test_diameters_are_rounded_in_their_own_unit() -> None:
    """Of a study in inches, one that is written in mm is a preferred number of mm; fillets and
    lengths are not rounded so.
    """
    text = """
[pin.B]
fillet = 0.1
profile = [
  { length = 1.0, diameter = "50 mm", connection = "B" },
  { length = 1.0, diameter = 3.0 },
]
"""
    standard = StandardDiameters(preferred=PREFERRED_NUMBERS["R20"])
    pin = tomllib.loads(resized_text(text, {"B": 1.15}, UNIT_SYSTEMS["in-lbf-s"], standard))["pin"][
        "B"
    ]
    assert [s["diameter"] for s in pin["profile"]] == ["63 mm", 3.55]
    assert pin["fillet"] == 0.115
    assert [s["length"] for s in pin["profile"]] == [1.0, 1.0]


def test_the_step_of_the_command_line_comes_first() -> None:
    table = SizeTable(series="R10")
    assert standard_diameters(table) == StandardDiameters(preferred=PREFERRED_NUMBERS["R10"])
    assert standard_diameters(table, 1e-3) == StandardDiameters(step=1e-3)
    assert standard_diameters(SizeTable()) is None


@each(
    ("line", "message"),
    [
        ('series = "R15"', "size.series"),
        ("series = []", "size.series"),
        ("largest_diameter = 0", "must be positive"),
        ("eye_ratio = 0.9", "size.eye_ratio"),
        ("scale_lugs = 1", "size.scale_lugs"),
        ("rooms = 4", "did you mean 'room'?"),
    ],
)
def test_bad_input_is_named(line: str, message: str) -> None:
    path = ROOT / "studies" / "one_pin.toml"
    with pytest.raises(InputError) as told:
        parse_study(path, f"{path.read_text()}\n[size]\n{line}\n")
    assert message in str(told.value)
