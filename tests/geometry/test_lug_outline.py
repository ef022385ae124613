"""How lugs bend out of their plane, by their outlines."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from geometry.shape.lug_outline import LugOutline
from pinbase.errors import ArgumentError
from tests.support.errors import raises


def test_a_plate_with_a_small_hole_bends_as_a_beam() -> None:
    plate = LugOutline("square", 0.001, 0.0, 0.05, 0.2, 0.05)
    assert plate.bending == pytest.approx(0.2 / 0.05, rel=1e-3)


def test_the_hole_takes_width() -> None:
    """The integral of dx / (w - 2 sqrt(r^2 - x^2)), closed by x = r sin a."""
    r, w, length = 0.01, 0.05, 0.05
    k = 2.0 * r / w
    turn = 2.0 / math.sqrt(1.0 - k * k) * math.atan(math.sqrt((1.0 + k) / (1.0 - k)))
    beside = -math.pi / 4.0 + 0.5 * turn
    plate = LugOutline("square", 2.0 * r, 0.0, w, length, w)
    assert plate.bending == pytest.approx(beside + (length - r) / w, rel=1e-4)


def test_a_shank_that_tapers() -> None:
    """From the head, 50 wide, to 20 where it is held, 200 away, beside the integral of a wedge."""
    wedge = LugOutline("tapered", 0.0004, 0.05, 0.02, 0.2, 0.025)
    (start, half), (held, last) = wedge.joints
    head = math.asin(start / 0.025)
    expected = head / 2.0 + (held - start) / (2.0 * (half - last)) * math.log(half / last)
    assert wedge.bending == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("head", "width", "length", "pulled", "pushed"),
    [
        (50.0, 50.0, 50.0, 0.631, 1.995),
        (50.0, 30.0, 50.0, 0.431, 0.949),
        (50.0, 30.0, 100.0, 0.227, 0.319),
        (36.0, 36.0, 50.0, 0.391, 1.668),
    ],
)
def test_beside_lugs_in_three_dimensions(
    head: float, width: float, length: float, pulled: float, pushed: float
) -> None:
    """`python -m benchmarks tilt`: stiffness of lugs about a bore of 20, over that of the default
    without a shank, pressed at their end or towards the shank. The outline's is between, nearer to
    the former.
    """
    outline = LugOutline("round", 20.0, head, width, length, head / 2.0)
    stiffness = 0.8 / outline.bending
    assert pulled < stiffness < min(1.3 * pulled, pushed)


ROUND = LugOutline("round", 0.02, 0.05, 0.05, 0.05, 0.025)
SQUARE = LugOutline("square", 0.02, 0.0, 0.05, 0.05, 0.03)
REFUSED: list[tuple[LugOutline, dict[str, float], str]] = [
    (ROUND, {"end": 0.01}, "lug-too-narrow"),
    (ROUND, {"head": 0.0199, "width": 0.0198}, "lug-too-narrow"),
    (ROUND, {"interface": 0.06}, "lug-too-narrow"),
    (SQUARE, {"width": 0.02}, "lug-too-narrow"),
    (ROUND, {"width": 0.019}, "shank-too-narrow"),
    (ROUND, {"width": 0.051}, "shank-too-wide"),
    (ROUND, {"length": 0.024}, "shank-too-short"),
    (SQUARE, {"length": 0.009}, "shank-too-short"),
]


def test_outlines_that_cannot_be() -> None:
    for outline, change, code in REFUSED:
        with raises(ArgumentError, code):
            replace(outline, **change)  # type: ignore[arg-type]


def test_similar_lugs_are_one_in_radii() -> None:
    for k in (1.0, 3.7, 1.0 / 3.0):
        sizes = {n: k * getattr(ROUND, n) for n in ("bore", "head", "width", "length", "end")}
        assert replace(ROUND, **sizes).in_radii() == ROUND.in_radii()
    assert ROUND.in_radii().head == pytest.approx(5.0)
    # Widest across a concentric head; an eccentric one has its chord through the bore's centre.
    assert ROUND.width_at_bore == pytest.approx(0.05)
    assert replace(ROUND, width=0.03, end=0.021).width_at_bore == pytest.approx(
        2.0 * math.sqrt(0.025**2 - 0.004**2)
    )
