"""The FKM guideline for local strains (nonlinear, 2019) with the damage parameter P_RAM, by pyLife.

Source: Fiedler, Wächter, Varfolomeev, Vormwald, Esderts: Richtlinie nichtlinear, Frankfurt 2019;
its P_RAJ is not used here.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from geometry.arrays import Floats

MaterialGroup = Literal["Steel", "SteelCast", "Al_wrought"]
PER_MPA, PER_MM = 1e6, 1e-3


@dataclass(frozen=True)
class FkmMaterial:
    """ultimate: R_m, Pa. roughness: R_z, m. plastic: K_p, limit load over the load at yield.
    area, gradient: highly stressed surface (m^2) and related stress gradient (1/m), which support
    the notch; by default they do not.
    """

    group: MaterialGroup
    ultimate: float
    roughness: float
    plastic: float
    area: float = 500e-6
    gradient: float = 0.0


@dataclass(frozen=True)
class FkmLife:
    """Cycles and repetitions of the sequence until failure; infinite: below the endurance limit.
    at: repetitions at failure probabilities, from the scatter of the guideline without its least
    safety factor; only of a life at 50 %.
    """

    cycles: float
    repetitions: float
    infinite: bool
    at: Callable[[float], float] | None = None


def p_ram_life(
    sequence: Floats,
    material: FkmMaterial,
    probability: float = 0.5,
    loads: tuple[float, float | None] = (50.0, None),
) -> FkmLife:
    """Life of a point under a sequence of elastic stress (T,) Pa, repeated, at a failure
    probability of at most 50 %. loads: probability P_L (%) that they do not exceed it, and their
    standard deviation (Pa).
    """
    import pandas
    from pylife.strength.fkm_nonlinear.assessment_nonlinear_standard import (
        perform_fkm_nonlinear_assessment,
    )

    asked = _parameters(material) | {"P_A": probability, "P_L": loads[0]}
    if loads[1] is not None:
        asked["s_L"] = loads[1] / PER_MPA
    with warnings.catch_warnings():  # pyLife 2.3 uses what pandas 3 deprecates
        warnings.simplefilter("ignore", DeprecationWarning)
        found = perform_fkm_nonlinear_assessment(
            pandas.Series(asked), pandas.Series(sequence / PER_MPA), calculate_P_RAJ=False
        )
    cycles, repetitions = (
        float(found[f"P_RAM_lifetime_n_{of}"]) for of in ("cycles", "times_load_sequence")
    )

    def at(wanted: float) -> float:
        return float(found["P_RAM_N_max_bearable"](wanted)) * repetitions / cycles

    scattered = "P_RAM_N_max_bearable" in found
    infinite = bool(found["P_RAM_is_life_infinite"])
    return FkmLife(cycles, repetitions, infinite, at if scattered else None)


def _parameters(material: FkmMaterial) -> dict[str, object]:
    """As pyLife calls them, in MPa and mm."""
    return {
        "MatGroupFKM": material.group,
        "FinishingFKM": "none",
        "R_m": material.ultimate / PER_MPA,
        "R_z": material.roughness / 1e-6,
        "c": 1.0,
        "A_sigma": material.area / PER_MM**2,
        "A_ref": 500.0,
        "G": material.gradient * PER_MM,
        "K_p": material.plastic,
    }
