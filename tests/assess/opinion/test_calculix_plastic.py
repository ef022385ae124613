"""The limit load in CalculiX, on the same mesh."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from assess.opinion.calculix_plastic import factor_reached, limit_opinion
from assess.opinion.opinions import MAX_LIMIT_LOAD_DIFFERENCE
from assess.plastic.pin_body import acting_at, pin_body
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexSize, twenty
from tests.support.exact.plastic import RULE, STEEL, D, limit

COARSE = HexSize(2, 0.5)


def test_nodes_of_other_programs_are_ours_in_another_order() -> None:
    assert sorted(twenty().tolist()) == list(range(20))


@pytest.mark.peers
def test_an_opinion_on_a_limit_load() -> None:
    """From loads aslant, on the first mesh."""
    parts = Segment(0.5 * D, 1.5 * D), Segment(1.5 * D, D), Segment(0.5 * D, D, connection="a")
    pin = Pin("p", parts, fillet=0.05 * D)
    loads = PinLoads("c", ("a",), np.array([[[600.0, 800.0, 0.0]]]))
    found = limit_opinion(pin, STEEL, ("start",), loads)
    assert found.difference == pytest.approx(0.0, abs=MAX_LIMIT_LOAD_DIFFERENCE)
    assert not found.complaint
    assert "limit load is" in replace(found, theirs=1.1 * (found.ours or 0.0)).complaint


def test_without_calculix_there_is_no_opinion(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    pin = Pin("p", (Segment(1.5 * D, D), Segment(0.5 * D, D, connection="a")))
    loads = PinLoads("c", ("a",), np.array([[[1e3, 0.0, 0.0]]]))
    assert "cannot be run" in limit_opinion(pin, STEEL, ("start",), loads).complaint


@pytest.mark.peers
@pytest.mark.slow
@pytest.mark.parametrize("aslant", [False, True])
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
