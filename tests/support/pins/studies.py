"""Studies of pins that several tests modify."""

import tomlkit

from pinstress.explore.size.scaled_study import resized
from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.study.schema.units import UnitSystem


def resized_text(
    text: str,
    scales: dict[str, float],
    system: UnitSystem,
    standard: StandardDiameters | None = None,
    required: float | None = None,
) -> str:
    """Return a study's text with pins (by name) scaled across their axis."""
    return tomlkit.dumps(resized(text, scales, system, standard, required))


# Two pins of different materials, both solved by harmonic models.
TWO_PINS = """
title = "Two pins"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
yield_strength = "600 MPa"
[material.bronze]
youngs_modulus = "110 GPa"
poisson_ratio = 0.34
[pin.A]
material = "steel"
clamp = ["start"]
profile = [{ length = 20, diameter = 30 }, { length = 40, diameter = 20, connection = "A" }]
fillet = 4
[pin.B]
material = "bronze"
clamp = ["start"]
profile = [{ length = 10, diameter = 31 }, { length = 20, diameter = 24, connection = "B" }]
fillet = 3
[case.press]
kind = "given"
forces = { A = [30.0, 40.0], B = [0.0, 90.0] }
[analysis]
model = "harmonic"
tolerance = 0.2
"""

# The same pin by segments and by corners, with a cone, a bore and a fillet.
BY_SEGMENTS_AND_CORNERS = """
title = "The same pin by segments and by corners"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  { length = 40, diameter = 20, bore = 8 },
  { length = 10, diameter = [20, 30], bore = 8 },
  { length = 30, diameter = 30, bore = 8, connection = "B", edge_radius = 1 },
]
fillet = 2
[pin.M]
material = "steel"
clamp = ["start"]
meridian = [[0, 10], [40, 10, 2], [50, 15], [80, 15, 1]]
bore_meridian = [[0, 4], [80, 4]]
band.C = { z = [50, 80] }
[case.push]
kind = "given"
forces = { B = [0, 1000], C = [0, 1000] }
"""

# The profile of the pin of a clevis: its bands and the segments between them.
DOUBLE_SHEAR = """[
  { length = 10, diameter = 20, connection = "L" }, { length = 1, diameter = 20, name = "gap" },
  { length = 20, diameter = 20, connection = "M" }, { length = 1, diameter = 20 },
  { length = 10, diameter = 20, connection = "R" },
]"""
