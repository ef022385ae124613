"""Lugs in a study: what a table of them means, and what is refused."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from fea.support.lugs.lug import Bushing, Lug, LugRange
from pinstress import InputError, load_study, prepare, run
from pinstress.study.model.lugs import AssumedLugs
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.studies import DOUBLE_SHEAR
from tests.support.study_text import study_file

STUDY = """
title = "A pin in double shear"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"

[material.bronze]
youngs_modulus = "110 GPa"
poisson_ratio = 0.34

[analysis]
tolerance = 0.1
{analysis}

[case.pull]
kind = "given"
forces = {{ L = [-25000, 0], M = [50000, 0], R = [-25000, 0] }}

[pin.P]
material = "steel"
profile = {profile}
{pin}
"""


def study(folder: Path, pin: str = "", analysis: str = "") -> Path:
    return study_file(folder, STUDY.format(profile=DOUBLE_SHEAR, pin=pin, analysis=analysis))


def lugs(folder: Path, pin: str = "", analysis: str = "") -> tuple[Lug, ...]:
    (task,) = prepare(load_study(study(folder, pin, analysis))).tasks
    return task.lugs


def test_every_key_of_a_lug(tmp_path: Path) -> None:
    given = """
[pin.P.lug.L]
outer_diameter = 60
material = "bronze"
clearance = 0.02
edge_radius = 0.5
tilt = "free"
bushing = { thickness = 2, material = "steel" }
friction = 0.15
[pin.P.lug.M]
tilt = "guided"
[pin.P.lug.R]
tilt = "2e5 N m/rad"
clearance = -0.01
range = { clearance = [-0.02, 0], stiffness = [0.8, 1.2], tilt = ["1e5 N m/rad", "guided"] }
"""
    left, middle, right = lugs(tmp_path, given)
    assert right.range.clearance == pytest.approx((-2e-5, 0.0))
    assert (right.range.stiffness, right.range.tilt) == ((0.8, 1.2), (1e5, math.inf))
    assert left.range == LugRange()
    steel = middle.material
    assert (left.connection, left.outer_diameter, left.material.name) == ("L", 0.06, "bronze")
    assert (left.clearance, left.edge_radius, left.tilt) == pytest.approx((2e-5, 5e-4, 0.0))
    assert left.bushing == Bushing(0.002, steel)
    assert (middle.tilt, right.tilt) == (math.inf, 2e5)
    assert right.clearance == pytest.approx(-1e-5)
    assert [(lug.friction, lug.growth) for lug in (left, middle)] == [(0.15, 0.0), (0.0, 0.0)]


def test_what_is_not_given(tmp_path: Path) -> None:
    """An eye of 2.5 diameters of the pin's material that fits, and tilts as its own shank bends."""
    (left, middle, right) = lugs(tmp_path, "lug.M = {}")
    assert left.outer_diameter == middle.outer_diameter == pytest.approx(0.05)
    assert (left.clearance, left.edge_radius, left.bushing) == (0.0, 0.0, None)
    assert left.material.name == "steel"
    assert left.tilt == pytest.approx(right.tilt)
    assert left.tilt == pytest.approx(210e9 * 0.05 * 0.01**3 / (12.0 * 0.04))
    assert middle.tilt == pytest.approx(8.0 * left.tilt)


def test_a_range_of_clearance_that_leaves_zero_out_is_solved_in_its_middle(tmp_path: Path) -> None:
    """It was solved without clearance, which the range excludes."""
    ranges = """
[pin.P.lug.L]
range = { clearance = [0.03, 0.06] }
[pin.P.lug.M]
range = { clearance = [-0.01, 0.06] }
[pin.P.lug.R]
fit = "H7/f7"
range = { clearance = [0.03, 0.06] }
"""
    left, middle, right = lugs(tmp_path, ranges)
    assert left.clearance == pytest.approx(4.5e-5)
    assert middle.clearance == 0.0
    assert right.clearance == pytest.approx(0.5 * (20e-6 + 62e-6))


