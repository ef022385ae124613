"""The maximum over a motion, not over its samples."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.over_time import knots, rise_between
from fea.core.pin_loads import Distribution, Floats, PinLoads, chord_deviation
from fea.core.requirement import Model, Requirement
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from tests.support.each import each

# Double shear of a plain bar of 20 mm.
BAR = Pin(
    "D",
    (
        Segment(0.01, 0.02, connection="D1"),
        Segment(0.02, 0.02, connection="D2"),
        Segment(0.01, 0.02, connection="D3"),
    ),
)
TURN = 0.35  # rad per s of the load's direction: it turns little while its size has a crest
CREST = 0.4321  # s


def loads_at(times: Floats, distribution: Distribution = "uniform") -> PinLoads:
    """Forces that swell once, at CREST, while they turn."""
    size = 1000.0 * (1.0 + np.cos(2.0 * np.pi * (times - CREST)))
    angle = TURN * times
    force = size[:, None] * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    forces = np.stack([0.5 * force, -force, 0.5 * force], axis=1)
    return PinLoads("turn", ("D1", "D2", "D3"), forces, distribution=distribution, times=times)


def of_cosine(times: Floats) -> PinLoads:
    return loads_at(times, "cosine")


def held_up(times: Floats) -> PinLoads:
    """The largest of these loads, which stays."""
    return replace(loads_at(np.full(len(times), CREST)), times=times)


@each("model", ["beam", "harmonic"])
def test_loads_that_stay_stress_as_one_instant(model: Model, steel: Material) -> None:
    """None lies beyond the chord of its neighbours, so no interval needs a search."""
    requirement, times = Requirement(model=model), np.linspace(0.0, 1.0, 5)
    (found,) = solve_pin(BAR, steel, (), (held_up(times),), requirement, between={"turn": held_up})
    (alone,) = solve_pin(BAR, steel, (), (loads_at(np.array([CREST])),), requirement)
    assert found.peak.max_von_mises == pytest.approx(alone.peak.max_von_mises, rel=1e-9)


@each("model", ["beam", "harmonic"])
@each("samples", [3, 5, 41])
def test_samples_do_not_matter(model: Model, samples: int, steel: Material) -> None:
    """The largest load is at CREST, whatever the samples: maximum to 1e-9 of that of this instant
    alone, its time to 1e-5 s (a crest is flat), its error with next to nothing of the time.
    """
    requirement = Requirement(model=model)
    times = np.linspace(0.0, 1.0, samples)
    (found,) = solve_pin(
        BAR, steel, (), (loads_at(times),), requirement, between={"turn": loads_at}
    )
    (alone,) = solve_pin(BAR, steel, (), (loads_at(np.array([CREST])),), requirement)
    assert found.peak.max_von_mises == pytest.approx(alone.peak.max_von_mises, rel=1e-9)
    assert found.peak.time == pytest.approx(CREST, abs=1e-5)
    assert found.loads.times is not None
    assert found.loads.times[found.instant] == found.peak.time
    assert set(times) <= set(found.loads.times)
    assert found.peak.parts is not None
    assert alone.peak.parts is not None
    limit = 0.05 * requirement.tolerance * (found.peak.max_von_mises or 0.0)
    assert 0.0 < found.peak.parts.time <= 1.1 * limit  # which the first mesh decides
    assert alone.peak.parts.time == 0.0


def test_pressures_turn_with_their_forces(steel: Material) -> None:
    """A bearing pressure is no linear function of its force, yet its maximum is found: to 1e-6 of
    the largest of 2,001 instants.
    """
    times = np.linspace(0.0, 1.0, 4)
    (found,) = solve_pin(
        BAR, steel, (), (of_cosine(times),), Requirement(), between={"turn": of_cosine}
    )
    assert found.answer is not None
    dense = found.answer.largest(of_cosine(np.linspace(0.0, 1.0, 2001)))[0]
    assert found.peak.max_von_mises == pytest.approx(dense, rel=1e-6)
    assert (found.peak.max_von_mises or 0.0) >= dense


def test_what_is_told_of_the_time_is_a_bound(steel: Material) -> None:
    """On few instants, without more of them: what lies between is less than the bound, and the
    bound no more than six times as much.
    """
    (found,) = solve_pin(BAR, steel, (), (loads_at(np.array([CREST])),), Requirement())
    assert found.answer is not None
    for count in (7, 12, 25):
        few = loads_at(np.linspace(0.0, 1.0, count))
        most = max(
            found.answer.largest(loads_at(np.linspace(a, b, 101)))[0]
            - max(found.answer.largest(loads_at(np.array([t])))[0] for t in (a, b))
            for a, b in itertools.pairwise(few.times if few.times is not None else ())
        )
        bound = rise_between(found.answer, few, loads_at)
        assert most <= bound <= 6.0 * most


def test_a_table_of_instants_is_taken_as_it_is(steel: Material) -> None:
    """Nothing is known between its rows."""
    times = np.linspace(0.0, 1.0, 5)
    (found,) = solve_pin(BAR, steel, (), (loads_at(times),), Requirement())
    assert found.peak.time == 0.5
    assert len(found.loads) == 5
    assert found.peak.parts is not None
    assert found.peak.parts.time == 0.0


def test_merged_instants_are_in_the_order_of_time() -> None:
    few, more = loads_at(np.array([0.0, 0.5, 1.0])), loads_at(np.array([0.25, 0.5, 0.75]))
    both = few.merged(more)
    expected = loads_at(np.linspace(0.0, 1.0, 5))
    assert both.times is not None
    assert np.array_equal(both.times, np.linspace(0.0, 1.0, 5))
    assert np.array_equal(both.forces, expected.forces)
    assert np.array_equal(both.at(np.array([1, 3])).forces, expected.forces[[1, 3]])


def test_forces_along_a_chord_differ_by_nothing() -> None:
    """Linear forces of constant direction, under both distributions; turned ones by what they turn:
    1 - cos of half the angle between the ends, to its third power.
    """
    ends = replace(loads_at(np.zeros(2)), times=np.array([0.0, 1.0]))
    ends.forces[1] *= 3.0
    middle = ends.at(np.array([0]))
    middle.forces[:] *= 2.0
    for distribution in ("uniform", "cosine"):
        kinds = (replace(x, distribution=distribution) for x in (ends, middle))
        off = chord_deviation(*kinds)
        assert max(np.abs(c).max() for c in off.coefficients().values()) < 1e-9
    turned = PinLoads("t", ("a",), np.array([[[1.0, 0.0, 0.0]], [[np.cos(0.2), np.sin(0.2), 0.0]]]))
    middle = PinLoads("t", ("a",), np.array([[[np.cos(0.1), np.sin(0.1), 0.0]]]))
    (apart,) = chord_deviation(turned, middle).coefficients().values()
    assert np.hypot(*apart[0]) == pytest.approx(1.0 - np.cos(0.1), rel=1e-12)


def test_amounts_turn_as_forces_do() -> None:
    """Of every harmonic of a pressure, with the forces that make it."""
    loads = of_cosine(np.linspace(0.0, 1.0, 3))
    none = replace(loads.at(np.array([0, 1])), forces=np.zeros((2, 3, 3)))
    amounts = chord_deviation(replace(loads, forces=0.0 * loads.forces), loads.at(np.array([0, 1])))
    assert none.coefficients() == {}
    turned = amounts.turned(0.7).coefficients()
    expected = loads.at(np.array([0, 1])).turned(0.7).coefficients()
    assert set(turned) == set(expected)
    for load, both in turned.items():
        assert both == pytest.approx(expected[load], abs=1e-9)


def test_a_jump_needs_no_instants(steel: Material) -> None:
    """Friction that reverses: both sides are instants, and what is between them on their chord."""
    jump = 0.6

    def at(times: Floats) -> PinLoads:
        loads = loads_at(times)
        return replace(loads, forces=loads.forces * np.where(times < jump, 1.0, 0.7)[:, None, None])

    times = np.array([0.0, 0.3, jump - 1e-7, jump + 1e-7, 1.0])
    (found,) = solve_pin(BAR, steel, (), (at(times),), Requirement(), between={"turn": at})
    assert found.peak.time == pytest.approx(CREST, abs=1e-5)
    assert len(found.loads) < 200
    assert found.peak.parts is not None
    assert found.peak.parts.time <= 1.1 * 0.001 * (found.peak.max_von_mises or 0.0)


def test_knots_are_where_loads_bend() -> None:
    """Two straight courses and a jump between samples are kept; so is an interval's share."""
    times = np.linspace(0.0, 1.0, 101)
    bent = np.where(times < 0.37, times, 0.37) + 3.0 * (times > 0.805)
    forces = bent[:, None, None] * [[[1.0, -2.0, 0.0]]]
    kept = knots(PinLoads("bent", ("A",), forces, times=times), 0.01, 4)
    assert set(kept.tolist()) >= {0, 25, 37, 50, 75, 80, 81, 100}
    assert len(kept) <= 9
    rebuilt = np.interp(times, times[kept], bent[kept])
    assert np.abs(rebuilt - bent).max() <= 0.01 * bent.max()
