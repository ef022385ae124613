"""Fields of a pin in the results: values at the nodes of its mesh or surface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import (
    Floats,
    Floats32,
    Forces,
    Length,
    Lengths,
    Point,
    Stress,
    Stresses,
    Time,
)


@dataclass(frozen=True)
class BandLoad:
    """A band of a pin and the load applied to it, in the pin's axes.

    z: the two ends of the band.
    radius: of the band.
    force: (3,).
    moment: (3,), about the middle of the band on the axis.
    held: whether the band is held; force and moment are then zero.
    """

    connection: str
    z: tuple[Length, Length]
    radius: Length
    force: Forces
    moment: Annotated[Floats, "energy"]
    held: bool

    @property
    def middle(self) -> Floats:
        """The middle (3,) of the band on the axis."""
        return np.array([0.0, 0.0, 0.5 * (self.z[0] + self.z[1])])


@dataclass(frozen=True)
class Still:
    """The fields of a pin at another instant than that of its Field.

    displacement: (N, 3). von_mises: (N,). loads: at this instant.
    pressed: (N,), whether lugs press on the node; None without lugs.
    """

    time: Time
    displacement: Annotated[Floats32, "length"]
    von_mises: Annotated[Floats32, "stress"]
    loads: tuple[BandLoad, ...]
    pressed: NDArray[np.bool_] | None = None


@dataclass(frozen=True)
class Volume:
    """The whole volume of a revolved pin, or of a pin with cuts.

    points: (N, 3). cells: (M, 6), type "wedge", or (M, 10), "tetra10". displacement: (N, 3).
    stress: (N, 6), components as in Field. von_mises: (N,). pressed: (N,), as in Still.
    more: cells of other types, by type.
    """

    points: Lengths
    cells: NDArray[np.int64]
    cell_type: str
    displacement: Lengths
    stress: Stresses
    von_mises: Stresses
    pressed: NDArray[np.bool_] | None = None
    more: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)


@dataclass(frozen=True)
class Field:
    """A mesh with results at its nodes.

    points: (N, 3).
    cells: (M, 10) in VTK's order of "tetra10", or (M, 4) "quad" for a surface alone.
    displacement: (N, 3).
    stress: (N, 6), components xx, yy, zz, yz, xz, xy.
    von_mises: (N,).
    envelope: (N,), the largest von Mises stress over all instants at surface nodes, NaN inside.
    yield_strength: for the safety factor at each point; None if not given.
    outside: the largest stress outside the excluded zones and the pressed surface, and its place
    (x, y, z).
    beneath: the largest stress and its place (x, y, z), if it is inside and the mesh is a surface.
    time: None without a motion.
    loads: at this instant.
    stills: other instants of the motion, if requested.
    volume: the whole volume, if requested, where the field is a surface.
    contact_pressure: (N,), from the lugs.
    pressed: (N,), whether lugs press on the part shown; None without lugs. At these nodes
    `envelope` includes only the instants without pressure (NaN if there are none).
    solids: the ranges of z of local solids about cuts.
    """

    pin: str
    case: str
    points: Lengths
    cells: NDArray[np.int64]
    displacement: Lengths
    stress: Stresses
    von_mises: Stresses
    envelope: Stresses
    cell_type: str = "tetra10"
    yield_strength: Stress | None = None
    outside: tuple[Stress, Point] | None = None
    beneath: tuple[Stress, Point] | None = None
    verdict: str = ""
    time: Time | None = None
    loads: tuple[BandLoad, ...] = ()
    stills: tuple[Still, ...] = ()
    volume: Volume | None = None
    contact_pressure: Stresses | None = None
    pressed: NDArray[np.bool_] | None = None
    solids: tuple[tuple[Length, Length], ...] = ()
