"""The solved load case that is differentiated, and its derivatives."""

from __future__ import annotations

from dataclasses import dataclass

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone
from fea.harmonic.section_solution import HarmonicSolution
from geometry import Pin


@dataclass(frozen=True)
class SolvedCase:
    """A pin solved on one mesh under the loads of one instant.

    clamps: the names of the clamped surfaces.
    zones: the excluded zones at singularities.
    error: the relative error of the maximum.
    history: the loads at all instants of the case, if there are more.
    """

    pin: Pin
    material: Material
    clamps: tuple[str, ...]
    loads: PinLoads
    solution: HarmonicSolution
    zones: tuple[Zone, ...]
    error: float = 0.0
    history: PinLoads | None = None


@dataclass(frozen=True)
class Derivatives:
    """Derivatives of the largest von Mises stress `maximum`, Pa, at the governing instant.

    location: (x, y, z), m.
    by_dimension: Pa/m, by the key of each dimension.
    without: for each dimension without a derivative, the reason.
    by_force, by_moment: Pa/N and Pa/(N m), by surface and axis of the pin ("x", "y", "z"), with the
    other loads unchanged.
    poisson_ratio: Pa.
    youngs_modulus: 0, because the stress of a pin under given loads does not depend on it.
    density: Pa/(kg/m^3), through the pin's own weight.
    tied_places, tied_times: other places (r, z), m, and times, s, whose stress is within the error
    of the maximum. Any of them may govern as soon as anything changes, so that the derivatives are
    then one-sided.
    """

    maximum: float
    location: tuple[float, float, float]
    by_dimension: dict[str, float]
    without: dict[str, str]
    by_force: dict[tuple[str, str], float]
    by_moment: dict[tuple[str, str], float]
    poisson_ratio: float
    density: float
    tied_places: tuple[tuple[float, float], ...] = ()
    tied_times: tuple[float, ...] = ()
    youngs_modulus: float = 0.0
