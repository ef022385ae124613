"""Whether a single signed stress represents a history of all its components.

A rule for such a history takes the stress at every instant as a multiple of one tensor. The
deviator times sqrt(3/2), whose length is the von Mises stress, should then move on a line through
zero: `unseen` is its largest distance from the place on that line where the rule takes it to be,
over the largest von Mises stress. It is 2 where the sign of a torsion does not register, and about
1.4 for components 90 degrees out of phase.

In pure shear the principal stresses are equal, so that neither gives the von Mises stress its sign
(assess.fatigue.critical_points). There the side of zero on the line does; the larger side counts as
tension, the safe choice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from assess.fatigue.records import CaseHistory
from fea.core.voigt import VON_MISES, von_mises
from pinbase.arrays import Floats

MAX_RULE_ERROR = 0.05  # of the largest stress, allowed error of a rule; chosen by judgement
SIGNED_SHEAR_RULE = "alternating shear, signed by its direction"


@dataclass(frozen=True)
class SignedCourse:
    """Signed stress (T,), Pa, of each case.

    largest: von Mises stress, Pa.
    unseen: error of the representation, over that.
    note: how it was signed, if not by the largest principal stress.
    """

    cases: list[Floats]
    largest: float
    unseen: float
    note: str = ""

    @property
    def stands(self) -> bool:
        """Whether it represents the history."""
        return self.unseen <= MAX_RULE_ERROR


def course(cases: Sequence[CaseHistory]) -> SignedCourse:
    """The signed stress of all cases of a history; its error is for the caller to judge."""
    stress = np.concatenate([case.stress for case in cases])
    signed = np.concatenate([case.signed for case in cases])
    size = von_mises(stress)
    largest = float(size.max(initial=0.0))
    if not largest:
        return SignedCourse([case.signed for case in cases], 0.0, 0.0)
    values, vectors = np.linalg.eigh(VON_MISES)
    deviator = stress @ (vectors * np.sqrt(np.maximum(values, 0.0)))  # (T, 6)
    # The line through zero that fits the deviators best: their first principal direction.
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
