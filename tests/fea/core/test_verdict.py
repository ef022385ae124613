"""A maximum is judged once, with all parts of its error: verdict, error and note agree."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fea.core.linear_solver import SolveError
from fea.core.peak import ErrorParts, Reason, SingularZone
from fea.core.verdict import Evidence, judge
from tests.support.each import each
from tests.support.errors import raises

SURFACE = Evidence(
    "P", "pull", "harmonic", 200.0, ErrorParts(1.0), (0.0, 0.0, 0.0),
    remarks=Reason("; another remark", ("another",)), why=Reason("contact", ("contact",)),
)  # fmt: skip
CLAMP = SingularZone(
    (0.0, 0.0, 0.0), "the edge of a clamp", ("start", "shaft"), 0.31, 0.33, 1e-3, True, 900.0, ""
)


@each(
    ("mesh", "cells", "verdict", "note", "code"),
    [
        (0.005, 0.01, "converged", "estimated error 1.5%", "within-tolerance"),
        (0.015, 0.01, "unconverged", "estimated error 2.5%, above the tolerance of 2.0%",
         "above-tolerance"),
        (0.05, 0.01, "unconverged", "estimated error 6.0%, above the tolerance of 2.0%",
         "above-tolerance"),
    ],
)  # fmt: skip
def test_note_error_and_verdict_agree(
    mesh: float, cells: float, verdict: str, note: str, code: str
) -> None:
    surface = replace(SURFACE, parts=ErrorParts(200.0 * mesh)).with_parts(cells=200.0 * cells)
    peak = judge(surface, 0.02)
    assert (peak.verdict, peak.note) == (verdict, f"{note}; another remark")
    assert peak.reasons == (code, "another", "contact")
    assert peak.error_estimate == pytest.approx(200.0 * (mesh + cells))
    assert peak.parts is not None
    assert peak.parts.cells == pytest.approx(200.0 * cells)
    assert peak.why == "contact"


def test_an_error_that_is_not_known_is_never_within_the_tolerance() -> None:
    doubt = Reason("no error is known: a torque", ("no-error-known",))
    peak = judge(replace(SURFACE, doubt=doubt), 0.02)
    assert (peak.verdict, peak.reasons[0]) == ("unconverged", "no-error-known")
    assert peak.note == "no error is known: a torque; another remark"


def test_a_singular_row_has_every_part_in_its_interval_and_its_note() -> None:
    """The note once told the interval of the meshes alone, where cells had widened it."""
    surface = replace(SURFACE, zones=(CLAMP,), excluded=(180.0, 230.0))
    peak = judge(surface.with_parts(cells=1.0), 0.02)
    assert peak.interval == pytest.approx((180.0 * 0.99, 230.0 * 1.01))
    assert peak.error_estimate == pytest.approx(32.3)
    assert (peak.verdict, peak.reasons[0]) == ("singular", "within-tolerance")
    assert peak.note == (
        "no maximum exists: at the edge of a clamp (start / shaft) stress grows as distance^-s, "
        "s = 0.31 measured, 0.33 theoretical; half and twice the excluded distance give -11% to "
        "+16%; another remark"
    )
    rough = judge(surface.with_parts(cells=9.0), 0.02)
    assert "; outside, estimated error 5.0%, above the tolerance of 2.0%;" in rough.note


def test_a_surface_that_is_read_nowhere_has_no_verdict() -> None:
    """A thin ring: the note divided by the stress, which was zero."""
    surface = replace(SURFACE, value=0.0, zones=(CLAMP,), excluded=(0.0, 0.0))
    with raises(SolveError, "all-excluded", "analysis.excluded_distance"):
        judge(surface, 0.02)


@each(
    ("other", "error", "verdict"),
    [((0.0, 150.0), 1.0, "converged"), ((0.0, 204.0), 4.0, "converged"),
     ((0.0, 205.0), 5.0, "unconverged")],
)  # fmt: skip
def test_a_place_that_may_be_larger_counts(
    other: tuple[float, float], error: float, verdict: str
) -> None:
    peak = judge(SURFACE, 0.02, other)
    assert (peak.error_estimate, peak.verdict) == (error, verdict)


def test_a_small_tolerance_is_not_said_to_be_zero() -> None:
    peak = judge(replace(SURFACE, parts=ErrorParts(200.0 * 4e-4)), 2e-8)
    assert peak.note.startswith("estimated error 0.04%, above the tolerance of 2e-06%;")
