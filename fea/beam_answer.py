"""The beam's answer for one case, in the words of the ladder."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from fea.answer import Picture
from fea.beam_error import BeamEstimate, beam_estimate
from fea.beam_peak import harmonics, highest
from fea.beam_stress import BeamStress, beam_stress
from fea.line_load import acting
from fea.look import Look
from fea.material import Material
from fea.peak import Peak, Refinement
from fea.pin_loads import Floats, PinLoads
from fea.zones import Place, outside
from geometry import Pin


class BeamAnswer:
    """A pin as a beam, with the unit loads of a case."""

    def __init__(
        self, pin: Pin, material: Material, clamps: tuple[str, ...], case: PinLoads
    ) -> None:
        self.pin, self.case, self.clamps = pin, case, clamps
        self._beam: BeamStress = beam_stress(pin, material, acting(case), clamps)

    @cached_property
    def estimate(self) -> BeamEstimate:
        """Of the largest stress of the case."""
        return beam_estimate(self._beam, self.case, self.clamps)

    def maxima(self, loads: PinLoads) -> Floats:
        """Largest von Mises stress (T,) Pa at every instant."""
        return np.asarray(highest(harmonics(self._beam, loads)).von_mises.max(axis=0))

    def look(self, places: Sequence[Place]) -> Look:
        """The largest stress outside the places, as the other models tell it."""
        found = highest(harmonics(self._beam, self.case))
        r, z = self._beam.points.T
        value = np.where(outside(places, r, z)[:, None], found.von_mises, 0.0)
        point, instant = (int(i) for i in np.unravel_index(value.argmax(), value.shape))
        at, theta = float(r[point]), float(found.theta[point, instant])
        location = (at * math.cos(theta), at * math.sin(theta), float(z[point]))
        return Look(0, float(value[point, instant]), instant, location)

    def picture(self, loads: PinLoads, instant: int) -> Picture | None:
        """None: a beam has no field over its surface."""
        return None

    def peak(self, tolerance: float, seconds: float, note: str) -> Peak:
        """The peak with the beam's own error; where it has none, that of the whole value."""
        found = self.estimate
        r, z = found.place
        error = found.maximum if found.error is None else found.error
        relative = error / found.maximum if found.maximum else 0.0
        known = found.error is not None and relative <= tolerance
        if found.without_factor:
            told = f"no notch factor for {', '.join(found.without_factor)}: not the maximum there"
        else:
            told = f"known to {relative:.0%}" + (
                "" if known else f" only, {tolerance:.1%} was asked for"
            )
        return Peak(
            pin=self.pin.name,
            case=self.case.case,
            model="beam",
            verdict="converged" if known else "unconverged",
            note=f"{told}. {found.leaves_out.rstrip('.')}{note}",
            max_von_mises=found.maximum,
            error_estimate=error,
            location=(r * math.cos(found.theta), r * math.sin(found.theta), z),
            instant=found.instant,
            history=(Refinement(0, found.maximum, seconds),),
        )
