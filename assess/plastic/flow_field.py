"""The plastic flow of a pin at its limit load, at the nodes of its mesh."""

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


def flow_field(pin: PinBody, state: State, angle: float) -> FlowField:
    """The flow in a state, in the pin's axes.

    angle: rad, by which the state's axes are turned from them.
    """
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return FlowField(
        points=pin.mesh.nodes @ turn,
        cells=pin.mesh.elements[:, twenty()],
        displacement=pin.body.displacement(state.unknowns) @ turn,
        plastic_strain=np.maximum(_at_nodes(pin, state.flow.equivalent), 0.0),
        von_mises=_at_nodes(pin, von_mises(state.flow.stress)),
        factor=state.factor,
    )


def _at_nodes(pin: PinBody, values: Floats) -> Floats:
    """Nodal means (N,) of what the elements' values (M, 8) at quadrature points extrapolate to."""
    at_corners = values @ reading(np.asarray(ElementHexS2().doflocs)).T
    numbers = pin.mesh.elements.ravel()
    total = np.bincount(numbers, at_corners.ravel(), minlength=len(pin.mesh.nodes))
    return np.asarray(total / np.bincount(numbers, minlength=len(pin.mesh.nodes)))
