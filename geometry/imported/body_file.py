"""A pin's shape in a file, and where on it links bear."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

CAD_SUFFIXES = (".step", ".stp", ".brep", ".iges", ".igs")  # shapes; everything else is a mesh


@dataclass(frozen=True)
class Place:
    """A band: the outermost surface between two z (m, in the file's axes), or the file's surface
    of that name; connection: whether a link of the same name bears on it.
    """

    name: str
    z: tuple[float, float] | None = None
    surface: str | None = None
    connection: bool = True


@dataclass(frozen=True)
class BodyFile:
    """unit: m per unit of the file, whose z-axis is the pin's axis."""

    name: str
    path: Path
    unit: float
    places: tuple[Place, ...]

    @property
    def meshed(self) -> bool:
        """Whether it is a mesh already."""
        return self.path.suffix.lower() not in CAD_SUFFIXES
