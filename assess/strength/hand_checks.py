"""Hand checks of a pin: shear, bearing and bending.

These are the nominal stresses of textbooks, each at the place and instant where it is largest. They
are compared with yield in bending, yield over sqrt(3) in shear (von Mises), and yield in bearing.
Yield in bearing is a convention, and a safe one: a pin that is confined by its neighbours bears a
higher pressure before it is marked. Against rupture they are compared with the study's shear and
bearing strengths.

Shear and bending take the section forces of a beam (assess.strength.section_forces). In double
shear, with a force F on the middle lug, the moment is

    even             F / 2 (a / 2 + c + b / 4)
    concentrated     F / 2 (a / 2 + c + b / 2)

where a is the thickness of the outer lugs, b that of the middle lug, and c the gap. If the joint
was solved, its section forces also include the couples that the lugs carry, which both formulas
omit.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, 3-10 and 3-11
(bending, transverse shear), problem 3-40 (concentrated forces), 5-5 (distortion energy), 8-12
(shear and bearing of bolts and pins); ASME BTH-1, Design of Below-the-Hook Lifting Devices, 3-3,
has the same for pinned connections.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from operator import attrgetter
from types import MappingProxyType

import numpy as np

from assess.check import CheckText, Rupture, WorstPlace, check
from assess.margin import Margin
from assess.requirement import RequiredCheck
from assess.situation import ForcesKind, NominalStress, Situation
from assess.work import Work, scaled, wider, work
from fea.beam.line_load import acting, shares
from fea.beam.timoshenko import SHEAR, stepped_beam
from fea.core.hardened import linear_strength
from fea.core.material import Material

SHIGLEY = "Budynas & Nisbett, Shigley's Mechanical Engineering Design"
SHIGLEY_JOINTS = f"{SHIGLEY}, 8-12"
BEARING_SOURCE = f"{SHIGLEY_JOINTS}; yield as its strength is a convention"
BENDING_TEXTS: dict[ForcesKind, tuple[str, str]] = {  # method and clause
    "even": ("bending", f"{SHIGLEY}, 3-10"),
    "joint": ("bending, joint model", "Shigley, 3-10"),
    "concentrated": ("bending, concentrated forces", "Shigley, problem 3-40"),
}
BENDING_METHODS = frozenset(method for method, _ in BENDING_TEXTS.values())
# Methods that compare the pressure on bands, and the shear of pin and lugs, with strengths.
BEARING_METHODS = "bearing", "lug, bearing", "lug, bearing, bushing"
SHEAR_METHODS = (
    "single shear, mean",
    "single shear, at the neutral axis",
    "double shear, mean",
    "lug, shear-out",
)
METHODS_BY_FORMULA: Mapping[RequiredCheck, tuple[str, ...]] = MappingProxyType(
    {"bearing": BEARING_METHODS, "shear": SHEAR_METHODS}
)
BENDING_FORMULA = "M c / I"
NOMINAL_OMITS = (
    "Not covered: stress at notches and beneath lugs, axial force and torque, which the von Mises "
    "stress of the model has."
)
BEARING_OMITS = "Not covered: uneven pressure along the band and its edges, wear."
MAX_HALF_DIFFERENCE = 0.1  # difference of a band's two sides in double shear, over its load


def shear_yield(material: Material) -> float | None:
    """Return the yield strength in shear by von Mises, Pa; None without a yield strength."""
    return material.yield_strength / math.sqrt(3.0) if material.yield_strength else None


@check("single shear, mean", SHIGLEY_JOINTS, kind="hand", takes="section forces",
       omits=NOMINAL_OMITS)  # fmt: skip
def mean_shear(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the mean shear stress V / A in the section where it is largest."""
    if not s.chosen:
        return []
    stress = s.forces.mean_shear()
    return _along(text, s, stress, shear_yield(s.material), "V / A", "shear")


@check("single shear, at the neutral axis", f"{SHIGLEY}, 3-11", kind="hand",
       takes="section forces", omits=NOMINAL_OMITS)  # fmt: skip
