"""A row that meets its factor on surface and section, judged by what lies beneath contact.

118,000 psi of strength and a factor of 1.5 permit 78,667 psi; the row has 59,000 (factor 2.000).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.places import ContactEdge, ContactPlace, Places, SectionPlace, SurfacePlace
from fea.harmonic.beneath import stairs
from fea.support.records import JointRange, Variation
from pinbase.records import in_units
from pinstress import load_study, run
from pinstress.cli.closing import EXIT_REQUIREMENT_MISSED, report_violations
from pinstress.study.schema.units import UNIT_SYSTEMS
from reports.data.dependence import depends_on
from reports.data.results import Results
from reports.data.row import LandingRange, PinResult
from reports.format.words import headline, result_words
from reports.tables.json_results import to_json
from reports.tables.strength.envelope import envelope_table
from reports.tables.strength.safety_factors import safety_factors_table
from reports.text.pin_sentence import pin_sentence
from reports.text.summary import summary
from tests.conftest import ROOT
from tests.support.results.judged_results import judged, row
from tests.support.results.made_up_joint import make_joint
from tests.support.results.rows import with_values

SURFACE = SurfacePlace(59000.0, 295.0, "converged", (0.0, 1.0, 2.0))
SECTION = SectionPlace(50000.0, 250.0, "converged", 2.0, None, 0.0, 1e4, 2e4, 0.0, 0.2)
# 90,000 at 0.05, 80,000 at 0.3, 70,000 at 0.4 in
DEPTHS = (90000.0, 0.05), (80000.0, 0.3), (70000.0, 0.4)


def contact(beneath: float, error: float = 1000.0) -> ContactPlace:
    return ContactPlace(
        beneath, error, (0.0, 0.7, 2.0), None, 0.0, 0.3, (), (), DEPTHS
    )  # fmt: skip


def pin(beneath: float, error: float = 1000.0, **changes: object) -> PinResult:
    places = Places("surface", SURFACE, SECTION, contact(beneath, error))
    made = with_values(row("x", "converged", 2.0, True), places=places, **changes)
    return replace(made, depends_on=depends_on(made))


def only(made: PinResult) -> Results:
    return replace(judged(), pins=(made,))


@pytest.mark.parametrize(("beneath", "error", "expected"), [
    (77600.0, 1000.0, "safe"), (77700.0, 1000.0, "depends"), (85000.0, 0.0, "depends"),
])  # fmt: skip
def test_it_is_safe_only_if_what_lies_beneath_is_with_its_error(
    beneath: float, error: float, expected: str
) -> None:
    """118,000 / 1.5 = 78,666.7: 78,600 is less, 78,700 is more."""
    made = pin(beneath, error)
    assert made.outcome == expected
    assert made.meets_required is (expected == "safe")


def test_nothing_beneath_changes_a_row_that_fails_or_is_open() -> None:
    for decided, expected in ((False, "fails"), (None, "not decided")):
        made = pin(85000.0, decided=decided)
        assert made.outcome == expected
        assert made.depends_on == ()


def test_without_a_required_factor_yield_is_the_limit() -> None:
    assert pin(117500.0, 600.0, required=None).outcome == "depends"
    assert pin(117500.0, 400.0, required=None).outcome == "below yield"


def test_the_depth_is_that_of_what_is_permitted() -> None:
    """More than 78,667 psi reach to 0.3 in, more than 85,000 to 0.05; a factor there of
    118,000 / 85,000 = 1.388.
    """
    (found,) = pin(85000.0).depends_on
    assert (found.what, found.over, found.reach) == ("beneath", "beneath", 0.3)
    assert found.factor == pytest.approx(118.0 / 85.0)
    assert contact(1.0).depth(85000.0) == 0.05
    assert contact(1.0).depth(95000.0) == 0.0


def test_it_is_said_wherever_an_outcome_is(capsys: pytest.CaptureFixture[str]) -> None:
    made = pin(85000.0)
    results = only(made)
    clause = "but not beneath contact (factor 1.39, too low to a depth of 0.30 in)"
    assert headline(results) == (
        f"Pin A is safe as described (factor 2.00 ≥ 1.5 required; x), {clause}."
    )
    assert result_words(made) == "depends: beneath contact"
    assert "0 of 1 pin is safe in all cases" in summary(results)
    assert "depends: A (beneath contact)" in summary(results)
    assert clause in pin_sentence(made, results.units)
    (cells,) = safety_factors_table(results).records()
    assert (cells["outcome"], cells["meets_required"]) == ("depends", False)
    assert (
        cells["depends_on"] == "stress beneath contact (factor 1.39, too low to a depth of 0.30 in)"
    )
    assert {row["outcome"] for row in envelope_table(results).records()} <= {"depends"}
    assert report_violations(results) == EXIT_REQUIREMENT_MISSED
    assert f"Safe as described, {clause}: A (x)." in capsys.readouterr().err


def test_what_exceeds_only_with_its_error_has_no_depth_in_words() -> None:
    made = pin(78000.0, 1000.0)
    assert "(factor 1.49 with its error)" in headline(only(made))
    (entry,) = to_json(only(made))["pins"][0]["depends_on"]
    assert (entry["what"], entry["reach"]) == ("beneath", 0.3)
    assert entry["safety_factor"] == pytest.approx(118.0 / 79.0)


def test_results_json_has_the_places() -> None:
    found = to_json(only(pin(85000.0)))["pins"][0]
    assert found["governs"] == "surface"
    assert found["surface"]["safety_factor"] == pytest.approx(2.0)
    assert found["section"]["safety_factor"] == pytest.approx(118.0 / 50.0)
    assert found["contact"]["beneath"] == 85000.0
    assert "depths" not in found["contact"]
    bare = with_values(pin(85000.0), places=Places("surface", SURFACE))
    found = to_json(only(bare))["pins"][0]
    assert not {"section", "contact"} & set(found)


def test_properties_together_are_named_only_where_none_alone_is_enough() -> None:
    """80,000 psi beneath contact in a looser joint; all together 80,000 of the row as well. A row
    that fails is judged by itself.
    """
    for alone, expected in (
        (80000.0, [("beneath", "clearance")]),
        (70000.0, [("together", "all")]),
    ):
        over = (
            Variation("clearance", "high", 60000.0, 0.003, beneath=alone),
            Variation("together", "all", 80000.0, beneath=81000.0),
        )
        joint = replace(make_joint(), range=JointRange((59000.0, 80000.0), over))
        found = pin(60000.0, joint=joint)
        assert [(x.what, x.value) for x in found.depends_on] == expected
        assert found.outcome == "depends"
    low = (
        Variation("clearance", "high", 60000.0, 0.003, beneath=80000.0),
        Variation("together", "all", 50000.0, beneath=50000.0),
    )
    joint = replace(make_joint(), range=JointRange((50000.0, 60000.0), low))
    fails = with_values(pin(60000.0, joint=joint), required=2.2, decided=False)
    assert [(x.what, x.value) for x in depends_on(fails)] == [("together", "all")]


def test_strengths_of_edges_and_depths_are_in_the_units_of_a_study() -> None:
    """K of p = K d^-s: 1 Pa m^0.25 is 1e-6 MPa (1000 mm)^0.25 = 5.623e-6 MPa mm^0.25."""
    edge = ContactEdge("L", "start", 1.0, 0.25, 0.001, None, None, None)
    found = in_units(replace(contact(1e6), edges=(edge,)), UNIT_SYSTEMS["mm-N-s"].factor)
    strength = found.edges[0].K
    assert strength == pytest.approx(1e-6 * 1000.0**0.25, rel=1e-12)
    assert found.edges[0].yield_distance == pytest.approx(1.0)
    assert found.depths[0] == pytest.approx((0.09, 50.0))
    assert found.beneath == pytest.approx(1.0)


def test_stairs_have_the_farthest_point_of_every_stress() -> None:
    """Against a search of all points."""
    draw = np.random.default_rng(35)
    stress, away = draw.random(500), draw.random(500) ** 3
    made = stairs(stress, away, 0.2)
    assert len(made) < 60
    place = replace(contact(1.0), depths=made)
    for limit in (0.2, 0.5, 0.9, 0.99, stress.max()):
        brute = away[stress > limit].max(initial=0.0)
        assert place.depth(limit) == brute
    assert stairs(stress, away, 2.0) == ()


def test_what_lies_beneath_goes_with_the_impulse() -> None:
    """59,000 psi of the row are 68,077 at 0.13 s instead of 0.15, safe; 75,000 beneath are 86,538.
    In proportion to 1 / time, 78,667 are reached at 0.143 s.
    """
    times = np.array([0.15, 0.13])
    stress = 59000.0 * 0.15 / times
    over = LandingRange(
        "A", "x", times, np.full(2, 25.0), stress, stress, 118000.0 / stress, (0.15, 25.0),
        "converged", pulses=("rectangular",) * 2, nominal_pulse="rectangular",
        beneath=75000.0 * 0.15 / times,
    )  # fmt: skip
    made = pin(75000.0, 0.0)
    assert made.depends_on == ()
    (found,) = depends_on(replace(made, landing=over))
    assert (found.what, found.value, found.over) == ("beneath", "impulse time", "landing")
    assert found.flips_at == pytest.approx(0.15 * 75000.0 / (118000.0 / 1.5))
    assert found.factor == pytest.approx(118000.0 / 75000.0 * 0.13 / 0.15)
    text = headline(only(replace(made, depends_on=(found,))))
    assert "range of the landing (beneath contact at impulse time below 0.143 s)" in text
    less = replace(over, beneath=50000.0 * 0.15 / times)
    assert depends_on(pin(50000.0, 0.0, landing=less)) == ()


def test_a_row_that_fails_is_safe_at_a_longer_impulse_only_if_what_lies_beneath_is() -> None:
    """84,286 psi at 0.15 s are 74,370 at 0.17 s, safe; 90,000 beneath are 79,412, too much."""
    times = np.array([0.15, 0.17])
    stress = 118000.0 / 1.4 * 0.15 / times
    over = LandingRange(
        "A", "x", times, np.full(2, 25.0), stress, stress, 118000.0 / stress, (0.15, 25.0),
        "converged", pulses=("rectangular",) * 2, nominal_pulse="rectangular",
    )  # fmt: skip
    for beneath, expected in ((75000.0, ["impulse time"]), (90000.0, [])):
        over = replace(over, beneath=beneath * 0.15 / times)
        failing = row("x", "converged", 1.4, False, places=pin(beneath, 0.0).places, landing=over)
        assert [d.what for d in depends_on(failing)] == expected


@pytest.mark.slow
def test_the_range_of_a_landing_is_of_surface_and_section() -> None:
    """Section governs pin F of the landing gear (14.5 ksi, the surface less than 12.5): at the
    impulse of the case itself the range has the row's maximum, not the surface's. And stress is
    proportional to the force of the impulse, as there is no clearance.
    """
    found = run(load_study(ROOT / "studies" / "landing_gear.toml"), pins=["F"], cases=["landing"])
    (made,), (over,) = found.pins, found.landing
    assert made.places is not None
    assert made.places.governs == "section"
    here = np.isclose(over.impulse_time, over.nominal[0])
    here &= np.isclose(over.velocity_change, over.nominal[1])
    here &= np.array([pulse == over.nominal_pulse for pulse in over.pulses])
    (at,) = np.flatnonzero(here)
    assert over.max_von_mises[at] == pytest.approx(made.max_von_mises, rel=5e-3)
    per_force = over.max_von_mises / over.force
    assert per_force == pytest.approx(per_force[at], rel=0.02)
