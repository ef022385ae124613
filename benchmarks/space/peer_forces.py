"""Forces and moments in the joints of a machine, as ours and as the peers give them."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pinbase.arrays import Floats


@dataclass(frozen=True)
class PeerForces:
    """Wrenches in C joints and forces of D drives at T instants.

    points: (T, C, 3) m, of the moving body at each joint.
    forces, moments: (T, C, 3) N and N m, of the moving body on the base, about that point, in world
    axes, without what the drives exert.
    drives: (T, D) N or N m, positive where they increase the coordinate.
    """

    points: Floats
    forces: Floats
    moments: Floats
    drives: Floats

    @classmethod
    def fields(cls) -> tuple[str, ...]:
        """Names of the quantities."""
        return tuple(field.name for field in fields(cls))

    def every(self, step: int) -> PeerForces:
        """Those at every so many of the instants, with the last."""
        return PeerForces(*(getattr(self, name)[step - 1 :: step] for name in self.fields()))

    def difference(self, reference: PeerForces) -> float:
        """The largest difference of all quantities, relative to the largest of their kind."""
        return max(
            float(np.abs(getattr(self, name) - getattr(reference, name)).max())
            / float(np.abs(getattr(reference, name)).max())
            for name in self.fields()
        )
