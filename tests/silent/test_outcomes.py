"""A row was "safe" while its own page said otherwise: within the range of its joint, within that of
its landing, with its error, or beside a check that fails. Independent values are in the comments.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from assess.margin import Margin, PinMargin
from fea.support.records import JointRange, JointResult, Variation
from pinstress import changed_study, load_study, run
from pinstress.cli.commands import run_command_line
from reports.data.dependence import depends_on
from reports.data.headline import headline_json, worst_checks
from reports.data.overview import pin_lines
from reports.data.results import Results
from reports.data.row import LandingRange, PinResult
from reports.format.words import headline, result_words
from reports.tables.json_results import to_json
from reports.tables.strength.overview import check_words
from reports.tables.strength.safety_factors import safety_factors_table
from reports.text.summary import summary
from tests.conftest import ROOT
from tests.support.results.judged_results import judged, row
from tests.support.results.made_up_joint import make_joint

CLEVIS = ROOT / "studies" / "clevis.toml"
ONE_PIN = load_study(ROOT / "studies" / "one_pin.toml")


def only(pin: PinResult) -> Results:
    return replace(judged(), pins=(pin,))


@pytest.fixture(scope="module")
def clevis() -> Results:
    """Prescribed, with lugs described: 362.5 MPa, of 700, where contact has 306 (CalculiX 304),
    and a beam in the lugs up to 570. 1.5 is required, 700 / 570 = 1.23.
    """
    return run(
        changed_study(
            load_study(CLEVIS),
            {"analysis.joints": "prescribed", "case.pull.distribution": "uniform"},
        )
    )


@pytest.fixture(scope="module")
def one_pin() -> Results:
    return run(ONE_PIN)


def test_safe_as_described_but_not_within_the_range_of_the_joint(clevis: Results) -> None:
    (pin,) = clevis.pins
    assert pin.safety_factor is not None
    assert pin.safety_factor > 1.5
    assert pin.joint is not None
    assert pin.joint.range is not None
    assert 700.0 / pin.joint.range.max_von_mises[1] < 1.5
    assert pin.outcome == "depends"
    assert pin.meets_required is False
    assert all(d.over == "joint" and d.factor < 1.5 for d in pin.depends_on)
    assert headline(clevis).startswith(
        "Pin P is safe as described (factor 1.93 ≥ 1.5 required; pull)"
    )
    assert "fails within the range of the joint (clearance 0.1 mm" in headline(clevis)
    assert summary(clevis).startswith("0 of 1 pin is safe in all cases")
    found = json.loads(json.dumps(to_json(clevis)))
    assert found["pins"][0]["outcome"] == "depends"
    assert found["pins"][0]["depends_on"][0]["what"] == "clearance"
    assert found["pins"][0]["depends_on"][0]["flips_at"] == 0.1
    assert found["headline"]["depends"] == ["P"]
    assert found["headline"]["failing"] == []
    (cells,) = safety_factors_table(clevis).records()
    assert (cells["outcome"], cells["meets_required"]) == ("depends", False)
    assert str(cells["depends_on"]).startswith("the range of the joint (clearance 0.1 mm")


def test_the_exit_status_counts_it_as_a_miss(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The second run has its rows from the cache."""
    monkeypatch.setenv("PINSTRESS_CACHE", str(tmp_path / "cache"))
    text = CLEVIS.read_text(encoding="utf-8").replace(
        "[analysis]", '[analysis]\njoints = "prescribed"'
    )
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    command = ["run", str(tmp_path / "c.toml"), "--out", str(tmp_path / "out")]
    assert run_command_line(command) == 0
    said = capsys.readouterr()
    assert "fails within the range of the joint" in " ".join(said.out.split())
    assert run_command_line([*command, "--fail-on-miss"]) == 4
    assert "Safe as described, but not within the range of the joint" in capsys.readouterr().err


