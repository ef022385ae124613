"""Where lugs press on a pin and where its surface is free: arcs, cells and distances beside slow
loops that are written from the definitions.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.places import BENEATH_DISTANCE
from fea.core.pressed import ARC_ANGLES, ARC_COUNT, PressedArcs, Rings
from fea.harmonic.beneath import ARC_STRIDE, Away, _distance, arcs_apart
from tests.support.each import each

STEEL = Material("steel", 210e9, 0.3)
D, RADIUS = 0.02, 0.01


def rings(ends: list[list[float]], edges: int = 1, radii: tuple[float, ...] = (RADIUS,)) -> Rings:
    """Of lugs, each with the ends (m) of its rings, the outermost `edges` of them rounded."""
    start = np.concatenate([x[:-1] for x in ends])
    end = np.concatenate([x[1:] for x in ends])
    count = [len(x) - 1 for x in ends]
    band = np.repeat(np.arange(len(ends)), count)
    edge = np.concatenate([np.minimum(np.arange(n), np.arange(n)[::-1]) < edges for n in count])
    radius = np.resize(radii, len(ends))[band]
    return Rings(start, end, radius, band, edge, np.full(len(start), 0.226))


THREE = rings([[0.0, 0.001, 0.003, 0.006, 0.008, 0.009], [0.009, 0.010, 0.013, 0.015, 0.016]])


def apart(a: float, b: float) -> float:
    """Degrees between two angles, 0 to 180."""
    return abs((a - b + 180.0) % 360.0 - 180.0)


@each("sectors", [24, 36, 48, 64])
@each("angle", [0.0, 0.1, -2.7, 4.0])
def test_arcs_are_those_of_the_cells_that_turn(sectors: int, angle: float) -> None:
    """Each of 360 arcs is pressed if the cell in which its middle is has pressure; one of which a
    cell's end is the middle belongs to either.
    """
    rng = np.random.default_rng(sectors)
    cells = rng.random((2, len(THREE), sectors)) < 0.4
    found = PressedArcs.of(THREE, list(cells), [angle, 0.0])
    assert found.on.shape == (2, len(THREE), ARC_COUNT)
    assert found.sector == math.ceil(360.0 / sectors)
    middles = np.degrees(angle) + 360.0 / sectors * np.arange(sectors)
    for k, at in enumerate(np.degrees(ARC_ANGLES)):
        off = np.array([apart(at, m) for m in middles])
        nearest = np.flatnonzero(off <= off.min() + 1e-6)
        assert any((found.on[0, :, k] == cells[0, :, m]).all() for m in nearest)


def test_a_pressed_cell_presses_as_many_arcs_as_it_is_wide() -> None:
    """36 sectors of ten arcs each, about the cell's middle, at whichever angle the first is."""
    for cell, angle in ((0, 0.02), (7, 1.0), (35, -0.5)):
        cells = np.zeros((len(THREE), 36), dtype=bool)
        cells[3, cell] = True
        found = PressedArcs.of(THREE, [cells], [angle])
        assert found.on.sum() == found.on[0, 3].sum() == 10
        middle = np.degrees(angle) + 10.0 * cell
        assert max(apart(float(a), middle) for a in np.degrees(ARC_ANGLES[found.on[0, 3]])) <= 5.0


@each("sector", [5, 8, 10, 15])
def test_widened_is_a_sector_more_on_both_sides(sector: int) -> None:
    rng = np.random.default_rng(sector)
    arcs = rng.random((6, ARC_COUNT)) < np.array([0.0, 0.002, 0.01, 0.1, 0.9, 1.1])[:, None]
    arcs[1, [0, 359]] = True
    found = PressedArcs(THREE, arcs[None], sector).widened(arcs)
    for row, on in enumerate(arcs):
        where = np.flatnonzero(on)
        for k in range(ARC_COUNT):
            near = any(
                min((k - j) % ARC_COUNT, (j - k) % ARC_COUNT) <= sector for j in where.tolist()
            )
            assert found[row, k] == near


def test_the_last_pressed_rings_of_what_has_no_gap() -> None:
    """Ring by ring and arc by arc; lugs that touch on one cylinder go on, across a gap or a step
    they do not.
    """
    touching = [[0.0, 0.002, 0.005], [0.005, 0.006, 0.009]]
    gap = [touching[0], [0.0051, 0.006, 0.009]]
    cases = (rings(touching), True), (rings(gap), False), (rings(touching, 1, (0.01, 0.011)), False)
    for of, follows in cases:
        assert of.follows.tolist() == [True, follows, True]
        rng = np.random.default_rng(1)
        on = rng.random((3, len(of), ARC_COUNT)) < 0.6
        for instant in range(3):
            first, last = PressedArcs(of, on, 8).last(instant)
            for ring in range(len(of)):
                for k in range(0, ARC_COUNT, 7):
                    now = on[instant, :, k]
                    before = ring > 0 and of.follows[ring - 1] and now[ring - 1]
                    after = ring + 1 < len(of) and of.follows[ring] and now[ring + 1]
                    assert first[ring, k] == (now[ring] and not before)
                    assert last[ring, k] == (now[ring] and not after)


