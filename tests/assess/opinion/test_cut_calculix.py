"""Local solids beside CalculiX, which solves the whole pin on another mesh."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.cuts.cut_calculix import in_calculix
from benchmarks.random_pins import STEEL
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from geometry import CutPin, Hole
from tests.support.each import sampled
from tests.support.pins.plain_pins import TWICE


@pytest.mark.long
@pytest.mark.peers
@pytest.mark.parametrize("z", sampled([0.04, 0.025], every=2))
def test_a_hole_between_two_clamps(z: float) -> None:
    """In the shaft, and in the band that a force pulls along; averaged stress of CalculiX on this
    mesh is known to some per cent.
    """
    pin = CutPin(TWICE, (Hole(z, 0.006, 0.3),))
    loads = PinLoads("pull", ("B",), np.array([[[0.0, 0.0, 40e3]]]))
    clamps = ("start", "end")
    (ours,) = solve_pin(pin, STEEL, clamps, (loads,), Requirement(0.01))
    assert ours.peak.model == "harmonic+local"
    theirs = in_calculix(pin, clamps, loads, 2.0**0.5)
    assert ours.peak.max_von_mises == pytest.approx(theirs.maximum, rel=0.06)
