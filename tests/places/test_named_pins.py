"""Pins of which other programs' numbers are known (benchmarks/joints/named_pins.py), and CalculiX's
contact in three dimensions of a shrink fit, of a tube and of grooves.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from assess.opinion.calculix_joint import joint_opinion
from assess.opinion.calculix_joint_answer import JointOpinion
from assess.opinion.calculix_joint_mesh import Fineness
from assess.opinion.calculix_row import free, section_of
from benchmarks.joints.joint import STEEL, D
from benchmarks.joints.named_pins import (
    BORE,
    GROOVE,
    INTERFERENCE,
    NAMED,
    NamedPin,
    clevis,
    grooved,
    peak_of,
    row_of_named,
)
from benchmarks.joints.turned_ccx import DENSER, turned_opinion
from fea.core.voigt import von_mises
from fea.support.contact.contact_support import profile_of
from fea.support.support import PinProblem
from geometry import Segment
from tests.support.each import sampled

# Of the nearer end: lugs with shanks of their own differ from rings by 4 % (docs/benchmarks.md).
WITHIN = 0.04


@pytest.mark.slow
@pytest.mark.parametrize("named", sampled(NAMED, every=2), ids=lambda n: n.name)
def test_surface_and_section_are_those_of_other_programs(named: NamedPin) -> None:
    found = named.solve().places
    assert found is not None
    pairs = [(found.surface.max_von_mises, named.surface)]
    if found.section is not None:
        pairs.append((found.section.max_von_mises, named.section))
    if found.contact is not None:
        pairs.append((found.contact.beneath, named.beneath))
    for ours, theirs in pairs:
        if theirs is not None:
            low, high = theirs
            assert (1.0 - WITHIN) * low < ours / 1e6 < (1.0 + WITHIN) * high


def test_a_clamps_edge_leaves_the_fillet_to_its_stress() -> None:
    """656.4 MPa by graded axisymmetric elements, 0.15 d from the edge; 3 % is the requirement."""
    (named,) = (n for n in NAMED if "clamped" in n.name)
    assert named.solve().max_von_mises == pytest.approx(656.4e6, rel=0.005)
    assert row_of_named(named)[1:3] == ("656.3", "656.4")


def test_the_outline_of_a_groove() -> None:
    """By hand, mm: 7.4 long, floor at 8.8; a rounded corner begins and ends 1.5 tan(22.5 degrees) =
    0.6213 from the corner of floor and flank, along each; the flank rises by 45 degrees.
    """
    z = np.linspace(0.0, GROOVE.length, 74001)
    r = GROOVE.radius_at(z)
    assert GROOVE.length == pytest.approx(7.4e-3)
    assert GROOVE.length == pytest.approx(sum(s.length for s in GROOVE.segments))
    assert (r.min(), r[0], r[37000]) == pytest.approx((8.8e-3, 10e-3, 8.8e-3))
    assert z[np.flatnonzero(r < 8.8e-3 + 1e-12)[-1]] == pytest.approx(5.2e-3 - 0.6213e-3, abs=1e-6)
    slope = np.diff(r) / np.diff(z)
    end = 5.2e-3 + 0.6213e-3 * math.cos(math.pi / 4.0)
    assert slope[np.searchsorted(z, end) + 5] == pytest.approx(1.0)
    assert np.interp(6.0e-3, z, r) == pytest.approx(9.6e-3)
    stations = GROOVE.stations()
    assert (stations[0], stations[-1]) == pytest.approx((0.0, GROOVE.length))
    assert (np.diff(stations) > 5e-5).all()


def same(given: PinProblem, found: JointOpinion, within: float) -> None:
    """The row is the largest stress of their surface without what is pressed; the moment at
    mid-span is theirs to 2 %.
    """
    peak = peak_of(given)
    surface = np.where(free(found), von_mises(found.stress), 0.0).max()
    assert peak.max_von_mises == pytest.approx(float(surface), rel=within)
    assert peak.places is not None
    assert peak.places.section is not None
    section = section_of(found, profile_of(given.pin), given.material)
    assert peak.places.section.max_von_mises == pytest.approx(section.value, rel=0.02)


@pytest.mark.long
@pytest.mark.peers
def test_calculix_agrees_on_grooves() -> None:
    """681 and 698 MPa with 3 and 4 layers across the pin, ours 709 +- 1.5 %; both have a moment of
    356.7 N m at mid-span.
    """
    given = grooved()
    plain = clevis(gap=(Segment(GROOVE.length, D),))
    at = [(0.012, GROOVE), (0.032 + GROOVE.length, GROOVE)]
    fineness = Fineness(rings=4, sectors=16, layers=5, eye=2)
    found = turned_opinion(profile_of(plain.pin), at, STEEL, given.lugs, given.cases[0], fineness)
    same(given, found, 0.03)


@pytest.mark.long
@pytest.mark.peers
def test_calculix_agrees_on_a_tube() -> None:
    """In the gap, where its bore becomes oval; ours 577.2 +- 0.8 % MPa. Theirs comes from above on
    layers that are thin at the bore, 600 here and 583.7 with twice the sectors and 5 layers, and
    from below on others, 537 and 562: so 5 % here.
    """
    given = clevis(bore=BORE)
    fineness = Fineness(rings=6, sectors=16, layers=4, eye=2)
    found = turned_opinion(
        profile_of(given.pin), [], STEEL, given.lugs, given.cases[0], fineness, -DENSER
    )
    same(given, found, 0.05)


@pytest.mark.long
@pytest.mark.peers
def test_calculix_agrees_on_a_shrink_fit() -> None:
    """The pressed tension fibre, far from edges: as it is, it has no more than the row; with the
    stress of its pressure p taken off, p times (1, 2 nu, 1), the row. (On a finer mesh 319.7 and
    331.1 MPa, on a coarser one 337, ours 323.2 +- 0.9 %.)
    """
    given = clevis(interference=INTERFERENCE)
    found = joint_opinion(
        profile_of(given.pin),
        STEEL,
        given.lugs,
        given.cases[0],
        Fineness(rings=8, sectors=24, eye=2),
    )
    at = np.linalg.norm(found.nodes - [0.5 * D, 0.0, 0.5 * given.pin.length], axis=1).argmin()
    fibre = found.stress[at]
    pressure = -fibre[0]
    assert pressure > 40e6
    relieved = fibre + pressure * np.array([1.0, 0.6, 1.0, 0.0, 0.0, 0.0])
    as_is, less = von_mises(np.stack([fibre, relieved]))
    peak = peak_of(given)
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    assert as_is < 1.02 * (peak.max_von_mises + peak.error_estimate)
    assert peak.max_von_mises == pytest.approx(less, rel=0.04)
    section = section_of(found, profile_of(given.pin), STEEL).value
    assert peak.places is not None
    assert peak.places.section is not None
    assert peak.places.section.max_von_mises == pytest.approx(section, rel=0.02)
