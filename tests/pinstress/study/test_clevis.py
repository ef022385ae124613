"""A link with two ears: its force amid them, its moment as a couple of forces on them."""

from __future__ import annotations

import numpy as np
import pytest

import pinstress
from pinstress.analysis.plan import all_loads
from pinstress.analysis.remedies.joint_parameters import joint_parameters
from pinstress.explore.size.scaled_study import wider_eyes
from pinstress.study.model.clevis import Ears, on_ears
from pinstress.study.reading.errors import InputError
from tests.support.each import each

STUDY = """
title = "Clevis"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "600 MPa"
[pin.P]
material = "steel"
profile = [
  { length = 4, diameter = 26 },
  { length = 10, diameter = 20, connection = "FORK" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "EYE" },
  { length = 1, diameter = 20 },
  { length = 10, diameter = 20, name = "FAR", ear_of = "FORK" },
  { length = 2, diameter = 20 },
]
lug.FORK = {}
[case.pull]
kind = "given"
forces = { FORK = [40000, 0, 3000], EYE = [-40000, 0, -3000] }
moments = { FORK = [50000, 90000, 8000], EYE = [-50000, -90000, -8000] }
[analysis]
joints = "foundation"
"""
# By hand: the ears' middles are 32 mm apart; N and N m.
EXACT = {
    "FORK": (40e3 / 2 - 90.0 / 0.032, 50.0 / 0.032, 0.0),
    "EYE": (-40e3, 0.0, -3e3),
    "FAR": (40e3 / 2 + 90.0 / 0.032, -50.0 / 0.032, 3e3),
}


def test_ears_take_half_the_force_and_a_couple() -> None:
    """The force along the axis is that of the ear that it pushes away from the other."""
    plan = pinstress.prepare(pinstress.study_from(STUDY))
    (task,) = plan.tasks
    (loads,) = task.loads
    assert set(loads.surfaces) == set(EXACT)
    for surface, force, moment in zip(
        loads.surfaces, loads.forces[0], loads.moments[0], strict=True
    ):
        assert force == pytest.approx(EXACT[surface], abs=1e-6), surface
        across = (-50.0, -90.0, -8.0) if surface == "EYE" else (0.0, 0.0, 4.0)
        assert moment == pytest.approx(across, abs=1e-9), surface


def test_keys_change_the_lug_of_both_ears_or_refuse() -> None:
    """A change of one ear's clearance alone took all else of its lug away, and eyes that sizes
    widen ended in a traceback.
    """
    alike = pinstress.study_from(STUDY.replace("FORK = {}", "FORK = { outer_diameter = 44 }"))
    clearance = "lug.FAR.clearance"
    with pytest.raises(InputError, match="that of FORK, whose keys change both") as error:
        pinstress.changed_study(alike, {f"pin.P.{clearance}": 0.1})
    assert error.value.code == "lug-of-both-ears"
    thicker = pinstress.changed_study(alike, {"pin.P.profile[6].diameter": 40})
    assert wider_eyes(alike, thicker, "P") == pytest.approx({"FORK": 0.060})
    (task,) = pinstress.prepare(alike).tasks
    found = {x.of_joint.key: x.of_joint.changed for x in joint_parameters(alike, task)}
    assert clearance not in found
    _, _, lugs = found["lug.FORK.clearance"](1e-4)
    assert {x.connection for x in lugs if x.clearance == 1e-4} == {"FORK", "FAR"}
    own = pinstress.study_from(f"{STUDY}\n[pin.P.lug.FAR]\nouter_diameter = 50\n")
    changed = pinstress.changed_study(own, {f"pin.P.{clearance}": 0.1}).table.pin["P"].lug["FAR"]
    assert (changed.outer_diameter, changed.clearance) == pytest.approx((0.05, 1e-4))


TRUSS = """
[mechanism]
gravity = [0, 0]
[mechanism.joint.A]
at = [-300, 0]
fixed_in = "ground"
z = 25
connections = { AP = "left" }
[mechanism.joint.B]
at = [300, 0]
fixed_in = "ground"
z = 25
connections = { BP = "right" }
[mechanism.joint.P]
at = [0, 400]
z = 0
connections = { FORK = "left", EYE = "right" }
[mechanism.body.left]
mass = 0
inertia = 0
[mechanism.body.right]
mass = 0
inertia = 0
[case.rest]
kind = "static"
apply = [{ body = "right", at = "P", force = [0, -20000] }]
"""


