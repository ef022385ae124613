"""The reactions of redundant supports of a pin with cuts.

The ends of the local solid about a cut are free, and its cut moves them rigidly relative to each
other (fea.cut.local_model). Between two clamps no such motion is possible, so the clamp beyond the
cut is moved back by as much. The uncut pin therefore has additional unit loads, which are
rigid-body motions of all its clamps but the first. The cuts respond to these as to any other load.
The motions that close all gaps are linear in the other loads.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields

import numpy as np

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import LoadAmounts, Loads, PinLoads, Unit, UnitLoad, amounts_of
from fea.cut.local_fields import LocalFields
from pinbase.arrays import Floats

MAX_GAP_CONDITION = 1e8  # largest condition number of the equations that close the gaps


@dataclass(frozen=True)
class ClampReaction:
    """A clamped surface.

    name: of the surface.
    z: of its middle, m.
    """

    name: str
    z: float


@dataclass(frozen=True)
class LoadsWithReactions(PinLoads):
    """Loads together with the motions of clamps that they cause.

    acting: (T, 2) the amounts of each unit load, these motions included.
    """

    acting: Mapping[UnitLoad, Floats] = field(default_factory=dict)

    def coefficients(self) -> Mapping[UnitLoad, Floats]:
        """The amount (T, 2), by phase, of each unit load."""
        return self.acting


def motions(supports: Sequence[ClampReaction]) -> tuple[Unit, ...]:
    """The rigid-body motions of all clamps but the first.

    They are translations along x, y, z, and rotations about x (with the opposite sign), y, z.
    """
    out: list[Unit] = []
    for s in supports[1:]:
        shift, turn = UnitLoad(s.name, "shift", 1), UnitLoad(s.name, "turn", 1)
        along, about = UnitLoad(s.name, "shift", 0), UnitLoad(s.name, "turn", 0)
        out += [(shift, 0), (shift, 1), (along, 0), (turn, 1), (turn, 0), (about, 1)]
    return tuple(out)


MOTION_SIGNS = np.array([1.0, 1.0, 1.0, -1.0, 1.0, 1.0])  # signs of the motions of a clamp


@dataclass(frozen=True)
class ClampMotions:
    """The motions of clamps that loads cause.

    units: L unit loads.
    motions: M motions of clamps, as unit loads.
    amounts: (M, L) of each motion per unit of each unit load.
    """

    units: tuple[Unit, ...]
    motions: tuple[Unit, ...]
    amounts: Floats

    def with_motions(self, loads: Loads) -> Loads:
        """The loads together with the motions of clamps that they cause."""
        if not self.motions:
            return loads
        q = amounts_of(self.units, loads) @ self.amounts.T
        acting = dict(loads.coefficients())
        for (unit, phase), amount in zip(self.motions, q.T, strict=True):
            both = acting.setdefault(unit, np.zeros((len(loads), 2)))
            both[:, phase] += amount
        if isinstance(loads, LoadAmounts):
            return LoadAmounts(loads.case, acting, len(loads), loads.pressed)
        values = {field.name: getattr(loads, field.name) for field in fields(PinLoads)}
        return LoadsWithReactions(**values, acting=acting)


def reactions(supports: Sequence[ClampReaction], pieces: Sequence[LocalFields]) -> ClampMotions:
    """The motions of clamps that close the gaps which cuts open between clamps.

    pieces: solved under all unit loads, the motions of clamps last.

    Raises: SolveError where the gaps cannot be closed.
    """
    units, moved = pieces[0].units, motions(supports)
    first = len(units) - len(moved)
    if not moved:
        return ClampMotions(units, (), np.zeros((0, first)))
    positions = [reached(s, pieces) for s in supports]
    gap = np.concatenate([MOTION_SIGNS[:, None] * (x - positions[0]) for x in positions[1:]])
    # The gap at each clamp is its own motion plus the motions that the cuts cause under all clamp
    # motions and loads. It must be zero.
    system = np.eye(len(moved)) + gap[:, first:]
    scale = np.tile(
        np.repeat([1.0, pieces[0].piece.profile.largest_diameter], 3), len(supports) - 1
    )
    if not np.linalg.cond(system * scale[:, None] / scale) < MAX_GAP_CONDITION:
        raise SolveError(
            f"pin {pieces[0].piece.profile.name}: the reactions of its clamps cannot be found from "
            "local solids",
            "reactions-unknown",
        )
    return ClampMotions(units[:first], moved, -np.linalg.solve(system, gap[:, :first]))


def reached(support: ClampReaction, pieces: Sequence[LocalFields]) -> Floats:
    """The rigid-body motion (6, L) of a clamp relative to the pin's start by all cuts before it.

    It is a translation (m) and a rotation (rad) about the pin's origin.
    """
    out = np.zeros((6, len(pieces[0].units)))
    for p in pieces:
        if support.z > p.piece.z1:
            out += p.moved[1] - p.moved[0]
        elif support.z > p.piece.z0:  # within the piece, whose motions are relative to the clamp
            out -= p.moved[0]
    return out
