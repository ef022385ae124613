"""Joints in symmetrical double shear by AFFDL-TR-69-42, 9.4: the load shifts to the faces.

    lugs and bushings    P_uLB = min(2 P_1, P_2)
    shifted bending      P_max = 2 C (sqrt(P_ub arm / C + g^2) - g)
                         C = P_1 P_2 / (P_1 t_2 + P_2 t_1)

P_1 and P_2 are the allowable loads of one outer lug and of the middle lug with their bushings; t_1
and t_2 are their thicknesses and g is the gap. P_ub = 2 M_u / arm is the load that breaks the pin
in bending with even bearing; arm = t_1/2 + t_2/4 + g. A yielding pin bears more on the facing sides
of the lugs, as far as the lugs carry it; P_max is the load with the reduced bearing widths b_1 and
2 b_2.

The load of the joint is the smallest of the load of the lugs, the shear load of the pin, and the
larger of both bending loads.

Source: AFFDL-TR-69-42, Stress Analysis Manual, 9.4, equations 9-11 to 9-19.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from assess.check import CheckText, WorstPlace, check
from assess.clauses.affdl_lugs import (
    LUG_OMITS,
    MANUAL,
    bearing_capacity,
    bushing_capacity,
    net_section_capacity,
)
from assess.clauses.cozzone import bending_strength
from assess.clauses.eye import LoadedEye, loaded_eyes
from assess.clauses.eye_margin import lacks_pull
from assess.margin import Margin, strength_key
from assess.situation import Situation
from assess.strength.bending_arms import in_double_shear, outer_and_gap, sections_between
from assess.work import Work, diameter_of_wall, work
from fea.beam.round_section import Circle
from geometry import ArgumentError, Band

LAYOUT_NEEDED = "symmetrical double shear, with the sizes of all three lugs"


@dataclass(frozen=True)
class DoubleShear:
    """A joint in symmetrical double shear.

    outer, middle: loads of one outer lug and of the middle lug with their bushings, P_1 and P_2, N.
    thickness: t_1 and t_2, m. gap: g, m. moment: M_u that breaks the pin, N m. shear: load that
    shears the pin in both planes, N. section: the section that breaks first in bending.
    """

    outer: float
    middle: float
    thickness: tuple[float, float]
    gap: float
    moment: float
    shear: float
    section: Circle

    def with_wall(self, wall: float) -> DoubleShear:
        """Return the joint with another wall thickness of the pin, m, in the same lugs."""
        section = Circle(self.section.inner + wall, self.section.inner)
        moment = self.moment * section.modulus / self.section.modulus
        shear = self.shear * section.area / self.section.area
        return replace(self, moment=moment, shear=shear, section=section)

    @property
    def arm(self) -> float:
        """The arm of the moment with even bearing, m (9-13)."""
        t1, t2 = self.thickness
        return t1 / 2.0 + t2 / 4.0 + self.gap

    @property
    def lugs(self) -> float:
        """The load of lugs and bushings, N (9-11)."""
        return min(2.0 * self.outer, self.middle)

    @property
    def even_bending(self) -> float:
        """The load that breaks the pin in bending with even bearing, N (9-15)."""
        return 2.0 * self.moment / self.arm

    @property
    def line_load(self) -> float:
        """C, N/m: half of the load per width at which both lugs bear up to failure (9-16)."""
        t1, t2 = self.thickness
        return self.outer * self.middle / (self.outer * t2 + self.middle * t1)

    @property
    def shifted_bending(self) -> float:
        """The load that breaks the pin in bending with the load shifted to the faces, N (9-16)."""
        C, g = self.line_load, self.gap
        return 2.0 * C * (math.sqrt(self.even_bending * self.arm / C + g**2) - g)

    @property
    def bearing_widths(self) -> tuple[float, float]:
        """The widths b_1 of each outer lug and 2 b_2 of the middle one that bear, m (9-17)."""
        load = self.shifted_bending
        t1, t2 = self.thickness
        return load * t1 / (2.0 * self.outer), load * t2 / self.middle

    @property
    def load(self) -> float:
        """The load of the joint, N (9-19)."""
        return min(self.lugs, self.shear, max(self.even_bending, self.shifted_bending))

    def works(self) -> tuple[Work, ...]:
        """Return the work of each load."""
        (t1, t2), force, length = self.thickness, "force", "length"
        P_1, P_2 = (self.outer, force), (self.middle, force)
        return (
            work("P_uLB", self.lugs, force, "min(2 × {P_1}, {P_2})", P_1=P_1, P_2=P_2),
            work(
                "P_ub", self.even_bending, force, "2 × {M_u} / ({t_1} / 2 + {t_2} / 4 + {g})",
                M_u=(self.moment, "moment"), t_1=(t1, length), t_2=(t2, length),
                g=(self.gap, length),
            ),
            work(
                "C", self.line_load, "force length^-1",
                "{P_1} × {P_2} / ({P_1} × {t_2} + {P_2} × {t_1})", P_1=P_1, P_2=P_2,
                t_1=(t1, length), t_2=(t2, length),
            ),
            work(
                "P_max", self.shifted_bending, force,
                "2 × {C} × (√({P_ub} × {arm} / {C} + {g} × {g}) − {g})",
                C=(self.line_load, "force length^-1"), P_ub=(self.even_bending, force),
                arm=(self.arm, length), g=(self.gap, length),
            ),
            work(
                "P", self.load, force, "min({P_uLB}, {P_us}, max({P_ub}, {P_max}))",
                P_uLB=(self.lugs, force), P_us=(self.shear, force), P_ub=(self.even_bending, force),
                P_max=(self.shifted_bending, force),
            ),
        )  # fmt: skip


@check("AFFDL joint in double shear", f"{MANUAL}, 9.4, eq. 9-11 to 9-19", kind="clause",
       takes="statics", level="ultimate", dimension="force",
       omits=f"{LUG_OMITS} One diameter of the pin along all three lugs.")  # fmt: skip
def affdl_joint(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of the force on the middle lug against the load of the joint."""
    joint = joint_of(s)
    if isinstance(joint, list):
        return [text.lacks(s, *joint)]
    bands, loaded = _in_order(s)
    t = int(loaded[1].size.argmax())
    force, place = float(loaded[1].size[t]), WorstPlace.at_band(bands[1], s.loads, t)
    name, basis, section = s.material.name, loaded[1].basis, joint.section

    def of_wall(wall: float) -> float:
        return s.factors.at(text.level) * force / joint.with_wall(wall).load

    passing = diameter_of_wall(section, of_wall) if joint.lugs > joint.load else None
    return [text.margin(s, force, joint.load, place, name, basis, joint.works(), passing)]


