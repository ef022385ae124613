"""Reading a run's folder for `view`, `compare` and `plots`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from loads import MB
from pinbase.dimensions import Floats
from pinbase.errors import Damaged
from reports.data.fields import Field
from reports.data.row import Units
from reports.folder.inside import read_inside
from reports.folder.results_json import read_results
from reports.format.numbers import engineering
from reports.format.words import verdict_words
from reports.vtk.fields import VTK_TENSOR_ORDER
from reports.vtk.vtu import Vtu, read_vtu

MAX_FIELD_SIZE = 2048 * MB
MAX_COORDINATE = 1e15  # VTK computes with squares of coordinates in float32


@dataclass(frozen=True)
class Opened:
    """A results folder with the content of its results.json."""

    directory: Path
    content: dict[str, Any]

    @property
    def units(self) -> Units:
        """The units of all numbers in the folder."""
        names = ("length", "force", "stress", "time")
        return Units(*(self.content["units"][name] for name in names))

    def row(self, pin: str | None, case: str | None) -> dict[str, Any]:
        """Return the row of a pin and case; of several the one with the smallest safety factor.

        Raises: ValueError, with the names of the existing rows.
        """
        rows = self.content["pins"]
        matches = [r for r in rows if r["pin"] == (pin or r["pin"])]
        matches = [r for r in matches if r["case"] == (case or r["case"])]
        if not matches:
            known_rows = ", ".join(f"{r['pin']} in {r['case']}" for r in rows) or "none"
            wanted = " in ".join(name for name in (pin, case) if name)
            raise ValueError(f"no {wanted or 'pin'}; there are {known_rows}")
        # Without a yield strength, the row with the largest stress is returned.
        return min(
            matches, key=lambda r: (r["safety_factor"] or np.inf, -(r["max_von_mises"] or 0))
        )

    def title(self, row: dict[str, Any]) -> str:
        """Return the pin, the case, and the factor with its verdict."""
        text = f"pin {row['pin']}, {row['case']}"
        if row["safety_factor"] is not None:
            text += f": factor of safety {engineering(row['safety_factor'])}"
        return f"{text} ({verdict_words(row['verdict'], row['yields'])})"

    def only(self, row: dict[str, Any]) -> Opened:
        """Return the folder reduced to one row, for a process that draws it."""
        return Opened(self.directory, {"units": self.content["units"], "pins": [row]})

    def field(self, row: dict[str, Any]) -> Field:
        """Return the field of a row.

        Raises: FileNotFoundError if none was written, Damaged, OSError.
        """
        name = f"vtk/{row['pin']}_{row['case']}.vtu"
        try:
            content = read_inside(self.directory, name, MAX_FIELD_SIZE)
        except FileNotFoundError:
            raise FileNotFoundError(self.directory / name) from None
        mesh, u = read_vtu(content, name), self.units
        if np.abs(mesh.points).max() > MAX_COORDINATE or not np.ptp(mesh.points, axis=0).any():
            raise Damaged(f"{name} is damaged: its points are no body")
        stress = np.empty((len(mesh.points), 6))
        stress[:, VTK_TENSOR_ORDER] = _data(mesh, f"stress [{u.stress}]", 6, name)
        pressed = mesh.data.get("pressed")
        return Field(
            pin=row["pin"],
            case=row["case"],
            points=mesh.points,
            cells=mesh.cells,
            displacement=_data(mesh, f"displacement [{u.length}]", 3, name),
            stress=stress,
            von_mises=_data(mesh, f"von Mises [{u.stress}]", 1, name),
            envelope=_data(mesh, f"von Mises envelope [{u.stress}]", 1, name, gaps=True),
            cell_type=mesh.cell_type,
            outside=_outside(row),
            verdict=row["verdict"],
            pressed=None if pressed is None else pressed.astype(bool),
        )


def _outside(row: dict[str, Any]) -> tuple[float, tuple[float, float, float]] | None:
    """Return the value of Field.outside for a row."""
    read = row["surface"] if row.get("contact") else row
    largest, place = read["max_von_mises"], read["location"]
    if not (row["singular_at"] or row.get("contact")) or None in (largest, place):
        return None
    return largest, tuple(place)


def _data(mesh: Vtu, key: str, width: int, name: str, gaps: bool = False) -> Floats:
    """Return the numbers at the points.

    width: the number of components. gaps: whether numbers may be missing.
    Raises: Damaged.
    """
    values = mesh.data.get(key)
    if values is None or values.size != width * len(mesh.points):
        raise Damaged(f"{name} is damaged: it has no {width} numbers {key!r} at each point")
    known = values[~np.isnan(values)] if gaps else values
    if not np.isfinite(known).all():
        raise Damaged(f"{name} is damaged: {key!r} is no number at some point")
    return values


def open_results(directory: Path) -> Opened:
    """Read a folder that a run wrote.

    Raises: FileNotFoundError, Damaged, OSError.
    """
    return Opened(directory, read_results(directory))
