"""The sentence at the top of the page, and the tables of loads and times."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reports.data.decision import utilisation, worst_first
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.words import headline
from reports.page.loads import loads_at, timings
from reports.text.summary import summary
from tests.support.programs.command_line import QUICK, run_here
from tests.support.results.rows import with_values


def row(results: Results, pin: str, case: str) -> PinResult:
    (found,) = (p for p in results.pins if (p.pin, p.case) == (pin, case))
    return found


def test_a_row_that_was_not_solved_is_no_worse_than_one_that_fails(results: Results) -> None:
    known = [p for p in results.pins if p.meets_required is False]
    least = min(known, key=lambda p: p.safety_factor or 0.0)
    text = headline(results)
    assert text.startswith("5 of 9 pins miss the required factor 1.5: ")
    assert text.partition(": ")[2].startswith(f"{least.pin} ({least.case}), ")
    of_one = replace(results, pins=(least,))
    assert headline(of_one).startswith(f"Pin {least.pin} fails: factor ")
    assert f"< 1.5 required ({least.case})" in headline(of_one)
    order = [pin.outcome for pin in worst_first(results)]
    assert order == sorted(order, key=["fails", "not decided", "safe"].index)


def test_pins_without_load_have_no_factor_to_name(results: Results) -> None:
    idle = with_values(
        row(results, "A", "retract"),
        verdict="converged",
        max_von_mises=0.0,
        error_estimate=0.0,
        safety_factor=None,
        decided=True,
        required=2.0,
    )
    other = with_values(idle, pin="B")
    both = replace(results, pins=(idle, other))
    assert headline(both) == "Both pins are safe: no load stresses them."
    assert headline(replace(results, pins=(idle,))) == "Pin A is safe: no load stresses it."
    loaded = with_values(
        idle, case="extend", max_von_mises=100.0, safety_factor=3.0, safety_factor_interval=None
    )
    one = replace(results, pins=(idle, loaded))
    assert worst_first(one) == [loaded, idle]
    assert loaded.location is not None
    assert idle.location is None
    assert headline(one) == "Pin A is safe: factor 3.00 ≥ 2 required (extend)."


@pytest.mark.parametrize(
    ("verdict", "factor", "meets", "required", "words"),
    [
        ("converged", 3.0, True, 2.0, "Pin A is safe: factor 3.00 ≥ 2 required (retract)."),
        ("singular", 3.0, None, 2.0, "not decided: singular (retract); factor 3.00, 2 required."),
        ("singular", 1.5, False, 2.0, "Pin A fails: factor 1.50 < 2 required (retract)."),
        ("unconverged", 3.0, None, 2.0, "Whether pin A is safe is not decided: not converged"),
        ("converged", 3.0, True, None, "Pin A stays below yield: factor 3.00 ≥ 1 at yield"),
        ("failed", None, None, 2.0, "pin A is safe is not decided: solution failed (retract)."),
    ],
)
def test_the_worst_row_in_a_sentence(
    results: Results,
    verdict: str,
    factor: float | None,
    meets: bool | None,
    required: float | None,
    words: str,
) -> None:
    pin = with_values(
        row(results, "A", "retract"),
        verdict=verdict,
        safety_factor=factor,
        decided=meets,
        required=required,
    )
    some = replace(results, pins=(pin,), required_safety_factor=required)
    assert words in headline(some)
    if verdict == "converged":
        assert summary(some).endswith("All maxima have converged to 2 %.")
        other = with_values(pin, pin="B", safety_factor=5.0)
        text = headline(replace(some, pins=(other, pin)))
        assert text.startswith("Both pins ")
        assert "(pin A, retract)" in text
    assert headline(replace(some, pins=())) == ""


@pytest.mark.parametrize(
    ("interval", "used"),
    [(None, (0.5, 0.5)), ((1.6, 8.0), (0.25, 1.25)), ((1.6, None), (0.0, 1.25))],
)
def test_utilisation(
    results: Results, interval: tuple[float, float | None] | None, used: tuple[float, float]
) -> None:
    pin = with_values(
        row(results, "A", "retract"), safety_factor=4.0, safety_factor_interval=interval
    )
    assert utilisation(pin, 2.0) == pytest.approx(used)
    assert utilisation(with_values(pin, safety_factor=None), 2.0) is None


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


def test_a_pin_without_load_is_told_no_margin_of_safety(tmp_path: Path) -> None:
    """Of its checks the rupture, with an infinite margin, was named "+–"."""
    text = QUICK.replace("forces = {", "forces = { B = [0, 0] } #")
    text = text.replace("yield_strength", 'ultimate_strength = "250 ksi"\nyield_strength')
    (tmp_path / "study.toml").write_text(text)
    made = run_here("run", "study.toml", "--no-cache", "--jobs", "1", cwd=tmp_path)
    assert made.stdout.startswith("Pin B is safe: no load stresses it.\n")
    assert "Other checks: no load in any." in made.stdout
    assert not {"+–", "surface", "rupture"} & set(made.stdout.split())
