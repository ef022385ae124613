"""The mesh of a pin, however its shape is given."""

from __future__ import annotations

from dataclasses import replace

from geometry.imported.imported_pin import SolidBody
from geometry.mesh import solid_mesh as turned
from geometry.mesh.cut_pin import CutPin
from geometry.mesh.elements import Element, with_element
from geometry.mesh.solid_mesh import MeshSize, SolidMesh
from geometry.shape.pin import Pin
from geometry.shape.pin_like import PinLike


def solid_mesh(
    pin: PinLike, size: MeshSize, edges: tuple[float, ...] = (), element: Element = "curved"
) -> SolidMesh:
    """Mesh a pin; `edges` are z (m) of further circles on the surface to refine at,
    which for a body from a file are the ends of its bands.

    Raises: MeshError.
    """
    if isinstance(pin, SolidBody):
        made = pin.mesh(size)
        return replace(made, mesh=with_element(made.mesh, element))
    assert isinstance(pin, Pin | CutPin)
    return turned.solid_mesh(pin, size, edges, element)
