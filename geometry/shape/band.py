"""Surfaces of a pin on which links bear, the names of faces, and the error of impossible pins."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pinbase.errors import CodedError

END_FACES = ("start", "end")
SHOULDER = "shoulder "  # a shoulder's face has this name and the number of the segment before it


class GeometryError(CodedError, ValueError):
    """The pin as described is impossible; the message says why and what would be right."""


@dataclass(frozen=True)
class Band:
    """The outer surface of a segment between its fillets.

    z0, z1: axial positions of its ends, m.
    radius: m; for a cone, on which no link can bear, the mean radius.
    """

    name: str
    z0: float
    z1: float
    radius: float

    @property
    def length(self) -> float:
        """Axial length, m."""
        return self.z1 - self.z0

    @property
    def area(self) -> float:
        """Exact area, m^2."""
        return 2.0 * math.pi * self.radius * self.length

    @property
    def middle(self) -> float:
        """Position z of the middle, m."""
        return 0.5 * (self.z0 + self.z1)