def neutral_axis_shear(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the shear stress at the neutral axis, V Q / (I t), which is
    4 V / (3 A) in a solid pin.
    """
    if not s.chosen:
        return []
    stress = s.forces.neutral_axis_shear()
    formula = "V Q / (I t)" if stress.section.inner else "4 V / (3 A)"
    return _along(text, s, stress, shear_yield(s.material), formula)


@check("double shear, mean", SHIGLEY_JOINTS, kind="hand", takes="statics", omits=NOMINAL_OMITS)
def double_shear(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the mean shear stress F / (2 A) at every band in double shear: half of
    its load, when the load is largest, goes to each side.
    """
    loads = s.on_bands
    forces = stepped_beam(s.pin, s.material, acting(loads), s.clamps)
    c = shares(forces.loads, loads)
    margins = []
    for name in dict.fromkeys(loads.surfaces):
        band = s.pin.band(name)
        left, right = (int(np.abs(forces.stations - z).argmin()) for z in (band.z0, band.z1))
        adjacent = {left - 1, left, right - 1, right}
        if not adjacent <= set(forces.free):
            continue
        ends = forces.inside(np.array([left, right - 1]), np.array([band.z0, band.z1]))
        V = np.einsum("sk,tpk->stp", ends[:, SHEAR], c)
        load = np.linalg.norm(V[0] - V[1], axis=1)
        t = int(load.argmax())
        if load[t] > 0.0 and np.linalg.norm(V[0, t] + V[1, t]) <= MAX_HALF_DIFFERENCE * load[t]:
            section = min((forces.sections[i] for i in adjacent), key=lambda x: x.area)
            place = WorstPlace.at_band(band, loads, t)
            shown = work(
                "τ", float(load[t]) / (2.0 * section.area), "stress", "{F} / (2 × {A})",
                F=(float(load[t]), "force"), A=(section.area, "length^2"),
            )  # fmt: skip
            passing = partial(wider, section, power=2.0, resists=attrgetter("area"))
            margins += text.at_levels(
                s, shown.result.value, place, s.material, shear_yield(s.material), "shear",
                "F / (2 A)", shown=(shown, passing),
            )  # fmt: skip
    return margins


@check("bearing", BEARING_SOURCE, kind="hand", takes="statics", omits=BEARING_OMITS)
def bearing(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the transverse force on every loaded band over its projected area,
    F / (d L).
    """
    loads, material, margins = s.on_bands, s.material, list[Margin]()
    for i, name in enumerate(loads.surfaces):
        band = s.pin.band(name)
        size = np.hypot(loads.forces[:, i, 0], loads.forces[:, i, 1])
        t = int(size.argmax())
        if size[t] > 0.0:
            d, place = 2.0 * band.radius, WorstPlace.at_band(band, loads, t)
            shown = work(
                "σ", float(size[t]) / (d * band.length), "stress", "{F} / ({d} × {L})",
                F=(float(size[t]), "force"), d=(d, "length"), L=(band.length, "length"),
            )  # fmt: skip
            margins += text.at_levels(
                s, shown.result.value, place, material, material.yield_strength, "bearing",
                "F / (d L)", shown=(shown, partial(scaled, "thickness", band.length, power=1.0)),
            )  # fmt: skip
    return margins


@check(*BENDING_TEXTS["even"], kind="hand", takes="section forces", omits=NOMINAL_OMITS)
def bending(text: CheckText, s: Situation) -> list[Margin]:
    """The elastic bending stress M c / I, with each kind of section forces.

    With a hardened surface against that at which the case yields, or the core beneath it.
    """
    method, clause = BENDING_TEXTS[s.forces.kind]
    named = replace(text, method=method, clause=clause)
    strength, pin = s.material.yield_strength, s.pin
    if parts := s.material.strength_parts(pin.length):
        strength = linear_strength(parts, pin.largest_diameter / 2.0)
    return _along(named, s, s.forces.bending(), strength, BENDING_FORMULA)


def _along(
    text: CheckText,
    s: Situation,
    stress: NominalStress,
    strength: float | None,
    formula: str,
    ruptures: Rupture | None = None,
) -> list[Margin]:
    """Return the margins of a nominal stress that follows from the section forces."""
    place, basis = WorstPlace(stress.at, stress.z, stress.time), s.forces.basis
    resists, power = {BENDING_FORMULA: ("modulus", 3.0), "V / A": ("area", 2.0)}.get(
        formula, ("axis_area", 2.0)
    )
    passing = partial(wider, stress.section, power=power, resists=attrgetter(resists))
    return text.at_levels(
        s, stress.stress, place, s.material, strength, ruptures, formula, basis,
        (_shown(stress, formula), passing),
    )  # fmt: skip


def _shown(stress: NominalStress, formula: str) -> Work:
    """Return the work of a nominal stress in the worst section."""
    section, value = stress.section, stress.stress
    if formula == BENDING_FORMULA:
        return work(
            "σ", value, "stress", "{M} / {W}", M=(value * section.modulus, "moment"),
            W=(section.modulus, "length^3"),
        )  # fmt: skip
    ratio = 1.0 if formula == "V / A" else section.vq_it
    return work(
        "τ", value, "stress", "{k} × {V} / {A}", k=(ratio, "1"),
        V=(value * section.area / ratio, "force"), A=(section.area, "length^2"),
    )  # fmt: skip