def in_contact(factor: float, **changes: Any) -> PinResult:
    """118,000 psi; 1.5 is required, so 78,667 psi are permitted. Clearances as make_joint has them:
    0.0015 in given, 0.003 in varied.
    """
    made = row("x", "converged", factor, factor > 1.5)
    stress = made.max_von_mises or 0.0
    over = JointRange(
        (stress, 1.5 * stress),
        (
            Variation("clearance", "none", 0.9 * stress, 0.0),
            Variation("clearance", "twice the given", 1.5 * stress, 0.003),
            Variation("tilt", "guided", 0.95 * stress),
        ),
    )
    return replace(made, joint=replace(make_joint(), range=over), **changes)


def test_the_clearance_at_which_it_flips() -> None:
    """A factor of 2 with 0.5 % of error; 1.5 times the stress at 0.003 in. Linear between: the
    permitted stress is 1/3 above that as given, 1.3333 = 1.005 (1 + 0.5 x), x = 0.65340.
    """
    pin = in_contact(2.0)
    (over,) = depends_on(pin)
    assert (over.what, over.given, over.at) == ("clearance", 0.0015, 0.003)
    assert over.flips_at == pytest.approx(0.0015 * (1.0 + 0.65340), rel=1e-4)
    assert over.factor == pytest.approx(2.0 / 1.5)
    assert result_words(replace(pin, depends_on=(over,))) == "depends: joint"
    assert depends_on(in_contact(3.0)) == ()  # 3 / 1.5 is enough


def test_the_error_counts_within_the_range_too() -> None:
    """A factor of 2.255 falls to 1.5033 at twice the clearance, 1.4958 with its error of 0.5 %."""
    assert depends_on(in_contact(2.255)) != ()
    assert depends_on(in_contact(2.265)) == ()


def test_a_pin_that_fails_may_be_safe_within_the_range() -> None:
    """1.4 as described; no clearance has 1.4 / 0.9 = 1.556. It fails all the same."""
    pin = in_contact(1.4)
    some = depends_on(pin)
    assert [(d.what, d.value) for d in some] == [("clearance", "none")]
    found = replace(pin, depends_on=some)
    assert found.outcome == "fails"
    entry = to_json(only(found))["pins"][0]
    assert entry["depends_on"] == []
    assert entry["safe_within"][0]["what"] == "clearance"
    assert "Fails as described, safe within the range of the joint: A (x)." in summary(only(found))


def landing(factor: float, pulses: tuple[str, ...] = ("rectangular",)) -> LandingRange:
    """Stress as the force: velocity over time, times pi / 2 for a half-sine. 0.15 s, 25 ft/s."""
    peak = {"rectangular": 1.0, "half-sine": math.pi / 2.0}
    points = [(t, v, p) for p in pulses for v in (10.0, 25.0) for t in (0.1, 0.15, 0.2)]
    times, speeds = (np.array([x[k] for x in points]) for k in (0, 1))
    force = speeds / times * np.array([peak[p] for *_, p in points])
    stress = 118000.0 / factor * force / (25.0 / 0.15)
    return LandingRange(
        "A", "x", times, speeds, force, stress, 118000.0 / stress, (0.15, 25.0), "converged",
        pulses=tuple(p for *_, p in points), nominal_pulse="rectangular",
    )  # fmt: skip


def test_within_the_range_of_the_landing() -> None:
    """2 at 0.15 s is 1.333 at 0.1 s; the factor is in proportion to time: 1.5 at 0.1125 s, less
    the error of 0.5 % at 0.11306 s.
    """
    pin = row("x", "converged", 2.0, True)
    (over,) = depends_on(replace(pin, landing=landing(2.0)))
    assert (over.what, over.over, over.given, over.at) == ("impulse time", "landing", 0.15, 0.1)
    assert over.flips_at == pytest.approx(0.15 * 1.5 / 2.0 * 1.005, rel=1e-9)
    assert "range of the landing (impulse time below 0.113 s)" in headline(
        only(replace(pin, depends_on=(over,)))
    )
    assert depends_on(row("x", "converged", 2.4, True, landing=landing(2.4))) == ()


