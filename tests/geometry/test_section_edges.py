"""Edges of a section, straight and round: distances and points beside them."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.path import Path

from geometry import Pin, Segment
from geometry.shape.profile import Arc, meridian, off_edge
from pinbase.arrays import Floats

PIN = Pin("P", (Segment(0.03, 0.02, edge_radii=(0.002, 0.0)), Segment(0.02, 0.03)), fillet=0.003)


def test_distances_beside_many_points_of_the_edges() -> None:
    """The least distance from 4,001 points of each, found along it by its own centre and angles."""
    x = np.random.default_rng(4).uniform([-0.002, -0.01], [0.02, 0.06], (300, 2))
    arcs, lefts, outline = 0, list[Floats](), list[Floats]()
    for edge in meridian(PIN):
        part = np.linspace(0.0, 1.0, 4001)[:, None]
        line = np.array(edge.start) + part * (np.array(edge.end) - np.array(edge.start))
        if isinstance(edge, Arc):
            arcs += 1
            away = line - edge.centre  # the chord's points, out to the circle
            line = edge.centre + edge.radius * away / np.hypot(*away.T)[:, None]
            quarter = 0.5 * np.pi * edge.radius
            assert edge.length == pytest.approx(quarter)
        gap = np.hypot(*(x[:, None] - line[None]).transpose(2, 0, 1)).min(axis=1)
        assert edge.distance(x) == pytest.approx(gap, abs=0.5 * edge.length / 4000)
        on, beside = (edge.beside(np.array([0.2, 0.5, 0.9]), off) for off in (0.0, 1e-4))
        assert edge.distance(on) == pytest.approx(0.0, abs=1e-12)
        assert edge.distance(beside) == pytest.approx(1e-4)
        assert off_edge(edge)(*on.T) == pytest.approx(0.0, abs=1e-12)
        lefts.append(beside)
        outline.append(edge.beside(np.linspace(0.0, 1.0, 200), 0.0))
    # The outline goes counter-clockwise, so its left is in the material.
    assert Path(np.concatenate(outline)).contains_points(np.concatenate(lefts)).all()
    assert arcs == 2
