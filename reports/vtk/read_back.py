"""A run's folder read back: what `view` shows."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from loads import MB, FileError, read_regular
from reports.data.results import Field, Units
from reports.format.numbers import engineering
from reports.format.words import verdict_words
from reports.vtk.fields import VTK_SYMMETRIC

LARGEST = 1024 * MB  # of results.json


@dataclass(frozen=True)
class Opened:
    """A folder with its results.json."""

    directory: Path
    content: dict[str, Any]

    @property
    def units(self) -> Units:
        """Those of all its numbers."""
        return Units(**self.content["units"])

    def row(self, pin: str | None, case: str | None) -> dict[str, Any]:
        """The row of that pin and case; of several the one with the most stress of its strength.

        Raises: ValueError saying which there are.
        """
        rows = self.content["pins"]
        found = [r for r in rows if r["pin"] == (pin or r["pin"])]
        found = [r for r in found if r["case"] == (case or r["case"])]
        if not found:
            there = ", ".join(f"{r['pin']} in {r['case']}" for r in rows) or "none"
            wanted = " in ".join(name for name in (pin, case) if name)
            raise ValueError(f"no {wanted or 'pin'}; there are {there}")
        # Without a yield strength the most stressed.
        return min(found, key=lambda r: (r["safety_factor"] or np.inf, -(r["max_von_mises"] or 0)))

    def title(self, row: dict[str, Any]) -> str:
        """Pin, case, and the factor with its verdict."""
        text = f"pin {row['pin']}, {row['case']}"
        if row["safety_factor"] is not None:
            text += f": factor of safety {engineering(row['safety_factor'])}"
        return f"{text} ({verdict_words(row['verdict'], row['yields'])})"

    def field(self, row: dict[str, Any]) -> Field:
        """The field of a row. Raises: FileNotFoundError when none was written."""
        import meshio

        path = self.directory / "vtk" / f"{row['pin']}_{row['case']}.vtu"
        if not path.is_file():
            raise FileNotFoundError(path)
        mesh, u = meshio.read(path), self.units
        data = mesh.point_data
        (cells,) = mesh.cells
        stress = np.empty((len(mesh.points), 6))
        stress[:, VTK_SYMMETRIC] = data[f"stress [{u.stress}]"]
        place = row["location"]
        excluded = bool(row["singular_at"]) and place is not None
        return Field(
            pin=row["pin"],
            case=row["case"],
            points=mesh.points.astype(float),
            cells=cells.data.astype(np.int64),
            displacement=data[f"displacement [{u.length}]"],
            stress=stress,
            von_mises=data[f"von Mises [{u.stress}]"],
            envelope=data[f"von Mises envelope [{u.stress}]"],
            cell_type=cells.type,
            outside=(row["max_von_mises"], tuple(place)) if excluded else None,
            verdict=row["verdict"],
        )


def open_results(directory: Path) -> Opened:
    """Read a folder that a run wrote. Raises: FileNotFoundError, ValueError."""
    try:
        content = json.loads(read_regular(directory / "results.json", LARGEST))
    except FileError as error:
        raise ValueError(f"its results.json {error}") from None
    schema = content.get("schema") if isinstance(content, dict) else None
    if not str(schema).startswith("pinstress-results/"):
        raise ValueError("its results.json was not written by pinstress")
    return Opened(directory, _printable(content))


def _printable(node: Any) -> Any:
    """Without characters that steer a terminal, which another program may have written."""
    if isinstance(node, dict):
        return {_printable(key): _printable(value) for key, value in node.items()}
    if isinstance(node, list):
        return [_printable(value) for value in node]
    if isinstance(node, str):
        return "".join(c if c.isprintable() or c == "\n" else "\ufffd" for c in node)
    return node
