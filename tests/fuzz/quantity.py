"""Studies as trees of quantities in SI, and the same tree written in one unit or another."""

from __future__ import annotations

import csv
import io
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from pinstress.study.schema.units import DIMENSIONS_NEEDING_UNIT, UNIT_SYSTEMS
from tests.support.study_text import study_file

Tree = dict[str, Any]
INCH, POUND = 0.0254, 0.45359237
POUND_FORCE = POUND * 9.80665

# What a person may write, with its SI value; the first where a unit is needed.
UNITS: dict[str, tuple[tuple[str, float], ...]] = {
    "length": (("mm", 1e-3), ("in", INCH), ("cm", 1e-2), ("m", 1.0)),
    "force": (("N", 1.0), ("kN", 1e3), ("lbf", POUND_FORCE)),
    "moment": (("N m", 1.0), ("N cm", 1e-2), ("lbf in", POUND_FORCE * INCH)),
    "stress": (("MPa", 1e6), ("GPa", 1e9), ("ksi", 1e3 * POUND_FORCE / INCH**2)),
    "density": (("kg/m^3", 1.0), ("g/cm^3", 1e3), ("lb/in^3", POUND / INCH**3)),
    "mass": (("kg", 1.0), ("lb", POUND)),
    "inertia": (("kg m^2", 1.0), ("lb in^2", POUND * INCH**2)),
    "time": (("s", 1.0), ("ms", 1e-3)),
    "acceleration": (("m/s^2", 1.0),),
    "velocity": (("m/s", 1.0), ("ft/s", 0.3048)),
    "angle": (("rad", 1.0),),
    "stiffness": (("N/m", 1.0), ("N/mm", 1e3)),
    "torsional stiffness": (("N m/rad", 1.0),),
    "damping": (("N s/m", 1.0),),
    "angular velocity": (("rad/s", 1.0),),
    "angular acceleration": (("rad/s^2", 1.0),),
}


@dataclass(frozen=True)
class Quantity:
    """A number in SI and what it is."""

    value: float
    dimension: str

    def __mul__(self, factor: float) -> Quantity:
        return Quantity(self.value * factor, self.dimension)

    def __neg__(self) -> Quantity:
        return self * -1.0


def length(value: float) -> Quantity:
    """m."""
    return Quantity(value, "length")


def force(value: float) -> Quantity:
    """N."""
    return Quantity(value, "force")


def moment(value: float) -> Quantity:
    """N m."""
    return Quantity(value, "moment")


def angle(value: float) -> Quantity:
    """rad."""
    return Quantity(value, "angle")


@dataclass(frozen=True)
class Csv:
    """A table beside the study: rows by column; cells are texts or quantities."""

    name: str
    rows: tuple[dict[str, Any], ...]


def mapped(node: Any, change: Callable[[Quantity], Quantity]) -> Any:
    """The same tree with every quantity changed."""
    if isinstance(node, Quantity):
        return change(node)
    if isinstance(node, dict):
        return {key: mapped(value, change) for key, value in node.items()}
    if isinstance(node, list | tuple):
        return type(node)(mapped(value, change) for value in node)
    if isinstance(node, Csv):
        return Csv(node.name, mapped(node.rows, change))
    return node


def write(tree: Tree, folder: Path, spelling: random.Random | None = None) -> Path:
    """Put a study and its tables in a folder; the study's path. Numbers are in its unit system, or
    some of them, as `spelling` draws, in units of their own.
    """
    system = UNIT_SYSTEMS[tree["units"]]

    def number(quantity: Quantity) -> float:
        return float(f"{quantity.value / system.factor(quantity.dimension):.15g}")

    def plain(node: Any) -> Any:
        if isinstance(node, Quantity):
            worded = spelling is not None and spelling.random() < 0.3
            if worded or node.dimension in DIMENSIONS_NEEDING_UNIT:
                units = UNITS[node.dimension]
                name, factor = spelling.choice(units) if spelling else units[0]
                return f"{node.value / factor:.15g} {name}"
            return number(node)
        if isinstance(node, dict):
            return {key: plain(value) for key, value in node.items() if value is not None}
        if isinstance(node, list | tuple):
            return [plain(value) for value in node]
        if isinstance(node, Csv):
            (folder / node.name).write_text(_csv(mapped_cells(node)))
            return node.name
        return node

    def mapped_cells(table: Csv) -> list[dict[str, Any]]:
        return [
            {key: number(x) if isinstance(x, Quantity) else x for key, x in row.items()}
            for row in table.rows
        ]

    return study_file(folder, tomlkit.dumps(plain(tree)))


def _csv(rows: list[dict[str, Any]]) -> str:
    out = io.StringIO()
    table = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    return out.getvalue()
