"""A file with a pin's shape, and the bands on which links bear."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

CAD_SUFFIXES = (".step", ".stp", ".brep", ".iges", ".igs")  # all other files are meshes


@dataclass(frozen=True)
class Place:
    """A band of a body from a file.

    The band is given either by `z` or by `surface`.
    z: two z, m, in the file's axes, between which the outermost surface is the band.
    surface: name of the file's surface that is the band.
    connection: whether a link with the band's name bears on it.
    """

    name: str
    z: tuple[float, float] | None = None
    surface: str | None = None
    connection: bool = True


@dataclass(frozen=True)
class BodyFile:
    """A CAD or mesh file with the shape of a pin, whose axis is the file's z-axis.

    name: name of the pin. unit: m per unit of the file. places: bands of the pin.
    """

    name: str
    path: Path
    unit: float
    places: tuple[Place, ...]

    @property
    def meshed(self) -> bool:
        """Whether the file is a mesh."""
        return self.path.suffix.lower() not in CAD_SUFFIXES
