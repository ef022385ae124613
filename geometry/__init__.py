"""Geometry: a pin as a body of revolution with cuts, its exact volume, and its solid mesh.

Lengths are in m. Of the other packages here, it imports only `pinbase`. `geometry.mesh.solid_mesh`
needs meshio, scikit-fem and gmsh and is therefore not imported here.
"""

from geometry.mesh.cut_pin import CutPin
from geometry.shape.band import Band, GeometryError
from geometry.shape.corners import Vertex, vertices
from geometry.shape.drill import Bottom
from geometry.shape.features import Cut
from geometry.shape.hole import Hole
from geometry.shape.milled import Flat, Slot
from geometry.shape.passage import Passage
from geometry.shape.pin import Pin
from geometry.shape.pin_like import PinLike, body_of_revolution
from geometry.shape.profile import Arc, Edge, meridian, sharp_corners
from geometry.shape.recess import Recess
from geometry.shape.segment import Segment
from pinbase.errors import ArgumentError, CodedError
