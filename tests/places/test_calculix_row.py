"""Surface and sections of another program's contact in three dimensions."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from assess.opinion.calculix_joint import joint_opinion
from assess.opinion.calculix_joint_answer import JointOpinion
from assess.opinion.calculix_joint_mesh import Fineness
from assess.opinion.calculix_row import free, pressed, section_of
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from pinstress.explore.chart.single_joint import JointProblem, JointRung, joint_result_on

D, F = 0.02, 50e3
STEEL = Material("steel", 2.1e11, 0.3)
PULL = PinLoads("pull", tuple("ABC"), F * np.outer([-0.5, 1.0, -0.5], np.eye(3)[0])[None])
LUGS = tuple(
    Lug(n, 0.05, STEEL, 0.0, 2e-4, t) for n, t in zip("ABC", (2e5, np.inf, 2e5), strict=True)
)


CLEVIS = Pin(
    "P",
    (
        *(Segment(0.002, D), Segment(0.01, D, connection="A"), Segment(0.002, D)),
        *(Segment(0.02, D, connection="B"), Segment(0.002, D)),
        *(Segment(0.01, D, connection="C"), Segment(0.002, D)),
    ),
)


@cache
def theirs() -> JointOpinion:
    return joint_opinion(CLEVIS, STEEL, LUGS, PULL, Fineness(rings=4, sectors=16, eye=2))


@pytest.mark.long
@pytest.mark.peers
def test_what_calculix_presses_is_what_its_lugs_do() -> None:
    """On the sides that the lugs pull, and on no other; its free surface is most of the rest. The
    section's moment is that of its own forces about mid-span, by hand.
    """
    found = theirs()
    x, on = found.nodes, pressed(found)
    c, s = np.cos(found.angle), np.sin(found.angle)
    along = c * x[:, 0] - s * x[:, 1]
    middle = (x[:, 2] > 0.013) & (x[:, 2] < 0.035)
    assert on.any()
    assert (along[on & middle] < 2.5e-3).all()
    assert (along[on & ~middle] > -2.5e-3).all()
    assert not (free(found) & on).any()
    at = section_of(found, CLEVIS, STEEL)
    mid = 0.5 * CLEVIS.length
    before = found.ends[:, 1] <= mid + 1e-9
    by_hand = np.linalg.norm((mid * found.force - found.first)[before].sum(axis=0))
    assert at.bending_moment == pytest.approx(by_hand, rel=0.01)
    assert at.value == pytest.approx(32.0 * at.bending_moment / np.pi / D**3, rel=0.02)


@pytest.mark.long
@pytest.mark.peers
def test_rows_of_both_programs_agree() -> None:
    """A clevis. (326 MPa on CalculiX's surface at mid-span, 307 in its section; 315 and 301.)"""
    problem = JointProblem(CLEVIS, STEEL, LUGS, PULL)
    ours = joint_result_on(problem, JointRung("contact", "", 1))
    found = theirs()
    read = np.where(free(found), von_mises(found.stress), 0.0)
    row = max(float(read.max()), section_of(found, CLEVIS, STEEL).value)
    assert row == pytest.approx(ours.maximum, rel=0.06)


@pytest.mark.slow
def test_a_foundation_has_the_row_of_contact() -> None:
    """For a plain pin, within the error of beams."""
    problem = JointProblem(CLEVIS, STEEL, LUGS, PULL)
    contact = joint_result_on(problem, JointRung("contact", "")).maximum
    foundation = joint_result_on(problem, JointRung("foundation", "")).maximum
    assert foundation == pytest.approx(contact, rel=0.12)
