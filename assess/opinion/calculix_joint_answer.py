"""CalculiX's results for a pin in its lugs, and how they are read."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from assess.opinion import calculix
from assess.opinion.calculix_joint_deck import JointDeck, slave
from assess.opinion.calculix_joint_mesh import natural_coordinates, trilinear
from fea.core.pin_loads import Floats
from fea.core.voigt import von_mises
from fea.cut.free_points import relieved
from geometry import Pin
from pinbase.arrays import Ints

ZERO_INCREMENT_MESSAGE = "zero-size increment is appended"
NEAREST_ELEMENTS = 12  # number of elements that are searched for a point


@dataclass(frozen=True)
class JointOpinion:
    """CalculiX's results in the pin's axes, SI.

    ends: (R, 2) ends along z of the rings of all bands in their order, m.
    force: (R, 2) forces of the lugs on the pin at each ring, N.
    first: (R, 2) moments of these forces about z = 0, the integrals of z times force, N m.
    nodes, elements, stress: (N, 3) m, (M, 20) and (N, 6) Pa of the pin, or of its half, in axes
    rotated about the pin's by `angle`, rad.
    edges: (K, 2), r and z of circles where the stress is unbounded, m.
    unknowns, iterations, seconds: of the run.
    appended: whether CalculiX found tension in the contact and appended an increment of zero load
    with a new contact search, which is less accurate.
    """

    ends: Floats
    force: Floats
    first: Floats
    nodes: Floats
    elements: Ints
    stress: Floats
    angle: float
    half: bool
    edges: Floats
    unknowns: int
    iterations: int
    seconds: float
    appended: bool = False

    @property
    def line_load(self) -> Floats:
        """The force per length of the lugs on the pin, averaged over each ring, (R, 2) N/m."""
        return self.force / np.diff(self.ends)

    def bending_moment(self, z: Floats) -> Floats:
        """Return the bending moment (Z, 2), N m, at z (Z,), m, of the part of the pin before z.

        The moment is the integral of the shear along x and along y. It is exact at the ends of a
        ring; within a ring the load is assumed even.
        """
        low, high = self.ends.T
        reach = np.clip(z[:, None] - low, 0.0, high - low)
        arm = reach * (z[:, None] - low - reach / 2.0)
        even = np.einsum("zr,ra->za", arm, self.line_load)
        off = self.force * self.ends.mean(axis=1)[:, None] - self.first
        return np.asarray(even + (z[:, None] >= high) @ off)

    def surface_at(self, point: Floats, nu: float) -> float:
        """Return the von Mises stress, Pa, at a point (3,), m, of the surface.

        On a ring, the local stress of the pressure is removed (fea.harmonic.free_surface).
        """
        x = self._turned(point[None])[0]
        stress = self._stress_at(x)
        on = (x[2] > self.ends[:, 0]) & (x[2] < self.ends[:, 1])
        if on.any():
            stress = relieved(stress[None, :, None], x[None], nu)[0, :, 0]
        return float(von_mises(stress))

    def von_mises_at(self, points: Floats) -> Floats:
        """Return the von Mises stress (P,), Pa, at points (P, 3), m, of the pin."""
        return von_mises(np.array([self._stress_at(x) for x in self._turned(points)]))

    def _turned(self, points: Floats) -> Floats:
        """Return points (P, 3) of the pin in the axes of the model, mirrored into its half."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        x = points @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        if self.half:
            x[:, 1] = np.abs(x[:, 1])
        return np.asarray(x)

    def largest(self, distance: float) -> float:
        """Return the largest nodal von Mises stress, Pa, farther than a distance, m, from edges."""
        r, z = np.hypot(self.nodes[:, 0], self.nodes[:, 1]), self.nodes[:, 2]
        away = np.hypot(r[:, None] - self.edges[:, 0], z[:, None] - self.edges[:, 1])
        return float(von_mises(self.stress[(away > distance).all(axis=1)]).max())

    def _stress_at(self, point: Floats) -> Floats:
        """Return the stress (6,), Pa, at a point, interpolated linearly from the corners of the
        element that contains the point or is nearest to it.
        """
        corners = self.nodes[self.elements[:, :8]]
        near = np.argsort(np.linalg.norm(corners.mean(axis=1) - point, axis=1))[:NEAREST_ELEMENTS]
        natural = [natural_coordinates(corners[e], point) for e in near]
        beyond = [float(np.abs(x).max()) for x in natural]
        best = int(np.argmin(beyond))
        shape, _ = trilinear(np.clip(natural[best], -1.0, 1.0))
        return np.asarray(shape @ self.stress[self.elements[near[best], :8]])


