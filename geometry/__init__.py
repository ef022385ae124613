"""Geometry: a pin as a body of revolution, its exact volume, and its solid mesh.

Lengths in m. This room imports nothing else of ours. `geometry.solid_mesh` needs meshio, scikit-fem
and gmsh and is therefore not imported here.
"""

from geometry.cut_pin import CutPin
from geometry.features import Flat, Hole
from geometry.meridian import Arc, Corner, Edge, meridian, sharp_corners
from geometry.pin import Band, GeometryError, Pin, Segment
from geometry.pin_like import PinLike
from geometry.vertices import Vertex, vertices

__all__ = [
    "Arc",
    "Band",
    "Corner",
    "CutPin",
    "Edge",
    "Flat",
    "GeometryError",
    "Hole",
    "Pin",
    "PinLike",
    "Segment",
    "Vertex",
    "meridian",
    "sharp_corners",
    "vertices",
]
