"""Relations that hold between the answers to a pin and to the same pin said or loaded otherwise.

Exact ones hold to 1e-9, and to the last digit where the same numbers are worked with. Those between
different meshes hold within the sum of the errors that both report; so do those between units and
sizes, where coordinates differ in the last digit: gmsh then makes some other triangles.
"""

from __future__ import annotations

import math
import random
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.fuzz.loaded import Found, Loaded, draw, solve
from tests.fuzz.quantity import Quantity, Tree, length, mapped
from tests.support.each import in_turn, sampled

EXACT = 1e-9
# Sharp; held by nothing; bearing pressures and moments; with a groove. All take little time.
seeds = in_turn("seed", (4, 6, 9, 10))
pytestmark = pytest.mark.slow
EXPONENTS = {"length": (1, 0), "force": (0, 1), "moment": (1, 1), "stress": (-2, 1)}


@cache
def solved(seed: int) -> Found:
    """The drawn pin as it is, to compare with."""
    return solve(draw(seed))


def same(one: Found, other: Found) -> None:
    """To round-off, error, time and verdict included."""
    assert other.maximum == pytest.approx(one.maximum, rel=EXACT)
    assert other.error == pytest.approx(one.error, rel=1e-6)
    assert (other.time, other.verdict) == (one.time, one.verdict)


def within_errors(one: Found, other: Found) -> None:
    """As far as the two meshes know, and to round-off: sections under given loads have no error."""
    rounding = 1e-9 * one.maximum
    assert abs(one.maximum - other.maximum) <= one.error + other.error + rounding
    assert (one.time, one.verdict) == (other.time, other.verdict)


@seeds
@pytest.mark.parametrize("units", sampled(["in-lbf-s", "m-N-s", "words"], every=2))
def test_units_change_nothing(seed: int, units: str) -> None:
    pin = draw(seed)
    if units == "words":
        within_errors(solved(seed), solve(pin, random.Random(seed)))
    else:
        within_errors(solved(seed), solve(replace(pin, units=units)))


@seeds
def test_a_pin_of_another_size_under_the_square_of_it_is_stressed_as_much(seed: int) -> None:
    pin, k = draw(seed), 2.5

    def larger(q: Quantity) -> Quantity:
        a, b = EXPONENTS.get(q.dimension, (0, 0))
        return q if q.dimension == "stress" else q * k ** (a + 2 * b)

    within_errors(solved(seed), solve(mapped(pin.tree, larger)))


@seeds
@pytest.mark.parametrize("k", sampled([-1.0, 3.7, 1e-6], every=2))
def test_stress_is_as_many_times_as_large_as_the_loads(seed: int, k: float) -> None:
    """Of the other way round only where tension becomes pressure: a bearing only ever presses."""
    pin, size = draw(seed), abs(k)
    pin = replace(pin, distribution="uniform") if k < 0.0 else pin
    before = solve(pin) if k < 0.0 else solved(seed)
    found = solve(pin.under(lambda f, m: (k * f, k * m)))
    same(replace(before, maximum=size * before.maximum, error=size * before.error), found)


@seeds
@pytest.mark.parametrize("angle", sampled([0.7, math.pi / 2.0], every=2))
def test_loads_turned_about_the_axis_stress_as_much(seed: int, angle: float) -> None:
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    same(solved(seed), solve(draw(seed).under(lambda f, m: (f @ turn.T, m @ turn.T))))


@seeds
def test_loads_in_a_mirror_stress_as_much(seed: int) -> None:
    """In that of the plane x, z: moments are of the other sign where forces are not."""
    mirror = np.array([1.0, -1.0, 1.0])
    same(solved(seed), solve(draw(seed).under(lambda f, m: (f * mirror, -m * mirror))))


@seeds
def test_names_change_nothing(seed: int) -> None:
    """To the last digit, also where their order in the alphabet is another."""
    pin = draw(seed)
    names = {band: f"{'zyx'[i]} {band}" for i, band in enumerate(pin.bands)}
    profile = [
        s | {key: names.get(s[key], f"Ω {s[key]}") for key in ("connection", "name") if key in s}
        for s in pin.pin["profile"]
    ]
    clamp = [x if x in ("start", "end") else names.get(x, f"Ω {x}") for x in pin.pin["clamp"]]
    table = pin.pin | {"profile": profile, "clamp": clamp}
    assert solve(replace(pin, pin=table, name="E 7", case="Ünit")) == solved(seed)


def reversed_pin(pin: Loaded) -> Loaded:
    """The same body, z counted from its other end."""
    profile: list[Tree] = pin.pin["profile"]
    corners = [s.get("fillet") for s in profile[:-1]]
    turned = []
    for segment, fillet in zip(profile[::-1], [*corners[::-1], None], strict=True):
        bare = {key: value for key, value in segment.items() if key != "fillet"}
        turned.append(bare | ({} if fillet is None else {"fillet": fillet}))
    faces = {"start": "end", "end": "start"}
    table = pin.pin | {"profile": turned, "clamp": [faces.get(c, c) for c in pin.pin["clamp"]]}
    mirror = np.array([1.0, 1.0, -1.0])
    made = replace(pin, pin=table)
    return made.under(lambda f, m: (f[:, ::-1] * mirror, -m[:, ::-1] * mirror))


