"""Fields of a pin in results: at the nodes of its mesh or surface."""

from __future__ import annotations

from dataclasses import dataclass
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
    """A band of a pin, from z0 to z1 on a radius, with the force (3,) and the moment (3,) about its
    middle on the axis that are applied there, in the pin's axes; zero where it is `held`.
    """

    connection: str
    z: tuple[Length, Length]
    radius: Length
    force: Forces
    moment: Annotated[Floats, "energy"]
    held: bool

    @property
    def middle(self) -> Floats:
        """On the axis, (3,)."""
        return np.array([0.0, 0.0, 0.5 * (self.z[0] + self.z[1])])


@dataclass(frozen=True)
class Still:
    """The pin of a Field at another instant: displacement (N, 3), von_mises (N,), its loads, and
    where lugs press on it, (N,), None without lugs.
    """

    time: Time
    displacement: Annotated[Floats32, "length"]
    von_mises: Annotated[Floats32, "stress"]
    loads: tuple[BandLoad, ...]
    pressed: NDArray[np.bool_] | None = None


@dataclass(frozen=True)
class Volume:
    """All of a revolved pin: points (N, 3), cells (M, 6; "wedge"), displacement (N, 3), stress
    (N, 6) as a Field's, von_mises (N,), pressed (N,) as a Still's.
    """

    points: Lengths
    cells: NDArray[np.int64]
    cell_type: str
    displacement: Lengths
    stress: Stresses
    von_mises: Stresses
    pressed: NDArray[np.bool_] | None = None


@dataclass(frozen=True)
class Field:
    """A mesh with results at its nodes: points (N, 3), cells (M, 10; VTK's order of "tetra10") or
    (M, 4; "quad": the surface alone), displacement (N, 3), stress (N, 6: xx, yy, zz, yz, xz, xy),
    von_mises (N,), and envelope (N,): the largest von Mises over all instants at surface nodes, NaN
    inside. yield_strength: for the factor of safety at each point, None without one. outside: where
    zones are excluded or lugs press on the surface, the largest stress that is read of it and where
    it is (x, y, z). time: None without a motion. loads: what acts at this instant. stills: along
    the motion, and volume: all of a revolved pin, if wanted. contact_pressure: (N,) of its lugs;
    pressed: (N,) where they press on what is shown, and where the envelope has only the instants at
    which they do not (NaN if there are none); None without lugs. solids: between which z local
    solids are about cuts.
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
    verdict: str = ""
    time: Time | None = None
    loads: tuple[BandLoad, ...] = ()
    stills: tuple[Still, ...] = ()
    volume: Volume | None = None
    contact_pressure: Stresses | None = None
    pressed: NDArray[np.bool_] | None = None
    solids: tuple[tuple[Length, Length], ...] = ()
