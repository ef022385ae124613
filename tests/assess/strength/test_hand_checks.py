"""Hand checks against sums on paper: shear, bearing, bending; clamped, balanced, in motion."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from assess.checks import margins_of
from assess.margin import Margin
from assess.situation import Situation
from fea.core.hardened import Hardened
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

d, F = 0.02, 12_000.0
A, W = math.pi / 4 * d**2, math.pi / 32 * d**3  # area and section modulus
b, g, c = 0.015, 0.003, 0.03  # outer lugs, gaps, middle lug

LUGS = double_shear(b, g, c, d)


def hand_checks(
    pin: Pin, material: Material, loads: PinLoads, clamps: tuple[str, ...] = ()
) -> list[Margin]:
    """With even loads on the bands."""
    every = margins_of(Situation(pin, material, loads, clamps))
    return [m for m in every if m.listed_by_hand and "concentrated" not in m.method]


def lugs(*middle: tuple[float, float], left: float = 0.5) -> PinLoads:
    """Force (x, y) on the middle lug at each instant, `left` the part carried on the left."""
    m = np.array(middle)
    forces = np.zeros((len(m), 3, 3))
    forces[:, 1, :2] = m
    forces[:, 0, :2], forces[:, 2, :2] = -left * m, (left - 1) * m
    return PinLoads("case", ("A", "B", "C"), forces, times=np.arange(len(m)) / 2.0)


def test_double_shear_on_paper(steel: Material) -> None:
    """F/2A, 4/3 of it, F/dc, F/2db, and bending F/2 (b/2 + g + c/4) over the section modulus; the
    second instant is the largest and slants.
    """
    loads = lugs((F / 2, 0), (F * 0.6, F * 0.8), (0, F / 3))
    checks = hand_checks(LUGS, steel, loads)
    assert all(x.time == 0.5 for x in checks)
    assert {x.at for x in checks if x.method == "double shear, mean"} == {"B"}
    found = {(x.method, x.at): x for x in checks}
    assert found["double shear, mean", "B"].demand == pytest.approx(F / (2 * A))
    single = next(x for x in checks if x.method == "single shear, mean")
    assert single.demand == pytest.approx(F / (2 * A))
    highest = next(x for x in checks if x.method == "single shear, at the neutral axis")
    assert highest.demand == pytest.approx(4 / 3 * F / (2 * A))
    assert found["bearing", "B"].demand == pytest.approx(F / (d * c))
    assert found["bearing", "A"].demand == pytest.approx(F / 2 / (d * b))
    bending = found["bending", "B"]
    assert bending.demand == pytest.approx(F / 2 * (b / 2 + g + c / 4) / W)
    assert bending.z == pytest.approx(b + g + c / 2)


def test_strengths(steel: Material) -> None:
    """Yield in bending and bearing, yield over the root of 3 in shear; no yield, no factor."""
    for check in hand_checks(LUGS, steel, lugs((F, 0.0))):
        expected = 1e9 / math.sqrt(3) if "shear" in check.method else 1e9
        assert check.allowable == pytest.approx(expected)
        assert check.safety_factor == pytest.approx(expected / (check.demand or 0.0))
        assert check.formula
        assert "Shigley" in check.clause
    for check in hand_checks(LUGS, replace(steel, yield_strength=None), lugs((F, 0.0))):
        assert check.allowable is None
        assert check.safety_factor is None


@each(("other_gap", "double"), [(0.006, True), (0.04, False)])
def test_uneven_sides_are_single_shear(steel: Material, other_gap: float, double: bool) -> None:
    """With a wider gap on one side, statics send less than half there. The sides may differ by a
    tenth of the load, here (l - r) / (l + r) of the distances: 0.03 and 0.32.
    """
    segments = list(LUGS.segments)
    segments[3] = Segment(other_gap, d)
    left, right = b / 2 + g + c / 2, b / 2 + other_gap + c / 2
    loads = lugs((F, 0.0), left=right / (left + right))
    checks = hand_checks(Pin("P", tuple(segments)), steel, loads)
    assert ("double shear, mean" in [x.method for x in checks]) is double
    single = next(x for x in checks if x.method == "single shear, mean")
    assert single.demand == pytest.approx(F * right / (left + right) / A)


def test_a_cantilever_pin(steel: Material) -> None:
    """Clamped in a hub over its first segment, loaded at its end: V = F, M at the hub's edge."""
    hub, arm, lug = 0.03, 0.01, 0.02
    pin = Pin("P", (Segment(hub, d, name="hub"), Segment(arm, d), Segment(lug, d, connection="B")))
    loads = PinLoads("case", ("B",), np.array([[[0.0, F, 500.0]]]))
    found = {x.method: x for x in hand_checks(pin, steel, loads, ("hub",))}
    assert found["single shear, mean"].demand == pytest.approx(F / A)
    assert found["bending"].demand == pytest.approx(F * (arm + lug / 2) / W)
    assert found["bending"].z == pytest.approx(hub)
    assert found["bearing"].demand == pytest.approx(F / (d * lug))
    assert "double shear, mean" not in found