@seeds
def test_a_pin_may_be_told_from_its_other_end(seed: int) -> None:
    within_errors(solved(seed), solve(reversed_pin(draw(seed))))


@seeds
def test_a_segment_may_be_told_as_two(seed: int) -> None:
    """One that nothing bears on and nothing holds; where there is none, a stub is put to the end
    first.
    """
    pin = draw(seed)
    profile: list[Tree] = pin.pin["profile"]
    held = set(pin.pin["clamp"])
    free = [i for i, s in enumerate(profile) if "name" in s and s["name"] not in held]
    before = pin
    if not free:
        last = profile[-1]
        stub = {"length": last["diameter"] * 0.5, "diameter": last["diameter"], "name": "stub"}
        stub |= {key: last[key] for key in ("bore",) if key in last}
        profile, free = [*profile, stub], [len(profile)]
        before = replace(pin, pin=pin.pin | {"profile": profile})
    whole = profile[free[0]]
    first = {k: v for k, v in whole.items() if k != "fillet"} | {"length": whole["length"] * 0.4}
    second = whole | {"length": whole["length"] * 0.6, "name": "rest"}
    parts = [*profile[: free[0]], first, second, *profile[free[0] + 1 :]]
    one = solved(seed) if before is pin else solve(before)
    within_errors(one, solve(replace(pin, pin=pin.pin | {"profile": parts})))


@seeds
def test_instants_that_come_again_change_nothing(seed: int) -> None:
    """The first of the largest governs. The least order of the meshes is known from all instants,
    so to round-off only.
    """
    same(solved(seed), solve(draw(seed).at(0, 1, 2, 0, 1, 2)))


@seeds
def test_time_may_run_backwards(seed: int) -> None:
    before, found = solved(seed), solve(draw(seed).at(2, 1, 0))
    assert before.time is not None
    same(replace(before, time=1.0 - before.time), found)


@seeds
def test_a_course_is_as_bad_as_its_worst_instant(seed: int) -> None:
    pin = draw(seed)
    alone = [solve(pin.at(k)) for k in range(3)]
    worst = max(alone, key=lambda found: found.maximum)
    whole = solved(seed)
    assert abs(whole.maximum - worst.maximum) <= whole.error + worst.error


@seeds
def test_two_loads_together_are_no_worse_than_the_sum_of_both(seed: int) -> None:
    """Von Mises stress is a norm. Not of bearing pressures, which turn with the force: the sum of
    two is another pressure.
    """
    pin = replace(draw(seed), distribution="uniform")
    one, two = (solve(pin.at(k)) for k in (0, 1))
    both = solve(pin.at(0).under(lambda f, m: (f + pin.forces[1], m + pin.moments[1])))
    errors = both.error + one.error + two.error
    assert abs(one.maximum - two.maximum) - errors <= both.maximum
    assert both.maximum <= one.maximum + two.maximum + errors


@seeds
def test_a_softer_material_is_stressed_as_much(seed: int) -> None:
    tree = draw(seed).tree
    steel: Tree = tree["material"]["steel"]
    soft = steel | {"youngs_modulus": steel["youngs_modulus"] * 1e-3}
    same(solved(seed), solve(tree | {"material": {"steel": soft}}))


@seeds
def test_the_order_of_rows_and_keys_changes_nothing(seed: int) -> None:
    pin = draw(seed)
    tree = pin.tree
    tree["pin"][pin.name] = dict(reversed(tree["pin"][pin.name].items()))
    case = tree["case"][pin.case]
    case["table"] = replace(case["table"], rows=case["table"].rows[::-1])
    assert solve(dict(reversed(tree.items()))) == solved(seed)


def test_a_beam_scales_with_its_loads_and_its_size() -> None:
    """A long shaft, which a beam answers."""
    profile = [
        {"length": length(0.2), "diameter": length(0.02), "name": "shaft"},
        {"length": length(0.05), "diameter": length(0.02), "connection": "P0"},
    ]
    forces = np.array([[[10.0, 200.0, 30.0]], [[-300.0, 100.0, 0.0]]])
    beam = Loaded({"material": "steel", "clamp": ["start"], "profile": profile}, forces,
                  np.zeros((2, 1, 3)), np.array([0.0, 0.5]))  # fmt: skip
    before = solve(beam, model="beam")
    found = solve(beam.under(lambda f, m: (-2.0 * f, m)), model="beam")
    same(replace(before, maximum=2.0 * before.maximum, error=2.0 * before.error), found)
    same(before, solve(replace(beam, units="in-lbf-s"), model="beam"))
