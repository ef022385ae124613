"""Lugs with bushings: exact plane annuli of two rings, and the limits of none."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.harmonic.assembly import Section
from fea.support.contact.flexibility import half_plane, layered, lug_rings, wavy_flexibility
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Bushing, Lug
from geometry import Pin, Segment
from geometry.mesh.eye_mesh import eye_mesh
from geometry.shape.rings import annulus, graded
from tests.support.each import each
from tests.support.exact.layered_annulus import widening

STEEL, BRONZE = Material("steel", 210e9, 0.3), Material("bronze", 100e9, 0.34)
RIGID_BUSH = Material("hard", 600e9, 0.2)
A, C, B = 0.01, 0.012, 0.025  # radii of bore, interface and outside


def lug(thickness: float | None, material: Material = BRONZE) -> Lug:
    bushing = None if thickness is None else Bushing(thickness, material)
    return Lug("A", 2.0 * B, STEEL, bushing=bushing)


def flexibility(of: Lug, ends: Floats, highest: int, across: float = 20.0) -> Floats:
    pin = Pin("P", (Segment(float(ends[-1]), 2.0 * A, connection="A"),))
    return lug_rings(annulus(pin, "A", of.outer_diameter, ends), of, across).flexibility(highest)


def test_the_exact_annulus_is_lames_and_muskhelishvilis() -> None:
    """Of one material, with free outside; of a hole in a plate, R / (4 mu) [k / (n - 1) + 1 /
    (n + 1)] in plane stress.
    """
    one = [(A, B, STEEL)]
    ratio = (B**2 + A**2) / (B**2 - A**2)
    assert widening(one, 0, strain=False) == pytest.approx(A / 210e9 * (ratio + 0.3), rel=1e-9)
    mu, k = 210e9 / 2.6, (3.0 - 0.3) / 1.3
    for n in (3, 6):
        plate = A / (4.0 * mu) * (k / (n - 1) + 1.0 / (n + 1))
        assert widening([(A, 1e3 * A, STEEL)], n, strain=False) == pytest.approx(plate, rel=1e-6)
    for n in range(7):
        split = widening([(A, C, STEEL), (C, B, STEEL)], n, strain=True)
        assert split == pytest.approx(widening(one, n, strain=True), rel=1e-9)


@each("n", range(7))
def test_a_thin_lug_is_an_annulus_in_plane_stress(n: int) -> None:
    """Two rings, within 0.5 %; for n = 0 Lame's compound tube, for n = 1 with the reaction."""
    exact = widening([(A, C, BRONZE), (C, B, STEEL)], n, strain=False)
    found = flexibility(lug(C - A), graded(0.0002, 1), n)[n]
    assert found.sum(axis=1) == pytest.approx(exact, rel=5e-3)


@pytest.mark.parametrize("material", [BRONZE, RIGID_BUSH])
def test_the_middle_of_a_long_lug_is_in_plane_strain(material: Material) -> None:
    """For n = 2 to 6 within 0.2 %. Under n = 0 and 1 what free ends leave of the axial stress
    strains all of the length.
    """
    ends = np.array([0.0, 0.04, 0.06, 0.1])
    found = flexibility(lug(C - A, material), ends, 6)[2:, 1].sum(axis=1)
    exact = [widening([(A, C, material), (C, B, STEEL)], n, strain=True) for n in range(2, 7)]
    assert found == pytest.approx(exact, rel=2e-3)


def test_parts_of_one_material_are_one() -> None:
    """On one mesh, to 1e-12."""
    pin = Pin("P", (Segment(0.02, 2.0 * A, connection="A"),))
    eye = annulus(pin, "A", 2.0 * B, graded(0.02, 4))
    mesh = eye_mesh(eye, 10.0, C)
    inner = (mesh.mesh.p[0, mesh.mesh.t].mean(axis=0) < C).astype(np.int64)
    assert 0 < inner.sum() < len(inner)
    alone, both = Section(mesh), Section(mesh, inner)
    for n in (0, 1, 5):
        one, two = alone.stiffness(STEEL, n), both.stiffness((STEEL, STEEL), n)
        assert abs(one - two).max() <= 1e-12 * abs(one).max()
        mixed = both.stiffness((STEEL, BRONZE), n)
        swapped = both.stiffness((BRONZE, STEEL), n)
        summed = alone.stiffness(BRONZE, n) + one
        assert abs(mixed + swapped - summed).max() <= 1e-12 * abs(one).max()


