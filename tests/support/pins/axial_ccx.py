"""CalculiX's contact of a headed pin in a clevis whose ears also push its heads apart.

The mesh, lugs and contact are those of assess.opinion.calculix_joint; the axial forces are a
pressure on the faces of the heads, as large as the flat part beyond their fillets.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from assess.opinion.calculix_deck import real
from assess.opinion.calculix_joint import deck_opinion, joint_deck
from assess.opinion.calculix_joint_answer import JointOpinion
from assess.opinion.calculix_joint_deck import JointDeck
from assess.opinion.calculix_joint_mesh import Fineness
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.axial import axial_seats
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from pinbase.arrays import Ints

STEEL, D, FILLET, HEAD = Material("steel", 210e9, 0.3), 0.02, 0.0015, 0.032
FORCE, PULL = 50e3, 30e3
PIN = Pin(
    "H",
    (
        Segment(0.008, HEAD, fillet=FILLET),
        Segment(0.0115, D, connection="L"),
        Segment(0.001, D),
        Segment(0.020, D, connection="M"),
        Segment(0.001, D),
        Segment(0.0115, D, connection="R", fillet=FILLET),
        Segment(0.008, HEAD),
    ),
)
START_FACE, END_FACE = 1, 2  # of an element, across the axis


@dataclass(frozen=True)
class Pressed(JointDeck):
    """A joint whose pin also has pressure on faces of elements.

    pressed: elements of the pin, the number of their face, and the pressure, Pa.
    """

    pressed: tuple[tuple[Ints, int, float], ...] = ()

    def _step(self, fraction: float) -> Iterator[str]:
        for line in super()._step(fraction):
            if line == "*CLOAD":
                yield "*DLOAD"
                for elements, face, pressure in self.pressed:
                    yield from (f"{1 + e}, P{face}, {real(fraction * pressure)}" for e in elements)
            yield line


def problem(pull: float) -> tuple[tuple[Lug, ...], PinLoads]:
    """Return the lugs, and the forces at one instant.

    pull: axial force of the ears, N
    """
    forces = np.zeros((1, 3, 3))
    forces[0, :, 0] = -FORCE / 2, FORCE, -FORCE / 2
    forces[0, :, 2] = -pull, 0.0, pull
    lugs = tuple(
        Lug(c, 0.05, STEEL, 2e-5, tilt=210e9 * 0.05 * PIN.band(c).length ** 3 / (12 * 0.04))
        for c in PIN.connections
    )
    seats = axial_seats(PIN, lugs) if pull else {}
    return lugs, PinLoads("axial", PIN.connections, forces, np.zeros((1, 3, 3)), seats=seats)


def opinion(pull: float, fineness: Fineness) -> JointOpinion:
    """Return CalculiX's results for a pull of the ears, N."""
    lugs, loads = problem(pull)
    deck, angle = deck_of(lugs, loads, fineness)
    return deck_opinion(PIN, deck, angle, fineness.scale)


def deck_of(lugs: tuple[Lug, ...], loads: PinLoads, fineness: Fineness) -> tuple[Pressed, float]:
    across = replace(loads, forces=loads.forces * [1.0, 1.0, 0.0], seats={})
    deck, angle = joint_deck(PIN, STEEL, lugs, across, fineness)
    mesh, flat = deck.pin.mesh, D / 2.0 + FILLET
    z = mesh.nodes[mesh.elements[:, :8], 2]
    area = np.pi * ((HEAD / 2.0) ** 2 - flat**2)
    pressed = []
    for face, ends, at in (
        (END_FACE, z.max(axis=1), PIN.stations[1]),
        (START_FACE, z.min(axis=1), PIN.stations[-2]),
    ):
        on_face = (mesh.inner > flat - 1e-6) & (np.abs(ends - at) < 1e-9)
        pull = float(np.abs(loads.forces[..., 2]).max()) * fineness.scale
        pressed.append((np.flatnonzero(on_face), face, pull / area))
    own = {f.name: getattr(deck, f.name) for f in fields(JointDeck)}
    return Pressed(**own, pressed=tuple(pressed)), angle
