"""What of a joint is changed for its range."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from fea.core.material import Material
from fea.support.lugs.changes import JointChange, joint_variations, worst_together
from fea.support.lugs.lug import Lug, LugRange
from geometry import ArgumentError, Pin, Segment
from tests.support.each import each

STEEL = Material("steel", 210e9, 0.3)
PIN = Pin("P", (Segment(0.01, 0.02, connection="L"), Segment(0.02, 0.02, connection="M")))
TIGHT = Lug("L", 0.05, STEEL, tilt=math.inf)
LOOSE = Lug("M", 0.05, STEEL, clearance=1e-4, tilt=1e5)


def by_name(lugs: tuple[Lug, ...]) -> dict[tuple[str, str], JointChange]:
    return {(change.what, change.value): change for change in joint_variations(PIN, lugs)}


def test_the_usual_changes() -> None:
    found = by_name((TIGHT, LOOSE))
    assert list(found) == [
        ("clearance", "none"),
        ("clearance", "twice the given or 0.002 of the diameter"),
        ("stiffness of the lugs", "times 0.5"),
        ("stiffness of the lugs", "times 2"),
        ("tilt", "free"),
        ("tilt", "guided"),
    ]
    none, twice = (found["clearance", x] for x in ("none", list(found)[1][1]))
    assert [lug.clearance for lug in none.lugs] == [0.0, 0.0]
    assert [lug.clearance for lug in twice.lugs] == pytest.approx([4e-5, 2e-4])
    assert twice.length == pytest.approx(2e-4)
    assert found["stiffness of the lugs", "times 0.5"].softness == (2.0, 2.0)
    assert [lug.tilt for lug in found["tilt", "free"].lugs] == [0.0, 0.0]


def test_ranges_of_a_lugs_own() -> None:
    own = LugRange((1e-5, 3e-5), (0.8, 1.5), (1e4, 1e6))
    found = by_name((replace(TIGHT, range=own), replace(LOOSE, range=own)))
    low, high = (found["clearance", f"{end} end of its range"] for end in ("low", "high"))
    assert [lug.clearance for lug in (*low.lugs, *high.lugs)] == [1e-5, 1e-5, 3e-5, 3e-5]
    stiff = found["stiffness of the lugs", "times 1.5"]
    assert stiff.softness == pytest.approx((1 / 1.5, 1 / 1.5))
    assert [lug.tilt for lug in found["tilt", "high end of its range"].lugs] == [1e6, 1e6]
    assert len(found) == 6


def test_what_changes_nothing_is_left_out() -> None:
    known = LugRange(clearance=(0.0, 0.0), stiffness=(1.0, 1.0), tilt=(math.inf, math.inf))
    assert by_name((replace(TIGHT, range=known),)) == {}
    assert ("clearance", "none") not in by_name((TIGHT,))


@each(
    ("given", "code"),
    [
        ({"clearance": (2e-5, 1e-5)}, "range-order"),
        ({"stiffness": (2.0, 0.5)}, "range-order"),
        ({"tilt": (math.inf, 0.0)}, "range-order"),
        ({"stiffness": (0.0, 2.0)}, "not-positive"),
    ],
)
def test_impossible_ranges(given: dict[str, tuple[float, float]], code: str) -> None:
    with pytest.raises(ArgumentError) as error:
        LugRange(**given)
    assert error.value.code == code


def test_the_ends_that_go_farthest_are_changed_together() -> None:
    """For two measures, and for the least of the first."""
    lugs = (TIGHT, LOOSE)
    changes = list(by_name(lugs).values())
    first = [0.99, 1.03, 1.10, 0.9, 0.96, 0.95]  # clearance, stiffness, tilt
    second = [1.0, 1.0, 0.9, 0.8, 0.9, 0.8]  # raised by nothing
    most, least = worst_together(lugs, changes, list(zip(first, second, strict=True)))
    assert most.what == least.what == "together"
    assert most.value == f"clearance {changes[1].value}, stiffness of the lugs times 0.5"
    assert [(x.clearance, x.tilt) for x in most.lugs] == [
        (changes[1].lugs[0].clearance, math.inf), (changes[1].lugs[1].clearance, 1e5),
    ]  # fmt: skip
    assert most.softness == (2.0, 2.0)
    assert least.value == "clearance none, stiffness of the lugs times 2, tilt guided"
    assert [x.tilt for x in least.lugs] == [math.inf, math.inf]
    assert worst_together(lugs, changes[2:4], [(1.1,), (0.9,)]) == []  # one property alone
    assert worst_together(lugs, (), ()) == []


def test_of_what_does_little_alone_both_ends_are_tried() -> None:
    """Stiff lugs raise the stress of a loose pin by a third, of a tight one by nothing: the range
    of pin C of the landing gear ended at half of what both together give.
    """
    changes = list(by_name((TIGHT,)).values())  # clearance, soft, stiff, free
    found = worst_together((TIGHT,), changes, [(4.8,), (1.001,), (0.999,), (1.005,)])
    loose = "clearance 0.002 of the diameter"
    soft, stiff = (f"{loose}, stiffness of the lugs times {x}" for x in ("0.5", "2"))
    assert [x.value for x in found] == [f"{soft}, tilt free", soft, f"{stiff}, tilt free", stiff]
    # Where nothing does much there is nothing to look for.
    assert len(worst_together((TIGHT,), changes, [(1.01,), (1.001,), (0.999,), (1.005,)])) == 1
