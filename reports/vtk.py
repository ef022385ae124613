"""Fields on solid meshes and on surfaces: VTU files for ParaView, and pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from reports.picture import render_pin
from reports.renderer import renderer_problem
from reports.results import Field, Floats, Units

__all__ = ["point_data", "render_pin", "renderer_problem", "write_vtu"]

FACTOR = "factor of safety"
# From xx, yy, zz, yz, xz, xy to the order of VTK's symmetric tensors, XX YY ZZ XY YZ XZ.
VTK_SYMMETRIC = (0, 1, 2, 5, 3, 4)


def point_data(field: Field, units: Units) -> dict[str, Floats]:
    """Arrays at the nodes under names with units: displacement (N, 3), stress (N, 6: XX, YY, ZZ,
    XY, YZ, XZ, as ParaView names the components of a symmetric tensor), von Mises (N,), von Mises
    envelope (N,; NaN inside); with a yield strength also the factor of safety, yield over envelope.
    """
    stress = units.stress
    arrays = {
        f"displacement [{units.length}]": np.ascontiguousarray(field.displacement),
        f"stress [{stress}]": np.ascontiguousarray(field.stress[:, VTK_SYMMETRIC]),
        f"von Mises [{stress}]": np.ascontiguousarray(field.von_mises),
        f"von Mises envelope [{stress}]": np.ascontiguousarray(field.envelope),
    }
    if field.yield_strength is not None:
        arrays[FACTOR] = _factor(field.envelope, field.yield_strength)
    return arrays


def _factor(envelope: Floats, strength: float) -> Floats:
    """(N,): infinite where there is no stress, which ParaView leaves out of its colour scale; a
    large number there would take all of it. NaN where the envelope is.
    """
    with np.errstate(divide="ignore"):
        return np.asarray(strength / np.abs(envelope))


def write_vtu(field: Field, path: Path, units: Units) -> None:
    """Write a VTU file (binary, compressed) of the field's cells with results at the nodes."""
    import meshio

    mesh = meshio.Mesh(
        points=field.points,
        cells=[(field.cell_type, field.cells)],
        point_data=point_data(field, units),
    )
    meshio.write(path, mesh, file_format="vtu", binary=True, compression="zlib")
