"""A maximum against yield: factors, what they decide, and the outcome, by hand."""

from __future__ import annotations

import pytest

from assess.judgement import Judgement, against_yield
from fea.core.peak import Maximum
from tests.support.each import each

CONVERGED = Maximum("P", "c", "harmonic", "converged", "", 200e6, 10e6)


@each(("strength", "required", "decided", "outcome"), [
    (400e6, 1.5, True, "safe"),  # 210 of 267 MPa
    (310e6, 1.5, None, "not decided"),  # 190 to 210 of 207 MPa
    (280e6, 1.5, False, "fails"),  # 190 of 187 MPa
    (220e6, None, True, "below yield"),
    (205e6, None, None, "not decided"),
    (180e6, None, False, "yields"),
])  # fmt: skip
def test_the_error_decides(
    strength: float, required: float | None, decided: bool | None, outcome: str
) -> None:
    found = against_yield(CONVERGED, strength, required)
    assert found.safety_factor == pytest.approx(strength / 200e6)
    assert (found.decided, found.outcome, found.interval) == (decided, outcome, None)
    assert found.yields is (strength < 200e6)


def test_a_singular_maximum_has_an_interval_and_is_never_safe() -> None:
    zone = Maximum(
        "P", "c", "harmonic", "singular", "", 200e6, 60e6, interval=(100e6, 250e6)
    )  # fmt: skip
    found = against_yield(zone, 500e6, 1.5)
    assert found.interval == (2.0, 5.0)
    assert found.decided is None
    assert against_yield(zone, 140e6, 1.5).outcome == "fails"  # 100 of 93 MPa
    endless = Maximum("P", "c", "harmonic", "singular", "", 200e6, 60e6, interval=(0.0, 250e6))
    assert against_yield(endless, 500e6, 1.5).interval == (2.0, None)


def test_without_a_strength_or_a_stress_nothing_is_decided() -> None:
    rigid = Maximum("P", "c", "harmonic", "rigid", "")
    for found in (against_yield(CONVERGED, None, 1.5), against_yield(rigid, 400e6, 1.5)):
        assert found == Judgement(required=1.5)
        assert (found.yields, found.outcome) == (None, "not decided")
