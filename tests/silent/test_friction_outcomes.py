"""What friction takes off the stress while a load grows must not make a pin safe; what it adds when
a load falls, or links turn, must not be silent.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

import pinstress
from fea.support.contact.cell_error import NOWHERE
from fea.support.contact.variations import ResolutionComparison, joint_range
from fea.support.records import FRICTION, JointRange, Variation
from reports.data.dependence import depends_on
from reports.data.row import PinResult
from reports.data.unknowns import unknowns
from reports.format.words import result_words
from tests.fea.support.contact.test_solve_in_lugs import STEADY
from tests.silent.test_outcomes import in_contact


def with_friction(factor: float, low: float, high: float) -> PinResult:
    """A pin whose stress friction changes by these ratios; 1.5 is required."""
    pin = in_contact(factor)
    assert pin.joint is not None
    stress = pin.max_von_mises or 0.0
    variations = (
        Variation(FRICTION, "0.15, load growing", low * stress),
        Variation(FRICTION, "0.15, load falling", high * stress),
    )
    over = JointRange((stress, max(stress, high * stress)), variations)
    return replace(pin, joint=replace(pin.joint, range=over))


def test_a_safe_pin_depends_on_friction_that_adds() -> None:
    pin = with_friction(1.8, 0.8, 1.3)
    (over,) = depends_on(pin)
    assert (over.what, over.value, over.over) == ("friction", "0.15, load falling", "joint")
    assert over.factor == pytest.approx(1.8 / 1.3)
    assert result_words(replace(pin, depends_on=(over,))) == "depends: joint"
    assert depends_on(with_friction(1.8, 0.8, 1.1)) == ()


def test_a_pin_that_fails_is_never_safe_by_friction() -> None:
    assert depends_on(with_friction(1.4, 0.8, 1.3)) == ()


def test_the_range_over_the_joint_has_no_lower_end_by_friction() -> None:
    over = (
        Variation("tilt", "guided", 0.95),
        Variation(FRICTION, "0.15, load growing", 0.8),
        Variation(FRICTION, "0.15, load falling", 1.3),
    )
    known = ResolutionComparison(NOWHERE, NOWHERE, STEADY, over)
    assert joint_range(known.over, 200.0).max_von_mises == pytest.approx((190.0, 260.0))


def test_friction_is_an_open_value_that_only_lowers_the_factor() -> None:
    pin = with_friction(1.8, 0.8, 1.3)
    pin = replace(pin, depends_on=depends_on(pin))
    ((_, value),) = (row for unknown in unknowns([pin]) for row in unknown.rows)
    assert value.what == "friction"
    assert value.high == pytest.approx(1.8)
    assert value.low == pytest.approx(1.8 / 1.3)
    assert value.flips is not None


RUBBED = """
title = "Friction around prescribed loads"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"
fatigue = { knee_stress = "300 MPa", knee_cycles = 1e6, slope = 5, mean_stress_sensitivity = 0.2 }
[analysis]
joints = "prescribed"
model = "beam"
tolerance = 0.9
[fatigue]
unit = "flight"
life = 1
[fatigue.occurrences]
pull = 1
[case.pull]
kind = "given"
forces = { L = [-25000, 0], M = [50000, 0] }
[lug_defaults]
friction = 0.3
[pin.P]
material = "steel"
balance = "R"
profile = [
  { length = 10, diameter = 20, connection = "L" },
  { length = 20, diameter = 20, connection = "M" },
  { length = 10, diameter = 20, connection = "R" },
]
"""


def test_what_leaves_out_the_stated_friction_says_so() -> None:
    """The range of prescribed loads was without it, and fatigue without its torque, in silence."""
    for friction in (0.3, 0.0):
        text = RUBBED.replace("friction = 0.3", f"friction = {friction}")
        results = pinstress.run(pinstress.study_from(text))
        joint, fatigue = results["P", "pull"].joint, results.fatigue
        assert joint is not None
        assert joint.range is not None
        assert ("not included: friction in lugs" in joint.remark) is (friction > 0.0)
        assert fatigue is not None
        said = [x for x in fatigue.left_out if x.startswith("Friction in lugs: its torque")]
        assert len(said) == (friction > 0.0)
        assert all(x.endswith("pin P.") for x in said)
