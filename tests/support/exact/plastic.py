"""Bodies whose limit loads are known in closed form."""

import math

import numpy as np

from assess.plastic.body import FlowingBody, untied
from assess.plastic.flow import FlowRule
from assess.plastic.limit_load import MeshBracket, limit_on_mesh
from assess.plastic.mechanism import RefinedElements
from assess.plastic.pin_body import acting_at, hexahedral, nodal_forces, pin_body, refine
from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexSize, hexahedra
from pinbase.arrays import Floats

YIELD = 250e6
STEEL = Material("steel", 200e9, 0.3, None, YIELD)
RULE = FlowRule(STEEL)
D = 0.02


def bar(bore: float = 0.0) -> Pin:
    """Return a bar with bands two diameters long at its ends and four diameters between them.

    bore: in diameters
    """
    ends = (
        Segment(2 * D, D, bore * D, connection="a"),
        Segment(2 * D, D, bore * D, connection="b"),
    )
    return Pin("bar", (ends[0], Segment(4 * D, D, bore * D), ends[1]))


def couples(axis: int) -> PinLoads:
    """Return couples of 1 N m at both ends of the bar, about y (axis 1) or about its own
    axis (2).
    """
    moments = np.zeros((1, 2, 3))
    moments[0, :, axis] = 1.0, -1.0
    return PinLoads("couples", ("a", "b"), np.zeros((1, 2, 3)), moments)


def limit(
    pin: Pin, loads: PinLoads, fineness: HexSize, clamps: tuple[str, ...] = ()
) -> MeshBracket:
    made = pin_body(pin, RULE, clamps, acting_at(loads, 0), fineness)
    return limit_on_mesh(made.body, made.forces, refine(made.body.elements))


def elastic_moment(bore: float = 0.0) -> float:
    """Return the moment at which a round bar begins to yield in bending, N m.

    bore: in diameters
    """
    return YIELD * math.pi / 32 * D**3 * (1 - bore**4)


def cylinder(around: int) -> tuple[FlowingBody, Floats, RefinedElements]:
    """Return a quarter of a thick cylinder in plane strain, the forces on it, and its elements with
    more integration points.

    Its radii are 1 and 1.3 m. The forces are those of 1 Pa from outside, which makes it flow as a
    pressure from inside does.
    """
    pin = Pin("ring", (Segment(0.2, 2.6, 2.0, connection="a"),))
    mesh = hexahedra(pin, HexSize(around, 1.0), 1)
    elements = hexahedral(mesh.nodes, mesh.elements)
    zero = np.abs(mesh.nodes) < 1e-9
    zero[:, 2] = True
    ties = untied(len(mesh.nodes)).without(np.flatnonzero(zero))
    pressure = ((UnitLoad("a", "pressure", 0, (("a", 1.0),)), 0, 1.0),)
    forces = ties.matrix.T @ nodal_forces(pin, RULE, mesh, elements, pressure).ravel()
    return FlowingBody(elements, ties, RULE), forces, refine(elements)
