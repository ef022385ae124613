"""The test whether a single signed stress represents a history of all stress components.

A signed stress assumes that the stress at every instant is a multiple of one tensor. The deviator
times sqrt(3/2), whose length is the von Mises stress, then moves on a line through zero. `unseen`
is the largest distance of this deviator from the point on the line where the signed stress places
it, relative to the largest von Mises stress. It is 2 where the sign of a torsion is lost, and about
1.4 for components 90 degrees out of phase.

In pure shear the principal stresses are equal in magnitude, so that neither of them gives the von
Mises stress a sign (assess.fatigue.critical_points). The side of zero on the line gives the sign
instead; the side with the larger stress counts as tension, which is the safe choice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from assess.fatigue.records import CaseHistory
from fea.core.voigt import VON_MISES, von_mises
from pinbase.arrays import Floats

MAX_RULE_ERROR = 0.05  # allowed `unseen`; chosen by judgement
SIGNED_SHEAR_RULE = "alternating shear, signed by its direction"


@dataclass(frozen=True)
class SignedCourse:
    """The signed stress of a history.

    cases: signed stress (T,), Pa, of each load case.
    largest: largest von Mises stress, Pa.
    unseen: error of the representation, relative to `largest`.
    note: the rule of the sign, if it is not that of the largest principal stress.
    """

    cases: list[Floats]
    largest: float
    unseen: float
    note: str = ""

    @property
    def stands(self) -> bool:
        """Whether the signed stress represents the history."""
        return self.unseen <= MAX_RULE_ERROR


def course(cases: Sequence[CaseHistory]) -> SignedCourse:
    """Return the signed stress of all cases of a history; the caller must judge its error."""
    stress = np.concatenate([case.stress for case in cases])
    signed = np.concatenate([case.signed for case in cases])
    size = von_mises(stress)
    largest = float(size.max(initial=0.0))
    if not largest:
        return SignedCourse([case.signed for case in cases], 0.0, 0.0)
    values, vectors = np.linalg.eigh(VON_MISES)
    deviator = stress @ (vectors * np.sqrt(np.maximum(values, 0.0)))  # (T, 6)
    # The line through zero that best fits the deviators: their first principal direction.
    line = np.linalg.svd(deviator, full_matrices=False)[2][0]
    place = deviator @ line
    side = np.sign(place[np.abs(place).argmax()])
    by_side = np.where(side * place < 0.0, -size, size)

    def off(values: Floats, line: Floats) -> float:
        apart = np.linalg.norm(deviator - values[:, None] * line, axis=1)
        return float(apart.max()) / largest

    plain = min(off(signed, line), off(signed, -line))
    if plain <= MAX_RULE_ERROR or off(by_side, side * line) > MAX_RULE_ERROR:
        return SignedCourse([case.signed for case in cases], largest, plain)
    ends = np.cumsum([len(case.signed) for case in cases])[:-1]
    return SignedCourse(
        np.split(by_side, ends), largest, off(by_side, side * line), SIGNED_SHEAR_RULE
    )
