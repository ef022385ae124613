"""The loads on the pins of a motion at any time.

They are interpolated by polynomials between instants at which the mechanism was solved and which
are dense enough for that (loads.motion.refine).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from loads import Dynamics, Reactions, Resolved, resolved
from loads.landing.through import fall
from pinbase.arrays import Floats

# Reactions, and the accelerations (T, J, 2) m/s^2 of the joints, or (T, C, 3) of the pins in space
Acting = tuple[Reactions, Floats]


def acting(dynamics: Dynamics) -> Acting:
    """Return the reactions of a mechanism, and the accelerations of its joints in their order."""
    accelerations = [acceleration for _, _, acceleration in dynamics.motion.joints()]
    falling = fall(dynamics.motion, dynamics.applied)[:, None]  # of the aircraft in a drop
    return dynamics.reactions, np.stack(accelerations, axis=1) + falling


class MovingLoads:
    """The reactions of a motion and the accelerations of its joints.

    solve: function that returns both at times (T,) s, in any order.
    times: samples, s.
    corners: times at which a value may jump, s.
    """

    def __init__(
        self,
        solve: Callable[[Floats], Acting],
        times: Floats,
        corners: Floats | tuple[float, ...] = (),
    ) -> None:
        self._solve, self._times, self._corners = solve, times, corners

    @cached_property
    def _resolved(self) -> Resolved:
        def values(times: Floats) -> Floats:
            """Return (T, K) values: forces, moments, turn by connection; acceleration by joint."""
            r, joints = self._solve(times)
            parts = (r.forces, r.moments, r.turn, joints)
            return np.concatenate([x.reshape(len(times), -1) for x in parts], axis=1)

        return resolved(self._times, values, self._corners)

    @cached_property
    def _first(self) -> Acting:
        return self._solve(self._times[:1])

    @cached_property
    def instants(self) -> Floats:
        """The samples and further times (N,) s, dense enough for interpolation."""
        return np.union1d(self._times, self._resolved.nodes)

    def at(self, times: Floats) -> Acting:
        """Return the loads at times (T,) s, interpolated."""
        r, joints = self._first
        like = (r.forces, r.moments, r.turn, joints)
        values = self._resolved.interpolate(times)
        columns = np.split(values, np.cumsum([x.size for x in like[:-1]]), axis=1)
        forces, moments, turn, joints = (
            x.reshape(len(times), *shape.shape[1:]) for x, shape in zip(columns, like, strict=True)
        )
        reactions = Reactions(r.case, times, r.connections, r.bodies, forces, moments, turn)
        return reactions, joints
