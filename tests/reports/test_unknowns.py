"""What a study leaves open: the spread of factors, what flips an outcome, and both ranges together.

Independent values: a factor is in inverse proportion to the stress, and the stress of a landing to
its force (speed over time, times pi / 2 for a half-sine).
"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from assess.judgement import DEPENDS, FAILS, SAFE
from fea.support.records import TOGETHER, JointRange, Variation, range_ends
from pinstress import changed_study, load_study, run
from reports.data.dependence import depends_on
from reports.data.headline import JudgedCheck
from reports.data.overview import PinLine, pin_lines
from reports.data.results import Results
from reports.data.row import PinResult, Units
from reports.data.unknowns import factor_spread, open_values, unknowns
from reports.format.words import but_words, over_words
from reports.page.overview import nothing_to_change
from reports.text.certainty import (
    certainty,
    excess_stress,
    flips,
    flips_words,
    measure_first,
    range_words,
)
from reports.text.overview import actions
from tests.conftest import ROOT
from tests.silent.test_outcomes import landing
from tests.support.results.judged_results import row
from tests.support.results.made_up_joint import make_joint
from tests.support.results.rows import with_values

UNITS = Units("in", "lbf", "psi", "s")
BOTH = ("rectangular", "half-sine")


def pin(
    factor: float, joint: tuple[float, float] | None, pulses: tuple[str, ...] = ()
) -> PinResult:
    """1.5 is required. joint: ends of the stress over the tilt, over that of the row."""
    made = row("x", "converged", factor, factor > 1.5)
    stress = made.max_von_mises or 0.0
    if joint is not None:
        ends = (min(joint[0], 1.0) * stress, max(joint[1], 1.0) * stress)
        over = JointRange(
            ends,
            (
                Variation("tilt", "free", joint[0] * stress),
                Variation("tilt", "guided", joint[1] * stress),
            ),
        )
        made = replace(made, joint=replace(make_joint(), range=over))
    if pulses:
        made = replace(made, landing=landing(factor, pulses))
    return replace(made, depends_on=depends_on(made))


def test_two_ranges_that_change_an_outcome_only_together() -> None:
    """2.6: 2.6 / 1.5 = 1.733 at 0.1 s, 2.6 / 1.3 = 2.0 guided, 2.6 / 1.95 = 1.333 with both."""
    alone = pin(2.6, None, ("rectangular",)), pin(2.6, (0.9, 1.3))
    assert [p.outcome for p in alone] == [SAFE, SAFE]
    both = pin(2.6, (0.9, 1.3), ("rectangular",))
    assert both.outcome == DEPENDS
    assert both.meets_required is False
    (over,) = both.depends_on
    assert (over.over, over.what) == ("joint and landing", TOGETHER)
    assert over.factor == pytest.approx(2.6 / 1.5 / 1.3, rel=1e-9)
    assert over_words(both.depends_on) == "joint and landing"
    assert flips(both, UNITS) == "the joint and landing values together"
    assert pin(3.1, (0.9, 1.3), ("rectangular",)).outcome == SAFE  # 3.1 / 1.95 = 1.59


def test_properties_of_a_joint_that_change_an_outcome_only_together() -> None:
    """2.0 of 1.5: 1.67 with soft lugs, 1.54 with free ones, 1.28 with both; friction adds 10 %."""

    def of(*over: tuple[str, str, float]) -> PinResult:
        made = row("x", "converged", 2.0, True)
        stress = made.max_von_mises or 0.0
        variations = [Variation(what, value, times * stress) for what, value, times in over]
        ends = range_ends(stress, variations)
        joint = replace(make_joint(), range=JointRange(ends, tuple(variations)))
        made = replace(made, joint=joint)
        return replace(made, depends_on=depends_on(made))

    soft, free = ("stiffness", "times 0.5", 1.2), ("tilt", "free", 1.3)
    assert of(soft, free).outcome == SAFE
    # Stiff lugs that are free change it as well, by less.
    stiff = TOGETHER, "stiffness times 2, tilt free", 1.4
    both = of(soft, free, stiff, (TOGETHER, "stiffness times 0.5, tilt free", 1.56))
    (d,) = both.depends_on
    assert (d.over, d.what) == ("joint", TOGETHER)
    assert d.factor == pytest.approx(2.0 / 1.56)
    assert flips(both, UNITS) == "the joint values together"
    assert over_words(both.depends_on) == "joint"
    assert "(several properties together)" in but_words(both.depends_on, UNITS)
    assert [x.what for x in open_values(both)] == ["stiffness", "tilt"]
    # What one changes alone is named, not the others with it.
    stiffer = of(("tilt", "free", 1.4), (TOGETHER, "stiffness times 0.5, tilt free", 1.7))
    assert [x.what for x in stiffer.depends_on] == ["tilt"]
    rubbed = of(free, ("friction", "0.15", 1.1))
    (d,) = rubbed.depends_on
    assert (d.what, d.value) == (TOGETHER, "all properties and friction")
    assert d.factor == pytest.approx(2.0 / 1.43)


def test_a_range_without_one_property_has_the_product_of_the_others() -> None:
    over = [Variation("clearance", "0", 1.1), Variation("tilt", "free", 1.2),
            Variation("stiffness", "2", 0.9), Variation(TOGETHER, "all", 1.4)]  # fmt: skip
    joint = JointRange(range_ends(1.0, over), tuple(over))
    assert joint.max_von_mises == (0.9, 1.4)
    rest = joint.without("clearance", 1.0)
    assert rest.max_von_mises == pytest.approx((0.9, 1.2))
    assert [x.what for x in rest.variations] == ["tilt", "stiffness"]
    assert joint.without("tilt", 1.0).max_von_mises == pytest.approx((0.9, 1.1))


def test_pins_whose_ranges_straddle_the_requirement_are_told_apart(results: Results) -> None:
    """Those that fail as described and those that depend had the same bars, and no word on it."""
    rows = {"A": pin(1.0, (0.9, 1.1)), "B": pin(1.2, (0.7, 1.1)), "C": pin(1.7, (0.9, 1.3)),
            "D": pin(9.0, (0.9, 1.1))}  # fmt: skip
    pins = tuple(with_values(row, pin=name) for name, row in rows.items())
    lines = pin_lines(replace(results, pins=pins, spectrum_margins=()))
    assert {x.pin: x.outcome for x in lines} == {"A": FAILS, "B": FAILS, "C": DEPENDS, "D": SAFE}
    assert certainty(lines) == [
        "A fails at all open values; B fails as described and is safe at some; C is safe as "
        "described and fails at some."
    ]
    assert excess_stress(lines) == ["Even B has 25 % more than the permitted stress."]
    assert excess_stress([x for x in lines if x.pin == "A"]) == [
        "A has 1.5 times the permitted stress."
    ]
    assert excess_stress([x for x in lines if x.outcome == SAFE]) == []
    strict = [replace(x, row=with_values(x.row, required=10.0)) if x.pin == "B" else x
              for x in lines]  # fmt: skip
    assert excess_stress(strict) == ["Even A has 1.5 times the permitted stress."]


def test_a_pin_that_fails_may_be_safe_only_with_both() -> None:
    """0.55: 1.375 at 10 ft/s, 0.611 at 0.9 of the stress; 1.83 at 0.2 s and 10 ft/s alone."""
    failing = pin(0.4, (0.6, 1.1), ("rectangular",))  # 0.4 * 2.5 * 4/3 = 1.333; / 0.6 = 2.22
    assert failing.outcome == FAILS
    assert [d.over for d in failing.depends_on] == ["joint and landing"]
    assert pin(0.2, (0.6, 1.1), ("rectangular",)).depends_on == ()  # 1.11: fails whatever


def test_the_spread_is_the_product_of_the_ratios() -> None:
    """Speeds 10 to 25 ft/s of 25, 0.1 to 0.2 s of 0.15, a half-sine pi / 2, tilt 0.9 to 1.3."""
    spread = factor_spread(pin(4.0, (0.9, 1.3), BOTH))
    assert spread is not None
    assert spread[0] == pytest.approx(4.0 / 1.5 / (math.pi / 2.0) / 1.3)
    assert spread[1] == pytest.approx(4.0 * 2.5 * (4.0 / 3.0) / 0.9)
    assert factor_spread(pin(4.0, None)) is None
    assert factor_spread(pin(4.0, (1.0, 1.0))) == (4.0, 4.0)


def test_a_joint_that_may_take_all_stress_off_leaves_no_upper_end() -> None:
    """The error of a beam on foundations reaches zero on a stub, which ended a run."""
    no_stress = pin(4.0, (0.0, 1.25))
    assert factor_spread(no_stress) == pytest.approx((3.2, math.inf))
    first = unknowns([no_stress])[0]
    assert (first.what, first.rows[0][1].high) == ("tilt", math.inf)


def test_each_open_value_alone() -> None:
    values = {v.what: v for v in open_values(pin(4.0, (0.9, 1.3), BOTH))}
    assert list(values) == ["impulse time", "velocity change", "pulse", "tilt"]
    time, speed, pulse, tilt = values.values()
    assert (time.low, time.high) == pytest.approx((4.0 / 1.5, 4.0 * 4.0 / 3.0))
    assert time.ends == (0.1, 0.2)
    assert (speed.low, speed.high) == pytest.approx((4.0, 10.0))
    assert (pulse.low, pulse.high) == pytest.approx((4.0 / (math.pi / 2.0), 4.0))
    assert (tilt.low, tilt.high) == pytest.approx((4.0 / 1.3, 4.0 / 0.9))
    assert (pulse.states, tilt.states) == (BOTH, ("free", "guided"))
    assert not any(v.flips for v in values.values())


def test_a_check_by_formula_that_depends_is_named_for_each_value_of_its_range() -> None:
    """The table said "no" for all values beside a pin that depends by its shear."""
    row = pin(9.0, (0.9, 1.3), BOTH)
    check = JudgedCheck("A", row.case, "shear", DEPENDS, 1.1, 1.0, 0.9, reason="joint")
    line = PinLine(row, check, row.case, None, None, None)
    words = {u.what: flips_words(u, UNITS, [line]) for u in unknowns([row])}
    assert words.pop("tilt") == "perhaps: A in shear"
    assert set(words.values()) == {"no"}


def test_what_flips_most_pins_comes_first_then_what_matters_most() -> None:
    """2.3 / (pi / 2) = 1.46: the pulse flips; 1.533 at 0.1 s and a tilt of 1.3 do not."""
    rows = [pin(2.3, (0.9, 1.3), BOTH), with_values(pin(9.0, (0.9, 1.3), BOTH), pin="B")]
    ranked = unknowns(rows)
    assert [u.what for u in ranked] == ["pulse", "velocity change", "impulse time", "tilt"]
    assert flips_words(ranked[0], UNITS) == "A may fail with half-sine"
    assert [flips_words(u, UNITS) for u in ranked[1:]] == ["no"] * 3
    assert range_words(ranked[2], UNITS) == "0.1 to 0.2 s"
    assert measure_first(ranked) == ["Measure first: force over time at landing (A)."]
    (nothing,) = measure_first(unknowns(rows[1:]))
    assert nothing.startswith("Nothing open changes an outcome alone; velocity change matters most")


def test_what_alone_decides_of_a_joint_is_to_be_measured() -> None:
    """All of a joint was, where its tilt decides."""
    tilts = unknowns([pin(1.7, (0.9, 1.3))])
    assert measure_first(tilts) == ["Measure first: tilt (A)."]
    (over,) = pin(2.6, (0.9, 1.3), ("rectangular",)).depends_on
    together = replace(pin(1.7, (0.9, 1.1)), depends_on=(replace(over, over="joint"),))
    assert measure_first(unknowns([together])) == [
        "Measure first: clearance and stiffness of the lugs (A)."
    ]


def test_a_row_that_may_lose_all_its_stress_hides_no_other() -> None:
    """As an idle press fit without interference does: its factor has no upper end."""
    rows = [pin(9.0, (0.9, 1.3)), with_values(pin(8.0, (0.0, 1.0)), pin="idle")]
    (tilt,) = unknowns(rows)
    assert tilt.ratio == pytest.approx(1.3 / 0.9)
    assert measure_first([tilt]) == [
        "Nothing open changes an outcome alone; tilt matters most (factor of A 6.92 to 10.0)."
    ]
    assert unknowns(rows[1:])[0].ratio == math.inf


def test_what_to_do_about_a_pin_that_depends_is_to_narrow_its_ranges(results: Results) -> None:
    """The page said that no change is known."""
    rows = [with_values(pin(1.7, (0.9, 1.3)), pin=name) for name in "CD"]
    lines = pin_lines(replace(results, pins=(rows[0],), spectrum_margins=()))
    assert nothing_to_change(lines).startswith("Narrow the ranges on which C depends")
    both = pin_lines(replace(results, pins=tuple(rows), spectrum_margins=()))
    assert nothing_to_change(both).startswith("Narrow the ranges on which C and D depend")


def test_a_pin_that_depends_is_told_how_to_be_sized_over_its_ranges() -> None:
    study = ROOT / "studies" / "clevis.toml"
    results = run(changed_study(load_study(study), {"analysis.required_safety_factor": 2.2}))
    assert [p.outcome for p in results.pins] == [DEPENDS]
    steps = actions(results, pin_lines(results), "studies/clevis.toml")
    assert steps.command == "pinstress size studies/clevis.toml --pins P --over-ranges"
