"""The contact of a pin in its lugs in one case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.support.bands import Bands
from fea.support.contact.bending import LoadedJoint
from fea.support.contact.contact_state import ContactState, wide_gap_half_angle
from fea.support.contact.pressure_loads import PressureLoads
from pinbase.arrays import Floats


@dataclass(frozen=True)
class JointContact(LoadedJoint):
    """The contact of a pin in its lugs in one case.

    angles: of the middles of the sectors from the first one, rad.
    contact: at each instant.
    """

    loads: PressureLoads
    angles: Floats
    contact: tuple[ContactState, ...]

    @property
    def contact_angle(self) -> Floats:
        """The half angle of contact at each band's ring where it is largest, (T, B) rad."""
        sector = self.angles[1] - self.angles[0]
        cells = np.stack([(state.pressure > 0.0).sum(axis=1) for state in self.contact])
        return self.bands.largest(0.5 * sector * cells)

    @property
    def largest_pressure(self) -> Floats:
        """The largest pressure on any cell of each band, (T, B) Pa.

        At edges it depends on the size of the cells.
        """
        return self.bands.largest(np.stack([x.pressure.max(axis=1) for x in self.contact]))

    def half_angle(self, bands: Bands, tail: Floats) -> float:
        """The half angle of contact, rad, where a ring is pressed most at the first instant.

        It is that of plane contact with a wide gap, at most a right angle, so that it does not
        depend on the cells.
        bands, tail: of the model of this contact (ContactModel), or of a model with other gaps.
        """
        # Rings under rounded edges count with the smallest gap of their band.
        load, gap = np.linalg.norm(self.line_load[0], axis=1), np.full(len(self.lugs), np.inf)
        np.minimum.at(gap, bands.band, bands.gap)
        half = wide_gap_half_angle(load, 4.0 * bands.radius / tail * gap[bands.band])
        half = np.where(load > 0.0, np.minimum(half, 0.5 * np.pi), 0.5 * np.pi)
        return float(half[(load / half).argmax()])
