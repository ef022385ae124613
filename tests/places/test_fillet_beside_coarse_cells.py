"""A fillet that is shorter than the cells beside it is read nevertheless."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.harmonic.field import HarmonicField
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import singularities_of
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment

D, F, RHO = 0.02, 30e3, 0.001
STEEL = Material("steel", 2.1e11, 0.3)
PULL = PinLoads("pull", tuple("ABC"), F * np.outer([-0.5, 1.0, -0.5], np.eye(3)[0])[None])
ROUGH, FINE = Resolution(4, 24, 8), Resolution(16, 64, 20)
TRUTH = 290e6  # Pa, on 16 rings of a lug; 287 on 12


@pytest.mark.parametrize("cells", [ROUGH, pytest.param(FINE, marks=pytest.mark.slow)])
def test_it_is_found_on_any_cells(cells: Resolution) -> None:
    """Fillets of 0.05 d that begin 0.005 d from the outer lugs, 0.05 d from the middle one. Rough
    cells would end in rings of 0.07 and 0.14 d, and a lug presses on either side of each fillet:
    with no part of these rings cut for it, 134 MPa were left within a ring's length of both.
    """
    gap = 1.1 * RHO
    pin = Pin(
        "P",
        (
            *(Segment(0.004, D), Segment(0.01, D, connection="A"), Segment(gap, D, fillet=RHO)),
            *(Segment(0.001, 1.15 * D), Segment(0.02, 1.15 * D, connection="B")),
            *(Segment(0.001, 1.15 * D, fillet=RHO), Segment(gap, D)),
            *(Segment(0.01, D, connection="C"), Segment(0.004, D)),
        ),
    )
    tilts = zip("ABC", (math.inf, 0.0, math.inf), strict=True)
    lugs = [Lug(n, 0.06, STEEL, 2e-5, 0.0, tilt) for n, tilt in tilts]
    model = ContactModel(pin, STEEL, lugs, cells)
    loads = model.solve(PULL).loads
    zones = singularities_of(model.pin, STEEL, (), (loads,))
    posed = SectionProblem(model.pin, STEEL, (), (loads,), zones, model.first)
    answer = HarmonicField(harmonic_solution(posed, 0, 1.0), zones)
    assert answer.largest(loads)[0] == pytest.approx(TRUTH, rel=0.04)
