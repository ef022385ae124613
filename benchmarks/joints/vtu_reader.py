"""An independent reader of the surface of a pin that uses only the folder of a run.

pyvista opens the VTU files, and results.json lists the cells on which lugs press. No code of the
program is used: neither its mask of the pressed surface, nor its von Mises stress, which is
computed here from the tensor.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Row = dict[str, Any]

NEAR = 1e-6  # of a cell; a node nearer than this to its end is on it, as files have seven digits
INSIDE = 0.05  # of a cell; nodes farther than this from its ends are on the band only
OUTSIDE = 1e-3  # of the radius
FILE = 1e-5  # of the stress; error by the seven digits of six components


@dataclass(frozen=True)
class SurfaceRead:
    """The row of a pin and case compared with the stress read on its surface, in the units of the
    study.

    row, upper: the row's maximum and its upper end. governs: the place that governs the row.
    read: the largest stress read in `file`. z, angle: its place, the angle in degrees.
    aside: distance along z, in cells, from the nearest pressed cell at this angle; inf if there is
    none.
    cell: the length of this cell.
    """

    pin: str
    case: str
    file: str
    row: float
    upper: float
    governs: str
    read: float
    z: float
    angle: float
    aside: float
    cell: float

    @property
    def violates(self) -> bool:
        """Whether the surface has more stress than the row with its error."""
        return self.read > self.upper * (1.0 + FILE)

    def __str__(self) -> str:
        return (
            f"{self.pin}, {self.case}, {self.file}: {self.read:.5g} at z {self.z:.6g}, "
            f"{self.angle:.1f} degrees, {self.aside:.2f} cells of {self.cell:.4g} from pressure; "
            f"the row has {self.row:.5g}, at most {self.upper:.5g}, by its {self.governs}"
        )


def read_folder(folder: Path, grown: float = 0.0) -> list[SurfaceRead]:
    """Return the values read for every row in contact that has VTU files, also on the outside of
    its solids.

    grown: number of cells, at most 1, by which the pressed area is enlarged on every side.

    Raises: ValueError for another `grown`.
    """
    if not 0.0 <= grown <= 1.0:
        raise ValueError("pressed cells may be grown by one cell at most")
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    unit, out = results["units"]["stress"], []
    for row in results["pins"]:
        if row.get("contact") is None or row["max_von_mises"] is None:
            continue
        name = f"{row['pin']}_{row['case']}"
        for file in (f"{name}.vtu", f"{name}/solid.vtu", f"{name}/local.vtu"):
            path = folder / "vtk" / file
            if path.exists():
                body = pyvista.read(path).extract_surface(algorithm="dataset_surface")
                out.append(_read(row, file, body, unit, grown))
    return out


def _read(row: Row, file: str, body: Any, unit: str, grown: float) -> SurfaceRead:
    points = np.asarray(body.points, dtype=float)
    stress = von_mises(np.asarray(body.point_data[f"stress [{unit}]"], dtype=float))
    cells = np.array([cell for band in row["contact"]["bands"] for cell in band["pressed"]])
    stress[shut(points, cells, grown)] = 0.0
    at = int(stress.argmax())
    x, y, z = points[at]
    aside, cell = _aside(points[at], cells)
    return SurfaceRead(
        row["pin"], row["case"], file, row["max_von_mises"], upper(row), row["governs"],
        float(stress[at]), float(z), float(np.degrees(np.arctan2(y, x))), aside, cell,
    )  # fmt: skip


def upper(row: Row) -> float:
    """Return the upper end of a row's maximum; for a singular row the end of its interval."""
    interval = row["max_von_mises_interval"]
    if interval is None:
        return float(row["max_von_mises"] + row["error_estimate"])
    return float(np.inf if interval[1] is None else interval[1])


def von_mises(s: Floats) -> Floats:
    """Return the von Mises stress of tensors (N, 6) in VTK's order: XX, YY, ZZ, XY, YZ, XZ."""
    direct = (s[:, 0] - s[:, 1]) ** 2 + (s[:, 1] - s[:, 2]) ** 2 + (s[:, 2] - s[:, 0]) ** 2
    return np.asarray(np.sqrt(0.5 * direct + 3.0 * (s[:, 3:] ** 2).sum(axis=1)))


def shut(points: Floats, cells: Floats, grown: float) -> NDArray[np.bool_]:
    """Return which points (N, 3) are on pressed cells, including their enlarged edges.

    cells: (M, 4), start z, end z, start and end angle in degrees. Points in a bore are on no cell:
    cells are on the outermost surface between their ends.
    """
    out = np.zeros(len(points), dtype=bool)
    angle, z = np.degrees(np.arctan2(points[:, 1], points[:, 0])), points[:, 2]
    radius = np.hypot(points[:, 0], points[:, 1])
    for z0, z1 in np.unique(cells[:, :2], axis=0):
        more = (grown + NEAR) * (z1 - z0)
        within = (z > z0 + INSIDE * (z1 - z0)) & (z < z1 - INSIDE * (z1 - z0))
        near = (z >= z0 - more) & (z <= z1 + more)
        if not within.any():  # the cell has nodes only at its ends
            within = near
        near &= radius > (1.0 - OUTSIDE) * radius[within].max()
        for low, high in cells[(cells[:, 0] == z0) & (cells[:, 1] == z1), 2:]:
            turn = np.abs((angle - 0.5 * (low + high) + 180.0) % 360.0 - 180.0)
            out |= near & (turn <= (0.5 + grown + NEAR) * (high - low))
    return out


def _aside(point: Floats, cells: Floats) -> tuple[float, float]:
    """Return the distance along z of the nearest pressed cell at the angle of a point, in lengths
    of this cell, and this length.
    """
    angle = np.degrees(np.arctan2(point[1], point[0]))
    turn = np.abs((angle - 0.5 * (cells[:, 2] + cells[:, 3]) + 180.0) % 360.0 - 180.0)
    own = cells[turn <= 0.5 * (cells[:, 3] - cells[:, 2]) * (1.0 + NEAR)]
    if not len(own):
        return np.inf, np.nan
    away = np.maximum(own[:, 0] - point[2], point[2] - own[:, 1]).clip(0.0)
    k = int(away.argmin())
    length = own[k, 1] - own[k, 0]
    return float(away[k] / length), float(length)
