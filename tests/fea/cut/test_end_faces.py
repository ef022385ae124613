"""End faces into which cuts open: they are drawn, and read, as the local solid has them."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
import pytest
from scipy.spatial import cKDTree

from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import StressField
from fea.core.voigt import von_mises
from fea.cut.field import CutField
from fea.solve.solve import solve_pin
from geometry import Cut, CutPin, Flat, Passage, Pin, Segment
from pinbase.arrays import Floats
from tests.fea.cut.test_cut_kinds import STEEL

R, OVERHANG = 0.015, 0.012
PROFILE = Pin(
    "shaft",
    (
        Segment(OVERHANG, 2.0 * R),
        Segment(0.03, 2.0 * R, connection="A"),
        Segment(0.06, 2.0 * R),
        Segment(0.03, 2.0 * R, connection="B"),
        Segment(0.06, 2.0 * R),
        Segment(0.03, 2.0 * R, connection="C"),
    ),
)
FORCES = np.array([[[-1e4, 3e3, 0.0], [2e4, -6e3, 0.0], [-1e4, 3e3, 0.0]]])
LOADS = PinLoads("case", ("A", "B", "C"), FORCES)
DISTANCE = 0.45 * R
FLAT, DRILLED = Flat(0.0, 0.008, DISTANCE), Passage(0.0, 0.02, 0.008, 0.006, 0.3, "start")


def end_face(cut: Cut, model: Literal["auto", "solid"]) -> tuple[StressField, Floats, Floats]:
    """The stress on one mesh, the points (P, 3) of the end face z = 0, m, and the von Mises stress
    (P,) there, Pa.
    """
    need = Requirement(0.2, model=model, meshes=1)
    (found,) = solve_pin(CutPin(PROFILE, [cut]), STEEL, (), (LOADS,), need)
    assert found.answer is not None
    picture = found.answer.picture(LOADS, 0)
    assert picture is not None
    at = np.abs(picture.points[:, 2]) < 1e-9
    return found.answer, picture.points[at], von_mises(picture.stress[at])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cut", "removed"),
    [
        (FLAT, R**2 * math.acos(DISTANCE / R) - DISTANCE * math.sqrt(R**2 - DISTANCE**2)),
        (DRILLED, math.pi * 0.004**2),
    ],
)
def test_the_end_face_is_open(cut: Cut, removed: float) -> None:
    """The area that is drawn lacks the cut."""
    field, *_ = end_face(cut, "auto")
    assert isinstance(field, CutField)
    surface = field.solution.unit_surface
    corners = surface.points[surface.triangles]
    a, b, c = np.moveaxis(corners[(np.abs(corners[:, :, 2]) < 1e-9).all(axis=1)], 1, 0)
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    assert area == pytest.approx(math.pi * R**2 - removed, rel=0.02)


@pytest.mark.slow
def test_its_stress_is_that_of_a_whole_solid() -> None:
    """Beside a flat on the overhang."""
    _, x, ours = end_face(FLAT, "auto")
    _, y, whole = end_face(FLAT, "solid")
    apart, near = (np.asarray(found) for found in cKDTree(y).query(x))
    close = np.flatnonzero(apart < 0.03 * R)
    assert len(close) > 20
    assert ours[close] == pytest.approx(whole[near[close]], abs=0.1 * float(whole.max()))
