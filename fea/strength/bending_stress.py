"""Elastic bending of a pin between lugs, with the forces even over the lugs or at their middles.

The stress is 32 M / (pi d^3) (of a hollow pin M c / I), compared with yield at limit load. The
moment in double shear, for a force F on the middle lug,

    even             F / 2 (a / 2 + c + b / 4)
    concentrated     F / 2 (a / 2 + c + b / 2)

with a the outer lugs' thickness, b the middle one's, c the gap; other layouts: fea.strength.
section_forces. The even load is what fea.checks.hand_checks has as bending.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, problem 3-40.
"""

from __future__ import annotations

import numpy as np

from fea.strength.margin import Margin
from fea.strength.section_forces import SectionForces
from fea.strength.situation import Situation
from fea.strength.worst import Check, strength_key

CONCENTRATED = Check("bending, concentrated forces", "Shigley, problem 3-40", "limit", "stress")
OF_JOINT = Check("bending, joint model", "Shigley, 3-10", "limit", "stress")


def bending_margin(s: Situation, check: Check, forces: SectionForces) -> Margin:
    """Against yield."""
    fy = s.material.yield_strength
    if fy is None:
        return check.lacks(s, strength_key(s.material.name, "yield"))
    stress = forces.moment / forces.of_sections("modulus")
    return check.along(s, forces, stress, np.full(stress.shape[1], fy))
