"""Fields on meshes: VTU files for ParaView, and pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from reports.picture import render_pin
from reports.renderer import renderer_problem
from reports.results import Field, Floats, Units

__all__ = ["point_data", "render_pin", "renderer_problem", "write_vtu"]

# From xx, yy, zz, yz, xz, xy to the order of VTK's symmetric tensors, XX YY ZZ XY YZ XZ.
VTK_SYMMETRIC = (0, 1, 2, 5, 3, 4)


def point_data(field: Field, units: Units) -> dict[str, Floats]:
    """Arrays at the nodes under names with units: displacement (N, 3), stress (N, 6: XX, YY, ZZ,
    XY, YZ, XZ, as ParaView names the components of a symmetric tensor), von Mises (N,), von Mises
    envelope (N,; NaN inside) and, with a yield strength, the factor of safety that follows from it.
    """
    stress = units.stress
    data = {
        f"displacement [{units.length}]": np.ascontiguousarray(field.displacement),
        f"stress [{stress}]": np.ascontiguousarray(field.stress[:, VTK_SYMMETRIC]),
        f"von Mises [{stress}]": np.ascontiguousarray(field.von_mises),
        f"von Mises envelope [{stress}]": np.ascontiguousarray(field.envelope),
    }
    if field.yield_strength is not None:
        lowest = np.finfo(np.float32).tiny * field.yield_strength  # a factor that is no infinity
        data["factor of safety"] = field.yield_strength / np.maximum(field.envelope, lowest)
    return data


def write_vtu(field: Field, path: Path, units: Units) -> None:
    """Write a VTU file (binary, compressed) with results at the nodes."""
    import meshio

    mesh = meshio.Mesh(
        points=field.points,
        cells=[(field.cell_type, field.cells)],
        point_data=point_data(field, units),
    )
    meshio.write(path, mesh, file_format="vtu", binary=True, compression="zlib")
