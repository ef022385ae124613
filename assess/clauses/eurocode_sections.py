"""Sections of pins by EN 1993-1-1:2005, 6.2.8 to 6.2.10: bending with shear and axial force.

    V_pl,Rd = 2 A / pi f_y / (sqrt(3) gamma_M0)      T_Rd = W_t f_y / (sqrt(3) gamma_M0)
    v = V_Ed / V_pl,Rd + T_Ed / T_Rd                 rho = (2 v - 1)^2 above v = 0.5, else 0
    M_Ed <= M_N,V,Rd

M_N,V,Rd is the plastic moment that remains beside an axial force (6.2.9) at the yield strength
(1 - rho) f_y (6.2.8, 6.2.10). The clause gives no formula for round sections; here it is exact for
a fully plastic section, solid or hollow (fea.beam.plastic_interaction). With b, the utilisation of
M_pl,Rd and N_pl,Rd by M_Ed and N_Ed together, the check is b <= 1 - rho. The factor on all loads at
which b = 1 - rho is 1/R, with

    R = b where 2 v <= b, else 4 v^2 / (4 v - b)

Four simplifications are on the safe side: the shear area is that of a tube also for solid pins; the
yield strength is reduced in the whole section, not only in the shear area; W_t is the elastic
torsional modulus; and shear and torsion are added (V_Ed over the V_pl,T,Rd of 6.2.7 is less as long
as the sum is below 1).

Tubes must be of class 1 or 2: d/t up to 70 * 235 MPa / f_y (table 5.2).

Source: EN 1993-1-1:2005, 6.2.5 to 6.2.10 and table 5.2.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from assess.check import CheckText, WorstPlace, check
from assess.margin import RATIO_DIMENSION, Margin, strength_key
from assess.situation import SectionForces, Situation
from assess.work import Work, diameter_of_wall, work
from fea.beam.plastic_interaction import bending_and_axial_use
from fea.beam.round_section import Circle
from pinbase.arrays import Floats

MAX_SLENDERNESS, SLENDERNESS_STRENGTH = 70.0, 235e6  # d/t of class 2, times epsilon^2; Pa
MAX_LEFT = 0.01  # resultant relative to the largest axial force or torque; more is unbalanced
REACTION_NEEDED = (
    "the forces along the pin and torques of a structure's lugs, which the solved joint gives"
)
USE_RULE = "1/R is the factor on all loads at which b = 1 − ρ"
CLASS_NEEDED = "walls of class 1 or 2 (d/t at most 70 times 235 MPa over the yield strength)"


@check("EN 1993-1-1 section", "EN 1993-1-1, 6.2.8 to 6.2.10", kind="clause",
       takes="section forces", level="ultimate", dimension=RATIO_DIMENSION,
       omits="Not covered: buckling, what loads press into a wall.")  # fmt: skip
def eurocode_section(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of moment, shear, axial force and torque in the worst section."""
    forces, fy = s.forces, s.material.yield_strength
    if forces.kind == "concentrated":
        return []
    if fy is None:
        return [text.lacks(s, strength_key(s.material.name, "yield"))]
    if forces.kind == "even" and not s.clamps and _left_along(s):
        return [text.lacks(s, REACTION_NEEDED)]
    if any(_slenderness(x) > MAX_SLENDERNESS * SLENDERNESS_STRENGTH / fy for x in forces.sections):
        return [text.lacks(s, CLASS_NEEDED)]
    design = fy / s.partial.M0
    used = np.stack([_along(forces, k, design) for k in range(len(forces.z))], axis=1)
    t, k = s.most_used(used)
    section = forces.sections[k]
    V, M, N, T = (float(x[t, k]) for x in _four(forces))
    time = None if forces.times is None else float(forces.times[t])
    margin = text.margin(
        s, float(used[t, k]), 1.0, WorstPlace(forces.labels[k], float(forces.z[k]), time),
        s.material.name, f"{forces.basis}; {USE_RULE}",
        _works(section, fy, s.partial.M0, V, M, N, T),
    )  # fmt: skip
    factor = s.factors.at(text.level)

    # A change of the diameter changes all places with this section, so the worst place may change.
    alike = np.array([other == section for other in forces.sections])

    def of_wall(wall: float) -> float:
        wider = Circle(section.inner + wall, section.inner)
        everywhere = (x[:, alike] for x in _four(forces))
        return factor * float(section_use(wider, design, *everywhere).max())

    return [replace(margin, passing=diameter_of_wall(section, of_wall))]


