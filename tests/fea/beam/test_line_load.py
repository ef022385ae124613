"""Loads per length of a beam, and the balance of one that nothing holds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.beam.line_load import shares
from fea.beam.timoshenko import MOMENT, SHEAR, stepped_beam
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import BODY_SURFACE, PinLoads, UnitLoad
from geometry import ArgumentError, Pin, Segment
from tests.support.errors import raises
from tests.support.pins.plain_pins import COUPLE, PLAIN, PULL, SPIN, A, B, L, d, double_shear


def test_three_bands_in_balance_by_statics(steel: Material) -> None:
    """Double shear: F at the middle, half at each side. V = F/2 in the gaps, and in the middle
    M = F/2 (b/2 + g + c/2) - F/2 c/4 (bands b, gaps g, middle band c).
    """
    b, g, c, F = 0.02, 0.005, 0.03, 1000.0
    pin = double_shear(b, g, c, d)
    loads = PinLoads(
        "case", ("A", "B", "C"), np.array([[[0, -F / 2, 0], [0, F, 0], [0, -F / 2, 0]]])
    )
    units = tuple(loads.coefficients())
    forces = stepped_beam(pin, steel, units)
    in_y = shares(units, loads)[0, 1]
    z = np.array([b, b + g, b + g + c / 2, b + g + c])
    V, M = (forces.at(z)[:, i] @ in_y for i in (SHEAR, MOMENT))
    assert pytest.approx([F / 2, F / 2, 0.0, -F / 2], abs=1e-9 * F) == V
    middle = F / 2 * (b / 2 + g + c / 2) - F / 2 * c / 4
    assert pytest.approx([F * b / 4, F * b / 4 + F / 2 * g, middle], rel=1e-9) == -M[:3]
    assert forces.at(np.array([0.0, pin.length])) == pytest.approx(0.0, abs=1e-9)


def test_what_is_out_of_balance_is_closed_by_all_bands(steel: Material) -> None:
    """One band over the whole pin: its own unit load is taken back where it acts, and a couple
    too; weight, spread as the closing traction is, leaves nothing either.
    """
    units = (
        B,
        COUPLE,
        PULL,
        SPIN,
        UnitLoad(BODY_SURFACE, "body", 1),
        UnitLoad(BODY_SURFACE, "body", 0),
    )
    forces = stepped_beam(PLAIN, steel, units)
    assert np.abs(forces.coefficients[:, 0]).max() < 1e-12
    z = np.linspace(0.0, L, 7)
    assert np.abs(forces.at(z)).max() < 1e-12
    two = Pin(
        "P",
        (Segment(L / 3, d, connection="B"), Segment(L / 3, d), Segment(L / 3, d, connection="C")),
    )
    weight = stepped_beam(two, steel, (UnitLoad(BODY_SURFACE, "body", 1),)).at(
        np.array([L / 3, L / 2, L])
    )
    w = 7850.0 * A
    # w L is carried by the bands, 3 w / 2 per length; half of the middle third hangs on each
    assert weight[:, SHEAR, 0] == pytest.approx([w * L / 6, 0.0, 0.0], abs=1e-9 * w)
    assert weight[1, MOMENT, 0] == pytest.approx(-w * L * L / 24, rel=1e-9)


def test_weight_needs_density(steel: Material) -> None:
    with raises(SolveError, "no-density"):
        stepped_beam(
            PLAIN, replace(steel, density=None), (UnitLoad(BODY_SURFACE, "body", 0),), ("start",)
        )


def test_harmonics_that_no_section_feels(steel: Material) -> None:
    units = (*(UnitLoad("B", "pressure", n) for n in (0, 2, 4, 1)), B)
    c = stepped_beam(PLAIN, steel, units, ("start",)).coefficients
    assert not c[..., :3].any()
    assert c[..., 3] == pytest.approx(c[..., 4], rel=1e-12)
    loads = PinLoads("case", ("B",), np.array([[[3.0, -4.0, 0.0]]]), distribution="cosine")
    assert shares((UnitLoad("B", "pressure", 1),), loads)[0, :, 0] == pytest.approx([3.0, -4.0])
    with raises(ArgumentError, "missing-fields"):
        shares((B,), loads)


def test_a_balance_needs_a_band(steel: Material) -> None:
    """Of a pin that no link touches and nothing holds, under its own weight."""
    with raises(SolveError, "unconstrained", "pin P"):
        stepped_beam(Pin("P", (Segment(L, d),)), steel, (UnitLoad(BODY_SURFACE, "body", 1),))
