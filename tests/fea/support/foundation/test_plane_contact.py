"""Plane contact of pin and eye: its harmonics against finite elements and exact limits."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.tractions import Traction
from fea.harmonic.assembly import around
from fea.harmonic.model import HarmonicModel, body_force
from fea.support.contact.flexibility import half_plane, lug_rings, pin_rings
from fea.support.foundation.plane_contact import (
    MAX_PLANE_HARMONIC,
    lug_harmonics,
    pin_harmonics,
    plane_stiffness,
)
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.shape.rings import annulus
from tests.support.exact.layered_annulus import widening

STEEL = Material("steel", 210e9, 0.3)
EVEN = Material("no lateral strain", 210e9, 0.0, density=1.0)  # plane in any length
TUBE = Pin("P", (Segment(0.02, 0.02, 0.01, connection="A"),))
SOLID = Pin("P", (Segment(0.02, 0.02, connection="A"),))


def test_a_lug_is_that_of_finite_elements() -> None:
    found = lug_rings(
        annulus(TUBE, "A", 0.05, np.array([0.0, 0.02])), Lug("A", 0.05, EVEN), 20.0
    ).flexibility(6)[:, 0, 0]
    assert lug_harmonics(0.01, 0.025, EVEN)[:7] == pytest.approx(found, rel=1e-3)


def test_a_lug_that_contracts_is_the_exact_annulus() -> None:
    """In displacements in place of Michell's stresses, for any Poisson's ratio."""
    for material in (STEEL, Material("rubbery", 1e9, 0.45)):
        exact = [widening([(0.01, 0.025, material)], n, strain=True) for n in range(7)]
        assert lug_harmonics(0.01, 0.025, material)[:7] == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(("pin", "bore"), [(TUBE, 0.005), (SOLID, 0.0)])
def test_a_pin_is_that_of_finite_elements(pin: Pin, bore: float) -> None:
    """But for n = 1, which is below."""
    found = pin_rings(pin, ["A"], EVEN, 20.0).flexibility(6)[:, 0, 0]
    ours = pin_harmonics(bore, 0.01, EVEN)[:7]
    assert np.delete(ours, 1) == pytest.approx(np.delete(found, 1), rel=1e-3)


@pytest.mark.parametrize(("pin", "bore"), [(TUBE, 0.005), (SOLID, 0.0)])
def test_a_section_held_by_a_body_force(pin: Pin, bore: float) -> None:
    """n = 1: the work of a pressure and the body force that balances it is that of the surface's
    motion against the mean of the section.
    """
    model = HarmonicModel(pin, meridian_mesh(pin, SectionSize(20.0)), EVEN, ())
    model.pivot = 0.5
    inwards = (Traction("A", 0.0, np.array([-1.0, 0.0, 0.0]), np.zeros(3)),)
    pressure, body = (
        model.forces(1, [inwards])[:, 0],
        body_force(model.material, 1, model.space.integrals).ravel(),
    )
    factor = np.pi * 0.01 * 0.02 / (pin.volume * EVEN.density)  # type: ignore[operator]
    both = (pressure + factor * body)[:, None]
    work = float((both.T @ model.displace(1, both)).item()) / around(1)
    assert pin_harmonics(bore, 0.01, EVEN)[1] == pytest.approx(work / (0.01 * 0.02), rel=1e-5)


def test_high_harmonics_are_the_half_planes() -> None:
    n = np.arange(MAX_PLANE_HARMONIC + 1)
    for found in (pin_harmonics(0.004, 0.01, STEEL), lug_harmonics(0.01, 0.03, STEEL)):
        assert (n * found)[-1] == pytest.approx(half_plane(STEEL, 0.01), rel=0.05)


def test_the_stiffness_does_not_depend_on_size() -> None:
    """Only on proportions, and on the moduli in common."""
    soft = Material("soft", 105e9, 0.3)
    one = plane_stiffness((0.004, 0.01), STEEL, 0.025, STEEL)
    assert plane_stiffness((0.0004, 0.001), STEEL, 0.0025, STEEL) == pytest.approx(one, rel=1e-9)
    assert plane_stiffness((0.004, 0.01), soft, 0.025, soft) == pytest.approx(one / 2.0, rel=1e-9)


def test_what_makes_it_soft() -> None:
    """A wide bore, a narrow or a soft lug."""
    plain = plane_stiffness((0.0, 0.01), STEEL, 0.025, STEEL)
    soft = Material("soft", 70e9, 0.3)
    assert plane_stiffness((0.007, 0.01), STEEL, 0.025, STEEL) < 0.7 * plain
    assert plane_stiffness((0.0, 0.01), STEEL, 0.016, STEEL) < 0.9 * plain
    assert plane_stiffness((0.0, 0.01), STEEL, 0.025, soft) < 0.6 * plain