def section_use(
    section: Circle, strength: float, V: Floats, M: Floats, N: Floats, T: Floats
) -> Floats:
    """Return R, the reciprocal of the factor that all loads may reach in proportion, (...).

    V, N: (...) shear and axial forces, N. M, T: (...) moments and torques, N m. strength: the
    design yield strength, Pa.
    """
    v = V / plastic_shear(section, strength) + T / torsion_resistance(section, strength)
    in_plastic = M / (section.plastic_modulus * strength), N / (section.area * strength)
    b, _ = bending_and_axial_use(section, *in_plastic)
    b = np.where((M > 0.0) | (N > 0.0), b, 0.0)
    sheared = 2.0 * v > b
    return np.where(sheared, 4.0 * v**2 / np.where(sheared, 4.0 * v - b, 1.0), b)


def plastic_shear(section: Circle, strength: float) -> float:
    """Return V_pl,Rd, N, for a design yield strength, Pa (6.2.6 (3) g)."""
    return 2.0 / math.pi * section.area * strength / math.sqrt(3.0)


def torsion_resistance(section: Circle, strength: float) -> float:
    """Return T_Rd, N m, at which the outer fibre yields, for a design yield strength, Pa."""
    return section.polar / section.outer * strength / math.sqrt(3.0)


def _left_along(s: Situation) -> bool:
    """Whether axial forces or torques have a resultant that no band reacts."""
    loads = s.by_formula
    return any(
        bool(np.abs(x.sum(axis=1)).max() > MAX_LEFT * np.abs(x).max())
        for x in (loads.forces[..., 2], loads.moments[..., 2])
    )


def _slenderness(section: Circle) -> float:
    return 2.0 * section.outer / (section.outer - section.inner) if section.inner else 0.0


def _four(forces: SectionForces) -> tuple[Floats, Floats, Floats, Floats]:
    """Return V, M, N, T, (T, S) each."""
    return forces.shear, forces.moment, forces.axial, forces.torque


def _along(forces: SectionForces, k: int, design: float) -> Floats:
    """Return R at a station, by its number, at all instants (T,)."""
    return section_use(forces.sections[k], design, *(x[:, k] for x in _four(forces)))


def _works(
    section: Circle, fy: float, gamma_M0: float, V: float, M: float, N: float, T: float
) -> tuple[Work, ...]:
    design = fy / gamma_M0
    M_pl, N_pl = section.plastic_modulus * design, section.area * design
    V_pl, T_Rd = plastic_shear(section, design), torsion_resistance(section, design)
    strength, gamma = (fy, "stress"), (gamma_M0, "1")
    v = V / V_pl + T / T_Rd
    b = float(section_use(section, design, *(np.array([x]) for x in (0.0, M, N, 0.0)))[0])
    R = float(section_use(section, design, *(np.array([x]) for x in (V, M, N, T)))[0])
    both = work("R", R, "1", "4 × {v} × {v} / (4 × {v} − {b})", v=(v, "1"), b=(b, "1"))
    return (
        work("M_pl,Rd", M_pl, "moment", "{W_pl} × {f_y} / {γ_M0}",
             W_pl=(section.plastic_modulus, "length^3"), f_y=strength, γ_M0=gamma),
        work("N_pl,Rd", N_pl, "force", "{A} × {f_y} / {γ_M0}",
             A=(section.area, "length^2"), f_y=strength, γ_M0=gamma),
        work("V_pl,Rd", V_pl, "force", "2 × {A} / π × {f_y} / (√3 × {γ_M0})",
             A=(section.area, "length^2"), f_y=strength, γ_M0=gamma),
        work("v", v, "1", "{V_Ed} / {V_pl} + {T_Ed} / {T_Rd}", V_Ed=(V, "force"),
             V_pl=(V_pl, "force"), T_Ed=(T, "moment"), T_Rd=(T_Rd, "moment")),
        work("b", b, "1", "{M_Ed} / {M_pl} with {N_Ed} / {N_pl}", M_Ed=(M, "moment"),
             M_pl=(M_pl, "moment"), N_Ed=(N, "force"), N_pl=(N_pl, "force")),
        both if 2.0 * v > b else work("R", R, "1", "{b}", b=(b, "1")),
    )  # fmt: skip
