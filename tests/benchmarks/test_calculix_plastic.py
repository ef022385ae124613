"""The limit load in CalculiX, on the same mesh."""

from pathlib import Path

import numpy as np
import pytest

from assess.plastic.pin_body import acting_at, pin_body
from benchmarks.pins.calculix_plastic import factor_reached
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexSize, twenty
from tests.support.each import sampled
from tests.support.exact.plastic import RULE, D, limit

COARSE = HexSize(2, 0.5)


def test_nodes_of_other_programs_are_ours_in_another_order() -> None:
    assert sorted(twenty().tolist()) == list(range(20))


@pytest.mark.peers
@pytest.mark.slow
@pytest.mark.parametrize("aslant", sampled([True, False], every=2))
def test_limit_load_as_in_calculix(tmp_path: Path, aslant: bool) -> None:
    """aslant: two forces in different planes, of which half the pin is modelled by half a turn."""
    a, b = (Segment(0.5 * D, D, connection=name) for name in "ab")
    pin = Pin("p", (Segment(1.5 * D, D), a, b))
    forces = np.array([[[1e3, 0.0, 0.0], [0.0, 1e3 if aslant else 0.0, 0.0]]])
    loads = PinLoads("c", ("a", "b"), forces)
    made = pin_body(pin, RULE, ("start",), acting_at(loads, 0), COARSE)
    assert made.sector.quarters == (2 if aslant else 1)
    ours = limit(pin, loads, COARSE, ("start",))
    theirs = factor_reached(made, 1.05 * ours.reached, tmp_path)
    assert theirs == pytest.approx(ours.reached, rel=1e-2)
