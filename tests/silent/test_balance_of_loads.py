"""A couple that nothing carries, and forces out of balance: one rule, before anything is solved.

Silently wrong was: an unclamped pin under forces with a couple of 0.3 or 0.5 of the largest force
times the pin's length was solved, its bands reacting the couple, with half a sentence in the note;
forces out of balance by 0.1 were refused. `check` said nothing of either couple.

Independent values: statics by hand. The clevis has bands at z = 5, 21 and 37 mm and is 42 mm long;
forces -(25 + x), 50, -(25 - x) kN have the couple x (37 - 5) mm, which is x 32 / (50 42) of the
largest force times the length, and the resultant of R = -(25 - y) kN alone is y / 50 of it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinstress
from fea.core.equilibrium import balancing_forces, out_of_balance
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from pinstress.cli.commands import run_command_line
from pinstress.study.model.balance import given_warnings
from pinstress.study.model.pins import pin as pin_of
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each

CLEVIS = Pin(
    "P",
    (
        Segment(0.010, 0.02, connection="L"),
        Segment(0.001, 0.02),
        Segment(0.020, 0.02, connection="M"),
        Segment(0.001, 0.02),
        Segment(0.010, 0.02, connection="R"),
    ),
)


def study(left: float, right: float, forces: Any = None, **pin: Any) -> pinstress.Study:
    """kN on the outer bands, against 50 on the middle one; or other forces, N."""
    profile: list[dict[str, Any]] = [
        {"length": 10, "diameter": 20, "connection": "L"},
        {"length": 1, "diameter": 20},
        {"length": 20, "diameter": 20, "connection": "M"},
        {"length": 1, "diameter": 20},
        {"length": 10, "diameter": 20, "connection": "R"},
    ]
    steel = {"youngs_modulus": 2e5, "poisson_ratio": 0.3, "yield_strength": 900}
    forces = forces or {"L": [-1e3 * left, 0], "M": [5e4, 0], "R": [-1e3 * right, 0]}
    return pinstress.study_from(
        {
            "title": "clevis",
            "units": "mm-N-s",
            "material": {"steel": steel},
            "pin": {"P": {"material": "steel", "profile": profile, **pin}},
            "case": {"pull": {"kind": "given", "forces": forces}},
        }
    )


def said(checked: pinstress.Study) -> tuple[str, str]:
    """Refusals and warnings of `check`."""
    _, refused, others = describe(checked)
    return "\n".join(refused), "\n".join([*given_warnings(checked), *others])


COUPLES = [x / (32.0 / (50.0 * 42.0)) for x in (0.009, 0.011, 0.09, 0.11, 0.3)]
FORCES = [50.0 * y for y in (0.009, 0.011, 0.09, 0.11, 0.3)]
OUTCOMES = ["silent", "warned", "warned", "refused", "refused"]


@each(
    ("left", "right", "outcome"),
    [
        *((25.0 + x, 25.0 - x, o) for x, o in zip(COUPLES, OUTCOMES, strict=True)),
        *((25.0, 25.0 - y, o) for y, o in zip(FORCES, OUTCOMES, strict=True)),
    ],
)
def test_one_rule_for_forces_and_couples(left: float, right: float, outcome: str) -> None:
    refused, warned = said(study(left, right))
    assert bool(refused) == (outcome == "refused")
    assert bool(warned) == (outcome == "warned")


def test_the_warning_has_the_numbers_and_the_forces_that_close_it() -> None:
    """x = 2 kN: 64 N m, 3.0 %; the pair that closes it is the change of both outer forces."""
    _, warned = said(study(27.0, 23.0))
    assert "a couple across the axis of 64,000 N mm (3.0% of the largest force times" in warned
    assert "L = [-25000, 0] N and R = [-25000, 0] N" in warned
    _, warned = said(study(25.0, 22.0))
    assert "a force of 3,000 N (6.0% of the largest)" in warned
    assert re.search(r"for example, R = \[-25000, 0\] N$", warned)  # one force is enough


def test_the_forces_that_close_it_are_in_equilibrium() -> None:
    """Any loads in both directions, with moments; sums of forces and of moments by hand."""
    rng = np.random.default_rng(3)
    z = np.array([5.0, 21.0, 37.0]) / 1e3
    for _ in range(20):
        forces = rng.normal(size=(1, 3, 3)) * [1e4, 1e4, 0.0]
        moments = rng.normal(size=(1, 3, 3)) * [30.0, 30.0, 0.0]
        loads = PinLoads("case", ("L", "M", "R"), forces, moments)
        change = balancing_forces(CLEVIS, loads, 0)
        assert change is not None
        for name, by in change.items():
            forces[0, "LMR".index(name), :2] += by
        fx, fy = forces[0, :, 0], forces[0, :, 1]
        assert abs(fx.sum()) + abs(fy.sum()) < 1e-7
        assert moments[0, :, 0].sum() - z @ fy == pytest.approx(0.0, abs=1e-8)
        assert moments[0, :, 1].sum() + z @ fx == pytest.approx(0.0, abs=1e-8)


def test_a_couple_is_not_solved_either(steel: Material) -> None:
    """By `run`, `sweep` and all else that solves pins; single shear, 0.5 of F times the length."""
    pin = Pin("P", (Segment(0.02, 0.02, connection="A"), Segment(0.02, 0.02, connection="B")))
    shear = np.array([[[0.0, 1e4, 0.0], [0.0, -1e4, 0.0]]])
    hold = np.zeros((1, 2, 3))
    hold[0, :, 0] = -1e4 * 0.02 / 2.0  # half of the couple on each band
    cases = PinLoads("sheared", ("A", "B"), shear), PinLoads("held", ("A", "B"), shear, hold)
    loose, held = solve_pin(pin, steel, (), cases, Requirement(model="harmonic", meshes=1))
    assert (loose.peak.verdict, loose.peak.reasons) == ("rigid", ("couple-imbalance",))
    assert "couple across the axis is 0.5 of the largest force" in loose.peak.note
    assert held.peak.max_von_mises is not None
    assert held.peak.imbalance is None
    assert balancing_forces(pin, cases[0], 0) is None  # only no load at all would


@each(
    ("held", "outcome"),
    [
        ({"lug": {"M": {"tilt": "guided"}}}, ""),  # one that cannot tilt carries the couple
        ({"lug": {"L": {"tilt": "free"}}}, ""),  # the others have their stiffness by default
        ({"lug": {n: {"tilt": "free"} for n in "LMR"}}, "no lug reacts"),
        ({"clamp": ["start"]}, ""),
    ],
)
def test_what_carries_a_couple(held: dict[str, Any], outcome: str) -> None:
    refused, warned = said(study(45.0, 5.0, **held))
    assert warned == ""
    assert outcome in refused
    assert bool(refused) == bool(outcome)


def test_lugs_do_not_carry_a_force() -> None:
    """The links share a small resultant in contact, too, and `check` refuses a larger one."""
    lugs = {"lug": {"M": {"tilt": "guided"}}}
    refused, _ = said(study(25.0, 15.0, **lugs))
    assert "resultant is 0.2 of the largest load (its links share at most 0.1)" in refused
    refused, warned = said(study(25.0, 24.0, **lugs))
    assert refused == ""
    assert "a force of 1,000 N (2.0% of the largest) is left over, which its links share" in warned


def test_two_lugs_of_a_structure_carry_forces_and_couples() -> None:
    """By their distance, though both are free to tilt; one alone that is free does not."""
    profile = [
        {"length": 10, "diameter": 20, "name": "left"},
        {"length": 20, "diameter": 20, "connection": "M"},
        {"length": 20, "diameter": 20, "name": "right"},
    ]
    free = {"tilt": "free"}
    pull = {"M": [5e4, 0.0]}
    both = study(0, 0, pull, profile=profile, lug={"left": free, "M": free, "right": free})
    one = study(0, 0, pull, profile=profile, lug={"left": free, "M": free})
    assert said(both) == ("", "")
    assert "no lug reacts" in said(one)[0]


def test_the_weight_of_a_pin_acts_at_its_centre_of_volume(steel: Material) -> None:
    """A stepped pin held up at its ends by what statics gives is in equilibrium."""
    pin = Pin("P", (Segment(0.03, 0.04, connection="A"), Segment(0.07, 0.02, connection="B")))
    assert steel.density is not None
    weights = steel.density * 9.81 * np.pi / 4.0 * np.array([0.04**2 * 0.03, 0.02**2 * 0.07])
    at, bands = np.array([0.015, 0.065]), np.array([0.015, 0.065])
    assert at.tolist() == bands.tolist()  # so each band carries its own segment
    forces = np.stack([np.zeros(2), weights, np.zeros(2)], axis=1)[None]
    loads = PinLoads("own", ("A", "B"), forces, body=np.array([0.0, -9.81, 0.0]))
    found = out_of_balance(pin, loads, steel.density)
    assert max(found.shares) < 1e-12


def test_a_pin_of_a_mechanism_in_single_shear_needs_lugs() -> None:
    """Pin C of the landing gear without clamp and lugs: two equal forces, so the distance of its
    bands over its length.
    """
    gear = pinstress.load_study(ROOT / "studies" / "grenier2008.toml")
    free = pinstress.changed_study(gear, {"pin.C.clamp": []})
    refused, _ = said(free)
    assert "pin C is unconstrained in case landing" in refused
    pin = pin_of(free, "C")
    share = abs(pin.band("C1").middle - pin.band("C2").middle) / pin.length
    assert f"couple across the axis is {share:.2g} of the largest force" in refused
    assert "give it lugs, whose tilt carries couples (pin.C.lug)" in refused
    assert "for example" not in refused  # the mechanism gives the forces
    assert said(pinstress.load_study(ROOT / "studies" / "landing_gear.toml")) == ("", "")


def test_check_ends_with_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "clevis.toml"
    path.write_text(study(45.0, 5.0).text)
    assert run_command_line(["check", str(path)]) == 1
    assert "Not decided: pin P is unconstrained in case pull" in capsys.readouterr().err
    path.write_text(study(27.0, 23.0).text)
    assert run_command_line(["check", str(path)]) == 0
    assert capsys.readouterr().err.count("Warning") == 1


def test_it_says_which_lugs_would_hold_a_pin() -> None:
    """Segments of the link that carries the pin have names, or have yet to be named."""
    profile: list[dict[str, Any]] = [
        {"length": 10, "diameter": 20, "name": "left"},
        {"length": 20, "diameter": 20, "connection": "M"},
        {"length": 10, "diameter": 20, "name": "right"},
    ]
    loaded: dict[str, Any] = {"forces": {"M": [5e4, 0]}, "lug": {"M": {}}}
    refused, _ = said(study(0.0, 0.0, profile=profile, **loaded))
    assert refused.endswith("each segment that a structure holds: pin.P.lug.left, pin.P.lug.right")
    for segment in profile:
        segment.pop("name", None)
    refused, _ = said(study(0.0, 0.0, profile=profile, **loaded))
    assert refused.endswith("and give it a lug (pin.P.lug.NAME)")
