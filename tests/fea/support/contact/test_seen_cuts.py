"""Contact that sees the cuts of a pin, on rough cells."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.cut import compliance
from fea.support.contact.contact_state import ContactState
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Bushing, Lug
from geometry import Cut, CutPin, Flat, Hole
from pinbase.arrays import Floats
from pinbase.memo import Memo
from tests.support.each import sampled
from tests.support.pins.plain_pins import CLEVIS

D, F = 0.02, 50e3
STEEL, BRONZE = Material("steel", 2.1e11, 0.3), Material("bronze", 1.1e11, 0.34)
TIGHT = tuple(
    Lug(n, 0.05, STEEL, 0.0, 0.0, t) for n, t in zip("ABC", (2e5, math.inf, 2e5), strict=True)
)
LOOSE = tuple(replace(lug, clearance=5e-5) for lug in TIGHT)
LINED = tuple(replace(lug, bushing=Bushing(0.002, BRONZE)) for lug in LOOSE)
KINDS = {"tight": TIGHT, "loose": LOOSE, "bushing": LINED}
ROUGH, MEMO = Resolution(4, 24, 8), Memo()
FLAT = Flat(0.0165, 0.0295, D / 2.0 * math.cos(math.pi / 6.0), math.pi, 0.001)
HOLE = Hole(0.007, 0.3 * D)


def pull(*angles: float) -> PinLoads:
    """The clevis's loads in some directions, rad, one after the other."""
    along = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)
    forces = F * along[:, None] * np.array([-0.5, 1.0, -0.5])[:, None]
    return PinLoads("pull", ("A", "B", "C"), forces, times=np.arange(float(len(angles))))


def model(lugs: tuple[Lug, ...], *cuts: Cut) -> ContactModel:
    """The clevis with some cuts."""
    plain = ContactModel(CLEVIS, STEEL, lugs, ROUGH, MEMO)
    return plain.seeing(CutPin(CLEVIS, cuts)) if cuts else plain


def cells(of: ContactModel, state: ContactState) -> tuple[Floats, Floats]:
    """The forces (R, M, 2) of the cells on the pin, and their middles (R, M, 3)."""
    turns = of.contact.angles + state.angle
    e_r = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    mean = np.sinc(1.0 / len(turns))
    force = -mean * (state.pressure * of.contact.area.reshape(state.pressure.shape))[..., None]
    radius, z = of.bands.radius, of.bands.z
    x = np.concatenate(
        [
            radius[:, None, None] * e_r,
            np.broadcast_to(z[:, None, None], (len(z), len(turns), 1)),
        ],
        axis=2,
    )
    return force * e_r, x


def moment(of: ContactModel, state: ContactState) -> float:
    """The bending moment amid the pin, N m."""
    force, x = cells(of, state)
    arm = np.maximum(0.5 * CLEVIS.length - x[..., 2], 0.0)
    return float(np.linalg.norm(np.einsum("rma,rm->a", force, arm)))


@pytest.mark.slow
@pytest.mark.parametrize("kind", sampled(KINDS, every=3, first=2))
def test_a_flat_does_not_press_and_softens_the_pin(kind: str) -> None:
    """Nothing presses on it, every lug still has its force, and the lever of the forces becomes
    shorter; another cut in another lug shortens it more.
    """
    lugs = KINDS[kind]
    plain, cut, both = model(lugs), model(lugs, FLAT), model(lugs, FLAT, HOLE)
    moments = []
    for of in (plain, cut, both):
        (state,) = of.pressed(pull(0.0))
        force, x = cells(of, state)
        for b, share in enumerate((-0.5, 1.0, -0.5)):
            total = force[of.bands.band == b].sum(axis=(0, 1))
            assert total == pytest.approx([share * F, 0.0], abs=1e-6 * F)
        inside = FLAT.takes(x.reshape(-1, 3), D / 2.0).reshape(state.pressure.shape)
        deep = inside & (np.abs(x[..., 2] - 0.023) < 0.004) & (x[..., 0] < -0.9 * D / 2.0)
        assert deep.any()
        assert (state.pressure[deep].max() > 0.0) == (of is plain)
        moments.append(moment(of, state))
    assert moments[1] < 0.97 * moments[0]
    assert moments[2] < 0.999 * moments[1]


@pytest.mark.slow
def test_a_joint_that_is_turned_with_its_cut_is_the_same() -> None:
    """The cells keep to the cut. A load that turns is solved at every instant as it is alone."""
    turned = replace(FLAT, angle=FLAT.angle + 0.7)
    one, other = model(LOOSE, FLAT), model(LOOSE, turned)
    directions = 0.0, 0.4, 1.5
    states = one.pressed(pull(*directions))
    again = other.pressed(pull(*(a + 0.7 for a in directions)))
    for direction, x, y in zip(directions, states, again, strict=True):
        (alone,) = one.pressed(pull(direction))
        largest = x.pressure.max()
        assert x.pressure == pytest.approx(y.pressure, abs=1e-4 * largest)
        assert x.pressure == pytest.approx(alone.pressure, abs=1e-6 * largest)
    moments = [moment(one, x) for x in states]
    assert moments[0] < 0.98 * max(moments)  # the flat faces the load


def test_cuts_add_compliance_each_on_its_own() -> None:
    """In pieces of their own they add up. What they add is reciprocal, and with it cells are still
    stable: any forces on them do positive work.
    """
    added = []
    hole = Hole(0.005, 0.1 * D)
    for cuts in ((FLAT,), (hole,), (FLAT, hole)):
        of = model(LOOSE, *cuts)
        assert of.cuts is not None
        matrix = of.cuts.added(of.bands, ROUGH.sectors, np.eye(len(of.rings)))
        assert matrix == pytest.approx(matrix.T, abs=1e-9 * np.abs(matrix).max())
        assert np.linalg.eigvalsh(of.contact._compliance)[0] > 0.0
        added.append(of.cuts.compliance.work(np.eye(len(of.cuts.of))))
    together = np.linalg.norm(added[2])
    assert np.linalg.norm(added[2] - added[0] - added[1]) < 0.02 * together


@pytest.mark.slow
def test_few_combinations_of_pressures_reach_a_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    """From them, and iterations that end early, cells learn what all of them would say."""
    known = model(LOOSE, FLAT)
    monkeypatch.setattr(compliance, "STRESS_TOLERANCE", 0.0)
    monkeypatch.setattr(compliance, "WORK_TOLERANCE", 1e-6)
    alone = ContactModel(CLEVIS, STEEL, LOOSE, ROUGH, Memo()).seeing(CutPin(CLEVIS, [FLAT]))
    few, every = (
        x.cuts.added(x.bands, ROUGH.sectors, np.eye(len(x.rings)))
        for x in (known, alone)
        if x.cuts is not None
    )
    assert few == pytest.approx(every, abs=1e-3 * np.abs(every).max())
    assert (few != every).any()


@pytest.mark.slow
def test_a_prick_changes_nothing() -> None:
    """A hole of 0.3 mm leaves the pressures as they are."""
    plain, pricked = model(LOOSE), model(LOOSE, Hole(0.023, 0.0004, math.pi, 0.0004))
    (before,), (after,) = plain.pressed(pull(0.0)), pricked.pressed(pull(0.0))
    assert moment(pricked, after) == pytest.approx(moment(plain, before), rel=1e-3)