def test_the_largest_stress_is_not_where_the_largest_moment_is(steel: Material) -> None:
    """A thick root: the thin part beyond it governs, with half the moment."""
    pin = Pin("P", (Segment(0.03, 0.03), Segment(0.02, d), Segment(0.02, d, connection="B")))
    loads = PinLoads("case", ("B",), np.array([[[F, 0.0, 0.0]]]))
    bending = next(x for x in hand_checks(pin, steel, loads, ("start",)) if x.method == "bending")
    assert bending.z == pytest.approx(0.03)
    assert bending.at == "segment 2"
    assert bending.demand == pytest.approx(F * 0.03 / W)


def test_a_tube_in_shear(steel: Material) -> None:
    """V Q / (I t) of a hollow circle: 4/3 (a^2 + a b + b^2) / (a^2 + b^2) V / A."""
    bore = 0.012
    pin = Pin("P", tuple(replace(s, bore=bore) for s in LUGS.segments))
    checks = {x.method: x for x in hand_checks(pin, steel, lugs((F, 0.0)))}
    mean = F / 2 / (math.pi / 4 * (d**2 - bore**2))
    factor = 4 / 3 * (d**2 + d * bore + bore**2) / (d**2 + bore**2)
    peak = checks["single shear, at the neutral axis"]
    assert checks["single shear, mean"].demand == pytest.approx(mean)
    assert peak.demand == pytest.approx(factor * mean)
    assert peak.formula == "V Q / (I t)"


def test_shear_at_the_neutral_axis_is_largest_where_a_tube_shares_the_mean(steel: Material) -> None:
    """A solid gap and a hollow one with a little more area: the mean is largest in the first, V Q /
    (I t) in the second.
    """
    segments, bore = list(LUGS.segments), 0.008
    segments[1] = Segment(g, 0.018)
    segments[3] = Segment(g, d, bore=bore)
    checks = hand_checks(Pin("P", tuple(segments)), steel, lugs((F, 0.0)))
    found = {x.method: x for x in checks}
    assert found["single shear, mean"].at == "segment 2"
    peak = found["single shear, at the neutral axis"]
    tube = 4 / 3 * (d**2 + d * bore + bore**2) / (d**2 + bore**2)
    assert peak.at == "segment 4"
    assert peak.demand == pytest.approx(tube * F / 2 / (math.pi / 4 * (d**2 - bore**2)))
    assert peak.formula == "V Q / (I t)"


def test_a_moment_between_samples_is_found_exactly(steel: Material) -> None:
    """In balance under three unequal bands, in two planes at once: against sums over 150,000 slices
    of what acts, the closing traction included. (Of two bands both unit loads have the same shape,
    whose largest moment is a sample.)
    """
    lengths = np.array([0.0713, 0.129, 0.0487])
    pin = Pin(
        "P",
        tuple(Segment(x, d, connection=n) for x, n in zip(lengths.tolist(), "ABC", strict=True)),
    )
    forces = F * np.array([[[1.0, 0.2, 0.0], [-0.3, 1.0, 0.0], [-1.0, -0.5, 0.0]]])
    largest = next(
        x
        for x in hand_checks(pin, steel, PinLoads("case", ("A", "B", "C"), forces))
        if x.method == "bending"
    )
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    z = np.unique(np.concatenate([np.linspace(*e, 50_001) for e in itertools.pairwise(ends)]))
    h, mid = np.diff(z), 0.5 * (z[1:] + z[:-1])
    band = np.searchsorted(ends[1:-1], mid)
    centre, length = ends[-1] / 2, ends[-1]
    M2 = np.zeros(len(z))
    for axis in (0, 1):
        w = (forces[0, :, axis] / lengths)[band]
        couple = float((w * (mid - centre) * h).sum())
        own = 0.5 * (ends[1:] + ends[:-1])[band]
        slope = 12 * couple / np.sum(np.asarray(lengths) ** 3)
        w = w - (w * h).sum() / length - slope * (mid - own)
        V = -np.concatenate([[0.0], np.cumsum(w * h)])
        M = -np.concatenate([[0.0], np.cumsum(0.5 * (V[1:] + V[:-1]) * h)])
        M2 += M**2
    assert largest.demand == pytest.approx(math.sqrt(M2.max()) / W, rel=1e-7)
    assert largest.z == pytest.approx(z[M2.argmax()], abs=1e-5)