def test_the_shape_of_the_pulse() -> None:
    """2.3 as the mean force is 2.3 / (pi / 2) = 1.464 at the peak of a half-sine."""
    pin = row("x", "converged", 2.3, True)
    found = depends_on(replace(pin, landing=landing(2.3, ("rectangular", "half-sine"))))
    assert [(d.what, d.value) for d in found] == [("pulse", "half-sine")]
    assert found[0].factor == pytest.approx(2.3 / (math.pi / 2.0))
    together = depends_on(
        row("x", "converged", 2.5, True, landing=landing(2.5, ("rectangular", "half-sine")))
    )
    assert [d.what for d in together] == ["impulse time, velocity change and pulse together"]


@pytest.mark.parametrize(("part", "expected", "status"), [
    (-2.0, "safe", 0), (-0.5, "not decided", 1), (0.5, "not decided", 1), (2.0, "fails", 0),
])  # fmt: skip
def test_a_converged_maximum_counts_with_its_error(
    part: float,
    expected: str,
    status: int,
    one_pin: Results,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The required factor is the pin's own, moved by a part of its error: within it nothing is
    decided, though the maximum has converged.
    """
    (first,) = one_pin.pins
    assert first.max_von_mises is not None
    error = (first.error_estimate or 0.0) / first.max_von_mises
    required = (first.safety_factor or 0.0) * (1.0 + part * error)
    (tmp_path / "p.toml").write_text(
        re.sub(r"required_safety_factor = .*", f"required_safety_factor = {required}", ONE_PIN.text)
    )
    command = ["run", str(tmp_path / "p.toml"), "--out", str(tmp_path / "out")]
    assert run_command_line(command) == status
    (found,) = json.loads((tmp_path / "out" / "results.json").read_text())["pins"]
    assert (found["verdict"], found["outcome"]) == ("converged", expected)
    said = capsys.readouterr()
    open_ = "Not decided: B (landing): within its error of the required factor"
    assert (open_ in said.err) is (expected == "not decided")


def made_safe() -> PinResult:
    return row("x", "converged", 4.462, True)


def test_a_check_over_all_cases_is_named_without_a_demand() -> None:
    """The line had the factor of a failing case beside "safe", which is of the life alone."""
    life = Margin("fatigue life", "critical plane", "fatigue", "limit", 1.0, 0.0, 1e-6, "1")
    pins = (row("x", "converged", 1.4, False), row("y", "converged", 4.462, True))
    results = replace(only(pins[0]), pins=pins, spectrum_margins=(PinMargin("A", "", life),))
    found = {line.case: check_words(line) for line in pin_lines(results)}
    assert found == {"x": "–", "y": "–", "all cases": "fatigue life"}


def test_the_headline_is_the_worst_of_all_checks() -> None:
    """4.462 of 1.5 beside 4.525 times the allowable fatigue damage: 1 / 4.525 - 1 = -0.779."""
    fatigue = Margin("fatigue life", "critical plane", "fatigue", "limit", 1.0, 4.525e-6, 1e-6, "1")
    results = replace(only(made_safe()), spectrum_margins=(PinMargin("A", "", fatigue),))
    assert headline(results) == "Pin A fails: fatigue life, margin of safety −0.779."
    assert "0 of 1 pin is safe in all cases (required factor 1.5); fails: A (fatigue life)." in (
        summary(results)
    )
    found = headline_json(results, headline(results))
    assert found is not None
    assert found["failing"] == ["A"]
    assert found["worst"] == {
        "pin": "A", "case": "", "check": "fatigue life",
        "factor": pytest.approx(1.0 / 4.525), "required": 1.0, "outcome": "fails",
    }  # fmt: skip


def test_comparisons_and_checks_without_data_do_not_count() -> None:
    weak = Margin("bending, for comparison", "", "hand", "limit", 1.0, 2.0, 1.0, governs=False)
    open_ = Margin("bearing", "", "hand", "limit", 1.0, None, None, needs="bearing_strength")
    results = replace(
        only(made_safe()), spectrum_margins=(PinMargin("A", "x", weak), PinMargin("A", "x", open_))
    )
    assert headline(results).startswith("Pin A is safe: factor 4.46 ≥ 1.5")


def test_rupture_within_the_error_is_not_decided() -> None:
    """The margin takes the upper end of the maximum; the lower end meets it: 1.004 / 1.01 < 1."""
    rupture = Margin("von Mises stress, rupture", "", "model", "ultimate", 1.5, 1.004, 1.5)
    results = replace(only(made_safe()), spectrum_margins=(PinMargin("A", "x", rupture),))
    assert worst_checks(results)["A"].outcome == "not decided"
    sure = replace(rupture, demand=1.02)
    results = replace(results, spectrum_margins=(PinMargin("A", "x", sure),))
    assert worst_checks(results)["A"].outcome == "fails"


def test_one_margin_of_a_row_has_one_meaning(one_pin: Results) -> None:
    """Against the required factor: 1.13 of 10 was -0.887 in one table and +0.13 in another."""
    (found,) = one_pin.pins
    (m,) = (m.margin for m in one_pin.margins if m.margin.method == "von Mises stress, yield")
    (cells,) = safety_factors_table(one_pin).records()
    assert found.max_von_mises is not None
    assert m.factor == 10.0
    low = (found.safety_factor or 0.0) / (1.0 + (found.error_estimate or 0.0) / found.max_von_mises)
    assert m.margin == pytest.approx(low / 10.0 - 1.0)
    assert float(cells["margin_of_safety"] or 0.0) == pytest.approx(
        (found.safety_factor or 0.0) / 10.0 - 1.0
    )


def test_a_joint_that_is_not_solved_names_the_contact() -> None:
    """Where no single change of the assumed lugs is to blame, contact itself is."""
    made = row("x", "converged", 1.7, True)
    stress = made.max_von_mises or 0.0
    over = JointRange((0.5 * stress, 1.4 * stress), (), "foundation", True)
    (found,) = depends_on(replace(made, joint=JointResult("prescribed", range=over)))
    assert (found.what, found.value) == ("joint", "contact with assumed lugs")


@pytest.mark.slow
def test_a_sweep_says_what_a_run_says(clevis: Results) -> None:
    """In contact a design's outcome is that of its run; with prescribed loads, whose range a sweep
    leaves to a run, it is never plainly safe.
    """
    from pinstress.explore.sweep.evaluate import Evaluator

    prescribed = changed_study(load_study(CLEVIS), {"analysis.joints": "prescribed"})
    (found,) = Evaluator(prescribed, ()).rows(())
    assert found.outcome == "safe as described"
    weak = {"material.steel.yield_strength": "475 MPa"}
    contact = changed_study(load_study(CLEVIS), weak)
    (row_,) = Evaluator(contact, ()).rows(())
    results = run(contact)
    (pin,) = results.pins
    assert row_.outcome == pin.outcome == "depends"
    assert row_.depends_on == safety_factors_table(results).records()[0]["depends_on"]


def test_designs_of_equal_forces_are_judged_each_by_its_own_impulse() -> None:
    """Twice the velocity in twice the time is the same force, and not the same place in the range:
    a row does not depend on which designs the process has solved before.
    """
    from pinstress.explore.sweep.evaluate import Evaluator
    from pinstress.explore.sweep.number import number_at

    gear = load_study(ROOT / "studies" / "landing_gear.toml")
    weak = changed_study(gear, {"material.AISI 4340.yield_strength": "37.5 ksi"})
    impulse = "case.landing.apply.impulse"
    numbers = [number_at(weak, f"{impulse}.{key}") for key in ("impulse_time", "velocity_change")]
    first = [number.nominal for number in numbers]
    second = [2.0 * value for value in first]
    one = Evaluator(weak, numbers, ["B"], ["landing"])
    (stated,), (slower,) = one.rows(first), one.rows(second)
    assert stated.max_von_mises == pytest.approx(slower.max_von_mises, rel=1e-9)
    assert stated.outcome == slower.outcome == "depends"
    assert stated.depends_on != slower.depends_on
    assert Evaluator(weak, numbers, ["B"], ["landing"]).rows(second) == [slower]
