"""Cuts of a pin on its drawing: sizes in words, hidden edges dashed."""

from __future__ import annotations

import math

from geometry import CutPin, Flat, Hole, Passage, Pin, Segment, Slot
from pinbase.records import in_units
from pinstress.analysis.gather.gather import cut_shapes
from pinstress.study.model.pins import outline
from reports.data.results import PinShape
from reports.page.pin_drawing import cut_words, draw_pin
from tests.support.results.made_up_run import make_results

MM = 1e-3
PIN = CutPin(
    Pin("P", (Segment(40 * MM, 20 * MM, connection="A"),)),
    (
        Hole(8 * MM, 4 * MM, 0.0, 6 * MM),
        Hole(16 * MM, 4 * MM, math.pi / 2),
        Flat(20 * MM, 24 * MM, 9 * MM, math.pi),
        Slot(30 * MM, 50 * MM, 4 * MM, 3 * MM),
        Passage(0.0, 5 * MM, 2 * MM, 6 * MM, -math.pi / 2, "start"),
    ),
)


def shape() -> PinShape:
    made = PinShape("P", tuple(outline(PIN)), "steel", None, (), tuple(cut_shapes(PIN)))
    return in_units(made, lambda dimension: MM if dimension == "length" else 1.0)


def test_sizes_in_words() -> None:
    assert [cut_words(cut) for cut in shape().cuts] == [
        "hole 1: ⌀4, 6 deep, z = 8, at 0°",
        "hole 2: ⌀4, through, z = 16, at 90°",
        "flat 1: 9 from the axis, z = 20 to 24, at 180°",
        "slot 1: 4 wide, 3 deep, z = 30 to 40, at 0°",
        "passage 1: ⌀2, 5 deep, z = 0 to 5, 6 from the axis at 270°",
    ]


def test_an_oblique_hole_in_words() -> None:
    aslant = Hole(8 * MM, 4 * MM, offset=-3 * MM, tilt=math.radians(15.0))
    (cut,) = cut_shapes(CutPin(PIN.profile, (aslant,)))
    words = cut_words(in_units(cut, lambda dimension: MM if dimension == "length" else 1.0))
    assert words == ("hole 1: ⌀4, through, 3 beside the axis, z = 8, at 0°, leaning 15° towards z")


def test_every_cut_is_drawn() -> None:
    svg = draw_pin(shape(), make_results().units)
    parts = svg.split('<g class="cut">')[1:]
    assert len(parts) == 5
    dashed = ["stroke-dasharray" in part.split("</g>")[0] for part in parts]
    assert dashed == [True, True, False, False, True]  # a hole through is hidden at the back
    assert ['fill="#fff"' in part.split("</g>")[0] for part in parts][2:4] == [True, True]
