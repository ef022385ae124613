"""Geometry: a pin as a body of revolution, its exact volume, and its solid mesh.

Lengths in m. This room imports nothing else of ours. `geometry.solid_mesh` needs meshio, scikit-fem
and gmsh and is therefore not imported here.
"""

from geometry.meridian import Arc, Corner, Edge, meridian, sharp_corners
from geometry.pin import Band, GeometryError, Pin, Segment
from geometry.pin_like import PinLike

__all__ = [
    "Arc",
    "Band",
    "Corner",
    "Edge",
    "GeometryError",
    "Pin",
    "PinLike",
    "Segment",
    "meridian",
    "sharp_corners",
]
