"""Pins in lugs where the answer is known: limits of fit, stiffness and load, and symmetries."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Bushing, Lug
from geometry import Pin, Segment
from tests.support.each import each
from tests.support.exact.layered_annulus import widening

E, NU, D, EYE, FORCE = 210e9, 0.3, 0.02, 0.05, 50e3
STEEL = Material("steel", E, NU)
ANY = Lug("any", EYE, STEEL)
NAMES = ("L", "M", "R")
SHARE = np.array([-0.5, 1.0, -0.5])
MIDDLE = np.array([0.023])
NOMINAL = FORCE / 2.0 * (0.005 + 0.001 + 0.005)


def clevis(change: Lug = ANY) -> ContactModel:
    """Lugs of 10, 20 and 10 mm, 1 mm apart, on a pin of 20 mm, all guided and as `change` is."""
    over, apart = Segment(0.002, D), Segment(0.001, D)
    left, middle, right = (
        Segment(t, D, connection=name) for t, name in zip((0.01, 0.02, 0.01), NAMES, strict=True)
    )
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    return ContactModel(pin, STEEL, [replace(change, connection=name) for name in NAMES])


def pull(share: Floats = SHARE, angle: float = 0.0) -> PinLoads:
    along = FORCE * np.array([math.cos(angle), math.sin(angle), 0.0])
    return PinLoads("pull", NAMES, (share[:, None] * along)[None])


def moment(found: JointContact, at: Floats = MIDDLE) -> float:
    return float(np.linalg.norm(found.bending_moment(at)[0, 0])) / NOMINAL


def require_conditions(found: JointContact, share: Floats = SHARE) -> None:
    """Pressures have the links' forces and no couple."""
    line = found.line_load[0] * found.bands.length[:, None]
    by_band = np.stack([line[found.bands.band == b].sum(axis=0) for b in range(len(share))])
    assert by_band[:, 0] == pytest.approx(share * FORCE, abs=1e-8 * FORCE)
    assert by_band[:, 1] == pytest.approx(0.0, abs=1e-8 * FORCE)
    assert found.bands.z @ line == pytest.approx([0.0, 0.0], abs=1e-8 * FORCE * D)


@pytest.mark.parametrize("bushing", [None, Bushing(0.002, Material("bronze", 100e9, 0.3))])
def test_interference_is_lames(bushing: Bushing | None) -> None:
    """Of a pin as thin as its eye, in plane stress: even to 0.5 %, and Lame's."""
    disc, size = Pin("P", (Segment(0.0004, D, connection="A"),)), 2e-5
    lug = Lug("A", EYE, STEEL, clearance=-size, bushing=bushing)
    model = ContactModel(disc, STEEL, [lug], Resolution(8, 12, 2, across=40.0))
    found = model.solve(PinLoads("none", ("A",), np.zeros((1, 1, 3))))
    walls = [(D / 2.0, EYE / 2.0, STEEL)]
    if bushing is not None:
        between = D / 2.0 + bushing.thickness
        walls = [(D / 2.0, between, bushing.material), (between, EYE / 2.0, STEEL)]
    flexible = widening(walls, 0, strain=False) + D / 2.0 * (1.0 - NU) / E
    assert found.contact[0].pressure == pytest.approx(size / 2.0 / flexible, rel=5e-3)
    assert found.contact[0].active.all()


def test_interference_that_stays_and_that_opens() -> None:
    """A tight fit is in contact all round under load; a slight one opens behind the pin."""
    tight, slight = (clevis(replace(ANY, clearance=-c)).solve(pull()) for c in (2e-4, 1e-6))
    require_conditions(tight)
    require_conditions(slight)
    assert tight.contact[0].active.all()
    assert not slight.contact[0].active.all()


def test_huge_clearance_is_in_equilibrium() -> None:
    """A tenth of the diameter: a line contact, where the load is."""
    found = clevis(replace(ANY, clearance=0.1 * D)).solve(pull())
    require_conditions(found)
    assert (np.degrees(found.contact_angle) < 20.0).all()


@each("size", [500.0, 50.0, 5.0])
def test_loads_that_hardly_close_the_clearance_settle(size: float) -> None:
    """Few cells of four lugs touch then, far from where the forces point."""
    over, names = Segment(0.002, D), "ABCD"
    lengths = 0.01, 0.02, 0.02, 0.01
    lugs = [Segment(t, D, connection=n) for n, t in zip(names, lengths, strict=True)]
    parts = [x for lug in lugs for x in (lug, Segment(0.001, D))]
    pin = Pin("P", (over, *parts, over))
    loose = [replace(ANY, connection=n, clearance=4e-5) for n in names]
    model = ContactModel(pin, STEEL, loose, Resolution(6, 24, 6))
    middles = model.contact.bands.middles
    unbalanced = np.stack([np.ones(4), middles - middles.mean()])
    forces = np.random.default_rng(7).normal(size=(4, 3)) * [1.0, 1.0, 0.0]
    forces -= np.linalg.pinv(unbalanced) @ unbalanced @ forces
    joint = model.solve(PinLoads("few", tuple(names), size * forces[None]))
    (found,) = joint.contact
    assert found.active.any()
    assert not found.pressure[~found.active].any()
    line = joint.line_load[0] * joint.bands.length[:, None]
    by_band = np.stack([line[joint.bands.band == b].sum(axis=0) for b in range(4)])
    assert by_band == pytest.approx(size * forces[:, :2], abs=1e-6 * size)


