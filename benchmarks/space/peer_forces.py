"""Forces and moments in the joints of a machine, by our code and by others."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pinbase.arrays import Floats


@dataclass(frozen=True)
class PeerForces:
    """The wrenches in C joints and the forces of D drives at T instants.

    points: (T, C, 3), of the moving body at each joint, m.
    forces, moments: (T, C, 3), N and N m, of the moving body on the base, about this point, in
    world axes, without the forces of the drives.
    drives: (T, D), N or N m, positive where they increase the coordinate.
    """

    points: Floats
    forces: Floats
    moments: Floats
    drives: Floats

    @classmethod
    def fields(cls) -> tuple[str, ...]:
        """Return the names of the quantities."""
        return tuple(field.name for field in fields(cls))

    def every(self, step: int) -> PeerForces:
        """Return the values at every `step`-th instant, the last included."""
        return PeerForces(*(getattr(self, name)[step - 1 :: step] for name in self.fields()))

    def difference(self, reference: PeerForces) -> float:
        """Return the largest difference of all quantities, relative to the largest value of their
        kind.
        """
        return max(
            float(np.abs(getattr(self, name) - getattr(reference, name)).max())
            / float(np.abs(getattr(reference, name)).max())
            for name in self.fields()
        )
