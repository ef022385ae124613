"""The mesh of a pin, whatever the source of its shape."""

from __future__ import annotations

import math
from dataclasses import replace

from geometry.imported.imported_pin import SolidBody
from geometry.mesh import solid_mesh as turned
from geometry.mesh.cut_pin import CutPin
from geometry.mesh.elements import Element, with_element
from geometry.mesh.solid_mesh import MeshSize, SolidMesh
from geometry.shape.pin import Pin
from geometry.shape.pin_like import PinLike


def solid_mesh(
    pin: PinLike,
    size: MeshSize,
    edges: tuple[float, ...] = (),
    element: Element = "curved",
    most: float = math.inf,
) -> SolidMesh:
    """The mesh of a pin.

    edges: z of further circles on the surface at which the mesh is refined, m; a body from a file
    ignores them and is refined at the ends of its bands.
    element: kind of tetrahedra.
    most: largest number of unknowns of quadratic tetrahedra that is allowed.

    Raises: MeshError where the pin cannot be meshed.
    """
    if isinstance(pin, SolidBody):
        solid = pin.mesh(size, most)
        return replace(solid, mesh=with_element(solid.mesh, element))
    assert isinstance(pin, Pin | CutPin)
    return turned.solid_mesh(pin, size, edges, element, most)