def test_a_clevis_lies_amid_its_ears_in_a_linkage() -> None:
    """A fork about an eye: nothing acts out of the plane of both, 25 mm from the pin's start."""
    pin, analysis = STUDY.split("[case.pull]")[0], STUDY[STUDY.index("[analysis]") :]
    study = pinstress.study_from(pin + TRUSS + analysis)
    reactions = all_loads(study, ["rest"])["rest"].reactions
    assert reactions.forces[..., 2] == pytest.approx(np.zeros((1, 4)), abs=1e-9)
    assert reactions.moments == pytest.approx(np.zeros((1, 4, 3)), abs=1e-9)


def test_the_other_ear_is_alike_unless_it_is_stated() -> None:
    wide = STUDY.replace("lug.FORK = {}", "lug.FORK = { outer_diameter = 44 }")
    own = wide.replace("[case.pull]", "[pin.P.lug.FAR]\nouter_diameter = 60\n[case.pull]")
    for text, diameter in ((wide, 0.044), (own, 0.060)):
        (task,) = pinstress.prepare(pinstress.study_from(text)).tasks
        lugs = {lug.connection: lug.outer_diameter for lug in task.given}
        assert (lugs["FORK"], lugs["FAR"]) == pytest.approx((0.044, diameter))


def test_resultants_are_those_of_the_link_at_any_instant() -> None:
    """Whichever ear the connection names, by sums of forces and moments about the middle."""
    rng = np.random.default_rng(1)
    forces, moments = rng.normal(size=(2, 5, 1, 3))
    for z, other in ((0.1, 0.4), (0.4, 0.1)):
        names, at_ears, about = on_ears(("A",), forces, moments, {"A": Ears("B", z, other)})
        assert names == ("A", "B")
        assert at_ears.sum(axis=1) == pytest.approx(forces[:, 0])
        arms = np.array([z, other]) - 0.25
        first = np.cross(arms[:, None] * [0.0, 0.0, 1.0], at_ears)
        assert (first + about).sum(axis=1) == pytest.approx(moments[:, 0])
        front = 1 if other > z else 0
        assert at_ears[:, front, 2] == pytest.approx(np.maximum(forces[:, 0, 2], 0.0))


def carries_the_couple(joints: str) -> None:
    """Check the forces and the couple of the bands of a run, which statics determines."""
    text = STUDY.replace('joints = "foundation"', f'joints = "{joints}"\ntolerance = 0.2')
    results = pinstress.run(pinstress.study_from(text))
    (row,) = results.pins
    assert row.maximum.max_von_mises is not None
    assert row.joint is not None
    couples = {band.name: band.couple for band in row.joint.bands}
    assert couples["EYE"] == pytest.approx(np.hypot(50e3, 90e3), rel=1e-4)  # N mm
    forces = {band.name: band.force for band in row.joint.bands}
    for name, force in EXACT.items():
        assert forces[name] == pytest.approx(np.hypot(*force[:2]), rel=1e-4)
    assert "that of FAR on its own band" in row.maximum.note


def test_foundations_carry_the_couple() -> None:
    carries_the_couple("foundation")


@pytest.mark.slow
def test_contact_carries_the_couple() -> None:
    carries_the_couple("contact")


@each(
    ("old", "new", "code"),
    [
        ('ear_of = "FORK"', 'ear_of = "FORKS"', "unknown-connection"),
        ('name = "FAR", ear_of = "FORK"', 'ear_of = "FORK"', "ear-without-name"),
        ("{ length = 2, diameter = 20 }",
         '{ length = 2, diameter = 20, name = "X", ear_of = "FORK" }', "third-ear"),
    ],
)  # fmt: skip
def test_ears_that_are_refused(old: str, new: str, code: str) -> None:
    with pytest.raises(InputError) as error:
        pinstress.study_from(STUDY.replace(old, new))
    assert error.value.code == code


def test_a_clamped_ear_is_refused() -> None:
    text = STUDY.replace("lug.FORK = {}", 'clamp = ["FAR"]').replace(
        'joints = "foundation"', 'joints = "prescribed"'
    )
    with pytest.raises(InputError) as error:
        pinstress.prepare(pinstress.study_from(text))
    assert error.value.code == "clamped-ear"
