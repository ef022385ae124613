"""The FKM guideline for local strains (nonlinear, 2019) with the damage parameter P_RAM, by pyLife.

Source: Fiedler, Waechter, Varfolomeev, Voormann, Esderts: Richtlinie nichtlinear, Frankfurt 2019;
its P_RAJ is not used here.
"""

from __future__ import annotations

import warnings
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
    """Cycles and repetitions of the sequence until failure; infinite: below the endurance limit."""

    cycles: float
    repetitions: float
    infinite: bool


def p_ram_life(
    sequence: Floats,
    material: FkmMaterial,
    probability: float = 0.5,
    loads: tuple[float, float | None] = (50.0, None),
) -> FkmLife:
    """Life of a point under a sequence of elastic stress (T,) Pa, repeated. loads: probability P_L
    (%) that they do not exceed it, and their standard deviation (Pa).
    """
    import pandas
    from pylife.strength.fkm_nonlinear.assessment_nonlinear_standard import (
        perform_fkm_nonlinear_assessment,
    )

    exceeded, deviation = loads
    asked = {
        "MatGroupFKM": material.group,
        "FinishingFKM": "none",
        "R_m": material.ultimate / PER_MPA,
        "R_z": material.roughness / 1e-6,
        "P_A": probability,
        "P_L": exceeded,
        "c": 1.0,
        "A_sigma": material.area / PER_MM**2,
        "A_ref": 500.0,
        "G": material.gradient * PER_MM,
        "K_p": material.plastic,
    }
    if deviation is not None:
        asked["s_L"] = deviation / PER_MPA
    with warnings.catch_warnings():  # pyLife 2.3 uses what pandas 3 deprecates
        warnings.simplefilter("ignore", DeprecationWarning)
        found = perform_fkm_nonlinear_assessment(
            pandas.Series(asked), pandas.Series(sequence / PER_MPA), calculate_P_RAJ=False
        )
    return FkmLife(
        float(found["P_RAM_lifetime_n_cycles"]),
        float(found["P_RAM_lifetime_n_times_load_sequence"]),
        bool(found["P_RAM_is_life_infinite"]),
    )
