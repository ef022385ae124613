"""How a pin flows at its limit load, at the nodes of its mesh."""

from __future__ import annotations

import math

import numpy as np
from skfem import ElementHexS2

from assess.plastic.path import State
from assess.plastic.pin_body import PinBody, reading
from assess.plastic.records import FlowField
from fea.core.voigt import von_mises
from geometry.mesh.hexahedra import twenty
from pinbase.arrays import Floats


def flow_field(made: PinBody, state: State, angle: float) -> FlowField:
    """Of a state in axes that are turned by an angle (rad) from the pin's."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return FlowField(
        points=made.mesh.nodes @ turn,
        cells=made.mesh.elements[:, twenty()],
        displacement=made.body.displacement(state.unknowns) @ turn,
        plastic_strain=np.maximum(_at_nodes(made, state.flow.equivalent), 0.0),
        von_mises=_at_nodes(made, von_mises(state.flow.stress)),
        factor=state.factor,
    )


def _at_nodes(made: PinBody, values: Floats) -> Floats:
    """(N,) means over the elements of what their values (M, 8) extrapolate to."""
    each = values @ reading(np.asarray(ElementHexS2().doflocs)).T
    numbers = made.mesh.elements.ravel()
    total = np.bincount(numbers, each.ravel(), minlength=len(made.mesh.nodes))
    return np.asarray(total / np.bincount(numbers, minlength=len(made.mesh.nodes)))
