"""What of a joint is changed for its range."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from fea.core.material import Material
from fea.support.lugs.changes import JointChange, joint_variations
from fea.support.lugs.lug import Lug, LugRange
from fea.support.records import TOGETHER
from geometry import ArgumentError, Pin, Segment
from tests.support.each import each

STEEL = Material("steel", 210e9, 0.3)
PIN = Pin("P", (Segment(0.01, 0.02, connection="L"), Segment(0.02, 0.02, connection="M")))
TIGHT = Lug("L", 0.05, STEEL, tilt=math.inf)
LOOSE = Lug("M", 0.05, STEEL, clearance=1e-4, tilt=1e5)


def by_name(lugs: tuple[Lug, ...]) -> dict[tuple[str, str], JointChange]:
    """The changes of one property."""
    every = joint_variations(PIN, lugs)
    return {(change.what, change.value): change for change in every if change.what != TOGETHER}


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


def test_all_ends_are_changed_together() -> None:
    """In every combination: stiff lugs raise the stress of a pin in a clearance by half that they
    leave alone without it. Of a property with one change the other end is as given; tilt may be as
    given, too, where some lugs are free and others guided.
    """
    lugs = (TIGHT, LOOSE)
    alone = list(by_name(lugs).values())
    corners = {x.value: x for x in joint_variations(PIN, lugs) if x.what == TOGETHER}
    assert len(corners) == 12
    some = alone[1], alone[2], alone[5]  # loose, soft, guided
    both = corners[", ".join(f"{x.what} {x.value}" for x in some)]
    assert [x.clearance for x in both.lugs] == [x.clearance for x in alone[1].lugs]
    assert (both.softness, [x.tilt for x in both.lugs]) == ((2.0, 2.0), [math.inf, math.inf])
    # Of a tight, guided lug: loose or not, free or not, soft and stiff.
    every = [x.value for x in joint_variations(PIN, (TIGHT,)) if x.what == TOGETHER]
    soft, stiff = (f"stiffness of the lugs times {x}" for x in ("0.5", "2"))
    loose = "clearance 0.002 of the diameter"
    assert every == [
        f"{loose}, {soft}, tilt free", f"{loose}, {soft}", f"{loose}, {stiff}, tilt free",
        f"{loose}, {stiff}", f"{soft}, tilt free", f"{stiff}, tilt free",
    ]  # fmt: skip
    known = replace(TIGHT, range=LugRange(clearance=(0.0, 0.0), tilt=(math.inf, math.inf)))
    assert [x.what for x in joint_variations(PIN, (known,))] == ["stiffness of the lugs"] * 2
