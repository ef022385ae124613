"""The flexibility of rings, harmonic by harmonic: mean displacements of rings under pressure.

A pressure p cos n theta, uniform along a ring, displaces each ring by C_n p cos n theta on the
average over the ring. By Betti's theorem, C_n times the lengths of the rings is symmetric; it is
made exactly symmetric. Rigid motions are not part of the flexibility. The pin is held by a
statically determinate support, which has no reaction to balanced pressures. The lug is guided: it
is held by a reaction on its outer surface, of constant direction and linear along z, and
displacements are relative to the mean motion of that surface, taken with the same weight.

Pressures of harmonics beyond the last that is computed so have effects no deeper than about R / n.
Rings then respond to p(z) cos n theta like a half-space: the displacement is the convolution of p
with 2 (1 - nu^2) / (pi E) times the Bessel function K0(n z / R). For a long ring that is the
half-plane's u_n = 2 (1 - nu^2) R p_n / (E n). In a lug the response is mirrored at the faces, and
with a bushing it is that of a layer.

Sources: Johnson, Contact Mechanics, sec. 13.2 (a wavy pressure on a half-space); Nogi & Kato, J.
Tribol. 119 (1997) 493 (the layer).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.special import iti0k0, k1

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.core.tractions import ALONG_X, Traction
from fea.harmonic.assembly import Section, around
from fea.harmonic.boundary import Outline
from fea.harmonic.model import HarmonicBody, generalised, rigid_motions
from fea.support.lugs.lug import Lug
from geometry import Pin
from geometry.mesh.eye_mesh import eye_mesh
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.sizing import Grade
from pinbase.arrays import Ints

NO_SLOPE = np.zeros(3)
OUTWARDS = np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True)
class RingBody:
    """A body on one mesh with rings on its surface.

    rings: names of the rings.
    pushed: direction of the pressure on the rings: amplitudes along r, theta and z, (3,).
    guided: whether the body is held like a lug.
    """

    body: HarmonicBody
    rings: tuple[str, ...]
    pushed: Floats
    guided: bool = False

    @property
    def area(self) -> Floats:
        """The areas of the rings, (R,) m^2 per radian."""
        bands = [self.body.pin.band(name) for name in self.rings]
        return np.array([b.radius * b.length for b in bands])

    def forces(self, n: int) -> Floats:
        """The nodal forces (unknowns, R) of unit pressures of harmonic n on the rings."""
        return around(n) * self._unit_forces

    @cached_property
    def _unit_forces(self) -> Floats:
        """The nodal forces divided by `around`, which are the same for all harmonics."""
        unit = [(Traction(name, 0.0, self.pushed, NO_SLOPE),) for name in self.rings]
        return self.body.forces(0, unit) / around(0)

    def balanced(self, n: int, forces: Floats) -> Floats:
        """The forces of harmonic n, with the reaction that guides the body if it is a lug."""
        if self.guided and n == 1:
            return self.reacted(self.body.outline, self.body.pin.length, forces)
        return forces

    def reacted(self, outline: Outline, length: float, forces: Floats) -> Floats:
        """The forces of harmonic 1 (unknowns, K) with the reaction on the outer surface.

        The reaction has a constant direction and is linear along z.
        """
        reactions = [
            tuple(Traction(name, 0.5 * length, *parts) for name in self.body.pin.connections)
            for parts in ((ALONG_X, NO_SLOPE), (NO_SLOPE, ALONG_X))
        ]
        against = np.stack([generalised(outline.forces(one, 1)) for one in reactions], axis=1)
        modes = rigid_motions(outline.every_node, 1)
        return np.asarray(forces - against @ np.linalg.solve(modes.T @ against, modes.T @ forces))

    def flexibility(self, highest: int) -> Floats:
        """The flexibility C_n (highest + 1, R, R), m/Pa, positive in the direction of pressure."""
        out = []
        for n in range(highest + 1):
            forces = self.balanced(n, self.forces(n))
            out.append(self.body.work(n, forces) / around(n) / self.area[:, None])
        return np.stack(out)


def pin_rings(pin: Pin, rings: Sequence[str], material: Material, across: float) -> RingBody:
    """The rings of a pin, on a mesh."""
    size = SectionSize(across)
    mesh = meridian_mesh(pin, size, finer=_grades(pin, rings, size.growth))
    return RingBody(HarmonicBody(pin, Section(mesh), material, pivot=0.5), tuple(rings), -OUTWARDS)


def _grades(pin: Pin, rings: Sequence[str], growth: float) -> list[Grade]:
    """The mesh sizes at the ends of rings: elements there are at most half as long as the ring."""
    bands = (pin.band(name) for name in rings)
    return [Grade(((b.radius, b.z0), (b.radius, b.z1)), b.length / 2.0, 0.0, growth) for b in bands]


def lug_rings(eye: Pin, lug: Lug, across: float) -> RingBody:
    """The rings of a lug's bore, on a mesh."""
    rings = tuple(f"bore {name}" for name in eye.connections)
    bushing = lug.bushing
    if bushing is None:
        body = HarmonicBody(eye, Section(eye_mesh(eye, across)), lug.material, pivot=0.5)
    else:
        interface = eye.segments[0].bore / 2.0 + bushing.thickness
        mesh = eye_mesh(eye, across, interface)
        middles = mesh.nodes[mesh.elements[:, :3], 0].mean(axis=1)
        parts = (middles > interface).astype(np.int64)
        both = (bushing.material, lug.material)
        body = HarmonicBody(eye, Section(mesh, parts), both, pivot=0.5)
    return RingBody(body, rings, OUTWARDS, guided=True)