def joint_of(s: Situation) -> DoubleShear | list[str]:
    """Return the joint of a situation or, if it is not such a joint or cannot be checked, what is
    missing.
    """
    bands, eyes = _in_order(s)
    if len(bands) != len(eyes) or not in_double_shear(s):
        return [LAYOUT_NEEDED]
    if needs := [need for eye in eyes if (need := lacks_pull(eye))]:
        return needs[:1]
    try:
        return _joint(s, bands, eyes)
    except ArgumentError as error:
        return [str(error)]


def _in_order(s: Situation) -> tuple[list[Band], list[LoadedEye]]:
    """Return the bands in their order along the pin, and the eyes of the bands whose lug size is
    given.
    """
    eyes = {x.connection: x for x in loaded_eyes(s)}
    bands = sorted((s.pin.band(name) for name in s.loads.surfaces), key=lambda b: b.z0)
    return bands, [eyes[band.name] for band in bands if band.name in eyes]


def _joint(s: Situation, bands: list[Band], eyes: list[LoadedEye]) -> DoubleShear | list[str]:
    """Return the joint of three bands, or the keys that the study lacks.

    Raises: ArgumentError as assess.clauses.cozzone.
    """
    sections = sections_between(s.pin, bands[0], bands[2])
    strengths, fsu = {x: bending_strength(s, x) for x in sections}, s.material.shear_strength
    loads = [_lug_load(s, x) for x in eyes]
    lacking = [key for x in (*loads, *strengths.values()) if isinstance(x, list) for key in x]
    lacking += [strength_key(s.material.name, "shear")] * (fsu is None)
    if lacking or fsu is None:
        return list(dict.fromkeys(lacking))
    first, middle, last = (load for load in loads if isinstance(load, float))
    outer, gap = outer_and_gap(*bands)
    moment, section = min(
        (
            (strength.result.value * section.modulus, section)
            for section, strength in strengths.items()
            if isinstance(strength, Work)
        ),
        key=lambda x: x[0],
    )
    return DoubleShear(
        min(first, last), middle, (outer, bands[1].length), gap, moment,
        2.0 * fsu * min(section.area for section in sections), section,
    )  # fmt: skip


def _lug_load(s: Situation, x: LoadedEye) -> float | list[str]:
    """Return the smallest load of a lug and its bushing, N, or the keys that the study lacks."""
    every = bearing_capacity(s, x), net_section_capacity(s, x), bushing_capacity(x)
    lists = [[c] if isinstance(c, str) else c for c in every if isinstance(c, list | str)]
    if lists:
        return [key for keys in lists for key in keys]
    return min(c(x.eye).result.value for c in every if callable(c))
