"""Plastic hinges and slip of a pin as a beam: bounds of the load factor at every instant.

Static theorem (lower bound): internal forces that are in equilibrium, here the elastic ones, and
that every section can carry,

    g(M/Mp, N/Np)^2 + (V/Vs + T/Tp)^2 <= 1.

g is the utilisation of the interaction curve of bending with an axial force
(fea.beam.plastic_interaction). In torsion the shear stress is the same everywhere, with Tp the
plastic torque. The shear stress of V is s_tz = -C sin theta, a field in equilibrium with elastic
bending; its largest value is V Q / (I t) at the neutral axis (the resisting area is 3/4 A in a
solid bar and half of A in a thin tube). The sum of both stresses is therefore nowhere exceeded. It
leaves sqrt(1 - (V/Vs + T/Tp)^2) of the yield stress for bending and the axial force.

Kinematic theorem (upper bound): the least ratio, among mechanisms, of the work of flow to the power
of the loads. Slip of a section takes Vp = A s_y / sqrt 3, twist takes Tp. To slip apart along a
plane with slope t against the section takes Vp (t + 1 / t), which is 2 Vp = 1.155 Np where there is
room for a slope of one. A hinge bends and stretches along the curve g. If it also twists, it takes
at most s_y sqrt(A (A e^2 + I k^2 + J t^2 / 3)) per length (by Schwarz's inequality, for a stretch
e, a curvature k and a twist t). One hinge is enough where one side of a span is free. Where both
sides are clamped, three hinges are needed, which only bend. Next to a clamp or a shoulder the
section cannot warp and contract: a hinge is at least MIN_HINGE_DISTANCE away from it, where the
solid has it too. Closer sections slip and twist.

Both theorems are applied to beams. The solid differs within a diameter of loads and clamps, so a
bound decides only if it is beyond 1 by more than HINGE_ERROR.

Source: B. G. Neal, The Plastic Methods of Structural Analysis (1977), chapters 2, 3 and 6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fea.beam.line_load import acting, shares
from fea.beam.plastic_interaction import bending_and_axial_use, plastic_torque
from fea.beam.round_section import Circle
from fea.beam.timoshenko import AXIAL, MOMENT, SHEAR, TORQUE, InternalForces, Span, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import Loads
from geometry import Pin
from pinbase.arrays import Floats, Mask

# Distance, in diameters, between a clamp and the nearest hinge, as in the solid.
MIN_HINGE_DISTANCE = 0.75
# Allowance on the load factor, checked against solids of the landing gear (docs/past-yield.md).
HINGE_ERROR = 0.15
SECTIONS_PER_CELL = 101  # sections that are checked in each cell of the beam


@dataclass(frozen=True)
class BeamBounds:
    """Bounds of the load factor at every instant, (T,); infinite where no load acts.

    slip: the upper bound by slip alone. It also holds for the solid, because the slipping parts are
    rigid.
    """

    lower: Floats
    upper: Floats
    slip: Floats

    @property
    def governing(self) -> int:
        """The number of the instant with the smallest lower bound."""
        return int(self.lower.argmin())


def beam_bounds(pin: Pin, material: Material, clamps: tuple[str, ...], loads: Loads) -> BeamBounds:
    """Return the bounds of the load factor of a pin, by both theorems for beams.

    The lower bound uses the yield strength, which the material must have; the upper bound uses the
    last hardening stress, if there is one.
    """
    units = acting(loads)
    first = material.yield_strength
    assert first is not None
    last = material.hardening[-1][1] if material.hardening else first
    lower, upper, slip = np.full((3, len(loads)), np.inf)
    if not units:
        return BeamBounds(lower, upper, slip)
    forces = stepped_beam(pin, material, units, clamps)
    amounts = shares(units, loads)
    for span in forces.spans:
        z, sections, inside = _sampled(forces, span, amounts)
        strong = _strengths(sections)
        across = np.linalg.norm(inside, axis=1) / strong  # (T, S, 4)
        most, least = _bending_and_axial(sections, across)
        lower = np.minimum(lower, first * _static(sections, across, most))
        slip = np.minimum(slip, last * _slip(span, strong, inside))
        room = _room(span, sections, z)
        if span.left and span.right:
            away = room >= 2.0 * MIN_HINGE_DISTANCE
            power = _three_hinges(z, away, strong[:, MOMENT], inside[..., MOMENT])
        else:
            power = _one_mechanism(room, across, least)
        upper = np.minimum(upper, last * _inverse(power))
    return BeamBounds(lower, np.minimum(upper, slip), slip)


def _sampled(
    forces: InternalForces, span: Span, amounts: Floats
) -> tuple[Floats, list[Circle], Floats]:
    """Return z (S,), m, the sections (S), and V, M, N, T there by phase, (T, 2, S, 4)."""
    cells = np.repeat(np.arange(span.first, span.last), SECTIONS_PER_CELL)
    part = np.tile(np.linspace(0.0, 1.0, SECTIONS_PER_CELL), span.last - span.first)
    z = forces.stations[cells] + part * np.diff(forces.stations)[cells]
    inside = np.einsum("sqk,tpk->tpsq", forces.inside(cells, z), amounts)
    return z, [forces.sections[c] for c in cells], inside


def _strengths(sections: list[Circle]) -> Floats:
    """Return Vp, Mp, Np and Tp of the sections per Pa of yield stress, (S, 4)."""
    return np.array(
        [(s.area / math.sqrt(3.0), s.plastic_modulus, s.area, _torque(s)) for s in sections]
    ).reshape(-1, 4)


def _torque(section: Circle) -> float:
    """Return the plastic torque per Pa of yield stress, m^3."""
    return plastic_torque(section) / math.sqrt(3.0)


def _bending_and_axial(sections: list[Circle], across: Floats) -> tuple[Floats, Floats]:
    """Return an upper and a lower estimate of the utilisation of the sections by bending and axial
    force, (T, S) each.

    The lower estimate includes torsion: the work of flow is at most that by the root mean square of
    its strain.
    """
    most, least = np.empty((2, *across.shape[:2]))
    for section in set(sections):
        same = np.array([s == section for s in sections])
        moment, axial = across[:, same, MOMENT], across[:, same, AXIAL]
        most[:, same], least[:, same] = bending_and_axial_use(section, moment, axial)
    # Mean square of the strain of bending, stretching and twisting: M, N and T weigh with these
    # factors.
    squares = np.array(
        [
            (
                s.plastic_modulus**2 / (s.area * s.inertia),
                1.0,
                _torque(s) ** 2 * 3.0 / (s.area * s.polar),
            )
            for s in sections
        ]
    )
    together = np.sqrt((across[..., [MOMENT, AXIAL, TORQUE]] ** 2 * squares).sum(axis=2))
    return most, np.maximum(least, together)


def _static(sections: list[Circle], across: Floats, bent: Floats) -> Floats:
    """Return the lower bounds (T,) per Pa of yield stress.

    across: (T, S, 4) V, M, N and T over the plastic strengths.
    bent: (T, S) utilisation by bending and axial force.
    """
    peak = np.array([s.vq_it for s in sections])
    sheared = across[..., SHEAR] * peak + across[..., TORQUE]
    return _inverse(np.hypot(bent, sheared).max(axis=1))


def _slip(span: Span, strong: Floats, inside: Floats) -> Floats:
    """Return the upper bounds (T,) by slip, per Pa of yield stress.

    One section slips or, in a span clamped at both ends, the part between two sections. For the
    latter only the ends of cells need be tried.
    """
    if not (span.left and span.right):
        return _inverse((np.linalg.norm(inside, axis=1) / strong)[..., SHEAR].max(axis=1))
    ends = np.arange(len(strong)) % SECTIONS_PER_CELL % (SECTIONS_PER_CELL - 1) == 0
    shear, most = inside[:, :, ends, SHEAR], strong[ends, SHEAR]
    jump = shear[:, :, :, None] - shear[:, :, None, :]
    power = np.linalg.norm(jump, axis=1) / (most[:, None] + most)
    return _inverse(power.max(axis=(1, 2)))


def _one_mechanism(room: Floats, across: Floats, bent: Floats) -> Floats:
    """Return the largest ratio of power to work (T,) of one section that twists, slips apart or is
    a hinge.

    room: (S,) as in `_room`.
    across: (T, S, 4) V, M, N and T over the plastic strengths.
    bent: (T, S) ratio of a hinge.
    """
    steep = np.minimum(room, 1.0)  # of a plane that ends before clamps and thicker sections
    apart = math.sqrt(3.0) * steep / (1.0 + steep**2) * across[..., AXIAL]
    hinge = np.where(room >= 2.0 * MIN_HINGE_DISTANCE, bent, 0.0)
    return np.asarray(np.maximum(np.maximum(across[..., TORQUE], apart), hinge).max(axis=1))


def _room(span: Span, sections: list[Circle], z: Floats) -> Floats:
    """Return the distance (S,) from clamps and thicker sections, divided by the outer radius."""
    outer, inner = np.array([(s.outer, s.inner) for s in sections]).T
    more = (outer > (1.0 + 1e-9) * outer[:, None]) | (inner < (1.0 - 1e-9) * inner[:, None])
    room = np.where(more, np.abs(z - z[:, None]), np.inf).min(axis=1)
    if span.left:
        room = np.minimum(room, z - z[0])
    if span.right:
        room = np.minimum(room, z[-1] - z)
    return np.asarray(room / outer)


def _three_hinges(z: Floats, away: Mask, strong: Floats, moment: Floats) -> Floats:
    """Return the largest ratio of power to work (T,) of three hinges: one near each end of a span,
    and one between them.

    z: (S,) m.
    away: (S,) mask of the sections where a hinge is allowed.
    strong: (S,) plastic moments per Pa of yield stress.
    moment: (T, 2, S) bending moments by phase.
    """
    places = np.flatnonzero(away)
    if len(places) < 3:
        return np.zeros(len(moment))
    a, b = places[0], places[-1]
    middle = places[1:-1]
    middle = middle[(z[middle] > z[a]) & (z[middle] < z[b])]
    right = (z[middle] - z[a]) / (z[b] - z[middle])
    power = moment[..., middle] * (1.0 + right) - moment[..., [a]] - moment[..., [b]] * right
    work = strong[middle] * (1.0 + right) + strong[a] + strong[b] * right
    return np.asarray((np.linalg.norm(power, axis=1) / work).max(axis=1, initial=0.0))


def _inverse(used: Floats) -> Floats:
    return np.divide(1.0, used, out=np.full_like(used, np.inf), where=used > 0.0)
