"""Pins with cuts in their lugs: the surface is read where it is free, like that of other pins."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.pressed import PressedArcs, Rings
from fea.core.requirement import Requirement
from fea.cut.field import CutField
from fea.cut.free_points import FreePoints, relieved
from fea.solve.solve import solve_in_lugs
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import CutPin, Hole, Pin, Segment

D, F = 0.02, 30e3
ROUGHLY = Requirement(0.05, cells="rough", meshes=1)
STEEL = Material("steel", 2.1e11, 0.3, yield_strength=9e8)
PIN = Pin(
    "P",
    (
        *(Segment(0.004, D), Segment(0.016, D, connection="A"), Segment(1e-4, D)),
        *(Segment(0.016, D, connection="B"), Segment(0.004, D)),
    ),
)
LUGS = tuple(Lug(n, 0.05, STEEL, 2e-5, 0.0, np.inf) for n in "AB")
LOADS = PinLoads("pull", ("A", "B"), F * np.array([[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]]))


def solved(*cuts: Hole) -> Solution:
    """In single shear, where lugs nearly touch."""
    cut = CutPin(PIN, cuts) if cuts else None
    return solve_in_lugs(PinProblem(cut or PIN, STEEL, LUGS, (LOADS,)), ROUGHLY)[0]


def test_a_prick_changes_nothing() -> None:
    """A hole of 0.06 d in the unloaded end makes the pin solid as far as into the second lug. The
    row, and what lies beneath contact, stay those of the pin without it, which is solved by
    harmonics alone; the solid itself reads no more there. All of its points together, as they
    were read before, have 1.6 times the stress: steps of cells at the edges.
    """
    plain, pricked = solved(), solved(Hole(0.002, 6e-4, 0.0, 6e-4))
    one, other = plain.peak.places, pricked.peak.places
    assert one is not None
    assert other is not None
    assert one.contact is not None
    assert other.contact is not None
    assert other.surface.max_von_mises == pytest.approx(one.surface.max_von_mises, rel=0.05)
    assert other.contact.beneath == pytest.approx(one.contact.beneath, rel=0.02)
    answer, loads = pricked.answer, pricked.pressed(LOADS)
    assert isinstance(answer, CutField)
    (piece,) = answer.solution.pieces
    assert piece.piece.z1 > PIN.band("B").z0
    read, every = (piece.largest(x)[0][0] for x in (loads, replace(loads, pressed=None)))
    assert read < 1.02 * one.surface.max_von_mises
    assert every > 1.3 * one.surface.max_von_mises


def test_free_points_by_brute_force() -> None:
    """Which points on and beside rings with random cells are free, cell by cell by their distance:
    a sector more on both sides, and beyond the last ring its own length, or that of the next one.
    """
    rng = np.random.default_rng(5)
    ends, sectors = np.array([0.0, 0.1, 0.25, 0.45, 0.7]), 36
    zeros = np.zeros(4)
    rings = Rings(ends[:-1], ends[1:], np.ones(4), zeros.astype(int), zeros.astype(bool), zeros)
    cells = rng.random((4, sectors)) < 0.15
    pressed = PressedArcs.of(rings, [cells], [0.0])
    z, angle = rng.uniform(-0.3, 1.1, 4000), np.radians(rng.integers(0, 360, 4000))
    points = np.stack([np.cos(angle), np.sin(angle), z], axis=1)
    free = FreePoints.of(points, np.ones(len(z), dtype=bool), rings)
    some = free.some(np.arange(len(z)), len(z)).read(pressed, 0)

    def shut(z: float, angle: float) -> bool:
        for ring, sector in np.argwhere(cells):
            middle = 2.0 * np.pi * sector / sectors
            off = abs((angle - middle + np.pi) % (2.0 * np.pi) - np.pi)
            length = rings.length[max(ring - 1, 0) : ring + 2]
            own = rings.length[ring]
            low = rings.start[ring] - min(own, length[0])
            high = rings.end[ring] + min(own, length[-1])
            if np.degrees(off) < 14.5 and low < z < high:
                return True
        return False

    by_hand = np.array([not shut(a, b) for a, b in zip(z.tolist(), angle.tolist(), strict=True)])
    assert 0.2 < by_hand.mean() < 0.8
    assert (by_hand != some).mean() < 0.02  # whose arc is cut by the end of a sector


def test_relieved_of_an_even_pressure_nothing_is_left() -> None:
    """Under the pressure of a half-plane, s_rr = s_zz = -p and s_tt = -2 nu p, at any angle."""
    angle = np.array([0.3, 2.0, 4.4])
    out = np.stack([np.cos(angle), np.sin(angle), np.zeros(3)], axis=1)
    around = np.stack([-np.sin(angle), np.cos(angle), np.zeros(3)], axis=1)
    local = np.einsum("pi,pj->pij", out, out) + np.diag([0.0, 0.0, 1.0])
    local += 0.6 * np.einsum("pi,pj->pij", around, around)
    six = np.stack([-local[:, a, b] for a, b in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))])
    stress = six.T[:, :, None] * 7e6
    assert np.abs(relieved(stress, out, 0.3)).max() < 1.0
    tension = np.zeros_like(stress)
    tension[:, 2] = 5e7
    assert relieved(stress + tension, out, 0.3) == pytest.approx(tension, abs=1.0)


@pytest.mark.slow
def test_the_wall_of_a_hole_under_a_lug_is_read() -> None:
    """In the pressed fibre under its lug: the walls of the hole are free however pressure surrounds
    its mouth, and there is the largest stress.
    """
    found = solved(Hole(0.012, 0.1 * D)).peak.places
    assert found is not None
    assert found.section is None
    assert found.contact is not None
    x, y, z = found.surface.location
    assert np.hypot(y, z - 0.012) == pytest.approx(0.05 * D, rel=0.02)
    assert np.hypot(x, y) < 0.5 * D
    assert found.surface.max_von_mises > 0.15e9
    assert found.contact.beneath == pytest.approx(0.43e9, rel=0.03)  # of the pin without it
