"""A pin as a cantilever: shear, moment and bending stress along z.

A stepped beam clamped at z = 0, which is statically determinate: no material enters. The stress at
the surface is M r / I. Source: any text on the mechanics of materials.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.beam.timoshenko import MOMENT, SHEAR, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from geometry import Pin
from geometry.arrays import Floats

_ANY = Material("any", 1.0, 0.0)


@dataclass(frozen=True)
class BeamForces:
    """Along z (m): shear (N), moment (N m) and axial stress (Pa) on the side that is in tension."""

    z: Floats
    shear: Floats
    moment: Floats
    stress: Floats


def cantilever(pin: Pin, forces: dict[str, float], z: Floats) -> BeamForces:
    """The beam at z (Z,) in m; transverse forces (N) in one plane by band, each uniform over it."""
    units = tuple(UnitLoad(name, "force", 1) for name in forces)
    beam = stepped_beam(pin, _ANY, units, ("start",))
    inside = beam.at(z) @ np.array(list(forces.values()))
    section = [beam.sections[c] for c in np.searchsorted(beam.stations[1:-1], z, side="right")]
    per_moment = np.array([s.outer / s.inertia for s in section])
    moment = inside[:, MOMENT]
    return BeamForces(z, inside[:, SHEAR], moment, moment * per_moment)
