"""Rings of bands, and a rounded edge against the flat rounded punch."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Band, Pin, Segment
from geometry.shape.profile import Edge, meridian
from geometry.shape.rings import (
    MAX_RING_LENGTH,
    beside_fillets,
    graded,
    ring_ends,
    ringed,
    ringed_name,
    rings,
    whole_names,
)
from tests.support.each import each, sampled

BAND = Band("A", 0.0, 0.02, 0.01)


def test_sharp_edges_have_the_usual_rings() -> None:
    assert ring_ends(BAND, 0.0, 8, 0.3) == pytest.approx(graded(0.02, 8))
    long = ring_ends(Band("A", 0.0, 0.04, 0.01), 0.0, 8, 0.3)
    assert len(long) - 1 == 13
    assert np.diff(long).max() <= MAX_RING_LENGTH * 0.02


@each("radius", [2e-4, 5e-4, 1e-3, 4e-3, 0.01])
@each("count", [4, 8, 16])
def test_rounded_edges_have_rings_where_rounding_begins(radius: float, count: int) -> None:
    """Rising, mirrored, an end at each radius; beside it no ring longer than a third of it."""
    ends = ring_ends(BAND, radius, count, 1.0 / 3.0)
    parts = np.diff(ends)
    assert ends[0] == 0.0
    assert ends[-1] == pytest.approx(0.02)
    assert (parts > 0.0).all()
    assert parts == pytest.approx(parts[::-1])
    at = int(np.abs(ends - radius).argmin())
    assert ends[at] == pytest.approx(radius)
    first = radius / 3.0 * 8 / count
    assert parts[at - 1] <= first * 1.0001
    assert parts[at] <= first * 1.0001 or at == len(ends) // 2
    assert parts.max() <= MAX_RING_LENGTH * 0.02 * 8 / count * 1.0001


@each("radius", [2e-4, 5e-4, 1e-3, 4e-3, 0.01])
@each("count", [4, 8, 16])
def test_rings_of_rounded_edges(radius: float, count: int) -> None:
    """As many as of sharp edges where the bore is straight, and a few short ones in the rounding,
    the shortest next to where it begins.
    """
    ends = ring_ends(BAND, radius, count)
    parts = np.diff(ends)
    assert ends[[0, -1]] == pytest.approx([0.0, 0.02])
    assert parts == pytest.approx(parts[::-1])
    at = int(np.abs(ends - radius).argmin())
    assert ends[at] == pytest.approx(radius)
    assert at >= 2
    assert parts[at - 1] <= radius / 4.0 * 1.0001
    assert (np.diff(parts[:at]) < 0.0).all()
    straight = ends[(ends > radius * 0.9999) & (ends < 0.02 - radius * 0.9999)] - radius
    if radius < 0.01:
        assert straight == pytest.approx(graded(0.02 - 2.0 * radius, count))
    assert parts.max() <= MAX_RING_LENGTH * 0.02 * 8 / count * 2.0


def test_lugs_may_differ_in_rings() -> None:
    pin = Pin("P", (Segment(0.02, 0.02, connection="A"), Segment(0.01, 0.02, connection="B")))
    steel = Material("steel", 210e9, 0.3)
    lugs = [Lug("A", 0.05, steel, edge_radius=5e-4), Lug("B", 0.05, steel)]
    model = ContactModel(pin, steel, lugs, Resolution(8, 12, 2))
    counts = [len(model.ends[name]) - 1 for name in ("A", "B")]
    assert counts[0] > counts[1] == 8
    assert model.rings == (*rings("A", model.ends["A"]), *rings("B", model.ends["B"]))
    assert np.bincount(model.contact.bands.band).tolist() == counts
    assert ringed(pin, model.ends).connections == model.rings


def punch(
    force: float, flat: float, radius: float, weak: float, ends: Floats
) -> tuple[Floats, float]:
    """Mean pressure between ends (R + 1,) of a rigid flat punch of half width `flat` with rounded
    edges on a half-plane of modulus `weak`, Pa, under a force per length, N/m; half width of
    contact.

    Contact that grows to s adds the pressure of flat punches, dP / (pi sqrt(s^2 - x^2)), with
    P(s) = weak / radius times the integral from flat to s of x (x - flat) / sqrt(s^2 - x^2).
    Source: Ciavarella, Hills & Monno, J. Strain Analysis 33 (1998) 409.
    """

    def total(s: float) -> float:
        start = math.asin(flat / s)
        return quad(lambda t: s * math.sin(t) * (s * math.sin(t) - flat), start, math.pi / 2)[0]

    reach = brentq(lambda s: weak / radius * total(s) - force, flat * (1 + 1e-12), flat + radius)
    t, w = np.polynomial.legendre.leggauss(400)
    s = flat + (reach - flat) * (t + 1.0) / 2.0
    grown = weak / radius * s * np.arccos(flat / s) / math.pi * w * (reach - flat) / 2.0
    inside = np.arcsin(np.clip(ends[:, None] / s, -1.0, 1.0))
    return np.diff(inside, axis=0) @ grown / np.diff(ends), reach


@pytest.mark.slow
@pytest.mark.parametrize(
    ("interference", "cells"),
    sampled(
        [(2e-3, Resolution(16, 6, 0, beside=0.01)), (2e-4, Resolution(8, 6, 0, beside=0.004))],
        every=2,
    ),
)
def test_a_rounded_edge_is_a_flat_rounded_punchs(interference: float, cells: Resolution) -> None:
    """A rigid eye pressed on a band that is short beside the pin's radius, round its whole axis, so
    that contact reaches a sixth of the radius into the rounding, and a 28th. Over the flat 1.5 %;
    reach of contact within a ring; at the peak, where rounding begins, 3 %.
    """
    length, radius, edge = 0.02, 0.5, 0.005
    steel, rigid = Material("steel", 210e9, 0.3), Material("rigid", 210e15, 0.3)
    over = Segment(0.5, 2.0 * radius)
    pin = Pin("P", (over, Segment(length, 2.0 * radius, connection="A"), over))
    lug = Lug("A", 3.0 * radius, rigid, clearance=-interference, edge_radius=edge)
    model = ContactModel(pin, steel, [lug], cells)
    pressure = model.solve(PinLoads("none", ("A",), np.zeros((1, 1, 3)))).contact[0].pressure[:, 0]
    ends = model.ends["A"] - length / 2.0
    flat, force = length / 2.0 - edge, float(pressure @ np.diff(ends))
    exact, reach = punch(force, flat, edge, 210e9 / (1.0 - 0.3**2), ends)
    assert exact @ np.diff(ends) == pytest.approx(force, rel=1e-3)
    inner = np.abs(ends[1:] + ends[:-1]) / 2.0 < 0.8 * flat
    assert pressure[inner] == pytest.approx(exact[inner], rel=0.015)
    assert pressure.max() == pytest.approx(exact.max(), rel=0.03)
    last = np.flatnonzero(pressure)[-1]
    assert ends[last] - 1e-12 < reach + (ends[last + 1] - ends[last])
    assert reach < ends[last + 2]


STEPPED = Pin(
    "P",
    (
        Segment(0.03, 0.02, bore=0.008),
        Segment(0.02, 0.03, bore=0.012, connection="A"),
        Segment(0.025, 0.024, bore=0.012, connection="B", name="seat"),
        Segment(0.01, 0.02, bore=0.01),
    ),
    fillet=0.002,
)


def test_names_of_a_ringed_pin_are_those_of_the_same_place_on_the_whole() -> None:
    """An edge of its section lies on the edge of that name in the section of the whole."""
    ends = {"A": graded(0.02, 5), "B": graded(0.025, 4)}
    cut = ringed(STEPPED, ends)
    names = whole_names(STEPPED, ends)
    assert set(rings("A", ends["A"])) <= set(cut.labels)
    assert cut.volume == pytest.approx(STEPPED.volume, rel=1e-12)
    whole: dict[str | None, list[Edge]] = {}
    for edge in meridian(STEPPED):
        whole.setdefault(edge.name, []).append(edge)
    for edge in meridian(cut):
        assert edge.name is not None
        if edge.name.startswith("fillet "):  # nothing is named after these
            continue
        name = names.get(edge.name, edge.name)
        middle = edge.beside(np.array([0.5]), 0.0)
        assert min(float(x.distance(middle)[0]) for x in whole[name]) < 1e-12, edge.name
    for name in ("segment 1", "segment 4", "shoulder 1", "shoulder 2", "shoulder 3"):
        assert names[ringed_name(cut, name)] == name
    assert ringed_name(cut, "bore A") == "bore A"


def test_outermost_rings_beside_fillets() -> None:
    """A quarter of the radius beyond the arc's tangent point; without a fillet they may be long."""
    most = beside_fillets(STEPPED, STEPPED.band("B"))
    assert most == pytest.approx((0.25 * 0.002, 0.25 * 0.002))
    plain = Pin("P", (Segment(0.03, 0.02), Segment(0.02, 0.02, connection="A")))
    assert beside_fillets(plain, plain.band("A")) == (math.inf, math.inf)
    parts = np.diff(ring_ends(BAND, 0.0, 8, None, (1e-4, math.inf)))
    assert parts[0] <= 1e-4 * (1.0 + 1e-9)
    assert parts.sum() == pytest.approx(0.02)
