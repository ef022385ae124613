"""A file with a pin's shape, and the bands on which links bear."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

CAD_SUFFIXES = (".step", ".stp", ".brep", ".iges", ".igs")  # every other file is a mesh


@dataclass(frozen=True)
class Place:
    """A band of a body from a file.

    z: it is the outermost surface between two z, m, in the file's axes.
    surface: or it is the file's surface of that name.
    connection: whether a link with the band's name bears on it.
    """

    name: str
    z: tuple[float, float] | None = None
    surface: str | None = None
    connection: bool = True


@dataclass(frozen=True)
class BodyFile:
    """A CAD or mesh file with the shape of a pin, whose axis is the file's z-axis.

    name: of the pin. unit: m per unit of the file. places: its bands.
    """

    name: str
    path: Path
    unit: float
    places: tuple[Place, ...]

    @property
    def meshed(self) -> bool:
        """Whether the file is a mesh."""
        return self.path.suffix.lower() not in CAD_SUFFIXES
