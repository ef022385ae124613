"""The forces of the ground on a wheel: every sum, direction and point of application."""

from __future__ import annotations

import math

import numpy as np
import pytest

from loads.landing import GROUND_RULES, GroundedWheel, spin_up_drag
from loads.landing.requirements import MAX_TYRE_FRICTION, RULES_OF_PART
from tests.support.mechanism.space import vector

LEFT_WARDS = GroundedWheel(
    (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), "left", 0.4
)  # flies to -x: its left is +z


def test_components_are_those_of_the_clauses() -> None:
    """Fractions written out from the paragraphs, of 1 kN: vertical, drag, side."""
    expected = {
        "25.479-drag": (1000.0, 250.0, 0.0),
        "25.479-drift": (750.0, 0.40 * 750.0, 0.25 * 750.0),
        "25.473-spin-up": (1000.0, 800.0, 0.0),
        "25.473-spring-back": (1000.0, -800.0, 0.0),
        "23.D-spin-up": (1000.0, 800.0, 0.0),
        "23.D-spring-back": (1000.0, -800.0, 0.0),
        "23.479-drag": (1000.0, 250.0, 0.0),
        "23.499-aft": (2250.0, 0.8 * 2250.0, 0.0),
        "23.499-forward": (2250.0, -0.4 * 2250.0, 0.0),
        "23.499-side": (2250.0, 0.0, 0.7 * 2250.0),
    }
    assert expected.keys() == GROUND_RULES.keys()
    for name, (vertical, drag, side) in expected.items():
        forces = LEFT_WARDS.forces(GROUND_RULES[name], 1000.0, "left")
        total = np.sum([force.force for force in forces], axis=0)
        assert total == pytest.approx((drag, vertical, side)), name
        for force in forces:
            assert force.factor > 0.0
            assert math.hypot(*force.force) == pytest.approx(force.factor * force.reference)


def test_drag_never_exceeds_the_friction_that_is_required() -> None:
    for name, rule in GROUND_RULES.items():
        assert abs(rule.drag) <= MAX_TYRE_FRICTION * rule.vertical * (1 + 1e-12), name


def test_every_rule_belongs_to_one_list() -> None:
    assert sorted(rule for rules in RULES_OF_PART.values() for rule in rules) == sorted(
        GROUND_RULES
    )


def test_sides_are_those_of_a_pilot_who_looks_forward() -> None:
    """Left is up x forward, in a right-handed system, for any plane and either direction."""
    for turn in (0.0, 0.7, 2.0):
        up = np.array([-math.sin(turn), math.cos(turn), 0.0])
        for sign in (1.0, -1.0):
            aft = sign * np.array([math.cos(turn), math.sin(turn), 0.0])
            left = np.cross(up, -aft)
            axes = vector(up), vector(aft)
            for leg, outboard in (("left", left), ("right", -left)):
                wheel = GroundedWheel(*axes, leg)
                assert wheel.sideways("outboard") == pytest.approx(outboard, abs=1e-12)
                assert wheel.sideways("inboard") == pytest.approx(-outboard, abs=1e-12)
                assert wheel.sideways("left") == pytest.approx(left, abs=1e-12)
                assert wheel.sideways("right") == pytest.approx(-left, abs=1e-12)


def test_forces_act_at_the_ground_or_at_the_axle() -> None:
    """A rolling wheel passes on drag at its axle, a braked one with the moment drag × radius."""
    drift = GROUND_RULES["25.479-drift"]
    rolling = {f.component: f for f in LEFT_WARDS.forces(drift, 1e4, "left")}
    assert rolling["drag"].couple == (0.0, 0.0, 0.0)
    assert rolling["vertical"].couple == pytest.approx((0.0, 0.0, 0.0))
    # (0, -r, 0) x (0, 0, F) = (-r F, 0, 0): the leg bends to the left at its foot
    assert rolling["side"].couple == pytest.approx((-0.4 * 0.1875e4, 0.0, 0.0))
    braked = GroundedWheel((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), "left", 0.4, braked=True)
    drag = {f.component: f for f in braked.forces(drift, 1e4, "left")}["drag"]
    assert drag.couple == pytest.approx((0.0, 0.0, 0.4 * 0.3e4))
    no_radius = GroundedWheel((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), "left")
    assert {f.place for f in no_radius.forces(drift, 1e4, "left")} == {"axle"}


def test_spin_up_gives_the_wheel_its_energy_over_the_time() -> None:
    """Appendix D: F_H^2 r^2 = 2 I v n F / t below the limit, and n F from there on."""
    inertia, radius, speed, vertical, time = 0.9, 0.3, 40.0, 5e4, 0.15
    drag = spin_up_drag(inertia, radius, speed, vertical, time)
    assert (drag * radius) ** 2 * time == pytest.approx(2 * inertia * speed * 0.8 * vertical)
    assert drag < 0.8 * vertical
    limit = 0.8 * vertical * radius**2 * time / (2 * speed)  # inertia at which friction governs
    assert spin_up_drag(0.999 * limit, radius, speed, vertical, time) < 0.8 * vertical
    assert spin_up_drag(1.001 * limit, radius, speed, vertical, time) == 0.8 * vertical
