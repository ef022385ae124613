"""The section forces of a pin by the resultants of contact's pressures on its rings."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import LoadAmounts, PinLoads, UnitLoad
from fea.section.section_stress import SectionField
from fea.support.contact.pressure_loads import resultants
from geometry import ArgumentError, Pin, Segment
from geometry.shape.rings import ringed, rings

STEEL = Material("s", 210e9, 0.3)
PIN = Pin("P", tuple(Segment(0.03, 0.02, connection=name) for name in ("A", None, "B")))
ENDS = {name: np.linspace(0.0, 0.03, 4) for name in "AB"}
CUT, RINGS = ringed(PIN, ENDS), tuple(x for name in "AB" for x in rings(name, ENDS[name]))
LINKS = PinLoads("c", ("A", "B"), np.zeros((1, 2, 3)))


def on_rings(forces: list[float]) -> PinLoads:
    """The resultants of pressures with forces along x, N, on the rings."""
    areas = [CUT.band(name).area for name in RINGS]
    waves = np.zeros((2, 1, len(RINGS), 2))
    waves[1, 0, :, 0] = -2.0 * np.array(forces) / areas
    return resultants(CUT, RINGS, waves, LINKS)


def test_rings_that_press_at_other_instants_alone_are_felt() -> None:
    first, later = on_rings([1e4, 0, -1e4, 0, 0, 0]), on_rings([0, 1e4, 0, 0, -1e4, 0])
    largest = SectionField(CUT, STEEL, (), (later,)).largest(later)[0]
    assert largest > 0.0
    assert SectionField(CUT, STEEL, (), (first,)).largest(later)[0] == pytest.approx(largest)


def test_a_load_that_no_case_has_is_refused() -> None:
    first = on_rings([1e4, 0, -1e4, 0, 0, 0])
    weight = LoadAmounts("c", {UnitLoad("", "body", 1): np.ones((1, 2))}, 1)
    with pytest.raises(ArgumentError, match="no unit fields"):
        SectionField(CUT, STEEL, (), (first,)).largest(weight)
