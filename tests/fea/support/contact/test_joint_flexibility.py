"""Flexibilities of pins and lugs against exact discs and tubes, and clevises against contact in
three dimensions.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState
from fea.support.contact.flexibility import half_plane, lug_rings, pin_rings
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from geometry.shape.rings import annulus, graded, ring, ringed
from tests.support.each import each

E, NU = 210e9, 0.3
STEEL = Material("steel", E, NU)


def test_rings_fill_the_band_and_keep_the_shape() -> None:
    pin = Pin(
        "P",
        (Segment(0.03, 0.05), Segment(0.04, 0.03, 0.01, connection="A"), Segment(0.02, 0.05)),
        fillet=0.004,
    )
    whole = pin.band("A")
    cut = ringed(pin, {"A": graded(whole.length, 6)})
    assert cut.volume == pytest.approx(pin.volume, rel=1e-12)
    assert cut.length == pytest.approx(pin.length)
    bands = [cut.band(ring("A", i)) for i in range(6)]
    assert (bands[0].z0, bands[-1].z1) == pytest.approx((whole.z0, whole.z1))
    assert [b.z0 for b in bands[1:]] == pytest.approx([b.z1 for b in bands[:-1]])
    assert bands[0].length < bands[2].length
    assert [b.length for b in bands] == pytest.approx(np.diff(graded(whole.length, 6)))


@each("n", [0, 2, 3, 6])
def test_a_thin_disc_is_the_plane_ones(n: int) -> None:
    """R / (4 mu) [k / (n + 1) + 1 / (n - 1)] in plane stress, R (1 - nu) / E for n = 0."""
    r, t = 0.01, 0.0002
    mu, k = E / 2.0 / (1.0 + NU), (3.0 - NU) / (1.0 + NU)
    exact = r * (1.0 - NU) / E if n == 0 else r / (4.0 * mu) * (k / (n + 1) + 1.0 / (n - 1))
    disc = Pin("disc", (Segment(t, 2.0 * r, connection="A"),))
    found = pin_rings(disc, ["A"], STEEL, 24.0).flexibility(n)[n, 0, 0]
    assert found == pytest.approx(exact, rel=2e-3)


def test_an_even_pressure_in_a_lug_is_lames() -> None:
    """u = p r / E [(D^2 + d^2) / (D^2 - d^2) + nu] with free faces, whatever the length."""
    pin = Pin("P", (Segment(0.02, 0.02, connection="A"),))
    lug = Lug("A", 0.05, STEEL)
    flexible = lug_rings(annulus(pin, "A", 0.05, graded(0.02, 4)), lug, 8.0).flexibility(0)[0]
    moved = flexible.sum(axis=1)  # an even pressure on all rings
    ratio = (0.05**2 + 0.02**2) / (0.05**2 - 0.02**2)
    assert moved == pytest.approx(0.01 / E * (ratio + NU), rel=1e-4)


def test_flexibilities_are_symmetric_and_positive() -> None:
    """By Betti, in the work of pressures: C times the length of the ring that moves."""
    whole = Pin("P", (Segment(0.01, 0.02), Segment(0.03, 0.02, connection="A")))
    rings = [ring("A", i) for i in range(5)]
    ends = graded(0.03, 5)
    lengths = np.diff(ends)
    pin = pin_rings(ringed(whole, {"A": ends}), rings, STEEL, 8.0).flexibility(4)
    lug = lug_rings(annulus(whole, "A", 0.05, ends), Lug("A", 0.05, STEEL), 6.0).flexibility(4)
    for found in (pin, lug):
        work = found * lengths[None, :, None]
        assert work == pytest.approx(work.swapaxes(1, 2), rel=1e-12)
        values = np.linalg.eigvalsh(work)
        assert values.min() > -1e-9 * values.max()


# Clevises in three-dimensional contact (two programs, frictionless, E = 210 GPa, nu = 0.3, d = 20,
# eyes of 50, shank of 50 clamped 50 mm away, 50 kN): thickness of the inner and the outer lugs,
# gap, diametral clearance, all mm; bending moment at mid-span over F/2 (t_o/2 + g + t_i/4).
CLEVISES = [
    (20, 10, 1, 0.0, 0.8418),
    (20, 10, 1, 0.02, 0.8433),
    (20, 10, 1, 0.05, 0.8476),
    (20, 10, 1, 0.1, 0.8574),
    (10, 5, 0.5, 0.0, 0.9483),
    (10, 5, 0.5, 0.05, 0.9500),
    (40, 20, 2, 0.0, 0.3845),
    (40, 20, 2, 0.05, 0.4197),
]
LUGS, RINGS, SECTORS, HIGHEST, FORCE = ("L", "M", "R"), 8, 36, 12, 50e3
D, EYE, ARM = 0.02, 0.05, 0.04  # pin, eye; where the eye ends its shank bends over this length


def clevis(inner: float, outer: float, gap: float) -> tuple[Pin, Bands, Floats]:
    """Pin, rings and flexibility."""
    over = Segment(0.002, D)
    apart = Segment(gap, D)
    left, middle, right = (
        Segment(t, D, connection=name) for t, name in zip((outer, inner, outer), LUGS, strict=True)
    )
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    ends = {name: graded(pin.band(name).length, RINGS) for name in LUGS}
    cut = ringed(pin, ends)
    rings = [ring(name, i) for name in LUGS for i in range(RINGS)]
    flexible = pin_rings(cut, rings, STEEL, 10.0).flexibility(HIGHEST)
    for b, name in enumerate(LUGS):
        own = slice(b * RINGS, (b + 1) * RINGS)
        eye = annulus(pin, name, EYE, ends[name])
        flexible[:, own, own] += lug_rings(eye, Lug(name, EYE, STEEL), 5.0).flexibility(HIGHEST)
    bands = [cut.band(name) for name in rings]
    z, length = np.array([b.middle for b in bands]), np.array([b.length for b in bands])
    radius = np.full(len(rings), D / 2.0)
    return pin, Bands(z, length, radius, np.repeat(range(3), RINGS), 0.0 * z), flexible


def pressed(
    inner: float, outer: float, gap: float, clearance: float
) -> tuple[ContactProblem, ContactState]:
    _, bands, flexible = clevis(inner, outer, gap)
    tilt = E * EYE * outer**3 / (12.0 * ARM)
    open_ = Bands(bands.z, bands.length, bands.radius, bands.band, bands.gap + clearance / 2.0)
    tail = np.full(len(bands.z), 2.0 * half_plane(STEEL, D / 2.0))
    contact = ContactProblem(open_, flexible, tail, [tilt, math.inf, tilt], SECTORS)
    forces = np.array([[-0.5, 0.0], [1.0, 0.0], [-0.5, 0.0]]) * FORCE
    return contact, contact.solve(forces)


@pytest.mark.parametrize(("inner", "outer", "gap", "clearance", "moment"), CLEVISES)
def test_the_bending_moment_of_a_clevis(
    inner: float, outer: float, gap: float, clearance: float, moment: float
) -> None:
    """Within 0.03 of contact in three dimensions; the clamp and the even pressure are off by 0.2 to
    0.6. What is left is the shank, which the annulus has not.
    """
    contact, found = pressed(inner / 1e3, outer / 1e3, gap / 1e3, clearance / 1e3)
    bands = contact.bands
    along = (found.pressure * contact.area.reshape(found.pressure.shape)) @ np.cos(contact.angles)
    along *= np.sinc(1.0 / SECTORS)
    middle = bands.middles[1]
    left = bands.z < middle
    bending = float((along * (middle - bands.z))[left].sum())
    nominal = FORCE / 2.0 * (outer / 2.0 + gap + inner / 4.0) / 1e3
    assert abs(bending) / nominal == pytest.approx(moment, abs=0.03)
