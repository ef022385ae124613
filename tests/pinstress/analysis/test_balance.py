"""Stress that gives the sections of a body in cells their forces."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.solution import Picture
from fea.section.section_stress import SectionField
from geometry import Pin, Segment
from pinbase.arrays import Floats
from pinstress.analysis.balance import balanced

R, LENGTH = 10e-3, 60e-3
PIN = Pin("P", (Segment(LENGTH, 2.0 * R),))


def test_the_surface_between_points_that_are_shown_stays_as_it_is() -> None:
    """A long cylinder is shown by rings far apart: nodes between these counted as inner ones."""
    turns = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    heights = np.linspace(0.0, LENGTH, 31)
    rings = [[r * np.cos(t), r * np.sin(t)] for r in (R, 0.5 * R) for t in turns]
    across = np.array([*rings, [0.0, 0.0]])
    points = np.array([[x, y, z] for z in heights for x, y in across])
    outer = np.hypot(*points[:, :2].T) > 0.99 * R
    ends = (points[:, 2] == 0.0) | (points[:, 2] == LENGTH)
    cells = Delaunay(points, qhull_options="QJ").simplices.astype(np.int64)
    none = np.zeros((len(points), 6))
    body = Picture(points, cells, "tetra", none[:, :3], none, none[:, 0])

    def forces(z: Floats) -> Floats:
        return np.tile([1.0, 2.0, 3.0], (len(z), 1))

    stress = balanced(body, PIN, points[outer & ends], forces).stress
    assert np.abs(stress[outer]).max() == 0.0
    inside = stress[~outer & ~ends][:, [4, 3, 2]]
    assert inside == pytest.approx(inside[:, :1] * [1.0, 2.0, 3.0], rel=1e-6)
    assert (inside > 0.0).all()


@pytest.mark.parametrize("clamps", [("start",), ("start", "end")])
def test_forces_between_two_clamps_are_not_known(clamps: tuple[str, ...]) -> None:
    """There was no mask of sections without a span that statics decides: a pin of two clamps had no
    file of its inside.
    """
    pin = Pin("P", (Segment(0.02, 0.02), Segment(0.02, 0.02, connection="B"), Segment(0.02, 0.02)))
    loads = PinLoads("k", ("B",), np.array([[[100.0, 0.0, 0.0]]]))
    sections = SectionField(pin, Material("steel", 2.1e11, 0.3), clamps, (loads,))
    forces = sections.forces_on(loads, 0)(np.array([0.01, 0.05]))
    exact = [[100.0, 0.0, 0.0], [0.0, 0.0, 0.0]] if len(clamps) == 1 else np.full((2, 3), np.nan)
    assert forces == pytest.approx(np.array(exact), abs=1e-9, nan_ok=True)
