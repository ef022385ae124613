"""The fully plastic section of a round pin, solid or hollow, in bending with shear.

    M_pl = W_pl f_y       V_pl = A_v f_y / sqrt(3)

W_pl is exact for a perfectly plastic section (fea.beam.round_section). A_v is the larger of two
areas: the shear area 2 A / pi of a circular hollow section, and the area at which V Q / (I t)
reaches yield. The second is also safe, and is larger for thick walls: 3 A / 4 for a solid pin. With
a hardened surface, M_pl is the sum of the moments of case and core, and V_pl follows from the
core's strength.

The interaction (M / M_pl)^2 + (V / V_pl)^2 <= 1 is checked in every section; the root of its left
side is the utilisation. It is checked at ultimate load with the yield strength, because a plastic
hinge is not permitted at limit load. The circle follows from a uniform shear stress tau, which
leaves sqrt(f_y^2 - 3 tau^2) for bending. Axial force and torque are not included;
assess.plastic.hinge includes them.

This is a rule of pinstress, not of a standard. EN 1993-1-1:2005 covers shear alone in 6.2.6,
bending with shear in 6.2.8, and both with axial force in 6.2.9 and 6.2.10
(assess.clauses.eurocode_sections).

Source: EN 1993-1-1:2005, 6.2.6(3) g, for the shear area of a circular hollow section alone.
"""

from __future__ import annotations

import math

import numpy as np

from assess.check import CheckText, Passing, check
from assess.margin import RATIO_DIMENSION, Margin, strength_key
from assess.situation import Situation
from assess.work import Work, diameter_of_wall, work
from fea.beam.plastic_interaction import cased_rings
from fea.beam.round_section import Circle

PLASTIC_METHOD = "plastic bending and shear"
INTERACTION_RULE = "(M/M_pl)^2 + (V/V_pl)^2 <= 1, without axial force and torque"


def plastic_shear(section: Circle, strength: float) -> float:
    """Return V_pl, N, of a section. strength: yield strength, Pa."""
    return max(2.0 / math.pi * section.area, section.axis_area) * strength / math.sqrt(3.0)


def _moment(s: Situation, z: float, section: Circle) -> float:
    """Return M_pl, N m, of a section at z, m; with a hardened surface, the sum of the moments of
    case and core. At the end of a hardened length the smaller moment counts.
    """
    material, strength = s.material, s.material.yield_strength or 0.0
    cases = [case for case in material.hardened if case.start <= z <= case.end]
    rings = [cased_rings(section, case) for case in cases]
    if not cases or (material.unhardened and any(z in (c.start, c.end) for c in cases)):
        rings.append(((section, material.unhardened or strength),))
    return min(sum(fy * ring.plastic_modulus for ring, fy in both) for both in rings)


@check(
    PLASTIC_METHOD,
    "rule of pinstress",
    kind="clause",
    takes="section forces",
    level="ultimate",
    dimension=RATIO_DIMENSION,
    omits="Not covered: axial force and torque, which limit loads have.",
)
def plastic_bending(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of the section nearest to a hinge, with even loads or the joint's."""
    forces, fy = s.forces, s.material.yield_strength
    if forces.kind == "concentrated":
        return []
    if fy is None:
        return [text.lacks(s, strength_key(s.material.name, "yield"))]
    M = np.array([_moment(s, *at) for at in zip(forces.z, forces.sections, strict=True)])
    V = np.array([plastic_shear(section, fy) for section in forces.sections])
    used = np.hypot(forces.moment / M, forces.shear / V)
    factor = s.factors.at(text.level)

    def shown(k: int) -> tuple[Work, Passing]:
        section, t = forces.sections[k], int(used[:, k].argmax())
        moment, shear = float(forces.moment[t, k]), float(forces.shear[t, k])
        both = work(
            "u", float(used[t, k]), RATIO_DIMENSION, "√(({M} / {M_pl})² + ({V} / {V_pl})²)",
            M=(moment, "moment"), M_pl=(float(M[k]), "moment"), V=(shear, "force"),
            V_pl=(float(V[k]), "force"),
        )  # fmt: skip

        # A change of the diameter changes all places with this section, and the worst place among
        # them may change. Only places count that no other exceeds in both moment and shear (and
        # some of those with equal moments, which change nothing).
        distinct = {id(other): other for other in forces.sections}
        same = {key: other == section for key, other in distinct.items()}
        alike = np.array([same[id(other)] for other in forces.sections])
        bent, sheared = (forces.moment / M)[:, alike].ravel(), (forces.shear / V)[:, alike].ravel()
        falling = np.argsort(-bent)
        before = np.maximum.accumulate(np.append(-1.0, sheared[falling][:-1]))
        front = falling[sheared[falling] > before]

        def of_wall(wall: float) -> float:
            other = Circle(section.inner + wall, section.inner)
            m = bent[front] * section.plastic_modulus / other.plastic_modulus
            v = sheared[front] * plastic_shear(section, fy) / plastic_shear(other, fy)
            return factor * float(np.hypot(m, v).max())

        return both, lambda _: diameter_of_wall(section, of_wall)

    return [text.along(s, used, np.ones(used.shape[1]), INTERACTION_RULE, shown)]
