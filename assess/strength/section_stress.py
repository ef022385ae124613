"""Nominal stresses of a pin by its section forces: shear and elastic bending.

Mean shear V / A, shear at the neutral axis V Q / (I t) (solid: 4 V / (3 A)) and bending M c / I,
each where and when it is largest. The moment in double shear, for a force F on the middle lug,

    even             F / 2 (a / 2 + c + b / 4)
    concentrated     F / 2 (a / 2 + c + b / 2)

with a the outer lugs' thickness, b the middle one's, c the gap; other layouts: `section_forces`.
The even load is what `hand_checks` has. Where the joint was solved its own
section forces have the couples that lugs carry, too, which neither of both knows.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, 3-10, 3-11, 8-12,
and problem 3-40 (concentrated forces).
"""

from __future__ import annotations

import math

import numpy as np

from assess.strength.hand_checks import (
    BENDING_METHOD,
    MEAN_SHEAR_METHOD,
    NEUTRAL_AXIS_METHOD,
    SHIGLEY,
    SHIGLEY_JOINTS,
)
from assess.strength.records import HandCheck
from assess.strength.section_forces import SectionForces
from assess.strength.situation import Situation
from pinbase.arrays import Floats

JOINT_MODEL_BENDING = f"{BENDING_METHOD}, joint model", "Shigley, 3-10"
CONCENTRATED_BENDING = f"{BENDING_METHOD}, concentrated forces", "Shigley, problem 3-40"


def shear_checks(s: Situation, forces: SectionForces) -> tuple[HandCheck, HandCheck]:
    """Mean, and at the neutral axis."""
    yields = s.material.yield_strength
    strength = yields / math.sqrt(3.0) if yields else None
    mean = forces.shear / forces.of_sections("area")
    solid = not any(section.inner for section in forces.sections)
    axis = NEUTRAL_AXIS_METHOD, "4 V / (3 A)" if solid else "V Q / (I t)", f"{SHIGLEY}, 3-11"
    return (
        _largest(s, forces, mean, strength, (MEAN_SHEAR_METHOD, "V / A", SHIGLEY_JOINTS), "shear"),
        _largest(s, forces, mean * forces.of_sections("vq_it"), strength, axis),
    )


def bending_check(s: Situation, forces: SectionForces, named: tuple[str, str]) -> HandCheck:
    """named: the check and its source."""
    stress, (name, source) = forces.moment / forces.of_sections("modulus"), named
    return _largest(s, forces, stress, s.material.yield_strength, (name, "M c / I", source))


def _largest(
    s: Situation,
    forces: SectionForces,
    stress: Floats,
    strength: float | None,
    words: tuple[str, str, str],
    ruptures: str = "",
) -> HandCheck:
    """Of stresses (T, S), Pa. words: name, formula, source."""
    (name, formula, source), (t, k) = words, np.unravel_index(stress.argmax(), stress.shape)
    time = None if forces.times is None else float(forces.times[t])
    at, value = (forces.labels[int(k)], float(forces.z[k]), time), float(stress[t, k])
    return HandCheck(
        name, *at, value, strength, formula, source, s.material.name, ruptures, forces.basis
    )
