"""The sentence at the top of the page, and the tables of loads and times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reports.headline import headline
from reports.page_loads import loads_at, timings
from reports.results import PinResult, Results


def row(results: Results, pin: str, case: str) -> PinResult:
    (found,) = (p for p in results.pins if (p.pin, p.case) == (pin, case))
    return found


def test_says_what_governs_whether_it_is_enough_and_what_is_open(results: Results) -> None:
    known = [p for p in results.pins if p.safety_factor is not None]
    least = min(known, key=lambda p: p.safety_factor or 0.0)
    text = headline(results)
    assert text.startswith(
        f"Pin {least.pin} governs, in case {least.case}: its factor of safety is"
    )
    assert "(converged, beyond yield) where 1.5 is required, which is not enough." in text
    assert "pin J (landing), which nothing holds" in text
    assert "the maximum of pin D (retract), pin D (landing) to what was asked for" in text


@pytest.mark.parametrize(
    ("verdict", "factor", "meets", "required", "words"),
    [
        ("converged", 3.0, True, 2.0, "3.000 (converged) where 2 is required, which is enough."),
        ("singular", 3.0, None, 2.0, "whether that is enough is not known. Not known: the true"),
        ("singular", 1.5, False, 2.0, "(singular) where 2 is required, which is not enough."),
        ("unconverged", 3.0, None, 2.0, "and whether that is enough is not known."),
        ("converged", 3.0, None, None, "3.000 (converged), which is below yield."),
    ],
)
def test_no_factor_without_its_verdict(
    results: Results,
    verdict: str,
    factor: float,
    meets: bool | None,
    required: float | None,
    words: str,
) -> None:
    pin = replace(
        row(results, "A", "retract"),
        verdict=verdict,
        safety_factor=factor,
        meets_required=meets,
        yields=False,
    )
    text = headline(replace(results, pins=(pin,), required_safety_factor=required))
    assert words in text
    known = "Every maximum is known to 2 %." in text
    assert known is (verdict == "converged")


def test_failed_rows_are_told(results: Results) -> None:
    failed = replace(
        row(results, "J", "landing"), verdict="failed", note="the mesh of pin J is inside out"
    )
    text = headline(replace(results, pins=(row(results, "A", "retract"), failed)))
    assert "pin J (landing), whose numerics failed" in text
    assert headline(replace(results, pins=(failed,))) == ""


def test_loads_are_those_at_the_governing_instant(results: Results) -> None:
    pin, table = row(results, "C", "retract"), results.reactions[0]
    grid = loads_at(pin, results)
    assert grid is not None
    assert table.times is not None
    assert pin.time is not None
    instant = int(np.abs(table.times - pin.time).argmin())
    assert instant > 0
    c = table.connections.index("strut C")
    (found,) = (r for r in grid.body if r[0] == "strut C")
    size = float(np.linalg.norm(table.forces[instant, c]))
    assert float(found[2].replace(",", "")) == pytest.approx(size, rel=1e-3)
    assert len(grid.body) == 2
    assert loads_at(replace(pin, case="another"), results) is None


def test_times_add_up(results: Results) -> None:
    grid = timings(results)
    assert grid is not None
    assert len(grid.body) == len(results.pins) + 1
    assert float(grid.body[-1][-1]) == pytest.approx(sum(p.seconds for p in results.pins), rel=0.05)
    assert timings(replace(results, pins=())) is None
