"""Contact on cells against exact plane solutions, its conditions, and its limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState
from tests.support.exact.plane_contact import (
    E_STAR,
    NU,
    PERSSON,
    ROLLER_LOAD,
    ROLLER_PIN,
    ROLLER_SECTORS,
    disc_and_plate,
    plane,
    roller,
)


def three(
    clearance: float = 0.0, tilt: float = math.inf, stiff: float = 1.0, sectors: int = 32
) -> ContactProblem:
    """A fork and an eye on bands of two rings: local flexibility by ring, and a beam's bending.

    The flexibility is made up, symmetric and positive: half-planes and a cantilever.
    """
    z = np.array([0.25, 0.75, 1.5, 2.5, 3.25, 3.75])
    length = np.array([0.5, 0.5, 1.0, 1.0, 0.5, 0.5])
    flexible = np.zeros((7, 6, 6))
    for n in range(7):
        flexible[n] = 2.0 / max(n, 1) * np.eye(6) / stiff
    near, far = np.minimum(z[:, None], z), np.maximum(z[:, None], z)
    flexible[1] += near**2 * (3.0 * far - near) / 6.0 * length
    bands = Bands(z, length, np.ones(6), np.array([0, 0, 1, 1, 2, 2]), np.full(6, clearance))
    return ContactProblem(bands, flexible, np.full(6, 2.0) / stiff, [tilt, math.inf, tilt], sectors)


FORK = np.array([[-0.5, 0.0], [1.0, 0.0], [-0.5, 0.0]])


def resultants(contact: ContactProblem, found: ContactState) -> Floats:
    """Force of the cells on the pin at every ring, (R, 2)."""
    a, mean = contact.angles, np.sinc(1.0 / contact.sectors)
    area = contact.area.reshape(found.pressure.shape)
    e_r = mean * np.stack([np.cos(a), np.sin(a)], axis=1)
    return np.asarray(-(found.pressure * area) @ e_r)


@pytest.mark.parametrize("ratio", PERSSON)
def test_persson(ratio: float) -> None:
    """Peak pressure within 1 %, angle within half a sector of 3.75 degrees."""
    half_angle, peak = PERSSON[ratio]
    contact = plane(ratio / E_STAR)
    found = contact.solve(np.array([[-1.0, 0.0]]))
    assert found.pressure.max() == pytest.approx(peak, rel=0.01)
    assert found.pressure.argmax() == 0
    cells = np.count_nonzero(found.pressure[0])
    assert 180.0 / 96 * cells == pytest.approx(half_angle, abs=180.0 / 96)


def test_hertz() -> None:
    """p0 = sqrt(Q E' / (pi R)), half width 2 Q / (pi p0), within a cell."""
    weak = 1.0 / ((1.0 - NU * NU) * (1.0 / 210e3 + 1.0 / 70e3))
    peak, width = roller()
    exact = math.sqrt(ROLLER_LOAD * weak / (math.pi * 50.0))
    assert peak == pytest.approx(exact, rel=0.01)
    cell = math.pi / ROLLER_SECTORS * ROLLER_PIN
    assert width == pytest.approx(2.0 * ROLLER_LOAD / (math.pi * exact), abs=cell)


def test_the_peak_converges_with_sectors_and_harmonics() -> None:
    """Half way between limits, where neither alone is easy."""
    exact = PERSSON[2.0][1]

    def error(sectors: int, highest: int) -> float:
        found = plane(2.0 / E_STAR, sectors, highest).solve(np.array([[-1.0, 0.0]]))
        return abs(float(found.pressure.max()) / exact - 1.0)

    assert error(192, 10) < 0.001
    assert error(48, 6) < 0.01


def test_without_the_half_planes_tail_it_is_wrong() -> None:
    """More unknown pressures than harmonics say anything about: a tenth of it is far too little."""
    found = plane(0.0, highest=6, tail=0.1).solve(np.array([[-1.0, 0.0]]))
    assert abs(found.pressure[0, 0] / PERSSON[0.0][1] - 1.0) > 0.08  # in waves


def test_interference_is_lames() -> None:
    """Without any load the pressure of a press fit is even: interference over the flexibility."""
    found = plane(-0.01).solve(np.zeros((1, 2)))
    assert found.pressure == pytest.approx(0.01 / disc_and_plate(0)[0, 0, 0], rel=1e-9)
    assert found.active.all()


def test_no_load_and_clearance_is_no_pressure() -> None:
    found = three(clearance=0.01).solve(np.zeros((3, 2)))
    assert not found.pressure.any()
    assert found.gap == pytest.approx(0.01)


@pytest.mark.parametrize("clearance", [0.0, 0.3, 3.0, -0.2])
@pytest.mark.parametrize("tilt", [math.inf, 0.0, 2.0])
def test_conditions_hold(clearance: float, tilt: float) -> None:
    """No tension, no overlap, one of both zero; forces and couples in equilibrium to 1e-10."""
    contact = three(clearance, tilt)
    forces = np.array([[-0.7, 0.1], [1.1, 0.3], [-0.4, -0.4]])
    found = contact.solve(forces, couple=(0.05, -0.02))
    assert found.pressure.min() >= 0.0
    assert found.gap.min() >= 0.0
    assert not (found.pressure * found.gap).any()
    ring = resultants(contact, found)
    by_band = np.add.reduceat(ring, [0, 2, 4])
    assert by_band == pytest.approx(forces, abs=1e-10)
    arm = contact.bands.z - contact.bands.z.mean()
    mx, my = -(arm @ ring)[1] + 0.05, (arm @ ring)[0] - 0.02
    assert (mx, my) == pytest.approx((0.0, 0.0), abs=1e-10)
    if tilt == 0.0:
        for b in (0, 2):
            own = contact.bands.band == b
            couple = (contact.bands.z - contact.bands.middles[b])[own] @ ring[own]
            assert couple == pytest.approx([0.0, 0.0], abs=1e-10)


def test_a_symmetric_case_is_symmetric() -> None:
    found = three(0.1).solve(FORK)
    assert found.pressure == pytest.approx(found.pressure[::-1], abs=1e-9)  # end for end
    mirrored = np.roll(found.pressure[:, ::-1], 1, axis=1)  # about the plane of the load
    assert found.pressure == pytest.approx(mirrored, abs=1e-9)


@pytest.mark.parametrize(
    ("sectors", "clearance", "tilt"),
    [(32, 0.3, math.inf), (33, 0.0, math.inf), (24, 0.1, 3.0), (25, 0.2, 0.0)],
)
def test_half_the_circumference_has_the_contact_of_all_of_it(
    sectors: int, clearance: float, tilt: float
) -> None:
    """Loads along x press mirrored about x; a load aside, too small to matter, shows all cells.

    Any solution satisfies all conditions of contact, which have only one.
    """
    contact = three(clearance, tilt, sectors=sectors)
    forces = np.array([[-0.7, 0.0], [1.0, 0.0], [-0.3, 0.0]])
    moments = np.array([[0.0, 0.1], [0.0, 0.0], [0.0, -0.05]]) if tilt == 0.0 else None
    half = contact.solve(forces, (0.0, 0.4), moments=moments)
    assert "_compliance" not in contact.__dict__  # of all cells it was not needed
    aside = forces + 1e-8 * np.array([[0.0, 1.0], [0.0, -2.0], [0.0, 1.0]])
    whole = contact.solve(aside, (0.0, 0.4), moments=moments)
    assert "_compliance" in contact.__dict__
    largest = whole.pressure.max()
    assert half.pressure == pytest.approx(whole.pressure, abs=1e-6 * largest)
    assert (half.pressure[:, 1:] == half.pressure[:, :0:-1]).all()
    assert half.gap == pytest.approx(whole.gap, abs=1e-6 * whole.gap.max())
    assert half.shift == pytest.approx(whole.shift, abs=1e-6 * np.abs(whole.shift).max())
    assert half.turn == pytest.approx(whole.turn, abs=1e-6 * np.abs(whole.turn).max())
    assert resultants(contact, half)[:2].sum(axis=0) == pytest.approx(forces[0], abs=1e-9)


def test_turned_loads_turn_the_pressure() -> None:
    """By sectors exactly; between them as far as cells of 7.5 degrees allow."""
    contact = three(0.1, sectors=48)
    first = contact.solve(FORK)
    for sectors, within in ((5, 1e-8), (0.5, 0.02)):
        angle = sectors * 2.0 * math.pi / 48
        c, s = math.cos(angle), math.sin(angle)
        found = contact.solve(FORK @ np.array([[c, s], [-s, c]]))
        if sectors == 5:
            assert found.pressure == pytest.approx(np.roll(first.pressure, 5, axis=1), abs=within)
        line, other = (x.pressure.sum(axis=1) for x in (found, first))
        assert line == pytest.approx(other, rel=within)


def test_without_clearance_forces_in_proportion_give_pressures_in_proportion() -> None:
    one, ten = (three().solve(k * FORK) for k in (1.0, 10.0))
    assert ten.pressure == pytest.approx(10.0 * one.pressure, rel=1e-9, abs=1e-9)
    loose = [three(0.3).solve(k * FORK).pressure for k in (1.0, 10.0)]
    assert loose[1].max() < 9.0 * loose[0].max()  # contact spreads


def test_any_start_leads_to_the_same_answer() -> None:
    contact = three(0.2)
    cold = contact.solve(FORK)
    for start in (np.ones((6, 32), bool), np.roll(cold.active, 9, axis=1)):
        assert contact.solve(FORK, start=start).pressure == pytest.approx(cold.pressure, abs=1e-9)
    assert contact.solve(FORK, start=cold.active).steps == 1


def test_a_lug_that_carries_nothing_is_left_alone() -> None:
    """Its force is zero: with clearance it has no contact, and the others balance without it."""
    contact = three(clearance=5.0, tilt=2.0)
    found = contact.solve(np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]))
    by_band = np.add.reduceat(resultants(contact, found), [0, 2, 4])
    assert by_band == pytest.approx(np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]), abs=1e-10)


