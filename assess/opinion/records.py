"""Results of the check against beam theory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats, Force, Forces, Length, Lengths, Moments, Stress, Stresses

COMPARISON_WINDOW = (0.3, 0.8)  # of the loaded length: away from the root and from the load's end


@dataclass(frozen=True)
class Difference:
    """The difference of elasticity's stress from the beam's, as parts of the beam's peak.

    It has the rms and the largest within the window, the largest anywhere and its z.
    """

    rms: float
    largest: float
    largest_anywhere: float
    largest_at: Length


@dataclass(frozen=True)
class BeamCheck:
    """A cantilever pin's axial stress, Pa, on its line in tension along z, m.

    It runs from the root to the end of the load on a `band`: by beam theory, and by elasticity with
    the load on the band's surface and on the axis (a bore of the diameter axis_bore).
    expected_offset*: how much exact elasticity is above beam theory while the load acts, away from
    the ends (assess.opinion.cantilever), Pa.
    """

    pin: str
    case: str
    connection: str
    force: Force
    diameter: Length
    axis_bore: Length
    band: tuple[Length, Length]
    z: Lengths
    shear: Forces
    moment: Moments
    beam_axial_stress: Stresses
    fea_axial_stress: Stresses
    fea_axial_stress_axis_load: Stresses
    expected_offset: Stress
    expected_offset_axis_load: Stress

    def difference(self, stress: Floats) -> Difference:
        """The difference of `stress` from the beam's."""
        z, beam = self.z, self.beam_axial_stress
        error = (stress - beam) / beam.max()
        loaded = z[-1]
        inside = (z >= COMPARISON_WINDOW[0] * loaded) & (z <= COMPARISON_WINDOW[1] * loaded)
        worst = int(np.abs(error).argmax())
        return Difference(
            rms=float(np.sqrt(np.mean(error[inside] ** 2))),
            largest=float(np.abs(error[inside]).max()),
            largest_anywhere=float(abs(error[worst])),
            largest_at=float(z[worst]),
        )

    @property
    def on_surface(self) -> Difference:
        """The difference with the load on the band's surface."""
        return self.difference(self.fea_axial_stress)

    @property
    def on_axis(self) -> Difference:
        """The difference with the load on the axis."""
        return self.difference(self.fea_axial_stress_axis_load)

    @property
    def on_surface_beyond_offset(self) -> Difference:
        """The same after the expected offset is added to the beam."""
        return self.difference(self.fea_axial_stress - self.expected_offset)

    @property
    def on_axis_beyond_offset(self) -> Difference:
        """The same after the expected offset is added to the beam."""
        return self.difference(self.fea_axial_stress_axis_load - self.expected_offset_axis_load)
