"""Properties of a round section, solid or hollow, with outer radius a and inner radius b.

Saint-Venant's flexure under a shear V along x has, everywhere in the section,

    s_rz =  V / (2 (1 + nu) I) k (a^2 + b^2 - a^2 b^2 / r^2 - r^2) cos theta
    s_tz = -V / (2 (1 + nu) I) (k (a^2 + b^2 + a^2 b^2 / r^2) - (1 - 2 nu) r^2 / 4) sin theta

with k = (3 + 2 nu) / 4. For b = 0 these are the (3 + 2 nu) / (2 (1 + nu)) V / A on the axis and the
(1 + 2 nu) / (1 + nu) V / A at the ends of the neutral axis of the textbooks.

Sources: A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity, ch. XV (flexure of a
hollow cylinder); G. R. Cowper, J. Appl. Mech. 33 (1966) 335, for the shear coefficients.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeVar

from geometry import Segment
from pinbase.arrays import Floats

Radius = TypeVar("Radius", float, Floats)


@dataclass(frozen=True)
class Circle:
    """A round section with radii in m; inner is 0 for a solid one."""

    outer: float
    inner: float = 0.0

    @property
    def area(self) -> float:
        """The area, m^2."""
        return math.pi * (self.outer**2 - self.inner**2)

    @property
    def inertia(self) -> float:
        """The second moment of area about a diameter, m^4."""
        return math.pi / 4.0 * (self.outer**4 - self.inner**4)

    @property
    def polar(self) -> float:
        """The second moment of area about the axis, m^4."""
        return 2.0 * self.inertia

    @property
    def modulus(self) -> float:
        """The elastic section modulus, m^3."""
        return self.inertia / self.outer

    @property
    def plastic_modulus(self) -> float:
        """The plastic section modulus, m^3: twice the first moment of half of the section.

        It exceeds the elastic one by the factor 16 / (3 pi) (1 - q^3) / (1 - q^4), with q = inner /
        outer.

        Source: S. P. Timoshenko, Strength of Materials II, plastic bending.
        """
        return 4.0 / 3.0 * (self.outer**3 - self.inner**3)

    def shear_coefficient(self, nu: float) -> float:
        """Timoshenko's shear coefficient under a static end load, no unit.

        It is 6 (1 + nu) / (7 + 6 nu) for a solid section.

        Source: Cowper, as the module.
        """
        m2 = (self.inner / self.outer) ** 2
        whole = (1.0 + m2) ** 2
        return 6.0 * (1.0 + nu) * whole / ((7.0 + 6.0 * nu) * whole + (20.0 + 12.0 * nu) * m2)

    def flexure(self, r: Radius, nu: float) -> tuple[Radius, Radius]:
        """The amplitudes of s_rz (cos theta) and s_tz (sin theta) at r (m), Pa per N of shear along
        x.

        Source: Love, as the module.
        """
        a2, b2 = self.outer**2, self.inner**2
        ring = a2 * b2 / r**2 if b2 else 0.0 * r
        k, factor = (3.0 + 2.0 * nu) / 4.0, 1.0 / (2.0 * (1.0 + nu) * self.inertia)
        rz = factor * k * (a2 + b2 - ring - r**2)
        tz = -factor * (k * (a2 + b2 + ring) - (1.0 - 2.0 * nu) * r**2 / 4.0)
        return rz, tz

    @property
    def vq_it(self) -> float:
        """The factor V Q / (I t) over V / A at the neutral axis, no unit: 4 / 3 if solid, 2 for a
        thin tube.

        Source: Budynas & Nisbett, Shigley's Mechanical Engineering Design, 3-11.
        """
        a, b = self.outer, self.inner
        return 4.0 / 3.0 * (a * a + a * b + b * b) / (a * a + b * b)

    @property
    def axis_area(self) -> float:
        """The shear force V over the shear stress at the neutral axis, I t / Q, m^2."""
        return self.area / self.vq_it


def circle(segment: Segment) -> Circle:
    """The section of a segment without cones."""
    return Circle(segment.diameter / 2.0, segment.bore / 2.0)


def thinnest_section(segment: Segment, start: float, end: float) -> Circle:
    """The thinnest section between start and end, m from the segment's start."""
    (b0, r0), (b1, r1) = segment.radii(start), segment.radii(end)
    return Circle(min(r0, r1), max(b0, b1))
