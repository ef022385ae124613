"""Forces of links along the axis: where they enter the pin, and the sections between.

Sections are those of statics; stress a diameter away from shoulders is force over area
(Saint-Venant).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import pinstress
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve, solve_pin
from fea.support.foundation.foundation_model import FoundationModel
from fea.support.lugs.axial import axial_seats
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import ArgumentError, Pin, Segment
from pinstress.study.reading.errors import InputError
from tests.support.each import each

STEEL = Material("steel", 210e9, 0.3, yield_strength=600e6)
D, PULL = 0.02, 5e4
HEADED = Pin(
    "P",
    (
        Segment(0.008, 0.03),
        Segment(0.001, D),
        Segment(0.010, D, connection="L"),
        Segment(0.001, D),
        Segment(0.020, D, connection="M"),
        Segment(0.001, D),
        Segment(0.010, D, connection="R"),
        Segment(0.002, D),
        Segment(0.006, 0.018, name="groove"),
        Segment(0.002, 0.022, name="ring"),
    ),
    fillet=0.0005,
)
LUGS = tuple(Lug(name, 0.05, STEEL) for name in "LMR")


def loads(along: list[float]) -> PinLoads:
    forces = np.zeros((1, 3, 3))
    forces[0, :, 0] = [-1e3, 2e3, -1e3]
    forces[0, :, 2] = along
    return PinLoads("axial", ("L", "M", "R"), forces)


def seats(**axial: tuple[str, str]) -> dict[str, tuple[str, str]]:
    lugs = (replace(lug, axial=axial.get(lug.connection)) for lug in LUGS)
    return axial_seats(HEADED, tuple(lugs))


def test_a_link_bears_on_the_next_shoulder_without_a_lug_between() -> None:
    """Over gaps of the pin's diameter and a groove; M has a lug on either side."""
    assert seats() == {"L": ("shoulder 1", "L"), "R": ("R", "shoulder 9")}
    stepped = Pin(
        "S", (Segment(D, D, connection="A"), Segment(D, 0.03, connection="B"), Segment(D, D))
    )
    eyes = (Lug("A", 0.05, STEEL), Lug("B", 0.08, STEEL))
    assert axial_seats(stepped, eyes) == {"A": ("A", "shoulder 1")}


def test_what_the_study_names() -> None:
    """Towards the start and towards the end; both ways on the outer surface of a part."""
    assert seats(M=("segment 1", "ring"))["M"] == ("shoulder 1", "shoulder 9")
    assert seats(M=("ring", "ring"))["M"] == ("ring", "ring")
    assert seats(R=("R", "groove"))["R"] == ("R", "groove")
    assert "L" not in seats(L=("L", "L"))


@each(
    ("axial", "code"),
    [
        (("nose", "ring"), "unknown-surface"),
        (("L", "ring"), "axial-on-band"),
        (("ring", "segment 1"), "axial-side"),
    ],
)
def test_names_that_are_refused(axial: tuple[str, str], code: str) -> None:
    with pytest.raises(ArgumentError) as error:
        seats(M=axial)
    assert error.value.code == code


@each("model", ["contact", "foundation"])
def test_sections_carry_the_force_between_the_seats(model: str) -> None:
    """In the groove, which no link reaches otherwise."""
    problem = PinProblem(HEADED, STEEL, LUGS, (loads([-PULL, 0.0, PULL]),))
    (found,) = solve(
        problem,
        Requirement(tolerance=0.3, joints=model, meshes=1, varied=False),  # type: ignore[arg-type]
    )
    assert found.peak.places is not None
    assert found.peak.places.section is not None
    course = np.array(found.peak.places.section.course)
    area = math.pi * 0.018**2 / 4.0
    inside = (course[:, 0] > 0.0535) & (course[:, 0] < 0.0585)
    assert inside.any()
    assert course[inside, 1] == pytest.approx(np.full(inside.sum(), PULL / area), rel=1e-4)
    assert found.peak.places.section.axial_force == pytest.approx(PULL, rel=1e-9)
    assert found.joint is not None
    along = found.joint.along
    assert along is not None
    assert along.axial is not None
    in_groove = (along.z > 0.0535) & (along.z < 0.0585)
    assert along.axial[0, in_groove] == pytest.approx(PULL, rel=1e-9)
    assert along.axial[0, [0, -1]] == pytest.approx(0.0, abs=1e-6 * PULL)
    assert "forces along the axis: that of L on shoulder 1, that of R on shoulder 9" in (
        found.peak.note
    )


def test_foundations_have_the_axial_force_of_statics() -> None:
    z = np.array([0.0, 0.0081, 0.0195, 0.030, 0.0405, 0.0515, 0.0589, HEADED.length])
    (links,) = PinProblem(HEADED, STEEL, LUGS, (loads([-PULL, 0.3 * PULL, 0.7 * PULL]),)).cases
    force = FoundationModel(HEADED, STEEL, LUGS).solve(links).along(z)[0][0]
    exact = PULL * np.array([0.0, -1.0, -1.0, -0.85, -0.7, -0.7, -0.7, 0.0])
    assert force == pytest.approx(exact, abs=1e-9 * PULL)


def test_a_reversed_pull_is_superposed_from_the_same_fields() -> None:
    """L bears on the head one way and on its own band the other: other surfaces are loaded."""
    one, other = loads([-PULL, PULL, 0.0]), loads([PULL, -PULL, 0.0])
    requirement = Requirement(model="harmonic", tolerance=0.02)
    problem = PinProblem(HEADED, STEEL, LUGS, (one,), also={"axial": other})
    (solution,) = solve(problem, requirement)
    (expected,) = solve(PinProblem(HEADED, STEEL, LUGS, (other,)), requirement)
    assert solution.answer is not None
    acting = solution.pressed(other)
    assert solution.answer.maxima(acting)[0] == pytest.approx(expected.peak.max_von_mises, rel=0.03)
    assert solution.peak.max_von_mises != pytest.approx(expected.peak.max_von_mises, rel=0.05)


