"""Checks that are met with the joint as given, but not over what the study says is open of it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from assess.judgement import DEPENDS
from assess.margin import Margin
from assess.requirement import StatedRequirement
from assess.strength.model_stress import RUPTURE_METHOD
from pinstress.analysis.results import RunResults
from pinstress.explore.size.judged_pin import judged_pin
from pinstress.study.reading.in_python import study_from
from reports.data.headline import worst_checks
from reports.data.requirements import requirement_rows
from tests.support.pins.remembered import remembered

# In double shear; the clearance may be anything up to 0.3 mm.
TEXT = """
title = "Loose"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "700 MPa"
ultimate_strength = "900 MPa"
[analysis]
required_safety_factor = 1.0
[pin.P]
material = "steel"
profile = [
  { length = 2, diameter = 20 },
  { length = 10, diameter = 20, connection = "LEFT" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "EYE" },
  { length = 1, diameter = 20 },
  { length = 10, diameter = 20, connection = "RIGHT" },
  { length = 2, diameter = 20 },
]
[lug_defaults]
outer_diameter = 50
edge_radius = 0.5
CLEARANCE
[case.pull]
kind = "given"
forces = { LEFT = [-HALF, 0], EYE = [WHOLE, 0], RIGHT = [-HALF, 0] }
"""
TIGHT, LOOSE = "clearance = 0.0", "clearance = 0.3"
RANGED = "clearance = 0.0\nrange = { clearance = [0.0, 0.3] }"
RUBBING = "clearance = 0.02\nfriction = 0.2"
CASE = (
    'yield_strength = "700 MPa"',
    'hardened = { surface = "1100 MPa", core = "700 MPa", depth = "1.5 mm" }',
)
# Lugs whose stress is solved, too, which takes as long as all else.
SHANK = "[case.pull]", "[lug_defaults.shank]\nwidth = 50\n[case.pull]"
REPLACEABLE = "EN 1993 bending, replaceable"
BORE, BENDING, NET = "lug, von Mises stress at the bore", "bending, joint model", "lug, net section"


def solved(clearance: str, half: float, *swaps: tuple[str, str]) -> RunResults:
    text = TEXT.replace("CLEARANCE", clearance)
    text = text.replace("[analysis]", '[analysis]\nlimit_load = "never"')
    for old, new in swaps:
        text = text.replace(old, new)
    text = text.replace("HALF", f"{half}").replace("WHOLE", f"{2.0 * half}")
    return remembered(study_from(text))


def worst(results: RunResults, method: str) -> Margin:
    """The governing margin of a check at limit load."""
    margins = [m for m in results.pins[0].worst if m.method == method and m.level == "limit"]
    return max((m for m in margins if m.governs), key=lambda m: m.used)


def test_a_check_that_a_loose_joint_misses_depends() -> None:
    """Loads are such that each check is met with tight lugs and missed with loose ones, which a run
    of these shows. The first two were said to be met.
    """
    tight, loose, ranged = (solved(x, 20e3, SHANK) for x in (TIGHT, LOOSE, RANGED))
    for method, within in ((BORE, 0.02), (BENDING, 0.03)):
        given, there = worst(tight, method), worst(loose, method)
        assert given.demand is not None
        assert there.demand is not None
        assert there.demand > 1.03 * given.demand
        ours = worst(ranged, method)
        assert ours.demand is not None
        # Other variations of the joint may be worse than its clearance, but none is better.
        assert ours.over_joint * ours.demand > (1.0 - within) * there.demand
        between = (given.used * there.used) ** 0.5
        outcomes = {
            row.check: (row.outcome, row.over)
            for row in requirement_rows(solved(RANGED, 20e3 / between, SHANK))
            if row.level == "limit"
        }
        assert outcomes[method] == ("depends", "joint")


def test_a_size_that_meets_a_check_with_the_joint_as_given_alone_depends() -> None:
    """It was safe; the run of the study that it wrote depends."""
    swaps = (
        ("[analysis]", "[analysis]\nultimate_factor = 1.0"),
        ("[pin.P]", "[pin.P]\nreplaceable = true"),
        ("0.3] }", "0.3], stiffness = [1.0, 1.0] }"),  # stiff lugs use up the pin itself
    )
    tight, loose = (worst(solved(x, 20e3, *swaps), REPLACEABLE) for x in (TIGHT, LOOSE))
    results = solved(RANGED, 20e3 / (tight.used * loose.used) ** 0.5, *swaps)
    assert worst_checks(results)["P"].outcome == DEPENDS
    judged = judged_pin(results, "P")
    assert judged.outcome == DEPENDS
    assert judged.why.startswith(REPLACEABLE)
    assert judged.why.endswith("is met as described, but not over the joint (pull)")


def test_bending_knows_that_friction_adds_to_it_when_the_load_falls() -> None:
    """On each side of the middle of the eye friction along the bores adds two couples of mu R F, of
    the outer lug and of half the eye. It changed the stress of the row alone. What the joint adds
    without friction it multiplies.
    """
    half, radius, coefficient = 20e3, 10.0, 0.2
    margin = worst(solved(RUBBING, half), BENDING)
    assert margin.demand is not None
    moment = margin.demand * 3.14159265 * radius**3 / 4.0
    smooth = worst(solved(RUBBING.replace("0.2", "0.0"), half), BENDING)
    assert margin.demand == smooth.demand
    by_friction = 1.0 + 2.0 * coefficient * radius * half / moment
    assert margin.over_joint == pytest.approx(by_friction * smooth.over_joint, rel=1e-3)
    assert smooth.over_joint > 1.05


def test_rupture_of_a_hardened_pin_that_a_loose_joint_misses_depends() -> None:
    """It was met by the joint as given. The truth is a run with the largest clearance."""
    runs = [solved(x, 20e3, CASE).pins[0] for x in (TIGHT, LOOSE)]
    rupture = [m.safety_factor for x in runs for m in x.worst if m.method == RUPTURE_METHOD]
    ends = [x for x in rupture if x is not None]
    assert ends[1] < 0.97 * ends[0]
    between = (ends[0] * ends[1]) ** 0.5
    results = replace(
        solved(RANGED, 20e3, CASE),
        stated=(StatedRequirement("P", "pull", "ultimate", "rupture", between),),
    )
    (row,) = (r for r in requirement_rows(results) if r.check == "rupture" and r.stated)
    assert (row.outcome, row.over) == ("depends", "joint")


def test_a_formula_takes_the_largest_clearance() -> None:
    """That of ASME BTH-1 counts the clearance of the hole."""
    tight, loose, ranged = (worst(solved(x, 20e3), NET) for x in (TIGHT, LOOSE, RANGED))
    assert ranged.demand == loose.demand
    assert ranged.used > 1.03 * tight.used


def test_lugs_that_share_what_statics_does_not_decide_take_more_in_a_loose_joint() -> None:
    """Three cheeks of the structure about two eyes, beside a run with all lugs loose."""
    cheeks = (
        TEXT[: TEXT.index("profile")].replace("[analysis]", "[analysis]\ntolerance = 0.5")
        + """profile = [
  { length = 10, diameter = 20, name = "LEFT" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "ONE" },
  { length = 1, diameter = 20 },
  { length = 10, diameter = 20, name = "AMID" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "OTHER" },
  { length = 1, diameter = 20 },
  { length = 10, diameter = 20, name = "RIGHT" },
]
lug = { LEFT = {}, AMID = {}, RIGHT = {} }
[lug_defaults]
outer_diameter = 50
edge_radius = 0.5
CLEARANCE
[case.pull]
kind = "given"
forces = { ONE = [20000, 0], OTHER = [20000, 0] }
"""
    )
    found = {}
    for clearance in (TIGHT, LOOSE, RANGED):
        (row,) = remembered(study_from(cheeks.replace("CLEARANCE", clearance))).pins
        found[clearance] = {m.at: m for m in row.margins if m.method == "bearing"}
    given, there, ours = (found[x]["LEFT"] for x in (TIGHT, LOOSE, RANGED))
    assert given.demand is not None
    assert there.demand is not None
    assert ours.demand == given.demand
    assert there.demand > 1.05 * given.demand
    assert 0.99 * there.demand < ours.over_joint * given.demand < 1.1 * there.demand
    assert found[RANGED]["ONE"].over_joint == 1.0


@pytest.mark.long
@pytest.mark.slow
def test_the_hole_about_a_bushing_that_a_loose_joint_loads_more_depends() -> None:
    """Its stress grows by half with the clearance, and was met as of the joint as given."""
    ring = "bushing = { thickness = 2, material = 'steel', interference = 0.01 }"
    eye = "[lug_defaults]", f"[pin.P.lug.EYE]\n{ring}\nshank = {{ width = 50 }}\n[lug_defaults]"
    tight, loose, ranged = (solved(x, 15e3, eye).pins[0].joint for x in (TIGHT, LOOSE, RANGED))
    holes = [
        max((x for x in joint.lugs if x.wall == "hole"), key=lambda x: x.max_von_mises)
        for joint in (tight, loose, ranged)
        if joint is not None
    ]
    given, there, ours = holes
    assert there.max_von_mises > 1.2 * given.max_von_mises
    assert ours.max_von_mises == given.max_von_mises
    assert ours.over_joint * ours.max_von_mises > 0.99 * there.max_von_mises