def test_instants_go_with_those_of_the_loads() -> None:
    """Through `at` and `merged` of loads in the order of time, and `amid` between two."""
    rng = np.random.default_rng(0)
    on = rng.random((5, len(THREE), ARC_COUNT)) < 0.5
    times = np.array([0.0, 0.5, 1.0, 0.25, 0.75])

    def case(instants: list[int]) -> PinLoads:
        forces = np.zeros((len(instants), 1, 3))
        forces[:, 0, 0] = instants
        pressed = PressedArcs(THREE, on[instants], 8)
        return PinLoads("c", ("A",), forces, times=times[instants], pressed=pressed)

    both = case([0, 1, 2]).merged(case([3, 1, 4]))
    assert both.pressed is not None
    assert both.forces[:, 0, 0].tolist() == [0, 3, 1, 4, 2]
    assert np.array_equal(both.pressed.on, on[[0, 3, 1, 4, 2]])
    some = both.at(np.array([4, 1]))
    assert some.pressed is not None
    assert np.array_equal(some.pressed.on, on[[2, 3]])
    amid = both.pressed.amid()
    for k, (a, b) in enumerate(((0, 3), (3, 1), (1, 4), (4, 2))):
        assert np.array_equal(amid.on[k], on[a] & on[b])
    plain = replace(case([0]), pressed=None)
    assert plain.merged(case([1])).pressed is None


# What follows is of distances in space.


def brute(point: tuple[float, float], angle: float, of: PressedArcs, instant: int) -> float:
    """The least distance (m) from r, z at an angle to points of all pressed arcs, a hundredth of a
    degree and of a ring's length apart.
    """
    (r, z), least = point, math.inf
    x, y = r * math.cos(angle), r * math.sin(angle)
    for ring in range(len(of.rings)):
        radius = float(of.rings.radius[ring])
        along = np.linspace(of.rings.start[ring], of.rings.end[ring], 101) - z
        height = float(np.abs(along).min())
        arcs = ARC_ANGLES[of.on[instant, ring]]
        if len(arcs):
            each = arcs[:, None] + np.radians(np.linspace(-0.5, 0.5, 101))
            flat = np.hypot(radius * np.cos(each) - x, radius * np.sin(each) - y).min()
            least = min(least, math.hypot(float(flat), height))
    return least


def some_arcs(seed: int, share: float) -> PressedArcs:
    """A few stretches of arcs on the rings of two lugs of unlike radius, one instant with none."""
    rng = np.random.default_rng(seed)
    of = rings([[0.0, 0.001, 0.004, 0.006], [0.008, 0.010, 0.013]], 1, (RADIUS, 1.2 * RADIUS))
    on = np.zeros((3, len(of), ARC_COUNT), dtype=bool)
    for ring in np.flatnonzero(rng.random(len(of)) < share).tolist():
        first, count = rng.integers(0, ARC_COUNT), rng.integers(1, 120)
        on[0, ring, np.arange(first, first + count) % ARC_COUNT] = True
    on[1, 2] = True
    return PressedArcs(of, on, 10)


@each("seed", range(4))
def test_distances_are_those_in_space(seed: int) -> None:
    of = some_arcs(seed, 0.7)
    rng = np.random.default_rng(100 + seed)
    points = np.stack([rng.uniform(0.0, RADIUS, 12), rng.uniform(-0.005, 0.02, 12)], axis=1)
    points[0, 0] = 0.0
    for instant in range(3):
        found = _distance(points, of, instant)
        assert found.shape == (12, ARC_COUNT // ARC_STRIDE)
        for k, (r, z) in enumerate(points.tolist()):
            for arc in rng.integers(0, ARC_COUNT // ARC_STRIDE, 5).tolist():
                expected = brute((r, z), float(ARC_ANGLES[arc * ARC_STRIDE]), of, instant)
                if math.isinf(expected):
                    assert math.isinf(found[k, arc])
                else:
                    assert found[k, arc] == pytest.approx(expected, abs=1e-3 * RADIUS)


@each("seed", range(4))
def test_away_is_farther_than_a_tenth_of_the_diameter(seed: int) -> None:
    """From all that is pressed at the instant; by half an arc or less it may be either."""
    of = some_arcs(seed, 0.7)
    rng = np.random.default_rng(200 + seed)
    points = np.stack([rng.uniform(0.6, 1.0, 40) * RADIUS, rng.uniform(-0.003, 0.016, 40)], axis=1)
    region = Away(points, of)
    every = np.arange(len(points))
    near = 0
    for instant in range(3):
        found = region.read(every, np.full(len(points), instant))
        masked = region.masked(every)
        for k, (r, z) in enumerate(points.tolist()):
            for arc in rng.integers(0, ARC_COUNT, 6).tolist():
                distances = [
                    brute((r, z), float(ARC_ANGLES[arc]), one, instant) / (2.0 * float(radius))
                    for radius in np.unique(of.rings.radius)
                    for one in [of_radius(of, float(radius))]
                ]
                slack = 0.5 * math.radians(1.0) * RADIUS / (2.0 * RADIUS)
                if min(distances) > BENEATH_DISTANCE + slack:
                    assert found[k, arc]
                if min(distances) < BENEATH_DISTANCE - slack:
                    assert not found[k, arc]
                    near += 1
            assert masked[k] or found[k].all()
    assert near > 25


def of_radius(of: PressedArcs, radius: float) -> PressedArcs:
    """Of rings of one radius only."""
    return replace(of, on=of.on & (of.rings.radius == radius)[:, None])


def test_arcs_apart_are_counted_the_shorter_way_round() -> None:
    rng = np.random.default_rng(5)
    on = rng.random((5, ARC_COUNT)) < np.array([0.0, 0.003, 0.02, 0.3, 1.1])[:, None]
    found = arcs_apart(on)
    for row, arcs in enumerate(on):
        where = np.flatnonzero(arcs).tolist()
        for k in range(ARC_COUNT):
            least = min(
                (min((k - j) % ARC_COUNT, (j - k) % ARC_COUNT) for j in where), default=ARC_COUNT
            )
            assert found[row, k] == least
