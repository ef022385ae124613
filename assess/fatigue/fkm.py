"""The FKM guideline for local strains (nonlinear, 2019) with the damage parameter P_RAM, by pyLife.

Source: Fiedler, Wächter, Varfolomeev, Vormwald, Esderts: Richtlinie nichtlinear, Frankfurt 2019;
its P_RAJ is not used here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Literal

import numpy as np

from assess.fatigue.quiet import quiet
from pinbase.arrays import Floats

if TYPE_CHECKING:
    import pandas

MaterialGroup = Literal["Steel", "SteelCast", "Al_wrought"]
PA_PER_MPA, M_PER_MM = 1e6, 1e-3


@dataclass(frozen=True)
class FkmMaterial:
    """The data of a material and a notch for the FKM guideline.

    ultimate: R_m, Pa.
    roughness: R_z, m.
    plastic: K_p, the ratio of the limit load to the load at first yield.
    area, gradient: highly stressed surface (m^2) and related stress gradient (1/m), which give the
    notch support; no support by default.
    """

    group: MaterialGroup
    ultimate: float
    roughness: float
    plastic: float
    area: float = 500e-6
    gradient: float = 0.0


@dataclass(frozen=True)
class FkmLife:
    """The cycles, and the repetitions of the sequence, until failure.

    infinite: whether the sequence is below the endurance limit.
    at: a function from a failure probability to the repetitions, by the scatter of the guideline
    without its minimum safety factor; only for a life at 50 %, else None.
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
    """Return the life of a point under a repeated sequence of elastic stress.

    sequence: (T,) Pa.
    probability: failure probability, at most 0.5.
    loads: probability P_L (%) that the loads do not exceed the sequence, and the standard deviation
    of the loads (Pa).
    """
    import pandas
    from pylife.strength.fkm_nonlinear.assessment_nonlinear_standard import (
        perform_fkm_nonlinear_assessment,
    )

    parameters = _parameters(material) | {"P_A": probability, "P_L": loads[0]}
    if loads[1] is not None:
        parameters["s_L"] = loads[1] / PA_PER_MPA
    with quiet():
        assessment = perform_fkm_nonlinear_assessment(
            pandas.Series(parameters), pandas.Series(sequence / PA_PER_MPA), calculate_P_RAJ=False
        )
        infinite = bool(assessment["P_RAM_is_life_infinite"])
    cycles, curve = assessment["P_RAM_collective"], assessment["P_RAM_woehler_curve"]
    bearable = assessment.get("P_RAM_N_max_bearable")

    def at(wanted: float) -> float:
        with quiet():
            bearable(wanted)  # stores the damage at this probability in the calculator
        calculated = assessment["P_RAM_damage_calculator"].collective
        return _repetitions(calculated, calculated["D"].to_numpy(dtype=float))

    parameter, closed = (cycles[x].to_numpy() for x in ("P_RAM", "is_closed_hysteresis"))
    ratio = np.nan_to_num(parameter.astype(float) / float(curve.P_RAM_Z))
    slope = np.where(ratio >= 1.0, 1.0 / curve.d_1, 1.0 / curve.d_2)
    damage = np.where(closed, 1.0, 0.5) * 1e-3 * ratio**-slope
    repetitions = _repetitions(cycles, damage)
    count = int((cycles["run_index"] == 2).sum())
    never = infinite or repetitions == inf
    return FkmLife(count * repetitions, repetitions, never, None if bearable is None else at)


def _repetitions(cycles: pandas.DataFrame, damage: Floats) -> float:
    """Return the repetitions of the sequence until failure, by equation 2.6-90 of the guideline.

    If failure occurs within the first or the second run, a fraction of that run counts; pyLife has
    no rule for this. A cycle in compression has no P_RAM and does no damage.

    damage: (C,) of the cycles in the first and the second run.
    """
    run = cycles["run_index"].to_numpy()
    first, second = (float(np.nansum(damage[run == n])) for n in (1, 2))
    if first >= 1.0:
        return 1.0 / first
    return 1.0 + (1.0 - first) / second if second > 0.0 else inf


def _parameters(material: FkmMaterial) -> dict[str, object]:
    """Return the parameters under pyLife's names, in MPa and mm (R_z in micrometres)."""
    return {
        "MatGroupFKM": material.group,
        "FinishingFKM": "none",
        "R_m": material.ultimate / PA_PER_MPA,
        "R_z": material.roughness / 1e-6,
        "c": 1.0,
        "A_sigma": material.area / M_PER_MM**2,
        "A_ref": 500.0,
        "G": material.gradient * M_PER_MM,
        "K_p": material.plastic,
    }
