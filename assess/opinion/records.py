"""Results of the check against beam theory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats, Force, Forces, Length, Lengths, Moments, Stress, Stresses

COMPARISON_WINDOW = (0.3, 0.8)  # of the length, away from the root and from the end of the load


@dataclass(frozen=True)
class Difference:
    """The difference between the stress by elasticity and the beam's, relative to the beam's peak.

    rms, largest: within the comparison window. largest_anywhere, largest_at: over the whole length,
    and its z.
    """

    rms: float
    largest: float
    largest_anywhere: float
    largest_at: Length


@dataclass(frozen=True)
class BeamCheck:
    """The axial stress of a cantilever pin, Pa, on its tension line along z, m, from the root to
    the end of the load on a `band`.

    The stress is by beam theory, and by elasticity with the load on the band's surface and with the
    load on the axis (a bore of diameter axis_bore).
    expected_offset, expected_offset_axis_load: amount by which exact elasticity exceeds beam theory
    under the load, away from the ends (assess.opinion.cantilever), Pa.
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
        """Return the difference between `stress` and the beam's."""
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
        """The difference `on_surface` after the expected offset is added to the beam's stress."""
        return self.difference(self.fea_axial_stress - self.expected_offset)

    @property
    def on_axis_beyond_offset(self) -> Difference:
        """The difference `on_axis` after the expected offset is added to the beam's stress."""
        return self.difference(self.fea_axial_stress_axis_load - self.expected_offset_axis_load)