def test_a_lug_bends_as_far_as_its_shank_is_held(tmp_path: Path) -> None:
    """A shank 30 wide and held 100 away bends four times as much as the default says."""
    shanks = """
[pin.P.lug.L]
shank = { width = 30, length = 100 }
[pin.P.lug.M]
shank = { width = 30, length = 100 }
tilt = "guided"
[pin.P.lug.R]
shank = { width = 30 }
"""
    left, middle, right = lugs(tmp_path, shanks)
    default = 210e9 * 0.05 * 0.01**3 / (12.0 * 0.04)
    assert left.tilt == pytest.approx(default * 0.8 / left.outline(0.01).bending)
    assert left.tilt == pytest.approx(0.248 * default, rel=0.01)
    assert right.tilt == pytest.approx(default)
    assert middle.tilt == math.inf


@each(
    ("pin", "joints", "held"),
    [
        ("", "auto", 0),
        ("lug.M = {}", "auto", 3),
        ("lug.M = {}\nhole = [{ z = 20, diameter = 4 }]", "auto", 3),
        ("lug.M = {}", "prescribed", 0),
        ("", "contact", 3),
        ("", "foundation", 3),
    ],
)
def test_whose_pins_are_in_lugs(tmp_path: Path, pin: str, joints: str, held: int) -> None:
    assert len(lugs(tmp_path, pin, f'joints = "{joints}"')) == held


def test_a_lug_of_the_structure_by_the_name_of_a_segment(tmp_path: Path) -> None:
    assert [lug.connection for lug in lugs(tmp_path, "lug.gap = {}")] == ["L", "M", "R", "gap"]


@each(
    "cut",
    [
        "flat = [{ z = [14, 26], distance = 9 }]",
        "slot = [{ z = [13, 29], width = 4, depth = 2 }]",
        "passage = [{ diameter = 4, offset = 4 }]\nhole = [{ z = 21, diameter = 3, depth = 5 }]",
        "hole = [{ z = 21, diameter = 3, chamfer = 0.5 }]",
    ],
)
def test_cuts_of_all_kinds_may_be_in_lugs(tmp_path: Path, cut: str) -> None:
    assert len(lugs(tmp_path, f"lug.M = {{}}\n{cut}")) == 3


