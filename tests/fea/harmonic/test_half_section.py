"""What a pin shows when it is cut open, beside what its fields have on the same meridian."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.voigt import von_mises
from fea.harmonic.field import HarmonicField
from fea.harmonic.half_section import MeridianPlane
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_pin
from geometry import Pin, Segment

ANGLE = 0.7
LOADS = PinLoads("c", ("P1",), np.array([[[500.0, 200.0, -900.0]]]))


@pytest.fixture(scope="module")
def plane() -> MeridianPlane:
    """A tube with a head and a bore that ends at half its length."""
    segments = (
        Segment(0.02, 0.03, 0.01, "head"),
        Segment(0.02, 0.02, 0.01),
        Segment(0.02, 0.02, 0.0, "P1", "P1"),
    )
    steel = Material("steel", 200e9, 0.3)
    requirement = Requirement(model="harmonic", meshes=1)
    (found,) = solve_pin(Pin("p", segments), steel, ("start",), (LOADS,), requirement)
    assert isinstance(found.answer, HarmonicField)
    return MeridianPlane(found.answer.fields, found.answer.singularities)


def test_walls_are_those_of_the_profile(plane: MeridianPlane) -> None:
    inner, outer = plane.walls(np.array([0.0, 0.01, 0.03, 0.05, 0.06]))
    assert inner == pytest.approx([0.005, 0.005, 0.005, 0.0, 0.0])
    assert outer == pytest.approx([0.015, 0.015, 0.01, 0.01, 0.01])


def test_stress_at_nodes_is_that_of_the_fields(plane: MeridianPlane) -> None:
    fields = plane.fields
    rows = np.arange(fields.skin, len(fields.displacement))[::7]
    found = plane.von_mises(LOADS, 0, ANGLE, fields.points[rows])
    angles = np.array([ANGLE, ANGLE + np.pi])
    expected = von_mises(Circumference(fields, LOADS).stress(rows, 0, angles))
    assert found == pytest.approx(expected.T, rel=1e-9)
    assert found[0] != pytest.approx(found[1], rel=1e-3)  # axial force and bending


def test_zones_are_marked(plane: MeridianPlane) -> None:
    corner = np.array([[[0.01, 0.02], [0.008, 0.03]]])
    assert plane.outside(corner).tolist() == [[False, True]]


def test_every_point_of_the_section_has_a_stress(plane: MeridianPlane) -> None:
    """Also where round-off puts it outside of the section, at ends of the axis and of the walls."""
    points = np.array([[0.0, 0.06], [-1e-12, 0.06 + 1e-12], [0.015 + 1e-12, 0.0], [0.005, -1e-12]])
    found = plane.von_mises(LOADS, 0, ANGLE, points)
    assert np.isfinite(found).all()
    fields = plane.fields
    nodes = fields.points[: len(fields.displacement)]
    everywhere = np.arange(len(nodes))
    angles = np.array([ANGLE, ANGLE + np.pi])
    known = von_mises(Circumference(fields, LOADS).stress(everywhere, 0, angles))
    for point, both in zip(points, found.T, strict=True):
        apart = np.linalg.norm(nodes - point, axis=1)
        near = known[apart <= apart.min() + 1e-9]  # a corner has a stress on either side
        assert (both >= near.min(axis=0) * (1.0 - 1e-6)).all()
        assert (both <= near.max(axis=0) * (1.0 + 1e-6)).all()
