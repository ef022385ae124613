"""Positions of the drive of a linkage in space: rows of pins had that at the start of the motion,
and largest forces none, which plots drew at zero.
"""

from __future__ import annotations

import math

import pytest

import pinstress
from tests.conftest import ROOT


def _angle(time: float) -> float:
    """Return the angle of the cycloidal drive of slewing_crank.toml at a time (s), degrees."""
    return 90.0 * (time - math.sin(2.0 * math.pi * time) / (2.0 * math.pi))


def test_positions_are_those_at_the_time_of_the_maximum() -> None:
    study = pinstress.load_study(ROOT / "studies" / "slewing_crank.toml")
    results = pinstress.run(study, tolerance=0.1)
    (pin,), (table,) = results.pins, results.reactions
    assert pin.position_unit == "deg"
    assert pin.time is not None
    assert 0.1 < pin.time < 0.9
    assert pin.position == pytest.approx(_angle(pin.time), rel=1e-6)
    for peak in table.largest:
        assert peak.time is not None
        assert peak.position == pytest.approx(_angle(peak.time), rel=1e-6)