def half_plane(material: Material, radius: float) -> float:
    """The value n u_n / p_n of one body for high harmonics n, m/Pa."""
    return 2.0 * radius * material.plane_compliance


def wavy_flexibility(lug: Lug, pin: Material, radius: float, ends: Floats, waves: Ints) -> Floats:
    """The flexibility C_n (2, N, R, R), m/Pa, on a lug's rings for high harmonics.

    The first is that of the pin as a half-space, the second that of the lug with its two faces.
    ends: of the rings, (R + 1,) m along z.
    waves: the harmonics, (N,).
    """
    on, beyond = _responses(tuple((ends / radius).tolist()), tuple(waves.tolist()))
    n = waves[:, None, None]
    layer = np.array([layered(lug, k / radius) for k in waves.tolist()])[:, None, None]
    of_lug = half_plane(lug.bearing, radius) * layer * (on + beyond) / n
    return np.stack([half_plane(pin, radius) * on / n, of_lug])


@lru_cache(maxsize=4)
def _responses(ends: tuple[float, ...], waves: tuple[int, ...]) -> tuple[Floats, Floats]:
    """The responses of a half-space on rings, and the terms that the mirror images at the faces
    add, (N, R, R) each.

    ends: of the rings, divided by the radius. waves: the harmonics.
    """
    x = np.outer(waves, ends)
    beyond = _half_space(x, -x) + _half_space(x, 2.0 * x[:, -1:] - x)
    return _half_space(x, x), beyond


def _half_space(x: Floats, y: Floats) -> Floats:
    """The mean displacement of rings with ends x (N, R + 1) under pressure on rings with ends y, at
    wave number 1, divided by that of a half-plane, (N, R, R).
    """
    twice = _integral_of_k0(np.abs(x[:, :, None] - y[:, None]))
    both = twice[:, 1:, :-1] + twice[:, :-1, 1:] - twice[:, 1:, 1:] - twice[:, :-1, :-1]
    return np.asarray(np.abs(both) / (np.pi * np.diff(x)[:, :, None]))


def _integral_of_k0(x: Floats) -> Floats:
    """The integral from 0 to x of (x - t) K0(t)."""
    positive = np.maximum(x, 1e-300)
    return np.asarray(
        np.where(x > 0.0, x * iti0k0(positive)[1] - 1.0 + positive * k1(positive), 0.0)
    )


def layered(lug: Lug, waves: float) -> float:
    """The displacement of a lug with a bushing under a wavy pressure, divided by that of a
    half-plane of the bushing's material.

    waves: wave number, 2 pi / wavelength, 1/m.
    """
    if lug.bushing is None:
        return 1.0
    nu, below = lug.bearing.poisson_ratio, lug.material.poisson_ratio
    stiffer = lug.bearing.lame[1] / lug.material.lame[1]
    a = 1.0 - 4.0 * (1.0 - nu) / (1.0 + stiffer * (3.0 - 4.0 * below))
    b = (stiffer - 1.0) / (stiffer + 3.0 - 4.0 * nu)
    x = waves * lug.bushing.thickness
    e = math.exp(-2.0 * x)
    more, less = 1.0 + 4.0 * x * b * e, 1.0 - (a + b + 4.0 * b * x * x) * e
    return (more - a * b * e * e) / (less + a * b * e * e)
