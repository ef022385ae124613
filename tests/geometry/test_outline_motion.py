"""How nodes on the outline of a section's mesh move with a dimension."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geometry import Pin, Segment
from geometry.mesh.outline_motion import OtherShapeError, OutlineNodes, Reach
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.shape.dimensions import dimensions

TUBE = Pin(
    "P",
    (
        Segment(0.03, 0.02, bore=0.012, connection="A", fillet=0.001),
        Segment(0.04, 0.026, bore=0.012, connection="B", edge_radii=(0.0, 0.0005)),
        Segment(0.03, 0.02, end_diameter=0.018, bore=0.008, bore_radii=(0.001, 0.0)),
    ),
    fillet=0.002,
)
MESH = meridian_mesh(TUBE, SectionSize())
NODES = OutlineNodes(MESH, TUBE, [Reach((0.01, 0.03), 0.001), Reach((0.013, 0.03), 0.001)])


def test_nodes_stay_on_the_outline() -> None:
    """Of a pin with every dimension 2 % larger, one after the other, and on the same edges."""
    assert NODES.at(TUBE) == pytest.approx(MESH.nodes[NODES.rows], abs=1e-12)
    for one in dimensions(TUBE):
        pin = one.changed(1.02 * one.value)
        outer = 0.5 * max(max(s.diameters) for s in pin.segments)
        at = NODES.at(pin)
        assert at[:, 0].max() == pytest.approx(outer, rel=1e-12)
        assert at[:, 1].max() == pytest.approx(pin.length, rel=1e-12)
    with pytest.raises(OtherShapeError):
        NODES.at(replace(TUBE, fillet=0.0))


def test_nodes_move_by_what_the_dimension_does() -> None:
    """A length takes along all beyond its segment, a diameter the surface by its half, a fillet the
    middle of its arc by sqrt(2) - 1 away from the corner.
    """
    by_key = {one.key: one for one in dimensions(TUBE)}
    assert {key.partition("].")[2] or key for key in by_key} >= {
        "diameter", "bore", "length", "fillet", "edge_radius[2]", "bore_radius[1]",
    }  # fmt: skip
    r, z = MESH.nodes[NODES.rows].T
    moved = NODES.motion(by_key["profile[1].length"])
    assert moved.velocity[z > 0.031, 1] == pytest.approx(1.0)
    assert moved.velocity[z < 0.001, 1] == pytest.approx(z[z < 0.001] / 0.03, abs=0.05)
    assert [p.length for p in moved.pins] == pytest.approx(
        [TUBE.length + k * moved.step for k in (-2.0, -1.0, 1.0, 2.0)]
    )
    moved = NODES.motion(by_key["profile[2].diameter"])
    on_it = np.abs(r - 0.013) < 1e-12
    assert moved.velocity[on_it, 0] == pytest.approx(0.5)
    assert moved.velocity[r < 0.0095] == pytest.approx(0.0, abs=1e-9)
    moved = NODES.motion(by_key["profile[1].fillet"])
    corner = np.array([0.01, 0.03])
    arc = np.abs(np.hypot(r - 0.011, z - 0.029) - 0.001) < 1e-9
    arc &= (r < 0.011) & (z > 0.029)
    away = np.stack([r[arc], z[arc]], axis=1) - corner
    middle = int(np.hypot(*away.T).argmin())
    diagonal = np.array([1.0, -1.0]) / np.sqrt(2.0)
    assert moved.velocity[arc][middle] @ diagonal == pytest.approx(np.sqrt(2.0) - 1.0, rel=1e-2)
    # Similar bodies: the sum over all lengths times their rates is the place itself.
    whole = sum(one.value * NODES.motion(one).velocity for one in by_key.values())
    assert whole == pytest.approx(np.stack([r, z], axis=1), abs=1e-9)
