"""The sentence at the top of the page, and the tables of loads and times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reports.data.results import PinResult, Results
from reports.page.loads import loads_at, timings
from reports.text.headline import headline


def row(results: Results, pin: str, case: str) -> PinResult:
    (found,) = (p for p in results.pins if (p.pin, p.case) == (pin, case))
    return found


def test_says_what_governs_whether_it_is_enough_and_what_is_open(results: Results) -> None:
    known = [p for p in results.pins if p.safety_factor is not None]
    least = min(known, key=lambda p: p.safety_factor or 0.0)
    text = headline(results)
    assert text.startswith(f"Pin {least.pin}, case {least.case}, governs: safety factor ")
    assert "(converged, beyond yield), required 1.5. The pin fails." in text
    assert "Pin J (landing): not solved, because it is unconstrained." in text
    assert "Pin D (retract), pin D (landing): not converged" in text


@pytest.mark.parametrize(
    ("verdict", "factor", "meets", "required", "words"),
    [
        ("converged", 3.0, True, 2.0, "3.000 (converged), required 2. The pin is safe."),
        ("singular", 3.0, None, 2.0, "not decided (singular). Pin A (retract): no maximum"),
        ("singular", 1.5, False, 2.0, "(singular), required 2. The pin fails."),
        ("unconverged", 3.0, None, 2.0, "Whether the pin is safe is not decided (not converged)."),
        ("converged", 3.0, None, None, "3.000 (converged). The pin stays below yield."),
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
    known = "All maxima have converged to 2 %." in text
    assert known is (verdict == "converged")


def test_failed_rows_are_reported(results: Results) -> None:
    failed = replace(
        row(results, "J", "landing"), verdict="failed", note="the mesh of pin J is inside out"
    )
    text = headline(replace(results, pins=(row(results, "A", "retract"), failed)))
    assert "Pin J (landing): the numerical solution failed." in text
    assert headline(replace(results, pins=(failed,))) == ""


def test_loads_are_those_at_the_governing_instant(results: Results) -> None:
    pin = row(results, "C", "retract")
    grid = loads_at(pin, results.units)
    assert grid is not None
    (found,) = (r for r in grid.body if r[0] == "strut C")
    (load,) = (x for x in pin.loads if x.connection == "strut C")
    size = float(np.linalg.norm(load.force))
    assert float(found[2].replace(",", "")) == pytest.approx(size, rel=1e-3)
    assert len(grid.body) == len(pin.loads) == 2
    assert loads_at(replace(pin, loads=()), results.units) is None


def test_times_add_up(results: Results) -> None:
    grid = timings(results)
    assert grid is not None
    assert len(grid.body) == len(results.pins) + 1
    assert float(grid.body[-1][-1]) == pytest.approx(sum(p.seconds for p in results.pins), rel=0.05)
    assert timings(replace(results, pins=())) is None
