"""A row is the larger of surface and section, as uncertain as either may make it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.peak import ErrorParts, Reason, SingularZone
from fea.core.pin_loads import PinLoads
from fea.core.verdict import Evidence
from fea.section.place import FoundSection, found_section
from fea.section.row import row_of
from fea.section.section_stress import SectionField
from geometry import Pin, Segment
from tests.support.each import each

STEEL = Material("steel", 205e9, 0.3, yield_strength=400e6)
D = 0.02
CANTILEVER = Pin("C", (Segment(0.2, D, name="shaft"), Segment(0.02, D, connection="E")))
BENT = PinLoads("c", ("E",), np.array([[[1e3, 0.0, 0.0]]]))


ZONE = SingularZone(
    (0.01, 0.0, 0.0), "the edge of a clamp", ("start", "shaft"), None, 0.3, 1e-3, True, 1e12, "none"
)


def surface(value: float, error: float, **more: object) -> Evidence:
    of = Evidence(
        "P", "c", "harmonic", value, ErrorParts(error), (0.01, 0.0, 0.1),
        remarks=Reason("; and more", ("more",)), why=Reason("harmonic", ("why",)),
    )  # fmt: skip
    return replace(of, **more)  # type: ignore[arg-type]


def section(share: float = 0.0) -> tuple[FoundSection, float]:
    """With an error of so much of it by cells, and its value."""
    answer = SectionField(CANTILEVER, STEEL, ("start",), (BENT,))
    found = found_section(answer, BENT, None, 0.02)
    found = replace(found, parts=ErrorParts(0.0, cells=share * found.at.value))
    return found, found.at.value


def test_a_row_is_the_larger_of_both() -> None:
    found, value = section(0.01)
    above = row_of(surface(2.0 * value, 0.03 * value), found, STEEL, 0.02)
    assert above.note == "estimated error 1.5%; and more"
    assert above.reasons == ("within-tolerance", "more", "why")
    assert above.places is not None
    assert above.places.governs == "surface"
    assert (above.max_von_mises, above.error_estimate) == (2.0 * value, 0.03 * value)
    assert (above.verdict, above.location) == ("converged", (0.01, 0.0, 0.1))
    below = row_of(surface(0.5 * value, 0.03 * value), found, STEEL, 0.02)
    assert below.places is not None
    assert below.places.governs == "section"
    assert (below.max_von_mises, below.error_estimate) == (value, 0.01 * value)
    assert below.location is not None
    assert np.abs(below.location) == pytest.approx([0.01, 0.0, 0.0])
    assert below.parts == found.parts
    assert below.note == "estimated error 1.0%; and more"
    assert below.reasons == ("in-section", "within-tolerance", "more", "why")
    for row in (above, below):
        assert row.places is not None
        assert row.places.section is not None
        assert row.places.section.max_von_mises == value
        use = found.at.plastic_use(400e6)
        assert row.places.section.plastic_utilisation == pytest.approx(use)
        assert row.places.contact is None
    assert below.places.surface.max_von_mises == 0.5 * value


def test_a_row_is_as_uncertain_as_the_larger_may_be() -> None:
    """Surface and section nearly alike: the upper end of either is that of the row, and a verdict
    that only one of them has is not kept.
    """
    found, value = section(0.05)
    row = row_of(surface(1.01 * value, 0.005 * value), found, STEEL, 0.02)
    assert row.places is not None
    assert row.places.governs == "surface"
    assert row.upper_end == pytest.approx(1.05 * value)
    assert row.verdict == "unconverged"
    assert row.note == "estimated error 4.0%, above the tolerance of 2.0%; and more"
    assert row.reasons == ("above-tolerance", "more", "why")
    assert row.places.surface.verdict == "converged"
    sure, value = section(0.001)
    row = row_of(surface(0.99 * value, 0.08 * value), sure, STEEL, 0.02)
    assert row.places is not None
    assert row.places.governs == "section"
    assert row.upper_end == pytest.approx(1.07 * value)
    assert row.verdict == "unconverged"
    assert row.note == "estimated error 7.0%, above the tolerance of 2.0%; and more"
    assert row.reasons == ("in-section", "above-tolerance", "more", "why")
    row = row_of(surface(0.9 * value, 0.08 * value), sure, STEEL, 0.02)
    assert row.verdict == "converged"  # the surface is surely below


@each(
    ("surfaces", "expected"),
    [
        ((0.9, (0.8, 1.2)), (1.0, 1.2)),  # the section governs, and the surface may have more
        ((0.5, (0.4, 0.7)), (1.0, 1.0)),  # it surely has less
        ((1.1, (0.7, 1.5)), (1.0, 1.5)),  # it governs: at half the distance; not below the section
        ((2.0, (1.5, 3.0)), (1.5, 3.0)),
    ],
)
def test_a_singular_surface_stays_singular(
    surfaces: tuple[float, tuple[float, float]], expected: tuple[float, float]
) -> None:
    found, value = section()
    own, (low, high) = surfaces
    singular = surface(own * value, 0.0, zones=(ZONE,), excluded=(low * value, high * value))
    row = row_of(singular, found, STEEL, 0.02)
    assert row.verdict == "singular"
    assert row.max_von_mises == pytest.approx(max(own, 1.0) * value)
    assert row.interval == pytest.approx((expected[0] * value, expected[1] * value))
    largest = row.max_von_mises or 0.0
    assert row.interval is not None
    assert row.error_estimate == pytest.approx(
        max(largest - row.interval[0], row.interval[1] - largest)
    )
    assert row.places is not None
    assert row.places.surface.verdict == "singular"
    assert row.places.section is not None
    assert row.places.section.verdict == "converged"


def test_bodies_without_sections() -> None:
    row = row_of(surface(1e8, 1e6), None, STEEL, 0.02)
    assert row.places is not None
    assert (row.places.governs, row.places.section) == ("surface", None)
