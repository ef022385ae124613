"""The von Mises stress of a pin on foundations, from section forces, at points of its sections.

Points nearer to sharp corners than the excluded distance are left out, as in other models.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fea.beam.error_model import NOTCH_ERROR
from fea.beam.maximum import VonMisesMaxima, von_mises_maxima
from fea.beam.round_section import circle
from fea.beam.stress import TZ, ZZ, notch_stress, section_stress
from fea.beam.stress_concentration import Notch, notches
from fea.beam.timoshenko import AXIAL, MOMENT
from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats
from fea.core.zone import Zone
from fea.singular.singularities import find_singularities, outside
from fea.support.foundation.foundation_model import FoundationModel, JointFoundation
from geometry import Pin

SHOULDER_REACH = 0.5  # distance, in diameters, up to which a sharp shoulder affects the stress
# Distance, in diameters, below which a fillet also has the stress of a lug's edge. At the edge it
# reaches up to 3 times the upper bound; at 0.1, 1 of 9 pins exceeds the bound; from 0.2 on none of
# 30 does.
MIN_FILLET_EDGE_DISTANCE = 0.15
NEGLIGIBLE_STRESS_SHARE = 1e-6  # of the largest
PRESSED_SHOULDER = "a shoulder whose face a force along the axis presses"
# Axial force over area, relative to the largest stress, above which a pressed shoulder counts. The
# fillet of a pressed head has about ten times that stress.
PRESSED_SHOULDER_SHARE = 1e-3
POINTS_PER_RADIUS = 17  # points along a segment at one radius, in addition to the ends of rings


@dataclass(frozen=True)
class FoundationStress:
    """The stress of a pin on foundations per section force, which serves all loads.

    r, z: of the points, (S,) m.
    per_force: amplitudes of the stress at the points per V, M, N, T, (S, 6, 4).
    near: relative error that notches and sharp shoulders add at the points, (S,).
    notches: the notches that are not excluded; their points come last.
    """

    model: FoundationModel
    r: Floats
    z: Floats
    per_force: Floats
    near: Floats
    notches: tuple[Notch, ...]

    @classmethod
    def of(cls, model: FoundationModel, distance: float = 0.1) -> Self:
        """The stress per section force of a pin on foundations.

        distance: excluded at sharp corners, as a fraction of the local diameter.

        Raises: SolveError where no part of the surface is outside the excluded distance.
        """
        pin, nu = model.whole, model.material.poisson_ratio
        corners = find_singularities(pin, (), (), nu, distance)
        every = notches(pin)
        shaft = list(_shaft(pin, np.array(model.pin.stations), nu))
        local = [_at(pin, notch, nu) for notch in every]
        r, z, per_force = (np.concatenate(parts) for parts in zip(*shaft, *local, strict=True))
        near = _near(corners, r, z)
        near[len(r) - len(local) :] = NOTCH_ERROR
        keep = outside(corners, r, z)
        if not (r[keep] > 0.0).any():
            raise SolveError(
                "its sharp corners are so close together that no surface is left to read",
                "beyond-foundations",
            )
        free = keep[len(r) - len(local) :]
        left = tuple(n for n, out in zip(every, free, strict=True) if out)
        return cls(model, r[keep], z[keep], per_force[keep], near[keep], left)

    @cached_property
    def on_surface(self) -> FoundationStress:
        """The stress without the points on the axis."""
        out = self.r > 0.0
        return replace(
            self, r=self.r[out], z=self.z[out], per_force=self.per_force[out], near=self.near[out]
        )

    @property
    def bending(self) -> Floats:
        """The axial stress per bending moment at the points, (S,) 1/m^3."""
        return np.abs(self.per_force[:, ZZ, MOMENT])

    def von_mises(self, joint: JointFoundation) -> VonMisesMaxima:
        """The von Mises stress at all points and instants, the largest over the circumference."""
        return von_mises_maxima(self.harmonics(joint))

    def lacking(self, joint: JointFoundation, von_mises: Floats) -> list[str]:
        """The notches under load, and pressed shoulders, without a valid notch factor, in words.

        von_mises: at the points and instants, (S, T) Pa.
        """
        first = len(self.z) - len(self.notches)
        torque = np.abs(joint.along(self.z[first:])[1]).max(axis=0)
        turned = torque > NEGLIGIBLE_STRESS_SHARE * np.abs(joint.loads.moments).max(initial=0.0)
        reached = von_mises[first:].max(axis=1) > NEGLIGIBLE_STRESS_SHARE * von_mises.max()
        pin, edges = self.model.whole, _edges(self.model)
        seats = [k for k, name in enumerate(joint.loads.surfaces) if joint.pin.shoulder(name)]
        push = np.abs(joint.loads.forces[:, seats, 2]).max(initial=0.0)
        area = min(circle(segment).area for segment in pin.segments)
        pressed = push > PRESSED_SHOULDER_SHARE * von_mises.max() * area
        return [PRESSED_SHOULDER] * bool(pressed) + [
            f"{n.why}, nearer than {MIN_FILLET_EDGE_DISTANCE:g} diameters to the edge of a lug"
            if beside
            else n.why
            for n, t, any_ in zip(self.notches, turned, reached, strict=True)
            if (
                beside := any_
                and _distance(pin, n, edges)
                < MIN_FILLET_EDGE_DISTANCE * pin.segments[n.on].diameter
            )
            or (any_ and n.bending is None)
            or (t and n.torsion is None)
        ]

    def harmonics(self, joint: JointFoundation) -> Floats:
        """The stress, (3, S, 6, T): the part that is constant around the axis, the factor of cos
        theta, and the factor of sin theta (fea.beam.maximum).
        """
        across = np.stack([-joint.shear_force(self.z), joint.bending_moment(self.z)], axis=-1)
        first, second = np.einsum("siq,tsaq->asit", self.per_force[:, :, :AXIAL], across)
        rest = -np.stack(joint.along(self.z), axis=-1)
        even = np.einsum("siq,tsq->sit", self.per_force[:, :, AXIAL:], rest)
        even[:, TZ] *= -1.0
        cosine, sine = first.copy(), second.copy()
        cosine[:, TZ], sine[:, TZ] = -second[:, TZ], first[:, TZ]
        return np.stack([even, cosine, sine])


Points = tuple[Floats, Floats, Floats]  # r, z and per_force


def _shaft(pin: Pin, cuts: Floats, nu: float) -> Iterator[Points]:
    """Yield the points along every segment, at its surface and at its bore or axis."""
    for (a, b), segment in zip(pairwise(pin.stations), pin.segments, strict=True):
        z = np.union1d(np.linspace(a, b, POINTS_PER_RADIUS), cuts[(cuts >= a) & (cuts <= b)])
        for r in (segment.diameter / 2.0, segment.bore / 2.0):
            amplitudes = section_stress(circle(segment), r, nu)
            yield np.full(len(z), r), z, np.broadcast_to(amplitudes, (len(z), 6, 4))


def _at(pin: Pin, notch: Notch, nu: float) -> Points:
    section = circle(pin.segments[notch.on])
    stress = notch_stress(notch, section, nu)
    return np.array([section.outer]), np.array([notch.z]), stress[None]


def _edges(model: FoundationModel) -> Floats:
    """The z of the edges of all lugs, m."""
    bands = [model.whole.band(lug.connection) for lug in model.lugs]
    return np.array([z for band in bands for z in (band.z0, band.z1)])


def _distance(pin: Pin, notch: Notch, edges: Floats) -> float:
    """The distance of a shoulder's fillet from the nearest edge, m; zero for an edge within it."""
    corner = min(pin.stations, key=lambda z: abs(z - notch.z))
    radius = pin.fillet_at(pin.stations.index(corner) - 1)
    ends = corner, corner + math.copysign(radius, notch.z - corner)
    away = np.maximum(np.maximum(min(ends) - edges, edges - max(ends)), 0.0)
    return float(away.min())


def _near(corners: tuple[Zone, ...], r: Floats, z: Floats) -> NDArray[np.float64]:
    out = np.zeros(len(r))
    for corner in corners:
        out[np.hypot(r - corner.r, z - corner.z) <= 2.0 * SHOULDER_REACH * corner.r] = NOTCH_ERROR
    return out
