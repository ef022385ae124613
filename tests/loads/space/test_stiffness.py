"""Stiffness of links against the unit-load theorem, Saint-Venant's series, and in proportion."""

from __future__ import annotations

import math
from dataclasses import astuple

import numpy as np
import pytest

from loads.space.stiffness import (
    LinkStiffness,
    cantilever,
    complete,
    flat_link,
    round_link,
    variations,
    worst_groups,
)
from pinbase.arrays import Floats
from tests.support.each import each

BAR = LinkStiffness(3.0, 0.5, 0.2, 0.07, depth=(0.3, 1.0, -0.4))
PLAIN = LinkStiffness(3.0, 0.5, 0.2, 0.07)


def by_unit_loads(arm: Floats, link: LinkStiffness, side: Floats) -> Floats:
    """The flexibility (6, 6) by Castigliano: work of the internal forces of each pair of loads."""
    length = float(np.linalg.norm(arm))
    along, normal = arm / length, np.cross(arm / length, side)
    out, unit = np.zeros((6, 6)), np.eye(6)
    for x, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
        rest = arm - 0.5 * length * (1.0 + x) * along
        force, moment = unit[:, :3], unit[:, 3:] + np.cross(rest, unit[:, :3])
        for inside, stiff in (
            (force @ along, link.axial), (moment @ along, link.torsion),
            (moment @ normal, link.bending), (moment @ side, link.across),
        ):  # fmt: skip
            out += 0.5 * length * weight * np.outer(inside, inside) / stiff
    return out


@each("arm", [(0.2, 0.7, 0.1), (-0.4, 0.0, 0.3), (0.0, -0.5, 0.0)])
def test_a_cantilever_has_the_work_of_its_internal_forces(arm: tuple[float, ...]) -> None:
    r = np.array(arm)
    along = r / np.linalg.norm(r)
    depth = np.array(BAR.depth) - np.array(BAR.depth) @ along * along
    depth /= np.linalg.norm(depth)
    assert cantilever(r, BAR) == pytest.approx(by_unit_loads(r, BAR, depth), abs=1e-14)
    level = np.array([-along[1], along[0], 0.0]) / math.hypot(*along[:2])  # in the drawing
    assert cantilever(r, PLAIN) == pytest.approx(by_unit_loads(r, PLAIN, level), abs=1e-14)


def test_a_cantilever_along_z_has_a_depth_across_it() -> None:
    """Any, so that the bending of a round bar is alike both ways."""
    found = cantilever(np.array([0.0, 0.0, 2.0]), round_link(0.1))
    bending = math.pi / 64.0 * 0.1**4
    assert found[0, 0] == pytest.approx(2.0**3 / (3.0 * bending))
    assert found[1, 1] == pytest.approx(2.0**3 / (3.0 * bending))
    assert found[2, 2] == pytest.approx(2.0 / (math.pi / 4.0 * 0.1**2))
    assert not cantilever(np.zeros(3), BAR).any()


@each("width", [0.1, 0.3, 0.6, 1.0, 2.5])
def test_a_flat_bar_twists_as_saint_venant_has_it(width: float) -> None:
    """Within 0.5 %, his series of hyperbolic tangents for a depth of 1 m and Poisson's ratio 0.3;
    the rest is beam theory. Half as large, the bar twists and bends a sixteenth as stiffly.
    """
    long, short = max(1.0, width), min(1.0, width)
    odd = np.arange(1.0, 60.0, 2.0)
    series = (np.tanh(odd * math.pi * long / (2.0 * short)) / odd**5).sum()
    twist = long * short**3 / 3.0 * (1.0 - 192.0 / math.pi**5 * short / long * series)
    bar = flat_link(1.0, width, 2e11)
    assert bar.torsion == pytest.approx(2e11 / 2.6 * twist, rel=5e-3)
    assert bar.axial == pytest.approx(2e11 * width)
    assert bar.bending == pytest.approx(2e11 * width / 12.0)
    assert bar.across == pytest.approx(2e11 * width**3 / 12.0)
    half = flat_link(0.5, 0.5 * width, 2e11)
    parts = [4.0, 16.0, 16.0, 16.0]
    assert np.array(astuple(half)[:4]) * parts == pytest.approx(np.array(astuple(bar)[:4]))


def test_a_tube_is_a_bar_less_its_bore() -> None:
    bar, bore, tube = round_link(0.03, 7e10), round_link(0.02, 7e10), round_link(0.03, 7e10, 0.02)
    for whole, hole, rest in zip(
        astuple(bar)[:4], astuple(bore)[:4], astuple(tube)[:4], strict=True
    ):
        assert rest == pytest.approx(whole - hole, rel=1e-12)
    assert bar.torsion == pytest.approx(7e10 / 2.6 * math.pi / 32.0 * 0.03**4)


def test_a_link_that_is_not_stated_is_the_geometric_mean() -> None:
    stated = {
        "a": BAR.times(4.0),
        "b": BAR,
        "rigid": LinkStiffness(math.inf, math.inf, math.inf, math.inf),
    }
    mean = complete(["a", "b", "c", "rigid"], stated, 1.0)["c"]
    assert astuple(mean)[:4] == pytest.approx(astuple(BAR.times(2.0))[:4])
    assert complete(["c"], {}, 2.0)["c"] == round_link(0.2)


def test_variations_are_stiffer_and_as_much_softer() -> None:
    known = {"a": BAR, "b": PLAIN, "c": PLAIN}
    found = variations(known, ["a", "b"], 5.0)
    assert len(found) == 6
    stiff, soft = found["a 5 times stiffer"]["a"], found["a 5 times more flexible"]["a"]
    for link, factor in ((stiff, 5.0), (soft, 0.2)):
        assert astuple(link)[:4] == pytest.approx([factor * x for x in astuple(BAR)[:4]])
    twisted = found["all links 5 times more flexible in torsion"]
    assert [twisted[x].torsion / known[x].torsion for x in "abc"] == pytest.approx([0.2, 0.2, 1.0])
    assert twisted["a"].bending == BAR.bending


def test_the_group_that_raises_a_load_is_stiff_against_the_rest() -> None:
    """Stiffness times its root against the rest divided by it: a ratio of 4."""
    known = dict.fromkeys("abc", PLAIN)
    sizes = {f"{x} 4 times {how}": np.array([y]) for x, pair in
             {"a": (2.0, 1.0), "b": (1.0, 2.0), "c": (1.0, 2.0)}.items()
             for how, y in zip(("stiffer", "more flexible"), pair, strict=True)}  # fmt: skip
    ((text, links),) = worst_groups(known, list("abc"), 4.0, sizes).items()
    assert text == "a 4 times stiffer than the rest"
    assert [links[x].bending / PLAIN.bending for x in "abc"] == pytest.approx([2.0, 0.5, 0.5])
    assert not worst_groups(known, ["a"], 4.0, sizes)
