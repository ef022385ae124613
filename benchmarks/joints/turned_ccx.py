"""Contact in three dimensions by CalculiX of pins that are not plain cylinders: with a groove, with
flanks of 45 degrees and rounded corners, in each gap of a clevis; with a bore; with interference.

The mesh is that of assess.opinion.calculix_joint for a plain pin, with layers at the stations of
the groove. Its nodes are moved inwards to the outline, which is written here, and closer to the
surface.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from assess.opinion.calculix_joint import deck_opinion, joint_deck
from assess.opinion.calculix_joint_answer import JointOpinion
from assess.opinion.calculix_joint_mesh import Fineness
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from pinbase.arrays import Floats

LAYERS = 3  # pairs of layers of elements along each rounded corner
FLAT = 2  # pairs of layers along half of the floor
DENSER = 0.6  # elements at the surface, or the bore, are 1 - DENSER times as thick as even ones
LITTLE = 1e-9  # of a radius


@dataclass(frozen=True)
class Groove:
    """A groove in a shaft; lengths in m.

    diameter: of the shaft.
    floor: length of the floor between the rounded corners.
    radius: of the corners.
    rim: length of the shaft on either side.
    """

    diameter: float
    depth: float
    floor: float
    radius: float
    rim: float

    @property
    def segments(self) -> tuple[Segment, ...]:
        """The segments of a pin's profile."""
        d, inner = self.diameter, self.diameter - 2.0 * self.depth
        return (
            Segment(self.rim, d, fillet=0.0),
            Segment(self.depth, d, end_diameter=inner, fillet=self.radius),
            Segment(self.floor, inner, fillet=self.radius),
            Segment(self.depth, inner, end_diameter=d, fillet=0.0),
            Segment(self.rim, d, fillet=0.0),
        )

    @property
    def length(self) -> float:
        return 2.0 * (self.rim + self.depth) + self.floor

    def radius_at(self, z: Floats) -> Floats:
        """Return the radius of the outline, m, at z, m, from the start of the groove."""
        off = np.abs(z - 0.5 * self.length)  # from the middle of the floor
        tangent = self.radius * math.tan(math.pi / 8.0)
        start = 0.5 * self.floor - tangent
        within = np.clip(off - start, 0.0, self.radius * math.sin(math.pi / 4.0))
        round_ = self.radius - np.sqrt(self.radius**2 - within**2)
        flank = np.maximum(off - start - self.radius * math.sin(math.pi / 4.0), 0.0)
        floor = 0.5 * self.diameter - self.depth
        return np.asarray(np.minimum(floor + round_ + flank, 0.5 * self.diameter))

    def stations(self) -> Floats:
        """Return the z of the nodes, m, from the start of the groove: ends of layers, with a
        mid-node between any two.
        """
        start = 0.5 * self.floor - self.radius * math.tan(math.pi / 8.0)
        turn = np.linspace(0.0, math.pi / 4.0, LAYERS + 1)
        arc = start + self.radius * np.sin(turn)
        end = 0.5 * self.length
        edge = end - self.rim
        flank, rim = np.linspace(arc[-1], edge, 3)[1:], np.linspace(edge, end, 3)[1:]
        half = np.concatenate([np.linspace(0.0, start, FLAT + 1)[1:], arc[1:], flank, rim])
        return np.asarray(end + np.concatenate([-half[::-1], [0.0], half]))


def turned_opinion(
    pin: Pin,
    grooves: Sequence[tuple[float, Groove]],
    material: Material,
    lugs: Sequence[Lug],
    loads: PinLoads,
    fineness: Fineness,
    denser: float = DENSER,
) -> JointOpinion:
    """Return CalculiX's result for a turned pin.

    pin: without its grooves.
    grooves: each with the z of its start, m.
    denser: refinement at the surface, or if negative at the bore.
    Raises: as assess.opinion.calculix_joint.joint_opinion.
    """
    cuts = [z for z0, groove in grooves for z in z0 + groove.stations()]
    plain = _cut(pin, np.array(cuts))
    along = replace(fineness, along=1e-3 if cuts else fineness.along)
    deck, angle = joint_deck(plain, material, lugs, loads, along)
    mesh = deck.pin.mesh
    moved = replace(mesh, nodes=_moved(mesh.nodes, pin, grooves, denser))
    deck = replace(deck, pin=replace(deck.pin, mesh=moved))
    return deck_opinion(plain, deck, angle, fineness.scale)


def _moved(
    nodes: Floats, pin: Pin, grooves: Sequence[tuple[float, Groove]], denser: float
) -> Floats:
    """Return the moved nodes of a pin with one diameter and one bore."""
    x, shaft = nodes.copy(), pin.segments[0]
    r, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
    bore, full = 0.5 * shaft.bore, 0.5 * shaft.diameter
    outer = np.full(len(x), full)
    for z0, groove in grooves:
        on = (z > z0) & (z < z0 + groove.length)
        outer[on] = groove.radius_at(z[on] - z0)
    s = (r - bore) / (full - bore)
    s *= 1.0 + denser * (1.0 - s)
    x[:, :2] *= ((bore + s * (outer - bore)) / np.maximum(r, LITTLE * full))[:, None]
    return x


def _cut(pin: Pin, at: Floats) -> Pin:
    """Return a pin whose segments without lugs are divided at the given z."""
    out: list[Segment] = []
    for segment, start in zip(pin.segments, pin.stations, strict=False):
        inside = at[(at > start + 1e-9) & (at < start + segment.length - 1e-9)]
        if segment.connection or not len(inside):
            out.append(segment)
            continue
        ends = np.concatenate([[start], np.unique(inside.round(12)), [start + segment.length]])
        out += [replace(segment, length=float(x)) for x in np.diff(ends)]
    return replace(pin, segments=tuple(out))
