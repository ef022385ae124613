"""The cuts of a pin converted to recesses."""

from __future__ import annotations

from geometry import CutPin, Recess
from geometry.imported.removed_solids import removed_solids
from geometry.mesh.cut_solid import cut_solid
from geometry.mesh.gmsh_session import gmsh_model
from tests.support.pins.pin_files import MM


def as_recesses(pin: CutPin) -> CutPin:
    """Return the pin with all that its cuts remove as recesses."""
    drawn = pin.scaled(1.0 / MM)
    with gmsh_model("P") as gmsh:
        body = cut_solid(gmsh, drawn.profile, drawn.cuts)
        recesses: list[Recess] = [
            one.recess.scaled(MM) for one in removed_solids(gmsh, body, drawn.profile)
        ]
    return CutPin(pin.profile, recesses)