def test_no_load_no_factor(steel: Material) -> None:
    checks = hand_checks(LUGS, steel, lugs((0.0, 0.0)))
    assert {x.method for x in checks} == {
        "single shear, mean",
        "single shear, at the neutral axis",
        "bending",
    }
    assert all(x.demand == 0.0 and x.safety_factor is None for x in checks)


def test_single_shear_is_the_whole_force(steel: Material) -> None:
    """Two links side by side: what takes up their couple leaves them their forces."""
    d, force = 0.02, 1000.0
    pin = Pin("P", (Segment(0.02, d, connection="A"), Segment(0.02, d, connection="B")))
    forces = np.array([[[0.0, force, 0.0], [0.0, -force, 0.0]]])
    found = {c.method: c for c in hand_checks(pin, steel, PinLoads("case", ("A", "B"), forces))}
    assert found["single shear, mean"].demand == pytest.approx(force / (math.pi * d**2 / 4))


def test_checks_are_proportional_to_the_load(steel: Material) -> None:
    """Also below a newton: what is small is not nothing."""
    whole, part = (hand_checks(LUGS, steel, lugs((f, 0.0))) for f in (F, 1e-5 * F))
    assert [(x.method, x.at) for x in whole] == [(x.method, x.at) for x in part]
    assert "double shear, mean" in {x.method for x in part}
    for a, b in zip(whole, part, strict=True):
        assert b.demand == pytest.approx(1e-5 * (a.demand or 0.0))


def test_lugs_side_by_side_at_the_ends_of_a_pin(steel: Material) -> None:
    """No gaps: beside the middle lug there is but the outer ones."""
    pin = Pin("P", tuple(s for s in LUGS.segments if s.connection))
    found = {(x.method, x.at): x for x in hand_checks(pin, steel, lugs((F, 0.0)))}
    assert found["double shear, mean", "B"].demand == pytest.approx(F / (2 * A))


def test_the_largest_moment_is_sought_within_the_pin(steel: Material) -> None:
    """F along 10 mm, half of it taken back along 10 mm and the rest along 1 mm: from there on no
    shear is left, and M is the forces times the distances of their middles. Were the second band
    longer, M would grow beyond that.
    """
    pin = Pin(
        "P",
        (
            Segment(0.010, d, connection="A"),
            Segment(0.010, d, connection="B"),
            Segment(0.001, d, connection="C"),
            Segment(0.010, d),
        ),
    )
    forces = F * np.array([[[1.0, 0.0, 0.0], [-0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    loads = PinLoads("case", ("A", "B", "C"), forces)
    bending = next(x for x in hand_checks(pin, steel, loads, ("end",)) if x.method == "bending")
    assert bending.demand == pytest.approx(F * (0.016 - 0.5 * 0.006 - 0.5 * 0.0005) / W)


def test_bending_of_a_hardened_pin_is_held_against_its_core(steel: Material) -> None:
    """1 mm below the surface of a pin of 20 mm there is 9/10 of the stress at the surface."""
    pin = LUGS
    case = Hardened(0.0, pin.length, 9e8, 5e8, 0.001)
    hard = replace(steel, yield_strength=9e8, hardened=(case,))
    bending = next(x for x in hand_checks(pin, hard, lugs((F, 0.0))) if x.method == "bending")
    assert bending.allowable == pytest.approx(5e8 / 0.9)