def read_answer(
    pin: Pin, deck: JointDeck, angle: float, folder: Path, printed: str, scale: float
) -> JointOpinion:
    """Return the results of a run; printed: its output. Other arguments as `deck_opinion`.

    Raises: CalculixError.
    """
    seconds = calculix.seconds_of(printed)
    mesh = deck.pin.mesh
    try:
        forces = contact_forces(folder / f"{calculix.JOB_NAME}.dat")
        stress = calculix.stresses(folder / f"{calculix.JOB_NAME}.frd")
        names = [slave(eye.part.name, k) for eye in deck.eyes for k in range(len(eye.rings))]
        ring_forces = np.array([forces[name] for name in names])
    except (OSError, ValueError, IndexError, KeyError, StopIteration) as error:
        raise calculix.CalculixError(
            f"{calculix.CALCULIX_COMMAND} wrote no readable results ({error})", "unreadable-results"
        ) from None
    if len(stress) != len(mesh.nodes) or not np.isfinite(ring_forces).all():
        raise calculix.CalculixError(
            f"{calculix.CALCULIX_COMMAND} did not write finite results for the whole pin",
            "missing-nodes",
        )
    c, s = np.cos(angle), np.sin(angle)
    back = np.array([[c, s], [-s, c]])
    ring_forces = ring_forces / scale
    force, first = ring_forces[:, :2], np.stack([ring_forces[:, 4], -ring_forces[:, 3]], axis=1)
    if deck.half:
        force, first = (2.0 * x * [1.0, 0.0] for x in (force, first))
    return JointOpinion(
        _ends(deck),
        force @ back,
        first @ back,
        mesh.nodes,
        mesh.elements,
        stress / scale,
        angle,
        deck.half,
        edges(pin),
        deck.unknowns,
        len(re.findall(r"^ iteration \d+", printed, re.MULTILINE)),
        seconds,
        ZERO_INCREMENT_MESSAGE in printed,
    )


def _ends(deck: JointDeck) -> Floats:
    z = deck.pin.mesh.nodes[deck.pin.mesh.elements[:, :8], 2]
    rings = [ring for eye in deck.eyes for ring in eye.rings]
    return np.array([(z[ring].min(), z[ring].max()) for ring in rings])


def edges(pin: Pin) -> Floats:
    """Return circles (K, 2), r and z, m: the edges of the lugs, and the shoulders of the pin
    outside and inside.
    """
    out = []
    for band in (pin.band(name) for name in pin.connections):
        out += [(band.radius, band.z0), (band.radius, band.z1)]
    for i, z in enumerate(pin.stations[1:-1]):
        one, other = pin.segments[i : i + 2]
        if one.diameter != other.diameter and not pin.fillet_at(i):
            out.append((min(one.diameter, other.diameter) / 2.0, z))
        if one.bore != other.bore:
            out.append((max(one.bore, other.bore) / 2.0, z))
    return np.array(out)


def contact_forces(dat: Path) -> dict[str, Floats]:
    """Return the contact force, N, and the moment about the origin, N m, on each slave surface,
    (6,) each, from a .dat file.
    """
    text, out = dat.read_text("ascii", "replace"), {}
    for block in text.split("statistics for slave set ")[1:]:
        _, numbers = block.split("(mx,my,mz)\n", 1)
        out[block.split(",")[0].strip()] = np.array(numbers.split()[:6], dtype=float)
    return out
