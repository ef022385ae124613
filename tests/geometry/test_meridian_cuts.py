"""Where the reaches of two spots meet on an edge there is one cut, not two."""

from __future__ import annotations

import numpy as np

from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, Spot, meridian_mesh


def test_reaches_that_meet_leave_no_edge_of_nought() -> None:
    """The face of a shoulder from 20 to 30 mm, with a tenth of each diameter left out at its ends:
    10 + 2 = 15 - 3 mm but for round-off. (Found by fuzzing.)
    """
    pin = Pin("P", (Segment(0.055, 0.02), Segment(0.015, 0.03)))
    spots = [Spot(0.01, 0.055, 1e-3, 0.1 * 0.02), Spot(0.015, 0.055, 1e-3, 0.1 * 0.03)]
    space = Section(meridian_mesh(pin, SectionSize(), spots))
    x = space.nodes[Outline(space).nodes]
    assert np.linalg.norm(x[:, 0] - x[:, 1], axis=1).min() > 1e-6
