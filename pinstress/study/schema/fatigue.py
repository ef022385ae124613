"""Keys of the fatigue spectrum and of the fatigue data of materials in a study file."""

from typing import Annotated, Literal

from pydantic import Field

from pinstress.study.schema.types import Number, PositiveLength, Stress, StrictTable

Probability = Annotated[Number, Field(gt=0.0, lt=1.0)]
Slope = Annotated[Number, Field(ge=1.0, le=100.0)]


class SnTable(StrictTable):
    """A stress-life (Woehler) curve, of amplitudes at stress ratio -1 for the surface and size of
    the pin.
    """

    knee_stress: Stress
    """Amplitude at the knee of the curve."""
    knee_cycles: Annotated[Number, Field(ge=1.0, le=1e12)]
    """Cycles at the knee."""
    slope: Slope
    """Exponent k above the knee, N proportional to amplitude^-k."""
    slope_below: Slope | None = None
    """Exponent below the knee. Default: amplitudes below the knee do no damage."""
    scatter: Annotated[Number, Field(gt=1.0, le=1e6)] | None = None
    """Life at 90 % failure probability over that at 10 %. Default: lives have no scatter."""
    failure_probability: Probability = 0.5
    """Failure probability of the curve."""
    mean_stress: Literal["none", "fkm", "goodman", "swt", "walker"] = "fkm"
    """Correction for mean stress: "fkm" (Haigh diagram with `mean_stress_sensitivity`), "goodman"
    (with the material's `ultimate_strength`), "swt" (Smith, Watson, Topper), "walker" (with
    `walker_exponent`), or "none"."""
    mean_stress_sensitivity: Annotated[Number, Field(ge=0.0, lt=1.0)] | None = None
    """M: amplitudes of pulsating tension count 1 + M times. Needed by "fkm" and the critical
    plane."""
    walker_exponent: Annotated[Number, Field(gt=0.0, le=1.0)] | None = None
    """Exponent of the amplitude; 0.5 is "swt"."""


class FkmTable(StrictTable):
    """Data for the method "fkm-p-ram" (FKM guideline for local strains), with the material's
    `ultimate_strength`.
    """

    group: Literal["Steel", "SteelCast", "Al_wrought"]
    """Material group of the guideline."""
    roughness: PositiveLength
    """R_z of the surface."""
    plastic_factor: Annotated[Number, Field(ge=1.0, le=10.0)]
    """K_p: limit load over the load at first yield."""


class FatigueTable(StrictTable):
    """The numbers of occurrences of cases, and the method by which fatigue is assessed."""

    unit: str = "flight"
    """Name of the unit in which occurrences are counted."""
    occurrences: Annotated[
        dict[str, Annotated[Number, Field(gt=0.0, le=10_000.0)]], Field(min_length=1)
    ]
    """Number of occurrences per unit of each case or sequence, in the order in which they follow
    each other. Each begins and ends at zero load; between the steps of a sequence the load does not
    return to zero."""
    life: Annotated[Number, Field(gt=0.0)] | None = None
    """Design life in units. Default: no utilisation."""
    failure_probability: Probability | None = None
    """Failure probability for which damage is computed. Default: that of the S-N curve."""
    method: Literal["signed-von-mises", "critical-plane", "fkm-p-ram"] = "signed-von-mises"
    """Stress that is counted: the signed von Mises stress, Findley's critical plane, or local
    strains by the FKM guideline. Where a signed stress does not represent all components, the
    critical plane is used instead, or fatigue is not decided."""
