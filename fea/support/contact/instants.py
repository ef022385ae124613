"""Contact at successive instants, each started from the most similar instant before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState, rotation
from pinbase.arrays import Floats, Mask

EQUAL_LOAD_TOLERANCE = 1e-13  # relative: loads that differ by no more are the same
LARGEST_FORCE_SHARE = 1.0 - 1e-6  # forces above this fraction of the largest are equally large


@dataclass(frozen=True)
class JointLoads:
    """The loads on a pin along x and y at each instant.

    forces: of the links, (T, L, 2) N.
    couples: by everything but the lugs, (T, 2) N m.
    moments: of the links at each lug, (T, B, 2) N m.
    """

    forces: Floats
    couples: Floats
    moments: Floats

    @property
    def directions(self) -> list[float]:
        """The angle of the largest force at each instant, rad; of equal forces the first counts."""
        size = np.linalg.norm(self.forces, axis=2)
        first = (size >= LARGEST_FORCE_SHARE * size.max(axis=1, keepdims=True)).argmax(axis=1)
        x, y = self.forces[np.arange(len(self.forces)), first].T
        return [float(angle) for angle in np.arctan2(y, x)]

    def turned(self, angles: Sequence[float]) -> JointLoads:
        """The components of the loads along axes that are turned by angles (T,), rad."""
        turns = np.stack([rotation(angle) for angle in angles])
        couples = np.einsum("ta,tab->tb", self.couples, turns)
        return JointLoads(self.forces @ turns, couples, self.moments @ turns)


def contact_at_instants(
    contact: ContactProblem,
    loads: JointLoads,
    angles: Sequence[float],
    length: float,
    start: Mask | None = None,
) -> list[ContactState]:
    """The contact at each instant.

    angles: of the middle of the first sector, (T,) rad.
    length: of the pin, m, over which couples are compared with forces.
    start: guess of the cells (R, M) in contact at the first instant.

    Raises: SolveError as `ContactProblem.solve`.
    """
    loads = loads.turned(angles)
    arms = loads.couples / length
    acting = np.concatenate([loads.forces, loads.moments / length], axis=1)
    sizes = np.abs(acting).max(axis=(1, 2))
    sizes[sizes == 0.0] = 1.0
    # Without any gap, contact is proportional to the loads.
    scale = sizes if contact.closed else np.full(len(sizes), sizes.max())
    like = np.concatenate([acting.reshape(len(acting), -1), arms], axis=1) / scale[:, None]
    states: list[ContactState] = []
    for t, (force, couple) in enumerate(zip(loads.forces, loads.couples.tolist(), strict=True)):
        apart = np.abs(like[:t] - like[t]).max(axis=1, initial=0.0)
        near = int(apart.argmin()) if t else None
        if near is not None and apart[near] <= EQUAL_LOAD_TOLERANCE:
            states.append(states[near].times(float(scale[t] / scale[near])))
            continue
        guess = start if near is None else states[near].active
        states.append(contact.solve(force, (couple[0], couple[1]), guess, loads.moments[t]))
    return [x.turned(angle) for x, angle in zip(states, angles, strict=True)]
