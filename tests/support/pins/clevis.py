"""A pin in the lugs of a clevis, and a study of it."""

from geometry import Pin, Segment

DIAMETER = 0.02
CLEVIS_PIN = Pin(
    "P",
    (
        Segment(0.002, DIAMETER),
        Segment(0.010, DIAMETER, connection="L"),
        Segment(0.001, DIAMETER),
        Segment(0.020, DIAMETER, connection="M"),
        Segment(0.001, DIAMETER),
        Segment(0.010, DIAMETER, connection="R"),
        Segment(0.002, DIAMETER),
    ),
)

CLEVIS = """
title = "A clevis"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"

[analysis]
required_safety_factor = 2
tolerance = 0.1

[case.pull]
kind = "given"
forces = { L = [-25000, 0], M = [50000, 0], R = [-25000, 0] }

[pin.P]
material = "steel"
profile = [
  { length = 2, diameter = 20 },
  { length = 10, diameter = 20, connection = "L" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "M" },
  { length = 1, diameter = 20 },
  { length = 10, diameter = 20, connection = "R" },
  { length = 2, diameter = 20 },
]

[pin.P.lug.L]
edge_radius = 1
[pin.P.lug.M]
edge_radius = 1
clearance = 0.01
tilt = "guided"
[pin.P.lug.R]
edge_radius = 1
"""