@each(
    ("pin", "code", "said"),
    [
        ("lug.X = {}", "unknown-segment", "pin.P.lug.X"),
        ('lug.M = { material = "brass" }', "unknown-material", "pin.P.lug.M.material"),
        (
            'lug.M = { bushing = { thickness = 1, material = "brass" } }',
            "unknown-material",
            "pin.P.lug.M.bushing.material",
        ),
        ("lug.M = { outer_diameter = 20 }", "lug-too-narrow", "lug M"),
        ("lug.M = { clearance = 5 }", "clearance-too-large", "lug M"),
        ("lug.M = { clearance = -2 }", "interference-too-large", "lug M"),
        ("lug.M = { edge_radius = 15 }", "edge-radius-too-large", "lug M"),
        ("lug.M = { range = { clearance = [0.1, 5] } }", "clearance-too-large", "lug M"),
        ("lug.M = { range = { clearance = [0.1, 0] } }", "range-order", "smaller value first"),
        ("lug.M = { range = { stiffness = [0, 2] } }", None, "pin.P.lug.M.range.stiffness"),
        ("lug.M = { range = { clearance = 0.1 } }", None, "pin.P.lug.M.range.clearance"),
        ('lug.M = { tilt = "loose" }', None, "pin.P.lug.M.tilt"),
        ("lug.M = { tilt = -1 }", None, "pin.P.lug.M.tilt"),
        ('clamp = ["start"]\nlug.M = {}', "clamped-in-lugs", "clamped at start"),
        ("lug.M = {}\nhole = [{ z = 11, diameter = 4 }]", "hole-at-end", "hole 1 lies at the edge"),
        (
            "lug.M = {}\nflat = [{ z = [28, 33], distance = 8 }]",
            "flat-at-end",
            "flat 1 lies at the edge of the lug of M, where stress has no bound: end it inside",
        ),
        (
            "lug.M = {}\nflat = [{ z = [10.2, 31.8], distance = 8 }]",
            "flat-at-end",
            "it goes through the whole lug",
        ),
        (
            "lug.M = {}\nslot = [{ z = [12, 29], width = 40, depth = 2 }]",
            "slot-too-wide",
            "times the pin's diameter there, so that it is a flat: give it as one",
        ),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_solved(
    tmp_path: Path, pin: str, code: str | None, said: str
) -> None:
    path = study(tmp_path, pin)
    if code is None:
        with pytest.raises(InputError, match=said):
            prepare(load_study(path))
        return
    with raises(InputError, code) as caught:
        prepare(load_study(path))
    assert said in str(caught.value)


@each("lug", ["{ clearance = -0.001 }", '{ bushing = { thickness = 1, material = "bronze" } }'])
def test_what_foundations_cannot_answer_is_refused(tmp_path: Path, lug: str) -> None:
    path = study(tmp_path, f"lug.M = {lug}", 'joints = "foundation"')
    with raises(InputError, "beyond-foundations", "lug M", '"contact"'):
        prepare(load_study(path))
    assert len(lugs(tmp_path, f"lug.M = {lug}")) == 3


@each("model", ["harmonic", "solid"])
def test_foundations_are_a_beams_alone(tmp_path: Path, model: str) -> None:
    path = study(tmp_path, "", f'joints = "foundation"\nmodel = "{model}"')
    with raises(InputError, "model-without-contact", "pin P", "beam"):
        prepare(load_study(path))


def around(folder: Path, pin: str, analysis: str = "") -> AssumedLugs:
    (task,) = prepare(load_study(study(folder, pin, analysis))).tasks
    assert task.surroundings is not None
    return task.surroundings


def test_a_pin_without_lugs_may_sit_in_default_ones(tmp_path: Path) -> None:
    found = around(tmp_path, "")
    assert [lug.connection for lug in found.lugs] == ["L", "M", "R"]
    assert [lug.outer_diameter for lug in found.lugs] == pytest.approx([0.05] * 3)
    assert found.assumed
    (task,) = prepare(load_study(study(tmp_path, "lug.M = {}"))).tasks
    assert task.surroundings is None


def test_a_clamped_segment_is_a_lug_of_the_structure(tmp_path: Path) -> None:
    found = around(tmp_path, 'clamp = ["L", "gap"]')
    assert found.pin is not None
    assert tuple(found.pin.connections) == ("M", "R")
    assert {lug.connection for lug in found.lugs} == {"L", "M", "R", "gap"}


def test_a_clamped_pin_stays_clamped_where_all_others_are_in_contact(tmp_path: Path) -> None:
    path = study(tmp_path, 'clamp = ["L", "gap"]', 'joints = "contact"')
    (task,) = prepare(load_study(path)).tasks
    assert task.clamps == ("L", "gap")
    assert task.lugs == ()


def test_given_lugs_of_a_prescribed_pin_are_those_of_its_range(tmp_path: Path) -> None:
    found = around(tmp_path, "lug.M = { outer_diameter = 60 }", 'joints = "prescribed"')
    assert not found.assumed
    assert [lug.outer_diameter for lug in found.lugs] == pytest.approx([0.05, 0.06, 0.05])


@each("pin", ['clamp = ["start"]', 'clamp = ["M", "end"]', "hole = [{ z = 20, diameter = 4 }]"])
def test_where_no_lugs_can_be_assumed(tmp_path: Path, pin: str) -> None:
    found = around(tmp_path, pin)
    assert (found.pin, found.lugs) == (None, ())
    assert found.why


def test_one_band_alone_has_no_lugs(tmp_path: Path) -> None:
    path = study(tmp_path)
    text = re.sub(r', connection = "[LR]"', "", path.read_text())
    path.write_text(re.sub(r"forces = .*", "forces = { M = [0, 0] }", text))
    (task,) = prepare(load_study(path)).tasks
    assert task.surroundings is not None
    assert task.surroundings.why


def test_foundations_from_study_to_results(tmp_path: Path) -> None:
    row = run(load_study(study(tmp_path, "", 'joints = "foundation"')))["P", "pull"]
    assert (row.model, row.verdict) == ("foundation", "unconverged")
    assert row.held == "its lugs (foundation)"
    assert row.error_estimate == row.error_parts["model"]
    assert row.joint is not None
    assert [band.force for band in row.joint.bands] == pytest.approx([25e3, 50e3, 25e3])
    assert row.joint.range is not None
    assert not row.joint.range.assumed
    low, high = row.joint.range.max_von_mises
    assert low < (row.max_von_mises or 0.0) < high


def test_a_prescribed_pin_has_a_range(tmp_path: Path) -> None:
    row = run(load_study(study(tmp_path)))["P", "pull"]
    assert (row.model, row.held) == ("harmonic", "nothing (loads in balance)")
    assert row.joint is not None
    assert (row.joint.model, row.joint.bands) == ("prescribed", ())
    assert row.joint.range is not None
    assert row.joint.range.assumed
    assert row.joint.range.model == "foundation"


def test_a_prescribed_pin_without_a_range_says_why(tmp_path: Path) -> None:
    row = run(load_study(study(tmp_path, 'clamp = ["start"]')))["P", "pull"]
    assert row.joint is not None
    assert row.joint.range is None
    assert "start" in row.joint.remark


@each("model", ["beam", "solid"])
def test_contact_is_found_by_the_harmonic_model_alone(tmp_path: Path, model: str) -> None:
    path = study(tmp_path, "lug.M = {}", f'model = "{model}"')
    with raises(InputError, "model-without-contact", "pin P", "harmonic"):
        prepare(load_study(path))


def test_lugs_whose_size_is_given_are_checked_by_hand(tmp_path: Path) -> None:
    """Net section F / (2 t b_eff), b_eff 0.6 b sqrt(D/b) without an ultimate strength, with the
    bore that holds a bushing; others are not checked.
    """
    given = """
[pin.P.lug.L]
outer_diameter = 60
bushing = { thickness = 2, material = "bronze" }
[pin.P.lug.M]
"""
    found = run(load_study(study(tmp_path, given)))["P", "pull"]
    checks = {(c.method, c.at): c.demand for c in found.hand_checks if c.method.startswith("lug")}
    assert set(checks) == {
        ("lug, net section", "L"), ("lug, shear-out", "L"), ("lug, bearing", "L"),
        ("lug, bearing, bushing", "L"),
    }  # fmt: skip
    effective = 0.6 * 18.0 * (24.0 / 18.0) ** 0.5
    assert checks["lug, net section", "L"] == pytest.approx(25000.0 / (2.0 * effective * 10.0))
    assert "bending, joint model" in {c.method for c in found.hand_checks}


@pytest.mark.slow
def test_cases_in_contact_share_a_surface(tmp_path: Path) -> None:
    """All cases of a pin are solved on the same meshes: at the angle of its maximum the surface has
    the stress that each case has there, and where lugs press on a part of the circumference, which
    is not read at their edges, no less.
    """
    path = study(tmp_path, "lug.M = {}")
    more = '[case.push]\nkind = "given"\nforces = { L = [0, -9e3], M = [0, 1e4], R = [0, -1e3] }\n'
    path.write_text(path.read_text().replace("[pin.P]", f"{more}\n[pin.P]"))
    found = run(load_study(path))
    (surface,) = found.surfaces
    assert [case.case for case in surface.cases] == ["pull", "push"]
    turns = np.linspace(0.0, 2.0 * np.pi, 361)
    free = np.abs(surface.points[:, 2] - 10.77) < 0.2  # mm: the gap from 10 to 11
    assert free.sum() > 5
    for case in surface.cases:
        first, second = case.amounts[case.instant].T
        even, n = np.array(surface.even[:5]), surface.n[:, None]
        c, s = np.cos(n * turns), np.sin(n * turns)
        back = surface.stress @ (c * first[:, None] + s * second[:, None])
        forth = surface.stress @ (s * first[:, None] - c * second[:, None])
        stress = np.linalg.norm(np.where(even[:, None], back, forth), axis=1).max(axis=1)
        assert (case.largest <= stress * 1.001).all()
        assert stress[free] == pytest.approx(case.largest[free], rel=1e-3)


@pytest.mark.slow
def test_a_pin_on_a_structure_has_the_hand_checks_of_its_joint(tmp_path: Path) -> None:
    """What the structure takes, and so the pin's bending, is known to the joint alone."""
    path = study(tmp_path, "lug.gap = {}\nlug.M = { outer_diameter = 50 }")
    found = run(load_study(path))["P", "pull"]
    assert {
        c.method: c.basis for c in found.hand_checks if c.governs and "shear, mean" not in c.method
    } == {
        **dict.fromkeys(("lug, net section", "lug, shear-out", "lug, bearing", "bearing"), ""),
        **dict.fromkeys(
            ("single shear, at the neutral axis", "bending, joint model"), "joint model"
        ),
    }
    assert found.held == "its lugs (contact)"