def test_a_bushing_of_the_lugs_material_is_none() -> None:
    """But for what the mesh does, which ends at the interface: 0.3 %."""
    ends = graded(0.02, 6)
    none, same = flexibility(lug(None), ends, 6), flexibility(lug(C - A, STEEL), ends, 6)
    assert same == pytest.approx(none, rel=3e-3, abs=3e-3 * none.max())
    waves = np.arange(13, 40)
    without, with_it = (
        wavy_flexibility(x, STEEL, A, ends, waves).sum(axis=0)
        for x in (lug(None), lug(C - A, STEEL))
    )
    assert with_it == pytest.approx(without, rel=1e-12)


def test_a_thin_bushing_does_little() -> None:
    """In proportion to its thickness."""
    ends = graded(0.02, 6)
    none = flexibility(lug(None), ends, 3)[2].sum()
    more = [flexibility(lug(t), ends, 3)[2].sum() / none - 1.0 for t in (2e-5, 2e-4)]
    assert 0.0 < more[0] < 0.004
    assert more[1] == pytest.approx(10.0 * more[0], rel=0.25)


@each("thickness", [0.0005, 0.002])
@each("material", [BRONZE, Material("soft", 21e9, 0.45), RIGID_BUSH])
def test_high_harmonics_of_a_bushing(thickness: float, material: Material) -> None:
    """A layer on a half-plane is the annulus to 7 % at n = 13 and 2 % at 40, as 1 / n."""
    rings = [(A, A + thickness, material), (A + thickness, B, STEEL)]
    for n, within in ((13, 0.07), (40, 0.025)):
        exact = widening(rings, n, strain=True)
        found = layered(lug(thickness, material), n / A) * half_plane(material, A) / n
        assert found == pytest.approx(exact, rel=within)


def test_high_harmonics_are_a_half_spaces() -> None:
    """Where elasticity of harmonic 16 is computed: on even pressure in mid-length 3 %, at the
    lug's faces, which are free and not held by a mirror, 15 %.
    """
    ends = graded(0.02, 8)
    rigid = Material("rigid", 210e20, 0.3)
    found = flexibility(lug(None), ends, 16, across=40.0)[16].sum(axis=1)
    wavy = wavy_flexibility(lug(None), rigid, A, ends, np.array([16])).sum(axis=0)[0].sum(axis=1)
    assert found[3:5] == pytest.approx(wavy[3:5], rel=0.03)
    assert found[[0, -1]] == pytest.approx(wavy[[0, -1]], rel=0.15)
    assert wavy == pytest.approx(half_plane(STEEL, A) / 16, rel=1e-9)  # as long as all is pressed


def test_a_soft_bushing_softens_the_joint() -> None:
    """It spreads the load of a press along the pin and lowers the largest pressure."""
    over, band = Segment(0.002, 2.0 * A), Segment(0.01, 2.0 * A, connection="A")
    apart, other = Segment(0.001, 2.0 * A), Segment(0.01, 2.0 * A, connection="B")
    pin = Pin("P", (over, band, apart, other, over))
    force = np.array([[[1e4, 0.0, 0.0], [-1e4, 0.0, 0.0]]])
    loads, found = PinLoads("pull", ("A", "B"), force), []
    for bushing in (None, Bushing(0.002, Material("soft", 5e9, 0.4))):
        lugs = [Lug(name, 2.0 * B, STEEL, 2e-5, bushing=bushing) for name in ("A", "B")]
        found.append(ContactModel(pin, STEEL, lugs).solve(loads))
    bare, soft = found
    assert (soft.largest_pressure < 0.8 * bare.largest_pressure).all()
    assert (soft.contact_angle > bare.contact_angle).all()