def test_loads_lost_in_round_off_say_so() -> None:
    model = clevis(replace(ANY, clearance=1e-3))
    with pytest.raises(SolveError) as refused:
        model.pressed(pull(1e-12 * SHARE))
    assert refused.value.code == "loads-too-small"


def test_a_lug_without_load() -> None:
    """The third link of three carries nothing; with clearance its eye takes no more than a couple,
    and the pin is in equilibrium without it.
    """
    share = np.array([-1.0, 1.0, 0.0])
    for clearance in (0.0, 1e-4):
        lug = replace(ANY, clearance=clearance)
        require_conditions(clevis(lug).solve(pull(share)), share)


def test_rigid_lugs() -> None:
    """A pin held at the lugs' edges, so that little bends: half of the nominal moment; what is
    stiffer by a hundred does no more.
    """
    stiff, stiffer = (
        clevis(replace(ANY, material=Material("rigid", k * E, NU))).solve(pull())
        for k in (1e4, 1e6)
    )
    require_conditions(stiff)
    assert moment(stiff) == pytest.approx(0.51, abs=0.06)
    assert moment(stiffer) == pytest.approx(moment(stiff), rel=1e-3)


def test_soft_lugs() -> None:
    """The pin is rigid beside them: even line loads but for the ends, and the nominal moment. What
    is softer by ten follows it in proportion of its motion.
    """
    soft = [
        clevis(replace(ANY, material=Material("soft", k * E, NU))).solve(pull())
        for k in (1e-3, 1e-4)
    ]
    require_conditions(soft[0])
    assert moment(soft[0]) == pytest.approx(1.0, abs=0.03)
    assert moment(soft[1]) == pytest.approx(moment(soft[0]), rel=5e-3)
    shifts = [float(found.contact[0].shift[1, 0] - found.contact[0].shift[0, 0]) for found in soft]
    assert shifts[1] == pytest.approx(10.0 * shifts[0], rel=0.01)


def test_two_halves_of_a_lug() -> None:
    """Side by side, with half of the force each: the moment at mid-span to 5 %, and more, because
    each eye gives way to a tilt by itself.
    """
    over, apart = Segment(0.002, D), Segment(0.001, D)
    ends = [Segment(0.01, D, connection=name) for name in ("L", "R")]
    half = [Segment(0.01, D, connection=name) for name in ("M1", "M2")]
    pin = Pin("P", (over, ends[0], apart, *half, apart, ends[1], over))
    names = ("L", "M1", "M2", "R")
    force = np.zeros((1, 4, 3))
    force[0, :, 0] = FORCE * np.array([-0.5, 0.5, 0.5, -0.5])
    split = ContactModel(pin, STEEL, [Lug(name, EYE, STEEL) for name in names])
    found = split.solve(PinLoads("pull", names, force))
    assert 1.0 < moment(found) / moment(clevis().solve(pull())) < 1.05
    first, second = found.largest_pressure[0, 1:3]
    assert first == pytest.approx(second, rel=0.02)


def test_mirrored_cases_are_mirrored() -> None:
    """About the plane of the load and about that across it to 1e-9, on cells that turn with it; end
    for end as far as the pin's mesh, which is not symmetric: 1 %.
    """
    model = clevis(replace(ANY, clearance=2e-5))
    found, turned = (model.solve(pull(angle=a)).contact[0] for a in (0.0, math.pi))
    one, other = found.pressure, turned.pressure
    assert abs(turned.angle - found.angle) == pytest.approx(math.pi)
    scale = one.max()
    mirrored = np.roll(one[:, ::-1], 1, axis=1)
    assert one == pytest.approx(mirrored, abs=1e-9 * scale)
    assert one == pytest.approx(other, abs=1e-9 * scale)
    assert one == pytest.approx(one[::-1], abs=0.01 * scale)


@pytest.mark.parametrize("clearance", [0.0, 5e-5])
def test_where_cells_are_cut_does_not_matter(clearance: float) -> None:
    """A load turned by parts of a sector: the moment within 0.2 %."""
    model = clevis(replace(ANY, clearance=clearance))
    sector = 2.0 * math.pi / 36
    found = [moment(model.solve(pull(angle=k * sector))) for k in (0.0, 0.25, 0.5, 0.8)]
    assert found == pytest.approx([found[0]] * 4, rel=2e-3)