def test_another_case_with_a_pull_leaves_no_singular_edge_in_this_one() -> None:
    """Fields of the pull are solved for both, but it acts in one of them only."""
    none, pulled = replace(loads([0.0, 0.0, 0.0]), case="none"), loads([PULL, -PULL, 0.0])
    requirement = Requirement(tolerance=0.02)
    (alone,) = solve(PinProblem(HEADED, STEEL, LUGS, (none,)), requirement)
    both = solve(PinProblem(HEADED, STEEL, LUGS, (none, pulled)), requirement)
    assert both[0].peak.verdict == alone.peak.verdict == "converged"
    assert both[0].peak.max_von_mises == pytest.approx(alone.peak.max_von_mises, rel=0.02)


def test_lugs_of_a_structure_react_what_links_pull_and_turn() -> None:
    """A plain pin between two of them has half of the force in each gap, an ear beside a head all
    of it in one.
    """
    plain = Pin(
        "P",
        (
            Segment(0.01, D, name="left"),
            Segment(0.001, D),
            Segment(0.02, D, connection="M"),
            Segment(0.001, D),
            Segment(0.01, D, name="right"),
        ),
    )
    lugs = tuple(Lug(name, 0.05, STEEL) for name in ("left", "M", "right"))
    forces, moments = np.array([[[2e3, 0.0, PULL]]]), np.array([[[0.0, 0.0, 40.0]]])
    pulled = PinLoads("axial", ("M",), forces, moments)
    (reacted,) = PinProblem(plain, STEEL, lugs, (pulled,)).cases
    assert reacted.surfaces == ("M", "left", "right")
    np.testing.assert_allclose(reacted.forces[0, 1:, 2], [-PULL / 2, -PULL / 2])
    np.testing.assert_allclose(reacted.moments[0, 1:, 2], [-20.0, -20.0])
    headed = replace(plain, segments=(Segment(0.005, 0.03), *plain.segments))
    (reacted,) = PinProblem(headed, STEEL, lugs, (pulled,)).cases
    # M pulls away from the head, which the left lug then holds; pushed towards it, nothing does.
    np.testing.assert_allclose(reacted.forces[0, 1:, 2], [-PULL, 0.0])
    (pushed,) = PinProblem(headed, STEEL, lugs, (replace(pulled, forces=-forces),)).cases
    np.testing.assert_allclose(pushed.forces[0, 1:, 2], [PULL / 2, PULL / 2])
    (solution,) = solve(PinProblem(plain, STEEL, lugs, (pulled,)), Requirement(tolerance=0.05))
    section = solution.peak.places.section if solution.peak.places else None
    assert section is not None
    assert abs(section.axial_force) <= PULL / 2 * 1.001


def test_the_face_of_a_shoulder_takes_the_whole_force() -> None:
    """Stress in the middle of a shaft of four diameters, of finite elements, is force over area."""
    pin = Pin(
        "T",
        (
            Segment(0.02, 0.03),
            Segment(0.04, D, connection="A"),
            Segment(0.04, D, connection="B"),
            Segment(0.02, 0.03),
        ),
        fillet=0.001,
    )
    forces = np.zeros((1, 2, 3))
    forces[0, :, 2] = -PULL, PULL
    pulled = PinLoads("pull", ("shoulder 1", "shoulder 3"), forces)
    (found,) = solve_pin(pin, STEEL, (), (pulled,), Requirement(0.01, model="harmonic"))
    assert found.answer is not None
    points = found.answer.points(found.loads)
    middle = np.flatnonzero(points.surface & (np.abs(points.points[:, 2] - 0.06) < 0.003))
    stress = points.at(middle, np.zeros(len(middle)), np.zeros(1, dtype=np.int64))[:, 0, 2]
    assert stress == pytest.approx(np.full(len(middle), PULL / (math.pi * D**2 / 4.0)), rel=2e-4)
    assert not found.peak.singular_at


STUDY = """
title = "Headed pin"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "600 MPa"
[pin.P]
material = "steel"
profile = [
  { length = 8, diameter = 30, name = "head" },
  { length = 10, diameter = 20, connection = "L" },
  { length = 20, diameter = 20, connection = "M" },
  { length = 5, diameter = 24, name = "nut" },
]
fillet = 0.5
HOLE
lug.L = {}
lug.M = { axial = AXIAL }
[case.pull]
kind = "given"
forces = { L = [1000, 0, -20000], M = [-1000, 0, 20000] }
[analysis]
joints = "foundation"
"""


def study(axial: str, hole: str = "") -> pinstress.Study:
    text = STUDY.replace("AXIAL", axial).replace("HOLE", hole)
    if hole:
        text = text.replace('joints = "foundation"', 'joints = "contact"')
    return pinstress.study_from(text)


def test_a_study_names_what_takes_the_force() -> None:
    results = pinstress.run(study('["head", "nut"]'))
    (row,) = results.pins
    assert "that of L on shoulder 1, that of M on shoulder 3" in row.maximum.note
    (row,) = pinstress.run(study('"nut"')).pins
    assert "that of M on nut" in row.maximum.note


@each(
    ("axial", "hole", "code"),
    [
        ('"knob"', "", "unknown-surface"),
        ('"nut"', "hole = [{ z = 28, diameter = 3 }]", "axial-of-cut-pin"),
    ],
)
def test_studies_that_are_refused(axial: str, hole: str, code: str) -> None:
    with pytest.raises(InputError) as error:
        pinstress.prepare(study(axial, hole))
    assert error.value.code == code
