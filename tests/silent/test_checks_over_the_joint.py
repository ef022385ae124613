"""Checks that are met with the joint as given, but not over what the study says is open of it."""

from __future__ import annotations

from functools import cache

import pinstress
from assess.margin import Margin
from pinstress.study.reading.in_python import study_from
from reports.data.requirements import requirement_rows

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
[lug_defaults.shank]
width = 50
[case.pull]
kind = "given"
forces = { LEFT = [-HALF, 0], EYE = [WHOLE, 0], RIGHT = [-HALF, 0] }
"""
TIGHT, LOOSE = "clearance = 0.0", "clearance = 0.3"
RANGED = "clearance = 0.0\nrange = { clearance = [0.0, 0.3] }"
BORE, BENDING, NET = "lug, von Mises stress at the bore", "bending, joint model", "lug, net section"


@cache
def solved(clearance: str, half: float) -> pinstress.RunResults:
    text = TEXT.replace("CLEARANCE", clearance)
    text = text.replace("HALF", f"{half}").replace("WHOLE", f"{2.0 * half}")
    return pinstress.run(study_from(text))


def worst(results: pinstress.RunResults, method: str) -> Margin:
    """The governing margin of a check at limit load."""
    margins = [m for m in results.pins[0].worst if m.method == method and m.level == "limit"]
    return max((m for m in margins if m.governs), key=lambda m: m.used)


def test_a_check_that_a_loose_joint_misses_depends() -> None:
    """Loads are such that each check is met with tight lugs and missed with loose ones, which a run
    of these shows. The first two were said to be met.
    """
    tight, loose, ranged = (solved(x, 20e3) for x in (TIGHT, LOOSE, RANGED))
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
            for row in requirement_rows(solved(RANGED, 20e3 / between))
            if row.level == "limit"
        }
        assert outcomes[method] == ("depends", "joint")


def test_a_formula_takes_the_largest_clearance() -> None:
    """That of ASME BTH-1 counts the clearance of the hole."""
    tight, loose, ranged = (worst(solved(x, 20e3), NET) for x in (TIGHT, LOOSE, RANGED))
    assert ranged.demand == loose.demand
    assert ranged.used > 1.03 * tight.used


def test_lugs_that_share_what_statics_does_not_decide_take_more_in_a_loose_joint() -> None:
    """Three cheeks of the structure about two eyes, beside a run with all lugs loose."""
    cheeks = (
        TEXT[: TEXT.index("profile")]
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
        study = study_from(cheeks.replace("CLEARANCE", clearance))
        (row,) = pinstress.run(study, tolerance=0.5).pins
        found[clearance] = {m.at: m for m in row.margins if m.method == "bearing"}
    given, there, ours = (found[x]["LEFT"] for x in (TIGHT, LOOSE, RANGED))
    assert given.demand is not None
    assert there.demand is not None
    assert ours.demand == given.demand
    assert there.demand > 1.05 * given.demand
    assert 0.99 * there.demand < ours.over_joint * given.demand < 1.1 * there.demand
    assert found[RANGED]["ONE"].over_joint == 1.0
