"""Hand checks of the lugs in which a pin sits: net section, shear-out, bearing.

Nominal stresses of an eye of outer diameter W, bore D and thickness t, on a pin of diameter d, as
if its link pulled with the largest force F of the case:

    net section    F / ((W - D) t)
    shear-out      F / (2 L t),  L = (sqrt(W^2 - (D sin 40)^2) - D cos 40) / 2
    bearing        F / (d t)

The shear planes run along the force from the bore, 40 degrees off it, to the outer edge: L is their
length in a round eye, at most 5 % less than the W / 2 - D / 2 cos 40 of a square end if W >= 2.5 D.
They are compared with yield, in shear with yield over sqrt(3) (von Mises); yield as the strength in
bearing is a convention. Neither the stress concentration at the bore nor a load across the link is
in them.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, 8-12 (net section,
edge shear, bearing); E. F. Bruhn, Analysis and Design of Flight Vehicle Structures, D1 (planes at
40 degrees); ANSI/AISC 360, D5 and J7 have the same net section and bearing area.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from assess.strength.hand_checks import BEARING_SOURCE, SHIGLEY_JOINTS
from assess.strength.records import HandCheck
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, Pin

BRUHN = "Bruhn, Analysis and Design of Flight Vehicle Structures, D1"
NET_SECTION_FORMULA = "F / ((W - D) t)"
SHEAR_OUT_FORMULA = "F / (t (sqrt(W^2 - (D sin 40°)^2) - D cos 40°))"
BEARING_FORMULA = "F / (d t)"
SHEAR_PLANE_ANGLE = math.radians(40.0)  # of shear-out, off the direction of the force
NO_BUSHING_BORES: Mapping[str, float] = MappingProxyType({})


def net_section_stress(force: float, outer: float, bore: float, thickness: float) -> float:
    """Net-section tension at the bore, Pa; N, and diameters and thickness in m.

    Raises: ArgumentError where the eye is not wider than its bore. Source: as the module.
    """
    _require_eye(outer, bore)
    return force / ((outer - bore) * thickness)


def shear_out_stress(force: float, outer: float, bore: float, thickness: float) -> float:
    """Shear on the two planes by which the pin would push out a piece of the eye, Pa; arguments,
    Raises and Source as `net_section_stress`.
    """
    _require_eye(outer, bore)
    across, along = bore * math.sin(SHEAR_PLANE_ANGLE), bore * math.cos(SHEAR_PLANE_ANGLE)
    length = (math.sqrt(outer**2 - across**2) - along) / 2.0
    return force / (2.0 * length * thickness)


def bearing_stress(force: float, diameter: float, thickness: float) -> float:
    """On the projected area of what is in the bore, Pa. Source: as the module."""
    return force / (diameter * thickness)


def lug_checks(
    pin: Pin,
    lugs: Sequence[Lug],
    loads: PinLoads,
    bores: Mapping[str, float] = NO_BUSHING_BORES,
) -> tuple[HandCheck, ...]:
    """Three checks of every loaded lug, at the instant when the force across the pin is largest.

    pin: with a band for each lug, not cut into rings; the lug is as thick as its band is long.
    bores: diameters of bores that hold a bushing, m, by connection; others fit the pin.

    Raises: ArgumentError as `net_section_stress`; GeometryError for a band that the pin has not.
    """
    return tuple(
        check
        for lug in lugs
        if lug.connection in loads.surfaces
        for check in _of_lug(pin, lug, loads, bores.get(lug.connection))
    )


def _of_lug(pin: Pin, lug: Lug, loads: PinLoads, bushed: float | None) -> tuple[HandCheck, ...]:
    band = pin.band(lug.connection)
    x, y = loads.forces[:, loads.surfaces.index(lug.connection), :2].T
    size = np.hypot(x, y)
    t = int(size.argmax())
    force, thickness, W = float(size[t]), band.length, lug.outer_diameter
    if not force:
        return ()
    inside = bushed or 2.0 * band.radius
    bore = bushed or inside + lug.clearance
    yields = lug.material.yield_strength
    in_shear = yields / math.sqrt(3.0) if yields else None
    net = net_section_stress(force, W, bore, thickness)
    out = shear_out_stress(force, W, bore, thickness)
    found = (
        ("lug, net section", net, yields, NET_SECTION_FORMULA, SHIGLEY_JOINTS, "ultimate"),
        ("lug, shear-out", out, in_shear, SHEAR_OUT_FORMULA, BRUHN, "shear"),
        (
            *("lug, bearing", bearing_stress(force, inside, thickness), yields),
            *(BEARING_FORMULA, BEARING_SOURCE, "bearing"),
        ),
    )
    time = None if loads.times is None else float(loads.times[t])
    at, made_of = (band.name, band.middle, time), lug.material.name
    return tuple(
        HandCheck(name, *at, stress, strength, formula, source, made_of, ruptures)
        for name, stress, strength, formula, source, ruptures in found
    )


def _require_eye(outer: float, bore: float) -> None:
    if not 0.0 < bore < outer:
        raise ArgumentError(
            f"the eye of a lug must be wider than its bore of {bore:g} m, not {outer:g} m",
            "out-of-range",
        )