def test_stiffer_lugs_and_smaller_clearance_press_harder_or_wider() -> None:
    """The first widens the arc with flexibility, the second with less clearance."""
    arcs = [np.count_nonzero(three(c).solve(FORK).pressure) for c in (0.0, 0.5, 2.0, 20.0)]
    assert arcs == sorted(arcs, reverse=True)
    assert arcs[0] > arcs[-1]


def test_forces_out_of_balance_cannot_be_answered() -> None:
    """Resultants are met band by band, whatever they are; a couple without lugs that take it is
    not: that of two free lugs in single shear.
    """
    contact = ContactProblem(
        Bands(np.array([0.5, 2.0]), np.ones(2), np.ones(2), np.array([0, 1]), np.zeros(2)),
        np.stack([np.eye(2)] * 2), np.ones(2), [0.0, 0.0], 24,
    )  # fmt: skip
    with pytest.raises(SolveError):
        contact.solve(np.array([[1.0, 0.0], [-1.0, 0.0]]))


def small_and_loose(sectors: int = 48, rings: int = 12, lugs: int = 2) -> ContactProblem:
    """Lugs 50 mm thick on a pin of 50 mm of steel, in metres, loose by 60 um: half-planes, with
    bending and the tilt of the lugs.
    """
    ends = np.linspace(0.0, 0.05, rings + 1)
    z = np.concatenate([0.5 * (ends[1:] + ends[:-1]) + 0.052 * lug for lug in range(lugs)])
    length = np.full(lugs * rings, 0.05 / rings)
    per_force, E = 4.0 * E_STAR**-1 * 0.025 / 200e9, 200e9
    flexible = np.zeros((17, len(z), len(z)))
    for n in range(17):
        flexible[n] = per_force / max(n, 1) * np.eye(len(z))
    near, far = np.minimum(z[:, None], z), np.maximum(z[:, None], z)
    bending = near**2 * (3.0 * far - near) / (6.0 * E * math.pi * 0.025**4 / 4.0)
    flexible[1] += math.pi * 0.025 * length * bending
    band = np.repeat(np.arange(lugs), rings)
    bands = Bands(z, length, np.full(len(z), 0.025), band, np.full(len(z), 30e-6))
    tail = np.full(len(z), per_force)
    return ContactProblem(bands, flexible, tail, [2e6] * lugs, sectors)


@pytest.mark.parametrize("load", [1e6, 1e4, 300.0, 10.0, 1.0])
@pytest.mark.parametrize("across", [0.0, 0.02, 0.3])
def test_light_loads_in_loose_lugs_touch_few_cells(load: float, across: float) -> None:
    """A pin in single shear turns until it touches both lugs at their ends, on a few cells of a
    thousand; conditions and balance hold there, from any start.
    """
    contact = small_and_loose()
    forces = load * np.array([[1.0, across], [-1.0, -across]])
    found = contact.solve(forces)
    touching = np.count_nonzero(found.pressure)
    assert found.pressure.min() >= 0.0
    assert found.gap.min() >= 0.0
    assert not (found.pressure * found.gap).any()
    ring = resultants(contact, found)
    assert np.add.reduceat(ring, [0, 12]) == pytest.approx(forces, abs=1e-9 * load)
    assert np.abs((contact.bands.z - 0.051) @ ring).max() < 1e-9 * load
    loaded = np.ones((24, 48), dtype=bool)
    again = contact.solve(forces, start=loaded)
    assert again.pressure == pytest.approx(found.pressure, abs=1e-7 * found.pressure.max())
    if load <= 300.0:
        assert touching < 24
