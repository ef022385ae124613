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

import numpy as np

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin
from assess.situation import Situation
from assess.strength.hand_checks import BEARING_SOURCE, SHIGLEY_JOINTS, shear_yield
from fea.support.lugs.lug import Lug
from geometry import ArgumentError

BRUHN = "Bruhn, Analysis and Design of Flight Vehicle Structures, D1"
NET_SECTION_FORMULA = "F / ((W - D) t)"
SHEAR_OUT_FORMULA = "F / (t (sqrt(W^2 - (D sin 40°)^2) - D cos 40°))"
BEARING_FORMULA = "F / (d t)"
SHEAR_PLANE_ANGLE = math.radians(40.0)  # of shear-out, off the direction of the force
NET_SECTION = CheckText("lug, net section", SHIGLEY_JOINTS, "hand")
SHEAR_OUT = CheckText("lug, shear-out", BRUHN, "hand")
BEARING = CheckText("lug, bearing", BEARING_SOURCE, "hand")


def net_section_stress(force: float, outer: float, bore: float, thickness: float) -> float:
    """The net-section tension at the bore, Pa.

    force: N.
    outer, bore, thickness: diameters and thickness, m.

    Raises: ArgumentError where the eye is not wider than its bore. Source: as the module.
    """
    _require_eye(outer, bore)
    return force / ((outer - bore) * thickness)


def shear_out_stress(force: float, outer: float, bore: float, thickness: float) -> float:
    """The shear stress on the two planes by which the pin would push out a piece of the eye, Pa.

    Arguments, errors and source as `net_section_stress`.
    """
    _require_eye(outer, bore)
    across, along = bore * math.sin(SHEAR_PLANE_ANGLE), bore * math.cos(SHEAR_PLANE_ANGLE)
    length = (math.sqrt(outer**2 - across**2) - along) / 2.0
    return force / (2.0 * length * thickness)


def bearing_stress(force: float, diameter: float, thickness: float) -> float:
    """The bearing stress on the projected area in the bore, Pa.

    force: N.
    diameter, thickness: m.

    Source: as the module.
    """
    return force / (diameter * thickness)


@check("lug", SHIGLEY_JOINTS, kind="hand", takes="loads")
def lug_checks(_: CheckText, s: Situation) -> list[Margin]:
    """Net section, shear-out and bearing of every loaded lug whose size is given.

    They are checked at the instant when the force across the pin is largest. The lug is as thick as
    its band is long.
    """
    return [m for lug in s.sized if lug.connection in s.loads.surfaces for m in _of_lug(s, lug)]


def _of_lug(s: Situation, lug: Lug) -> list[Margin]:
    band = s.pin.band(lug.connection)
    x, y = s.loads.forces[:, s.loads.surfaces.index(lug.connection), :2].T
    size = np.hypot(x, y)
    t = int(size.argmax())
    force, thickness, W = float(size[t]), band.length, lug.outer_diameter
    if not force:
        return []
    # The pin bears on the bushing, if there is one, and that on the bore of the lug.
    inside = 2.0 * (band.radius + (lug.bushing.thickness if lug.bushing else 0.0))
    bore = inside if lug.bushing else inside + lug.clearance
    material, place = lug.material, WorstPlace.at_band(band, s.loads, t)
    net = net_section_stress(force, W, bore, thickness)
    out = shear_out_stress(force, W, bore, thickness)
    pressure, yields = bearing_stress(force, inside, thickness), material.yield_strength
    return [
        *NET_SECTION.at_levels(s, net, place, material, yields, "ultimate", NET_SECTION_FORMULA),
        *SHEAR_OUT.at_levels(
            s, out, place, material, shear_yield(material), "shear", SHEAR_OUT_FORMULA
        ),
        *BEARING.at_levels(s, pressure, place, material, yields, "bearing", BEARING_FORMULA),
    ]


def _require_eye(outer: float, bore: float) -> None:
    if not 0.0 < bore < outer:
        raise ArgumentError(
            f"the eye of a lug must be wider than its bore of {bore:g} m, not {outer:g} m",
            "out-of-range",
        )
