"""A second opinion on a pin in its lugs: what is compared, refused, and beyond its limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.opinion import calculix_in_lugs
from assess.opinion.calculix import CalculixError
from assess.opinion.calculix_in_lugs import (
    HALF_MODEL_MESHES,
    PinInLugs,
    opinion_in_lugs,
    transverse,
)
from assess.opinion.calculix_joint import joint_deck
from assess.opinion.calculix_joint_answer import JointOpinion, edges
from assess.opinion.calculix_joint_mesh import Fineness, pin_mesh
from assess.opinion.opinions import BandOpinion, ContactOpinion, Opinion
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_in_lugs
from fea.support.lugs.lug import Bushing, Lug
from fea.support.records import BandContact, JointResult
from fea.support.support import PinProblem
from geometry import ArgumentError, Pin, Segment
from tests.support.errors import raises

D, F = 0.02, 50e3
STEEL = Material("steel", 210e9, 0.3, density=7850.0)
BRONZE = Material("bronze", 100e9, 0.34)
TWO = Pin("P", tuple(Segment(0.01, D, connection=name) for name in "AB"))
AXIAL = np.array([0.0, 0.0, 20.0])
APART = PinLoads("pull", ("A", "B"), np.array([[[-F, 0.0, 0.0], [F, 0.0, 0.0]]]))
SEATED = PinInLugs(TWO, STEEL, (Lug("A", 0.05, STEEL), Lug("B", 0.05, STEEL)))

BAND = BandOpinion("A", (0.0, 1.0, 3.0), (10.0, 20.0), (14.0, 18.0))
CONTACT = ContactOpinion((BAND,), 100.0, 103.0, 900, 0.02, 0.1)
AGREED = Opinion("P", "pull", 100.0, 5.0, 2000, theirs=110.0, contact=CONTACT)


def test_load_elsewhere_is_the_part_that_would_have_to_move() -> None:
    """4 of 50 are in the first part for one program and in the second for the other."""
    assert BAND.elsewhere == pytest.approx(4.0 / 50.0)
    assert CONTACT.elsewhere == BAND.elsewhere
    assert CONTACT.moment_difference == pytest.approx(0.03)


def test_what_is_beyond_its_limit_is_complained_of() -> None:
    """The error of the answer, 5 %, comes to the limits of moment and stress."""
    assert AGREED.complaint == ""
    far = replace(BAND, ours=(20.0, 15.0))
    for moment in (109.0, 91.0):
        assert replace(AGREED, contact=replace(CONTACT, moment=moment)).complaint == ""
    told = {
        "moment is +11.0% from": replace(AGREED, contact=replace(CONTACT, moment=111.0)),
        "moment is +nan%": replace(AGREED, contact=replace(CONTACT, moment=math.nan)),
        "maximum is -40.0% from": replace(AGREED, theirs=60.0),
        "12.0% of the load of A": replace(AGREED, contact=replace(CONTACT, bands=(far,))),
        "no ccx": replace(AGREED, contact=None, failure="no ccx"),
    }
    for words, opinion in told.items():
        assert words in opinion.complaint
        assert ";" not in opinion.complaint


def test_forces_across_are_balanced_and_the_rest_is_small_or_refused() -> None:
    loads = replace(APART, forces=APART.forces + AXIAL)
    found = transverse(SEATED, replace(loads, body=np.array([0.0, 9.8, 0.0])))
    assert found.surfaces == ("A", "B")
    assert found.forces[0] == pytest.approx(APART.forces[0])
    assert not found.body.any()
    for wrong in (
        replace(APART, forces=APART.forces + 10.0 * AXIAL),
        replace(APART, moments=np.array([[[0.0, 0.0, 5.0], [0.0, 0.0, -5.0]]])),
        replace(APART, body=np.array([0.0, 3e3, 0.0])),
    ):
        with raises(ArgumentError, "other-loads"):
            transverse(SEATED, wrong)


def test_lugs_that_calculix_has_no_model_of() -> None:
    tight = replace(SEATED, lugs=(replace(SEATED.lugs[0], clearance=-1e-5), SEATED.lugs[1]))
    with raises(ArgumentError, "interference", "A"):
        transverse(tight, APART)


def test_a_bushing_is_a_layer_of_its_own_material() -> None:
    lugs = [replace(SEATED.lugs[0], bushing=Bushing(0.002, BRONZE)), SEATED.lugs[1]]
    deck, _ = joint_deck(TWO, STEEL, lugs, APART, Fineness(rings=2, sectors=8, eye=2))
    (own, inside), (only,) = (list(eye.part.materials) for eye in deck.eyes)
    assert (own[1], inside[1], only[1]) == (STEEL, BRONZE, STEEL)
    mesh = deck.eyes[0].part.mesh
    assert mesh.inner[inside[2]] == pytest.approx(D / 2.0)
    assert mesh.outer[inside[2]] == pytest.approx(D / 2.0 + 0.002)
    assert mesh.inner[own[2]].min() == pytest.approx(D / 2.0 + 0.002)
    assert len(own[2]) + len(inside[2]) == len(mesh.elements)
    text = "\n".join(deck.lines())
    assert text.count("*SOLID SECTION") == 4
    assert text.count("*ELEMENT, TYPE=C3D20R") == 4


def band(name: str, load: tuple[float, ...], z: float) -> BandContact:
    ends = np.linspace(z, z + 0.01, len(load) + 1)
    line = tuple(zip((0.5 * (ends[1:] + ends[:-1])).tolist(), load, strict=True))
    return BandContact(
        name, 1e-2 * float(np.mean(load)), 60.0, 1e8, line, 0.0, 0.0, 0.05, tuple(ends)
    )


def stand_in(
    pin: Pin, material: Material, lugs: object, loads: PinLoads, mesh: Fineness
) -> JointOpinion:
    """Even loads of 5 MN/m in opposite directions, an axial stress of 1 MPa for each ring."""
    z = np.linspace(0.0, 0.02, 5)
    ends = np.stack([z[:-1], z[1:]], axis=1)
    force = np.array([[-1.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [1.0, 0.0]]) * F / 2.0
    body = pin_mesh(pin, [z[:3], z[2:]], Fineness(sectors=8), False)
    stress = np.zeros((len(body.nodes), 6))
    stress[:, 2] = 1e6 * mesh.rings
    first = force * ends.mean(axis=1)[:, None]
    return JointOpinion(
        ends, force, first, body.nodes, body.elements, stress, 0.0, False, edges(pin), 7, 1, 1.0
    )


PEAK = Maximum("P", "pull", "harmonic", "converged", "", 5e6, 1e5, (0.01, 0.0, 0.004), APART)
JOINT = JointResult(
    "contact", (band("A", (4e6, 4e6, 6e6, 6e6), 0.0), band("B", (5e6,), 0.01)), 260.0, ()
)


def test_our_loads_are_spread_over_the_rings_of_calculix(monkeypatch: pytest.MonkeyPatch) -> None:
    """Theirs are positive along the force of their link; moment F times 1 cm, as nothing reacts
    it;
    the finer mesh has 1.5 times the stress of the coarser one.
    """
    monkeypatch.setattr(calculix_in_lugs, "joint_opinion", stand_in)
    told: list[str] = []
    found = opinion_in_lugs(SEATED, PEAK, JOINT, told.append)
    assert found.contact is not None
    one, other = found.contact.bands
    assert one.ours == pytest.approx((4e6, 6e6))
    assert one.theirs == pytest.approx((5e6, 5e6))
    assert other.ours == pytest.approx(other.theirs)
    assert one.ends == pytest.approx((0.0, 0.005, 0.01))
    assert found.contact.moment == pytest.approx(F * 0.01)
    assert found.contact.stress_change == pytest.approx(
        HALF_MODEL_MESHES[1].rings / HALF_MODEL_MESHES[0].rings - 1.0
    )
    assert found.theirs == pytest.approx(1e6 * HALF_MODEL_MESHES[1].rings)
    assert found.unknowns == 7
    assert len(told) == 2


def test_why_there_is_none_is_in_the_opinion(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> JointOpinion:
        raise CalculixError("no luck", "failed")

    monkeypatch.setattr(calculix_in_lugs, "joint_opinion", fails)
    assert opinion_in_lugs(SEATED, PEAK, JOINT).failure == "no luck"
    tight = replace(SEATED, lugs=(replace(SEATED.lugs[0], clearance=-1e-5), SEATED.lugs[1]))
    refused = opinion_in_lugs(tight, PEAK, JOINT)
    assert "interference" in refused.failure
    assert refused.contact is None


@pytest.mark.peers
def test_calculix_agrees_on_a_clevis_with_a_bushing() -> None:
    """Of so soft a bushing in the middle that without it moment and load would be beyond their
    limits; on coarse meshes.
    """
    over, gap = Segment(0.002, D), Segment(0.001, D)
    left, middle, right = (
        Segment(t, D, connection=name) for t, name in zip((0.01, 0.02, 0.01), "LMR", strict=True)
    )
    pin = Pin("P", (over, left, gap, middle, gap, right, over))
    fork = F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    plain = tuple(Lug(name, 0.05, STEEL, tilt=66e3) for name in "LMR")
    soft = Bushing(0.004, Material("plastic", 10e9, 0.35))
    lugs = (plain[0], replace(plain[1], bushing=soft, tilt=math.inf), plain[2])
    given = PinProblem(pin, STEEL, lugs, (PinLoads("pull", ("L", "M", "R"), fork),))
    (solved,) = solve_in_lugs(given, Requirement(0.1))
    assert solved.joint is not None
    seated, peak = PinInLugs(pin, STEEL, lugs), solved.peak
    first = Fineness(rings=3, sectors=8, layers=1, eye=1)
    coarse = first, replace(first, sectors=16, eye=2)
    found = opinion_in_lugs(seated, peak, solved.joint, meshes=coarse)
    assert found.complaint == ""
    assert found.contact is not None
    assert abs(found.contact.moment_difference) < 0.05
    (without,) = solve_in_lugs(replace(given, lugs=plain), Requirement(0.1))
    assert without.joint is not None
    assert without.joint.bending_moment is not None
    assert abs(found.contact.moment / without.joint.bending_moment - 1.0) > 0.1
