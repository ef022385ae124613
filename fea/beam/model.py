"""The result of the beam model for one case, in the form that the other models have."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from fea.beam.error_model import BeamEstimate, beam_estimate
from fea.beam.line_load import acting
from fea.beam.maximum import StressAlongBeam, harmonics, von_mises_maxima
from fea.beam.stress import BeamStress, beam_stress
from fea.core.material import Material
from fea.core.mesh_result import MeshMaximum, at_angle
from fea.core.peak import ErrorParts, Reason, Refinement
from fea.core.pin_loads import LoadAmounts, Loads, PinLoads
from fea.core.verdict import Evidence
from fea.core.zone import Zone
from fea.singular.singularities import outside
from geometry import Pin
from pinbase.arrays import Floats


class BeamField(StressAlongBeam):
    """The stress of a pin as a beam under the unit loads of a case."""

    def __init__(
        self, pin: Pin, material: Material, clamps: tuple[str, ...], case: PinLoads
    ) -> None:
        self.pin, self.case, self.clamps = pin, case, clamps
        self._beam: BeamStress = beam_stress(pin, material, acting(case), clamps)
        self.at = self._beam.points

    @cached_property
    def estimate(self) -> BeamEstimate:
        """The beam's estimate of the largest stress of the case."""
        return beam_estimate(self._beam, self.case, self.clamps)

    def harmonics(self, loads: Loads) -> Floats:
        """The stress (3, S, 6, T), Pa, of the superposed unit loads."""
        return harmonics(self._beam, loads)

    def result(self, singularities: Sequence[Zone]) -> MeshMaximum:
        """The largest stress outside the singular zones, in the form of the other models."""
        maxima = von_mises_maxima(self.harmonics(self.case))
        r, z = self.at.T
        value = np.where(outside(singularities, r, z)[:, None], maxima.von_mises, 0.0)
        point, instant = (int(i) for i in np.unravel_index(value.argmax(), value.shape))
        location = at_angle(self.at[point], maxima.theta[point, instant])
        return MeshMaximum(0, float(value[point, instant]), instant, location)

    @property
    def strain_energy(self) -> float:
        """The strain energy, J, of the loads that have a resultant, at the instant of the largest
        stress.
        """
        coefficients = self.case.coefficients()
        felt = {unit: coefficients[unit] for unit in self._beam.forces.loads}
        amounts = LoadAmounts(self.case.case, felt, len(self.case))
        return self._beam.energy.of(amounts, self.estimate.instant)

    def evidence(self, seconds: float, remarks: Reason, rise: float = 0.0) -> Evidence:
        """The maximum with the beam's own error, which is as large as the value where it is not
        known.

        rise: how much higher the maximum may be between instants, Pa.
        """
        estimate, doubt = self.estimate, None
        whole = estimate.maximum if estimate.error is None else estimate.error
        if estimate.without_factor:
            notches = ", ".join(estimate.without_factor)
            doubt = Reason(
                f"no notch factor is available for {notches}, so the stress there is not included",
                ("no-notch-factor",),
            )
        return Evidence(
            pin=self.pin.name,
            case=self.case.case,
            model="beam",
            value=estimate.maximum,
            parts=ErrorParts(mesh=0.0, time=rise, model=whole),
            location=at_angle(estimate.place, estimate.theta),
            history=(Refinement(0, estimate.maximum, seconds, self.strain_energy),),
            doubt=doubt,
            omissions=Reason(f". {estimate.leaves_out.rstrip('.')}"),
            remarks=remarks,
            governing=self.case.at(np.array([estimate.instant])),
        )
